"""Instances of an effect that act on each other: all engines add the influences alike."""

from typing import Any

import numpy as np
import pytest

from boatsim.physics.base import AXES, Force, Motion, Wrench, make_motion
from boatsim.physics.compose import Composition
from boatsim.physics.effects.thruster import Thruster
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater

STEP = 0.1  # [s]
PLANAR = [AXES.index(axis) for axis in ("surge", "sway", "yaw")]
ADDED = (
    {"use": "thruster_interaction", "size": 1.0},
    {"use": "shared_supply", "loss": 0.3},
    {"use": "thruster_hull_interaction", "loss": 0.2},
)
# the race of the port drive strikes the starboard one, which pushes astern
COMMANDS = {
    "bow_1_N": 2e5,
    "bow_2_N": -1e5,
    "port_N": 5e5,
    "port_angle_rad": -1.4,
    "starboard_N": 3e5,
    "starboard_angle_rad": 2.8,
}


def interacting(*added: dict[str, Any]) -> Vessel:
    """The supply vessel with effects added."""
    vessel = load_vessel("osv")
    for table in added:
        vessel = vessel.with_effect(table)
    return vessel


def total_force(vessel: Vessel) -> np.ndarray:
    """Force and moment on the vessel at rest, with all drives at their commands."""
    program = Program(vessel)
    functions = program.estimation_functions
    act, still = np.zeros(program.actuator_signal_size), np.zeros(2 * program.module.NQ)
    sent, memory = program.command_array(COMMANDS), np.zeros(program.memory_size)
    functions.settle_actuators(sent, memory, program.values(), program.effect_switches(), act)
    values = np.concatenate([program.values(), program.body])
    on = program.effect_switches()
    return np.array(functions.total_body_force(0.0, still, act, np.int64(0), values, on))


def change_by_hand(effect: Force, vessel: Vessel, motion: Motion) -> np.ndarray:
    """The sum of the law over all drives, evaluated one at a time."""
    drives = []
    for drive in vessel.effects_of_type("thruster"):
        bound = vessel.bindings(drive)
        given = {role: COMMANDS.get(str(to), to) for role, to in bound.items()}
        drives.append((Thruster.signals(**given), drive.values()))  # type: ignore[arg-type]
    total = np.zeros(len(Wrench()))
    for k, drive_values in enumerate(drives):
        others: list[Any] = []
        if type(effect).influence is not None:
            for other in drives[:k] + drives[k + 1 :]:
                others += other
        total += effect.wrench(motion, *drive_values, *others)
    return total


@pytest.mark.parametrize("table", ADDED, ids=lambda table: table["use"])
@pytest.mark.slow
def test_the_program_adds_the_law_of_each_drive_with_the_influences_of_all_others(
    table: dict[str, Any],
) -> None:
    with_effect, without = interacting(table), interacting()
    effect = with_effect.effect(table["use"])
    assert isinstance(effect, Force)
    wanted = change_by_hand(effect, with_effect, make_motion())[PLANAR]
    found = total_force(with_effect) - total_force(without)
    assert np.abs(wanted).max() > 1e4
    assert found == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())


@pytest.mark.slow
def test_mujoco_compiled_engine_and_batch_agree() -> None:
    vessel = interacting(*ADDED)
    batch = Batch([vessel], step=STEP)
    batch.reset()
    batch.advance(COMMANDS, 300)
    together = batch.states[0][[0, 1, 2]]
    for engine in (OpenWater, Engine):
        one = engine(vessel, step=STEP)
        one.reset()
        one.command(COMMANDS)
        one.advance(300)
        alone = [one.state.x, one.state.y, one.state.psi]
        assert together == pytest.approx(alone, abs=1e-9)


def test_programs_of_vessels_without_influences_have_no_trace_of_them() -> None:
    text = Program(load_vessel("osv")).composition.source_text()
    assert "influence" not in text


def test_a_single_drive_is_influenced_by_nobody() -> None:
    vessel = load_vessel("catamaran").with_effect({"use": "shared_supply", "loss": 0.1})
    composition: Composition = Program(vessel).composition
    number = [e.name for e in composition.effects].index("shared_supply")
    (call,) = composition.law_calls(number)
    assert call.signals[-1] == "0.0"
