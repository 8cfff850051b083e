"""On a Ray cluster. A task whose node or process is lost is begun anew on another one."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from boatsim.errors import BadInput
from boatsim.physics import trust
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.workers.base import POLL, Task, Work

AHEAD = 2  # tasks handed out for each processor of the cluster
NODES_LOST = 20  # times a task may lose its node or process before it counts as lost itself


@dataclass(frozen=True)
class Cluster:
    """A cluster that runs; boatsim is installed on each of its nodes."""

    address: str  # "auto": the one that this machine belongs to

    def __call__(
        self, work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
    ) -> Iterator[tuple[int, Entry | None]]:
        """Carry out tasks, a few for each processor at a time."""
        ray = _ray()
        try:
            ray.init(self.address, logging_level="error", log_to_driver=False)
        except (ConnectionError, RuntimeError, ValueError) as error:
            said = " ".join(str(error).split())
            raise BadInput(
                f"--ray {self.address}: no cluster answers ({said}); `ray start --head` begins one"
            ) from None
        try:
            yield from _carried_out(ray, work, tasks, stop)
        finally:
            ray.shutdown()


def _carried_out(
    ray: Any, work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
) -> Iterator[tuple[int, Entry | None]]:
    remote = ray.remote(num_cpus=1, max_retries=NODES_LOST)(_work)
    trusted, ahead = trust.now(), iter(tasks)
    under_way: dict[Any, Task] = {}
    while not stop():
        room = AHEAD * max(int(ray.cluster_resources().get("CPU", 1)), 1)
        while len(under_way) < room and (task := next(ahead, None)):
            under_way[remote.remote(work, task[1], trusted)] = task
        if not under_way:
            return
        for done in ray.wait(list(under_way), num_returns=1, timeout=POLL)[0]:
            number = under_way.pop(done)[0]
            try:
                yield number, ray.get(done)
            except ray.exceptions.RayError as error:
                if isinstance(error, ray.exceptions.RayTaskError):
                    raise error.as_instanceof_cause() from None  # a defect
                yield number, None


def _work(work: Work, told: Any, trusted: trust.Trust) -> Entry:
    """One task, on whatever node."""
    trust.adopt(trusted)
    return work(told)


def _ray() -> Any:
    try:
        import ray
    except ImportError:
        raise BadInput('--ray needs Ray: pip install "boatsim[ray]"') from None
    return ray
