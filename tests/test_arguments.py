"""Arguments of the Python interface: what is not allowed is one line that names the argument."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import boatsim
from boatsim.errors import BadInput

SCENARIO = "joystick_boat/sway_1"
BODY = {"mass": 5.0, "roll_inertia": 0.2, "yaw_inertia": 0.5}
HUGE = 10**400


@pytest.fixture(scope="module")
def boat() -> boatsim.Vessel:
    return boatsim.load_vessel("joystick_boat")


@pytest.fixture(scope="module")
def batch(boat: boatsim.Vessel) -> boatsim.Batch:
    return boatsim.Batch(boat, 2, threads=1)


@pytest.mark.parametrize(
    ("call", "argument"),
    [
        (lambda: boatsim.load_vessel(5), "name"),  # type: ignore[arg-type]
        (lambda: boatsim.load_vessel("otter", load=5), "load"),  # type: ignore[arg-type]
        (lambda: boatsim.load_vessel("otter", load=[5]), "load"),  # type: ignore[list-item]
        (lambda: boatsim.load_scenario(SCENARIO, vessel="otter"), "vessel"),  # type: ignore[arg-type]
        (lambda: boatsim.load_scenario(SCENARIO, controller=5), "controller"),  # type: ignore[arg-type]
        (lambda: boatsim.run(5), "scenario"),  # type: ignore[arg-type]
        (lambda: boatsim.run(SCENARIO, seed="x"), "seed"),  # type: ignore[arg-type]
        (lambda: boatsim.run(SCENARIO, seed=1.5), "seed"),  # type: ignore[arg-type]
        (lambda: boatsim.run(SCENARIO, out=5), "out"),  # type: ignore[arg-type]
        (lambda: boatsim.read(None), "path"),  # type: ignore[arg-type]
        (lambda: boatsim.diagnose(5), "runs"),  # type: ignore[arg-type]
        (lambda: boatsim.diagnose("a.csv", horizon="x"), "horizon"),  # type: ignore[arg-type]
        (lambda: boatsim.diagnose("a.csv", settings=[1]), "settings"),  # type: ignore[arg-type]
        (lambda: boatsim.replay("a.csv", horizon=[1]), "horizon"),  # type: ignore[arg-type]
        (lambda: boatsim.sweep(SCENARIO, vary=[1]), "vary"),  # type: ignore[arg-type]
        (lambda: boatsim.sweep(SCENARIO, vary={"body.mass": 5}), "body.mass"),  # type: ignore[dict-item]
        (lambda: boatsim.sweep(SCENARIO, draw={"body.mass": 5}), "body.mass"),  # type: ignore[dict-item]
        (lambda: boatsim.sweep(SCENARIO, runs="x"), "runs"),  # type: ignore[arg-type]
        (lambda: boatsim.sweep(SCENARIO, report=5), "report"),  # type: ignore[arg-type]
        (lambda: boatsim.Batch("otter"), "vessels"),  # type: ignore[arg-type]
        (lambda: boatsim.Fleet(SCENARIO), "scenario"),  # type: ignore[arg-type]
        (lambda: boatsim.Recording("a", 5, {"x_m": [1]}), "t "),  # type: ignore[arg-type,dict-item]
        (lambda: boatsim.Recording(5, np.zeros(2), {}), "name"),  # type: ignore[arg-type]
    ],
)
def test_a_wrong_type_is_named(call: Callable[[], Any], argument: str) -> None:
    with pytest.raises((TypeError, BadInput)) as error:
        call()
    assert argument in str(error.value) and "allowed" in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: boatsim.load_vessel("a\0b"), "name = 'a\\x00b'"),
        (lambda: boatsim.load_scenario(SCENARIO, duration=HUGE), "duration = "),
        (lambda: boatsim.run(SCENARIO, seed=-1), "seed = -1; allowed 0 to"),
        (lambda: boatsim.run(SCENARIO, seed=HUGE), "seed = "),
        (lambda: boatsim.replay("a.csv", horizon=float("nan")), "horizon = nan"),
        (lambda: boatsim.diagnose("a.csv", settings={"select.odds": HUGE}), "select.odds = "),
        (lambda: boatsim.diagnose([]), "runs: no recording is given"),
        (lambda: boatsim.diagnose([], hold_out="a.csv"), "runs: no recording is given"),
        (lambda: boatsim.sweep(SCENARIO, runs=0), "runs = 0; allowed 1 to"),
        (lambda: boatsim.sweep(SCENARIO, design="latim"), "did you mean 'latin'?"),  # type: ignore[arg-type]
        (lambda: boatsim.sweep(SCENARIO, vary={"body.mass": [HUGE, 1]}), "more than 64 bits"),
        (lambda: boatsim.Body(**{**BODY, "mass": -1.0}), "Body: mass = -1.0; "),
        (lambda: boatsim.CommandChannel(low=0.0, hihg=1.0), "did you mean 'high'?"),  # type: ignore[call-arg]
        (lambda: boatsim.Recording("a", np.zeros(2), {"x": np.zeros(3)}), "signals['x'] of shape"),
    ],
)
def test_a_value_that_is_not_allowed_is_one_line(call: Callable[[], Any], said: str) -> None:
    with pytest.raises(BadInput) as error:
        call()
    assert said in str(error.value) and "\n" not in str(error.value)
    assert len(str(error.value)) < 400


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda b: b.replace(length="x"), "length = 'x'"),
        (lambda b: b.replace(lenght=1.0), "lenght"),
        (lambda b: b.replace(dof=("surge", "sing")), "freedoms.1 = 'sing'"),
        (lambda b: b.replace(body={"mass": 1.0}), "body = "),
        (lambda b: b.with_effect(5), "effect = 5; allowed is a mapping"),
        (lambda b: b.with_effect({"use": "current", "north": HUGE}), "Current.north = 1000"),
        (lambda b: b.with_parameters(5), "parameters = 5"),
        (lambda b: b.with_parameters({"body": 5}), "parameters['body'] = 5"),
        (lambda b: b.with_parameters({"added_mass": {"surge": "x"}}), "AddedMass.surge = 'x'"),
        (lambda b: b.without_effect([]), "name = []"),
        (lambda b: b.save(5), "folder = 5"),
    ],
)
def test_a_change_of_a_vessel_names_what_is_wrong(
    boat: boatsim.Vessel, change: Callable[[boatsim.Vessel], Any], said: str
) -> None:
    with pytest.raises((TypeError, BadInput)) as error:
        change(boat)
    assert said in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("use", "said"),
    [
        (lambda b: boatsim.Batch(b.vessels, n="x"), "n = 'x'; allowed is a whole number"),
        (lambda b: boatsim.Batch(b.vessels, step="x"), "step = 'x'; allowed is a number"),
        (lambda b: boatsim.Batch(b.vessels, threads=-1), "threads = -1; allowed 1 to"),
        (lambda b: boatsim.Batch(b.vessels, 2, seeds=["a", "b"]), "seeds = ['a', 'b']"),
        (lambda b: b.reset("x"), "states = 'x'"),
        (lambda b: b.reset(commands={5: 1.0}), "key of commands = 5"),
        (lambda b: b.reset(boats=[0.5]), "boats = [0.5]; allowed are whole numbers"),
        (lambda b: b.reset(boats=[True]), "boats is a mask of shape (1,); allowed is (2,)"),
        (lambda b: b.reset(boats=[[0], [1, 0]]), "boats = [[0], [1, 0]]"),
        (lambda b: b.advance({"pwm_port": [0.1, 0.2]}), "pwm_port = [0.1, 0.2]"),
        (lambda b: b.set("body.mass", "x"), "body.mass = 'x'; allowed is a number"),
        (lambda b: b.set(5, 1.0), "parameter = 5"),
        (lambda b: b.assign("x"), "vessel = 'x'"),
        (lambda b: b.rollout([0.0], np.zeros((3, 6)), 0.1), "start of shape (1,)"),
        (lambda b: b.rollout(np.zeros(6), np.zeros(6), 0.1), "commands of shape (6,)"),
        (lambda b: b.rollout(np.zeros(6), np.zeros((3, 6)), "x"), "interval = 'x'"),
        (lambda b: b.rollout(np.zeros(6), np.zeros((3, 6)), 0.1, [1.0]), "values of shape (1,)"),
        (lambda b: b.hold_commands([0.0], {}, 3), "start of shape (1,)"),
        (
            lambda b: b.hold_commands(np.zeros(6), {}, 1e3),
            "steps = 1000.0; allowed is a whole",
        ),
        (
            lambda b: b.hold_commands(np.zeros(6), {"pwm": 1.0}, 3),
            "did you mean 'pwm_port'?",
        ),
    ],
)
def test_a_batch_names_the_argument_before_compiled_code_gets_it(
    batch: boatsim.Batch, use: Callable[[boatsim.Batch], Any], said: str
) -> None:
    with pytest.raises((TypeError, BadInput)) as error:
        use(batch)
    assert said in str(error.value) and "\n" not in str(error.value)


def test_a_fleet_names_the_argument(boat: boatsim.Vessel) -> None:
    scenario = boatsim.load_scenario(SCENARIO, duration=0.2)
    fleet = boatsim.Fleet(scenario, 2, threads=1)
    for act, said in (
        (lambda: boatsim.Fleet(scenario, 2, controller=5), "controller = 5"),  # type: ignore[arg-type]
        (lambda: boatsim.Fleet(scenario, 2, seeds=[1]), "1 seeds for 2 boats"),
        (lambda: fleet.run("x"), "seconds = 'x'; allowed is a number"),  # type: ignore[arg-type]
        (lambda: fleet.run(-1.0), "seconds = -1.0; allowed 0 to"),
        (lambda: fleet.run(1e8, log=0.0), "are more than"),
        (lambda: fleet.reset("x"), "states = 'x'"),
    ):
        with pytest.raises((TypeError, BadInput)) as error:
            act()
        assert said in str(error.value) and "\n" not in str(error.value)


def test_numbers_of_numpy_are_numbers(boat: boatsim.Vessel, tmp_path: Path) -> None:
    batch = boatsim.Batch([boat], np.int64(2), np.float64(0.02), seeds=np.array([1, 2]))  # type: ignore[arg-type]
    batch.advance(steps=np.int32(2))  # type: ignore[arg-type]
    assert batch.t.tolist() == [0.04, 0.04]
    assert boatsim.load_vessel(boat.save(tmp_path / "a").file).length == boat.length
