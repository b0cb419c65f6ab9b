"""Control strategies of mechatronic vehicles: small frozen objects that lower to the core's block diagrams.
S and I of Perez, Busturia, Mei, Vinolas, Annual Reviews in Control 28 (2004) 207-217, others, none, and your own."""

from klingel.control.basics import WHEELSETS, Timing, Wheelset, scheduled
from klingel.control.common import Plant, command_steering, speed_difference
from klingel.control.composed import Composed
from klingel.control.coupling import WheelCoupling
from klingel.control.diagram import Diagram
from klingel.control.discrete import Section, bilinear, lead, low_pass, notch, slope_low_pass, transfer_function
from klingel.control.feedforward import ContactDesign
from klingel.control.feedforward_steering import Feedforward
from klingel.control.irw_like import IRWLike
from klingel.control.lateral_feedback import LateralFeedback
from klingel.control.own import PythonController
from klingel.control.passive import Passive
from klingel.control.passive_irw import PassiveIRW
from klingel.control.secondary_yaw import SecondaryYaw
from klingel.control.sensor import (
    Accelerometer,
    CurrentSensor,
    Encoder,
    Gyro,
    LoadCell,
    Position,
    Speedometer,
    StrokeSensor,
)
from klingel.control.sensors import Sensors
from klingel.control.slip import SlipControl
from klingel.control.solid_like import SolidLike
from klingel.control.state_space import DiscreteController
from klingel.control.steering import hold_equal_torques
from klingel.control.torque_vectoring import TorqueVectoring
from klingel.control.traction import Traction
from klingel.control.trailed_irw import TrailedIRW
from klingel.control.yaw_moment import YawMoment
from klingel.control.yaw_relaxation import YawRelaxation

__all__ = [
    "WHEELSETS",
    "Accelerometer",
    "Composed",
    "ContactDesign",
    "CurrentSensor",
    "Diagram",
    "DiscreteController",
    "Encoder",
    "Feedforward",
    "Gyro",
    "IRWLike",
    "LateralFeedback",
    "LoadCell",
    "Passive",
    "PassiveIRW",
    "Plant",
    "Position",
    "PythonController",
    "SecondaryYaw",
    "Section",
    "Sensors",
    "SlipControl",
    "SolidLike",
    "Speedometer",
    "StrokeSensor",
    "Timing",
    "TorqueVectoring",
    "Traction",
    "TrailedIRW",
    "WheelCoupling",
    "Wheelset",
    "YawMoment",
    "YawRelaxation",
    "bilinear",
    "command_steering",
    "hold_equal_torques",
    "lead",
    "low_pass",
    "notch",
    "scheduled",
    "slope_low_pass",
    "speed_difference",
    "transfer_function",
]
