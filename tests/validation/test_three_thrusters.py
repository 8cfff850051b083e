"""A vessel from data alone: three thrusters and two rudders, each with its own channels, run and
diagnosed."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, sin
from pathlib import Path

import answers
import boats
import numpy as np
import pytest
from alike import long
from scipy.integrate import solve_ivp

from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State

WORKBOAT = """
about = "workboat for tests: a bow thruster, a screw that is fixed, a pod that is steered, a rudder at either end"
source = "none"
freedoms = ["surge", "sway", "yaw"]
length = 2.0
beam = 0.8
draught = 0.2
body = { mass = 40.0, roll_inertia = 3.0, yaw_inertia = 15.0 }

[channels]
bow_N = { low = -15.0, high = 15.0 }
screw_N = { low = -20.0, high = 20.0 }
pod_N = { low = -20.0, high = 20.0 }
pod_rad = { low = -1.0, high = 1.0 }
fore_rad = { low = -0.5, high = 0.5 }
aft_rad = { low = -0.5, high = 0.5 }

[[effect]]
use = "added_mass"
surge = 4.0
sway = 25.0
yaw = 6.0

[[effect]]
use = "linear_damping"
surge = 20.0
sway = 60.0
yaw = 25.0

[[effect]]
use = "thruster"
name = "bow"
on = { thrust = "bow_N", angle = 1.5708 }
x = 0.8

[[effect]]
use = "thruster"
name = "screw"
on = { thrust = "screw_N" }
x = -0.9
y = 0.1
z = 0.15

[[effect]]
use = "thruster"
name = "pod"
on = { thrust = "pod_N", angle = "pod_rad" }
x = -0.7
y = -0.2
z = 0.1

[[effect]]
use = "rudder"
name = "fore"
on = { angle = "fore_rad" }
sway = 6.0
yaw = 5.0
roll = -0.5

[[effect]]
use = "rudder"
name = "aft"
on = { angle = "aft_rad" }
sway = -10.0
yaw = 9.0
roll = 1.0

