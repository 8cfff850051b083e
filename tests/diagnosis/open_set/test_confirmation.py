"""Each effect is confirmed by recordings that did not select it."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import BOAT, push, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge, unfitted_hypothesis
from boatsim.diagnosis.open_set.confirmation import (
    Errors,
    Outcome,
    confirmation_outcome,
    held_out_effect_errors,
)
from boatsim.diagnosis.open_set.consistency import Factor, effect_consistency
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem, prior_arrays
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.physics.base import Array
from boatsim.physics.program import Program

ONLY = "weak_reverse"
PROGRAM = Program(BOAT, candidate_library(BOAT).compiled_effects)


def weak_astern(t: float, y: Array, command: Array) -> Array:
    """A third of the thrust astern is missing."""
    return np.asarray(-0.33 * push(np.minimum(command[:2], 0.0), command[2:]))


def strong_astern(t: float, y: Array, command: Array) -> Array:
    """There is more thrust astern than in the file."""
    return np.asarray(0.2 * push(np.minimum(command[:2], 0.0), command[2:]))


def at_rest(seed: int) -> MappedRecording:
    """A recording of the boat at rest, without thrust."""
    recording = sail("rest", seed, lambda t, y, command: -push(command[:2], command[2:]))[0]
    signals = dict(recording.signals)
    for name in ("thrust_port_N", "thrust_starboard_N"):
        signals[name] = np.zeros(len(recording))
    return map_recording(replace(recording, signals=signals), PROGRAM)


@pytest.fixture(scope="module")
def fitted() -> tuple[Problem, Fit, Fit]:
    """A log of a boat that is weak astern: the problem, the fit without the effect, and with it."""
    recordings = [sail("a", 1, weak_astern)[0], sail("b", 2, weak_astern)[0]]
    problem = Problem(
        [map_recording(r, PROGRAM) for r in recordings],
        prior_noise_levels(BOAT, recordings),
        {"damping": 0.05, "thrust": 0.05},
    )
    _, without = fit_baseline(problem)
    free = problem.free_parameters((ONLY,))
    start = unfitted_hypothesis((ONLY,), free, prior_arrays(free).mean, without.levels)
    return problem, without, converge(problem, start)


def outcome(fitted: tuple[Problem, Fit, Fit], held_out: MappedRecording) -> Outcome:
    problem, without, best = fitted
    signs = effect_consistency(problem, best, {ONLY: without}, [held_out])
    errors = held_out_effect_errors(problem, best, {ONLY: without}, [held_out])
    return confirmation_outcome(problem.candidates[ONLY], errors[ONLY], signs[ONLY], DEFAULT.decide)


def test_a_true_effect_is_confirmed_and_alone_reduces_the_errors(fitted) -> None:
    problem, without, best = fitted
    held_out = map_recording(sail("c", 3, weak_astern)[0], PROGRAM)
    assert outcome(fitted, held_out) == "confirmed"
    for pair in held_out_effect_errors(problem, best, {ONLY: without}, [held_out])[ONLY].values():
        assert pair.with_effect < 0.7 * pair.without


def test_a_boat_without_the_effect_does_not_confirm_it(fitted) -> None:
    held_out = map_recording(sail("c", 3, strong_astern)[0], PROGRAM)
    assert outcome(fitted, held_out) == "unconfirmed"


def test_an_effect_that_held_out_recordings_require_in_another_size_is_not_refuted(fitted) -> None:
    problem, without, best = fitted
    held_out = map_recording(sail("c", 3, weak_astern)[0], PROGRAM)
    signs = effect_consistency(problem, best, {ONLY: without}, [held_out])[ONLY]
    worse = {"position_rms_m": Errors(0.1, 0.2)}
    for sd, expected in ((0.1, "open"), (0.4, "unconfirmed")):
        own = replace(signs, held_out=Factor(0.8, sd), held_out_gain=-3.0)
        assert (
            confirmation_outcome(problem.candidates[ONLY], worse, own, DEFAULT.decide) == expected
        )


def test_recordings_that_do_not_excite_an_effect_are_no_evidence_against_it(fitted) -> None:
    for seed in range(4):
        assert outcome(fitted, at_rest(seed)) != "unconfirmed"
