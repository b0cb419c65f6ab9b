"""Types of the compiled core."""

from collections.abc import Sequence
from typing import Any, Literal, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Cancelled",
    "ContactPair",
    "CoreError",
    "Progress",
    "build_info",
    "cache",
    "check",
    "creep_force",
    "creep_laws",
    "prepare",
    "profile",
    "simulate",
]

class CoreError(ValueError): ...
class Cancelled(Exception): ...  # noqa: N818, named so by the core

@final
class Progress:
    def __new__(cls) -> Progress: ...
    @property
    def fraction(self) -> float: ...
    def cancel(self) -> None: ...

_Prepared = tuple[Literal["compiled", "disk", "memory"], float, str | None]
_Floats = NDArray[np.float64]

@final
class ContactPair:
    def __new__(cls, spec: str) -> ContactPair: ...
    def prepare(self) -> _Prepared: ...
    def contact(self, y: _Floats, yaw: float, load: float | None) -> dict[str, NDArray[Any]]: ...
    def rolling_radius_difference(self, y: _Floats, load: float | None) -> _Floats: ...
    def equivalent_conicity(self, amplitude: _Floats) -> _Floats: ...

def simulate(spec: str, progress: Progress | None = None) -> dict[str, Any]: ...
def check(spec: str) -> None: ...
def prepare(spec: str) -> list[_Prepared]: ...
def cache() -> tuple[str, list[tuple[str, int, bool]]] | None: ...
def creep_force(
    law: str,
    columns: Sequence[_Floats],
    *,
    shear_modulus: float,
    poisson: float,
    elements: Sequence[int],
    reduction: Sequence[float] | None,
    blended: bool,
    slope: Sequence[float] | None,
    falling: Sequence[float] | None,
) -> list[_Floats]: ...
def creep_laws() -> list[str]: ...
def profile(name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def build_info() -> dict[str, Any]: ...
