"""Linear models of vessels against closed forms, against simulation and against the exponential."""

import json
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.signal import cont2discrete

import boatsim
from boatsim.cli import app
from boatsim.control.linear_model import LinearModel, read_linear_model
from boatsim.control.linear_quadratic import axis_parameters
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.content import load_class
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.steady_motion import find_steady_motion
from boatsim.simulate.stepper import State

PLANE = ("u", "v", "r")


def rows(model: LinearModel, names: tuple[str, ...]) -> list[int]:
    return [model.state(name) for name in names]


def block(model: LinearModel, names: tuple[str, ...]) -> Array:
    return np.asarray(model.a[np.ix_(rows(model, names), rows(model, names))])


def barge(mass: dict[str, float], damping: dict[str, float], *effects: dict[str, Any]) -> Vessel:
    """A hull with linear damping and a thruster that turns, about its mass centre."""
    return boatsim.Vessel.from_effects(
        name="barge",
        dof=("surge", "sway", "yaw"),
        length=2.0,
        beam=0.8,
        draught=0.2,
        body={"mass": 120.0, "roll_inertia": 8.0, "yaw_inertia": 40.0},
        channels={
            "thrust_N": {"low": -50.0, "high": 50.0},
            "angle_rad": {"low": -0.6, "high": 0.6},
        },
        effects=[
            {"use": "added_mass", **mass},
            {"use": "linear_damping", **damping},
            {"use": "thruster", "x": -1.0, "on": {"thrust": "thrust_N", "angle": "angle_rad"}},
            *effects,
        ],
    )


# Closed forms
# ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "mass", "damping"),
    [
        ("blueboat", (15.0, 15.0, 1.7), (32.0, 60.0, 15.0)),
        ("twin_usv", (1.0, 1.0, 1.0), (0.5, 2.0, 1.0)),
        ("catamaran", (7.35, 10.180863, 1.0336865), (14.0, 80.0, 5.0)),
        ("trial_boat", (4.9, 13.6, 1.3), (3.0, 10.0, 1.0)),
    ],
)
def test_linear_vessels_at_rest_have_minus_damping_over_mass(
    name: str, mass: tuple[float, ...], damping: tuple[float, ...]
) -> None:
    """Numbers are those of the vessel files; a = -M^-1 D, and E = M^-1."""
    model = boatsim.linearise(name)
    expected = -np.diag(np.array(damping) / np.array(mass))
    assert block(model, PLANE) == pytest.approx(expected, rel=1e-7, abs=1e-8)
    assert model.e[rows(model, PLANE)] == pytest.approx(np.diag(1.0 / np.array(mass)), abs=1e-8)


def test_coupled_damping_of_a_published_state_space_is_found_again() -> None:
    """A_p of table 10 of the thesis, whose entries the vessel file multiplies by mass or inertia."""
    model = boatsim.linearise("thesis_linear")
    expected = [
        [-0.0403936 / 10.4, 0.0235664 / 10.4],
        [-0.00292248 / 1.98, -0.00219186 / 1.98],
    ]
    assert block(model, ("v", "r")) == pytest.approx(np.array(expected), rel=1e-7)


