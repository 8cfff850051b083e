"""An FMU that a test drives call by call through FMPy, with the names of its variables."""

import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fmpy
from fmpy.simulation import instantiate_fmu

TYPES = {"co": "CoSimulation", "me": "ModelExchange"}


class FmuInstance:
    """One instance of an FMU of version 2 or 3.

    Attributes:
        fmu: The instance of FMPy.
        messages: What it logged.
    """

    def __init__(self, path: Path, folder: str, kind: str) -> None:
        """Instantiate the unpacked FMU."""
        description = fmpy.read_model_description(path)
        self.messages: list[str] = []
        self._references = {v.name: v.valueReference for v in description.modelVariables}
        self._two = description.fmiVersion == "2.0"
        given: dict[str, Any] = {}
        if not self._two:
            given["logger"] = lambda environment, status, category, message: self.messages.append(
                message.decode()
            )
        self.fmu = instantiate_fmu(folder, description, TYPES[kind], **given)

    def start(self, values: Mapping[str, float] | None = None, time: float = 0.0) -> None:
        """Set start values and initialise."""
        if self._two:
            self.fmu.setupExperiment(startTime=time)
            self.set(values or {})
            self.fmu.enterInitializationMode()
        else:
            self.set(values or {})
            self.fmu.enterInitializationMode(startTime=time)
        self.fmu.exitInitializationMode()

    def set(self, values: Mapping[str, float]) -> None:
        """Set variables by name."""
        references = [self._references[name] for name in values]
        write = self.fmu.setReal if self._two else self.fmu.setFloat64
        if references:
            write(references, list(values.values()))

    def get(self, *names: str) -> list[float]:
        """Read variables by name."""
        read = self.fmu.getReal if self._two else self.fmu.getFloat64
        return list(read([self._references[name] for name in names]))

    def step(self, now: float, length: float) -> None:
        """Make a communication step."""
        self.fmu.doStep(now, length)

    def states(self) -> tuple[Any, bytes]:
        """A stored state and its bytes."""
        if self._two:
            state = self.fmu.getFMUstate()
            return state, bytes(self.fmu.serializeFMUstate(state))
        state = self.fmu.getFMUState()
        return state, bytes(self.fmu.serializeFMUState(state))

    def restore(self, state: Any) -> None:
        """Go back to a stored state."""
        (self.fmu.setFMUstate if self._two else self.fmu.setFMUState)(state)

    def from_bytes(self, content: bytes) -> Any:
        """A stored state from its bytes."""
        if self._two:
            return self.fmu.deSerializeFMUstate(content)
        return self.fmu.deserializeFMUState(content)


@contextmanager
def opened(path: Path, kind: str = "co") -> Iterator[FmuInstance]:
    """An instance of an FMU, which is freed after the block."""
    folder = fmpy.extract(str(path))
    instance = FmuInstance(path, folder, kind)
    try:
        yield instance
    finally:
        instance.fmu.freeInstance()
        shutil.rmtree(folder, ignore_errors=True)


def simulated(
    path: Path,
    commands: Sequence[Mapping[str, float]],
    interval: float,
    names: Sequence[str],
    start: Mapping[str, float] | None = None,
) -> list[list[float]]:
    """Variables at the end of each communication step with the commands of that step.

    The actuators begin settled at the first commands.
    """
    rows = []
    with opened(path) as boat:
        boat.start({**commands[0], **(start or {})})
        for i, given in enumerate(commands):
            boat.set(given)
            boat.step(i * interval, interval)
            rows.append(boat.get(*names))
    return rows
