"""The select stage: forward selection, pruning, and decisions by held-out recordings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from boatsim.diagnosis.covariance_inflation import inflate_covariance
from boatsim.diagnosis.description import SymbolicDescription
from boatsim.diagnosis.divergence import Divergence
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge, gauss_newton
from boatsim.diagnosis.locate.residual_structure import Structure, find_structure
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recalibration import Recalibration
from boatsim.diagnosis.search.budget import SearchBudget
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.differing_groups import restrict_to_single_groups
from boatsim.diagnosis.search.energy_balance import dissipative_force_name, oscillating_force_name
from boatsim.diagnosis.search.estimated_numbers import candidates_for_absent_numbers
from boatsim.diagnosis.search.evidence import (
    log_evidence_gains,
    unexplained_evidence,
    unknown_cause_threshold,
)
from boatsim.diagnosis.search.forward_selection import (
    refit_from_baseline_noise_levels,
    select_forward,
)
from boatsim.diagnosis.search.group_harm import remove_harm_to_groups
from boatsim.diagnosis.search.pruning import IdentifiedEffect, prune
from boatsim.diagnosis.search.validation import (
    generalizes_worse,
    misleading_effect,
    refuted_effect,
    remove_dwarfed_effect,
    remove_refuted_rivals,
    replace_stochastic_force,
)
from boatsim.physics.described_laws import SymbolicTerm
from boatsim.progress import Report, ignore_progress

NOT_EXAMINED = "effects beside a much larger unexplained force were not examined again"
JUDGING = 0.8  # share of the work, by experience, that is done when held-out recordings decide


class Baseline(NamedTuple):
    """Fits of the vessel model without candidate effects.

    One is the model as specified, with its noise levels fitted, the other one has refitted
    coefficients.
    """

    nominal: Fit  # with noise and force levels fitted
    recalibrated: Fit


@dataclass(frozen=True)
class Ranking:
    """Result of the selection: the identified effects, and the evidence of all candidate effects.

    It also holds the fits of the nominal and recalibrated vessel, and what remains unexplained.
    """

    nominal: Fit  # the vessel as written, noise and force levels fitted
    recalibrated: Fit  # the nominal structure with its own coefficients refitted
    best: Fit
    named: tuple[IdentifiedEffect, ...]
    first: dict[str, float]  # [nats] that each candidate alone gains over the recalibrated vessel
    last: dict[str, Fit]  # each candidate that is not identified, on top of the best set
    left_over: float  # [nats] that a force beyond the assumed level gains after the best set
    structure: Structure  # what that force correlates with most
    explained: float  # [nats] that the deterministic effects of the best set gain
    told_from: float  # [nats] of `unexplained_evidence` from which an unknown cause is reported
    structured: bool  # whether that force, however weak, clearly correlates with something
    without: Mapping[str, Fit]  # fits without one of the identified effects, by its name
    description: SymbolicDescription | None = None  # symbolic description of it
    # where the model loses each recording, if fits diverge; nothing was fitted then
    divergences: tuple[Divergence, ...] = ()
    # effects that the best fit contains, but that are probably stand-ins for an unknown cause
    doubtful: tuple[IdentifiedEffect, ...] = ()
    skipped: tuple[str, ...] = ()  # what was not tried because the search's budget was spent
    stands_in: bool = False  # whether one of them explains so much that a cause must exist
    held_out_remains: bool = False  # whether held-out recordings clearly require another force
    # which refitted coefficients `recalibrated` has; None before that is decided
    recalibration: Recalibration | None = None
    # whether `best` was fitted to free runs, because a force remains unexplained
    by_free_runs: bool = False
    # effects of `best` that only make its free runs better: no statement about causes
    added: tuple[str, ...] = ()
    # effects that free runs found together; the filter takes up much of their slow motion, so that
    # free runs determine their sizes, too
    balanced: tuple[str, ...] = ()
    # effects among `doubtful` without which free runs are clearly more probable
    contradicted: tuple[str, ...] = ()

    @property
    def adds_effects(self) -> bool:
        """Whether the selected model has an effect or a formula that the vessel file lacks."""
        return bool(self.named or self.doubtful or self.described_terms or self.added)

    @property
    def described_terms(self) -> Mapping[str, SymbolicTerm]:
        """Terms found by symbolic regression that the selected model contains, by name."""
        return self.description.validated_terms() if self.description else {}

    @property
    def has_unexplained_force_or_cause(self) -> bool:
        """Whether a force or a cause remains that no candidate effect explains."""
        described = self.description is not None or bool(self.divergences)
        return (
            described or self.exceeds_assumed_disturbance or self.stands_in or self.held_out_remains
        )

    @property
    def exceeds_assumed_disturbance(self) -> bool:
        """Whether the unexplained force is larger than, or unlike, the assumed random disturbance.

        Unlike means that it clearly correlates with motion, commands, place or time.
        """
        return bool(self.left_over > self.told_from) or self.structured


def select_and_rank_candidates(
    problem: Problem,
    candidates: tuple[str, ...],
    held_out: Sequence[MappedRecording] = (),
    begin: Fit | None = None,
    report: Report = ignore_progress,
    base: Baseline | None = None,
    budget: SearchBudget | None = None,
) -> Ranking:
    """Select the candidate effects that the recordings require, and rank all candidates.

    Candidates are added one by one, each time after the present set has converged, and members are
    exchanged. Effects that supply an estimated number which the vessel model lacks, such as a lag,
    come first: they are no missing physics, and another effect shall not take their place. An
    effect is removed if far more remains unexplained than it explains, if free runs over held-out
    recordings get worse by it, or if it makes these less likely. Held-out recordings decide between
    look-alikes. An effect that every group of recordings but one replaces is stated for that group.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        candidates: Names of the candidates that are tested.
        held_out: Held-out recordings, which no fit has used.
        begin: Fit whose effects the search starts with; None: start without effects.
        report: Receives the progress.
        base: Fits of the vessel without candidates; None: fit them.
        budget: Work that the search may do; None: that of the configuration. When it is spent, no
            candidate is added or exchanged any more. Effects without sufficient evidence are still
            removed.

    Returns:
        The identified effects with the evidence of all candidates.
    """
    report("fitting the vessel as written")
    nominal, recalibrated = base or fit_baseline(problem)
    sets = CandidateSets(problem, candidates, recalibrated, report, budget)
    start = recalibrated
    if begin:
        start = refit_from_baseline_noise_levels(sets, begin)
    elif absent := candidates_for_absent_numbers(sets.refining, candidates, problem.candidates):
        start = select_forward(sets, recalibrated, absent)
    best, named = _select(sets, start, held_out)
    report("judging what is left over", JUDGING)
    best, named = _remove_refuted_effects(sets, best, named, held_out)
    best, named, correlated = _search_law_behind_waves(sets, best, named, held_out)
    best, named = restrict_to_single_groups(sets, best, named, held_out)
    named = remove_refuted_rivals(sets, best, named, held_out)
    explained = sets.explained_evidence(best)
    inflated = inflate_covariance(problem, best)
    decide = problem.config.decide
    gain = float(inflated.evidence - sets.base.evidence)
    return Ranking(
        nominal,
        sets.base,
        inflated,
        named,
        log_evidence_gains(sets.screen_candidates(sets.base), sets.base),
        _evidence_on_top(sets, best),
        unexplained_evidence(problem, best),
        correlated,
        explained,
        told_from=unknown_cause_threshold(
            problem.config.select, explained, decide.unexplained_share
        ),
        structured=_clearly_correlates(sets, correlated, gain, decide.structure_share),
        without=sets.fits_without_each(best),
        skipped=sets.budget.skipped_work_statements,
    )


def with_further_effects(
    problem: Problem,
    ranking: Ranking,
    best: Fit,
    named: tuple[IdentifiedEffect, ...],
    without: Mapping[str, Fit],
) -> Ranking:
    """Return a ranking with further deterministic effects and what these leave unexplained.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Result of the selection.
        best: Converged fit with the further effects.
        named: Statistics of all its effects.
        without: Converged fits without one of its effects, by the name of the effect.
    """
    config = problem.config
    explained = ranking.explained + float(best.evidence - ranking.best.evidence)
    correlated = find_structure(problem, best)
    gain = float(best.evidence - ranking.recalibrated.evidence)
    structured = unknown_cause_threshold(config.select, gain, config.decide.structure_share)
    return replace(
        ranking,
        best=inflate_covariance(problem, best),
        named=named,
        last={name: fit for name, fit in ranking.last.items() if name not in best.effects},
        left_over=unexplained_evidence(problem, best),
        structure=correlated,
        explained=explained,
        told_from=unknown_cause_threshold(
            config.select, explained, config.decide.unexplained_share
        ),
        structured=bool(correlated.significant and correlated.gain > structured),
        without=without,
    )


def _select(
    sets: CandidateSets, start: Fit, held_out: Sequence[MappedRecording]
) -> tuple[Fit, tuple[IdentifiedEffect, ...]]:
    """Forward selection and pruning, repeated after each dwarfed effect that is removed.

    Without a budget nothing can take the place of a removed effect, and none is removed.
    """
    best, named = prune(sets, select_forward(sets, start))
    while True:
        if sets.budget.is_spent:
            if best.effects:
                sets.budget.record_skipped_attempt(NOT_EXAMINED)
            return best, named
        fewer = remove_dwarfed_effect(sets, best, held_out)
        if fewer is best:
            return best, named
        best, named = prune(sets, select_forward(sets, fewer))


def _search_law_behind_waves(
    sets: CandidateSets,
    best: Fit,
    named: tuple[IdentifiedEffect, ...],
    held_out: Sequence[MappedRecording],
) -> tuple[Fit, tuple[IdentifiedEffect, ...], Structure]:
    """Exclude a stochastic force that stands in for a law, and select again.

    Returns the set, its identified effects, and what the force that remains correlates with.
    """
    correlated = find_structure(sets.problem, best)
    while True:
        waves = oscillating_force_name(sets, best)
        if not waves or not _replaces_law(sets, best, waves, correlated):
            return best, named, correlated
        sets.banned.add(waves)
        pruned = prune(sets, select_forward(sets, sets.fit_without(best, waves)))
        best, named = _remove_refuted_effects(sets, *pruned, held_out)
        best, named = _waves_beside_law(sets, best, named, waves)
        correlated = find_structure(sets.problem, best)
        if waves in best.effects:
            return best, named, correlated


def _evidence_on_top(sets: CandidateSets, best: Fit) -> dict[str, Fit]:
    """Each candidate on top of the set; one that was refuted is no hint and gains nothing."""
    found = sets.screen_candidates(best)
    for name in sets.banned & found.keys():
        found[name] = replace(found[name], evidence=min(found[name].evidence, best.evidence))
    return found


def _remove_refuted_effects(
    sets: CandidateSets,
    best: Fit,
    named: tuple[IdentifiedEffect, ...],
    held_out: Sequence[MappedRecording],
) -> tuple[Fit, tuple[IdentifiedEffect, ...]]:
    """The set without effects that physics or held-out recordings refute."""
    while named:
        worse = dissipative_force_name(sets, best) or misleading_effect(sets, best, held_out)
        if not worse:
            break
        sets.banned.add(worse)
        best, named = prune(sets, select_forward(sets, sets.fit_without(best, worse)))
    while named:
        worse = refuted_effect(sets, best, named, held_out)
        if not worse:
            break
        sets.banned.add(worse)
        without = prune(sets, select_forward(sets, sets.fit_without(best, worse)))
        if not generalizes_worse(sets, best, without[0], held_out):
            return _remove_refuted_effects(sets, *without, held_out)
        sets.banned.remove(worse)  # what replaced it holds less well for held-out recordings
        sets.supported.add(worse)
    while True:
        law = replace_stochastic_force(sets, best, named, held_out)
        if law is None:
            return remove_harm_to_groups(sets, best, named, held_out)
        best, named = prune(sets, select_forward(sets, law))


def _replaces_law(sets: CandidateSets, best: Fit, waves: str, correlated: Structure) -> bool:
    """Whether a stochastic force leaves a good part of its gain correlated with the motion."""
    gain = float(best.evidence - sets.fit_without(best, waves).evidence)
    clear = _clearly_correlates(
        sets,
        correlated,
        float(best.evidence - sets.base.evidence),
        sets.config.select.structure_error,
    )
    enough = correlated.gain > sets.config.select.remaining_share * gain
    return correlated.varies_with_motion and clear and enough


def _waves_beside_law(
    sets: CandidateSets, best: Fit, named: tuple[IdentifiedEffect, ...], waves: str
) -> tuple[Fit, tuple[IdentifiedEffect, ...]]:
    """The set with a stochastic force that hid a law, if it acts beside that law as well."""
    if not best.effects:
        return best, named
    sets.banned.remove(waves)
    both, named_both = prune(sets, select_forward(sets, best))
    more = both.evidence > best.evidence + sets.required_gain
    if more and {waves, *best.effects} <= set(both.effects):
        correlated = find_structure(sets.problem, both)
        if not _replaces_law(sets, both, waves, correlated):
            return both, named_both
    sets.banned.add(waves)
    return best, named


def _clearly_correlates(
    sets: CandidateSets, correlated: Structure, explained: float, model_error: float
) -> bool:
    """Whether the force that remains, however weak, clearly correlates with something."""
    threshold = unknown_cause_threshold(sets.config.select, explained, model_error)
    return bool(correlated.significant and correlated.gain > threshold)


def select_effects(problem: Problem, candidates: tuple[str, ...]) -> tuple[Fit, Fit]:
    """Select candidate effects by forward selection alone, for cross-validation.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        candidates: Names of the candidates that are tested.

    Returns:
        The fit of the vessel with refitted coefficients, and the fit with the selected effects.
    """
    _, recalibrated = fit_baseline(problem)
    return recalibrated, select_forward(
        CandidateSets(problem, candidates, recalibrated), recalibrated
    )


def fit_baseline(problem: Problem) -> Baseline:
    """Fit the vessel model without candidate effects: as specified, and with refitted coefficients.

    In the first fit only the noise levels are fitted.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
    """
    config = problem.config.fit
    nominal = fit_noise(problem, problem.nominal_hypothesis())
    start = gauss_newton(problem, nominal, config.first_steps, config.step_gain)
    return Baseline(nominal, converge(problem, start))