@settings(max_examples=15, deadline=None)
@given(
    added=st.tuples(*[st.floats(5.0, 150.0)] * 2, st.floats(5.0, 40.0)),
    lever=st.floats(-0.3, 0.3),
    damping=st.tuples(*[st.floats(5.0, 200.0)] * 3),
    couplings=st.tuples(*[st.floats(-20.0, 20.0)] * 2),
    # at lower speeds the influence of the angle is below what `linearise` sets to zero (ROUNDING)
    speed=st.just(0.0) | st.floats(-0.2, -1e-4) | st.floats(1e-4, 1.0),
)
def test_sway_and_yaw_under_way_are_those_of_the_handbook(
    added: tuple[float, float, float],
    lever: float,
    damping: tuple[float, float, float],
    couplings: tuple[float, float],
    speed: float,
) -> None:
    """M nu' + N(u0) nu = tau (Fossen 2021, equation 6.98), with the Munk moment."""
    mass = {"surge": added[0], "sway": added[1], "sway_at": lever, "yaw": added[2]}
    names = ("surge", "sway", "yaw", "sway_by_yaw", "yaw_by_sway")
    table = dict(zip(names, (*damping, *couplings), strict=True))
    vessel = barge(mass, table)
    if abs(damping[0] * speed) > 50.0:
        with pytest.raises(BadInput, match="no steady straight course"):
            boatsim.linearise(vessel, speed=speed)
        return
    model = boatsim.linearise(vessel, speed=speed)
    coupling = added[1] * lever
    m = np.array([[120.0 + added[1], coupling], [coupling, 40.0 + added[2] + coupling * lever]])
    n = np.array(
        [
            [damping[1], (120.0 + added[0]) * speed + couplings[0]],
            [(added[1] - added[0]) * speed + couplings[1], coupling * speed + damping[2]],
        ]
    )
    assert block(model, ("v", "r")) == pytest.approx(-np.linalg.solve(m, n), rel=1e-6, abs=1e-7)
    thrust = damping[0] * speed
    side = np.linalg.solve(m, [thrust, -thrust])  # of a small angle at x = -1 m
    j = model.input("angle_rad")
    assert model.b[rows(model, ("v", "r")), j] == pytest.approx(side, rel=1e-6, abs=1e-7)
    assert model.inputs[model.input("thrust_N")].value == pytest.approx(thrust, abs=1e-6)


def test_nomoto_constants_of_a_rudder_ship_are_those_of_its_derivatives() -> None:
    """K, T1, T2 and T3 from the derivatives of the vessel file (Nomoto 1957)."""
    speed, mass, centre = 1.179, 3272.0, 0.2436
    model = boatsim.linearise("kvlcc2", speed=speed)
    m = np.array([[mass + 2486.0, mass * centre], [mass * centre, 9908.6 + 6009.0]])
    m[1, 1] += mass * centre**2
    n = np.array([[591.4, mass * speed - 801.8], [1800.6, mass * centre * speed + 4508.0]])
    b = np.array([-113.9, 391.9])
    # Davidson and Schiff 1946
    determinant = np.linalg.det(n)
    product = np.linalg.det(m) / determinant
    total = n[0, 0] * m[1, 1] + n[1, 1] * m[0, 0] - n[0, 1] * m[1, 0] - n[1, 0] * m[0, 1]
    gain = (n[0, 0] * b[1] - n[1, 0] * b[0]) / determinant
    zero = (m[0, 0] * b[1] - m[1, 0] * b[0]) / (n[0, 0] * b[1] - n[1, 0] * b[0])
    found = model.nomoto("delta_rad")
    assert found.K == pytest.approx(gain, rel=1e-6)
    assert complex(found.T1 * found.T2).real == pytest.approx(product, rel=1e-6)
    assert complex(found.T1 + found.T2).real == pytest.approx(total / determinant, rel=1e-6)
    assert found.T3 == pytest.approx(zero, rel=1e-6)
    assert found.T == pytest.approx(total / determinant - zero, rel=1e-6)


def test_nomoto_constants_need_a_command_that_turns_the_vessel() -> None:
    model = boatsim.linearise("joystick_boat", speed=0.5)
    names = ("v", "r", "servo.steer_port_rad")
    steady = -np.linalg.solve(block(model, names), model.b[rows(model, names)])
    expected = steady[1, model.input("steer_port_rad")]
    assert model.nomoto("steer_port_rad").K == pytest.approx(expected, rel=1e-9)
    with pytest.raises(BadInput, match="no steady yaw rate"):
        boatsim.linearise("joystick_boat").nomoto("steer_port_rad")
    with pytest.raises(BadInput, match="input 'steer' does not exist"):
        model.nomoto("steer")


