"""What recordings that no fit has seen say: which look-alikes they rule out, which members they
stand by."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import laid, push, sail

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import fit
from boatsim.diagnosis.noise_levels import fit_latent_force_level, log_latent_force_prior
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.search import validation as asked
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.pruning import compare_rivals
from boatsim.diagnosis.search.screening import screen
from boatsim.diagnosis.search.validation import (
    predictive_log_likelihood,
    refuted_effect,
    remove_dwarfed_effect,
    remove_refuted_rivals,
    replace_stochastic_force,
)
from boatsim.physics.base import Array

Laid = tuple[Problem, Fit, Fit, list[MappedRecording]]


def a_third_less_astern(t: float, y: Array, command: Array) -> Array:
    return np.asarray(-0.33 * push(np.minimum(command[:2], 0.0), command[2:]))


@pytest.fixture(scope="module")
def weak() -> Laid:
    """Two runs with weak thrust astern, the fit that says so, and a third run."""
    problem, base = laid(*(sail(f"run_{k}", 50 + k, a_third_less_astern)[0] for k in range(2)))
    found = fit(problem, screen(problem, base, ["weak_reverse"])["weak_reverse"])
    return (
        problem,
        base,
        found,
        [map_recording(sail("unseen", 60, a_third_less_astern)[0], problem.program)],
    )


def sets_of(problem: Problem, base: Fit, *fits: Fit) -> CandidateSets:
    sets = CandidateSets(problem, ("weak_reverse", "steady_force", "wave_forcing"), base)
    sets.fits |= {frozenset(f.effects): f for f in fits}
    return sets


def as_likely(problem: Problem, base: Fit, found: Fit, name: str) -> Fit:
    """An entry that does next to nothing, but is said to be as likely on the fitted runs."""
    return replace(screen(problem, base, [name])[name], evidence=found.evidence + 1.0)


@pytest.mark.parametrize("name", ["steady_force", "wave_forcing"])
def test_a_look_alike_by_which_unseen_runs_are_foreseen_worse_is_none(
    weak: Laid, name: str
) -> None:
    problem, base, found, held_out = weak
    sets, rival = sets_of(problem, base, found), as_likely(problem, base, found, name)
    one = compare_rivals("weak_reverse", found, base, {name: rival})
    assert one.tied_with == (name,) and one.probability < 0.5
    (sure,) = remove_refuted_rivals(sets, found, [one], held_out)
    assert not sure.tied_with and sure.probability > 0.99 and not sure.rivals
    (kept,) = remove_refuted_rivals(sets, found, [one], [])
    assert kept.tied_with == (name,)  # nothing unseen, nothing distinguish


def test_a_law_by_which_unseen_runs_are_foreseen_better_takes_the_place_of_its_look_alike(
    weak: Laid,
) -> None:
    problem, base, found, held_out = weak
    wrong = as_likely(problem, base, found, "steady_force")
    sets = sets_of(problem, base, found, wrong)
    one = compare_rivals("steady_force", wrong, base, {"weak_reverse": found})
    assert replace_stochastic_force(sets, wrong, [one], held_out) is found and sets.banned == {
        "steady_force"
    }


def test_a_look_alike_that_foresees_as_much_stays_one(weak: Laid) -> None:
    problem, base, found, held_out = weak
    sets, twin = sets_of(problem, base, found), replace(found, evidence=found.evidence - 1.0)
    one = compare_rivals("weak_reverse", found, base, {"steady_force": twin})
    (kept,) = remove_refuted_rivals(sets, found, [one], held_out)
    assert kept.tied_with == ("steady_force",)
    assert replace_stochastic_force(sets, found, [one], held_out) is None and not sets.banned


def test_beside_what_nothing_explains_only_what_unseen_runs_ask_for_is_stood_for(
    weak: Laid, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem, base, found, held_out = weak
    monkeypatch.setattr(asked, "unexplained_evidence", lambda problem, best: 1000.0)
    levels = replace(
        found.levels, force=50.0 * problem.ambient.force
    )  # as if nothing took any of it away
    much, none = replace(found, levels=levels), replace(base, levels=levels)
    sets = sets_of(problem, none, much)
    assert remove_dwarfed_effect(sets, much, held_out) is much and not sets.banned
    assert remove_dwarfed_effect(sets, much, []) is none and sets.banned == {"weak_reverse"}


def test_free_runs_of_a_boat_that_runs_away_have_grown() -> None:
    sound, away = {"position_rms_m": [1.0, 1.0, 1.0]}, {"position_rms_m": [1.0, np.inf, 1.0]}
    assert (
        generalization.errors_grew(sound, away, 2.0)
        and not generalization.errors_grew(away, sound, 2.0)
        and not generalization.errors_grew(away, away, 2.0)
    )


def said(problem: Problem, found: Fit, factor: float) -> Fit:
    """A fit that says another factor of the thrust astern."""
    at = next(i for i, f in enumerate(found.free) if f.effect == "weak_reverse")
    theta = found.theta.copy()
    theta[at] = factor
    return replace(found, theta=theta)


def test_an_effect_by_which_unseen_runs_become_unlikelier_does_not_carry_over(weak: Laid) -> None:
    problem, base, found, held_out = weak
    sets = sets_of(problem, base, found)
    one = compare_rivals("weak_reverse", found, base, {})
    assert refuted_effect(sets, found, [one], held_out) == ""
    wrong = said(problem, found, 1.5)  # stronger astern, where it is weaker
    assert (
        refuted_effect(sets, wrong, [one], held_out) == "weak_reverse"
        and refuted_effect(sets, wrong, [one], []) == ""
    )


def test_a_loss_in_few_moments_leaves_the_decision_to_free_runs(
    weak: Laid, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is clear from one stretch that loses much beside another that gains much, and an
    effect that free runs are no worse with then stays. The same loss spread over all stretches
    refutes it, because free runs are hardly better with it."""
    problem, base, found, held_out = weak
    sets = sets_of(problem, base, found)
    one = compare_rivals("weak_reverse", found, base, {})
    monkeypatch.setattr(
        asked,
        "predictive_log_likelihood",
        lambda sets, f, recordings: 0.0 if f is base else -100.0,
    )
    better = {"position_rms_m": [1.0, 1.0]}
    monkeypatch.setattr(
        generalization,
        "mean_square_errors",
        lambda runs, name: {"position_rms_m": [1.03, 1.03]} if name else better,
    )
    few, all_alike = np.zeros(20), np.full(20, -5.0)
    few[:2] = -190.0, 90.0

    def losses(each: Array) -> None:
        monkeypatch.setattr(
            asked,
            "_log_density_of_stretches",
            lambda sets, f, recordings: np.zeros(20) if f is base else each,
        )

    losses(few)
    assert few.sum() == all_alike.sum() and refuted_effect(sets, found, [one], held_out) == ""
    losses(all_alike)
    assert refuted_effect(sets, found, [one], held_out) == "weak_reverse"


