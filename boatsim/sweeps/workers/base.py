"""Interface of the backends."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Protocol

from boatsim.sweeps.journal import Entry

# A function of a module, so that it can be sent to a process; it catches the errors of a task.
Work = Callable[[Any], Entry]
Task = tuple[int, Any]  # number, and argument of the work
POLL = 0.1  # [s] between two checks whether the campaign is to stop
MOST_ATTEMPTS = 2  # starts of a task before it counts as the one that kills its process


class Backend(Protocol):
    """Performs tasks."""

    def __call__(
        self, work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
    ) -> Iterator[tuple[int, Entry | None]]:
        """Yield the number and the result of each task as it finishes, in any order.

        Args:
            work: Function that performs a task.
            tasks: The tasks.
            stop: Returns whether to stop; tasks that are not finished then are dropped.

        Yields:
            Number and result; the result is None if the process of the task was killed.
        """
