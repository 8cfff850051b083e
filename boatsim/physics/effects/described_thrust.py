"""Described thrust: a share by which drives push more or less than stated, for a cause that no entry is."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import terms
from boatsim.physics.base import Boat, Wrench, param
from boatsim.physics.described_laws import Described
from boatsim.physics.effects.thruster import at_mount
from boatsim.physics.param import code

SIDES = {"all": 0.0, "port": -1.0, "starboard": 1.0}
SENSES = {"both": 0.0, "ahead": 1.0, "astern": -1.0}


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any, act: Any, at: Any, own: Any) -> Wrench:
    """Each drive's thrust times coefficient, factors and course, on the side and in the sense it is about."""
    thrust = t.gain * s.thrust
    about = (q.where == 0.0 or q.where * t.y > 0.0) and q.way * thrust >= 0.0
    return at_mount(q.coefficient * terms.term(m, q, act, at, own) * thrust if about else 0.0, s, t)


@dataclass(frozen=True)
class DescribedThrust(Described):
    """One term of a law about the drives: their thrust is off by a share, always or for a while."""

    words: ClassVar[str] = "a change of thrust that no entry of the library explains"
    shown_by: ClassVar[str] = "the same command again and again"
    rides: ClassVar[str] = "thruster"
    law: ClassVar = law

    side: str = "all"  # which of `SIDES`
    sense: str = "both"  # which of `SENSES`
    coefficient: float = param(
        0.0,
        low=-1e9,
        high=1e9,
        unit="",
        words="share of the thrust per product of the factors [SI]",
        fit=True,
        spread=0.3,
    )
    where: float = code("the side it is about")
    way: float = code("the sense it is about")

    def __post_init__(self) -> None:
        super().__post_init__()
        terms.code_of(f"{self.name}: side", self.side, tuple(SIDES))
        terms.code_of(f"{self.name}: sense", self.sense, tuple(SENSES))

    def rules(self, vessel: Boat) -> dict[str, float]:
        """What its words are to the program. Raises BadInput for factors that the vessel has not."""
        return super().rules(vessel) | {"where": SIDES[self.side], "way": SENSES[self.sense]}

    def shape(self) -> dict[str, object]:
        """What its table says of the law, less what has no meaning for it."""
        return {"side": self.side, "sense": self.sense} | super().shape()
