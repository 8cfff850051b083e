"""Two fixed propellers: their control allocation against exact solutions and brute force, and the
L1 joystick controller that uses it, on boats with weak propellers."""

from dataclasses import replace
from math import inf
from typing import Any

import numpy as np
import pytest

from boatsim.control.compiled import record_type
from boatsim.control.differential import (
    PROPELLER,
    allocate_to_propellers,
    command_for_thrust,
    thrust_at_command,
)
from boatsim.errors import BadInput
from boatsim.physics.content import load_class
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.run import run
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.vessel_margins import (
    VesselMargin,
    format_vessel_margins,
    margins_on_vessel,
)
from boatsim.simulate.vessel_model import command_lag, introduce_vessel
from boatsim.sweeps.robustness.closed_loops import runs_in_a_fleet

NAME = "l1_differential"


def pairs(count: int) -> list[np.void]:
    """Random pairs of propellers, some of which give nothing astern."""
    rng = np.random.default_rng(3)
    found = []
    for _ in range(count):
        q = np.zeros(1, record_type(port=PROPELLER, starboard=PROPELLER))
        for name, side in (("port", -1.0), ("starboard", 1.0)):
            low = -rng.uniform(0.0, 5.0) * (rng.random() > 0.2)
            high = rng.uniform(1.0, 8.0)
            ahead, astern = rng.uniform(0.01, 2.0, 2)
            q[name][0] = (side * rng.uniform(0.2, 1.0), low, high, ahead, astern, 0.9)
        found.append(q[0])
    return found


def wrench(q: np.void, thrusts: Any) -> tuple[Any, Any]:
    """X [N] and N [N m] of two thrusts, port first."""
    port, starboard = thrusts
    return port + starboard, -q["port"]["side"] * port - q["starboard"]["side"] * starboard


def test_an_attainable_demand_is_met_exactly_and_no_propeller_exceeds_its_limits() -> None:
    rng, met = np.random.default_rng(4), 0
    for q in pairs(500):
        inside = tuple(rng.uniform(q[s]["low"], q[s]["high"]) for s in ("port", "starboard"))
        for demand in (wrench(q, inside), tuple(rng.normal(0.0, 8.0, 2))):
            got = allocate_to_propellers(q, *demand)
            for thrust, side in zip(got, ("port", "starboard"), strict=True):
                assert q[side]["low"] - 1e-9 <= thrust <= q[side]["high"] + 1e-9
        met += np.allclose(allocate_to_propellers(q, *wrench(q, inside)), inside, atol=1e-9)
    assert met == 500


def test_the_yaw_moment_comes_before_the_surge_force() -> None:
    for q in pairs(200):
        sides = [np.linspace(q[s]["low"], q[s]["high"], 201) for s in ("port", "starboard")]
        forces, moments = wrench(q, tuple(np.meshgrid(*sides)))
        for sign in (
            -1.0,
            1.0,
        ):  # brute force: the largest moment with a surge force from 0 to 20 N
            N = sign * 0.9 * np.max((sign * moments)[forces >= 0.0])
            force, moment = wrench(q, allocate_to_propellers(q, 20.0, N))
            assert moment == pytest.approx(N, abs=1e-9)
            # and no larger surge force has this moment within the limits
            port = np.linspace(q["port"]["low"], q["port"]["high"], 4001)
            starboard = (-N - q["port"]["side"] * port) / q["starboard"]["side"]
            low, high = q["starboard"]["low"], q["starboard"]["high"]
            inside = (low <= starboard) & (starboard <= high)
            assert force == pytest.approx(np.max((port + starboard)[inside]), abs=0.05)


def test_commands_have_the_thrust_that_they_are_made_for() -> None:
    for q in pairs(50):
        for thrust in (-2.0, -0.1, 0.0, 0.3, 4.0):
            command = command_for_thrust(q["port"], thrust)
            assert thrust_at_command(q["port"], command) == pytest.approx(thrust, abs=1e-12)
    linear = q["port"].copy()
    linear["ahead"] = 0.0
    assert command_for_thrust(linear, 1.8) == pytest.approx(2.0)  # gain 0.9
    assert thrust_at_command(linear, 2.0) == pytest.approx(1.8)


@pytest.mark.parametrize("vessel", ["otter", "blueboat", "twin_usv"])
def test_the_boat_keeps_speed_and_rate_of_turn_with_weak_propellers(vessel: str) -> None:
    controller = load_class("controller", NAME)()
    introduce_vessel(controller, load_vessel(vessel))
    full = controller.largest_goals()
    goal = {"surge_mps": 0.5 * full["surge_mps"], "yaw_radps": 0.5 * full["yaw_radps"]}
    scenario = Scenario.from_settings(
        vessel=load_vessel(vessel),
        controller={"use": NAME},
        sensors={"ideal": True},
        engine="compiled",
        duration=80.0,
        goal=[{"from": 0.0, **goal}],
        effect=[{"use": "thrust_gain_error", "factor": 0.7}],
    )
    log = run(scenario).recording
    late = log.t > 40.0
    assert np.max(np.abs(log["u_mps"][late] - goal["surge_mps"])) < 0.02 * goal["surge_mps"]
    assert np.max(np.abs(log["r_radps"][late] - goal["yaw_radps"])) < 0.02 * goal["yaw_radps"]


def test_gains_follow_from_the_lag_and_the_damping_of_the_vessel() -> None:
    otter = load_vessel("otter")
    assert command_lag(otter) == pytest.approx(0.1)
    found = load_class("controller", NAME)()
    introduce_vessel(found, otter)
    delay = 0.5 * found.period + 0.1 + 0.3 * (2.0 / 1.2) ** 0.5
    assert found.yaw_bandwidth == pytest.approx(0.5 / delay)
    assert found.pole == pytest.approx(0.75 * 0.5 / delay)  # a hull of much damping
    assert found.mass == pytest.approx(55.0 + 5.28152101)
    slow = load_class("controller", NAME).from_settings({"lag": 2.0, "pole": 0.1})
    introduce_vessel(slow, otter)
    assert slow.yaw_bandwidth < 0.25 * found.yaw_bandwidth
    assert slow.pole == 0.1


def test_it_steers_fleets_and_other_drives_are_refused_in_one_line() -> None:
    kind = load_class("controller", NAME)
    assert runs_in_a_fleet(kind)
    with pytest.raises(BadInput, match="two fixed propellers .* joystick_boat has port, starboard"):
        introduce_vessel(kind(), load_vessel("joystick_boat"))
    for use in (kind().operating_points, kind().channels):
        with pytest.raises(BadInput, match="needs a model of its vessel"):
            use()


def test_a_margin_beyond_the_longest_simulated_delay_is_no_disagreement() -> None:
    long = VesselMargin("surge", 0.2, 90.0, 7.2, inf)
    assert long.difference == 0.0
    assert replace(long, delay_s=3.0).difference == -1.0
    cells = format_vessel_margins([long], load_vessel("otter")).splitlines()[-1].split()
    assert cells[-3:] == ["over", "5", "-"]


@pytest.mark.slow
@pytest.mark.parametrize("vessel", ["otter", "blueboat"])
def test_the_delay_margins_agree_with_simulations_within_5_per_cent(vessel: str) -> None:
    for margin in margins_on_vessel(load_class("controller", NAME)(), load_vessel(vessel)):
        assert abs(margin.difference) < 0.05, margin
        assert margin.delay_s > 1.0
