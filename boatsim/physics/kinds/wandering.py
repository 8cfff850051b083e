"""Wandering effects: measurement errors that vary slowly and at random."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import InsertionPoint, ProgramFunction, ProgramLayout
from boatsim.physics.kinds.measurement import Measurement
from boatsim.physics.signals import InstrumentDrift

DRIFT = ProgramFunction("instrument_drift", "p, on", ("w = InstrumentDrift(0.0, 0.0, 1.0)",), "w")


@dataclass(frozen=True)
class DriftingMeasurement(Measurement):
    """Slowly varying error: compiled `instrument_drift(values) -> InstrumentDrift`.

    The diagnosis filter tracks the error; a simulation without data does not contain it.
    """

    random: ClassVar[bool] = True
    parts: ClassVar = (DRIFT,)
    laws: ClassVar = ("instrument_drift",)
    instrument_drift: ClassVar[Callable[..., InstrumentDrift]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the line that sets the noise model of the error.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is DRIFT:
            for site in program.law_calls(number):
                yield f"w = {site.text('instrument_drift')}"