def test_a_current_changes_the_steady_motion_and_no_mode() -> None:
    """A uniform current is a moving frame; only the heading then moves the velocity over ground."""
    vessel = load_vessel("joystick_boat")
    commands = {"pwm_port": 100.0, "pwm_starboard": 100.0}
    still = boatsim.linearise(vessel, commands=commands)
    flow = vessel.with_effect({"use": "current", "north": 0.2, "east": -0.1})
    moved = boatsim.linearise(flow, commands=commands)
    for name, by in (("u", 0.2), ("v", -0.1)):
        before, after = (one.states[one.state(name)].value for one in (still, moved))
        assert after - before == pytest.approx(by, abs=1e-9)
    for old, new in zip(eigenvalues(still), eigenvalues(moved), strict=True):
        assert new == pytest.approx(old, abs=1e-5)


def eigenvalues(model: LinearModel) -> list[complex]:
    found = [mode.eigenvalue for mode in model.modes]
    return sorted(found, key=lambda value: (round(value.real, 4), value.imag))


# Simulation
# ------------------------------------------------------------------------------------------------


def simulated_change(
    vessel: Vessel, state: State, settled: dict[str, float], step: dict[str, float], time: float
) -> Array:
    """Change of u, v and r after a step of the commands."""
    engine = OpenWater(vessel, 0.005)
    engine.reset(state, settled)
    engine.command({**settled, **step})
    engine.advance(round(time / 0.005))
    return np.array([getattr(engine.state, n) - getattr(state, n) for n in PLANE])


@pytest.mark.parametrize(
    ("name", "commands", "step", "time"),
    [
        (
            "joystick_boat",
            {"pwm_port": 120.0, "pwm_starboard": 90.0},
            {"pwm_port": 20.0, "steer_port_rad": 0.2},
            1.0,
        ),
        ("mariner", {"delta_rad": 0.1}, {"delta_rad": 0.05}, 30.0),
        ("otter", {"n_port_radps": 80.0, "n_starboard_radps": 70.0}, {"n_port_radps": 8.0}, 1.0),
        ("jet_ski", {"throttle": 2.5, "jet_rad": 0.05}, {"jet_rad": 0.02, "throttle": 0.1}, 2.0),
    ],
)
def test_error_of_the_response_to_a_step_is_of_second_order(
    name: str, commands: dict[str, float], step: dict[str, float], time: float
) -> None:
    """Without rate limits the error of the linear model falls by 4 as the step is halved."""
    vessel = load_vessel(name)
    rates = {}
    for effect in vessel.effects:
        if effect.name in ("servo", "elevator_servo", "steering_rate_limit", "throttle_rate_limit"):
            rates[effect.name] = {"rate": 50.0 if "steering" in effect.name else 1e3}
    vessel = vessel.with_parameters(rates)
    steady = find_steady_motion(vessel, commands)
    model = boatsim.linearise(vessel, commands=commands).discretised(time)
    errors = []
    for factor in (0.4, 0.2, 0.1):
        small = {key: factor * value for key, value in step.items()}
        target = {key: steady.commands[key] + value for key, value in small.items()}
        found = simulated_change(vessel, steady.state, dict(steady.commands), target, time)
        u = np.zeros(len(model.inputs))
        for key, value in small.items():
            u[model.input(key)] = value
        expected = (model.b @ u)[rows(model, PLANE)]
        assert found == pytest.approx(expected, abs=0.25 * np.abs(expected).max())
        errors.append(float(np.abs(found - expected).max()))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.15)


