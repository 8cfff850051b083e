"""Drives a reader through mutated files."""

import time
import traceback
from dataclasses import dataclass, field

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from tests.fuzz.mutate import Edit, edits
from tests.fuzz.readers import Reader


@dataclass(frozen=True)
class Broken:
    """A file that ended in another exception."""

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
    broken: list[Broken] = field(default_factory=list)

    @property
    def files(self) -> int:
        """How many there were."""
        return self.read + self.refused + len(self.broken)

    def kinds(self) -> list[Broken]:
        """The shortest file for each place at which a reader broke."""
        ordered = sorted(self.broken, key=lambda b: -len(b.content))
        return list({b.place: b for b in ordered}.values())


def drive(reader: Reader, count: int, number: int = 0) -> Found:
    """So many mutated files, the same for the same `number`."""
    found, whole = Found(), reader.seeds()
    quiet = settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )

    @seed(number)
    @quiet
    @given(st.sampled_from(whole), edits(reader.text))
    def one(content: bytes, changes: list[Edit]) -> None:
        for change in changes:
            content = change.of(content)
        begin = time.perf_counter()
        try:
            usable = reader.outcome(content)
            found.read, found.refused = found.read + usable, found.refused + (not usable)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # a panic of native code is no Exception
            found.broken.append(Broken(content, error))
        found.slowest = max(found.slowest, time.perf_counter() - begin)

    one()
    return found
