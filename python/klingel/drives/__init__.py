"""Traction drives: running resistance, operating point of the motors, transfer functions of Eqs (12) to (29).
Equation numbers are those of Perez, Busturia, Mei, Vinolas, Annual Reviews in Control 28 (2004) 207-217."""

from klingel.drives.characteristic import (
    Excitation,
    base_speed,
    excitation,
    operating_characteristic,
    torque_limit,
)
from klingel.drives.demand import Demand, torque_demand
from klingel.drives.formulas import (
    DavisCoefficients,
    Resistance,
    curve_resistance,
    polynomial,
    sauthoff,
    sncf_general,
    strahl,
)
from klingel.drives.induction import InductionPoint, induction_point, induction_torque_max
from klingel.drives.limits import starting_point, steering_torque_max, traction_torque_max
from klingel.drives.motor import field_current, torque_constant, wheel_torque, wheel_torque_max
from klingel.drives.operating import OperatingPoint, operating_point, operating_table
from klingel.drives.resistance import running_resistance
from klingel.drives.transfer import DriveTransfer, InductionTransfer, Rational, TwoInputs, WheelPair

__all__ = [
    "DavisCoefficients",
    "Demand",
    "DriveTransfer",
    "Excitation",
    "InductionPoint",
    "InductionTransfer",
    "OperatingPoint",
    "Rational",
    "Resistance",
    "TwoInputs",
    "WheelPair",
    "base_speed",
    "curve_resistance",
    "excitation",
    "field_current",
    "induction_point",
    "induction_torque_max",
    "operating_characteristic",
    "operating_point",
    "operating_table",
    "polynomial",
    "running_resistance",
    "sauthoff",
    "sncf_general",
    "starting_point",
    "steering_torque_max",
    "strahl",
    "torque_constant",
    "torque_demand",
    "torque_limit",
    "traction_torque_max",
    "wheel_torque",
    "wheel_torque_max",
]