@pytest.mark.parametrize(
    ("name", "options", "mode", "signal"),
    [
        ("joystick_boat", {"speed": 0.5}, "surge", "u"),
        ("mariner", {}, "sway-yaw", "r"),
        ("kvlcc2_roll", {}, "roll", "phi"),
        ("pendulum", {"commands": {"torque_Nm": 1.0}}, "roll", "phi"),
        ("otter", {"speed": 1.0}, "roll", "phi"),
        ("kynoc", {}, "roll", "phi"),
    ],
)
def test_a_simulated_decay_has_the_eigenvalue_of_the_mode(
    name: str, options: dict[str, Any], mode: str, signal: str
) -> None:
    """Released in the shape of a mode, the motion stays in it: x(t) = Re(e^(s t) shape)."""
    vessel = load_vessel(name)
    model = boatsim.linearise(vessel, **options)
    value = next(one.eigenvalue for one in model.modes if one.name == mode)
    values, shapes = np.linalg.eig(model.a)
    shape = shapes[:, int(np.argmin(np.abs(values - value)))]
    shape = shape / shape[model.state(signal)]
    steady = find_steady_motion(vessel, options.get("commands"), options.get("speed"))
    changes = {}
    for one, by in zip(model.states, shape.real.tolist(), strict=True):
        if one.name in State._fields:
            changes[one.name] = getattr(steady.state, one.name) + 1e-5 * by
    time = min(1.0 / abs(value.real), 2.0 * pi / value.imag if value.imag else 1e9)
    engine = OpenWater(vessel, time / 400)
    engine.reset(steady.state._replace(**changes), steady.commands)
    engine.advance(400)
    end = getattr(engine.state, signal) - getattr(steady.state, signal)
    expected = 1e-5 * np.exp(value * time).real
    assert end == pytest.approx(expected, abs=1e-5 * 3e-3)


def test_time_constants_and_damping_ratios_are_those_of_the_eigenvalue() -> None:
    (roll,) = boatsim.linearise("kvlcc2_roll").modes
    # I phi'' + d phi' + c phi = 0 with the numbers of the vessel file
    inertia, damping, stiffness = 115.6 + 19.8, 6.7, 822.3
    assert roll.name == "roll"
    assert roll.frequency == pytest.approx((stiffness / inertia) ** 0.5, rel=1e-6)
    ratio = damping / 2.0 / (stiffness * inertia) ** 0.5
    assert roll.damping_ratio == pytest.approx(ratio, rel=1e-5)
    assert roll.time_constant == pytest.approx(2.0 * inertia / damping, rel=1e-5)


# Discrete models, modes and ranks
# ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dt", [0.01, 0.08, 1.0])
def test_the_discrete_model_is_the_exponential_and_that_of_scipy(dt: float) -> None:
    model = boatsim.linearise("joystick_boat", speed=0.5)
    found = boatsim.linearise("joystick_boat", speed=0.5, discrete=dt)
    assert found.a == pytest.approx(expm(model.a * dt), rel=1e-12, abs=1e-14)
    theirs = cont2discrete((model.a, model.b, model.c, model.d), dt)
    for own, other in zip((found.a, found.b, found.c, found.d), theirs, strict=False):
        assert own == pytest.approx(other, rel=1e-10, abs=1e-12)
    assert found.state_space().dt == dt
    # two samples are one sample of twice the length
    twice = model.discretised(2.0 * dt)
    assert twice.a == pytest.approx(found.a @ found.a, rel=1e-9, abs=1e-12)
    assert twice.b == pytest.approx(found.a @ found.b + found.b, rel=1e-9, abs=1e-12)
    for old, new in zip(eigenvalues(model), eigenvalues(found), strict=True):
        assert new == pytest.approx(old, rel=1e-4, abs=1e-6)


def test_the_sampled_model_of_margins_is_the_exponential_of_the_continuous_one() -> None:
    from boatsim.simulate.linearisation import linearise_vessel

    vessel = load_vessel("joystick_boat")
    steady = find_steady_motion(vessel, speed=0.5)
    sampled = linearise_vessel(vessel, steady.state, steady.commands, 0.08)
    model = boatsim.linearise(vessel, speed=0.5).discretised(0.08)
    for name in ("psi", *PLANE):
        i, k = model.state(name), sampled.outputs[name]
        for other in ("psi", *PLANE):
            expected = model.a[i, model.state(other)]
            assert sampled.a[k, sampled.outputs[other]] == pytest.approx(expected, abs=1e-6)
        assert sampled.b[k] == pytest.approx(model.b[i], abs=2e-6)


