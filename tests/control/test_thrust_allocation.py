"""The allocation to thrusters is optimal and never leaves their limits."""

import os
import subprocess
import sys
from itertools import product
from math import atan, cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from boatsim.control.thrust_allocation import (
    DEMAND,
    ThrustAllocator,
    azimuth_thruster,
    fixed_thruster,
    propeller_with_rudder,
    rudder,
    tunnel_thruster,
    with_weights,
)
from boatsim.errors import BadInput
from boatsim.physics.base import Array


def supply_vessel(**settings: float) -> ThrustAllocator:
    """A tunnel thruster and two azimuth thrusters with rates."""
    return ThrustAllocator(
        [
            tunnel_thruster("bow", 30.0, -200.0, 200.0, rate=20.0),
            azimuth_thruster("port", -40.0, -7.0, 500.0, rate=50.0, angle_rate=0.2),
            azimuth_thruster("starboard", -40.0, 7.0, 500.0, rate=50.0, angle_rate=0.2),
        ],
        **settings,
    )


def cost_of(allocator: ThrustAllocator, demand: Array, thrust: Array, force: Array) -> Array:
    """Cost of settings, in the definition of the allocator; thrusts (n, ...), forces (3, ...)."""
    scale = allocator.scale.reshape(3, *[1] * (force.ndim - 1))
    missing = ((demand.reshape(scale.shape) - force) / scale) ** 2
    largest = np.array([one.largest for one in allocator.thrusters])
    shares = (thrust / largest.reshape(-1, *[1] * (thrust.ndim - 1))) ** 2
    return np.asarray(DEMAND * missing.sum(axis=0) + shares.sum(axis=0))


@pytest.mark.parametrize("demand", [(50.0, 20.0, 900.0), (-300.0, 200.0, 0.0), (900.0, 900.0, 0.0)])
def test_no_setting_of_a_grid_is_better(demand: tuple[float, float, float]) -> None:
    allocator = ThrustAllocator(
        [
            tunnel_thruster("bow", 30.0, -200.0, 200.0),
            azimuth_thruster("port", -40.0, -7.0, 500.0),
            fixed_thruster("fixed", -38.0, 3.0, -100.0, 300.0, 0.1),
        ]
    )
    wanted = np.array(demand)
    found = allocator.optimum(wanted)
    bow, length, angle, fixed = np.meshgrid(
        np.linspace(-200, 200, 21),
        np.linspace(0, 500, 26),
        np.linspace(-pi, pi, 73),
        np.linspace(-100, 300, 21),
        indexing="ij",
    )
    X = length * np.cos(angle) + fixed * cos(0.1)
    Y = bow + length * np.sin(angle) + fixed * sin(0.1)
    N = 30.0 * bow + length * (-40.0 * np.sin(angle) + 7.0 * np.cos(angle))
    N += fixed * (-38.0 * sin(0.1) - 3.0 * cos(0.1))
    costs = cost_of(allocator, wanted, np.array([bow, length, fixed]), np.array([X, Y, N]))
    assert found.cost <= costs.min() * (1.0 + 1e-9)
    own = cost_of(allocator, wanted, found.setting.thrust, found.force)
    assert float(own) == pytest.approx(found.cost, rel=1e-6)
    assert found.setting.thrust[1] <= 500.0 * (1.0 + 1e-12)


def test_a_steered_thruster_that_runs_astern_takes_the_better_of_both_sectors() -> None:
    allocator = ThrustAllocator(
        [
            azimuth_thruster("port", -0.5, -0.2, 2.0, -0.8, 0.8, low=-1.5),
            azimuth_thruster("starboard", -0.5, 0.2, 2.0, -0.8, 0.8, low=-1.5),
        ]
    )
    wanted = np.array([0.0, 0.3, 0.0])
    found = allocator.optimum(wanted)
    best = np.inf
    thrusts, angles = np.linspace(-1.5, 2.0, 36), np.linspace(-0.8, 0.8, 33)
    first, second = (np.array(list(product(thrusts, angles))).T for _ in range(2))
    for thrust, angle in first.T:
        X = thrust * cos(angle) + second[0] * np.cos(second[1])
        Y = thrust * sin(angle) + second[0] * np.sin(second[1])
        N = -0.5 * Y + 0.2 * thrust * cos(angle) - 0.2 * second[0] * np.cos(second[1])
        both = np.array([np.full_like(second[0], thrust), second[0]])
        best = min(best, float(cost_of(allocator, wanted, both, np.array([X, Y, N])).min()))
    assert found.cost <= best
    assert np.abs(found.setting.angle).max() <= 0.8
    assert found.force == pytest.approx(wanted, abs=1e-4)


@pytest.mark.parametrize("settings", [{}, {"singularity": 1.0, "calm": 0.1}])
def test_limits_and_rates_are_never_exceeded(settings: dict[str, float]) -> None:
    allocator = supply_vessel(**settings)
    rng = np.random.default_rng(0)
    before = allocator.setting
    for _ in range(150):
        demand = rng.normal(size=3) * [600.0, 600.0, 2e4]
        now = allocator.step(demand, 0.5).setting
        assert (np.abs(now.thrust - before.thrust) <= np.array([10.0, 25.0, 25.0]) + 1e-9).all()
        assert (np.abs(now.angle - before.angle) <= 0.1 + 1e-9).all()
        assert -200.0 <= now.thrust[0] <= 200.0
        assert (now.thrust[1:] >= 0.0).all() and (now.thrust[1:] <= 500.0).all()
        before = now


