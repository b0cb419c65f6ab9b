"""Running resistance of a train on straight level track as A + B v + C v^2, from an empirical formula.
Only the share of one vehicle or one wheel matters here: it sets the torque of the motors (Table 1 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.errors import InputError

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle

MASS_FACTOR = {"tgv": 0.9, "passenger": 1.2, "freight": 1.5}
"""lambda of the SNCF formula, from a public file (TEGA davis.h)."""
FRONT_FACTOR = {"tgv": 9.0e-4, "passenger": 20.0e-4, "freight": 20.0e-4}
"""k1 of the SNCF formula; 20e-4 as recalled from Profillidis, unverified (the public file prints 2e-4)."""
SKIN_FACTOR = {"tgv": 20.0e-6, "passenger": 30.0e-6, "freight": 30.0e-6}
"""k2 of the SNCF formula, from the same public file."""


@dataclass(frozen=True)
class DavisCoefficients:
    """R = constant + linear v + quadratic v^2, v in m/s: N, N s/m, N s2/m2."""

    constant: float
    linear: float
    quadratic: float

    def __call__(self, speed: float) -> float:
        """Resistance [N] at `speed` [m/s]."""
        return self.constant + self.linear * speed + self.quadratic * speed**2

    def share(self, parts: float) -> DavisCoefficients:
        """One of `parts` equal parts."""
        return DavisCoefficients(self.constant / parts, self.linear / parts, self.quadratic / parts)


def sncf_general(
    *, mass: float, axle_load: float, front_area: float, perimeter: float, length: float, stock: str
) -> DavisCoefficients:
    """Running resistance of a whole train by the general SNCF formula.

    R[daN] = lambda M sqrt(10/m) + 0.01 M V + (k1 S + k2 p L) V^2 with train mass M [t], mass per axle m [t], speed V
    [km/h], front area S [m2], partial perimeter p [m], train length L [m].

    mass, axle_load: kg; front_area: m2; perimeter, length: m; stock: "tgv", "passenger" or "freight".
    Source: constants of a public file (TEGA davis.h) whose sqrt(1e5/m) is wrong by sqrt(10); corrected as here it
    gives 48.5 kN for a TGV of 418 t at 265 km/h, where the TGV formula gives 48.7 kN. Error: InputError for a stock
    that has no constants.

    >>> train = sncf_general(mass=418e3, axle_load=16.1e3, front_area=10.0, perimeter=10.0, length=200.0, stock="tgv")
    >>> round(train(265 / 3.6) / 1e3, 1)
    48.5
    """
    if stock not in MASS_FACTOR:
        raise InputError.single("stock", stock, "has no constants", remedy=f"give one of {', '.join(MASS_FACTOR)}")
    tonnes, per_axle = mass / 1e3, axle_load / 1e3
    drag = FRONT_FACTOR[stock] * front_area + SKIN_FACTOR[stock] * perimeter * length
    return DavisCoefficients(
        constant=10.0 * MASS_FACTOR[stock] * tonnes * (10.0 / per_axle) ** 0.5,
        linear=10.0 * 0.01 * tonnes * 3.6,
        quadratic=10.0 * drag * 3.6**2,
    )


def running_resistance(vehicle: Vehicle) -> DavisCoefficients:
    """The share of one vehicle [N] in the running resistance of its train (`vehicle.running_resistance`).

    Error: InputError where the vehicle states no train.

    >>> from klingel import library
    >>> round(running_resistance(library.vehicle("mechatronic_irw"))(30.0))
    1592
    """
    train = vehicle.running_resistance
    if train is None:
        raise InputError.single("running_resistance", None, "is missing", remedy="add the table to the vehicle's file")
    whole = sncf_general(
        mass=train.cars * vehicle.total_mass,
        axle_load=vehicle.total_mass / 4.0,
        front_area=train.front_area,
        perimeter=train.partial_perimeter,
        length=train.cars * train.car_length,
        stock=train.stock,
    )
    return whole.share(train.cars)