def test_modes_have_the_names_of_the_field() -> None:
    names = [mode.name for mode in boatsim.linearise("otter", speed=1.0).modes]
    for name in ("heading (integrator)", "surge", "sway-yaw", "roll", "heave-pitch", "shaft_lag"):
        assert name in names
    lags = [mode for mode in boatsim.linearise("otter").modes if mode.name == "shaft_lag"]
    assert [mode.time_constant for mode in lags] == pytest.approx([0.1, 0.1], rel=1e-6)


def test_what_no_input_reaches_and_no_output_shows_is_marked() -> None:
    free = boatsim.linearise("kvlcc2_roll")
    assert (free.controllable_states, free.observable_states) == (0, 2)
    assert not free.modes[0].controllable and free.modes[0].observable
    held = boatsim.linearise("kynoc")  # the speed is held, no command changes it
    for mode in held.modes:
        assert mode.controllable == (mode.name != "surge")
    assert held.controllable_states == len(held.states) - 1
    rate = boatsim.linearise("mariner", outputs="r")
    assert rate.c.shape == (1, 4) and rate.observable_states == 3
    assert [m.name for m in rate.modes if not m.observable] == ["heading (integrator)"]


def test_position_is_a_state_on_request() -> None:
    plain = boatsim.linearise("joystick_boat", speed=0.5)
    model = boatsim.linearise("joystick_boat", speed=0.5, position=True)
    assert {one.name for one in model.states} - {one.name for one in plain.states} == {"x", "y"}
    y = model.a[model.state("y")]
    assert y[model.state("v")] == pytest.approx(1.0) and y[model.state("psi")] == pytest.approx(0.5)
    turning = {"pwm_port": 120.0, "pwm_starboard": 60.0}
    with pytest.raises(BadInput, match="straight course"):
        boatsim.linearise("joystick_boat", commands=turning, position=True)


def test_delay_play_and_pause_are_named_and_left_out() -> None:
    vessel = load_vessel("joystick_boat")
    plain = boatsim.linearise(vessel, speed=0.5)
    late = vessel.with_effect({"use": "command_delay", "delay": 0.2})
    late = late.with_effect({"use": "steering_backlash"})
    late = late.with_effect({"use": "reversal_pause", "pause": 0.5})
    model = boatsim.linearise(late, speed=0.5)
    assert model.delay == pytest.approx(0.2)
    one = vessel.with_effect({"use": "command_delay", "delay": 0.2, "on": ["thrust_port_N"]})
    remarks = boatsim.linearise(one, speed=0.5).remarks
    assert remarks == ("the dead time acts on thrust_port_N only",)
    assert "steering_backlash" in model.remarks[0] and "reversal_pause" in model.remarks[0]
    assert model.a == pytest.approx(plain.a, abs=1e-9)


def test_derivatives_that_differ_to_both_sides_are_named() -> None:
    model = boatsim.linearise("jet_ski", commands={"throttle": 4.0})
    assert "throttle" in " ".join(model.remarks)
    assert not boatsim.linearise("jet_ski", commands={"throttle": 3.0}).remarks


def test_a_command_at_the_end_of_its_range_has_its_derivative_from_inside() -> None:
    for high in (20.0, 50.0):
        vessel = barge({}, {"surge": 20.0, "sway": 40.0, "yaw": 30.0})
        channels = dict(vessel.commands)
        channels["thrust_N"] = boatsim.CommandChannel(low=-50.0, high=high)
        model = boatsim.linearise(vessel.replace(commands=channels), commands={"thrust_N": 20.0})
        b = model.b[model.state("u"), model.input("thrust_N")]
        surge = model.e[model.state("u"), 0]
        assert b == pytest.approx(surge, rel=1e-6)


# Steady motions
# ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "speed"),
    [
        ("joystick_boat", 0.5),
        ("joystick_boat", -0.3),
        ("otter", 2.0),
        ("kvlcc2_mmg", 0.8),
        ("osv", 2.0),
        ("catamaran", 1.0),
        ("jet_ski", 10.0),
    ],
)
def test_a_vessel_keeps_the_speed_for_which_commands_were_found(name: str, speed: float) -> None:
    vessel = load_vessel(name)
    steady = find_steady_motion(vessel, speed=speed)
    assert steady.state.u == speed and steady.state.r == 0.0
    engine = OpenWater(vessel, 0.01)
    engine.reset(steady.state, steady.commands)
    engine.advance(100)
    for field in ("u", "v", "r", "phi", "z", "theta"):
        assert getattr(engine.state, field) == pytest.approx(getattr(steady.state, field), abs=1e-6)


