"""Measurement: what a recording shows differs from what the boat did."""

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
    """Compiled `shown(Shown, values) -> Shown`.

    Acts in the diagnosis filter and in `replay`; the simulated boat itself does not feel it. `late(values)`, where
    there is one, is the time [s] by which the recorded motion is late behind the recorded commands (negative: early).
    """

    kind: ClassVar[str] = "measurement"
    parts: ClassVar[tuple[Part, ...]] = (SHOWN, DISTORTED, LATE)
    laws: ClassVar[tuple[str, ...]] = ("shown", "late")
    of_columns: ClassVar[tuple[str, ...]] = ()  # recorded columns in which it shows, any of them
    shown: ClassVar[Callable[..., Shown] | None] = None
    late: ClassVar[Callable[..., float] | None] = None

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Change what is shown, say that it is changed, add up how late it comes."""
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