[diagnosis]
also = [
    { use = "weak_reverse", name = "weak_bow", on = "bow_N" },
    { use = "weak_reverse", name = "weak_screw", on = "screw_N" },
    { use = "weak_reverse", name = "weak_pod", on = "pod_N" },
]
"""
THRUSTERS = {
    "bow": (0.8, 0.0, 0.0),
    "screw": (-0.9, 0.1, 0.15),
    "pod": (-0.7, -0.2, 0.1),
}  # [m] ahead, starboard, down
RUDDERS = {
    "fore": (6.0, -0.5, 5.0),
    "aft": (-10.0, 1.0, 9.0),
}  # per rad: sway [N], roll and yaw [N m]
COMMANDS = ("bow_N", "screw_N", "pod_N", "pod_rad", "fore_rad", "aft_rad")


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return boats.written(tmp_path, "workboat", WORKBOAT)


def drawn(boat: Vessel, rows: int, seed: int) -> Array:
    """(rows, C) random commands inside their ranges."""
    low, high = np.array([(c.low, c.high) for c in boat.commands.values()]).T
    return np.random.default_rng(seed).uniform(low, high, (rows, len(low)))


def statics(c: Mapping[str, float]) -> Array:
    """(6,) force and moment of all thrusters and rudders: r x F of each at its mount."""
    total = np.zeros(6)
    for name, angle in (("bow", 1.5708), ("screw", 0.0), ("pod", c["pod_rad"])):
        force = c[f"{name}_N"] * np.array([cos(angle), sin(angle), 0.0])
        total += [*force, *np.cross(THRUSTERS[name], force)]
    for name, (sway, roll, yaw) in RUDDERS.items():
        total += c[f"{name}_rad"] * np.array([0.0, sway, 0.0, roll, 0.0, yaw])
    return total


def test_each_channel_drives_what_it_is_bound_to(place: Path) -> None:
    boat = vessel.load_vessel(str(place))
    assert boat.actuators == COMMANDS and boat.angles == ("pod_rad", "fore_rad", "aft_rad")
    assert [boat.side(n) for n in COMMANDS] == [0, 1, -1, -1, 0, 0]
    assert [e.name for e in boat.effects_of_type("thruster")] == list(THRUSTERS)
    assert [e.name for e in boat.effects_of_type("rudder")] == list(RUDDERS)


@pytest.mark.parametrize("seed", range(3))
def test_forces_and_moments_are_those_of_statics(tmp_path: Path, seed: int) -> None:
    six = '["surge", "sway", "heave", "roll", "pitch", "yaw"]'
    text = WORKBOAT.replace('["surge", "sway", "yaw"]', six).replace(
        "body = { ", "body = { pitch_inertia = 15.0, "
    )
    boat = vessel.load_vessel(str(boats.written(tmp_path, "workboat", text)))
    program, (row,) = Program(boat), drawn(boat, 1, seed)
    act, memory = np.zeros(program.actuator_signal_size), np.zeros(program.memory_size)
    program.estimation_functions.settle_actuators(
        row, memory, program.values(), program.effect_switches(), act
    )
    at_rest = np.zeros(12)
    force = program.estimation_functions.total_body_force(
        0.0, at_rest, act, np.int64(0), program.values(), program.effect_switches()
    )
    assert force == pytest.approx(statics(dict(zip(COMMANDS, row, strict=True))), abs=1e-12)


def test_a_fixed_thruster_does_not_turn_with_the_only_rudder(tmp_path: Path) -> None:
    text = WORKBOAT.replace('angle = "pod_rad"', "angle = 0.3").replace(
        'angle = "fore_rad"', "angle = 0.0"
    )
    boat = vessel.load_vessel(str(boats.written(tmp_path, "workboat", text)))
    assert boat.angles == ("aft_rad",)
    screw = boat.effect("screw")
    assert screw is not None and boat.bindings(screw) == {"thrust": "screw_N"}


def test_engine_and_twin_sail_alike(place: Path) -> None:
    boat = vessel.load_vessel(str(place))
    rows, start = drawn(boat, 30, 3), State(psi=0.4, u=0.5, v=-0.2, r=0.1)
    pose_and_rates = [signal.symbol for signal in motion_signals(boat.dof)]
    wanted = Batch(boat).rollout([getattr(start, n) for n in pose_and_rates], rows, 1.0)
    engine = Engine(boat)
    engine.reset(start, dict(zip(COMMANDS, rows[0], strict=True)))
    for row, then in zip(rows, wanted[1:], strict=True):
        engine.command(dict(zip(COMMANDS, row, strict=True)))
        engine.advance(50)
        assert [getattr(engine.state, n) for n in pose_and_rates] == pytest.approx(
            then, rel=0.0, abs=1e-10
        )
    assert np.ptp(wanted, axis=0).min() > 0.1


# ---- a diagnosis of data from an integrator that shares no code with the tool


@dataclass(frozen=True)
class Real:
    """The workboat as it really is: thrust astern per commanded thrust of each thruster, and of all
    damping."""

    astern: Mapping[str, float]
    damping: float = 1.03


def moved(t: float, y: Array, c: Mapping[str, float], real: Real) -> list[float]:
    """Newton and Kirchhoff in the plane, about the mass centre."""
    psi, u, v, r = y[2:]
    given = {
        n: c[f"{n}_N"] * (real.astern.get(n, 1.0) if c[f"{n}_N"] < 0.0 else 1.0) for n in THRUSTERS
    }
    ahead, aside = (
        given["screw"] + given["pod"] * cos(c["pod_rad"]),
        given["pod"] * sin(c["pod_rad"]),
    )
    X = ahead - real.damping * 20.0 * u
    Y = given["bow"] + aside + 6.0 * c["fore_rad"] - 10.0 * c["aft_rad"] - real.damping * 60.0 * v
    N = (
        0.8 * given["bow"]
        - 0.1 * given["screw"]
        - 0.7 * aside
        + 0.2 * given["pod"] * cos(c["pod_rad"])
    )
    N += 5.0 * c["fore_rad"] + 9.0 * c["aft_rad"] - real.damping * 25.0 * r
    px, py = 44.0 * u, 65.0 * v  # [kg m/s] momentum of hull and water
    return [
        u * cos(psi) - v * sin(psi),
        u * sin(psi) + v * cos(psi),
        r,
        (X + r * py) / 44.0,
        (Y - r * px) / 65.0,
        (N + v * px - u * py) / 21.0,
    ]


def recorded(real: Real, seed: int) -> Recording:
    """A minute at 5 Hz, all commands drawn anew every two seconds, seen by a camera."""
    rng, dt, count = np.random.default_rng(seed), 0.2, 300
    high = np.array([15.0, 20.0, 20.0, 1.0, 0.5, 0.5])
    rows = np.repeat(rng.uniform(-high, high, (count // 10, 6)), 10, axis=0)
    y, seen = np.zeros(6), []
    for row in rows:
        seen.append(y[:3])
        c = dict(zip(COMMANDS, row, strict=True))
        y = solve_ivp(moved, (0.0, dt), y, args=(c, real), rtol=1e-9, atol=1e-10).y[:, -1]
    pose = np.array(seen) + 0.005 * rng.standard_normal((count, 3))
    signals = dict(zip(("x_m", "y_m", "psi_rad"), pose.T, strict=True)) | dict(
        zip(COMMANDS, rows.T, strict=True)
    )
    return Recording(f"run_{seed}", dt * np.arange(count), signals)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("astern", "name"),
    [
        ({"screw": 0.7}, "weak_screw"),
        long({"pod": 0.8}, "weak_pod"),
        (dict.fromkeys(THRUSTERS, 0.85), "weak_reverse"),
        long({}, ""),
    ],
    ids=lambda case: case if isinstance(case, str) else "",
)
def test_the_thruster_that_is_weak_astern_is_named_alone(
    tmp_path: Path, place: Path, astern: Mapping[str, float], name: str
) -> None:
    runs = [recorded(Real(astern), seed) for seed in (1, 2, 3)]
    answer = answers.diagnosed(runs, tmp_path, str(place))
    if not name:
        answers.nothing_missing(answer)
        return
    (true,) = set(astern.values())
    answers.named(answer, name, {"astern_factor": true})
    found = answer["effects"][0]["parameters"]["astern_factor"]
    assert abs(found["value"] - true) < 2.0 * found["sd"] < 0.1
