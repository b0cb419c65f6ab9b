"""Running resistance of one vehicle: its share in that of its train, by the formula that its file names.
Only the share of one vehicle or one wheel matters here: it sets the torque of the motors (Table 1 of the paper)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from klingel.drives.formulas import DavisCoefficients, polynomial, sauthoff, sncf_general, strahl
from klingel.errors import InputError

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle


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
    mass = train.cars * vehicle.total_mass
    if train.formula == "davis":
        return DavisCoefficients(train.given("constant"), train.given("linear"), train.given("quadratic"))
    if train.formula == "sncf_general":
        whole = sncf_general(
            mass=mass,
            axle_load=vehicle.total_mass / 4.0,
            front_area=train.given("front_area"),
            perimeter=train.given("partial_perimeter"),
            length=train.cars * train.given("car_length"),
            stock=str(train.stock),
        )
    elif train.formula == "sauthoff":
        whole = sauthoff(mass=mass, cars=train.cars)
    elif train.formula == "strahl":
        whole = strahl(mass=mass, stock=str(train.stock))
    else:
        whole = polynomial(train.formula, mass=mass)
    return whole.share(train.cars)
