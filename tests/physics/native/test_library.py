"""The C library of a program: the numbers of numba, kept on disk, numba where it cannot be had."""

import stat
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long

from boatsim.diagnosis.candidates import diagnosis_program
from boatsim.diagnosis.locate.nominal_forces import actuator_states, body_forces
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics.content import shipped_content_names
from boatsim.physics.debugging import DEBUG
from boatsim.physics.effects.command_delay import CommandDelay
from boatsim.physics.native import build
from boatsim.physics.native.calls import BoundCall, partial_call
from boatsim.physics.native.library import NativeProgram, translate_program
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Recording
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from tests.boats import box_in_measured_wave

pytestmark = pytest.mark.skipif(DEBUG, reason="nothing is compiled")


@pytest.fixture(autouse=True)
def _with_a_compiler() -> None:
    try:
        build.compiler_path()
    except build.NoCompiler as reason:
        pytest.skip(str(reason))


def cruise(vessel: Vessel) -> Recording:
    """A turn with all commands a tenth ahead, as far as the vessel has these freedoms."""
    t = 0.2 * np.arange(60)
    signals = {
        "x_m": np.sin(0.1 * t),
        "y_m": 1.0 - np.cos(0.1 * t),
        "psi_rad": 0.1 * t + 0.01 * np.sin(3.0 * t),
    }
    for name, channel in vessel.commands.items():
        signals[name] = np.where(t > 5.0, 0.1, 0.05) * channel.high
    return Recording("cruise", t, signals)


@pytest.mark.parametrize("name", shipped_content_names("vessel"))
def test_every_vessel_has_a_c_form(name: str) -> None:
    module = Program(load_vessel(name)).module
    assert "kalman_filter" in translate_program(module, "estimation")
    assert "passive_callback" in translate_program(module, "simulation")


def test_a_program_with_candidates_has_a_c_form_without_the_callback_of_mujoco() -> None:
    program = Program(load_vessel("joystick_boat"), candidates=(CommandDelay(),))
    source = translate_program(program.module, "simulation")
    assert "rollout" in source and "passive" not in source
    assert isinstance(program.simulation_functions, NativeProgram)


def batch_states(vessel: Vessel) -> np.ndarray:
    """States and instrument readings of three vessels under changing commands."""
    batch = Batch(vessel, 3)
    high = np.array([channel.high for channel in vessel.commands.values()])
    rest = np.zeros(len(vessel.inputs) - len(high))
    felt, rows = np.zeros((3, 11)), []
    for i in range(40):
        share = np.array([[0.1], [0.5], [0.9]]) * np.cos(0.3 * i)
        batch.advance(np.hstack([share * high, np.tile(rest, (3, 1))]), steps=3)
        batch.sense(felt)
        rows.append(np.hstack([batch.states, felt]))
    return np.array(rows)


def engine_states(vessel: Vessel) -> np.ndarray:
    """States of a vessel on MuJoCo and in open water, and the forces on it."""
    rows = []
    for engine in (Engine(vessel), OpenWater(vessel)):
        for i in range(40):
            engine.command({n: 0.5 * c.high * np.cos(0.3 * i) for n, c in vessel.commands.items()})
            engine.advance(3)
            rows.append([*engine.state, *engine.wrench(), *engine.acceleration()])
    return np.array(rows)


