"""Many runs at once in threads, with a live progress bar; what is finished is kept, whatever happens to the rest.
Threads, because the core releases the interpreter's lock while it steps; the contact tables are shared between them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn

Result = TypeVar("Result")
Watched = TypeVar("Watched", bound="Monitor")

REFRESH = 0.1
"""The bar is redrawn, and Ctrl-C noticed, at this interval [s]."""


class Monitor(Protocol):
    """What a running simulation shows and obeys."""

    @property
    def fraction(self) -> float:
        """Share of the run that is done, 0 to 1."""
        ...

    def cancel(self) -> None:
        """Ask the run to stop at its next step."""
        ...


@dataclass(frozen=True)
class Batch(Generic[Result]):
    """What became of a batch.

    Attributes:
        done: name of each finished run to what it returned, in the order they were asked for.
        failed: name of each other run to the reason.
        interrupted: whether Ctrl-C ended the batch.
    """

    done: Mapping[str, Result]
    failed: Mapping[str, str]
    interrupted: bool


def run_all(
    tasks: Sequence[str],
    work: Callable[[str, Watched], Result],
    monitor: Callable[[], Watched],
    *,
    jobs: int | None = None,
    console: Console | None = None,
) -> Batch[Result]:
    """Work on every task, several at a time.

    Args:
        tasks: names, in the order to begin them: heaviest first keeps all threads busy to the end.
        work: does one task and returns its result; it must be safe to call from several threads.
        monitor: makes the progress object of one task.
        jobs: threads; one a processor if not given.
        console: to draw on.

    Returns:
        What is finished, and why the rest is not. A failing task does not stop the others; Ctrl-C stops all.
    """
    monitors = {task: monitor() for task in tasks}
    futures: dict[Future[Result], str] = {}
    interrupted = False
    with _bar(console) as bar, ThreadPoolExecutor(jobs or _processors()) as pool:
        line = bar.add_task("", total=float(len(tasks)), done=0, all=len(tasks))
        for task in tasks:
            futures[pool.submit(work, task, monitors[task])] = task
        try:
            _watch(futures, monitors, bar, line)
        except KeyboardInterrupt:
            interrupted = True
            pool.shutdown(wait=False, cancel_futures=True)
            for each in monitors.values():
                each.cancel()
    done, failed = {}, {}
    for future, task in futures.items():
        if future.cancelled():
            failed[task] = "not started"
        elif (error := future.exception()) is not None:
            failed[task] = "cancelled" if interrupted else f"{type(error).__name__}: {error}"
        else:
            done[task] = future.result()
    return Batch(done, failed, interrupted)


def _watch(futures: Mapping[Future[Result], str], monitors: Mapping[str, Monitor], bar: Progress, line: TaskID) -> None:
    """Draw the bar until every future is done."""
    pending = set(futures)
    while pending:
        _, pending = wait(pending, timeout=REFRESH, return_when=FIRST_COMPLETED)
        finished = len(futures) - len(pending)
        running = sum(min(monitors[futures[future]].fraction, 1.0) for future in pending)
        bar.update(line, completed=finished + running, done=finished)


def _bar(console: Console | None) -> Progress:
    return Progress(
        TextColumn("{task.fields[done]} of {task.fields[all]} runs"),
        BarColumn(bar_width=None),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
    )


def _processors() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
