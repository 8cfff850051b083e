"""Commands that a log repeats while none arrive are told from commands that rest."""

import numpy as np
import pytest

from boatsim.diagnosis.checks.held_commands import check_held_commands
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

T = np.arange(0.0, 120.0, 0.1)
HELD = slice(400, 417)  # 1.7 s
BOAT = load_vessel("blueboat")


def recorded(seed: int = 1) -> Recording:
    """Two minutes of commands that change in every row, as those of a controller with noise."""
    rng = np.random.default_rng(seed)
    port = 40.0 * np.sin(0.2 * T) + np.cumsum(rng.normal(size=len(T)))
    starboard = 30.0 * np.cos(0.13 * T) + np.cumsum(rng.normal(size=len(T)))
    signals = {"x_m": T, "y_m": 0.0 * T, "psi_rad": 0.0 * T}
    return Recording("run", T, signals | {"thrust_port_N": port, "thrust_starboard_N": starboard})


def with_rows(recording: Recording, value, *names: str) -> Recording:
    """The recording with other commands in the rows HELD: a value, or by None the first of them."""
    signals = dict(recording.signals)
    for name in names:
        signals[name] = signals[name].copy()
        signals[name][HELD] = signals[name][HELD.start] if value is None else value
    return Recording("run", T, signals)


BOTH = ("thrust_port_N", "thrust_starboard_N")


def test_commands_that_are_repeated_for_two_seconds_are_found_with_their_time() -> None:
    (finding,) = check_held_commands(with_rows(recorded(), None, *BOTH), BOAT, DEFAULT.checks)
    assert finding.name == "commands_held"
    assert finding.spans == (pytest.approx((40.0, 41.7)),)
    assert finding.remedy == "write into recording.toml: use = [[0, 40], [41.7, 119.9]]"
    assert "for 1.7 s and then leap, while they change at least every 0.1 s" in finding.evidence


def test_commands_that_stay_the_same_for_long_are_those_of_a_helm() -> None:
    signals = dict(recorded().signals)
    for name in BOTH:
        signals[name] = signals[name].copy()
        signals[name][400:500] = signals[name][400]
    assert check_held_commands(Recording("run", T, signals), BOAT, DEFAULT.checks) == []


@pytest.mark.parametrize(
    "recording",
    [
        recorded(),
        with_rows(recorded(), None, "thrust_port_N"),  # the other one goes on
        with_rows(recorded(), 0.0, *BOTH),  # the drives are at rest
        with_rows(recorded(), 200.0, *BOTH),  # both at the largest command
        Recording("run", T, {**recorded().signals, **dict.fromkeys(BOTH, np.round(T / 20.0))}),
    ],
    ids=["none", "one of two", "at rest", "at a limit", "steps of a helm"],
)
def test_commands_that_rest_or_change_seldom_are_no_fault(recording: Recording) -> None:
    assert check_held_commands(recording, BOAT, DEFAULT.checks) == []


def test_a_log_without_poses_and_commands_was_silent_as_a_whole() -> None:
    recording = with_rows(recorded(), None, *BOTH)
    signals = dict(recording.signals)
    signals["x_m"] = signals["x_m"].copy()
    signals["x_m"][HELD] = np.nan
    assert check_held_commands(Recording("run", T, signals), BOAT, DEFAULT.checks) == []


def test_a_ramp_that_goes_on_where_it_was_held_is_no_gap() -> None:
    recording = with_rows(recorded(), None, *BOTH)
    signals = dict(recording.signals)
    for name in BOTH:  # the controller stood still: no leap behind the time
        after = signals[name][HELD.stop :] - signals[name][HELD.stop] + 1e-3
        signals[name][HELD.stop :] = signals[name][HELD.start] + after
    assert check_held_commands(Recording("run", T, signals), BOAT, DEFAULT.checks) == []
