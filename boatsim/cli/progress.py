"""Progress of a command on stderr: a bar with the time left on a terminal, else lines of text."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING

from boatsim.errors import escape_for_terminal
from boatsim.progress import Report

if TYPE_CHECKING:
    from rich.progress import Progress

LINE_INTERVAL = 10.0  # [s] between two lines of a campaign, so that a log of it stays short
STAGE_INTERVAL = 30.0  # [s] between two lines of one stage, for the same reason
SMALLEST_SHARE = 0.05  # of the work, below which an estimate of the time left is unreliable
SHORTEST_TIME = 1.0  # [s] of work, below which an estimate of the time left is unreliable
# Called with the index of a run and the simulated time it has reached [s].
RunReport = Callable[[int, float], None]

_active: "Progress | None" = None  # bar on the terminal, which a question interrupts


@contextmanager
def report_stages() -> Iterator[Report]:
    """Show the progress of one computation within the block: a bar, or one line per stage.

    Yields:
        Function to call with the stage, the fraction of the work done, and a detail.
    """
    if sys.stderr.isatty():
        with _show_bar() as report:
            yield report
    else:
        yield _report_lines()


def _report_lines() -> Report:
    """Report that prints each stage once, the first together with the second.

    Wrong input is refused in the first stage, and then only the error is printed. In a long stage
    the elapsed time and the time left are printed now and then.
    """
    stages: list[str] = []
    start = last_line = monotonic()

    def print_stage_line(stage: str, share: float = 0.0, detail: str = "") -> None:
        nonlocal last_line
        now = monotonic()
        if stage in stages:  # The selection of effects is repeated after the validation.
            if now - last_line >= STAGE_INTERVAL:
                last_line = now
                left = time_left(now - start, share)
                print_progress(", ".join(filter(None, (f"{now - start:.0f} s so far", left))))
            return
        stages.append(stage)
        last_line = now
        if len(stages) == 2:
            print_progress(stages[0])
        if len(stages) > 1:
            print_progress(stage)

    return print_stage_line


@contextmanager
def show_task_progress() -> Iterator[Report]:
    """Show the progress of many tasks within the block: a bar, or a line every few seconds.

    Yields:
        Function to call with the stage, the fraction of the tasks done, and a detail.
    """
    if sys.stderr.isatty():
        with _show_bar(_Pace()) as bar:
            yield bar
        return
    last_line = monotonic() - LINE_INTERVAL
    paced = _Pace()

    def print_progress_line(stage: str, share: float = 0.0, detail: str = "") -> None:
        nonlocal last_line
        paced.record_share_done(share)
        if monotonic() - last_line < LINE_INTERVAL and share < 1.0:
            return
        last_line = monotonic()
        line = detail or stage
        left = paced.time_left(share)
        if left and share < 1.0:
            line = f"{line}, {left}"
        print_progress(line)

    yield print_progress_line


class _Pace:
    """Time left of many tasks, counted from the end of the first, which waits for compilation."""

    def __init__(self) -> None:
        self.first: tuple[float, float] | None = None  # time [s] and share of the work done

    def record_share_done(self, share: float) -> None:
        """Record the share of the work that is done now, for an estimate of the remaining time."""
        if self.first is None and share > 0.0:
            self.first = (monotonic(), share)

    def time_left(self, share: float) -> str:
        """Return the estimated remaining time in words; "" where an estimate is unreliable."""
        if self.first is None:
            return ""
        begun, before = self.first
        return time_left(monotonic() - begun, (share - before) / max(1.0 - before, 1e-9))


def print_progress(line: str) -> None:
    """Print a line about the progress of a command to stderr.

    Args:
        line: The line.
    """
    print(escape_for_terminal(f"progress: {line}"), file=sys.stderr, flush=True)


@contextmanager
def _show_bar(paced: "_Pace | None" = None) -> Iterator[Report]:
    """Progress bar with the present stage, the elapsed time and the time left."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
    from rich.table import Column

    left = TextColumn("{task.fields[left]}", markup=False, table_column=Column(no_wrap=True))
    rest = Column(ratio=1, no_wrap=True, overflow="ellipsis")
    bars = Progress(
        BarColumn(20),
        TimeElapsedColumn(),
        left,
        TextColumn("{task.description}", markup=False, table_column=rest),
        console=Console(stderr=True),
        transient=True,
        expand=True,
    )
    row = bars.add_task("", total=1.0, left="")

    def update_bar(stage: str, share: float = 0.0, detail: str = "") -> None:
        words = stage
        if detail:
            words += f": {detail}"
        elapsed = bars.tasks[row].elapsed or 0.0
        done = max(share, bars.tasks[row].completed)
        left = time_left(elapsed, done)
        if paced:
            paced.record_share_done(done)
            left = paced.time_left(done)
        bars.update(row, description=escape_for_terminal(words), completed=done, left=left)

    with _activate(bars):
        yield update_bar


