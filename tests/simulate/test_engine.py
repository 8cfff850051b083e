"""The vessel on MuJoCo: native against Python callback, against the twin, walls, symmetry, axes,
global state."""

import copy
from collections.abc import Mapping
from functools import cache
from math import cos, pi, sin
from pathlib import Path
from types import FunctionType
from typing import Any

import boats
import mujoco
import numpy as np
import pytest
from alike import few

from boatsim.errors import BadInput, BadPhysics
from boatsim.physics import content, vessel
from boatsim.physics.base import Array
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.simulate import scenario
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State, installed_callback
from boatsim.simulate.run import run
from boatsim.simulate.tank import Tank

EXTRA: dict[str, dict[str, float]] = {
    "weak_reverse": {"astern_factor": 0.694},
    "fan_wind": {"speed": 1.5, "toward": 0.8},
    "current": {"north": 0.05, "east": -0.03},
    "shallow_water": {"factor": 1.3},
}
NEUTRAL = {"current": {"north": 0.0, "east": 0.0}, "fan_wind": {"front": 0.0, "side": 0.0}}
VESSELS = [
    *(
        ("joystick_boat", loads)
        for loads in [("light",), ("heavy",), ("light", "wide"), ("heavy", "wide")]
    ),
    *((name, ()) for name in content.shipped_content_names("vessel") if name != "joystick_boat"),
]
START = State(x=0.1, y=-0.2, psi=0.4, phi=0.1, u=0.2, v=-0.1, p=0.05, r=0.3)


@cache
def on_water(name: str, loads: tuple[str, ...] = (), *without: str) -> Vessel:
    """A vessel with all that can be put on it, so that cases share a program.

    `without`: effects that do nothing.
    """
    if name != "joystick_boat":
        return vessel.load_vessel(name, loads)
    return vessel.load_vessel(
        name,
        loads,
        extra=[{"use": n, **v, **(NEUTRAL[n] if n in without else {})} for n, v in EXTRA.items()],
    )


def held_commands(boat: Vessel, rows: int, seed: int) -> Array:
    """(rows, C) random commands inside the channels' limits."""
    low, high = np.array([(c.low, c.high) for c in boat.commands.values()]).reshape(-1, 2).T
    return np.random.default_rng(seed).uniform(low, high, (rows, len(boat.commands)))


def pose_and_rates(boat: Vessel, s: State) -> list[float]:
    """A state as the twin has it."""
    return [getattr(s, signal.symbol) for signal in motion_signals(boat.dof)]


def sailed(engine: Engine, rows: Array, steps: int, start: State = START) -> Array:
    """(rows + 1, 2 NQ) states; each row of commands is held for some steps."""
    commands = [dict(zip(engine.vessel.commands, row, strict=True)) for row in rows]
    engine.reset(start, commands[0])
    out = [pose_and_rates(engine.vessel, engine.state)]
    for one in commands:
        engine.command(one)
        engine.advance(steps)
        out.append(pose_and_rates(engine.vessel, engine.state))
    return np.array(out)


# Native, Python and twin


