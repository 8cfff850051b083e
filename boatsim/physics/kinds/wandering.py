"""Wandering measurement: an instrument whose error comes and goes slowly."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Part, Station
from boatsim.physics.kinds.measurement import Measurement
from boatsim.physics.signals import Wander

WANDER = Part("wander", "p, on", ("w = Wander(0.0, 0.0, 1.0)",), "w")


@dataclass(frozen=True)
class Wandering(Measurement):
    """Compiled `wander(values) -> Wander`: the diagnosis filter follows the error, a free run knows nothing of it."""

    random: ClassVar[bool] = True
    parts: ClassVar = (WANDER,)
    laws: ClassVar = ("wander",)
    wander: ClassVar[Callable[..., Wander]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Say how the error wanders."""
        if part is WANDER:
            for site in program.sites(number):
                yield f"w = {site.call('wander')}"
