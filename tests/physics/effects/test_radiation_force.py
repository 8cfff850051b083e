"""The radiation force of one axis against its transfer function and the matrix exponential."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

import boatsim
from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics.base import Array, MotionMemory, make_motion
from boatsim.physics.debugging import python_function
from boatsim.physics.effects.radiation_force import HeaveRadiation, PitchRadiation, RollRadiation
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State
from tests.radiation_rig import DAMPING, INERTIA, STIFFNESS, Body, Radiation, body_vessel, equations

DAMPED, FREQUENCY, RATIO = 150.0, 7.0, 0.5
FORCE = HeaveRadiation(damping=DAMPED, frequency=FREQUENCY, damping_ratio=RATIO)
STEP = 0.01  # [s]


def forces(effect: MotionMemory, speed: Callable[[float], float], t: Array) -> Array:
    """Force in heave [N] at the times t, from rest before the first one."""
    advance = python_function(type(effect).remember_motion)
    law, values = python_function(type(effect).law), effect.values()
    memory, act, none, found = np.zeros(effect.memory_states), np.zeros(6), np.zeros(1), []
    for now, dt in zip(t, np.diff(t, append=t[-1] + STEP), strict=True):
        motion = make_motion(w=speed(now))
        advance(motion, act, 2, 0, memory, 0, dt, values, none, 0)
        found.append(law(motion, values, act, 0, 0, none, 0).Z)
    return np.array(found)


def transfer_function(w: float) -> complex:
    """Force per speed [N s/m] at a frequency w [rad/s], by its definition."""
    s, a = 1j * w, 2.0 * RATIO * FREQUENCY
    return DAMPED * a * s / (s * s + a * s + FREQUENCY**2)


@pytest.mark.parametrize("w", [1.0, 4.0, FREQUENCY, 20.0])
def test_force_of_a_harmonic_motion_is_that_of_the_transfer_function(w: float) -> None:
    t = STEP * np.arange(2000)
    found = forces(FORCE, lambda now: np.cos(w * now), t)[1000:]
    table = np.column_stack([np.cos(w * t), np.sin(w * t)])[1000:]
    cosine, sine = np.linalg.lstsq(table, found, rcond=None)[0]
    expected = -transfer_function(w)
    assert cosine - 1j * sine == pytest.approx(expected, abs=2e-3 * DAMPED)


def test_damping_is_largest_at_its_frequency_and_vanishes_far_from_it() -> None:
    at = {w: transfer_function(w).real for w in (0.02, 3.0, FREQUENCY, 15.0, 2000.0)}
    assert at[FREQUENCY] == pytest.approx(DAMPED)
    assert 0.0 < at[3.0] < DAMPED and 0.0 < at[15.0] < DAMPED
    assert at[0.02] < 1e-4 * DAMPED and at[2000.0] < 1e-4 * DAMPED


def test_constant_speed_ends_without_a_force() -> None:
    assert abs(forces(FORCE, lambda now: 0.4, STEP * np.arange(1500))[-1]) < 1e-6 * DAMPED


def test_steps_of_other_lengths_give_the_same_force() -> None:
    def speed(now: float) -> float:
        return 0.3 * np.sin(5.0 * now) ** 2

    even = STEP * np.arange(401)
    uneven = np.cumsum(np.random.default_rng(1).uniform(0.3, 1.7, 1000) * STEP)
    uneven = np.append(0.0, uneven[uneven < 4.0])
    found = forces(FORCE, speed, uneven)
    same = np.interp(uneven, even, forces(FORCE, speed, even))
    assert found == pytest.approx(same, abs=3e-3 * np.abs(same).max())


@pytest.mark.parametrize("seed", range(3))
def test_force_never_supplies_more_energy_than_it_received(seed: int) -> None:
    """The work that the hull has done since rest is at no time negative."""
    rng = np.random.default_rng(seed)
    w, phase = rng.uniform(0.3, 25.0, 8), rng.uniform(0.0, 6.3, 8)

    def speed(now: float) -> float:
        return float(np.sin(w * now + phase).sum()) * (now < 8.0)

    effect = HeaveRadiation(
        damping=DAMPED,
        frequency=float(rng.uniform(1.0, 15.0)),
        damping_ratio=float(rng.uniform(0.1, 1.0)),
    )
    t = 0.002 * np.arange(6000)
    power = -forces(effect, speed, t) * np.array([speed(now) for now in t])
    work = np.cumsum(0.5 * (power[1:] + power[:-1]) * 0.002)
    assert work.min() > -1e-3 * work.max()


def test_a_closed_cycle_takes_energy_at_every_frequency() -> None:
    for w in (2.0, 7.0, 18.0):
        t = np.linspace(0.0, 2.0 * np.pi / w * 12.0, 12 * 200 + 1)
        speed = np.cos(w * t)
        force = forces(FORCE, lambda now, w=w: float(np.cos(w * now)), t)
        lost = -np.trapezoid((force * speed)[-201:], t[-201:])
        assert lost == pytest.approx(np.pi / w * transfer_function(w).real, rel=5e-3)


def test_each_effect_acts_in_its_own_axis_alone() -> None:
    motion = make_motion(w=1.0, p=1.0, q=1.0)
    for kind, axis in ((HeaveRadiation, "Z"), (RollRadiation, "K"), (PitchRadiation, "M")):
        values = kind(damping=1.0).values()
        act = np.array([2.0, 3.0])
        found = python_function(kind.law)(motion, values, act, 0, 0, act, 0)
        assert {name for name in found._fields if getattr(found, name)} == {axis}
        assert getattr(found, axis) == -5.0
        turned = make_motion(w=-1.0, p=-1.0, q=-1.0)
        image = python_function(kind.law)(turned, values, -act * [1.0, -1.0], 0, 0, act, 0)
        assert getattr(image, axis) == 5.0


# ---- vessels


REAL = Body(Radiation(damping=np.array([DAMPED, 1.2])))
EFFECTS = (
    {"use": "heave_radiation", "damping": DAMPED, "frequency": FREQUENCY, "damping_ratio": RATIO},
    {"use": "roll_radiation", "damping": 1.2, "frequency": 6.0, "damping_ratio": RATIO},
)


def radiating(folder: Path) -> boatsim.Vessel:
    """The body of the rig with both effects."""
    boat = body_vessel(folder)
    for effect in EFFECTS:
        boat = boat.with_effect(effect)
    return boat


def test_free_decay_agrees_with_the_matrix_exponential(tmp_path: Path) -> None:
    engine = OpenWater(radiating(tmp_path), 0.02)
    for place in ((0.04, 0.0), (0.0, 0.04)):
        begin = np.array([*place, *np.zeros(6)])
        engine.reset(State(z=place[0], phi=place[1]))
        for k in range(1, 100):
            engine.advance()
            exact = expm(0.02 * k * equations(REAL)[0]) @ begin
            assert engine.state.z == pytest.approx(exact[0], abs=1e-6)
            assert engine.state.phi == pytest.approx(exact[1], abs=1e-6)


def test_mujoco_and_compiled_engine_agree(tmp_path: Path) -> None:
    boat, states = radiating(tmp_path), []
    for kind in (OpenWater, Engine):
        engine = kind(boat, step=0.02)
        engine.reset(State(z=0.03, phi=0.1))
        engine.advance(100)
        states.append(np.array(engine.state[1:]))
    assert states[1] == pytest.approx(states[0], rel=1e-9, abs=1e-12)


def test_linear_model_has_the_response_of_the_frequency_domain(tmp_path: Path) -> None:
    model = boatsim.linearise(radiating(tmp_path))
    assert model.accuracy < 1e-4
    for w in (2.0, 5.0, 9.0):
        s = 1j * w
        damping = DAMPING[0] + transfer_function(w)
        expected = 1.0 / (STIFFNESS[0] + s * damping + s * s * INERTIA[0])
        found = np.linalg.solve(s * np.eye(len(model.a)) - model.a, model.e)[0, 0]
        assert found == pytest.approx(expected, rel=1e-3)


def test_it_is_a_candidate_in_heave_roll_and_pitch_where_there_is_water(tmp_path: Path) -> None:
    names = ("heave_radiation", "roll_radiation", "pitch_radiation")
    assert set(names) <= set(candidate_library(load_vessel("otter")).tested_names)
    rig = candidate_library(body_vessel(tmp_path))
    assert set(names[:2]) <= set(rig.tested_names) and "pitch" in rig.inapplicable[names[2]]
    dry = candidate_library(body_vessel(tmp_path), (), {"no_water": True})
    assert not set(names) & set(dry.tested_names)
    assert not set(names) & set(candidate_library(load_vessel("trial_boat")).tested_names)
