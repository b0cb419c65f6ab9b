"""Running resistance: every formula against numbers computed apart from this code, vehicles that name one, curves."""

from typing import Any

import pytest

from klingel import library
from klingel.drives import curve_resistance, polynomial, running_resistance, sauthoff, sncf_general, strahl
from klingel.drives.formulas import constants
from klingel.errors import InputError
from klingel.vehicle import Vehicle

COACH = library.vehicle("manchester_coach")
CAR = 44.482e3

# Per wheel of a car of 44.482 t (8 wheels) in a train of eight [N]: computed apart from this code with g = 9.80665 m/s2
# (status "derived").
# Speed [km/h], SNCF general, TGV, X2000, OSRD's generic train of 900 t, Sauthoff.
PER_WHEEL = [
    (0, 47.5, 33.4, 32.8, 33.4, 106.2),
    (108, 196.8, 166.6, 162.6, 137.2, 291.0),
    (176, 382.5, 338.4, 357.3, 271.0, 543.9),
    (265, 732.5, 665.6, 743.9, 526.0, 1034.4),
    (300, 903.3, 826.2, 937.0, 651.2, 1276.8),
]


@pytest.mark.parametrize("row", PER_WHEEL, ids=lambda row: f"{row[0]}kmh")
def test_formulas_against_numbers_computed_apart(row: tuple[float, ...]) -> None:
    train = 8.0 * CAR
    general = sncf_general(mass=train, axle_load=CAR / 4.0, front_area=10.0, perimeter=10.0, length=200.0, stock="tgv")
    types = [polynomial(name, mass=train) for name in ("tgv", "x2000", "osrd_high_speed")]
    for formula, expected in zip([general, *types, sauthoff(mass=train, cars=8)], row[1:], strict=True):
        assert formula(row[0] / 3.6) / 64.0 == pytest.approx(expected, rel=5e-4, abs=0.06)


def test_formulas_that_are_recalled_have_their_own_form() -> None:
    """By hand from the printed formulas, V in km/h."""
    assert strahl(mass=100e3, stock="empty")(50.0 / 3.6) == pytest.approx(981.0 * (2.0 + 0.107 * 25.0))
    assert polynomial("crh2", mass=100e3)(200.0 / 3.6) == pytest.approx(981.0 * (0.88 + 1.488 + 4.56))
    assert polynomial("crh380a", mass=100e3)(300.0 / 3.6) == pytest.approx(981.0 * (0.52 + 1.14 + 10.08))
    assert polynomial("ave_s100", mass=421e3)(300.0 / 3.6) == pytest.approx(10.0 * (254.0 + 1002.0 + 5148.0))
    assert polynomial("shinkansen_200", mass=712e3)(50.0) == pytest.approx(1e3 * (8.202 + 5.328 + 29.8305))


def test_recalled_numbers_say_so() -> None:
    table = constants()
    assert table.sncf_general.k1.status == "memory"
    recalled = {name for name, entry in table.polynomial.items() if entry.status == "memory"}
    assert recalled == {"shinkansen_200", "ave_s100", "crh2", "crh380a"}
    assert all(entry.source for entry in [*table.polynomial.values(), *table.curve.values()])


def with_resistance(**table: Any) -> Vehicle:
    tables = COACH.model_dump(exclude_none=True)
    tables["running_resistance"] = {"status": "design", **table}
    return Vehicle.from_tables(tables)


def test_a_vehicle_names_any_formula_or_gives_its_coefficients() -> None:
    speed, mass = 50.0, COACH.total_mass
    davis = with_resistance(formula="davis", constant=500.0, linear="20 N s/m", quadratic=3.0)
    assert running_resistance(davis)(speed) == 500.0 + 20.0 * speed + 3.0 * speed**2
    assert running_resistance(with_resistance(formula="x2000"))(speed) == pytest.approx(
        polynomial("x2000", mass=mass)(speed)
    )
    eight = running_resistance(with_resistance(formula="sauthoff", cars=8))
    assert eight(speed) == pytest.approx(sauthoff(mass=8 * mass, cars=8)(speed) / 8.0)
    assert running_resistance(with_resistance(formula="strahl", stock="loaded"))(speed) > 0.0


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"formula": "davis", "constant": 1.0, "linear": 1.0}, "davis needs quadratic"),
        ({"formula": "sncf_general", "stock": "tgv"}, "sncf_general needs car_length"),
        ({"formula": "strahl", "stock": "tgv"}, "strahl has no stock tgv"),
        ({"formula": "maglev"}, "formula"),
    ],
)
def test_what_a_formula_needs_is_asked_for(table: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        with_resistance(**table)


def test_curve_resistance_is_made_for_its_radii() -> None:
    assert curve_resistance(mass=100e3, radius=705.0) == pytest.approx(981.0)
    assert curve_resistance(mass=100e3, radius=400.0, formula="sncf") == pytest.approx(1962.0)
    with pytest.raises(InputError, match="tighter than roeckl's formula is made for"):
        curve_resistance(mass=100e3, radius=299.0)
    with pytest.raises(InputError, match="is not known"):
        curve_resistance(mass=100e3, radius=299.0, formula="protopapadakis")
