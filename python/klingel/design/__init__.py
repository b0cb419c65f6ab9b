"""Design bench of controllers: loops of a strategy on the full vehicle and their margins.
Definitions and derivations: docs/theory/design.md."""

from klingel.design.loops import Loop, loops
from klingel.design.margins import Margins, margins, margins_of

__all__ = ["Loop", "Margins", "loops", "margins", "margins_of"]
