"""A wheel profile on a rail profile: where they touch, under what pressure, rolling radii and equivalent conicity.
What is shown under load comes from the tables that the simulator reads."""

from __future__ import annotations

import json
import logging
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.contact.profile import Profile
from klingel.core import core
from klingel.errors import InputError, Problem, nearest
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    import pandas as pd

    from klingel._core import ContactPair

Values = NDArray[np.float64]
NormalContact = Literal["kik_piotrowski", "hertz"]

SIDES = ("left", "right")
ZONES = ("tread", "root", "flange")

UNITS: Mapping[str, str] = {
    "y": "m",
    "side": "",
    "zone": "",
    "x": "m",
    "y_wheel": "m",
    "z_wheel": "m",
    "y_rail": "m",
    "z_rail": "m",
    "angle": "rad",
    "rolling_radius": "m",
    "a": "m",
    "b": "m",
    "area": "m2",
    "pressure": "Pa",
    "normal_force": "N",
    "penetration": "m",
    "roll": "rad",
}
"""Columns of `WheelRailPair.contact` and their units."""

LOADED = ("a", "b", "area", "pressure", "normal_force", "penetration")
"""Columns that only a load fills."""

LOG = logging.getLogger("klingel")


class Prepared(NamedTuple):
    """How a contact table was had.

    origin: "compiled" now, read from "disk", or still in "memory"; seconds: on the clock; unkept: why it could not be
    written to the cache folder, None if it was or need not be.
    """

    origin: Literal["compiled", "disk", "memory"]
    seconds: float
    unkept: str | None

    def __str__(self) -> str:
        how = {"compiled": "compiled", "disk": "read from the cache", "memory": "ready"}[self.origin]
        kept = f" (not kept: {self.unkept})" if self.unkept else ""
        return f"contact table {how} in {self.seconds:.2f} s{kept}"


