"""Measurement effects: differences between the recorded and the true motion."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Kind, Part, Station
from boatsim.physics.signals import Shown

SHOWN = Part("shown", "m, p, on", ("pass",), "m")
DISTORTED = Part("distorted", "on", ("found = False",), "found")
LATE = Part("late", "p, on", ("seconds = 0.0",), "seconds")


@dataclass(frozen=True)
class Measurement(Kind):
    """Error of a recording: compiled `shown(Shown, values) -> Shown`.

    It acts in the diagnosis filter and in `replay`, not on the simulated boat. `late(values)`, if
    defined, is the latency [s] of the recorded motion behind the recorded commands (negative:
    early).
    """

    kind: ClassVar[str] = "measurement"
    parts: ClassVar[tuple[Part, ...]] = (SHOWN, DISTORTED, LATE)
    laws: ClassVar[tuple[str, ...]] = ("shown", "late")
    of_columns: ClassVar[
        tuple[str, ...]
    ] = ()  # recorded columns that it changes; one of them must exist
    shown: ClassVar[Callable[..., Shown] | None] = None
    late: ClassVar[Callable[..., float] | None] = None

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Yield the lines that change the recorded motion, mark it as changed and add its latency.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        effect = program.effects[number]
        if not isinstance(effect, Measurement):
            return
        kind = type(effect)
        for site in program.sites(number):
            if part is SHOWN and kind.shown is not None:
                yield f"m = {site.call('shown', 'm')}"
            if part is DISTORTED and kind.shown is not None:
                yield "found = True"
            if part is LATE and kind.late is not None:
                yield f"seconds += {site.call('late')}"
