"""Wandering effects: measurement errors that vary slowly and at random."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Part, Station
from boatsim.physics.kinds.measurement import Measurement
from boatsim.physics.signals import Wander

WANDER = Part("wander", "p, on", ("w = Wander(0.0, 0.0, 1.0)",), "w")


@dataclass(frozen=True)
class Wandering(Measurement):
    """Slowly varying error: compiled `wander(values) -> Wander`.

    The diagnosis filter tracks the error; a simulation without data does not contain it.
    """

    random: ClassVar[bool] = True
    parts: ClassVar = (WANDER,)
    laws: ClassVar = ("wander",)
    wander: ClassVar[Callable[..., Wander]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Yield the line that sets the noise model of the error.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is WANDER:
            for site in program.sites(number):
                yield f"w = {site.call('wander')}"
