"""What every way to carry out tasks takes and gives."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Protocol

from boatsim.sweeps.journal import Entry

Work = Callable[
    [Any], Entry
]  # a function of a module, so that it can be sent; it catches what a run may raise
Task = tuple[int, Any]  # number, and what the work is told
POLL = 0.1  # [s] between two looks at whether somebody wants it to end
TRIES = 2  # times a task is begun before it is taken for what kills its process


class Backend(Protocol):
    """Carries out tasks and gives what became of each as it ends, in any order; None where its process was killed."""

    def __call__(
        self, work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
    ) -> Iterator[tuple[int, Entry | None]]:
        """Ends early once `stop` says so; what is then under way does not count."""
