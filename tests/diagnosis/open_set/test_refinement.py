"""A better value of an estimated number is no cause, and surroundings have no implausible size."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import BOAT, Missing, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.open_set.decision import Decision, decide
from boatsim.diagnosis.open_set.refinement import refines_estimated_number
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import select_and_rank_candidates
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel

EXACT, ROUGH = BOAT, replace(BOAT, estimated={"damping": 0.3})
CANDIDATES = ("quadratic_damping", "steady_force")
NEVER = replace(DEFAULT, decide=replace(DEFAULT.decide, least_probability=1.0))


def quadratic(t: float, y: Array, command: Array) -> Array:
    """Drag with the squares of surge speed and yaw rate."""
    return np.array([-15.0 * y[3] * abs(y[3]), 0.0, -6.0 * y[5] * abs(y[5])])


def towed(t: float, y: Array, command: Array) -> Array:
    """A constant force along and across the hull: many prior standard deviations."""
    return np.array([0.5, 0.3, 0.0])


def quadratic_and_hunting(t: float, y: Array, command: Array) -> Array:
    """The same, and a push along the hull that no candidate describes."""
    return quadratic(t, y, command) + np.array([0.8 * np.sin(1.1 * t), 0.0, 0.0])


def decided(missing: Missing, vessel: Vessel, config: DiagnosisConfig = NEVER) -> Decision:
    """The decision if no probability suffices for a cause, on two logs and a held-out one."""
    program = Program(vessel, candidate_library(vessel).compiled_effects)
    logs = [sail(name, seed, missing)[0] for seed, name in enumerate("abc")]
    mapped = [map_recording(log, program) for log in logs]
    levels, uncertain = prior_noise_levels(vessel, logs), {"damping": 0.05, "thrust": 0.05}
    problem = Problem(mapped[:2], levels, uncertain, config=config)
    ranking = select_and_rank_candidates(problem, CANDIDATES, mapped[2:])
    return decide(problem, ranking, mapped[2:], len(CANDIDATES))


@pytest.mark.parametrize(
    ("vessel", "refines"),
    [pytest.param(EXACT, False, id="exact"), pytest.param(ROUGH, True, id="rough")],
)
def test_an_effect_that_refines_an_estimate_needs_no_probability(
    vessel: Vessel, refines: bool
) -> None:
    found = decided(quadratic, vessel)
    assert [one.effect.name for one in found.judgements] == ["quadratic_damping"]
    best = found.ranking.best
    assert refines_estimated_number(found.problem, best, "quadratic_damping") == refines
    named = [one.name for one in found.ranking.named]
    doubtful = [one.name for one in found.ranking.doubtful]
    assert (named, doubtful) == (
        (["quadratic_damping"], []) if refines else ([], ["quadratic_damping"])
    )


@pytest.mark.parametrize(
    ("missing", "vessel", "is_named"),
    [
        pytest.param(quadratic, EXACT, True, id="alone"),
        pytest.param(quadratic_and_hunting, EXACT, False, id="beside an unknown cause"),
        pytest.param(quadratic_and_hunting, ROUGH, True, id="estimated numbers"),
    ],
)
def test_beside_an_unknown_cause_a_name_is_less_probable(
    missing: Missing, vessel: Vessel, is_named: bool
) -> None:
    limits = replace(DEFAULT.decide, least_probability=1e-3, odds_beside_unknown=-20.0)
    found = decided(missing, vessel, replace(DEFAULT, decide=limits))
    named = "quadratic_damping" in [one.name for one in found.ranking.named]
    assert "quadratic_damping" in [one.effect.name for one in found.judgements]
    assert found.ranking.has_unexplained_force_or_cause == (missing is not quadratic)
    assert named == is_named


def test_no_force_of_the_surroundings_is_implausibly_strong() -> None:
    found = decided(towed, EXACT)
    (judged,) = found.judgements
    assert judged.effect.name == "steady_force" and judged.signs.prior_distance == 0.0
    best, shifts = found.ranking.best, []
    for free, x in zip(best.free, best.theta, strict=True):
        if free.effect == "steady_force":
            shifts.append(abs(x - free.mean) / free.sd)
    assert max(shifts) > 3.0