@pytest.mark.parametrize(("name", "loads"), few(VESSELS, 5))
def test_native_and_python_callback_give_the_same_numbers(
    name: str, loads: tuple[str, ...]
) -> None:
    boat = on_water(name, loads)
    fast, plain = Engine(boat), Engine(boat, callback="python")
    assert isinstance(plain.callback, FunctionType)
    assert not isinstance(fast.callback, FunctionType), "fell back to the Python callback"
    rows = held_commands(boat, 40, seed=1)
    assert sailed(fast, rows, 5) == pytest.approx(sailed(plain, rows, 5), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(("name", "loads"), few(VESSELS, 5))
def test_engine_and_twin_agree_over_20_s_of_random_commands(
    name: str, loads: tuple[str, ...]
) -> None:
    boat = on_water(name, loads)
    rows = held_commands(boat, 200, seed=2)
    engine = sailed(Engine(boat), rows, 5)
    compiled = Batch(boat).rollout(pose_and_rates(boat, START), rows, 0.1)
    assert engine.shape == compiled.shape == (201, 2 * len(boat.dof))
    assert np.ptp(engine, axis=0).min() > 1e-3  # it did move, heave by some mm at least
    assert engine == pytest.approx(compiled, rel=1e-10, abs=1e-10)


def test_what_is_only_looked_at_changes_no_number() -> None:
    boat = on_water("joystick_boat")
    rows = held_commands(boat, 20, seed=3)
    seen, bare = (
        sailed(Engine(boat, Tank(20, 20, 0.1), show=show), rows, 5) for show in (True, False)
    )
    assert (seen == bare).all()


def test_many_steps_at_once_are_the_same_as_one_by_one(tmp_path: Path) -> None:
    one, many, coasting = (Engine(boats.planar(tmp_path)) for _ in range(3))
    for engine in (one, many, coasting):
        engine.reset(START, boats.push(2.0, 0.1))
    for _ in range(50):
        one.advance()
    many.advance(50)
    coasting.advance_without_actuators(50)
    assert one.state == many.state == coasting.state
    assert one.state.t == pytest.approx(1.0)


def test_accelerometer_feels_the_acceleration_over_ground(tmp_path: Path) -> None:
    engine = Engine(boats.planar(tmp_path, {"current": {"north": 0.2}}), step=1e-4)
    engine.reset(START, boats.push(2.0, 0.1))
    engine.advance()
    before = engine.state
    engine.advance()
    after, (ax, ay) = engine.state, engine.acceleration()
    # v' = a - omega x v in body axes
    assert ax == pytest.approx((after.u - before.u) / 1e-4 - after.r * after.v, abs=1e-3)
    assert ay == pytest.approx((after.v - before.v) / 1e-4 + after.r * after.u, abs=1e-3)


def test_the_acceleration_is_that_at_the_end_of_a_step_on_every_mujoco(tmp_path: Path) -> None:
    boat = boats.planar(tmp_path)
    engine, fine = Engine(boat, step=0.1), Engine(boat, step=1e-4)
    for one, steps in ((engine, 2), (fine, 2000)):
        one.reset(START, boats.push(2.0, 0.1))
        one.advance(steps)
    assert engine.acceleration() == pytest.approx(fine.acceleration(), rel=2e-3)


# Walls

ELASTIC: dict[str, Any] = {
    "wall_solref": (-2000.0, 0.0),
    "friction": 0.0,
}  # [1/s^2] stiffness, no damping
ADDED = {"added_mass": {"surge": 0.6, "sway": 3.0, "yaw": 0.3, "sway_at": 0.1}}
MASS = np.array(
    [[6.6, 0.0, 0.0], [0.0, 9.0, 0.3], [0.0, 0.3, 0.8 + 3.0 * 0.1**2]]
)  # M_RB + M_A of that boat


def momentum(s: State) -> Array:
    """M nu turned to earth axes: linear (2,) [N s], angular about the earth's origin [N m s]."""
    m = MASS @ [s.u, s.v, s.r]
    c, n = cos(s.psi), sin(s.psi)
    P = np.array([c * m[0] - n * m[1], n * m[0] + c * m[1]])
    return np.array([*P, m[2] + s.x * P[1] - s.y * P[0]])


def energy(s: State) -> float:
    nu = np.array([s.u, s.v, s.r])
    return float(0.5 * nu @ MASS @ nu)


def contact_force(engine: Engine, probe: Any) -> tuple[Array, int]:
    """MuJoCo's own contact force now, SNAME, moment about the earth's origin; and the number of
    contacts."""
    probe.qpos[:], probe.qvel[:], probe.userdata[:] = (
        engine.data.qpos,
        engine.data.qvel,
        engine.data.userdata,
    )
    with installed_callback(engine.callback):
        mujoco.mj_forward(engine.model, probe)
    X, Y, N = probe.qfrc_constraint * (1.0, -1.0, -1.0)
    s = engine.state
    return np.array([X, Y, N + s.x * Y - s.y * X]), probe.ncon


def moving(psi: float, u: float, v: float = 0.0, r: float = 0.0) -> State:
    """In the middle of the tank, on its way to the wall ahead."""
    return State(psi=psi, u=u, v=v, r=r)


@pytest.mark.parametrize(
    "start",
    [moving(0.0, 0.5), moving(pi, -0.5), moving(pi / 2, 0.0, -0.5), moving(0.6, 0.5, 0.1, 0.3)],
    ids=["bow", "stern", "side", "corner, turning"],
)
@pytest.mark.parametrize("callback", ["native", "python"])
def test_impulse_of_an_elastic_wall(tmp_path: Path, start: State, callback: str) -> None:
    boat = boats.planar(tmp_path, boats.WITHOUT_DRAG | ADDED)
    engine = Engine(boat, Tank(2.0, 20.0, 1.0), step=1e-3, callback=callback, **ELASTIC)
    engine.reset(start)
    probe, impulse, touched = copy.copy(engine.data), np.zeros(3), False
    for _ in range(4000):
        engine.advance()
        force, contacts = contact_force(engine, probe)
        impulse += force * engine.step
        if touched and not contacts:
            break
        touched = touched or contacts > 0
    assert touched
    change = momentum(engine.state) - momentum(start)
    assert abs(change[0]) > 1.0  # [N s]
    assert impulse == pytest.approx(change, abs=0.01 * float(np.abs(change).max()))
    assert change[1] == pytest.approx(
        0.0, abs=1e-3
    )  # a frictionless wall across x pushes along x only
    assert energy(engine.state) == pytest.approx(energy(start), rel=0.01)


def test_a_boat_in_a_tank_stays_in_it() -> None:
    boat = on_water("joystick_boat")
    engine = Engine(boat, Tank(1.5, 3.0, 0.1))
    engine.reset(State())
    full = {"pwm_port": 255.0, "pwm_starboard": 255.0}
    engine.command(full)
    engine.advance(1000)
    nose = engine.state.x + cos(engine.state.psi) * 0.7
    assert engine.contacts > 0
    assert nose < 0.75 + 0.02


# Symmetry, current, axes

MIRROR = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])