@pytest.mark.parametrize("name", ["joystick_boat", long("otter"), long("jet_ski")])
@pytest.mark.slow
def test_simulations_give_the_numbers_of_numba_to_the_last_bit(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    vessel = load_vessel(name)
    found = []
    for switch in ("1", "0"):
        monkeypatch.setenv("BOATSIM_NATIVE", switch)
        assert isinstance(Program(vessel).simulation_functions, NativeProgram) == (switch == "1")
        found.append((batch_states(vessel), engine_states(vessel)))
    for native, compiled in zip(*found, strict=True):
        assert np.array_equal(native, compiled) and np.ptp(native) > 0.1


@pytest.mark.slow
def test_a_prepared_call_has_the_numbers_that_it_is_given() -> None:
    program = Program(load_vessel("joystick_boat"))
    k, values, on = np.zeros(program.module.K), program.values(), program.effect_switches()
    commands, memory = program.command_array({"pwm_port": 100.0}), np.zeros(program.memory_size)
    act = np.zeros(program.actuator_signal_size)
    program.simulation_functions.compute_mass_constants(program.body, values, on, k)
    found = []
    for code in (program.simulation_functions, program.module):
        memory[:] = act[:] = 0.0
        advance = partial_call(code, "advance_actuators", commands, memory, ..., values, on, act)
        y = np.zeros(2 * program.module.NQ)
        step = partial_call(
            code, "step_in_place", ..., y, ..., act, values, on, k, np.zeros(program.module.NQ)
        )
        for dt in (0.02, 0.05):
            advance(dt)
            step(0.0, dt)
        found.append(np.concatenate([y, act, memory]))
    assert np.array_equal(*found) and np.abs(found[0]).max() > 0.0
    with pytest.raises(ValueError, match="argument"):
        step(0.0)


def test_a_prepared_call_returns_several_numbers_of_its_present_arguments() -> None:
    program = Program(load_vessel("joystick_boat"))
    y, act = np.zeros(2 * program.module.NQ), np.zeros(program.actuator_signal_size)
    given = 0.0, y, act, np.int64(0), program.values(), program.effect_switches()
    force = partial_call(program.simulation_functions, "total_body_force", *given)
    for speed in (0.5, 1.0):
        y[program.module.NQ] = speed
        assert force() == program.simulation_functions.total_body_force(*given)
    assert force()[0] < 0.0  # resistance


def test_a_repeated_call_uses_the_arguments_that_were_replaced_last() -> None:
    program = Program(load_vessel("joystick_boat"))
    states = np.zeros((2, 2 * program.module.NQ))
    states[:, program.module.NQ] = 0.5, 1.0
    held = np.zeros((2, program.actuator_signal_size // 3))
    found = []
    for code in (program.estimation_functions, program.module):
        first, second = np.zeros((2, program.module.NQ)), np.zeros((2, program.module.NQ))
        rest = held, program.values(), program.effect_switches()
        call = BoundCall(code, "total_body_forces", np.zeros_like(states), *rest, first)
        call()
        assert not first.any()
        call.replace(0, call.pack(0, states))
        call.replace(4, call.pack(4, second))
        call()
        assert not first.any() and (np.diff(second[:, 0]) < 0.0).all()  # more resistance
        found.append(second)
    assert np.array_equal(*found)


def test_forces_and_actuators_along_a_recording_are_those_of_single_calls() -> None:
    vessel = load_vessel("joystick_boat")
    program = Program(vessel)
    code, nq = program.estimation_functions, program.module.NQ
    values, on = program.values(), program.effect_switches()
    mapped = map_recording(cruise(vessel), program)
    held = actuator_states(mapped)
    memory, act = np.zeros(program.memory_size), np.zeros(program.actuator_signal_size)
    code.settle_actuators(mapped.commands[0], memory, values, on, act)
    states = np.random.default_rng(0).normal(0.0, 0.3, (len(held), 2 * nq))
    forces = body_forces(mapped, states, held, values)
    for row, step in enumerate(np.diff(mapped.times)):
        code.advance_actuators(mapped.commands[row], memory, step, values, on, act)
        begin, middle, end = act.reshape(3, -1)
        assert np.array_equal(held[row], (begin + 4.0 * middle + end) / 6.0)
        single = code.total_body_force(0.0, states[row], held[row], np.int64(0), values, on)
        assert tuple(forces[row]) == single
    assert np.ptp(held[:, 0]) > 0.0


def test_states_without_their_rows_of_actuators_are_refused() -> None:
    vessel = load_vessel("joystick_boat")
    program = Program(vessel)
    mapped = map_recording(cruise(vessel), program)
    states = np.zeros((len(mapped.times), 2 * program.module.NQ))
    with pytest.raises(ValueError, match="60 states and 59 rows of actuator states"):
        body_forces(mapped, states, actuator_states(mapped)[1:], program.values())


def test_an_array_of_another_type_is_refused() -> None:
    code = Program(load_vessel("joystick_boat")).simulation_functions
    with pytest.raises(TypeError, match="float32 with 1 dimensions; allowed is a contiguous"):
        code.water_displacement(0.0, np.zeros(3, dtype=np.float32), np.zeros(3))


@pytest.mark.slow
def test_filters_of_a_measured_wave_give_the_numbers_of_numba_to_the_last_bit(
    tmp_path: Path,
) -> None:
    program = Program(box_in_measured_wave(tmp_path))
    assert isinstance(program.estimation_functions, NativeProgram)
    vessel = program.vessel
    wave = vessel.inputs.index("wave_m")
    found: list[Any] = []
    for code in (program.estimation_functions, program.module):
        values, on = program.values(), program.effect_switches()
        memory, act = np.zeros(program.memory_size), np.zeros(program.actuator_signal_size)
        command = np.zeros(len(vessel.inputs))
        code.settle_actuators(command, memory, values, on, act)
        rows = []
        for i, dt in enumerate([0.05] * 40 + [0.013, 0.4, 900.0, 0.05]):
            command[wave] = 0.02 * np.sin(0.3 * i)
            code.advance_actuators(command, memory, dt, values, on, act)
            rows.append(np.concatenate([act, memory]))
        found.append(np.array(rows))
    assert np.array_equal(*found)
    first = list(program.composition.law_signals).index("filtered_elevation by wave_excitation")
    assert np.ptp(found[0][:, first]) > 0.01


# The otter has six freedoms: numba needs half a minute.
@pytest.mark.parametrize("name", ["joystick_boat", long("otter")])
@pytest.mark.slow
def test_filter_and_free_runs_give_the_numbers_of_numba_to_the_last_bit(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    found: list[Any] = []
    vessel = load_vessel(name)
    for switch in ("1", "0"):
        monkeypatch.setenv("BOATSIM_NATIVE", switch)
        program, _ = diagnosis_program(vessel)
        assert isinstance(program.estimation_functions, NativeProgram) == (switch == "1")
        levels = prior_noise_levels(vessel, [cruise(vessel)])
        mapped = map_recording(cruise(vessel), program)
        problem = Problem([mapped], levels, {})
        fit = fit_noise(problem, problem.nominal_hypothesis())
        everything = program.effect_switches(program.candidate_names)
        values = problem.parameter_vector(mapped, fit.free, fit.theta)
        smoothed = mapped.smooth(values, everything, fit.levels)
        runs = mapped.free_runs(values, everything, fit.levels, 4.0)
        found.append([fit.levels.force, smoothed.means, smoothed.covariances, *dict(runs).values()])
    for native, compiled in zip(*found, strict=True):
        assert np.array_equal(native, compiled, equal_nan=True)


def test_a_library_is_built_once_and_again_if_it_is_damaged(tmp_path: Path) -> None:
    def made() -> str:
        return translate_program(module, "simulation")

    module = Program(load_vessel("kvlcc2_roll")).module
    build.load_library(tmp_path, "simulation", made)
    (built,) = tmp_path.glob("simulation_*.so")
    first = built.read_bytes()
    build.load_library(tmp_path, "simulation", _fails)  # from the disk
    built.unlink()  # this process has loaded the first one
    built.write_bytes(b"damaged")
    with pytest.raises(AssertionError, match="built again"):
        build.load_library(tmp_path, "simulation", _fails)
    build.load_library(tmp_path, "simulation", made)
    assert built.read_bytes()[:4] == first[:4] == b"\x7fELF"


def _fails() -> str:
    raise AssertionError("built again")


@pytest.mark.parametrize("case", ["switched off", "missing", "fails"])
def test_without_a_compiler_the_program_is_that_of_numba(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    refusing = tmp_path / "cc"
    refusing.write_text("#!/bin/sh\necho no >&2\nexit 1\n")
    refusing.chmod(refusing.stat().st_mode | stat.S_IXUSR)
    if case == "switched off":
        monkeypatch.setenv("BOATSIM_NATIVE", "0")
    else:
        monkeypatch.setenv("CC", str(refusing if case == "fails" else tmp_path / "none"))
    program = Program(load_vessel("kvlcc2_roll"))
    build._warn_once.cache_clear()
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        assert program.estimation_functions is program.simulation_functions is program.module
        assert Program(load_vessel("kvlcc2_roll")).simulation_functions is program.module
    own = [one for one in seen if one.category is build.SlowCompilationWarning]
    assert len(own) == (case != "switched off")  # once in a process
    for warning in own:
        reason = f"{refusing}: no;" if case == "fails" else "neither the variable CC nor cc names"
        assert reason in str(warning.message)


def test_a_library_that_fails_later_is_reported_too(monkeypatch: pytest.MonkeyPatch) -> None:
    program = NativeProgram(Program(load_vessel("kvlcc2_roll")).module, "estimation")
    build._warn_once.cache_clear()
    monkeypatch.setenv("CC", "no such compiler")
    with pytest.warns(build.SlowCompilationWarning, match="no C compiler"):
        assert program.step_in_place is program.module.step_in_place
