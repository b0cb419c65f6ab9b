"""Design bench of controllers: loops of a strategy on the full vehicle and their margins.
Definitions and derivations: docs/theory/design.md."""

from klingel.design.check import Check, check
from klingel.design.compensator import Compensator, loop_shaping, lqg
from klingel.design.designed import Design
from klingel.design.limits import Limits, judged, limits
from klingel.design.loops import Loop, loops
from klingel.design.margins import Margins, margins, margins_of
from klingel.design.tune import speed_loop, steering_loop, torque_loop, tune, yaw_moment_loop

__all__ = [
    "Check",
    "Compensator",
    "Design",
    "Limits",
    "Loop",
    "Margins",
    "check",
    "judged",
    "limits",
    "loop_shaping",
    "loops",
    "lqg",
    "margins",
    "margins_of",
    "speed_loop",
    "steering_loop",
    "torque_loop",
    "tune",
    "yaw_moment_loop",
]
