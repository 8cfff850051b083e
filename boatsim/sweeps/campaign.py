"""Many tasks in a folder: what is done stays done, what is left is handed out, what fails is told and ends nothing."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any

from boatsim.interruption import deferred_signals
from boatsim.progress import Report, silent
from boatsim.sweeps.journal import Entry, Journal
from boatsim.sweeps.workers.base import Backend, Task, Work

KILLED = "its process was killed (out of memory?)"


@dataclass(frozen=True)
class Outcome:
    """What became of a campaign."""

    entries: Mapping[int, Entry]  # by the number of the task, in that order
    whole: bool  # False: it was interrupted

    @property
    def failed(self) -> int:
        """How many tasks failed."""
        return sum(entry["failure"] is not None for entry in self.entries.values())


def carry_out(
    folder: Path,
    about: Mapping[str, Any],
    count: int,
    tasks: Iterable[Task],
    work: Work,
    backend: Backend,
    what: str,
    report: Report = silent,
) -> Outcome:
    """Carry out those of `count` tasks that are not done yet; no other campaign than `about` goes on with them.

    `what` is the word for several of them. An interruption keeps what is done. Raises BadInput and OSError.
    """
    with Journal(folder, about) as journal, deferred_signals() as stop:
        before, begun = len(journal.done), monotonic()
        failed = sum(entry["failure"] is not None for entry in journal.done.values())
        left = (task for task in tasks if task[0] not in journal.done)
        for number, entry in backend(work, left, stop) if before < count else ():
            entry = entry if entry is not None else {"failure": KILLED}
            journal.add(number, entry)
            failed += entry["failure"] is not None
            done = len(journal.done) - before
            rate = done / max(monotonic() - begun, 1e-9)
            report(
                what, done / (count - before), _told(len(journal.done), count, what, rate, failed)
            )
            if stop():
                break
        stop.finishing = True
        entries = {number: journal.done[number] for number in sorted(journal.done)}
    return Outcome(entries, len(entries) == count)


def _told(done: int, count: int, what: str, rate: float, failed: int) -> str:
    """How far it has come, in words."""
    often = f"{rate:.3g} a second" if rate >= 1.0 else f"{60.0 * rate:.3g} a minute"
    return f"{done} of {count} {what}, {often}{f', {failed} failed' if failed else ''}"
