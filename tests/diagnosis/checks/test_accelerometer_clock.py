"""Clock of the poses against accelerometers: a known delay and rate, and logs without an error."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from boatsim.diagnosis.checks.accelerometer_clock import correct_pose_clock, pose_clock_error
from boatsim.diagnosis.checks.data_cleaning import cleaning_findings
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

BOAT = vessel.load_vessel("kvlcc2_roll")  # 4.7 m long
RATE = 20.0  # [Hz]
NOISE = {"phi_rad": 0.001, "sensed_phi_radps2": 0.02}


def roll(seed: int = 0) -> CubicSpline:
    """A roll motion of varying size: a decay from each of some pushes."""
    rng = np.random.default_rng(seed)
    t = np.arange(-10.0, 90.0, 0.05)
    x = np.zeros_like(t)
    for begin in (5.0, 30.0, 50.0):
        since = np.maximum(t - begin, 0.0)
        x += (
            rng.uniform(0.1, 0.2)
            * (1.0 - np.exp(-since))
            * np.exp(-since / 8.0)
            * np.sin(4.0 * since)
        )
    return CubicSpline(t, x)


def recording(delay: float, rate: float, seed: int = 0, witness: bool = True) -> Recording:
    """Poses that are `delay` late in the middle, on a clock that is fast by `rate`."""
    rng = np.random.default_rng(seed)
    motion, t = roll(seed), np.arange(0.0, 70.0, 1.0 / RATE)
    middle = 0.5 * t[-1]
    # the pose stamped s was true at t: s = t + delay + rate (t - middle)
    true = (t - delay + rate * middle) / (1.0 + rate)
    signals = {"phi_rad": motion(true) + rng.normal(0.0, NOISE["phi_rad"], len(t))}
    if witness:
        felt = motion(t, 2)
        signals["sensed_phi_radps2"] = felt + rng.normal(0.0, NOISE["sensed_phi_radps2"], len(t))
    return Recording("decay", t, signals)


@pytest.mark.parametrize(("delay", "rate"), [(0.3, 0.0), (-0.2, 0.008), (2.2, -0.004), (-3.1, 0.0)])
def test_delay_and_rate_of_the_clock_are_found(delay: float, rate: float) -> None:
    error = pose_clock_error(recording(delay, rate), BOAT, DEFAULT.checks)
    assert error is not None
    assert error.delay == pytest.approx(delay, abs=0.02)
    assert error.rate == pytest.approx(rate, abs=0.001)


def test_corrected_poses_stand_at_the_times_of_the_motion() -> None:
    corrected = correct_pose_clock(recording(0.4, 0.006), BOAT, DEFAULT.checks)
    off: Array = corrected["phi_rad"] - roll()(corrected.t)
    known = np.isfinite(off)
    assert known.mean() > 0.98
    assert np.sqrt(np.mean(off[known] ** 2)) < 2.0 * NOISE["phi_rad"]
    (finding,) = cleaning_findings(corrected)
    assert finding.name == "pose_clock"
    assert finding.kind == "mended"
    assert "+0.19 s late at the beginning and +0.61 s at the end" in finding.evidence


@pytest.mark.parametrize("seed", range(5))
def test_a_log_on_one_clock_stays_as_it_is(seed: int) -> None:
    one = recording(0.0, 0.0, seed)
    assert correct_pose_clock(one, BOAT, DEFAULT.checks) is one


def test_a_log_without_accelerometers_stays_as_it_is() -> None:
    one = recording(1.0, 0.0, witness=False)
    assert correct_pose_clock(one, BOAT, DEFAULT.checks) is one


def test_an_accelerometer_of_another_motion_moves_no_pose() -> None:
    one = recording(0.5, 0.0)
    other = roll(seed=7)(0.8 * one.t, 2)
    one = replace(one, signals={**one.signals, "sensed_phi_radps2": other})
    assert correct_pose_clock(one, BOAT, DEFAULT.checks) is one


def test_empty_cells_stay_empty() -> None:
    one = recording(0.5, 0.0)
    roll_angle = one["phi_rad"].copy()
    roll_angle[700:740] = np.nan
    one = replace(one, signals={**one.signals, "phi_rad": roll_angle})
    corrected = correct_pose_clock(one, BOAT, DEFAULT.checks)
    assert np.isnan(corrected["phi_rad"][692:728]).all()
    assert np.isfinite(corrected["phi_rad"][200:600]).all()
