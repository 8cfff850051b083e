"""Backend of parallel processes; the task of a process that is killed is started once more."""

from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from operator import attrgetter

from boatsim.interruption import ignored_signals
from boatsim.physics import trust
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.workers.base import MOST_ATTEMPTS, POLL, Task, Work

# A forked process would inherit locks of the threads of MuJoCo.
CONTEXT = get_context("spawn")


@dataclass
class Worker:
    """A process with its present task.

    Attributes:
        process: The process.
        pipe: Connection to it.
        task: Its present task.
    """

    process: SpawnProcess
    pipe: Connection
    task: Task

    def start_task(self, task: Task) -> None:
        """Send a task to the process, unless it has died.

        Args:
            task: The task.
        """
        self.task = task
        with suppress(OSError):  # If the process has died, `recv` raises next.
            self.pipe.send(task[1])


@dataclass(frozen=True)
class Processes:
    """Backend of parallel processes.

    Attributes:
        jobs: Number of processes.
    """

    jobs: int

    def __call__(
        self, work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
    ) -> Iterator[tuple[int, Entry | None]]:
        """Perform tasks; see `Backend`.

        Args:
            work: Function that performs a task.
            tasks: The tasks.
            stop: Returns whether to stop.

        Yields:
            Number and result of each task.
        """
        pending = iter(tasks)
        repeated: deque[Task] = deque()
        attempts: Counter[int] = Counter()
        workers: list[Worker] = []

        def next_task() -> Task | None:
            task = repeated.popleft() if repeated else next(pending, None)
            if task:
                attempts[task[0]] += 1
            return task

        try:
            while not stop():
                while len(workers) < self.jobs and (task := next_task()):
                    workers.append(_start_worker(work, task))
                if not workers:
                    return
                ready = wait(list(map(attrgetter("pipe"), workers)), POLL)
                for worker in [worker for worker in workers if worker.pipe in ready]:
                    number = worker.task[0]
                    try:
                        yield number, worker.pipe.recv()
                    except (EOFError, OSError):  # The process has died.
                        workers.remove(worker)
                        _stop_worker(worker)
                        if attempts[number] < MOST_ATTEMPTS:
                            repeated.append(worker.task)
                        else:
                            yield number, None
                        continue
                    if task := next_task():
                        worker.start_task(task)
                    else:
                        workers.remove(worker)
                        _stop_worker(worker)
        finally:
            for worker in workers:
                _stop_worker(worker)


def _start_worker(work: Work, task: Task) -> Worker:
    own, other = CONTEXT.Pipe()
    process = CONTEXT.Process(
        target=_worker_main, args=(other, work, trust.trusted_folder_list()), daemon=True
    )
    with ignored_signals():  # Only the parent process handles signals; the workers end with it.
        process.start()
    other.close()
    worker = Worker(process, own, task)
    worker.start_task(task)
    return worker


def _stop_worker(worker: Worker) -> None:
    worker.pipe.close()
    worker.process.kill()
    worker.process.join()
    worker.process.close()


def _worker_main(pipe: Connection, work: Work, trusted: trust.TrustedFolders) -> None:
    """Main function of a process: perform tasks until the other end of the pipe is closed."""
    trust.adopt_trust(trusted)
    with suppress(EOFError, OSError):
        while True:
            pipe.send(work(pipe.recv()))
