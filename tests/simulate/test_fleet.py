"""Many boats of a scenario: each as `boatsim run` sails it with its seed, whoever else is there."""

import re
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.simulate import scenario
from boatsim.simulate.batch import TURN
from boatsim.simulate.fleet import Fleet, FleetLog
from boatsim.simulate.run import run

OPEN = {"until": {}, "tank": {"length": 1e3, "width": 1e3}, "duration": 8.0}
SWAY = scenario.load("joystick_boat/sway_1_wind", OPEN)
RIVAL = scenario.load("joystick_boat/sway_1_wind", OPEN | {"controller": {"use": "pid_autopilot"}})


def by_hand(sense: np.ndarray, goal: object) -> dict[str, np.ndarray]:
    """A proportional turn back to north, by the difference of the thrusts."""
    return {"pwm_port": -80.0 * sense["psi"] + 60.0, "pwm_starboard": 80.0 * sense["psi"] + 60.0}


@pytest.mark.parametrize(
    "case",
    [
        SWAY,
        RIVAL,
        scenario.load("joystick_boat/yaw_2", OPEN | {"duration": 20.0}),
        scenario.load("joystick_boat/sway_1_gyro", OPEN),
        scenario.load("otter/turn"),
    ],
    ids=lambda s: s.name,
)
def test_each_boat_sails_as_a_run_with_its_seed_does(case) -> None:
    fleet = Fleet(case, 3)
    voyages = fleet.run(log=case.controller.period)
    for i in (0, 2):
        alone = run(case, seed=int(fleet.seeds[i]))
        rows = np.searchsorted(alone.recording.t, voyages.t - 1e-6)
        for name in voyages.columns:
            np.testing.assert_allclose(
                voyages[name][:, i], alone.recording.signals[name][rows], rtol=1e-7, atol=1e-9
            )
        counted = dict(zip(voyages.inputs, fleet.saturated[i].tolist(), strict=True))
        assert {n: k for n, k in counted.items() if k} == {
            n: k for n, k in alone.saturated.items() if k
        }
    assert (
        case.sensors.ideal
        or np.ptp(voyages.states[-1], axis=0).max() > 0
        or not type(case.controller).goals
    )


@pytest.mark.parametrize("controller", [None, by_hand], ids=["law", "function"])
def test_a_boat_sails_to_the_last_bit_alike_alone_and_among_others_on_any_number_of_threads(
    controller,
) -> None:
    def sailed(n: int, threads: int, first: int = 0) -> FleetLog:
        seeds = range(first, first + n)
        return Fleet(SWAY, n, seeds=seeds, controller=controller, threads=threads).run(2.0, log=0.4)

    many = sailed(TURN + 5, 1)
    assert (sailed(TURN + 5, 3).states == many.states).all()
    for i in (0, TURN + 4):
        assert (sailed(1, 1, first=i).states[:, 0] == many.states[:, i]).all()
    assert len(np.unique(many["psi_rad"][-1])) == TURN + 5


def test_it_sails_on_where_it_was_and_begins_anew_when_reset() -> None:
    whole, parts = Fleet(SWAY, 4), Fleet(SWAY, 4)
    end = whole.run(4.0)
    for seconds in (0.8, 1.6, 1.6):
        last = parts.run(seconds)
    assert (last.states[-1] == end.states[-1]).all() and last.t[-1] == pytest.approx(4.0)
    parts.reset()
    assert (parts.run(4.0).states[-1] == end.states[-1]).all()


def test_each_boat_may_have_settings_of_its_own() -> None:
    quick, slow = type(SWAY.controller)(), type(SWAY.controller)(sway_thrust=0.2)
    mixed = Fleet(SWAY, 4, seeds=[1, 1, 2, 2], controller=[quick, slow]).run(8.0)
    assert (mixed["y_m"][-1, ::2] > 2.0 * mixed["y_m"][-1, 1::2]).all()
    alone = Fleet(SWAY, 1, seeds=[2], controller=slow).run(8.0)
    assert (alone.states[-1, 0] == mixed.states[-1, 3]).all()


def test_a_controller_that_is_not_compiled_and_a_channel_that_is_not_there_are_refused() -> None:
    published = scenario.load("joystick_boat/sway_1_as_published")
    with pytest.raises(BadInput, match="not compiled"):
        Fleet(published, 2)
    with pytest.raises(BadInput, match="pwm_port"):
        Fleet(SWAY, 2, controller=lambda sense, goal: {"pwm_prt": 1.0}).run(0.1)
    with pytest.raises(BadInput, match="one for each"):
        Fleet(SWAY, 2, seeds=[1])
    with pytest.raises(BadInput, match="n = 0; allowed 1 to"):
        Fleet(SWAY, 0)
    with pytest.raises(BadInput, match="several kinds"):
        Fleet(SWAY, 2, controller=[SWAY.controller, RIVAL.controller])


def test_a_controller_that_does_more_than_its_law_is_refused() -> None:
    one = scenario.load("joystick_boat/sway_1_blind")
    with pytest.raises(BadInput, match="L1JoystickBlind is not compiled"):
        Fleet(one, 2)


def test_a_scenario_that_lets_go_of_the_boat_is_refused() -> None:
    let_go = scenario.load(
        "joystick_boat/berth",
        {"tank": None, "goal": [{"yaw_radps": 0.1}, {"from": 5.0, "off": True}]},
    )
    with pytest.raises(BadInput, match="off = true"):
        Fleet(let_go, 2)


def test_the_examples_of_the_page_print_what_it_shows(capsys: pytest.CaptureFixture[str]) -> None:
    page = (Path(__file__).parents[2] / "docs" / "batches.md").read_text()
    shown = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", page, re.DOTALL)
    assert len(shown) == 2
    names: dict[str, object] = {}
    for code, output in shown:
        exec(code, names)
        assert capsys.readouterr().out == output
