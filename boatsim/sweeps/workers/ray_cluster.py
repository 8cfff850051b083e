"""Backend of a Ray cluster; a task whose node or process is lost is restarted on another one."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from boatsim.errors import BadInput
from boatsim.physics import trust
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.workers.base import POLL, Task, Work

# Tasks submitted for each processor of the cluster, so that none waits for the next task.
AHEAD = 2
MOST_RESTARTS = 20  # of a task whose node or process is lost; nodes of a cluster may come and go


@dataclass(frozen=True)
class Cluster:
    """Backend of a running cluster; boatsim is installed on each of its nodes.

    Attributes:
        address: Address of the cluster; "auto" for the one this machine belongs to.
    """

    address: str

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

        Raises:
            BadInput: There is no cluster at the address, or Ray is not installed.
        """
        ray = _import_ray()
        try:
            ray.init(self.address, logging_level="error", log_to_driver=False)
        except (ConnectionError, RuntimeError, ValueError) as error:
            reason = " ".join(str(error).split())
            raise BadInput(
                f"--ray {self.address}: no cluster answers ({reason}); "
                "`ray start --head` starts one"
            ) from None
        try:
            yield from _perform_tasks(ray, work, tasks, stop)
        finally:
            ray.shutdown()


def _perform_tasks(
    ray: Any, work: Work, tasks: Iterable[Task], stop: Callable[[], bool]
) -> Iterator[tuple[int, Entry | None]]:
    remote = ray.remote(num_cpus=1, max_retries=MOST_RESTARTS)(_perform_task)
    trusted = trust.trusted_folder_list()
    pending = iter(tasks)
    running: dict[Any, Task] = {}
    while not stop():
        room = AHEAD * max(int(ray.cluster_resources().get("CPU", 1)), 1)
        while len(running) < room and (task := next(pending, None)):
            running[remote.remote(work, task[1], trusted)] = task
        if not running:
            return
        for done in ray.wait(list(running), num_returns=1, timeout=POLL)[0]:
            number = running.pop(done)[0]
            try:
                yield number, ray.get(done)
            except ray.exceptions.RayError as error:
                if isinstance(error, ray.exceptions.RayTaskError):
                    raise error.as_instanceof_cause() from None  # an error in boatsim
                yield number, None


def _perform_task(work: Work, argument: Any, trusted: trust.TrustedFolders) -> Entry:
    """Perform one task on a node."""
    trust.adopt_trust(trusted)
    return work(argument)


def _import_ray() -> Any:
    try:
        import ray
    except ImportError:
        raise BadInput('--ray needs Ray: pip install "boatsim[ray]"') from None
    return ray
