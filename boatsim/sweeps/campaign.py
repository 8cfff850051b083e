"""Campaign: many tasks in one folder; finished tasks are kept, and failures stop nothing."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any

from boatsim.interruption import deferred_signals
from boatsim.progress import Report, ignore_progress
from boatsim.sweeps.entries import AnyEntry
from boatsim.sweeps.journal import Entry, Journal
from boatsim.sweeps.workers.base import Backend, Task, Work

KILLED = "its process was killed (out of memory?)"


@dataclass(frozen=True)
class Outcome:
    """Results of the finished tasks of a campaign, such as a sweep of runs.

    Attributes:
        entries: Result of each finished task, by the number of the task in ascending order.
        complete: Whether all tasks are finished.
    """

    entries: Mapping[int, Entry]
    complete: bool

    @property
    def failed_count(self) -> int:
        """Number of tasks of the campaign that failed."""
        return sum(entry["failure"] is not None for entry in self.entries.values())


@dataclass(frozen=True)
class Campaign:
    """Many similar tasks, such as the runs of a sweep, whose results are stored in one folder.

    Attributes:
        folder: Folder with the journal of finished tasks.
        about: Definition of the campaign; another one cannot continue in the folder.
        count: Number of tasks.
        tasks: Number and argument of each task.
        work: Function that performs a task.
        label: Word for several tasks, in progress messages.
        form: Form of the results.
    """

    folder: Path
    about: Mapping[str, Any]
    count: int
    tasks: Iterable[Task]
    work: Work
    label: str
    form: type[AnyEntry] = AnyEntry


def run_campaign(campaign: Campaign, backend: Backend, report: Report = ignore_progress) -> Outcome:
    """Perform the tasks of a campaign that are not finished yet, and return all results.

    Args:
        campaign: The campaign.
        backend: Performs the tasks.
        report: Function to call with the progress.

    Raises:
        BadInput: The folder belongs to another campaign or is in use, or its journal is damaged.
        OSError: The journal cannot be written.
    """
    count = campaign.count
    opened = Journal(campaign.folder, campaign.about, campaign.form, count)
    with opened as journal, deferred_signals() as stop:
        before = len(journal.done)
        start = monotonic()
        failed = sum(entry["failure"] is not None for entry in journal.done.values())
        pending = (task for task in campaign.tasks if task[0] not in journal.done)
        results = backend(campaign.work, pending, stop) if before < count else ()
        for number, result in results:
            entry = {"failure": KILLED} if result is None else result
            journal.append_result(number, entry)
            failed += entry["failure"] is not None
            done = len(journal.done)
            rate = (done - before) / max(monotonic() - start, 1e-9)
            detail = f"{done} of {count} {campaign.label}, {_format_rate(rate)}"
            if failed:
                detail = f"{detail}, {failed} failed"
            report(campaign.label, (done - before) / (count - before), detail)
            if stop():
                break
        stop.finish()
        entries = dict(sorted(journal.done.items()))
    return Outcome(entries, len(entries) == count)


def _format_rate(rate: float) -> str:
    """Tasks per unit of time; `rate` is in 1/s."""
    if rate >= 1.0:
        return f"{rate:.3g} a second"
    return f"{60.0 * rate:.3g} a minute"
