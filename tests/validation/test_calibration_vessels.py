"""Further vessels of the calibration campaign: their laws agree with boatsim, their trials open."""

import ast
import json
from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.loading import open_recording
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.simulate.batch import Batch
from validation.calibration import unknown_causes, vessels
from validation.practice.make import Trial, simulate_trial, write_trial
from validation.practice.motion import generalised_force, motion_relative_to_water

NEW = ("blueboat", "mariner")
STATES = 40
PLANE = [0, 1, 5]  # surge, sway and yaw


def random_case(name: str) -> tuple[Array, Array]:
    """Random states (STATES, 6) as x y psi u v r, and commands (STATES, C)."""
    rng = np.random.default_rng(7)
    boat = vessels.BOATS[name]()
    speed = boat.cruise or 1.5
    states = np.zeros((STATES, 6))
    states[:, 2] = rng.uniform(-np.pi, np.pi, STATES)
    states[:, 3] = rng.uniform(-0.3, 1.2, STATES) * speed
    states[:, 4] = rng.uniform(-0.4, 0.4, STATES) * speed
    states[:, 5] = rng.uniform(-0.8, 0.8, STATES) * speed / boat.length
    low, high = np.array(list(boat.channels.values())).T
    return states, rng.uniform(low, high, (STATES, len(low)))


def law_accelerations(name: str, states: Array, commands: Array) -> Array:
    """Accelerations (STATES, 3) by the independent law and its mass matrix."""
    boat = vessels.BOATS[name]()
    q, nu = np.zeros((6, STATES)), np.zeros((6, STATES))
    q[PLANE] = states[:, :3].T
    nu[PLANE] = states[:, 3:].T
    act = boat.drive.goals(commands.T)
    runs = np.zeros(STATES, dtype=np.int64)
    motion, _, carried = motion_relative_to_water(
        boat, np.zeros(STATES), runs, q, nu, act, lambda t, q, run: None
    )
    force = generalised_force(boat, motion, carried, lambda m: np.zeros_like(m.nu))
    return np.asarray((boat.inverse() @ force)[PLANE].T)


def tool_accelerations(name: str, states: Array, commands: Array) -> Array:
    """Accelerations (STATES, 3) of boatsim: difference quotients extrapolated to no step."""
    step = 1e-5 * vessels.BOATS[name]().scale  # [s]
    batch = Batch(vessel.load_vessel(name), STATES, step=step)
    batch.reset(states, commands)
    batch.advance()
    one = batch.states[:, 3:].copy()
    batch.advance()
    two = batch.states[:, 3:].copy()
    return np.asarray(2.0 * (one - states[:, 3:]) - 0.5 * (two - states[:, 3:])) / step


@pytest.mark.parametrize("name", NEW)
def test_law_and_mass_matrix_give_the_accelerations_of_the_compiled_program(name: str) -> None:
    states, commands = random_case(name)
    ours = law_accelerations(name, states, commands)
    theirs = tool_accelerations(name, states, commands)
    size = np.abs(theirs).max(axis=0)
    assert np.abs(ours - theirs).max(axis=0) / size == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("concealed", [False, True])
@pytest.mark.parametrize("name", NEW)
def test_boatsim_reads_a_simulated_trial(tmp_path: Path, name: str, concealed: bool) -> None:
    boat, plan = vessels.BOATS[name], vessels.PLANS[name]
    makers = (unknown_causes.flooded_tank,)
    trial = Trial("T001_" + name, name, "unknown", concealed, False, makers, plan, boat)
    oracle = simulate_trial(trial, (4, 1), np.array([0.3]))
    write_trial(tmp_path / trial.name, boat(), oracle.voyage, {"kind": "unknown"}, trial)
    recording, found = open_recording(tmp_path / trial.name / "run_3.csv", None, ())
    assert found.name == name
    assert len(recording) >= 240
    assert not recording.remarks
    assert json.loads((tmp_path / trial.name / "answer.json").read_text()) == {"kind": "unknown"}
    assert np.isfinite(oracle.beyond_library(oracle.causes[0]))


def test_vessels_and_causes_do_not_import_boatsim() -> None:
    for module in (vessels, unknown_causes):
        for node in ast.walk(ast.parse(Path(module.__file__).read_text())):
            if isinstance(node, ast.Import):
                assert not any(alias.name.startswith("boatsim") for alias in node.names)
            if isinstance(node, ast.ImportFrom):
                assert not (node.module or "").startswith("boatsim")
