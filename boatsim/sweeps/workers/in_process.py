"""Backend that performs the tasks in this process, one after the other."""

from collections.abc import Callable, Iterable, Iterator

from boatsim.sweeps.journal import Entry
from boatsim.sweeps.workers.base import Task, Work


def run_in_this_process(
    work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
) -> Iterator[tuple[int, Entry | None]]:
    """Perform tasks one after another in this process; see `Backend`.

    Args:
        work: Function that performs a task.
        tasks: The tasks.
        stop: Returns whether to stop.

    Yields:
        Number and result of each task.
    """
    for number, argument in tasks:
        if stop():
            return
        try:
            yield number, work(argument)
        except KeyboardInterrupt:  # The task was interrupted.
            return
