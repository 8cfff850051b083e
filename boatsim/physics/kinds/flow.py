"""Flow effects: motion of the water over the ground."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Kind, Part, Station

FLOW = Part("flow", "p, on", ("north = east = 0.0",), "north, east")


@dataclass(frozen=True)
class Flow(Kind):
    """Velocity of the water: compiled `flow(values) -> (north, east)` [m/s]."""

    parts: ClassVar = (FLOW,)
    laws: ClassVar[tuple[str, ...]] = ("flow",)
    flow: ClassVar[Callable[..., tuple[float, float]]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Yield the lines that add the velocity of the water.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is FLOW:
            for site in program.sites(number):
                yield f"a, b = {site.call('flow')}"
                yield "north += a; east += b"
