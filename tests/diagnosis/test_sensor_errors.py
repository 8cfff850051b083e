"""Errors of a gyro and of a compass beside it: a boat made elsewhere, with the error put on
afterwards."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from alike import long
from answers import diagnosed, named, nothing_missing
from real_boat import FURTHER, Real, recorded
from scipy.interpolate import CubicSpline

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import content, vessel
from boatsim.physics.base import Array, MeasuredMotion
from boatsim.physics.effects.clock_rate import ClockRate
from boatsim.physics.effects.sensor_error import SensorError
from boatsim.physics.recorded_channels import CHANNELS
from boatsim.recordings.table import Recording

GYRO = 0.01  # [rad/s] noise
POSES = ("x_m", "y_m", "psi_rad")
BOAT = vessel.load_vessel("trial_boat")


def delayed(t: Array, value: Array) -> Array:
    return np.asarray(CubicSpline(t, value)(np.maximum(t - 0.15, t[0])))


def with_gyro(
    column: str = "", error: Callable[[Array, Array], Array] | None = None
) -> list[Recording]:
    """Three recordings of poses and yaw rate, one column of them with an error."""
    runs = [recorded(Real(), seed, gyro=GYRO) for seed in (1, 2, 3)]
    if error is None:
        return runs
    return [replace(r, signals=r.signals | {column: error(r.t, r[column])}) for r in runs]


def test_sensor_errors_are_candidates_where_their_columns_were_recorded_and_nowhere_else() -> None:
    usual = candidate_library(BOAT)
    assert candidate_library(BOAT, (), None, POSES).entries == usual.entries
    for effect in usual.entries:
        assert not isinstance(effect, SensorError)
    with_rate = candidate_library(BOAT, (), None, (*POSES, "r_radps"))
    added = {e.name for e in with_rate.entries} - {e.name for e in usual.entries}
    errors = {"gain", "offset", "drift"}
    assert added == {f"yaw_rate_{e}" for e in errors} | {"heading_delay", "heading_drift"}
    for rate in ("u_mps", "v_mps"):
        found = {e.name for e in candidate_library(BOAT, (), None, (*POSES, rate)).entries}
        word = {"u_mps": "surge", "v_mps": "sway"}[rate]
        assert found - {e.name for e in usual.entries} == {f"{word}_velocity_{e}" for e in errors}


def test_every_special_case_is_a_candidate_of_a_boat_with_all_freedoms_and_all_columns() -> None:
    boat = vessel.load_vessel("otter")
    special = {}
    for name in content.shipped_content_names("effect"):
        kind = content.load_class("effect", name)
        if issubclass(kind, SensorError) and kind is not SensorError:
            special[name] = kind
    assert set(special) <= {e.name for e in candidate_library(boat, (), None, CHANNELS).entries}
    for column in CHANNELS[2:]:
        library = candidate_library(boat, (), None, [c for c in CHANNELS if c != column])
        without = set(special) - {e.name for e in library.entries}
        assert without == {n for n, kind in special.items() if column in kind.needs_columns}
        assert {library.inapplicable[n] for n in without} <= {f"no column {column} was recorded"}


@pytest.mark.slow
def test_a_perfect_gyro_names_nothing(tmp_path: Path) -> None:
    nothing_missing(diagnosed(with_gyro(), tmp_path, "trial_boat", library=FURTHER))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("column", "error", "name", "true"),
    [
        ("r_radps", lambda t, r: r + 0.03, "yaw_rate_offset", {"offset_radps": 0.03}),
        long("r_radps", lambda t, r: 1.08 * r, "yaw_rate_gain", {"gain_fraction": 0.08}),
        long("r_radps", lambda t, r: r + 0.002 * t, "yaw_rate_drift", {"drift_radps2": 0.002}),
        ("psi_rad", delayed, "heading_delay", {"delay_s": 0.15}),
    ],
    ids=["offset", "gain", "drift", "delay"],
)
def test_an_error_of_one_channel_is_named_with_its_value(
    tmp_path: Path,
    column: str,
    error: Callable[[Array, Array], Array],
    name: str,
    true: dict[str, float],
) -> None:
    answer = diagnosed(with_gyro(column, error), tmp_path, "trial_boat", library=FURTHER)
    named(answer, name, true)
    assert answer["effects"][0]["kind"] == "measurement"
    assert "not physics" in answer["effects"][0]["words"]


def with_all_velocities(rate: float) -> list[Recording]:
    """Three recordings of poses and velocities on a clock whose second lasts `rate` seconds."""
    runs = [recorded(Real(), seed, gyro=GYRO, log=0.005) for seed in (1, 2, 3)]
    return [replace(run, t=run.t / rate) for run in runs]


def test_a_clock_rate_is_a_candidate_where_speed_and_yaw_rate_were_recorded() -> None:
    for columns in (POSES, (*POSES, "u_mps"), (*POSES, "r_radps")):
        assert "clock_rate" not in {
            e.name for e in candidate_library(BOAT, (), None, columns).entries
        }
    both = candidate_library(BOAT, (), None, (*POSES, "u_mps", "r_radps"))
    assert "clock_rate" in {e.name for e in both.entries}


def test_a_wrong_clock_makes_all_velocities_differ_by_one_factor() -> None:
    effect = ClockRate(fraction=0.25).with_all_parameters(BOAT)
    true = MeasuredMotion(*np.arange(1.0, 13.0))
    found = MeasuredMotion(*ClockRate.apply_measurement_error(true, effect.values()))
    assert found[:6] == pytest.approx(true[:6])
    assert found[6:] == pytest.approx(0.8 * np.array(true[6:]))


@pytest.mark.slow
def test_a_clock_that_runs_slowly_is_named(tmp_path: Path) -> None:
    answer = diagnosed(with_all_velocities(1.08), tmp_path, "trial_boat", library=FURTHER)
    assert "clock_rate" in {effect["name"] for effect in answer["effects"]}
    [found] = [effect for effect in answer["effects"] if effect["name"] == "clock_rate"]
    assert found["parameters"]["fraction"]["value"] == pytest.approx(0.08, abs=0.02)


@pytest.mark.slow
def test_a_right_clock_beside_velocities_names_nothing(tmp_path: Path) -> None:
    nothing_missing(diagnosed(with_all_velocities(1.0), tmp_path, "trial_boat", library=FURTHER))