def mirror_commands(boat: Vessel, rows: Array) -> Array:
    """Port and starboard change places; angles change sign."""
    names = list(boat.commands)
    other = [
        n.replace("starboard", "port") if "starboard" in n else n.replace("port", "starboard")
        for n in names
    ]
    sign = [-1.0 if n in boat.angles else 1.0 for n in names]
    return rows[:, [names.index(n) for n in other]] * sign


def test_mirror_image_of_commands_and_weather_gives_the_mirror_image_of_the_run() -> None:
    boat = on_water("joystick_boat")
    image = vessel.load_vessel(
        "joystick_boat",
        extra=[
            {"use": n} | v | {k: -v[k] for k in ("toward", "east") if k in v}
            for n, v in EXTRA.items()
        ],
    )
    rows = held_commands(boat, 100, seed=4)
    mirrored_start = START._replace(y=-START.y, psi=-START.psi, v=-START.v, r=-START.r)
    seen = sailed(Engine(image), mirror_commands(boat, rows), 5, mirrored_start)
    assert seen == pytest.approx(sailed(Engine(boat), rows, 5) * MIRROR, rel=1e-9, abs=1e-9)


def test_a_uniform_current_only_carries_the_boat_along() -> None:
    still, moving = (
        on_water("joystick_boat", (), "current", "fan_wind"),
        on_water("joystick_boat", (), "fan_wind"),
    )
    north, east = EXTRA["current"]["north"], EXTRA["current"]["east"]
    c, s = cos(START.psi), sin(START.psi)
    carried = START._replace(u=START.u + c * north + s * east, v=START.v + c * east - s * north)
    rows = held_commands(still, 100, seed=5)
    at_rest, adrift = sailed(Engine(still), rows, 5), sailed(Engine(moving), rows, 5, carried)
    t = 0.1 * np.arange(101)
    assert adrift[:, :2] - at_rest[:, :2] == pytest.approx(np.outer(t, [north, east]), abs=1e-7)
    assert adrift[:, [2, 5]] == pytest.approx(at_rest[:, [2, 5]], abs=1e-7)


def test_joints_are_z_up_and_states_are_sname(tmp_path: Path) -> None:
    engine = Engine(vessel.load_vessel("jet_ski"))
    engine.reset(START)
    c, s = cos(START.psi), sin(START.psi)
    assert [engine.model.joint(i).name for i in range(4)] == ["x", "y", "psi", "phi"]
    assert engine.data.qpos == pytest.approx([START.x, -START.y, -START.psi, START.phi])
    north, east = c * START.u - s * START.v, s * START.u + c * START.v
    assert engine.data.qvel == pytest.approx([north, -east, -START.r, START.p])
    assert engine.state == pytest.approx(START)


def test_positive_heading_is_clockwise_and_positive_y_is_to_starboard_in_mujoco(
    tmp_path: Path,
) -> None:
    engine = Engine(boats.planar(tmp_path))
    engine.reset(State(x=1.0, y=2.0, psi=0.5, u=0.3))
    mujoco.mj_forward(engine.model, engine.data)
    hull = engine.data.body("hull")
    assert hull.xpos == pytest.approx([1.0, -2.0, 0.0])
    assert hull.xmat.reshape(3, 3)[:, 0] == pytest.approx(
        [cos(0.5), -sin(0.5), 0.0]
    )  # where the bow points
    assert hull.xmat.reshape(3, 3)[:, 2] == pytest.approx([0.0, 0.0, 1.0])