class WheelRailPair:
    """Two equal wheels of a wheelset on two equal rails.

    wheel, rail: profiles of the right-hand side; rail_inclination: slope, positive when the rails lean inwards, such as
    1/40; gauge: 14 mm below the top of rail; flange_back: distance of the wheels' flange backs; radius: of the wheel at
    its tape circle, 70 mm outside the flange back; normal: how the normal contact is solved, `kik_piotrowski` (virtual
    penetration, not Hertzian) or `hertz` (an ellipse in every zone of the wheel). Plain numbers are SI, strings carry
    units. Steel: E 210 GPa, nu 0.28.
    Errors: InputError for profiles of the wrong kind and a pair that cannot be.

    >>> pair = WheelRailPair(Profile.s1002(), Profile.rail_60e1(), rail_inclination=1 / 40, gauge="1435 mm",
    ...                      flange_back="1360 mm", radius="460 mm")
    >>> round(pair.equivalent_conicity(0.003), 3)
    0.177
    """

    def __init__(
        self,
        wheel: Profile,
        rail: Profile,
        *,
        rail_inclination: Quantity,
        gauge: Quantity,
        flange_back: Quantity,
        radius: Quantity,
        normal: NormalContact = "kik_piotrowski",
    ) -> None:
        wheel.check("wheel")
        rail.check("rail")
        self.wheel, self.rail = wheel, rail
        self.rail_inclination = to_si(rail_inclination, "1", key="rail_inclination")
        self.gauge = to_si(gauge, "m", key="gauge")
        self.flange_back = to_si(flange_back, "m", key="flange_back")
        self.radius = to_si(radius, "m", key="radius")
        self.normal = normal
        if normal not in get_args(NormalContact):
            raise InputError.single("normal", normal, "is not known", remedy=nearest(normal, get_args(NormalContact)))
        spec = {
            "wheel": wheel.spec(),
            "rail": rail.spec(),
            "rail_inclination": self.rail_inclination,
            "gauge": self.gauge,
            "flange_back": self.flange_back,
            "radius": self.radius,
            "normal": normal,
        }
        self._core: ContactPair = _heard(lambda: core().ContactPair(json.dumps(spec, allow_nan=False)))

    def __repr__(self) -> str:
        lean = f"1:{1 / self.rail_inclination:g}" if self.rail_inclination else "upright"
        return f"{self.wheel.name} on {self.rail.name} {lean}, gauge {self.gauge * 1e3:g} mm"

    def prepare(self) -> Prepared:
        """Compile the contact table, or read it from the cache, if it is not at hand; it is done when first needed."""
        prepared = Prepared(*_heard(self._core.prepare))
        LOG.info("%s: %s", self, prepared)
        return prepared

    def contact(self, y: ArrayLike, *, yaw: float = 0.0, wheel_load: float | None = None) -> pd.DataFrame:
        """The contact patches of the wheelset moved by y, one row for every y, side and patch.

        y: to the right [m], a number or an array; yaw: positive to the right [rad]; wheel_load: vertical force of each
        wheel on its rail, without friction [N], None for rigid wheels and rails.

        Columns (SI units in `attrs["units"]`), each wheel in its own frame with y to the field side and z down:
        `y` of the wheelset; `side` left or right; `zone` of the wheel: tread, root or flange, "" when rigid;
        `y_wheel` from the tape circle and `z_wheel`, the radius increment; `y_rail`, `z_rail` from the highest point of
        the rail as it lies in the track; `x` ahead of the axle, which yaw brings about; `angle` of the contact plane in
        the track, positive on the flange; `rolling_radius` down to the rail; `a`, `b` semi-axes along and across the
        rolling direction of the equivalent ellipse, `area`, largest `pressure`, `normal_force`, `penetration` along the
        normal (NaN when rigid); `roll` of the axle, positive when its right side is low.
        Errors: InputError for numbers that are not finite, loads that are not positive, places off the rail.
        """
        import pandas as pd

        places = _finite("y", y).reshape(-1)
        turn = float(_finite("yaw", yaw))
        raw = _heard(lambda: self._core.contact(places, turn, _load(wheel_load)))
        rigid = wheel_load is None
        columns: dict[str, Any] = {
            **{name: values for name, values in raw.items() if name in UNITS},
            "y": places[raw["place"]],
            "side": np.array(SIDES, dtype=object)[raw["side"]],
            "zone": np.array([*ZONES, ""], dtype=object)[raw["zone"]],
        }
        if rigid:
            columns |= {name: np.full(len(raw["place"]), math.nan) for name in LOADED}
        frame = pd.DataFrame({name: columns[name] for name in UNITS})
        frame.attrs["units"] = dict(UNITS)
        return frame

    @overload
    def rolling_radius_difference(self, y: float, *, wheel_load: float | None = None) -> float: ...
    @overload
    def rolling_radius_difference(self, y: ArrayLike, *, wheel_load: float | None = None) -> float | Values: ...

    def rolling_radius_difference(self, y: ArrayLike, *, wheel_load: float | None = None) -> float | Values:
        """Right less left rolling radius at y [m], positive for y > 0 [m]; a number for a number, else of y's shape.

        The roll that follows from the contact is included; wheel_load [N]: of each wheel, then the radius is that of
        the load-weighted middle of the patches; None for rigid wheels and rails. Errors as `contact`.
        """
        places = _finite("y", y)
        made = _heard(lambda: self._core.rolling_radius_difference(places.reshape(-1), _load(wheel_load)))
        return _shaped(made, places)

    @overload
    def equivalent_conicity(self, amplitude: float) -> float: ...
    @overload
    def equivalent_conicity(self, amplitude: ArrayLike) -> float | Values: ...

    def equivalent_conicity(self, amplitude: ArrayLike) -> float | Values:
        """Equivalent conicity at an amplitude of lateral motion [m], by the integration of EN 15302, rigid contact.

        Slope of the cone with the same wavelength.
        Errors: InputError for amplitudes that are not positive or over 15 mm.
        """
        amplitudes = _finite("amplitude", amplitude)
        return _shaped(_heard(lambda: self._core.equivalent_conicity(amplitudes.reshape(-1))), amplitudes)


def _shaped(values: Values, like: Values) -> float | Values:
    return float(values[0]) if like.ndim == 0 else values.reshape(like.shape)


def _finite(key: str, given: ArrayLike) -> Values:
    try:
        values = np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError.single(key, given, "is no number", remedy="give numbers in SI units") from None
    values = values.reshape(np.shape(given))
    if not np.all(np.isfinite(values)):
        wrong = float(values[~np.isfinite(values)].flat[0])
        raise InputError.single(key, wrong, "is not finite", remedy="give finite numbers")
    return values


def _load(wheel_load: float | None) -> float | None:
    if wheel_load is None:
        return None
    load = float(_finite("wheel_load", wheel_load))
    if load <= 0.0:
        remedy = "give the force of one wheel in newtons, or None for rigid contact"
        raise InputError.single("wheel_load", load, "must be positive [N]", remedy=remedy)
    return load


def _heard(ask: Any) -> Any:
    """What the core answers; its refusal as an InputError."""
    try:
        return ask()
    except core().CoreError as error:
        raise InputError([Problem("", None, str(error))]) from None
