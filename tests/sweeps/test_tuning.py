"""Tuning: designs are better on unseen boats or not adopted, meet the norm condition, repeat."""

import json
import tomllib
from pathlib import Path

import pytest

from boatsim.control.base import Controller
from boatsim.errors import BadInput
from boatsim.physics.content import load_class
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.scenario import Scenario
from boatsim.sweeps.robustness.tuned_files import JSON, TABLE, write_tuning
from boatsim.sweeps.robustness.tuned_tables import tuning_tables
from boatsim.sweeps.robustness.tuning import (
    WORST,
    Tuning,
    gain_ranges,
    meets_norm_condition,
    tune,
)

FEW = 4  # boats of a test that needs no statistics
DELAY = {"delay": [0.2]}


def made(name: str, **settings: float) -> Controller:
    controller: Controller = load_class("controller", name)(**settings)
    return controller


def tuned(seed: int = 1, budget: int = 6) -> Tuning:
    """A PID controller with hardly any damping in yaw, under a delay."""
    slow = made("pid_autopilot", ki=0.002, kd=0.2)
    gains = [("kd", None, 2.0)]
    boat = load_vessel("joystick_boat")
    return tune("pid_autopilot", slow, boat, gains, DELAY, FEW, seed, budget=budget)


@pytest.mark.slow
def test_damping_is_found_and_the_errors_of_unseen_boats_become_smaller(tmp_path: Path) -> None:
    found = tuned()
    assert found.is_better and found.designs == 6
    assert found.best.cost < 0.8 * found.start.cost
    before, after = found.start.results[0].errors, found.best.results[0].errors
    yaw = [signal.goal for signal in found.signals].index("yaw_radps")
    assert after[yaw] < before[yaw]
    assert [one.condition.words for one in found.best.results] == ["none", "delay 0.2 s"]
    for gain in found.ranges:
        assert gain.low <= found.best.gains[gain.name] <= gain.high
    former = made("pid_autopilot", ki=0.002, kd=0.2)
    write_tuning(found, "pid_autopilot", former, tmp_path)
    table = tomllib.loads((tmp_path / TABLE).read_text())["controller"]
    assert table == {"use": "pid_autopilot", "ki": 0.002, **found.best.gains}
    boat = load_vessel("joystick_boat")
    scenario = Scenario.from_settings(vessel=boat, name="tuned", controller=table, duration=1.0)
    assert scenario.controller == found.controller
    content = json.loads((tmp_path / JSON).read_text())
    assert content["tuned"]["cost"] == pytest.approx(found.best.cost)
    gains, errors = tuning_tables(found)
    assert [row[0] for row in gains.rows] == ["kd [1/s]"]
    assert len(errors.rows) == 2


@pytest.mark.slow
def test_the_same_seed_gives_the_same_gains_and_another_seed_other_designs() -> None:
    first, again, other = tuned(budget=4), tuned(budget=4), tuned(seed=2, budget=4)
    assert (again.best.gains, again.best.cost) == (first.best.gains, first.best.cost)
    assert other.best.cost != first.best.cost


@pytest.mark.slow
def test_one_design_is_the_former_one_and_is_not_called_better() -> None:
    found = tuned(budget=1)
    assert found.designs == 1 and not found.is_better
    assert found.best is found.start


def test_designs_without_the_norm_condition_cost_as_much_as_divergence() -> None:
    assert meets_norm_condition(made("l1_joystick"))
    assert not meets_norm_condition(made("l1_joystick", yaw_bandwidth=0.3, pole=0.51))
    assert WORST > 1.0


def test_a_controller_that_describes_no_loops_is_not_judged_by_them() -> None:
    assert meets_norm_condition(made("feed_forward_speed"))


def test_ranges_are_within_the_bounds_of_the_parameters() -> None:
    controller = made("l1_joystick")
    for gain in gain_ranges("l1_joystick", controller, ()):
        bounds = type(controller).params()[gain.name]
        assert bounds.low <= gain.low < getattr(controller, gain.name) < gain.high <= bounds.high


@pytest.mark.parametrize(
    ("gains", "words"),
    [
        ([("pole_", None, None)], "did you mean 'pole'"),
        ([("pole", 0.6, 2.0)], "that contains 0.48"),
        ([("pole", 0.001, 2.0)], "within 0.01:10"),
        ([("compass_trust", None, None)], "compass_trust"),  # zero has no logarithm
        ([("period", None, None)], "period"),
    ],
)
def test_a_gain_that_cannot_be_tuned_is_refused_in_one_line(gains, words) -> None:
    with pytest.raises(BadInput, match=words) as error:
        gain_ranges("l1_joystick", made("l1_joystick"), gains)
    assert "\n" not in str(error.value)


def test_a_controller_without_named_gains_needs_them() -> None:
    with pytest.raises(BadInput, match="--gain NAME with one of"):
        gain_ranges("waypoint", made("waypoint"), ())
