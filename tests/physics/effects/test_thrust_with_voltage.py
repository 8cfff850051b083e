"""Thrust that grows with a power of the measured voltage: the law, its binding, its candidates, and a
craft from another integrator."""

import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import boats
import numpy as np
import pytest
from answers import diagnosed, named, nothing_missing
from real_boat import FURTHER, Real, recorded, voltage

import boatsim
from boatsim.diagnosis.candidates import candidate_library
from boatsim.errors import BadInput
from boatsim.physics import content, vessel
from boatsim.physics.effects.thrust_with_voltage import voltage_factor
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

BATTERY = """
[measured]
battery_V = { neutral = 24.0, about = "supply of both drives" }
"""
OWN = """
[[effect]]
use = "thrust_with_voltage"
on = ["thrust_port_N", "thrust_starboard_N"]
fed_by = ["battery_V", "battery_V"]
exponent = 2.0
"""


def with_battery(folder: Path, more: str = "", battery: str = BATTERY) -> Vessel:
    folder.mkdir(exist_ok=True)
    return vessel.load_vessel(str(boats.written(folder, "electric", boats.PLANAR + battery + more)))


@pytest.mark.parametrize(
    ("voltage", "exponent", "factor"),
    [
        (24.0, 2.0, 1.0),
        (12.0, 2.0, 0.25),
        (21.6, 2.0, 0.81),
        (26.4, 1.0, 1.1),
        (1.9, 2.0, 0.25),  # no supply of a drive that runs: held at half
        (79.0, 2.0, 2.25),
        (79.0, 0.0, 1.0),
        (0.0, 0.0, 1.0),
    ],
)
def test_thrust_is_a_power_of_the_voltage_within_what_a_battery_has(
    voltage: float, exponent: float, factor: float
) -> None:
    values = SimpleNamespace(exponent=exponent, nominal=24.0)
    assert voltage_factor.py_func(voltage, values) == pytest.approx(factor)


def test_a_run_at_a_lower_voltage_has_the_force_of_the_power_of_the_voltage(tmp_path: Path) -> None:
    """The first acceleration is in proportion to the thrust."""
    boat = with_battery(tmp_path, OWN)
    effect = boat.effect("thrust_with_voltage")
    assert effect is not None and effect.values().nominal == 24.0
    speeds = []
    for volts in (24.0, 18.0):
        changed = boat.with_measured({"battery_V": volts})
        goal = [{"thrust_port_N": 1.0, "thrust_starboard_N": 1.0}]
        case = boatsim.load_scenario("otter/turn", vessel=changed, duration=0.2, goal=goal)
        speeds.append(boatsim.run(case).recording["u_mps"][-1])
    assert speeds[1] / speeds[0] == pytest.approx(0.75**2, rel=0.01)


def test_it_is_a_candidate_where_a_voltage_is_measured_and_recorded(tmp_path: Path) -> None:
    name = "thrust_with_voltage"
    assert name in candidate_library(vessel.load_vessel("trial_boat")).inapplicable
    boat = with_battery(tmp_path)
    assert name in candidate_library(boat).tested_names
    assert name in candidate_library(boat, columns=["x_m", "battery_V"]).tested_names
    assert "battery_V was recorded" in candidate_library(boat, columns=["x_m"]).excluded[name]
    (effect,) = (e for e in candidate_library(boat).entries if e.name == name)
    assert effect.on == ("thrust_port_N", "thrust_starboard_N")
    assert effect.fed_by == ("battery_V", "battery_V")  # type: ignore[attr-defined]


def test_each_drive_has_the_voltage_that_is_called_like_it(tmp_path: Path) -> None:
    two = "\n[measured]\nsupply_starboard_V = { neutral = 12.0 }\nsupply_port_V = { neutral = 12.0 }\n"
    boat = with_battery(tmp_path, battery=two)
    (effect,) = (e for e in candidate_library(boat).entries if e.name == "thrust_with_voltage")
    fed = dict(zip(effect.on, effect.fed_by, strict=True))  # type: ignore[attr-defined]
    assert fed == {"thrust_port_N": "supply_port_V", "thrust_starboard_N": "supply_starboard_V"}


