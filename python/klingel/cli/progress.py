"""A run with a progress bar; Ctrl-C cancels the run in the core.
The bar is drawn by a thread of its own while the main thread waits for the run."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.status import Status

from klingel import result
from klingel.scenario import Scenario

if TYPE_CHECKING:
    import xarray as xr

REFRESH = 0.1
"""Seconds between two looks at the run."""


def preparing() -> Status:
    """Something that moves while contact tables are compiled, which takes some seconds for a new pair."""
    return Console(stderr=True).status("contact table: compiling, some seconds for a new pair")


def simulate_with_bar(scenario: Scenario, title: str) -> xr.Dataset:
    """Run a scenario with a live bar of how far it is and how long it takes; errors as `klingel.simulate`."""
    watched = result.progress()
    ended = threading.Event()
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn())
    with Progress(*columns, transient=True) as bar:
        task = bar.add_task(title, total=1.0)

        def follow() -> None:
            while not ended.wait(REFRESH):
                bar.update(task, completed=watched.fraction)

        follower = threading.Thread(target=follow, daemon=True)
        follower.start()
        try:
            return result.simulate(scenario, progress=watched)
        finally:
            ended.set()
            follower.join()