def test_more_port_thrust_turns_to_starboard_and_steering_to_starboard_pushes_there(
    tmp_path: Path,
) -> None:
    engine = Engine(boats.planar(tmp_path))
    engine.reset(None, {"thrust_port_N": 1.0, "thrust_starboard_N": -1.0})
    engine.advance(10)
    assert engine.state.r > 0 and engine.data.qvel[2] < 0
    engine.reset(
        None,
        {
            n: 1.5
            for n in (
                "thrust_port_N",
                "thrust_starboard_N",
                "steer_port_rad",
                "steer_starboard_rad",
            )
        },
    )
    engine.advance(10)
    assert engine.state.v > 0 and engine.data.body("hull").xpos[1] < 0


# Global state and errors


def falling_body() -> tuple[Any, Any]:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><size nuserdata='3'/><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    )
    return model, mujoco.MjData(model)


@pytest.mark.parametrize("callback", ["native", "python"])
def test_the_callback_leaves_models_of_another_size_alone(tmp_path: Path, callback: str) -> None:
    model, data = falling_body()
    engine = Engine(boats.planar(tmp_path), callback=callback)
    with installed_callback(engine.callback):
        mujoco.mj_step(model, data, nstep=100)
    _, undisturbed = falling_body()
    mujoco.mj_step(model, undisturbed, nstep=100)
    assert data.qpos[2] < -0.1
    assert (data.qpos == undisturbed.qpos).all() and (data.qvel == undisturbed.qvel).all()


@pytest.mark.parametrize("callback", ["native", "python"])
def test_the_callback_is_there_only_while_stepping(tmp_path: Path, callback: str) -> None:
    engine = Engine(boats.planar(tmp_path), callback=callback)
    assert mujoco.get_mjcb_passive() is None
    engine.advance(3)
    assert mujoco.get_mjcb_passive() is None
    engine.advance_without_actuators(3)
    assert mujoco.get_mjcb_passive() is None


def test_the_callback_is_taken_out_after_an_exception(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine = Engine(boats.planar(tmp_path))
    inside: list[bool] = []

    def broken(*_: Any) -> None:
        inside.append(mujoco.get_mjcb_passive() is not None)
        raise RuntimeError("broken")

    monkeypatch.setattr(mujoco, "mj_step", broken)
    with pytest.raises(RuntimeError, match="broken"):
        engine.advance()
    assert inside == [True] and mujoco.get_mjcb_passive() is None


def test_two_engines_do_not_disturb_each_other(tmp_path: Path) -> None:
    light, laden = boats.planar(tmp_path), boats.planar(tmp_path, loads=["laden"])
    commands: Mapping[str, float] = boats.push(2.0, 0.1)
    alone = []
    for boat in (light, laden):
        engine = Engine(boat)
        engine.reset(START, commands)
        engine.advance(60)
        alone.append(engine.state)
    pair = [Engine(light), Engine(laden)]
    for engine in pair:
        engine.reset(START, commands)
    for _ in range(20):
        for engine in pair:
            engine.advance(3)
    assert [engine.state for engine in pair] == alone
    assert alone[0].x != alone[1].x


def test_a_run_works_out_its_state_once_a_step(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, plain = [], Engine.state.fget

    def counted(engine: Engine) -> State:
        asked.append(engine.data.time)
        return plain(engine)

    monkeypatch.setattr(Engine, "state", property(counted))
    done = run(scenario.load("joystick_boat/sway_1", {"duration": 2.0, "until": {}}))
    assert len(asked) == done.steps == 100


def test_a_motion_that_is_no_longer_finite_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its warning into the working directory
    engine = Engine(boats.planar(tmp_path))
    engine.reset(State(u=1e200))
    with pytest.raises(BadPhysics, match="test_boat: the motion is no longer finite"):
        engine.advance(5)
    assert mujoco.get_mjcb_passive() is None


def test_a_command_the_boat_does_not_take_is_refused_with_the_nearest(tmp_path: Path) -> None:
    engine = Engine(boats.planar(tmp_path))
    with pytest.raises(BadInput, match="did you mean 'thrust_port_N'"):
        engine.command({"thrust_prot_N": 1.0})


def test_reset_settles_the_actuators_and_forgets_the_run_before() -> None:
    engine = Engine(on_water("joystick_boat"))
    rows = held_commands(engine.vessel, 20, seed=6)
    first = sailed(engine, rows, 5)
    assert (sailed(engine, rows, 5) == first).all()
    engine.reset(None, {"pwm_port": 150.0, "steer_port_rad": 2.0})
    assert engine.actuators["thrust_port_N"] == pytest.approx(0.617)
    assert engine.actuators["steer_port_rad"] == pytest.approx(0.7854)  # its range
