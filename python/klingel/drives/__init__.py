"""Traction drives: running resistance, operating point of the motors, transfer functions of Eqs (12) to (29).
Equation numbers are those of Perez, Busturia, Mei, Vinolas, Annual Reviews in Control 28 (2004) 207-217."""

from klingel.drives.limits import OperatingLimit, operating_limit, starting_point, traction_torque_max
from klingel.drives.motor import field_current, torque_constant, wheel_torque, wheel_torque_max
from klingel.drives.operating import OperatingPoint, base_speed, operating_point, operating_table
from klingel.drives.resistance import DavisCoefficients, running_resistance, sncf_general
from klingel.drives.transfer import DriveTransfer, WheelPair

__all__ = [
    "DavisCoefficients",
    "DriveTransfer",
    "OperatingLimit",
    "OperatingPoint",
    "WheelPair",
    "base_speed",
    "field_current",
    "operating_limit",
    "operating_point",
    "operating_table",
    "running_resistance",
    "sncf_general",
    "starting_point",
    "torque_constant",
    "traction_torque_max",
    "wheel_torque",
    "wheel_torque_max",
]
