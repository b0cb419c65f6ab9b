"""Control strategies of mechatronic vehicles: small frozen objects that lower to the core's block diagrams.
S and I of Perez, Busturia, Mei, Vinolas, Annual Reviews in Control 28 (2004) 207-217, others beside them, and none."""

from klingel.control.basics import Timing
from klingel.control.coupling import WheelCoupling
from klingel.control.feedforward import ContactDesign
from klingel.control.feedforward_steering import Feedforward
from klingel.control.irw_like import IRWLike
from klingel.control.lateral_feedback import LateralFeedback
from klingel.control.passive import Passive
from klingel.control.passive_irw import PassiveIRW
from klingel.control.secondary_yaw import SecondaryYaw
from klingel.control.slip import SlipControl
from klingel.control.solid_like import SolidLike
from klingel.control.torque_vectoring import TorqueVectoring
from klingel.control.traction import Traction
from klingel.control.trailed_irw import TrailedIRW
from klingel.control.yaw_moment import YawMoment
from klingel.control.yaw_relaxation import YawRelaxation

__all__ = [
    "ContactDesign",
    "Feedforward",
    "IRWLike",
    "LateralFeedback",
    "Passive",
    "PassiveIRW",
    "SecondaryYaw",
    "SlipControl",
    "SolidLike",
    "Timing",
    "TorqueVectoring",
    "Traction",
    "TrailedIRW",
    "WheelCoupling",
    "YawMoment",
    "YawRelaxation",
]
