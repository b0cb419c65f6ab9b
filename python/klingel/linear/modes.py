"""Modes of a linear model: frequency, damping, shape, energy shares, and a name guessed from them.
A sampled model's eigenvalues z become s = ln(z)/T, so that both kinds read alike."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from klingel.errors import InputError
from klingel.linear.blocks import eigen, lives
from klingel.linear.model import LinearModel
from klingel.linear.names import Guess, guess, numbered
from klingel.linear.shapes import Shape, Structure
from klingel.linear.sweep import Sweep
from klingel.lower import Spec, lower
from klingel.scenario import Scenario
from klingel.units import Quantity

if TYPE_CHECKING:
    import pandas as pd

STILL = 1e-4
"""Eigenvalues of smaller magnitude are those of a free position or of rounding [1/s]."""

OSCILLATES = 1e-6
"""Imaginary over absolute value from which an eigenvalue is one of an oscillation."""


@dataclass(frozen=True, eq=False)
class Mode:
    """One mode of a linear model: x(t) = Re(shape e^(eigenvalue t)).

    name: guessed from what moves, numbered where different modes would share it; eigenvalue: [1/s], that of the pair
    with positive imaginary part; shape: over the model's states, its largest motion real; bodies: body (or
    `<body>.<rotor>`, `<drive>.motor`) to its share of the kinetic energy; elements: element to its share of the elastic
    energy; parts: kind of state (bodies, rotors, dampers, actuators, drives, hold, controller) to its share in the
    eigenvalue (participation factors: the left vector times the right one, summed over the kind). Energies are means
    over a cycle. Shares sum to one, those of `elements` by their amounts as a wheelset's contacts may give energy;
    without energy there are none.
    """

    name: str
    eigenvalue: complex
    shape: Shape
    bodies: Mapping[str, float]
    elements: Mapping[str, float]
    parts: Mapping[str, float]

    @property
    def frequency(self) -> float:
        """Of the damped oscillation [Hz], zero for none."""
        return abs(self.eigenvalue.imag) / (2.0 * np.pi)

    @property
    def damping(self) -> float:
        """Damping ratio: -Re/|eigenvalue|, negative for an unstable mode; zero for a free position."""
        size = abs(self.eigenvalue)
        return -self.eigenvalue.real / size if size > STILL else 0.0

    @property
    def swings(self) -> bool:
        """Whether it oscillates visibly: with a damping ratio below 0.995."""
        return self.oscillates and self.damping < 0.995

    @property
    def oscillates(self) -> bool:
        """Whether it is one of a conjugate pair."""
        return abs(self.eigenvalue.imag) > max(OSCILLATES * abs(self.eigenvalue), STILL)


def modes(
    model: LinearModel | Scenario,
    of: Scenario | Spec | None = None,
    *,
    at: Quantity | None = None,
    controllers: bool = True,
    plant: LinearModel | None = None,
) -> tuple[Mode, ...]:
    """The modes of a linear model, oscillations first by frequency, then the others by speed of decay.

    model: a linear model of the scenario or spec `of`, or a scenario, which is then linearised (`at`, `controllers` as
    for `klingel.linearise`); plant: the continuous model beside a sampled one, for the energy in the contacts.
    Of a conjugate pair the one with positive frequency is given. Left out are the free position along the track and
    the bare memory of controllers (`klingel.linear.blocks.lives`). Errors: InputError as `klingel.linearise`, and for
    `of` being another vehicle.
    """
    if isinstance(model, Scenario):
        return _of_scenario(model, at, controllers)
    if of is None:
        remedy = "give `of`, the scenario or spec that it was made of"
        raise InputError.single("model", model.name, "does not say what its states are the motion of", remedy=remedy)
    structure = Structure(lower(of) if isinstance(of, Scenario) else of, model, plant)
    values, left, right = eigen(model)
    counted = np.flatnonzero(lives(values, model.sample_time) & (values.imag >= 0.0))
    found = list(_modes(structure, values[counted], left[:, counted], right[:, counted]))
    found.sort(key=lambda m: (not m.oscillates, m.frequency if m.oscillates else -m.eigenvalue.real))
    names = numbered([mode.name for mode in found], [mode.eigenvalue for mode in found])
    return tuple(dataclasses.replace(mode, name=name) for mode, name in zip(found, names, strict=True))


def _of_scenario(scenario: Scenario, at: Quantity | None, controllers: bool) -> tuple[Mode, ...]:
    made = Sweep(at=at, controllers=controllers)(scenario)
    return modes(made.model, made.spec, plant=made.plant)


def table(found: tuple[Mode, ...]) -> pd.DataFrame:
    """Modes as rows: name, frequency [Hz], damping ratio, real and imaginary part [1/s], main body and element."""
    import pandas as pd

    rows = [
        {
            "name": mode.name,
            "frequency": mode.frequency,
            "damping": mode.damping,
            "real": mode.eigenvalue.real,
            "imag": mode.eigenvalue.imag,
            "body": _main(mode.bodies),
            "element": _main(mode.elements),
        }
        for mode in found
    ]
    return pd.DataFrame(rows, columns=["name", "frequency", "damping", "real", "imag", "body", "element"])


def _modes(structure: Structure, values: Shape, left: Shape, right: Shape) -> list[Mode]:
    """Of eigenvalues (k) and their left and right vectors as columns."""
    shapes = _turned(structure, right)
    factors = np.conj(left) * right
    parts = {name: np.abs(factors[places].sum(axis=0)) for name, places in structure.groups.items() if len(places)}
    whole = np.sum(list(parts.values()), axis=0)
    parts = {name: share / whole for name, share in parts.items()}
    bodies, elements = structure.kinetic(shapes), structure.potential(shapes)
    found = []
    for k, s in enumerate(values):
        kinetic, potential, shares = _at(bodies, k), _at(elements, k), _at(parts, k)
        seen = Guess(structure, complex(s), shapes[:, k], shares, np.abs(factors[:, k]), kinetic)
        found.append(Mode(guess(seen), complex(s), shapes[:, k], _shares(kinetic), _shares(potential), shares))
    return found


def _at(each: Mapping[str, NDArray[np.float64]], k: int) -> dict[str, float]:
    return {name: float(values[k]) for name, values in each.items()}


def _turned(structure: Structure, shapes: Shape) -> Shape:
    """Each with its most energetic velocity real and positive, and a unit kinetic energy where it has any."""
    moving = [(e, i) for b in structure.bodies for e, i in zip(b.energies(shapes), b.rates, strict=True) if i >= 0]
    moving += [(0.25 * inertia * np.abs(shapes[i]) ** 2, i) for i, inertia in structure.rotors.values()]
    energies, places = np.array([e for e, _ in moving]), np.array([i for _, i in moving])
    most = np.where(energies.max(axis=0) > 0.0, places[energies.argmax(axis=0)], np.abs(shapes).argmax(axis=0))
    lead = shapes[most, np.arange(shapes.shape[1])]
    total = np.sum(list(structure.kinetic(shapes).values()), axis=0)
    scale = np.where(total > 0.0, np.sqrt(total), np.abs(lead))
    return np.asarray(shapes * (np.conj(lead) / np.abs(lead) / scale))


def _shares(energies: Mapping[str, float]) -> dict[str, float]:
    total = sum(abs(e) for e in energies.values())
    if not total > 0.0:
        return {}
    return dict(sorted(((k, float(e / total)) for k, e in energies.items()), key=lambda item: -abs(item[1])))


def _main(shares: Mapping[str, float]) -> str:
    return next((f"{name} {share:.0%}" for name, share in shares.items()), "")
