"""A synthetic pendulum with a known truth: noise of a measured torque, pushes, rest, and names."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.stats import multivariate_normal

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.checks.cut_recordings import parts_outside_intervals
from boatsim.diagnosis.checks.rest import intervals_at_rest
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.input_noise import input_noise_density, interpolate_measured_inputs
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics import vessel
from boatsim.physics.program import Program
from boatsim.recordings.table import Notes, Recording, TimedCommands
from tests.boats import box_in_measured_wave
from tests.driven_pendulum import FILE, PUSH, Pendulum, recording

GAIN, FRICTION = 0.8, 0.15  # of the truth: [-], [N m]
PENDULUM = vessel.load_vessel("pendulum")


@pytest.mark.slow
def test_the_diagnosis_names_the_friction_and_the_gain_and_reports_the_push() -> None:
    real = Pendulum(gain=GAIN, friction=FRICTION, torque_sd=0.3)
    runs = [recording(1, 20.0, replace(real, pushed=True)), recording(2, 20.0, real)]
    held_out = recording(3, 15.0, real)
    loaded = LoadedRecordings(runs, [held_out], {FILE: PENDULUM}, "run 3", horizon=1.0)
    answer = pipeline.diagnose_loaded(loaded).findings.answer
    named = {effect["name"]: effect["parameters"] for effect in answer["effects"]}
    assert set(named) == {"load_gain_error", "dry_friction"}, json.dumps(answer["sentence"])
    factor, roll = named["load_gain_error"]["factor"], named["dry_friction"]["roll_Nm"]
    assert factor["value"] == pytest.approx(GAIN, abs=max(3.0 * factor["sd"], 0.03))
    assert roll["value"] == pytest.approx(FRICTION, abs=max(3.0 * roll["sd"], 0.02))
    (finding,) = [entry for entry in answer["log"] if entry["name"] == "unrecorded_push"]
    ((begin, end),) = finding["spans_s"]
    assert begin == pytest.approx(PUSH[0], abs=0.25) and end == pytest.approx(PUSH[1], abs=0.25)


def test_the_noise_of_a_measured_torque_is_found_at_any_rate() -> None:
    t = np.arange(0.0, 40.0, 0.005)
    switched = np.sign(np.sin(2.0 * t))  # the steps of a bang-bang torque are no noise
    noisy = switched + 0.2 * np.random.default_rng(0).standard_normal(len(t))
    whole = Recording("rig", t, {"phi_rad": 0.0 * t, "torque_Nm": noisy})
    for one in (whole, whole.thinned(20.0)):
        density = input_noise_density(PENDULUM, one, ("roll",), DEFAULT.load)
        assert density == pytest.approx([0.2**2 * 0.005], rel=0.15)
    boat = vessel.load_vessel("kvlcc2_roll")
    assert input_noise_density(boat, whole, ("roll",), DEFAULT.load).tolist() == [0.0]


def test_a_measured_torque_follows_the_straight_line_between_its_samples() -> None:
    ramp = np.column_stack([np.arange(5.0), 10.0 * np.arange(5.0)])
    found = interpolate_measured_inputs(ramp, [1])
    assert found[:, 0].tolist() == ramp[:, 0].tolist()
    assert found[:4, 1].tolist() == [5.0, 15.0, 25.0, 35.0]


def test_the_filter_with_noise_of_a_measured_force_equals_the_dense_gaussian() -> None:
    boat = vessel.load_vessel("kvlcc2_roll")
    rng = np.random.default_rng(3)
    t = 0.2 * np.arange(30)
    phi = 0.1 * np.cos(2.46 * t) + 1e-3 * rng.standard_normal(len(t))
    found = map_recording(Recording("roll", t, {"phi_rad": phi}), Program(boat))
    white = 40.0  # [N^2 m^2 s]
    levels = NoiseLevels(np.array([3.0]), 1.5, {"roll_sd_rad": 1e-3}, white=np.array([white]))
    inertia, damping, stiffness = 115.6 + 19.8, 6.7, 822.3
    h, n = 0.2, len(t)
    A = np.array([[0, 1, 0], [-stiffness / inertia, -damping / inertia, 1 / inertia], [0, 0, 0]])
    F = expm(A * h)
    held = np.append(F[:2, 2], 0.0)  # motion per unit of a moment that is held over h
    F[2, 2] = np.exp(-h / 1.5)
    Q = np.diag([0.0, 0.0, 9.0 * (1 - F[2, 2] ** 2)]) + np.outer(held, held) * white / h
    P = found.initial_state_prior.covariance.copy()
    P[0, 0], P[2, 2] = 1e-6, 9.0
    big, mean, centre = np.zeros((3 * n, 3 * n)), np.zeros(3 * n), np.array([phi[0], 0.0, 0.0])
    for i in range(n):
        mean[3 * i : 3 * i + 3] = centre
        cross = P
        for j in range(i, n):
            big[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] = cross
            big[3 * j : 3 * j + 3, 3 * i : 3 * i + 3] = cross.T
            cross = cross @ F.T
        P, centre = F @ P @ F.T + Q, F @ centre
    rows = 3 * np.arange(1, n)
    dense = multivariate_normal(mean[rows], big[np.ix_(rows, rows)] + 1e-6 * np.eye(n - 1))
    seen = found.filter(found.values, found.program.effect_switches(), levels).log_likelihood
    seen -= 0.5 * len(rows) * np.log(2.0 * np.pi)
    assert seen == pytest.approx(dense.logpdf(phi[1:]), abs=0.3)  # as linear as the filter is


def test_stretches_at_rest_are_found_and_cut_out() -> None:
    t = np.arange(0.0, 20.0, 0.02)
    phi = np.where((t > 5.0) & (t < 12.0), 0.6 * np.sin(3.0 * (t - 5.0)), 0.0)
    run = Recording("rig", t, {"phi_rad": phi})
    intervals = intervals_at_rest(run, PENDULUM, DEFAULT)
    assert [round(x) for one in intervals for x in one] == [0, 5, 12, 20]
    (piece,) = parts_outside_intervals(run, intervals)
    assert piece.name.startswith("rig (") and 4.5 < piece.t[0] < 5.2 and 11.8 < piece.t[-1] < 12.5


def test_a_body_that_follows_a_small_wave_is_not_at_rest(tmp_path: Path) -> None:
    box, t = box_in_measured_wave(tmp_path), np.arange(0.0, 40.0, 0.05)
    wave = np.where(t > 15.0, 0.01 * np.sin(6.0 * t), 1e-4 * np.cos(t))
    still = np.zeros(len(t))
    heave = np.where(t > 15.0, 1e-4 * np.sin(6.0 * t), 0.0)
    signals = {"y_m": still, "z_m": heave, "phi_rad": still}
    alone = intervals_at_rest(Recording("tank", t, signals), box, DEFAULT)
    assert [round(x) for one in alone for x in one] == [0, 40]
    in_wave = intervals_at_rest(Recording("tank", t, signals | {"wave_m": wave}), box, DEFAULT)
    assert [round(x) for one in in_wave for x in one] == [0, 15]


def test_pieces_keep_the_name_of_the_whole_and_drop_what_is_too_short() -> None:
    t = np.arange(0.0, 10.0, 0.1)
    run = Recording("rig", t, {"phi_rad": t}, notes=Notes())
    first, last = parts_outside_intervals(run, [(3.0, 4.0)])
    assert (first.name, last.name) == ("rig (0 to 2.9 s)", "rig (4.1 to 9.9 s)")
    (kept,) = parts_outside_intervals(last, [(5.0, 5.5)])  # nine rows in front of it are too few
    assert kept.name == "rig (5.6 to 9.9 s)"
    assert parts_outside_intervals(run, []) == [run]


def test_a_thinned_recording_keeps_all_samples_of_the_torque() -> None:
    t = np.arange(0.0, 2.0, 0.01)
    run = Recording("rig", t, {"phi_rad": 0.0 * t, "torque_Nm": t}).thinned(20.0)
    assert isinstance(run.orders, TimedCommands)
    mapped = map_recording(run, Program(PENDULUM))
    assert len(mapped.command_times) == len(t)
    assert mapped.command_values[:3, 0] == pytest.approx([0.005, 0.015, 0.025])
