"""Reaction: a force that depends on the others."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Kind, Part, Station
from boatsim.physics.kinds.force import ADD, COMPONENTS, WRENCH
from boatsim.physics.signals import Wrench

SO_FAR = f"Wrench({', '.join(COMPONENTS)})"


@dataclass(frozen=True)
class Reaction(Kind):
    """Compiled `reaction(motion, wrench, values) -> Wrench`.

    `wrench` is the sum of all laws that stand before it: the vessel's own in the order of its file, then the suspects.
    """

    laws: ClassVar[tuple[str, ...]] = ("reaction",)
    reaction: ClassVar[Callable[..., Wrench]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Add what the sum so far brings about."""
        if part is WRENCH:
            for site in program.sites(number):
                yield f"f = {site.call('reaction', 'm', SO_FAR)}"
                yield ADD
