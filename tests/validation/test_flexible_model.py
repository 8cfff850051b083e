"""The Gaussian process of a missing force, and free runs with it."""

import numpy as np
import pytest

from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics.program import Program
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording
from validation.real.flexible_model import FlexibleModel
from validation.real.gaussian_process import GaussianProcess, fit_gaussian_process


def test_a_process_gives_a_function_of_one_input_and_ignores_another() -> None:
    rng = np.random.default_rng(3)
    X = rng.uniform(-2.0, 2.0, (200, 2))
    process = fit_gaussian_process(X, np.sin(2.0 * X[:, 0]) + 0.05 * rng.standard_normal(200))
    for x in np.linspace(-1.8, 1.8, 9):
        for other in (-1.0, 1.0):
            assert process.predict(np.array([x, other])) == pytest.approx(np.sin(2.0 * x), abs=0.06)
    assert process.lengths[1] > 5.0 * process.lengths[0]


def test_far_from_all_data_a_process_expects_nothing() -> None:
    X = np.linspace(0.0, 1.0, 50)[:, None]
    process = fit_gaussian_process(X, np.ones(50))
    assert process.predict(np.array([0.5])) == pytest.approx(1.0, abs=0.02)
    assert process.predict(np.array([1e4])) == 0.0


def constant_force(size: float) -> GaussianProcess:
    """A process whose data are one force, and whose length is so large that it is constant."""
    one = np.ones(1)
    return GaussianProcess(np.zeros((1, 1)), one, one, 1.0, np.zeros(1), 1e9 * one, size)


def turning_boat() -> tuple[Problem, Fit]:
    """A turn under commands that change, and the vessel as specified."""
    vessel, t = load_vessel("joystick_boat"), 0.2 * np.arange(100)
    signals = {
        "x_m": np.sin(0.1 * t),
        "y_m": 1.0 - np.cos(0.1 * t),
        "psi_rad": 0.1 * t + 0.01 * np.sin(3.0 * t),
    }
    for name, channel in vessel.commands.items():
        signals[name] = np.where(t > 5.0, 0.1, 0.05) * channel.high
    recording = Recording("turn", t, signals)
    levels = prior_noise_levels(vessel, [recording])
    problem = Problem([map_recording(recording, Program(vessel))], levels, {})
    return problem, fit_noise(problem, problem.nominal_hypothesis())


@pytest.mark.slow
def test_without_a_missing_force_the_flexible_model_is_the_one_that_it_extends() -> None:
    problem, fit = turning_boat()
    mapped = problem.recordings[0]
    model = FlexibleModel(problem, fit, [mapped])
    values = problem.parameter_vector(mapped, fit.free, fit.theta)
    own = mapped.free_runs(values, problem.program.effect_switches(()), fit.levels, 6.0)
    model.processes = [constant_force(0.0) for _ in model.processes]
    for (_, expected), found in zip(own, model.free_runs(mapped, 6.0), strict=True):
        assert found[:, :3] == pytest.approx(expected[:, :3], abs=1e-9)  # the pose
    assert len(own) == 3


def test_a_missing_surge_force_pushes_the_boat_ahead() -> None:
    problem, fit = turning_boat()
    mapped = problem.recordings[0]
    model = FlexibleModel(problem, fit, [mapped])
    ends = []
    for force in (0.0, 0.1):  # [N]
        model.processes = [constant_force(size) for size in (force, 0.0, 0.0)]
        states = model.free_runs(mapped, 2.0)[0]
        psi = states[-1, 2]
        ends.append(states[-1, 0] * np.cos(psi) + states[-1, 1] * np.sin(psi))
    assert ends[1] > ends[0] + 1e-4
