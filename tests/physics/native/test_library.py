"""The C library of a program: the numbers of numba, kept on disk, numba where it cannot be had."""

import stat
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from boatsim.diagnosis.candidates import diagnosis_program
from boatsim.diagnosis.filter import map_recording, prior_noise_levels
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.problem import Problem
from boatsim.physics.content import shipped_content_names
from boatsim.physics.debugging import DEBUG
from boatsim.physics.native import library
from boatsim.physics.native.library import NativeProgram, program_source
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Recording

pytestmark = pytest.mark.skipif(DEBUG, reason="nothing is compiled")


@pytest.fixture(autouse=True)
def _with_a_compiler() -> None:
    try:
        library.compiler()
    except library.NoCompiler as reason:
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
    assert "kalman_filter" in program_source(Program(load_vessel(name)).module)


MEASURED_WAVE = """
about = "a box in a measured wave"
source = "none"
freedoms = ["sway", "heave", "roll"]
length = 0.6
beam = 0.4
draught = 0.2
body = { mass = 48.0, roll_inertia = 1.0, yaw_inertia = 1.4 }

[measured]
wave_m = {}

[[effect]]
use = "wave_excitation"
on = { elevation = "wave_m" }
roll_elevation = -30.0
roll_rate = -10.0
sway_rate = -200.0

[[effect]]
use = "wave_drift"
on = { elevation = "wave_m" }
sway = -1400.0
"""
HULL = """<mujoco model="box"><worldbody><body name="hull">
<geom type="box" size="0.3 0.2 0.13"/></body></worldbody></mujoco>"""


def test_filters_of_a_measured_wave_give_the_numbers_of_numba_to_the_last_bit(
    tmp_path: Path,
) -> None:
    (tmp_path / "hull.xml").write_text(HULL)
    (tmp_path / "vessel.toml").write_text(MEASURED_WAVE)
    program = Program(load_vessel(str(tmp_path)))
    assert isinstance(program.functions, NativeProgram)
    vessel = program.vessel
    wave = vessel.inputs.index("wave_m")
    found: list[Any] = []
    for code in (program.functions, program.module):
        values, on = program.values(), program.effect_switches()
        memory, act = np.zeros(program.memory_size), np.zeros(program.held_size)
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


@pytest.mark.slow
@pytest.mark.parametrize("name", ["trial_boat", "otter"])
def test_filter_and_free_runs_give_the_numbers_of_numba_to_the_last_bit(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    found: list[Any] = []
    vessel = load_vessel(name)
    for switch in ("1", "0"):
        monkeypatch.setenv("BOATSIM_NATIVE", switch)
        program, _ = diagnosis_program(vessel)
        assert isinstance(program.functions, NativeProgram) == (switch == "1")
        levels = prior_noise_levels(vessel, [cruise(vessel)])
        mapped = map_recording(cruise(vessel), program)
        problem = Problem([mapped], levels, {})
        fit = fit_noise(problem, problem.nominal_hypothesis())
        everything = program.effect_switches(program.candidate_names)
        values = problem.values(mapped, fit.free, fit.theta)
        smoothed = mapped.smooth(values, everything, fit.levels)
        runs = mapped.free_runs(values, everything, fit.levels, 4.0)
        found.append([fit.levels.force, smoothed.means, smoothed.covariances, *dict(runs).values()])
    for native, compiled in zip(*found, strict=True):
        assert np.array_equal(native, compiled, equal_nan=True)


def test_a_library_is_built_once_and_again_if_it_is_damaged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BOATSIM_CACHE", str(tmp_path))
    module = Program(load_vessel("kvlcc2_roll")).module
    monkeypatch.setattr(module, "__file__", str(tmp_path / "__init__.py"))
    library.load_library(module)
    (built,) = tmp_path.glob("native_*.so")
    first = built.read_bytes()
    monkeypatch.setattr(library, "program_source", _fails)
    library.load_library(module)  # from the disk
    built.write_bytes(b"damaged")
    with pytest.raises(AssertionError, match="built again"):
        library.load_library(module)
    monkeypatch.undo()
    monkeypatch.setattr(module, "__file__", str(tmp_path / "__init__.py"))
    library.load_library(module)
    assert built.read_bytes()[:4] == first[:4] == b"\x7fELF"


def _fails(module: Any) -> str:
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
    assert program.functions is program.module
