"""Drives a reader through mutated files."""

import resource
import signal
import time
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from types import FrameType
from typing import Any

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from tests.fuzz.readers import Reader

PATIENCE = 10.0  # [s] for one file; a longer wait is a hang
# [s] for one file on a busy machine, where this process had less than half of the time of a core
BUSY_PATIENCE = 60.0
ROUND = 500  # files between two looks at the clock


class Hung(BaseException):
    """A reader is still at work when its time is up."""


@dataclass(frozen=True)
class Broken:
    """A file that ended in another exception, or not at all."""

    content: bytes
    error: BaseException

    @property
    def place(self) -> tuple[str, int | None]:
        """Where it was raised."""
        last = traceback.extract_tb(self.error.__traceback__)[-1]
        return last.filename, last.lineno


@dataclass
class Found:
    """What became of the files of one reader."""

    read: int = 0
    refused: int = 0
    slowest: float = 0.0  # [s]
    seconds: float = 0.0  # in all
    # [MB] by which the process grew at most beyond what it took for whole files
    memory: float = 0.0
    broken: list[Broken] = field(default_factory=list)

    @property
    def files(self) -> int:
        """How many there were."""
        return self.read + self.refused + len(self.broken)

    @property
    def hung(self) -> int:
        """How many were given up."""
        return sum(isinstance(b.error, Hung) for b in self.broken)

    def kinds(self) -> list[Broken]:
        """The shortest file for each place at which a reader broke."""
        ordered = sorted(self.broken, key=lambda b: -len(b.content))
        return list({b.place: b for b in ordered}.values())

    def figures(self) -> dict[str, float]:
        """All numbers."""
        numbers = {k: v for k, v in asdict(self).items() if k != "broken"}
        return numbers | {
            "files": self.files,
            "hung": self.hung,
            "raised": len(self.broken) - self.hung,
        }


def drive(reader: Reader, count: int, number: int = 0, seconds: float = float("inf")) -> Found:
    """So many mutated files, the same for the same `number`, or as many as there is time for."""
    found, begin = Found(), time.perf_counter()
    for content in reader.seeds():
        reader.outcome(content)
    before = _memory()
    for turn in range(number, number + 1000 * (1 + count // ROUND)):
        left = count - found.files
        if left <= 0 or found.seconds >= seconds:
            break
        _round(reader, min(left, ROUND), turn, found)
        found.seconds, found.memory = time.perf_counter() - begin, _memory() - before
    return found


def _round(reader: Reader, count: int, number: int, found: Found) -> None:
    @seed(number)
    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(st.sampled_from(reader.seeds()), reader.edits)
    def one(content: bytes, changes: list[Any]) -> None:
        for change in changes:
            content = change.of(content)
        begin = time.perf_counter()
        try:
            with _limited(PATIENCE), warnings.catch_warnings():
                warnings.simplefilter("error", RuntimeWarning)  # it would be a line of nobody's
                usable = reader.outcome(content)
            found.read, found.refused = found.read + usable, found.refused + (not usable)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # a panic of native code is no Exception
            found.broken.append(Broken(content, error))
        found.slowest = max(found.slowest, time.perf_counter() - begin)

    one()


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    """End the block by `Hung` after `seconds`, and once more every second where that is caught.

    A process that had less than half of the time of a core gets `BUSY_PATIENCE` instead: on a
    machine that does other work, starting a child process can take more than `seconds`.
    """
    begin, used = time.perf_counter(), time.process_time()

    def give_up(*_: int | FrameType | None) -> None:
        late = time.perf_counter() - begin >= BUSY_PATIENCE
        if late or time.process_time() - used >= seconds / 2:
            raise Hung

    before = signal.signal(signal.SIGALRM, give_up)
    signal.setitimer(signal.ITIMER_REAL, seconds, 1.0)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def _memory() -> float:
    """Most that the process has taken so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024  # Linux counts in KiB
