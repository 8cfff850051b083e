"""Unsteady effects: forces with a random time history."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Part, Station
from boatsim.physics.kinds.force import Force
from boatsim.physics.signals import Swell

SWELL = Part("swell", "p, on", (f"s = Swell({'0.0, ' * 7}1.0)",), "s")


@dataclass(frozen=True)
class Unsteady(Force):
    """Random force: compiled `swell(values) -> Swell`, and `law` for one realisation.

    The simulator uses the realisation of `law`. The diagnosis filter tracks the oscillators of
    `swell` instead and disables the law by `realisation` = 0.
    """

    random: ClassVar[bool] = True
    parts: ClassVar = (SWELL,)
    laws: ClassVar[tuple[str, ...]] = ("law", "swell")
    swell: ClassVar[Callable[..., Swell]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Yield the line that sets the oscillators; the realisation is an ordinary force.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is SWELL:
            for site in program.sites(number):
                yield f"s = {site.call('swell')}"
