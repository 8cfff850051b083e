"""Force: what the water, the air or a machine does to the hull, as a function of its motion."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Kind, Part, Station
from boatsim.physics.signals import Motion, Wrench

COMPONENTS = Wrench._fields
ADD = "; ".join(f"{c} += f.{c}" for c in COMPONENTS)
WRENCH = Part(
    "wrench",
    "m, p, on, act, at",
    (f"{' = '.join(COMPONENTS)} = 0.0",),
    f"Wrench({', '.join(COMPONENTS)})",
    compiled="merged",
)


@dataclass(frozen=True)
class Force(Kind):
    """Memoryless force: compiled `law(motion, values) -> Wrench`.

    With `roles` the law takes the bound signals as a third argument; an effect that `rides` on an idea is called once
    for each of its instances, with that one's signals and values. An idea that is another besides (a propeller is a
    thruster) gives its signals as that one's by a compiled function `as_` and that one's name, of its own two.
    """

    parts: ClassVar = (WRENCH,)
    laws: ClassVar[tuple[str, ...]] = ("law", "as_thruster")
    of_air: ClassVar[bool] = False  # a force of the air, which a run logs apart
    # what it holds on to beside the water: "the air", "walls"; empty: nothing
    anchored: ClassVar[str] = ""
    law: ClassVar[Callable[..., Wrench]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Add the law's force to the sum."""
        if part is WRENCH:
            for site in program.sites(number):
                yield f"f = {site.call('law', 'm')}"
                yield ADD

    def wrench(self, m: Motion, *given: tuple[float, ...], **signals: float) -> Wrench:
        """The force at one motion, its roles at these signals; what it rides on gives it signals and values instead."""
        own = (type(self).signals(**signals),) if type(self).roles and not given else ()
        return Wrench(*type(self).law(m, self.values(), *given, *own))