def test_a_constant_demand_is_reached_as_fast_as_the_rates_allow() -> None:
    allocator, demand = supply_vessel(), np.array([-200.0, 100.0, 1000.0])
    for _ in range(30):  # half a turn takes 16 s
        found = allocator.step(demand, 1.0)
    assert found.force == pytest.approx(demand, rel=1e-4)
    assert found.cost == pytest.approx(allocator.optimum(demand).cost)


def test_the_cost_of_a_singularity_keeps_directions_apart() -> None:
    thrusters = [
        tunnel_thruster("bow", 40.0, -200.0, 200.0),
        azimuth_thruster("port", -30.0, -5.0, 500.0, angle_rate=0.2),
        azimuth_thruster("starboard", -30.0, 5.0, 500.0, angle_rate=0.2),
    ]
    plain, careful = ThrustAllocator(thrusters), ThrustAllocator(thrusters, singularity=1.0)
    demand = np.array([100.0, 0.0, 0.0])
    for _ in range(50):
        plain.step(demand, 1.0)
        careful.step(demand, 1.0)
    # straight ahead, only the tunnel thruster gives a side force
    alike, apart = (one.singularity_cost(one.setting.angle) for one in (plain, careful))
    assert plain.setting.angle[1:] == pytest.approx([0.0, 0.0], abs=0.01)
    assert apart < 0.8 * alike
    assert careful.force(careful.setting) / careful.scale == pytest.approx(
        demand / careful.scale, abs=5e-3
    )


def test_a_thruster_with_a_larger_weight_is_used_less() -> None:
    thrusters = [
        fixed_thruster("a", 0.0, -1.0, -1.0, 1.0),
        fixed_thruster("b", 0.0, 1.0, -1.0, 1.0),
    ]
    thrusters += [fixed_thruster("c", 0.0, 0.0, -1.0, 1.0)]
    demand = np.array([0.9, 0.0, 0.0])
    even = ThrustAllocator(thrusters).optimum(demand).setting.thrust
    assert even == pytest.approx([0.3, 0.3, 0.3], abs=1e-5)
    spared = ThrustAllocator(with_weights(thrusters, {"c": 10.0})).optimum(demand).setting.thrust
    assert spared == pytest.approx([9 / 21, 9 / 21, 0.9 / 21], abs=1e-4)


def test_the_force_of_a_propeller_with_rudder_lies_in_its_sector() -> None:
    thrusters = [propeller_with_rudder("main", -1.0, 0.0, 10.0, 1.2, 0.6)]
    found = ThrustAllocator(thrusters).optimum(np.array([1.0, 5.0, -5.0]))
    assert found.setting.angle[0] == pytest.approx(atan(0.72))
    allocator = ThrustAllocator([rudder("rudder", -5.0, 10.0, 0.5), *thrusters])
    found = allocator.optimum(np.array([4.0, 0.0, 2.0]))
    assert found.force == pytest.approx([4.0, 0.0, 2.0], abs=2e-3)


def test_yaw_has_priority_if_its_weight_is_large() -> None:
    # one tunnel thruster at the bow cannot give a side force without a moment
    thrusters = [tunnel_thruster("bow", 2.0, -10.0, 10.0)]
    demand = np.array([0.0, 5.0, 0.0])
    force = ThrustAllocator(thrusters, (1.0, 1.0, 1e4)).optimum(demand).force
    assert abs(force[2]) < 0.01
    force = ThrustAllocator(thrusters, (1.0, 1e4, 1.0)).optimum(demand).force
    assert force[1] == pytest.approx(5.0, abs=0.01)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: ThrustAllocator([]), "at least one thruster"),
        (lambda: tunnel_thruster("bow", 1.0, 2.0, 3.0), "includes 0"),
        (lambda: azimuth_thruster("aft", 0.0, 0.0, 1.0, 1.0, -1.0), "lower and an upper limit"),
        (lambda: fixed_thruster("main", 0.0, 0.0, -1.0, 1.0, rate=0.0), "rate = 0"),
        (lambda: supply_vessel(singularity=-1.0), "singularity = -1"),
        (lambda: with_weights([tunnel_thruster("bow", 1, -1, 1)], {"bwo": 1.0}), "did you mean"),
    ],
)
def test_wrong_thrusters_are_refused(wrong: object, message: str) -> None:
    with pytest.raises(BadInput, match=message):
        wrong()  # type: ignore[operator]


SECOND_USE = """
import numpy as np
from tests.control.test_thrust_allocation import supply_vessel
print(supply_vessel().step(np.array([50.0, 20.0, 900.0]), 0.5).force.tolist())
"""


@pytest.mark.slow  # compiles everything anew
def test_a_second_process_loads_what_the_first_one_compiled(tmp_path: Path) -> None:
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    said = []
    for _ in range(2):
        command = [sys.executable, "-c", SECOND_USE]
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        said.append(done.stdout)
    assert said[0] == said[1] and said[0].startswith("[")
