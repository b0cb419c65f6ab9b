"""Cost of linear models and root loci on one core: CPU time, and that over the eigenvectors of a random matrix.
Run with `make bench`; clocks of machines vary, the ratio to work of the same kind in the same moment varies less."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

import klingel as kl
from klingel.linear import root_locus
from klingel.linear.operating import solve, steady_spec

VEHICLES: dict[str, tuple[str, Any]] = {
    "passive coach": ("manchester_coach", None),
    "no strategy": ("mechatronic_irw", None),
    "solid-like": ("mechatronic_irw", kl.control.SolidLike()),
    "irw-like": ("mechatronic_irw", kl.control.IRWLike()),
}
SPEEDS = np.linspace(30.0, 75.0, 100)
REPEATS = 20
YARDSTICK = np.random.default_rng(1).normal(size=(160, 160))


def seconds(work: Callable[[], object]) -> float:
    """CPU time of one go [s]."""
    start = time.process_time()
    work()
    return time.process_time() - start


def yardstick() -> float:
    """CPU time of the eigenvectors of a random matrix of order 160 [s]."""
    return seconds(lambda: np.linalg.eig(YARDSTICK))


def scenario(name: str) -> kl.Scenario:
    vehicle, control = VEHICLES[name]
    return kl.Scenario(kl.library.vehicle(vehicle), kl.Track.straight("1 km"), speed="160 km/h", control=control)


def linearised(name: str) -> tuple[float, float]:
    """Of the core's linear model at a known steady state: median CPU time [s], and that over the yardstick."""
    point = solve(steady_spec(scenario(name)))
    point.linearise()
    both = np.array([(seconds(point.linearise), yardstick()) for _ in range(REPEATS)])
    return float(np.median(both[:, 0])), float(np.median(both[:, 0] / both[:, 1]))


def swept(name: str) -> tuple[float, float]:
    """Of a root locus over 100 speeds: CPU time [s], and that over the yardstick, which is used after every speed."""
    root_locus(scenario(name), "speed", SPEEDS[:2])
    yards: list[float] = []
    whole = seconds(lambda: root_locus(scenario(name), "speed", SPEEDS, step=lambda _, __: yards.append(yardstick())))
    own = whole - sum(yards)
    return own, own / float(np.median(yards))


def main() -> None:
    """Print one row a vehicle."""
    print(f"{'':<16}{'linear model':>16}{'/ eig 160':>12}{'100 speeds':>14}{'/ eig 160':>12}")
    for name in VEHICLES:
        model, model_ratio = linearised(name)
        locus, locus_ratio = swept(name)
        print(f"{name:<16}{1e3 * model:>13.2f} ms{model_ratio:>12.3f}{locus:>12.2f} s{locus_ratio:>12.0f}")


if __name__ == "__main__":
    main()
