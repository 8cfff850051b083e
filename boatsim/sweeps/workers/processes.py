"""In processes of this machine. One that is killed costs its task a second try, not the campaign."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess

from boatsim.interruption import ignored_signals
from boatsim.physics import trust
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.workers.base import POLL, TRIES, Task, Work

CONTEXT = get_context("spawn")  # a fork would copy MuJoCo's threads half alive


@dataclass
class Worker:
    """A process and the task it has."""

    process: SpawnProcess
    line: Connection
    task: Task


@dataclass(frozen=True)
class Processes:
    """So many of them at the same time."""

    jobs: int

    def __call__(
        self, work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
    ) -> Iterator[tuple[int, Entry | None]]:
        """Carry out tasks, each sent to a process as soon as it has nothing to do."""
        again: deque[Task] = deque()
        ahead, begun = chain(iter(tasks)), dict[int, int]()
        there: list[Worker] = []

        def following() -> Task | None:
            task = again.popleft() if again else next(ahead, None)
            if task:
                begun[task[0]] = begun.get(task[0], 0) + 1
            return task

        try:
            while not stop():
                while len(there) < self.jobs and (task := following()):
                    there.append(_started(work, task))
                if not there:
                    return
                ready = wait([worker.line for worker in there], POLL)
                for worker in [w for w in there if w.line in ready]:
                    number = worker.task[0]
                    try:
                        yield number, worker.line.recv()
                    except (EOFError, OSError):  # it is no more
                        there.remove(worker)
                        _end(worker)
                        if begun[number] < TRIES:
                            again.append(worker.task)
                        else:
                            yield number, None
                        continue
                    if task := following():
                        worker.task = task
                        with suppress(OSError):  # told by the next look at it
                            worker.line.send(task[1])
                    else:
                        there.remove(worker)
                        _end(worker)
        finally:
            for worker in there:
                _end(worker)


def _started(work: Work, task: Task) -> Worker:
    mine, its = CONTEXT.Pipe()
    process = CONTEXT.Process(target=_serve, args=(its, work, trust.now()), daemon=True)
    with ignored_signals():  # a signal is heeded by the one that hands out; the others end with it
        process.start()
    its.close()
    with suppress(OSError):
        mine.send(task[1])
    return Worker(process, mine, task)


def _end(worker: Worker) -> None:
    worker.line.close()
    worker.process.kill()
    worker.process.join()
    worker.process.close()


def _serve(line: Connection, work: Work, trusted: trust.Trust) -> None:
    """All that a process does, until nobody is at the other end."""
    trust.adopt(trusted)
    with suppress(EOFError, OSError):
        while True:
            line.send(work(line.recv()))
