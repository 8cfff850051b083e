"""Results of the symbolic description of a force that no candidate explains."""

from collections.abc import Mapping
from dataclasses import dataclass

from boatsim.diagnosis.problem import Fit
from boatsim.physics.base import Array
from boatsim.physics.described_laws import SymbolicTerm


@dataclass(frozen=True)
class Curve:
    """Force of a term found by symbolic regression, as a function of the variable it depends on.

    Means over bins of that variable, of the term and of the force that the recordings require.
    """

    over: str  # variable of the abscissa: a factor, "time" or "product"
    x: Array  # (B,) [SI]
    law: Array  # (B,) force [N], moment [N m] or share of the thrust by the term
    sd: Array  # (B,) standard deviation of `law`
    found: Array  # (B,) the same required by the recordings, with all other causes subtracted


@dataclass(frozen=True)
class FittedTerm:
    """A term found by symbolic regression, with its fitted coefficient, evidence and curve."""

    term: SymbolicTerm  # with its coefficient
    sd: float  # of the coefficient
    gain: float  # [nats] beyond the other terms and effects
    # whether free runs over held-out recordings get better by it; an event of one run never does
    carries: bool
    curve: Curve | None = None


@dataclass(frozen=True)
class SymbolicDescription:
    """Formula that symbolic regression found for a force that no candidate effect explains.

    It contains all terms, and the fit with those terms that also hold for held-out recordings.
    """

    terms: tuple[FittedTerm, ...]
    fit: Fit
    left_over: float  # [nats] that a force beyond the assumed level gains in addition to all terms
    complete: bool = True  # whether terms were sought until the end, not until the budget was spent

    def validated_terms(self) -> Mapping[str, SymbolicTerm]:
        """Return the symbolic terms that hold for held-out recordings, by name of the effect."""
        return {w.term.name: w.term for w in self.terms if w.carries}
