"""Critical speeds of the passive coach on hollow wheels of one arc each, by the textbook and by the package.
From the reference model's assumptions to the package's in steps, one kind of term at a time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from tests.linear.modes import critical_speed
from tests.linear.railed import arc_wheel, contact_numbers, pair_of
from tests.linear.textbook import GRAVITY, TEXTBOOK, Contact, Matrix, Terms, plain, state_matrix
from tests.linear.textbook_vehicles import coach

import klingel as kl
from klingel.contact import Profile, WheelRailPair
from klingel.scenario import CreepLaw
from klingel.vehicle import Vehicle

REFERENCE = Path(__file__).parent / "reference.csv"


@dataclass(frozen=True)
class Running:
    """A wheel on 60E1 inclined by so much."""

    wheel: Profile
    inclination: float

    @property
    def pair(self) -> WheelRailPair:
        return pair_of(self.wheel, self.inclination, normal="hertz")


MIDDLE = 0.00251
"""Where 60E1 at 1:20 touches a cone of 1:20, outside the tape circle [m]."""
RADII = {0.10: 0.6126, 0.14: 0.4725, 0.18: 0.4194, 0.24: 0.3801, 0.30: 0.3569, 0.40: 0.3246}
"""Of the treads [m] that have this equivalent conicity under the coach's load."""
WHEELS = {0.05: Running(Profile.cone(1 / 20), 1 / 20)} | {
    conicity: Running(arc_wheel(1 / 20, radius, MIDDLE), 1 / 20) for conicity, radius in RADII.items()
}
S1002 = Running(Profile.s1002(), 1 / 40)
NOMINAL = (0.75, 0.46)
"""Half distance of the contacts and rolling radius of the reference model [m]."""
REFERENCE_CREEP = (10e6, 8.8e6)
"""Its f11 and f22 [N]."""

STEPS = ("reference model", "creep of the patch", "contact angle", "weight", "spin", "shift of load")
"""Textbook models, each with one kind of term more than the one before."""
SLOW, FAST, ACCURACY = 35.0, 125.0, 0.01
"""Where critical speeds are sought, and how closely [m/s]."""


@lru_cache
def vehicle() -> Vehicle:
    """The Manchester coach as its benchmark has it, without yaw dampers."""
    return kl.library.vehicle("manchester_coach").model_copy(update={"yaw_damper": None})


def load() -> float:
    """Of one wheel [N]."""
    return vehicle().total_mass * GRAVITY / 8.0


@lru_cache
def contact(running: Running) -> Contact:
    """The textbook's numbers of that wheel under the coach's load."""
    return contact_numbers(running.pair, load())


def equivalent(numbers: Contact) -> float:
    """Slope of the cone whose wave is as long, for small motions under load."""
    return numbers.conicity / numbers.slip


@lru_cache
def reference_model(conicity: float) -> float:
    """The textbook without contact angle, with the reference model's creep coefficients [m/s]."""
    return book(plain(load(), *NOMINAL, conicity, *REFERENCE_CREEP))


@lru_cache
def steps(conicity: float) -> tuple[float, ...]:
    """Critical speed of every model of STEPS [m/s]."""
    c = contact(WHEELS[conicity])
    bare = plain(load(), c.half_distance, c.radius, equivalent(c), c.f11, c.f22)
    return (
        reference_model(conicity),
        book(bare),
        book(c, Terms(gravity=False, spin=False)),
        book(c, Terms(spin=False)),
        book(c),
        book(c, Terms(load_shift=True)),
    )


def book(numbers: Contact, terms: Terms = TEXTBOOK) -> float:
    """Critical speed of the textbook's coach [m/s]."""
    twin = coach(vehicle(), numbers, yaw_dampers=False)
    return critical_speed(lambda V: state_matrix(twin, V, terms), SLOW, FAST, step=10.0, within=ACCURACY)


@lru_cache
def ours(running: Running, law: CreepLaw) -> float:
    """Critical speed of the package's linear model with a creep law [m/s]."""
    scenario = kl.Scenario(
        vehicle(),
        kl.Track.straight("1 km"),
        speed=SLOW,
        wheel=running.wheel,
        rail_inclination=running.inclination,
        creep_law=law,
    )

    def plant(speed: float) -> Matrix:
        return kl.linearise(scenario.replace(speed=speed)).A

    return critical_speed(plant, SLOW, FAST, step=10.0, within=ACCURACY)