def test_a_turn_is_the_steady_motion_under_different_thrusts() -> None:
    vessel = load_vessel("otter")
    steady = find_steady_motion(vessel, {"n_port_radps": 80.0, "n_starboard_radps": 60.0})
    engine = OpenWater(vessel, 0.02)
    engine.reset(State(u=1.0), steady.commands)
    engine.advance(4000)
    for field in ("u", "v", "r", "phi"):
        assert getattr(engine.state, field) == pytest.approx(getattr(steady.state, field), abs=1e-5)
    assert steady.state.r > 0.1


# Controller
# ------------------------------------------------------------------------------------------------


def test_lqi_is_designed_from_the_file_of_a_linear_model(tmp_path: Path) -> None:
    """Inertia and damping of a barge without couplings, and the lag and delay of its commands."""
    lag = {"use": "thrust_lag", "time_constant": 0.3}
    delay = {"use": "command_delay", "delay": 0.1}
    vessel = barge(
        {"surge": 10.0, "sway": 90.0, "yaw": 5.0},
        {"surge": 20.0, "sway": 60.0, "yaw": 30.0},
        lag,
        delay,
    )
    boatsim.linearise(vessel).write(tmp_path / "model.json")
    made: Any = load_class("controller", "lqi")(model=str(tmp_path / "model.json"))
    kind = load_class("controller", "lqi")
    numbers = {"inertia": 45.0, "mass": 130.0, "yaw_damping": 30.0, "surge_damping": 20.0}
    own: Any = kind(**numbers, motor_lag=0.3, command_delay=0.1)
    for name in (*numbers, "motor_lag", "command_delay", "yaw_integral", "yaw_velocity"):
        assert getattr(made, name) == pytest.approx(getattr(own, name), rel=1e-6), name
    for name in ("surge_integral", "surge_velocity", "surge_force", "yaw_force"):
        assert getattr(made, name) == pytest.approx(getattr(own, name), rel=1e-6), name


def test_gains_of_lqi_at_one_bandwidth_are_unchanged() -> None:
    made: Any = load_class("controller", "lqi")(bandwidth=0.5 / 0.49)
    assert made.yaw_integral == pytest.approx(0.999694354011933, rel=1e-9)
    assert made.yaw_velocity == pytest.approx(2.1440619493551965, rel=1e-9)
    assert made.surge_velocity == pytest.approx(5.360154873388217, rel=1e-9)


def test_files_of_linear_models_that_lqi_cannot_use_are_named(tmp_path: Path) -> None:
    lqi = load_class("controller", "lqi")
    path = tmp_path / "model.json"
    with pytest.raises(BadInput, match="model.json: No such file"):
        lqi(model=str(path))
    path.write_text("no JSON")
    with pytest.raises(BadInput, match="model.json: is no JSON text"):
        lqi(model=str(path))
    path.write_text("[1]")
    with pytest.raises(BadInput, match="format = None; allowed is 'boatsim linear model 1'"):
        lqi(model=str(path))
    model = boatsim.linearise("joystick_boat", speed=0.5)
    table = model.to_table()
    del table["E"]
    path.write_text(json.dumps(table))
    with pytest.raises(BadInput, match="entry is missing"):
        lqi(model=str(path))
    with pytest.raises(BadInput, match="without --discrete"):
        axis_parameters(model.discretised(0.1))
    with pytest.raises(BadInput, match="state 'r' does not exist"):
        axis_parameters(boatsim.linearise("kvlcc2_roll"))


# Files and command line
# ------------------------------------------------------------------------------------------------


