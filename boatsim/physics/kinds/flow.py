"""Flow: water that moves over the ground."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Kind, Part, Station

FLOW = Part("flow", "p, on", ("north = east = 0.0",), "north, east")


@dataclass(frozen=True)
class Flow(Kind):
    """Water that moves under the hull: compiled `flow(values) -> (north, east)` in m/s."""

    parts: ClassVar = (FLOW,)
    laws: ClassVar[tuple[str, ...]] = ("flow",)
    flow: ClassVar[Callable[..., tuple[float, float]]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Add the velocity of the water."""
        if part is FLOW:
            for site in program.sites(number):
                yield f"a, b = {site.call('flow')}"
                yield "north += a; east += b"
