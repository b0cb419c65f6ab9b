"""Creep forces of elliptic contact patches by the simulator's laws and by exact theory, for one patch or for arrays.
Positive creepages of the wheel over the rail give negative forces on the wheel."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Literal, get_args, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.core import core
from klingel.errors import InputError, Problem, nearest

Values = NDArray[np.float64]
CreepLaw = Literal["linear", "shen_hedrick_elkins", "polach", "fastsim", "table", "exact"]

ELEMENTS = {"fastsim": (16, 16), "exact": (40, 40)}
"""Laws that divide the patch into elements; how many along and across unless told otherwise."""


@overload
def creep_force(
    law: CreepLaw,
    *,
    a: float,
    b: float,
    xi: float,
    eta: float,
    phi: float,
    normal_force: float,
    friction: float,
    shear_modulus: float,
    poisson: float,
    elements: tuple[int, int] | None = None,
    blended: bool | None = None,
    slope: tuple[float, float, float] | None = None,
    reduction: tuple[float, float] | None = None,
    falling: tuple[float, float] | None = None,
    speed: float | None = None,
) -> tuple[float, float, float]: ...
@overload
def creep_force(
    law: CreepLaw,
    *,
    a: ArrayLike,
    b: ArrayLike,
    xi: ArrayLike,
    eta: ArrayLike,
    phi: ArrayLike,
    normal_force: ArrayLike,
    friction: ArrayLike,
    shear_modulus: float,
    poisson: float,
    elements: tuple[int, int] | None = None,
    blended: bool | None = None,
    slope: tuple[float, float, float] | None = None,
    reduction: tuple[float, float] | None = None,
    falling: tuple[float, float] | None = None,
    speed: ArrayLike | None = None,
) -> tuple[Values, Values, Values]: ...
def creep_force(
    law: CreepLaw,
    *,
    a: ArrayLike,
    b: ArrayLike,
    xi: ArrayLike,
    eta: ArrayLike,
    phi: ArrayLike,
    normal_force: ArrayLike,
    friction: ArrayLike,
    shear_modulus: float,
    poisson: float,
    elements: tuple[int, int] | None = None,
    blended: bool | None = None,
    slope: tuple[float, float, float] | None = None,
    reduction: tuple[float, float] | None = None,
    falling: tuple[float, float] | None = None,
    speed: ArrayLike | None = None,
) -> tuple[float, float, float] | tuple[Values, Values, Values]:
    """Fx [N], Fy [N] and Mz [N m] on the wheel, in the contact plane (x forward, y right, z into the rail).

    law: `linear` (Kalker's, without a friction limit), `shen_hedrick_elkins` (for little spin), `polach` (closed form
    with spin), `fastsim` (Kalker's simplified theory), `table` (Kalker's full theory read from a table, the simulator's
    unless told otherwise, docs/theory/creep_table.md) or `exact` (the full theory itself, docs/theory/exact.md: the
    reference for the others, some 50 ms a patch, on all cores); `shen_hedrick_elkins` and `polach` give no moment.
    a, b: semi-axes along and across rolling [m]; xi, eta: longitudinal and lateral creepage; phi: spin [1/m];
    normal_force [N]; friction: coefficient; shear_modulus [Pa] and poisson of both bodies. Arrays are broadcast against
    each other; plain numbers alone give plain floats.

    Options (docs/theory/creep.md has the formulas):
    elements: along and across, of `fastsim` up to 40 each, (16, 16) unless given, and of `exact` 4 to 80, (40, 40)
        unless given, as the table has been made
    blended: of `fastsim`, its three flexibilities blend into one as sliding sets in, which halves the error at no cost;
        True unless given, False is Kalker's original
    slope: of `fastsim`, (k0, alpha, beta) of Spiryagin's reduced initial slope
    reduction: of `polach`, (kA, kS), reduced stiffness in adhesion and in slip
    falling: of any law, (A, B [s/m]): friction mu0 ((1 - A) exp(-B w) + A) with mu0 = `friction`, at the slip velocity
        w = `speed` sqrt(xi^2 + eta^2)
    speed: of rolling [m/s], for `falling`
    Errors: InputError with every problem of the numbers, for an unknown law or option, for `table` with another
    Poisson's ratio than 0.28, or, with the patch's index, for a patch that `exact` has no solution for (a/b outside
    0.02 to 50; no convergence, which has not been seen) or that is not in the table (a/b outside 1/36 to 36).

    >>> steel = {"shear_modulus": 8.2e10, "poisson": 0.28}
    >>> patch = {"a": 6e-3, "b": 4e-3, "normal_force": 5e4, "friction": 0.3, **steel}
    >>> fx, fy, mz = creep_force("fastsim", xi=1e-3, eta=0.0, phi=0.0, **patch)
    >>> round(fx), round(fy), round(mz)
    (-7549, 0, 0)
    >>> creep_force("polach", xi=[1e-3, 1e-2], eta=0.0, phi=0.0, **patch)[0].round()
    array([ -8074., -14947.])
    >>> for law in ("exact", "table"):
    ...     fx, _, _ = creep_force(law, xi=1e-3, eta=0.0, phi=0.0, **patch)
    ...     print(round(fx / 1e3, 1))
    -7.7
    -7.7
    """
    options = {"slope": (slope, 3), "reduction": (reduction, 2), "falling": (falling, 2)}
    problems = [
        *_law_problems(law, elements, blended),
        *(
            Problem(key, value, f"is no tuple of {n} numbers, none negative")
            for key, (value, n) in options.items()
            if not _tuple(value, n)
        ),
        *_speed_problems(falling, speed),
    ]
    numbers: dict[str, ArrayLike] = {
        "a": a, "b": b, "xi": xi, "eta": eta, "phi": phi, "normal_force": normal_force, "friction": friction,
        "speed": 0.0 if speed is None else speed,
    }  # fmt: skip
    columns: dict[str, Values] = {}
    for key, value in (*numbers.items(), ("shear_modulus", shear_modulus), ("poisson", poisson)):
        try:
            columns[key] = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError):
            problems.append(Problem(key, value, "is no number or array of numbers", remedy="give plain numbers, SI"))
            continue
        problems.extend(_number_problems(key, columns[key]))
    if problems:
        raise InputError(problems)
    patches = [columns[key] for key in numbers]
    try:
        broadcast = np.broadcast_arrays(*patches)
    except ValueError:
        shapes = ", ".join(f"{key} {columns[key].shape}" for key in numbers if columns[key].ndim)
        raise InputError.single(
            "", None, f"these shapes do not go together: {shapes}", remedy="give equal shapes, or plain numbers"
        ) from None
    shape = broadcast[0].shape
    try:
        forces = core().creep_force(
            law,
            [np.ascontiguousarray(values).reshape(-1) for values in broadcast],
            shear_modulus=float(shear_modulus),
            poisson=float(poisson),
            elements=ELEMENTS.get(law, (1, 1)) if elements is None else elements,
            reduction=reduction,
            blended=law == "fastsim" if blended is None else blended,
            slope=slope,
            falling=falling,
        )
    except core().CoreError as error:
        message, *place = error.args
        raise InputError.single(f"patch{_index(place[0], shape)}" if place else "", None, message) from None
    if shape == ():
        fx, fy, mz = (float(values[0]) for values in forces)
        return fx, fy, mz
    x, y, z = (values.reshape(shape) for values in forces)
    return x, y, z


def _law_problems(law: object, elements: object, blended: object) -> Iterator[Problem]:
    if law not in get_args(CreepLaw):
        yield Problem("law", law, "is not known", remedy=nearest(law, get_args(CreepLaw)))
    elif elements is not None and law not in ELEMENTS:
        remedy = f"leave it out or choose {' or '.join(ELEMENTS)}"
        yield Problem("elements", elements, f"does not belong to {law}", remedy=remedy)
    if not _tuple(elements, 2, int, np.integer):
        yield Problem("elements", elements, "is no pair of whole numbers", remedy="give for example (16, 16)")
    if not (blended is None or isinstance(blended, bool)):
        yield Problem("blended", blended, "is no yes or no", remedy="give True or False")


def _speed_problems(falling: object, speed: object) -> Iterator[Problem]:
    if falling is not None and speed is None:
        yield Problem("speed", None, "is missing", remedy="falling friction needs the speed [m/s]")
    if falling is None and speed is not None:
        yield Problem("falling", None, "is missing", remedy="leave out speed or give falling = (A, B)")


def _tuple(value: Any, length: int, *kinds: type) -> bool:
    """Whether an option is left out or holds so many numbers that are not negative."""
    if value is None:
        return True
    if not isinstance(value, (tuple, list)) or len(value) != length:
        return False
    numbers: list[Any] = [x for x in value if isinstance(x, kinds or (int, float, np.number))]
    return len(numbers) == length and all(0 <= x < math.inf for x in numbers)


POSITIVE = ("a", "b", "shear_modulus")
NOT_NEGATIVE = ("normal_force", "friction", "speed", "poisson")
SCALAR = ("shear_modulus", "poisson")
LARGEST = 1e12
"""Of every number: far beyond steel's stiffness; powers of much larger ones overflow in the laws."""


def _number_problems(key: str, values: Values) -> Iterator[Problem]:
    """The first bad value of an argument."""
    if key in SCALAR and values.ndim:
        yield Problem(key, values.shape, "is an array", remedy="give one number: call once for each material")
        return
    bad, message = ~np.isfinite(values), "is not finite"
    if not bad.any():
        bad, message = np.abs(values) > LARGEST, f"is beyond {LARGEST:g}: no wheel has it; give SI units"
    if not bad.any() and key in POSITIVE:
        bad, message = values <= 0.0, "must be positive"
    elif not bad.any() and key in NOT_NEGATIVE:
        bad, message = values < 0.0, "must not be negative"
    if bad.any():
        place = int(np.argmax(bad))
        value = float(values.reshape(-1)[place])
        yield Problem(f"{key}{_index(place, values.shape)}", value if math.isfinite(value) else str(value), message)


def _index(place: int, shape: tuple[int, ...]) -> str:
    """A place counted through an array, as one writes it; nothing for a plain number."""
    return f"[{', '.join(str(int(i)) for i in np.unravel_index(place, shape))}]" if shape else ""