def test_the_log_density_of_stretches_adds_up_to_the_likelihood(weak: Laid) -> None:
    """Both are known up to a constant, so that two models differ by the same."""
    problem, base, found, held_out = weak
    sets = sets_of(problem, base, found)
    stretches = [asked._log_density_of_stretches(sets, f, held_out) for f in (found, base)]
    by_likelihood = []
    for f in (found, base):
        likelihood = predictive_log_likelihood(sets, f, held_out)
        levels = fit_latent_force_level(problem.with_recordings(held_out), f).levels
        by_likelihood.append(likelihood - log_latent_force_prior(problem, levels))
    assert len(stretches[0]) > 1
    assert stretches[0].sum() - stretches[1].sum() == pytest.approx(
        by_likelihood[0] - by_likelihood[1], rel=1e-6
    )


def test_what_all_recordings_together_hardly_ask_for_is_not_named(weak: Laid) -> None:
    """A factor next to one gains nothing on unseen runs: on the fitted ones it must then gain its
    whole required_gain."""
    problem, base, found, held_out = weak
    own = dict(zip(((f.effect, f.name) for f in base.free), base.theta, strict=True))
    theta = np.array([own.get((f.effect, f.name), 0.999) for f in found.free])
    little = replace(found, theta=theta, levels=base.levels, evidence=base.evidence + 2.5)
    sets = sets_of(problem, base, little)
    one = compare_rivals("weak_reverse", little, base, {})
    assert (
        sets.required_gain > 2.6 and refuted_effect(sets, little, [one], held_out) == "weak_reverse"
    )
    assert (
        refuted_effect(sets, little, [replace(one, shared=sets.required_gain + 20.0)], held_out)
        == ""
    )  # with its look-alikes


def test_what_unseen_runs_say_of_a_law_hangs_little_on_how_rough_the_water_was_before(
    weak: Laid,
) -> None:
    problem, base, found, held_out = weak
    sets, rough = (
        sets_of(problem, base),
        replace(found, levels=replace(found.levels, force=5.0 * found.levels.force)),
    )
    by_law = predictive_log_likelihood(sets, found, held_out) - predictive_log_likelihood(
        sets, said(problem, found, 1.0), held_out
    )
    assert (
        abs(
            predictive_log_likelihood(sets, rough, held_out)
            - predictive_log_likelihood(sets, found, held_out)
        )
        < 0.2 * by_law
    )


def test_a_rival_that_is_behind_on_the_fitted_runs_only_is_a_look_alike(weak: Laid) -> None:
    problem, base, found, held_out = weak
    wrong = said(problem, found, 0.9)
    gap = predictive_log_likelihood(
        sets_of(problem, base), found, held_out
    ) - predictive_log_likelihood(sets_of(problem, base), wrong, held_out)
    assert gap > 6.0
    rival = replace(
        found, evidence=wrong.evidence - gap
    )  # as far behind there as it is ahead on the unseen run
    one = compare_rivals("weak_reverse", wrong, base, {"steady_force": rival})
    assert not one.tied_with
    (all_told,) = remove_refuted_rivals(sets_of(problem, base, wrong), wrong, [one], held_out)
    assert all_told.tied_with == ("steady_force",)


def test_a_force_is_compared_with_forces_and_an_error_of_the_measurement_with_all(
    weak: Laid,
) -> None:
    problem, base, found, _ = weak
    both = replace(
        found, effects=("weak_reverse", "heading_offset"), evidence=base.evidence + 1000.0
    )
    force = replace(found, evidence=base.evidence + 600.0)
    sets = CandidateSets(problem, ("weak_reverse", "heading_offset", "steady_force"), base)
    sets.fits |= {frozenset(f.effects): f for f in (both, force)}
    share = problem.config.select.slight_share
    assert sets.slight_gain(both) == pytest.approx(share * 600.0)
    assert sets.slight_gain(both, measurement=True) == pytest.approx(share * 1000.0)
    assert sets.slight_gain(both, own=600.0) == 0.0  # nothing but the sensor besides it
    assert sets.slight_gain(force) == pytest.approx(share * 600.0)
