"""In this process, one task after the other."""

from collections.abc import Callable, Iterable, Iterator

from boatsim.sweeps.journal import Entry
from boatsim.sweeps.workers.base import Task, Work


def here(
    work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
) -> Iterator[tuple[int, Entry | None]]:
    """Carry out tasks."""
    for number, told in tasks:
        if stop():
            return
        try:
            yield number, work(told)
        except KeyboardInterrupt:  # a run that was ended early
            return
