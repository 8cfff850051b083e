"""What a diagnosis writes down of what no entry of the library explains."""

from collections.abc import Mapping
from dataclasses import dataclass

from boatsim.diagnosis.problem import Fit
from boatsim.physics.base import Array
from boatsim.physics.described_laws import Described


@dataclass(frozen=True)
class Curve:
    """A term over what it goes with, where the recordings show it: means over bins that hold anything."""

    over: str  # what the curve is drawn over: a factor, "time" or "product"
    x: Array  # (B,) [SI]
    law: Array  # (B,) force [N], moment [N m] or share of the thrust by the law,
    sd: Array  # (B,) its standard deviation,
    found: Array  # (B,) and what the recordings call for there, every other cause taken out


@dataclass(frozen=True)
class Written:
    """A term of a description."""

    term: Described  # with its coefficient
    sd: float  # of the coefficient
    gain: float  # [nats] on top of the other terms and entries
    # free runs over unseen recordings get better by it; an event of a run acts in no other
    carries: bool
    curve: Curve | None = None


@dataclass(frozen=True)
class Description:
    """The terms, and the fit in which those stand that carry over, and the events of the recordings fitted."""

    terms: tuple[Written, ...]
    fit: Fit
    left_over: float  # [nats] that a force beyond the tolerated one gains beside all of the terms

    def effects(self) -> Mapping[str, Described]:
        """What a boat that sails elsewhere has of it, by the names of the slots."""
        return {w.term.name: w.term for w in self.terms if w.carries}
