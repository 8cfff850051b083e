"""Decisions by held-out recordings: refuted effects, and distinguished look-alikes."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.free_runs import FreeRun, free_runs
from boatsim.diagnosis.noise_levels import fit_latent_force_level, log_latent_force_prior
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.search.candidate_sets import CandidateSets, Recordings
from boatsim.diagnosis.search.evidence import unexplained_evidence, unknown_cause_threshold
from boatsim.diagnosis.search.generalization import Squares
from boatsim.diagnosis.search.pruning import IdentifiedEffect, compare_rivals
from boatsim.physics.base import Array


def misleading_effect(sets: CandidateSets, best: Fit, held_out: Recordings) -> str:
    """Return the effect to remove from a fit that simulates held-out recordings badly.

    It is sought only if free runs (simulations with the recorded commands alone) are clearly worse
    with all effects of the fit than with none.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.
        held_out: Held-out recordings, which no fit has used.

    Returns:
        Name of the effect without which they are best, or "".
    """
    config = sets.config.validate
    without = sets.fits_without_each(best)
    runs = _free_runs(sets, {"none": sets.base, "all": best}, held_out)
    none = generalization.mean_square_errors(runs, "none")
    stochastic = sets.random & set(best.effects)
    sure = config.certainty_alike if stochastic else config.certainty
    if not none or not _errors_grew(
        sets, none, generalization.mean_square_errors(runs, "all"), sure
    ):
        return ""
    runs = _free_runs(sets, without, held_out)
    misfits = {}
    for name in best.effects:
        misfits[name] = generalization.error_ratio(
            generalization.mean_square_errors(runs, name), none
        )
    return min(best.effects, key=lambda name: misfits[name])


def refuted_effect(
    sets: CandidateSets, best: Fit, named: Sequence[IdentifiedEffect], held_out: Recordings
) -> str:
    """Return the name of an effect that held-out recordings refute, or "".

    Either these become less likely by it, or all recordings together gain less by it and its
    look-alikes than is required and than the laws of the other effects may be off by. The
    likelihood compares each row with the rows before. Free runs over held-out recordings must not
    require the effect all the same, as they may where these go beyond the fitted ones. Where only a
    few moments are less likely by it, such as impacts on a wall whose place is known to
    centimetres, free runs need not require it: it suffices that they are no worse with it.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.
        named: Identified effects of the fit, with their statistics.
        held_out: Held-out recordings, which no fit has used.
    """
    if not held_out:
        return ""
    whole = predictive_log_likelihood(sets, best, held_out)
    without = sets.fits_without_each(best)
    gains = {
        name: whole - predictive_log_likelihood(sets, f, held_out) for name, f in without.items()
    }
    threshold = unknown_cause_threshold(sets.config.select, sets.explained_evidence(best))
    doubtful = {name for name, gain in gains.items() if gain < -threshold}
    unlikely = doubtful - sets.supported
    little = set()
    for one in named:
        slight = sets.slight_gain(best, one.gain, one.name in sets.measurement)
        least = sets.required_gain + max(slight, 0.0)
        if one.shared + gains[one.name] < least:
            little.add(one.name)
    doubtful = unlikely | (little - sets.supported)
    if not doubtful:
        return ""
    fits = {"": best} | {name: f for name, f in without.items() if name in doubtful}
    runs = _free_runs(sets, fits, held_out)
    with_all = generalization.mean_square_errors(runs, "")
    if not with_all:
        return min(unlikely, key=lambda name: gains[name], default="")
    unnecessary = []
    for name in sorted(doubtful):
        misfit = generalization.error_ratio(generalization.mean_square_errors(runs, name), with_all)
        least = sets.config.validate.worse**2
        if name in unlikely and not _clearly_less_likely(sets, best, fits[name], held_out):
            least = 1.0
        if misfit < least:
            unnecessary.append(name)
    return min(unnecessary, key=lambda name: gains[name], default="")


def _clearly_less_likely(
    sets: CandidateSets, before: Fit, without: Fit, held_out: Recordings
) -> bool:
    """Whether held-out recordings are less likely with an effect by some standard errors.

    The losses in stretches as long as a free run are compared, as in the test of Vuong (1989),
    "Likelihood ratio tests for model selection and non-nested hypotheses", Econometrica 57. A
    loss in few of them has a large standard error.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        before: The fit with the effect.
        without: The fit without it.
        held_out: Held-out recordings, which no fit has used.

    Returns:
        True, too, where there are too few stretches for a standard error.
    """
    config = sets.config.validate
    log_density = _log_density_of_stretches(sets, before, held_out)
    losses = _log_density_of_stretches(sets, without, held_out) - log_density
    if len(losses) < config.fewest_runs:
        return True
    scatter = config.certainty * float(np.std(losses, ddof=1)) * np.sqrt(len(losses))
    return not np.sum(losses) < scatter


def _log_density_of_stretches(sets: CandidateSets, found: Fit, held_out: Recordings) -> Array:
    """(K,) log density of held-out recordings in stretches as long as a free run [nats]."""
    problem = sets.problem.with_recordings(held_out)
    refitted = fit_latent_force_level(problem, found)
    on = problem.program.effect_switches(refitted.effects)
    passes = problem.filter(refitted.free, refitted.theta, on, refitted.levels).passes
    parts = []
    for mapped, one in zip(held_out, passes, strict=True):
        stretch = ((mapped.times - mapped.times[0]) // problem.horizon).astype(int)
        parts.append(np.bincount(stretch, one.log_density_of_rows))
    return np.concatenate(parts)


def generalizes_worse(sets: CandidateSets, before: Fit, after: Fit, held_out: Recordings) -> bool:
    """Whether one fit simulates held-out recordings clearly worse than another.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        before: The fit that serves as reference.
        after: The fit that replaces it.
        held_out: Held-out recordings, which no fit has used.
    """
    runs = _free_runs(sets, {"before": before, "after": after}, held_out)
    old = generalization.mean_square_errors(runs, "before")
    if not old:
        return False
    new = generalization.mean_square_errors(runs, "after")
    return not generalization.error_ratio(new, old) < sets.config.validate.worse**2


def predictive_log_likelihood(sets: CandidateSets, found: Fit, held_out: Recordings) -> float:
    """Return the log likelihood of held-out recordings under a fit to other recordings [nats].

    Only the level of the latent (unmodelled) force is refitted to them.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        found: Fit of the vessel model with some candidate effects.
        held_out: Held-out recordings, which no fit has used.
    """
    key = (id(found), id(held_out))
    if key not in sets.predictions:
        problem = sets.problem.with_recordings(held_out)
        refitted = fit_latent_force_level(problem, found)
        on = problem.program.effect_switches(refitted.effects)
        likelihood = problem.log_likelihood(refitted.free, refitted.theta, on, refitted.levels)
        predicted = likelihood + log_latent_force_prior(problem, refitted.levels)
        sets.predictions[key] = found, held_out, predicted  # both stay alive with their identities
    return sets.predictions[key][2]


def evaluate_rivals_on_all(
    sets: CandidateSets, best: Fit, rivals: Mapping[str, Fit], held_out: Recordings
) -> dict[str, Fit]:
    """Return rivals of an effect with their evidence on fitted and held-out recordings together.

    A rival is a fit with another candidate effect in its place.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: The fit with the effect.
        rivals: Fits with other candidates in the effect's place, by name.
        held_out: Held-out recordings, which no fit has used.
    """
    own = predictive_log_likelihood(sets, best, held_out)
    if not np.isfinite(own):  # the simulated boat diverges
        return dict(rivals)
    found = {}
    for name, rival in rivals.items():
        evidence = rival.evidence + predictive_log_likelihood(sets, rival, held_out) - own
        found[name] = replace(rival, evidence=evidence)
    return found


def replace_stochastic_force(
    sets: CandidateSets, best: Fit, named: Sequence[IdentifiedEffect], held_out: Recordings
) -> Fit | None:
    """Replace a stochastic force by a deterministic effect if held-out recordings prefer it.

    Simulations (free runs) of held-out recordings must get clearly better by it, or all recordings
    together must become clearly more likely.

    Args:
        sets: Fits of candidate sets; an effect that is replaced is added to those refuted.
        best: Fit of the vessel model with some candidate effects.
        named: Identified effects of the fit, with their statistics.
        held_out: Held-out recordings, which no fit has used.

    Returns:
        The fit with the replacement; None if there is none.
    """
    clearly = best.evidence + sets.config.select.alike
    for one in named:
        least = best.evidence - sets.config.select.alike
        if one.name in sets.random:
            least = sets.fit_without(best, one.name).evidence + sets.required_gain
        laws = {}
        for name, rival in one.rivals.items():
            if name not in sets.random and rival.evidence > least:
                laws[name] = rival
        if not laws:
            continue
        fewest = sets.config.validate.fewest_runs
        runs = _free_runs(sets, {"": best, **laws}, held_out, fewest)
        with_effect = generalization.mean_square_errors(runs, "")
        everything = evaluate_rivals_on_all(sets, best, laws, held_out)
        better = []
        for name, law in laws.items():
            better_runs = _errors_grew_between_rivals(
                sets, generalization.mean_square_errors(runs, name), with_effect
            )
            if everything[name].evidence > clearly or better_runs:
                better.append(law)
        if better:
            sets.banned.add(one.name)
            return max(better, key=lambda f: f.evidence)
    return None


def remove_refuted_rivals(
    sets: CandidateSets, best: Fit, named: Sequence[IdentifiedEffect], held_out: Recordings
) -> tuple[IdentifiedEffect, ...]:
    """Drop alternative explanations of the identified effects that held-out recordings contradict.

    A rival is another candidate effect in the effect's place. It is dropped if the evidence of all
    recordings, the held-out ones included, is against it, or if simulations of the held-out
    recordings (free runs) with it are clearly worse than with the effect.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.
        named: Identified effects of the fit, with their statistics.
        held_out: Held-out recordings, which no fit has used.

    Returns:
        The identified effects with their remaining rivals.
    """
    fewest, found = sets.config.validate.fewest_runs, []
    least = best.evidence - sets.config.select.alike
    for one in named:
        rivals = evaluate_rivals_on_all(sets, best, one.rivals, held_out)
        alike = {}
        for name, rival in rivals.items():
            if max(rival.evidence, one.rivals[name].evidence) > least:
                alike[name] = rival
        runs: Sequence[FreeRun] = ()
        if alike:
            runs = _free_runs(sets, {"": best, **alike}, held_out, fewest)
        with_effect = generalization.mean_square_errors(runs, "")
        for name in alike:
            if _errors_grew_between_rivals(
                sets, with_effect, generalization.mean_square_errors(runs, name)
            ):
                del rivals[name]
        without = sets.fit_without(best, one.name)
        found.append(compare_rivals(one.name, best, without, rivals, sets.config.select))
    return tuple(found)


def remove_dwarfed_effect(sets: CandidateSets, best: Fit, held_out: Recordings) -> Fit:
    """Remove an effect that only absorbs a small part of a much larger unexplained force.

    It reduces the latent (unmodelled) force by almost nothing, and simulations of held-out
    recordings get no worse without it. Of several such effects a stochastic force is removed first,
    because it may have taken the place of a law.

    Args:
        sets: Fits of candidate sets; an effect that is removed is added to those refuted.
        best: Fit of the vessel model with some candidate effects.
        held_out: Held-out recordings, which no fit has used.

    Returns:
        The fit without it; the same object if no effect is removed.
    """
    config = sets.config.validate
    remaining = unexplained_evidence(sets.problem, best)
    if remaining < unknown_cause_threshold(sets.config.select, sets.explained_evidence(best)):
        return best
    without = sets.fits_without_each(best)
    little = {}
    for name, fewer in without.items():
        if np.min(best.levels.force / fewer.levels.force) > config.unexplained_share:
            little[name] = fewer
    if not little:
        return best
    runs = _free_runs(sets, {"": best, **little}, held_out, config.fewest_runs)
    whole = generalization.mean_square_errors(runs, "")
    idle = []
    for name in little:
        squares = generalization.mean_square_errors(runs, name)
        if not _errors_grew(sets, whole, squares, config.certainty):
            idle.append(name)
    if not idle:
        return best
    removed = max(idle, key=lambda name: (name in sets.random, without[name].evidence))
    sets.banned.add(removed)
    return without[removed]


def _errors_grew(sets: CandidateSets, before: Squares, after: Squares, sure: float) -> bool:
    """Whether the errors of free runs have grown by some standard errors."""
    return generalization.errors_grew(before, after, sure, sets.config.validate)


def _errors_grew_between_rivals(sets: CandidateSets, before: Squares, after: Squares) -> bool:
    """Whether the errors have grown, with the certainty that decides between look-alikes."""
    return _errors_grew(sets, before, after, sets.config.validate.certainty_alike)


def _free_runs(
    sets: CandidateSets, fits: Mapping[str, Fit], held_out: Recordings, parts: int = 1
) -> list[FreeRun]:
    """Free runs of fits over held-out recordings.

    They have the usual length, unless the longest recording does not hold that many of them.
    """
    longest = max((float(np.ptp(mapped.times)) for mapped in held_out), default=0.0)
    return free_runs(sets.problem, fits, held_out, min(sets.problem.horizon, longest / parts))
