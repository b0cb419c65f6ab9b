"""Assessment: one run in, the figures a railway engineer asks for out.
Pure functions of a result; they simulate nothing and write nothing."""

from klingel.assess.curving import COLUMNS, Assessment, WheelsetFigures, curving
from klingel.assess.energy import energy

__all__ = ["COLUMNS", "Assessment", "WheelsetFigures", "curving", "energy"]
