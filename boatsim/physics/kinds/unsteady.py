"""Unsteady force: one with a random course in time."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Part, Station
from boatsim.physics.kinds.force import Force
from boatsim.physics.signals import Swell

SWELL = Part("swell", "p, on", (f"s = Swell({'0.0, ' * 7}1.0)",), "s")


@dataclass(frozen=True)
class Unsteady(Force):
    """Compiled `swell(values) -> Swell`, and `law` for one realisation.

    The simulator feels the realisation that `law` gives; the diagnosis filter follows the oscillators of `swell`
    instead and silences the law by setting the parameter `realisation` to 0.
    """

    random: ClassVar[bool] = True
    parts: ClassVar = (SWELL,)
    laws: ClassVar[tuple[str, ...]] = ("law", "swell")
    swell: ClassVar[Callable[..., Swell]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Say what the oscillators are; the realisation is a force like any other."""
        if part is SWELL:
            for site in program.sites(number):
                yield f"s = {site.call('swell')}"
