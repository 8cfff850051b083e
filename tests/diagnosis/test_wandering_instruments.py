"""Instruments whose error wanders: the filter against the normal distribution written out, and data
made elsewhere."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from answers import diagnosed
from real_boat import FURTHER, Real, recorded

from boatsim.diagnosis.candidates import candidate_library, program_with_candidates
from boatsim.diagnosis.filter import MappedRecording, NoiseLevels
from boatsim.diagnosis.filter_arguments import inertia_with_added_mass
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.facts import first_invalid_fact
from boatsim.physics.kernel.records import InitialState
from boatsim.physics.program import Program
from boatsim.recordings.table import Recording

NOISE, RMS, TIME = 0.01, 0.05, 4.0  # [m], [m], [s]


def laid_at_rest(x: Array, every: float) -> tuple[Program, MappedRecording]:
    boat = vessel.load_vessel("trial_boat")
    program = program_with_candidates(boat, ["position_wander", "extra_mass"])
    t = every * np.arange(len(x))
    still = {name: np.zeros(len(x)) for name in ("y_m", "psi_rad", *boat.commands)}
    return program, map_recording(Recording("still", t, {"x_m": x} | still), program)


def likelihood(x: Array, every: float, rms: float) -> float:
    """Of a boat that lies as good as fast, with this wander in x."""
    program, laid = laid_at_rest(x, every)
    mean, covariance = np.zeros(9), np.full((9, 9), 1e-18)
    covariance[6:9, 6:9] = 0.0
    mean[0] = x[0]
    measured = laid.measured.copy()
    measured[:, 1:] = np.nan
    initial = InitialState(mean, covariance, np.zeros(3))
    laid = replace(laid, measured=measured, specified_initial=initial)
    values = laid.values.copy()
    for name, value in (("position", rms), ("time", TIME)):
        values[program.parameter_index("position_wander", name)] = value
    families = {"position_sd_m": NOISE, "heading_sd_rad": 0.01}
    levels = NoiseLevels(np.full(3, 1e-9), 1.0, families)
    return float(laid.log_likelihood(values, program.effect_switches(["position_wander"]), levels))


@pytest.mark.slow
def test_likelihood_is_that_of_the_normal_distribution_written_out() -> None:
    """Fixes of a boat at rest: noise of each and an error that decays as exp(-t/T); where it lies
    is unknown."""
    rng, every, n = np.random.default_rng(3), 0.5, 30
    t = every * np.arange(n)
    wander = RMS**2 * np.exp(-np.abs(t[:, None] - t) / TIME)
    x = rng.multivariate_normal(np.zeros(n), wander + NOISE**2 * np.eye(n))

    def difference(rms: float) -> float:
        """Log density of the later fixes less the first: the place of the boat cancels."""
        C = rms**2 / RMS**2 * wander + NOISE**2 * np.eye(n)
        to = np.hstack([-np.ones((n - 1, 1)), np.eye(n - 1)])
        D, d = to @ C @ to.T, to @ x
        return float(-0.5 * d @ np.linalg.solve(D, d) - 0.5 * np.linalg.slogdet(D)[1])

    for rms in (RMS, 2.0 * RMS):  # none of the fixes is an outlier for these
        assert likelihood(x, every, rms) == pytest.approx(difference(rms), abs=1e-6)


def test_added_mass_does_not_calm_the_water() -> None:
    """The latent force shakes a heavier hull as much: otherwise mass would be believed for making
    errors smaller."""
    boat = vessel.load_vessel("trial_boat")
    program = program_with_candidates(boat, ["position_wander", "extra_mass"])
    values = np.append(program.values(), program.body)
    heavier = values.copy()
    heavier[program.parameter_index("extra_mass", "mass")] = boat.body.mass
    light, heavy = (
        inertia_with_added_mass(program, v, program.effect_switches(["extra_mass"]))
        for v in (values, heavier)
    )
    assert heavy[0] == pytest.approx(light[0] + boat.body.mass)
    x = np.random.default_rng(0).normal(0.0, 0.003, 200)
    _, laid = laid_at_rest(x, 0.2)
    levels = NoiseLevels(np.full(3, 0.05), 1.0, {"position_sd_m": 0.003, "heading_sd_rad": 0.01})
    on = program.effect_switches(["extra_mass"])
    still, moved = (laid.log_likelihood(v, on, levels) for v in (values, heavier))
    assert (
        moved < still
    )  # a boat that lies in calmer water than assumed: 10 nats for twice the mass, were it a force


def wandering(run: Recording, sd: float, time: float, seed: int) -> Recording:
    """Fixes off by an Ornstein-Uhlenbeck error north and east."""
    rng, signals = np.random.default_rng(seed), dict(run.signals)
    for name in ("x_m", "y_m"):
        error = [sd * rng.standard_normal()]
        for dt in np.diff(run.t):
            kept = np.exp(-dt / time)
            error.append(kept * error[-1] + sd * np.sqrt(1.0 - kept**2) * rng.standard_normal())
        signals[name] = signals[name] + np.array(error)
    return replace(run, signals=signals)


def also_true(power: float) -> tuple[str, ...]:
    """Effects that the boat has besides: its loss of thrust grows with the load."""
    return ("thrust_exponent",) if power != 1.0 else ()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("power", "names"),
    [(1.0, ["position_wander"]), (0.7, ["position_wander", "thrust_gain_error"])],
)
def test_wander_is_named_as_such_and_physics_beside_it(
    tmp_path: Path, power: float, names: list[str]
) -> None:
    runs = [wandering(recorded(Real(power=(power, power)), s, 5), 0.1, 20.0, s) for s in (1, 2, 3)]
    (tmp_path / "recording.toml").write_text(
        'vessel = "trial_boat"\n[facts]\nposition_fix = "gnss"\n'
    )
    said = diagnosed(runs, tmp_path, "trial_boat", FURTHER)
    found = {e["name"]: e["parameters"] for e in said["effects"]}
    assert set(names) <= set(found) <= {*names, *also_true(power)}, said["sentence"]
    assert said["verdict"] == "named", said["sentence"]
    assert 0.05 < found["position_wander"]["position_m"]["value"] < 0.3
    if power < 1.0:
        factor = found["thrust_gain_error"]["factor"]
        assert abs(factor["value"] - power) < 3.0 * factor["sd"]


def test_a_camera_does_not_wander() -> None:
    boat = vessel.load_vessel("trial_boat")
    left_out = candidate_library(boat, facts={"position_fix": "camera"}).excluded
    assert left_out["position_wander"] == "position_fix = camera"
    assert "position_wander" in candidate_library(boat, facts={"position_fix": "gnss"}).tested_names


@pytest.mark.slow
def test_a_stated_wander_is_known_from_the_start(tmp_path: Path) -> None:
    runs = [wandering(recorded(Real(power=(0.7, 0.7)), s, 5), 0.1, 20.0, s) for s in (1, 2, 3)]
    facts = "position_wander_sd_m = 0.1\nposition_wander_time_s = 20.0\n"
    (tmp_path / "recording.toml").write_text(f'vessel = "trial_boat"\n[facts]\n{facts}')
    said = diagnosed(runs, tmp_path, "trial_boat", FURTHER)
    found = {e["name"] for e in said["effects"]}
    assert {"thrust_gain_error"} <= found <= {"thrust_gain_error", *also_true(0.7)}
    assert said["verdict"] == "named"
    assert said["facts"]["position_wander_sd_m"] == 0.1


def test_a_stated_wander_must_be_complete() -> None:
    assert first_invalid_fact({"position_wander_sd_m": 0.1}) is not None
    assert (
        first_invalid_fact({"position_wander_sd_m": 0.1, "position_wander_time_s": -1.0})
        is not None
    )
    assert first_invalid_fact({"position_wander_sd_m": 0.1, "position_wander_time_s": 30.0}) is None
