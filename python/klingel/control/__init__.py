"""Control strategies of mechatronic vehicles: small frozen objects that lower to the core's block diagrams.
S and I of Perez, Busturia, Mei, Vinolas, Annual Reviews in Control 28 (2004) 207-217, and no control at all."""

from klingel.control.basics import Timing
from klingel.control.feedforward import ContactDesign
from klingel.control.irw_like import IRWLike
from klingel.control.passive import Passive
from klingel.control.sensor import (
    Accelerometer,
    CurrentSensor,
    Encoder,
    Gyro,
    LoadCell,
    Position,
    Speedometer,
)
from klingel.control.sensors import Sensors
from klingel.control.slip import SlipControl
from klingel.control.solid_like import SolidLike
from klingel.control.traction import Traction

__all__ = [
    "Accelerometer",
    "ContactDesign",
    "CurrentSensor",
    "Encoder",
    "Gyro",
    "IRWLike",
    "LoadCell",
    "Passive",
    "Position",
    "Sensors",
    "SlipControl",
    "SolidLike",
    "Speedometer",
    "Timing",
    "Traction",
]
