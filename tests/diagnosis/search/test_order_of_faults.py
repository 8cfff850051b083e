"""A dead band of the command is not one of the shaft: where a lag lies between them, both are
tried, and told apart."""

from pathlib import Path

import numpy as np
import pytest
from alike import slow
from numpy.typing import NDArray

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.candidates import candidate_library, name_without_prefixes
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.effects.thrust_deadband import ThrustDeadband
from boatsim.physics.effects.thrust_imbalance import ThrustImbalance
from boatsim.physics.kernel.records import VesselNumbers
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings import table
from boatsim.recordings.table import Recording

LAG, WIDTH, STEP = 0.8, 0.12, 0.1  # [s] of the boat's own thrust; [N] of the fault; [s] of a row
STEPS_A_ROW = 10
LEVELS = (-0.6, -0.45, -0.3, -0.15, 0.0, 0.15, 0.3, 0.45, 0.6)  # [N] of the thrust commands
DRIVES = ("thrust_port_N", "thrust_starboard_N")


def lagging(folder: Path) -> Vessel:
    """The trial boat with a propeller that takes its time."""
    place = folder / "slow"
    place.mkdir(exist_ok=True)
    whole = vessel.load_vessel("trial_boat").file
    lag = f'\n[[effect]]\nuse = "thrust_lag"\ntime_constant = {LAG}\n'
    head, tables = whole.read_text().split("\n[[effect]]", 1)
    (place / "vessel.toml").write_text(f"{head}{lag}\n[[effect]]{tables}")
    (place / "hull.xml").write_text((whole.parent / "hull.xml").read_text())
    return vessel.load_vessel(str(place))


def sent(rows: int, seed: int) -> dict[str, NDArray[np.float64]]:
    """Small thrusts ahead and astern in steps of a second, each side for itself; the thrusters
    turned now and then. Of two sizes alone, a power of the command would explain the loss, too."""
    rng, each = np.random.default_rng(seed), round(1.0 / STEP)
    thrust = {n: np.repeat(rng.choice(LEVELS, rows // each + 1), each)[:rows] for n in DRIVES}
    turned = np.repeat(rng.uniform(-0.4, 0.4, rows // (3 * each) + 1), 3 * each)[:rows]
    return thrust | {"steer_port_rad": turned, "steer_starboard_rad": turned}


def sailed(boat: Vessel, fault: ThrustDeadband, seed: int) -> Recording:
    """A noisy recording of 40 s of the boat with a fault."""
    program, rows = Program(boat, candidates=(fault,)), 400
    code, given, rng = (
        program.simulation_functions,
        sent(rows, seed),
        np.random.default_rng(100 + seed),
    )
    commands = np.column_stack([given[c] for c in boat.commands])
    values, on, memory = (
        program.values(),
        program.effect_switches([fault.name]),
        np.zeros(program.memory_size),
    )
    path = np.zeros((rows + 1, 2 * code.NQ))
    code.settle_actuators(commands[0], memory, values, on, np.zeros(program.actuator_signal_size))
    code.rollout(
        VesselNumbers(np.array(program.body), values, on),
        program.vessel_state(np.zeros(2 * code.NQ), memory),
        commands,
        0.0,
        STEP / STEPS_A_ROW,
        STEPS_A_ROW,
        path,
    )
    noise = rng.standard_normal((rows, 3)) * (0.003, 0.003, 0.005)
    pose = dict(zip(("x_m", "y_m", "psi_rad"), (path[:rows, :3] + noise).T, strict=True))
    return Recording(f"run_{seed}", STEP * np.arange(rows), pose | given)


def test_each_order_is_the_composition_that_it_says(tmp_path: Path) -> None:
    """A step of 0.3 N: dead band then lag ends 0.12 N short of it, rising at once; lag then dead
    band rises later."""
    boat = lagging(tmp_path)
    usual, other = (
        ThrustDeadband(width=WIDTH),
        ThrustDeadband(width=WIDTH, name="behind", other_side=True),
    )
    program = Program(boat, candidates=(usual, other))
    ends = {}
    for name in ("thrust_deadband", "behind"):
        memory, act, on = (
            np.zeros(program.memory_size),
            np.zeros(program.actuator_signal_size),
            program.effect_switches([name]),
        )
        program.simulation_functions.settle_actuators(
            np.zeros(len(boat.commands)), memory, program.values(), on, act
        )
        command = np.array([0.3 if c in DRIVES else 0.0 for c in boat.commands])
        shown = []
        for _ in range(6):
            program.simulation_functions.advance_actuators(
                command, memory, STEP, program.values(), on, act
            )
            shown.append(act.reshape(3, -1)[2, program.composition.law_signals.index(DRIVES[0])])
        ends[name] = np.array(shown)
    built_up = 1.0 - np.exp(-STEP * np.arange(1, 7) / LAG)
    assert ends["thrust_deadband"] == pytest.approx((0.3 - WIDTH) * built_up)
    assert ends["behind"] == pytest.approx(np.maximum(0.3 * built_up - WIDTH, 0.0))


def test_both_orders_are_tried_where_a_lag_lies_between_them_and_nowhere_else(
    tmp_path: Path,
) -> None:
    twice = [
        n for n in candidate_library(lagging(tmp_path)).tested_names if n.startswith("reordered_")
    ]
    assert sorted(map(name_without_prefixes, twice)) == ["thrust_deadband", "weak_reverse"]
    assert not [
        n
        for n in candidate_library(vessel.load_vessel("trial_boat")).tested_names
        if n.startswith("reordered_")
    ]


def test_what_has_its_place_can_not_be_put_elsewhere() -> None:
    with pytest.raises(
        BadInput,
        match=r"^thrust_imbalance: other_side = True; allowed is false: its side is fixed$",
    ):
        ThrustImbalance(other_side=True)


@pytest.mark.slow
@pytest.mark.parametrize("behind", [slow(False), True], ids=["of the command", "of the shaft"])
def test_a_diagnosis_tells_a_dead_band_of_the_shaft_from_one_of_the_command(
    tmp_path: Path, behind: bool
) -> None:
    boat = lagging(tmp_path)
    fault = (
        ThrustDeadband(width=WIDTH, name="behind", other_side=True)
        if behind
        else ThrustDeadband(width=WIDTH)
    )
    files = []
    for seed in (1, 2, 3):
        files.append(tmp_path / f"{seed}.csv")
        table.write_csv(sailed(boat, fault, seed), files[-1])
    found = pipeline.diagnose(files[:2], files[2:], str(boat.path))
    answer = found.findings.answer
    (effect,) = answer["effects"]
    assert answer["verdict"] == "named" and effect["name"] == "thrust_deadband", answer["sentence"]
    assert effect["words"].endswith("in the actuator and not in its command") == behind
    width = effect["parameters"]["width_N"]
    assert abs(width["value"] - WIDTH) < 3.0 * width["sd"] < 0.5 * WIDTH
    assert found.ranking.best.effects == (
        "reordered_thrust_deadband" if behind else "thrust_deadband",
    )
