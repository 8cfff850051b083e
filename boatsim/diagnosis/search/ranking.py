"""Names what is missing: every suspect fitted in the filter, scored by evidence, selected forward, pruned backward."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from boatsim.diagnosis.covariance_inflation import inflate_covariance
from boatsim.diagnosis.description import Description
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge, gauss_newton
from boatsim.diagnosis.locate.residual_structure import Structure, find_structure
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.candidate_sets import Sets
from boatsim.diagnosis.search.energy_balance import braking, waves_of
from boatsim.diagnosis.search.evidence import left_over, told_from
from boatsim.diagnosis.search.forward_selection import begun, selected
from boatsim.diagnosis.search.pruning import Named, settled
from boatsim.diagnosis.search.validation import lawful, misled, missed, refuted, stood_for, told
from boatsim.physics.described_laws import Described
from boatsim.progress import Report, silent

JUDGING = 0.8  # of a ranking is done when it begins, by experience
# of what a random force gains, from which it but stands for a law that is left over beside it
LEFT_OF_IT = 0.25
ALONG = 0.02  # of what was explained: that much less is told of a force that goes with something


@dataclass(frozen=True)
class Ranking:
    """What selection found."""

    nominal: Fit  # the vessel as written, noise and force levels fitted
    recalibrated: Fit  # the nominal structure with its own coefficients refitted
    best: Fit
    named: tuple[Named, ...]
    first: dict[str, float]  # gain of every suspect alone over the recalibrated nominal [nats]
    last: dict[str, Fit]  # every suspect not named, on top of the best set
    left_over: float  # [nats] that a force beyond the tolerated one gains after the best set
    structure: Structure  # what goes best with the force left over
    explained: (
        float  # [nats] that the laws of the best set gain, of which something besides is told from
    )
    description: Description | None = None  # of what is left over, where something is

    @property
    def adds(self) -> bool:
        """Whether the best fit adds anything to the vessel."""
        return bool(self.named) or bool(self.laws)

    @property
    def laws(self) -> Mapping[str, Described]:
        """The described laws that the best fit adds, by name."""
        return self.description.effects() if self.description else {}

    @property
    def unknown(self) -> bool:
        """Whether something is left that no entry of the library explains."""
        return (
            self.description is not None or bool(self.left_over > self.told_from) or self.structured
        )

    @property
    def structured(self) -> bool:
        """Whether what is left over, however weak, goes with something."""
        return told_apart(self.structure, float(self.best.evidence - self.recalibrated.evidence))

    @property
    def told_from(self) -> float:
        """What must be left over [nats] for something to be missing besides: a law is never quite that of its entry."""
        return told_from(self.explained)


def rank(
    problem: Problem,
    candidates: tuple[str, ...],
    held_out: Sequence[MappedRecording] = (),
    begin: Fit | None = None,
    report: Report = silent,
) -> Ranking:
    """Forward selection over the candidates, the incumbent converged before each comparison, members exchanged.

    It begins with nothing, or with the set of another fit. Where far more stays unexplained than an effect explains, it
    is not stood for; nor is one by which free runs over `unseen` recordings get worse, or by which these become
    unlikelier. They decide between look-alikes.
    """
    report("fitting the vessel as written")
    nominal, recalibrated = baseline(problem)
    sets = Sets(problem, candidates, recalibrated, report)
    best, named = settled(sets, selected(sets, begun(sets, begin) if begin else recalibrated))
    while (stood := stood_for(sets, best, held_out)) is not best:
        best, named = settled(sets, stood)
    report("judging what is left over", JUDGING)
    best, named = _judged(sets, best, named, held_out)
    left, goes = left_over(problem, best), find_structure(problem, best)
    while (waves := waves_of(sets, best)) and _stands_for_a_law(sets, best, waves, goes):
        sets.banned.add(waves)
        best, named = _judged(
            sets, *settled(sets, selected(sets, sets.without(best, waves))), held_out
        )
        left, goes = left_over(problem, best), find_structure(problem, best)
    named = told(sets, best, named, held_out)
    first = {n: f.evidence - sets.base.evidence for n, f in sets.looked(sets.base).items()}
    last = sets.looked(best)
    for name in sets.banned & last.keys():  # what was found to mislead is no hint
        last[name] = replace(last[name], evidence=min(last[name].evidence, best.evidence))
    explained = sets.explained(best)
    return Ranking(
        nominal,
        sets.base,
        inflate_covariance(problem, best),
        named,
        first,
        last,
        left,
        goes,
        explained,
    )


def _judged(
    sets: Sets, best: Fit, named: tuple[Named, ...], held_out: Sequence[MappedRecording]
) -> tuple[Fit, tuple[Named, ...]]:
    """The set without what physics or unseen recordings speak against, laws in place of what but sways like them."""
    while named and (worse := braking(sets, best) or misled(sets, best, held_out)):
        sets.banned.add(worse)
        best, named = settled(sets, selected(sets, sets.without(best, worse)))
    while named and (worse := refuted(sets, best, named, held_out)):
        sets.banned.add(worse)
        without = settled(sets, selected(sets, sets.without(best, worse)))
        if missed(
            sets, best, without[0], held_out
        ):  # what came in its place carries over less than it did
            sets.banned.remove(worse)
            sets.vouched.add(worse)
            continue
        return _judged(sets, *without, held_out)
    while law := lawful(sets, best, named, held_out):
        best, named = settled(sets, selected(sets, law))
    return best, named


def _stands_for_a_law(sets: Sets, best: Fit, waves: str, goes: Structure) -> bool:
    """Whether a random force leaves over a good part of what it gains, which goes with a motion, command or heading."""
    gain = float(best.evidence - sets.without(best, waves).evidence)
    explained = float(best.evidence - sets.base.evidence)
    return goes.is_effect and told_apart(goes, explained) and goes.gain > LEFT_OF_IT * gain


def told_apart(goes: Structure, explained: float) -> bool:
    """Whether what is left over by a set that explained so many nats, however weak, goes with something."""
    return goes.significant and goes.gain > told_from(explained, ALONG)


def selection(problem: Problem, candidates: tuple[str, ...]) -> tuple[Fit, Fit]:
    """The recalibrated nominal and the best set on top of it, and no more: for cross-validation."""
    _, recalibrated = baseline(problem)
    return recalibrated, selected(Sets(problem, candidates, recalibrated), recalibrated)


def baseline(problem: Problem) -> tuple[Fit, Fit]:
    """The vessel as written with noise and force levels fitted, and recalibrated: its own coefficients refitted."""
    nominal = fit_noise(problem, problem.nominal())
    return nominal, converge(problem, gauss_newton(problem, nominal, 4, 0.1))
