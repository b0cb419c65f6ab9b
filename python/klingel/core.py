"""The compiled core, loaded when it is first needed.
The one place that knows its name; what is above imports `core` from here."""

from __future__ import annotations

import importlib
from typing import Any

from klingel.errors import CoreMissingError


def core() -> Any:
    """The extension module; errors: CoreMissingError if it was not built."""
    try:
        return importlib.import_module("klingel._core")
    except ImportError as error:
        raise CoreMissingError(f"klingel._core cannot be loaded ({error}); run `make build` in the checkout") from error