def test_a_model_that_is_read_again_is_the_same(tmp_path: Path) -> None:
    model = boatsim.linearise("joystick_boat", speed=0.5)
    model.write(tmp_path / "model.json")
    again = read_linear_model(tmp_path / "model.json")
    for name in "abcde":
        assert np.array_equal(getattr(again, name), getattr(model, name))
    assert (again.states, again.inputs, again.outputs) == (
        model.states,
        model.inputs,
        model.outputs,
    )
    assert again.modes == model.modes
    model.write(tmp_path / "model.npz")
    with np.load(tmp_path / "model.npz") as file:  # without pickle
        for name in "ABCDE":
            assert np.array_equal(file[name], getattr(model, name.lower()))
        assert file["states"].tolist() == [one.name for one in model.states]
        assert file["u0"].tolist() == [one.value for one in model.inputs]


def call(*words: object) -> int:
    with pytest.raises(SystemExit) as found:
        app(["linearise", *map(str, words)])
    return int(found.value.code or 0)


def test_the_command_prints_the_motion_and_the_modes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "folder" / "model.json"
    assert call("joystick_boat", "--speed", 0.5, "--out", out, "--discrete", 0.1) == 0
    text = capsys.readouterr().out
    for part in ("pwm_port", "77.19", "sway-yaw", "doubles in", "not observable", "of 8 states"):
        assert part in text
    assert read_linear_model(out).dt == 0.1
    table = json.loads(out.read_text())
    assert table["modes"][0]["name"] == "heading (integrator)"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nowhere"], "vessel 'nowhere' does not exist"),
        (["joystick_boat", "--command", "pwm_prt=3"], "did you mean 'pwm_port'?"),
        (["joystick_boat", "--command", "pwm_port=300"], "pwm_port = 300; allowed -255 to 255"),
        (["joystick_boat", "--command", "pwm_port"], "allowed is NAME=VALUE"),
        (["joystick_boat", "--command", "pwm_port=nan"], "allowed is NAME=VALUE"),
        (["joystick_boat", *["--command", "pwm_port=1"] * 2], "pwm_port is given twice"),
        (["joystick_boat", "--speed", "5"], "ends of their ranges give 0.912 m/s"),
        (["joystick_boat", "--speed", "inf"], "speed = inf; allowed -300 to 300 m/s"),
        (["joystick_boat", "--output", "q"], "state 'q' does not exist"),
        (["joystick_boat", "--discrete", "0"], "discrete = 0.0; allowed"),
        (["joystick_boat", "--out", "model.mat"], "allowed are names that end in .json or .npz"),
        (["pendulum", "--speed", "1"], "pendulum is not free in surge"),
        (["pendulum", "--command", "torque_Nm=4"], "no steady motion with torque_Nm = 4"),
        (["mariner", "--speed", "3"], "no free command changes its thrust"),
    ],
)
def test_bad_input_is_one_line(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(*words) == 2
    found = capsys.readouterr()
    assert message in found.err and found.err.count("\n") == 1 and not found.out


def test_no_steady_motion_in_waves_or_in_a_turn_in_a_current() -> None:
    barge_in_calm = barge(
        {"surge": 10.0, "sway": 90.0, "yaw": 15.0}, {"surge": 12.0, "sway": 60.0, "yaw": 30.0}
    )
    flow = barge_in_calm.with_effect({"use": "fan_wind", "speed": 4.0})
    turning = {"thrust_N": 10.0, "angle_rad": 0.4}
    assert boatsim.linearise(barge_in_calm, commands=turning).states
    with pytest.raises(BadInput, match="no steady motion"):
        boatsim.linearise(flow, commands=turning)


def test_wrong_arguments_of_python_are_named() -> None:
    model: Any = boatsim.linearise
    with pytest.raises(TypeError, match="speed"):
        model("joystick_boat", speed="fast")
    with pytest.raises(BadInput, match="load is allowed with the name"):
        model(load_vessel("joystick_boat"), load="heavy")
    with pytest.raises(BadInput, match="discrete already"):
        model("joystick_boat", discrete=0.1).discretised(0.1)
