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
    """Base class of measurement errors that vary slowly and at random.

    Their compiled function is `instrument_drift(values) -> InstrumentDrift`, the rms and
    correlation time of the error. The diagnosis filter tracks the error; a simulation without data
    does not contain it.
    """

    random: ClassVar[bool] = True
    parts: ClassVar = (DRIFT,)
    laws: ClassVar = ("instrument_drift",)
    instrument_drift: ClassVar[Callable[..., InstrumentDrift]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source line that gives the noise model of the error to the diagnosis filter.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        if part is DRIFT:
            for site in program.law_calls(number):
                yield f"w = {site.text('instrument_drift')}"
