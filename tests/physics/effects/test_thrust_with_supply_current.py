"""Thrust that decreases with the measured electric current: the law, its candidates, and a craft
from another integrator."""

import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import boats
import numpy as np
import pytest
from answers import diagnosed, named, nothing_missing
from real_boat import FURTHER, Real, drawn, recorded

import boatsim
from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import content, vessel
from boatsim.physics.effects.thrust_with_supply_current import current_factor
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

NOMINAL = 40.0  # [A]
NAME = "thrust_with_supply_current"
BATTERY = """
[measured]
battery_A = { neutral = 40.0, about = "current of the battery" }
"""
OWN = """
[[effect]]
use = "thrust_with_supply_current"
on = ["thrust_port_N", "thrust_starboard_N"]
fed_by = ["battery_A", "battery_A"]
loss = 0.2
"""


def with_battery(folder: Path, more: str = "", battery: str = BATTERY) -> Vessel:
    folder.mkdir(exist_ok=True)
    return vessel.load_vessel(str(boats.written(folder, "electric", boats.PLANAR + battery + more)))


@pytest.mark.parametrize(
    ("current", "loss", "factor"),
    [
        (0.0, 0.2, 1.0),
        (40.0, 0.2, 0.8),
        (80.0, 0.2, 0.6),
        (-15.0, 0.2, 1.0),  # the supply is charged
        (300.0, 0.2, 0.0),  # no thrust backwards
        (300.0, 0.0, 1.0),
    ],
)
def test_the_loss_of_thrust_is_in_proportion_to_the_current_drawn(
    current: float, loss: float, factor: float
) -> None:
    values = SimpleNamespace(loss=loss, nominal=NOMINAL)
    assert current_factor.py_func(current, values) == pytest.approx(factor)


def test_the_first_acceleration_of_a_run_decreases_with_the_current(tmp_path: Path) -> None:
    boat = with_battery(tmp_path, OWN)
    effect = boat.effect(NAME)
    assert effect is not None and effect.values().nominal == NOMINAL
    speeds = []
    for amperes in (0.0, 60.0):
        changed = boat.with_measured({"battery_A": amperes})
        goal = [{"thrust_port_N": 1.0, "thrust_starboard_N": 1.0}]
        case = boatsim.load_scenario("otter/turn", vessel=changed, duration=0.2, goal=goal)
        speeds.append(boatsim.run(case).recording["u_mps"][-1])
    assert speeds[1] / speeds[0] == pytest.approx(1.0 - 0.2 * 60.0 / NOMINAL, rel=0.01)


def test_it_is_a_candidate_where_a_current_is_measured_and_recorded(tmp_path: Path) -> None:
    assert (
        "measured quantity in A"
        in candidate_library(vessel.load_vessel("trial_boat")).inapplicable[NAME]
    )
    boat = with_battery(tmp_path)
    assert NAME in candidate_library(boat, columns=["x_m", "battery_A"]).tested_names
    assert "battery_A was recorded" in candidate_library(boat, columns=["x_m"]).excluded[NAME]
    assert "thrust_with_voltage" in candidate_library(boat).inapplicable
    (effect,) = (e for e in candidate_library(boat).entries if e.name == NAME)
    assert effect.fed_by == ("battery_A", "battery_A")  # type: ignore[attr-defined]


def test_each_drive_has_the_current_that_is_called_like_it(tmp_path: Path) -> None:
    two = (
        "\n[measured]\nmotor_starboard_A = { neutral = 20.0 }\nmotor_port_A = { neutral = 20.0 }\n"
    )
    boat = with_battery(tmp_path, battery=two)
    (effect,) = (e for e in candidate_library(boat).entries if e.name == NAME)
    fed = dict(zip(effect.on, effect.fed_by, strict=True))  # type: ignore[attr-defined]
    assert fed == {"thrust_port_N": "motor_port_A", "thrust_starboard_N": "motor_starboard_A"}


def test_a_current_without_a_nominal_value_is_answered_in_words(tmp_path: Path) -> None:
    boat = with_battery(tmp_path, battery="\n[measured]\nbattery_A = {}\n")
    assert "nominal current" in candidate_library(boat).inapplicable[NAME]


def test_shaft_rates_have_an_effect_of_their_own(tmp_path: Path) -> None:
    """Half of the speed of the shaft is a quarter of the thrust, and of the first acceleration."""
    otter = tmp_path / "otter"
    shutil.copytree(content.content_root() / "models" / "otter", otter)
    file = otter / "vessel.toml"
    file.write_text(file.read_text() + BATTERY)
    library = candidate_library(vessel.load_vessel(str(otter)))
    assert "shaft_with_supply_current" in library.tested_names
    assert NAME in library.inapplicable
    channels = ["n_port_radps", "n_starboard_radps"]
    table = {"use": "shaft_with_supply_current", "on": channels, "fed_by": ["battery_A"] * 2}
    boat = vessel.load_vessel(str(otter), extra=[{**table, "loss": 0.5}])
    speeds = []
    for amperes in (0.0, NOMINAL):
        changed = boat.with_measured({"battery_A": amperes})
        goal = [dict.fromkeys(channels, 60.0)]
        case = boatsim.load_scenario("otter/turn", vessel=changed, duration=0.2, goal=goal)
        speeds.append(boatsim.run(case).recording["u_mps"][-1])
    assert speeds[1] / speeds[0] == pytest.approx(0.25, rel=0.05)


# ---- boats from another integrator


def measured_runs(loss: float) -> list[Recording]:
    """Runs of the trial boat with a meter of the battery's current, which sometimes fails."""
    runs = []
    for seed in (1, 2, 3):
        run = recorded(Real(resistance=loss), seed)
        commands = np.column_stack([run["thrust_port_N"], run["thrust_starboard_N"]])
        shares = [drawn(t, one) for t, one in zip(run.t.tolist(), commands, strict=True)]
        amperes = NOMINAL * np.array(shares)
        amperes += 0.3 * np.random.default_rng(seed).standard_normal(len(amperes))
        amperes[[30, 31, 90]] = 655.35, 655.35, -327.0
        runs.append(replace(run, signals={**run.signals, "battery_A": amperes}))
    return runs


def electric_trial_boat(folder: Path) -> str:
    """The trial boat with a meter of the battery's current."""
    copied = folder / "electric"
    shutil.copytree(content.content_root() / "models" / "trial_boat", copied)
    file = copied / "vessel.toml"
    file.write_text(file.read_text() + BATTERY)
    return str(copied)


@pytest.mark.slow
def test_the_loss_with_the_current_is_named_with_its_value_although_some_readings_are_wrong(
    tmp_path: Path,
) -> None:
    answer = diagnosed(measured_runs(0.3), tmp_path, electric_trial_boat(tmp_path), FURTHER)
    named(answer, NAME, {"loss": 0.3})
    assert "supply_current_outliers" in str(answer["log"])


@pytest.mark.slow
def test_a_current_on_which_the_thrust_does_not_depend_is_not_named(tmp_path: Path) -> None:
    nothing_missing(diagnosed(measured_runs(0.0), tmp_path, electric_trial_boat(tmp_path), FURTHER))
