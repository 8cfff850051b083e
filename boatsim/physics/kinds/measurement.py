"""Measurement effects: differences between the recorded and the true motion."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout
from boatsim.physics.signals import MeasuredMotion

APPLY_ERRORS = ProgramFunction(
    "apply_measurement_errors", "m, t, p, on", ("pass",), "m", compiled="merged"
)
HAS_ERRORS = ProgramFunction("has_measurement_errors", "on", ("found = False",), "found")
MOTION_LATENCY = ProgramFunction("motion_latency", "p, on", ("seconds = 0.0",), "seconds")


@dataclass(frozen=True)
class Measurement(EffectKind):
    """Base class of measurement errors: differences between recorded and true motion.

    `apply_measurement_error(motion, values)`, compiled, takes and returns a `MeasuredMotion`. It
    acts in the diagnosis filter and in `replay`, not on the simulated boat. With `uses_time` it is
    `apply_measurement_error(motion, time, values)`; time is that since the first row [s].
    `motion_latency(values)`, if defined, is the latency [s] of the recorded motion behind the
    recorded commands (negative: early).
    """

    kind: ClassVar[str] = "measurement"
    parts: ClassVar[tuple[ProgramFunction, ...]] = (APPLY_ERRORS, HAS_ERRORS, MOTION_LATENCY)
    laws: ClassVar[tuple[str, ...]] = ("apply_measurement_error", "motion_latency")
    of_columns: ClassVar[
        tuple[str, ...]
    ] = ()  # recorded columns that it changes; one of them must exist
    # columns without which it is no candidate and is not compiled; all of them must be recorded
    needs_columns: ClassVar[tuple[str, ...]] = ()
    uses_time: ClassVar[bool] = False  # its law also takes the time since the first row
    apply_measurement_error: ClassVar[Callable[..., MeasuredMotion] | None] = None
    motion_latency: ClassVar[Callable[..., float] | None] = None

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines by which a measurement error changes the predicted recording.

        They apply the error to the motion, report that there is an error, and add its latency.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        effect = program.effects[number]
        if not isinstance(effect, Measurement):
            return
        kind = type(effect)
        motion = ("m", "t") if kind.uses_time else ("m",)
        for site in program.law_calls(number):
            if part is APPLY_ERRORS and kind.apply_measurement_error is not None:
                yield f"m = {site.text('apply_measurement_error', *motion)}"
            if part is HAS_ERRORS and kind.apply_measurement_error is not None:
                yield "found = True"
            if part is MOTION_LATENCY and kind.motion_latency is not None:
                yield f"seconds += {site.text('motion_latency')}"
