"""Commands that a log repeats while none arrive are told from commands that rest."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.checks.held_commands import check_held_commands
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics.base import Array
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

T = np.arange(0.0, 120.0, 0.1)
HELD = slice(400, 417)  # 1.7 s
BOAT, FOUR = load_vessel("blueboat"), load_vessel("trial_boat")
PORT, STARBOARD = "thrust_port_N", "thrust_starboard_N"
STEER = ("steer_port_rad", "steer_starboard_rad")


def noisy(seed: int, size: float = 1.0) -> Array:
    """Values (N,) that change in every row, as commands of a controller."""
    rng = np.random.default_rng(seed)
    return 10.0 * size * np.sin(0.2 * T + seed) + size * np.cumsum(rng.normal(size=len(T)))


def log(**commands: Array) -> Recording:
    signals = {"x_m": T, "y_m": 0.0 * T, "psi_rad": 0.0 * T}
    return Recording("run", T, signals | commands)


def held(values: Array, value: float | None = None, rows: slice = HELD) -> Array:
    """Values (N,) that some rows repeat: the first of these, or a given one."""
    found = values.copy()
    found[rows] = values[rows.start] if value is None else value
    return found


def findings(recording: Recording, vessel=BOAT, **settings):
    return check_held_commands(recording, vessel, replace(DEFAULT.checks, **settings))


BOTH = {PORT: noisy(1), STARBOARD: noisy(2)}
GAP = {name: held(values) for name, values in BOTH.items()}


def test_commands_that_are_repeated_for_two_seconds_are_found_with_their_time() -> None:
    (finding,) = findings(log(**GAP))
    assert finding.name == "commands_held"
    assert finding.spans == (pytest.approx((40.0, 41.7)),)
    assert "for 1.7 s and then leap, while they change in nearly every row" in finding.evidence


def test_a_row_without_a_command_hides_no_gap() -> None:
    missing = GAP[PORT].copy()
    missing[700] = np.nan
    assert findings(log(**GAP | {PORT: missing}))


@pytest.mark.parametrize(
    "commands",
    [
        BOTH,
        {PORT: held(noisy(1)), STARBOARD: noisy(2)},
        {name: held(values, 0.0) for name, values in BOTH.items()},
        {name: held(values, 200.0) for name, values in BOTH.items()},
        {name: held(values, rows=slice(400, 500)) for name, values in BOTH.items()},
    ],
    ids=["none", "one of two", "at rest", "at a limit", "for 10 s, as by a helm"],
)
def test_commands_that_rest_are_no_fault(commands: dict[str, Array]) -> None:
    assert findings(log(**commands)) == []


def test_a_cruise_throttle_beside_a_steering_at_its_limit_is_no_gap() -> None:
    """An autopilot steers at its limit in each turn; the throttle rests between its steps."""
    throttle = np.where(T < 5.0, 0.0, np.where(T < 60.0, 30.0, 40.0))
    throttle[-30:] = 60.0
    turn = np.abs(T % 20.0 - 10.0) < 0.8
    steer = {name: np.where(turn, 0.5, 0.01 * noisy(3)).clip(-0.5, 0.5) for name in STEER}
    assert findings(log(**{PORT: throttle, STARBOARD: throttle}, **steer), FOUR) == []


@pytest.mark.parametrize("ahead", [True, False])
def test_a_pause_of_a_planned_experiment_is_no_gap(ahead: bool) -> None:
    """A chirp about a trim, a pause, and a step: the commands do not move behind the pause."""
    chirp = 20.0 + 5.0 * np.sin(0.02 * T**2)
    commands = {}
    for name, size in ((PORT, 1.0), (STARBOARD, 0.8)):
        values = size * chirp
        values[800:816] = values[800]
        values[816:830] = values[800] + 20.0
        commands[name] = values if ahead else values[::-1].copy()
    assert findings(log(**commands)) == []


def test_commands_that_change_in_one_of_four_rows_are_not_judged() -> None:
    """A helm in steps of 0.4 s, which pauses for 1.9 s."""
    commands = {}
    for name, values in BOTH.items():
        commands[name] = held(np.repeat(values[:300], 4), rows=slice(400, 419))
    assert findings(log(**commands), held_times=4.0, held_moving=0.1)
    assert findings(log(**commands), held_times=4.0) == []


def test_a_log_with_few_changes_does_not_show_what_is_usual() -> None:
    assert findings(log(**GAP), held_changes=2000) == []


def test_a_log_without_poses_and_commands_was_silent_as_a_whole() -> None:
    recording = log(**GAP)
    signals = dict(recording.signals) | {"x_m": T.copy()}
    signals["x_m"][HELD] = np.nan
    assert findings(Recording("run", T, signals)) == []


def test_commands_that_go_on_where_they_were_held_are_no_gap() -> None:
    commands = {}
    for name, values in BOTH.items():  # the controller stood still: no leap behind the time
        after = values[HELD.stop :] - values[HELD.stop] + 1e-3
        commands[name] = held(values)
        commands[name][HELD.stop :] = values[HELD.start] + after
    assert findings(log(**commands)) == []
