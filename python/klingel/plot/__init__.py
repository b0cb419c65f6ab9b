"""Figures of Klingel: functions of results and tables that return matplotlib figures, and one that renders them.
They open no window, touch no global state for longer than the call, and write no file."""

from klingel.plot.curving import FIGURES, displacement_history, per_radius
from klingel.plot.energy import energy_account
from klingel.plot.style import LOOKS, Look, render

__all__ = ["FIGURES", "LOOKS", "Look", "displacement_history", "energy_account", "per_radius", "render"]
