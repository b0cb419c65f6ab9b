"""A profile as points in metres: standard ones from the core, measured ones read from files and smoothed.
Checked when made: finite, y rising, enough points, metres rather than millimetres."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.contact.checks import Kind, kind_of, kind_problems, point_problems
from klingel.core import core
from klingel.errors import InputError
from klingel.units import Quantity, to_si

Values = NDArray[np.float64]


@lru_cache(maxsize=32)
def _sampled(standard: str) -> tuple[Values, Values]:
    """Points of a curve that the core knows by name; a sweep asks for the same one every time."""
    y, z = core().profile(standard)
    return y, z


@dataclass(frozen=True, eq=False)
class Profile:
    """Cross-section of a wheel or rail: points (y, z) in metres, y rising; the canonical one is the right one.

    Wheel: y from the tape circle, + to the field side, z the radius increment, + on the flange.
    Rail: y from its axis, + to the field side, z down from the top, not inclined.
    Errors: InputError with every problem.

    >>> float(Profile.s1002().depth(-0.05).round(4))
    0.0269
    """

    name: str
    y: Values
    z: Values
    standard: str | None = None
    """Name of the core's own curve that the points are samples of."""

    def __post_init__(self) -> None:
        for axis in ("y", "z"):
            values = np.array(getattr(self, axis), dtype=np.float64)
            values.setflags(write=False)
            object.__setattr__(self, axis, values)
        problems = list(point_problems(self.y, self.z))
        if problems:
            raise InputError(problems, file=self.name)

    def __eq__(self, other: object) -> bool:
        """The same points under the same name."""
        if not isinstance(other, Profile):
            return NotImplemented
        return self.name == other.name and np.array_equal(self.y, other.y) and np.array_equal(self.z, other.z)

    def __hash__(self) -> int:
        return hash((self.name, self.y.tobytes(), self.z.tobytes()))

    @classmethod
    def _standard(cls, name: str, standard: str) -> Self:
        return cls(name, *_sampled(standard), standard)

    @classmethod
    def s1002(cls) -> Self:
        """Wheel S1002 (EN 13715; flange 28 mm high, 32.5 mm thick) from its zone formulas, as the core runs it."""
        return cls._standard("S1002", "s1002")

    @classmethod
    def cone(cls, slope: float) -> Self:
        """A coned tread with a slope such as 1/20, the flange of S1002 and a root of radius 13 mm tangent to both.

        This project's own construction, to check against the conicity of a cone. Errors: InputError for a slope outside
        0 to 0.5.

        >>> float(Profile.cone(1 / 40).depth(0.02).round(6))
        -0.0005
        """
        if not 0.0 <= slope <= 0.5:
            raise InputError.single("slope", slope, "is outside 0 to 0.5", remedy="give the cone's slope such as 1/20")
        return cls._standard(f"cone 1:{1 / slope:g}" if slope else "cylinder", f"cone({float(slope)!r})")

    @classmethod
    def rail_60e1(cls) -> Self:
        """Rail head 60E1 (EN 13674-1) from the radii and widths of its drawing, as the core runs it.

        Status: memory of the standard; the drawing is consistent in itself.
        """
        return cls._standard("60E1", "60e1")

    @classmethod
    def rail_54e1(cls) -> Self:
        """Rail head 54E1 (EN 13674-1) from the radii and widths of its drawing; status as for 60E1.

        >>> rail = Profile.rail_54e1()
        >>> float(np.interp(0.0141, rail.z[rail.y > 0], rail.y[rail.y > 0]).round(5))
        0.035
        """
        return cls._standard("54E1", "54e1")

    @classmethod
    def rail_uic60(cls) -> Self:
        """The UIC60 head of common benchmark files, up to 0.041 mm off 60E1; arcs fitted to a public point file."""
        return cls._standard("UIC60", "uic60")

    @classmethod
    def read(cls, path: str | Path, *, units: str | None = None) -> Self:
        """The profile in a file, as the canonical right-hand one; the content tells the format.

        CSV: `#` comments, header `y_m,z_m` or `y_mm,z_mm`, further columns ignored. SIMPACK `.prw`, `.prr`: with all
        steps of the spline block but its smoothing. MiniProf `.whl`, `.ban`: X and Y by ColumnDef; the tape circle or
        the top of rail becomes z = 0. A wheel is turned until its flange is up and at negative y; a rail until its head
        is up and its gauge face at negative y. An inclination in the file stays in the profile.

        units: of the file's lengths, such as "mm"; None takes what the file states or its format has.
        Errors: InputError with the file and every problem: unknown format, units that do not fit, NaN, y that turns
        back, no flange or a gauge face less than 14 mm deep, a side that cannot be told.
        """
        from klingel.contact.read import read_profile

        path = Path(path)
        return cls(str(path), *read_profile(path, units))

    def smoothed(self, cutoff: Quantity = "3 mm") -> Self:
        """The profile with waves shorter than the cut-off taken out, for measured points.

        A wave of the length L along the arc keeps 1/(1 + (cutoff/L)^4) of its height: half of it at the cut-off. At
        3 mm S1002 itself moves by 3 um where its radius jumps in the root, and by less than 0.2 um on the tread.
        Errors: InputError for a cut-off outside 0.2 to 20 mm or below two steps of the points, and for spikes: points
        far off the smooth runs on both sides of them.

        >>> wheel = Profile.s1002()
        >>> bool(abs(wheel.smoothed("3 mm").depth(0.01) - wheel.depth(0.01)) < 2e-7)
        True
        """
        from klingel.contact.smooth import smoothed

        length = to_si(cutoff, "m", key="cutoff")
        try:
            y, z = smoothed(self.y, self.z, length)
        except InputError as error:
            raise error.in_file(self.name) from None
        return type(self)(f"{self.name}, smoothed at {length * 1e3:g} mm", y, z)

    def spec(self) -> dict[str, Any]:
        """The profile as the core's spec has it: by name if it is the core's own, else its points [m].

        >>> Profile.rail_60e1().spec()
        {'named': '60e1'}
        """
        if self.standard is not None:
            return {"named": self.standard}
        return {"points": {"y": self.y.tolist(), "z": self.z.tolist()}}

    @property
    def kind(self) -> Kind | None:
        """What the points are the right-hand profile of: "wheel", "rail", None if neither.

        >>> Profile.s1002().kind, Profile.rail_60e1().kind
        ('wheel', 'rail')
        """
        return kind_of(self.y, self.z)

    def check(self, wanted: Kind, *, key: str = "") -> None:
        """Refuses the profile if it cannot serve as the wheel or the rail that is wanted.

        key: of the input that it was given for. Errors: InputError with every reason.

        >>> Profile.rail_60e1().check("wheel")
        Traceback (most recent call last):
        ...
        klingel.errors.InputError: 60E1: wheel: this is a rail profile; give a wheel profile here
        """
        problems = kind_problems(wanted, self.y, self.z)
        if problems:
            error = InputError(problems, file=self.name)
            raise error.within(key) if key else error

    def depth(self, y: ArrayLike) -> Values:
        """z at y [m], linear between the points; errors: InputError outside the profile."""
        at = np.asarray(y, dtype=np.float64)
        outside = at[(at < self.y[0]) | (at > self.y[-1])]
        if outside.size:
            remedy = f"use {self.y[0]:g} to {self.y[-1]:g} m"
            raise InputError.single("y", float(outside.flat[0]), "is outside the profile [m]", remedy=remedy)
        return np.asarray(np.interp(at, self.y, self.z))