@contextmanager
def _activate(bars: "Progress") -> Iterator[None]:
    global _active
    with bars:
        _active = bars
        try:
            yield
        finally:
            _active = None


@contextmanager
def pause_progress() -> Iterator[None]:
    """Hide the progress bar on the terminal, if there is one, within the block."""
    bars = _active
    if bars:
        bars.stop()
    try:
        yield
    finally:
        if bars:
            bars.start()


def time_left(elapsed: float, share: float) -> str:
    """Return the estimated remaining time of a computation in words.

    The result is "" where an estimate is unreliable.

    Args:
        elapsed: Time that the work has taken so far [s].
        share: Fraction of the work done, 0 to 1.
    """
    if share < SMALLEST_SHARE or elapsed < SHORTEST_TIME:
        return ""
    seconds = elapsed * (1.0 - share) / share
    if seconds < 1.0:
        return "nearly done"
    if seconds >= 90:
        return f"about {seconds / 60:.0f} min left"
    return f"about {seconds:.0f} s left"


@contextmanager
def report_runs(tasks: Sequence[tuple[str, float]], several: bool = True) -> Iterator[RunReport]:
    """Show the progress of several runs within the block: bars, or one line as each run starts.

    Args:
        tasks: Name and simulated duration [s] of each run.
        several: Whether the command accepts several runs; if so, a single run gets no line.

    Yields:
        Function to call with the index of a run and the simulated time it has reached [s].
    """
    if not sys.stderr.isatty():
        silent = several and len(tasks) == 1
        yield _ignore_progress if silent else _report_starts(tasks)
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    bars = Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.completed:.0f} of {task.total:.0f} s simulated"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        TextColumn("left"),
        console=Console(stderr=True),
        transient=True,
    )
    many = len(tasks) > 1
    total = sum(duration for _, duration in tasks)
    all_runs = bars.add_task(f"all {len(tasks)} runs", total=total, visible=many)
    rows = []
    for name, duration in tasks:
        rows.append(bars.add_task(name, total=duration, visible=not many, start=False))

    def update_run_bars(index: int, t: float) -> None:
        row = rows[index]
        if t > 0.0 and not bars.tasks[row].started:
            bars.start_task(row)
        running = 0.0 < t < tasks[index][1]
        bars.update(row, completed=t, visible=running or not many)
        bars.update(all_runs, completed=sum(bars.tasks[one].completed for one in rows))

    with _activate(bars):
        yield update_run_bars


def _ignore_progress(index: int, t: float) -> None:
    """Report nothing."""


def _report_starts(tasks: Sequence[tuple[str, float]]) -> RunReport:
    started: set[int] = set()

    def print_run_start(index: int, t: float) -> None:
        if index in started or t <= 0.0:
            return
        started.add(index)
        name = tasks[index][0]
        if len(tasks) > 1:
            print_progress(f"{len(started)} of {len(tasks)}: {name}")
        else:
            print_progress(f"running {name}")

    return print_run_start
