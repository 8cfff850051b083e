"""How far a command has come: a bar with the time left on a terminal, a line for each stage elsewhere; on stderr."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING

from boatsim.errors import printable
from boatsim.progress import Report

if TYPE_CHECKING:
    from rich.progress import Progress

SELDOM = 10.0  # [s] between two lines of many tasks
Reached = Callable[
    [int, float], None
]  # told of runs: which of them, and the simulated time it has reached [s]


@contextmanager
def reporting() -> Iterator[Report]:
    """Shows what is reported within the block."""
    if sys.stderr.isatty():
        with _bar() as report:
            yield report
    else:
        yield _lines()


def _lines() -> Report:
    """A line to stderr for each stage as it begins; that of the first, in which input is refused, with the second."""
    told: list[str] = []

    def report(stage: str, share: float = 0.0, detail: str = "") -> None:
        if stage in told:  # it comes back to selecting once what was left over is judged
            return
        told.append(stage)
        for line in told if len(told) == 2 else told[-1:] if len(told) > 2 else ():
            say(line)

    return report


@contextmanager
def counting() -> Iterator[Report]:
    """Shows how far many tasks are within the block: the bar on a terminal, elsewhere a line now and then."""
    if sys.stderr.isatty():
        with _bar() as bar:
            yield bar
        return
    begun, told = monotonic(), monotonic() - SELDOM

    def report(stage: str, share: float = 0.0, detail: str = "") -> None:
        nonlocal told
        if monotonic() - told >= SELDOM or share >= 1.0:
            told = monotonic()
            left = time_left(told - begun, share) if share < 1.0 else ""
            say(f"{detail or stage}{f', {left}' if left else ''}")

    yield report


def say(line: str) -> None:
    """A line of progress to stderr."""
    print(printable(f"progress: {line}"), file=sys.stderr, flush=True)


@contextmanager
def _bar() -> Iterator[Report]:
    """A bar of the whole with what is being done, the time taken and, as far as it can be told, the time left."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
    from rich.table import Column

    left = TextColumn("{task.fields[left]}", markup=False, table_column=Column(no_wrap=True))
    rest = Column(ratio=1, no_wrap=True, overflow="ellipsis")
    what = TextColumn("{task.description}", markup=False, table_column=rest)
    bars = Progress(
        BarColumn(20),
        TimeElapsedColumn(),
        left,
        what,
        console=Console(stderr=True),
        transient=True,
        expand=True,
    )
    row = bars.add_task("", total=1.0, left="")

    def report(stage: str, share: float = 0.0, detail: str = "") -> None:
        said, taken = (
            printable(f"{stage}: {detail}" if detail else stage),
            bars.tasks[row].elapsed or 0.0,
        )
        done = max(share, bars.tasks[row].completed)
        bars.update(row, description=said, completed=done, left=time_left(taken, done))

    with _shown(bars):
        yield report


@contextmanager
def _shown(bars: "Progress") -> Iterator[None]:
    global _now
    with bars:
        _now = bars
        try:
            yield
        finally:
            _now = None


@contextmanager
def set_aside() -> Iterator[None]:
    """The bars, if there are any, make way for a question."""
    bars = _now
    if bars:
        bars.stop()
    try:
        yield
    finally:
        if bars:
            bars.start()


def time_left(elapsed: float, share: float) -> str:
    """In words, from the time [s] that a share of the work took; nothing while that says little."""
    if share < 0.05 or elapsed < 1.0:
        return ""
    seconds = elapsed * (1.0 - share) / share
    if seconds < 1.0:
        return "nearly done"
    return f"about {seconds / 60:.0f} min left" if seconds >= 90 else f"about {seconds:.0f} s left"


@contextmanager
def running(tasks: Sequence[tuple[str, float]], several: bool = True) -> Iterator[Reached]:
    """Progress of runs (name, simulated time [s]): bars on a terminal, elsewhere a line as each begins.

    Of a single one there is no line, unless it is none of `several` that might have been.
    """
    if not sys.stderr.isatty():
        yield _begun(tasks) if len(tasks) > 1 or not several else lambda number, t: None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    clock = TextColumn("{task.completed:.0f} of {task.total:.0f} s simulated")
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        clock,
        TimeElapsedColumn(),
    )
    bars = Progress(
        *columns,
        TimeRemainingColumn(),
        TextColumn("left"),
        console=Console(stderr=True),
        transient=True,
    )
    many = len(tasks) > 1
    every = bars.add_task(
        f"all {len(tasks)} runs", total=sum(duration for _, duration in tasks), visible=many
    )
    rows = [
        bars.add_task(name, total=duration, visible=not many, start=False)
        for name, duration in tasks
    ]

    def report(number: int, t: float) -> None:
        if t > 0.0 and not bars.tasks[rows[number]].started:
            bars.start_task(rows[number])
        bars.update(rows[number], completed=t, visible=not many or 0.0 < t < tasks[number][1])
        bars.update(every, completed=sum(bars.tasks[row].completed for row in rows))

    with _shown(bars):
        yield report


def _begun(tasks: Sequence[tuple[str, float]]) -> Reached:
    there: set[int] = set()

    def report(number: int, t: float) -> None:
        if number not in there and t > 0.0:
            there.add(number)
            say(
                f"{len(there)} of {len(tasks)}: {tasks[number][0]}"
                if len(tasks) > 1
                else f"running {tasks[0][0]}"
            )

    return report


_now: "Progress | None" = None
