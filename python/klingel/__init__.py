"""Klingel: simulator and design bench for mechatronic railway vehicles.
Names are resolved on first use, so that `import klingel` stays quick."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from klingel import contact, control, library, track
    from klingel.track import Track
    from klingel.vehicle import Vehicle

__version__ = "0.1.0"

# Public name -> module, and the name inside it (None: the module itself).
_NAMES: dict[str, tuple[str, str | None]] = {
    "Track": ("klingel.track", "Track"),
    "Vehicle": ("klingel.vehicle", "Vehicle"),
    "contact": ("klingel.contact", None),
    "control": ("klingel.control", None),
    "library": ("klingel.library", None),
    "track": ("klingel.track", None),
}

__all__ = ["Track", "Vehicle", "__version__", "contact", "control", "library", "track"]


def __getattr__(name: str) -> Any:
    try:
        module, attribute = _NAMES[name]
    except KeyError:
        raise AttributeError(f"module 'klingel' has no attribute {name!r}; it has {', '.join(__all__)}") from None
    loaded = importlib.import_module(module)
    return loaded if attribute is None else getattr(loaded, attribute)


def __dir__() -> list[str]:
    return sorted(__all__)
