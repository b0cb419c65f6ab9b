"""The simulator's laws as the cases about exact creep forces compare and draw them.
One look a law in every picture: colours of Okabe and Ito, and a line that survives a grey print."""

from __future__ import annotations

from typing import Any

from klingel.plot.style import INK
from validation.contact_creep.picture import LAWS as DIRECT

LAWS: tuple[tuple[str, str, dict[str, Any], str, Any], ...] = (*DIRECT, ("table", "table", {}, INK, "-"))
"""Name, label, options, colour and line; FASTSIM with its 16 x 16 elements."""
MOMENT_LAWS = ("fastsim", "table")