def test_voltages_that_cannot_be_assigned_or_have_no_nominal_value_are_answered_in_words(
    tmp_path: Path,
) -> None:
    name = "thrust_with_voltage"
    unclear = "\n[measured]\none_V = { neutral = 12.0 }\ntwo_V = { neutral = 12.0 }\n"
    boat = with_battery(tmp_path / "a", battery=unclear)
    assert "assigned to each drive" in candidate_library(boat).inapplicable[name]
    boat = with_battery(tmp_path / "b", battery="\n[measured]\nbattery_V = {}\n")
    assert "nominal voltage" in candidate_library(boat).inapplicable[name]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ('fed_by = ["batery_V", "battery_V"]', "did you mean 'battery_V'"),
        ('fed_by = ["thrust_port_N", "battery_V"]', "thrust_port_N"),
        ("", "fed_by is missing"),
    ],
)
def test_a_wrong_binding_is_refused(tmp_path: Path, wrong: str, message: str) -> None:
    table = OWN.replace('fed_by = ["battery_V", "battery_V"]', wrong)
    with pytest.raises(BadInput, match=message):
        with_battery(tmp_path, table)


def test_shaft_rates_have_an_effect_of_their_own(tmp_path: Path) -> None:
    """Half of the speed of the shaft is a quarter of the thrust, and of the first acceleration."""
    otter = tmp_path / "otter"
    shutil.copytree(content.content_root() / "models" / "otter", otter)
    file = otter / "vessel.toml"
    file.write_text(file.read_text() + BATTERY)
    library = candidate_library(vessel.load_vessel(str(otter)))
    assert "shaft_with_voltage" in library.tested_names
    assert "thrust_with_voltage" in library.inapplicable
    channels = ["n_port_radps", "n_starboard_radps"]
    table = {"use": "shaft_with_voltage", "on": channels, "fed_by": ["battery_V"] * 2}
    boat = vessel.load_vessel(str(otter), extra=[{**table, "exponent": 1.0}])
    speeds = []
    for volts in (24.0, 12.0):
        changed = boat.with_measured({"battery_V": volts})
        goal = [dict.fromkeys(channels, 60.0)]
        case = boatsim.load_scenario("otter/turn", vessel=changed, duration=0.2, goal=goal)
        speeds.append(boatsim.run(case).recording["u_mps"][-1])
    assert speeds[1] / speeds[0] == pytest.approx(0.25, rel=0.05)


# ---- boats from other integrators

CHARGES = ((1.05, 0.97), (0.92, 0.86), (0.82, 0.78))  # at begin and end of each run


def measured_runs(power: float, wrong: bool = False) -> list[Recording]:
    """Runs of the trial boat with a voltmeter, which in some rows reads nonsense."""
    runs = []
    for seed, charge in enumerate(CHARGES, 1):
        real = Real(supply=power, charge=charge)
        run = recorded(real, seed)
        volts = 24.0 * np.array([voltage(t, real) for t in run.t.tolist()])
        volts += 0.05 * np.random.default_rng(seed).standard_normal(len(volts))
        if wrong:
            volts[[30, 31, 90]] = 1.9, 1.9, 79.0
        runs.append(replace(run, signals={**run.signals, "battery_V": volts}))
    return runs


def electric_trial_boat(folder: Path) -> str:
    """The trial boat with a voltmeter."""
    copied = folder / "electric"
    shutil.copytree(content.content_root() / "models" / "trial_boat", copied)
    file = copied / "vessel.toml"
    file.write_text(file.read_text() + BATTERY)
    return str(copied)


@pytest.mark.slow
def test_the_power_of_the_voltage_is_named_with_its_value_although_some_readings_are_wrong(
    tmp_path: Path,
) -> None:
    boat = electric_trial_boat(tmp_path)
    answer = diagnosed(measured_runs(2.0, wrong=True), tmp_path, boat, FURTHER)
    named(answer, "thrust_with_voltage", {"exponent": 2.0})
    assert "voltage_outliers" in str(answer["log"])


@pytest.mark.slow
def test_a_voltage_on_which_the_thrust_does_not_depend_is_not_named(tmp_path: Path) -> None:
    nothing_missing(diagnosed(measured_runs(0.0), tmp_path, electric_trial_boat(tmp_path), FURTHER))
