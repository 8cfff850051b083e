"""A description of what no entry of the library explains, and how far it carries over to recordings not seen."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from boatsim.diagnose.describe.choose import Chosen, chosen, less
from boatsim.diagnose.filter import Track
from boatsim.diagnose.free_runs import free_runs
from boatsim.diagnose.problem import Fit, Problem
from boatsim.diagnose.search import carries
from boatsim.physics.described import Described

BETTER = 0.98  # of the mean square errors: free runs must get that much better for one more term to carry over


@dataclass(frozen=True)
class Written:
    """A term of a description."""

    term: Described  # with its coefficient
    sd: float  # of the coefficient
    gain: float  # [nats] on top of the other terms and entries
    carries: bool  # free runs over unseen recordings get better by it; an event of a run acts in no other


@dataclass(frozen=True)
class Description:
    """The terms, and the fit in which those stand that carry over, and the events of the recordings fitted."""

    terms: tuple[Written, ...]
    fit: Fit

    def effects(self) -> Mapping[str, Described]:
        """What a boat that sails elsewhere has of it, by the names of the slots."""
        return {w.term.name: w.term for w in self.terms if w.carries}


def described(problem: Problem, best: Fit, recalibrated: Fit, unseen: Sequence[Track]) -> Description | None:
    """What is left over beside a set, as terms; None where no term is worth its price."""
    found = chosen(problem, best, unseen)
    if not found.terms:
        return None
    alone = {name: less(problem, found, name).fit for name in found.terms}
    gains = {name: found.fit.evidence - f.evidence for name, f in alone.items()}
    kept = _carried(problem, found, gains, recalibrated, unseen)
    written = []
    for name, term in sorted(found.terms.items(), key=lambda pair: -gains[pair[0]]):
        of = kept.fit if name in kept.terms else found.fit
        value, sd = of.value(name, "coefficient")
        said = term.having({"name": name, "coefficient": value})
        written.append(Written(said, sd, gains[name], name in kept.terms and not term.run))
    return Description(tuple(written), kept.fit)


def _carried(
    problem: Problem, found: Chosen, gains: Mapping[str, float], recalibrated: Fit, unseen: Sequence[Track]
) -> Chosen:
    """As many of the terms that gain most as free runs over unseen recordings are best with, and all events."""
    lasting = sorted((n for n, t in found.terms.items() if not t.run), key=lambda n: gains[n])
    chain = [found]
    for name in lasting:
        chain.append(less(problem, chain[-1], name))
    fits = {"recalibrated": recalibrated} | {str(k): c.fit for k, c in enumerate(chain)}
    longest = max((float(t.times[-1] - t.times[0]) for t in unseen), default=0.0)
    stretches = free_runs(problem, fits, unseen, min(problem.horizon, longest)) if unseen else []
    before = carries.squares(stretches, "recalibrated")
    if not before:
        return found
    misfits = [carries.misfit(carries.squares(stretches, str(k)), before) for k in range(len(chain))]
    best = len(chain) - 1
    for k in reversed(range(len(chain))):
        if misfits[k] < BETTER * misfits[best]:
            best = k
    return chain[best]
