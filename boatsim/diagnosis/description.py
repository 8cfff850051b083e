"""Results of the symbolic description of a force that no candidate explains."""

from collections.abc import Mapping
from dataclasses import dataclass

from boatsim.diagnosis.problem import Fit
from boatsim.physics.base import Array
from boatsim.physics.described_laws import SymbolicTerm


@dataclass(frozen=True)
class Curve:
    """A term over the variable on which it depends: means over the bins that contain rows."""

    over: str  # variable of the abscissa: a factor, "time" or "product"
    x: Array  # (B,) [SI]
    law: Array  # (B,) force [N], moment [N m] or share of the thrust by the term
    sd: Array  # (B,) standard deviation of `law`
    found: Array  # (B,) the same required by the recordings, with all other causes subtracted


@dataclass(frozen=True)
class FittedTerm:
    """A term of a symbolic description, with its fit and its curve."""

    term: SymbolicTerm  # with its coefficient
    sd: float  # of the coefficient
    gain: float  # [nats] beyond the other terms and effects
    # whether free runs over held-out recordings get better by it; an event of one run never does
    carries: bool
    curve: Curve | None = None


@dataclass(frozen=True)
class Description:
    """The terms, and the fit with those that hold for further recordings."""

    terms: tuple[FittedTerm, ...]
    fit: Fit
    left_over: float  # [nats] that a force beyond the assumed level gains in addition to all terms

    def effects(self) -> Mapping[str, SymbolicTerm]:
        """Return the terms that hold for further recordings, by the names of their effects."""
        return {w.term.name: w.term for w in self.terms if w.carries}
