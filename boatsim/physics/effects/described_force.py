"""Described force: a law that no entry of the library is, written down as a product of what it goes with."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import terms
from boatsim.physics.base import Boat, Wrench, param
from boatsim.physics.described_laws import Described
from boatsim.physics.param import code


@njit(inline="always")
def law(m: Any, q: Any, act: Any, at: Any, own: Any) -> Wrench:
    """Coefficient times its factors times its course, along one axis of the hull or of the earth."""
    return terms.along(m, q.direction, q.coefficient * terms.term(m, q, act, at, own))


@dataclass(frozen=True)
class DescribedForce(Described):
    """One term of a law: a force or moment along an axis that goes with up to three factors, always or for a while."""

    words: ClassVar[str] = "a force that no entry of the library explains"
    shown_by: ClassVar[str] = "the manoeuvre in which it was found"
    law: ClassVar = law

    axis: str = "surge"  # along which of `terms.DIRECTIONS`
    coefficient: float = param(
        0.0,
        low=-1e15,
        high=1e15,
        unit="",
        words="force [N] or moment [N m] per product of the factors [SI]",
        fit=True,
        spread=1.0,
    )
    direction: float = code("its axis")

    def __post_init__(self) -> None:
        super().__post_init__()
        terms.code_of(f"{self.name}: axis", self.axis, terms.DIRECTIONS)

    def rules(self, vessel: Boat) -> dict[str, float]:
        """What its words are to the program. Raises BadInput for factors that the vessel has not."""
        return super().rules(vessel) | {
            "direction": terms.code_of(self.name, self.axis, terms.DIRECTIONS)
        }

    def shape(self) -> dict[str, object]:
        """What its table says of the law, less what has no meaning for it."""
        return {"axis": self.axis} | super().shape()
