"""Sweeps of runs in open water: the table is that of the runs one by one, to the last bit."""

from pathlib import Path

import numpy as np
import pytest
from pyarrow import parquet

import boatsim
from boatsim.errors import BadPhysics
from boatsim.simulate.cases import read_scenario
from boatsim.simulate.evaluation import all_metrics
from boatsim.simulate.run import Simulation, run
from boatsim.simulate.run_options import RunOptions
from boatsim.simulate.scenario import Scenario, from_table
from boatsim.sweeps.execute import run_plan
from boatsim.sweeps.keys import find_target_values, parse_target, set_values
from boatsim.sweeps.plan import Plan, make_plan
from boatsim.sweeps.runs import RunTask, perform_run, with_fastest_engine
from boatsim.sweeps.sampled_keys import parse_sampled_key

RUNS = 6
HEAD = """
engine = "compiled"
duration = 5.0
sensors = { speed_sd = 0.02, position_sd = 0.1 }
"""
CHECKS = """
[[check]]
signal = "x_m"
norm = "l2"
below = 1e9
[[check]]
signal = "sensed_ax_mps2"
norm = "rms"
below = 1e9
"""
# name -> scenario, sampled quantity
CASES = {
    "compiled law in gusts and waves": (
        """
vessel = "otter"
measure = { use = "tracking", signal = "u_mps", reference = "reference_u_mps", goal = "goal_surge_mps" }
controller = { use = "l1_differential" }
goal = [{ surge_mps = 0.8 }]
[[effect]]
use = "gusty_wind"
speed = 5.0
front = 0.3
side = 0.6
[[effect]]
use = "strip_wave_loads"
significant_height = 0.1
modal_period = 2.5
components = 8.0
strips = 4.0
""",
        "gusty_wind.speed=uniform(2,6)",
    ),
    "goals as commands": (
        """
vessel = "otter"
controller = { use = "open_loop" }
goal = [{ n_port_radps = 80.0, n_starboard_radps = 60.0 }, { from = 2.0, n_port_radps = 20.0 }]
""",
        "body.mass*=uniform(0.8,1.2)",
    ),
    "law in Python": (
        """
vessel = "jet_ski"
load = ["low_speed"]
controller = { use = "l1_heading_discrete" }
goal = [{ psi_rad = 0.3 }]
""",
        "goal.psi_rad=uniform(0.1,0.5)",
    ),
}


def scenario_file(case: str, folder: Path) -> str:
    path = folder / "open_water.toml"
    path.write_text(HEAD + CASES[case][0] + CHECKS, encoding="utf-8")
    return str(path)


def plan(case: str, folder: Path) -> Plan:
    sampled = parse_sampled_key(CASES[case][1])
    return make_plan([scenario_file(case, folder)], [], [sampled], RUNS, 3)


def table(folder: Path) -> bytes:
    return (folder / "sweep.parquet").read_bytes()


def changed(case: str, folder: Path, value: float) -> Scenario:
    own, place = read_scenario(scenario_file(case, folder))
    target = parse_target(CASES[case][1].partition("=")[0])
    changed_table, slots = find_target_values(own, place, target)
    return from_table(set_values(changed_table, place, slots, target.operation, value), place)


@pytest.mark.parametrize("case", CASES)
def test_the_table_holds_the_metrics_of_each_run_alone(case: str, tmp_path: Path) -> None:
    run_plan(plan(case, tmp_path), tmp_path / "out", 1)
    found = parquet.read_table(tmp_path / "out" / "sweep.parquet").to_pydict()
    quantity = CASES[case][1].partition("=")[0]
    assert len(set(found[quantity])) == RUNS
    for i, value in enumerate(found[quantity]):
        alone = run(changed(case, tmp_path, value), found["seed"][i])
        asked = RunOptions(seed=found["seed"][i], finish=lambda: False)  # after each step
        stepped = Simulation(changed(case, tmp_path, value), asked).run()
        for done in (alone, stepped):
            for name, metric in all_metrics(done).items():
                assert found[name][i] == metric.value, (name, i)
    assert np.std(found["sensed_ax_mps2_rms"]) > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_neither_processes_nor_an_interruption_change_a_byte(case: str, tmp_path: Path) -> None:
    made, whole, cut = plan(case, tmp_path), tmp_path / "whole", tmp_path / "cut"
    run_plan(made, whole, 1)
    run_plan(made, tmp_path / "two", 2)
    assert table(tmp_path / "two") == table(whole)
    cut.mkdir()
    lines = (whole / "journal.jsonl").read_bytes().splitlines(keepends=True)
    # what a process leaves that is killed after other runs than the first ones
    (cut / "journal.jsonl").write_bytes(b"".join([lines[0], lines[5], lines[2], lines[3][:9]]))
    run_plan(made, cut, 2)
    assert table(cut) == table(whole)


def test_a_run_that_diverges_fails_alone_with_its_reason(tmp_path: Path) -> None:
    case = "goals as commands"
    address = scenario_file(case, tmp_path)
    # with 1e5 N s/m the time constant is half a millisecond, at steps of 20 ms
    vary = {"linear_damping.surge": [77.0, 1e5, 80.0], "start.u": [0.1]}
    done = boatsim.sweep(address, vary=vary, runs=2, out=tmp_path / "out", jobs=1)
    found = parquet.read_table(tmp_path / "out" / "sweep.parquet").to_pydict()
    assert done.complete
    for i, damping in enumerate(found["linear_damping.surge"]):
        failed = damping == 1e5
        assert (found["x_m_l2"][i] is None) == failed
        assert (found["failure"][i] is not None) == failed
        assert not failed or "the motion is no longer finite at t = " in found["failure"][i]
    own, place = read_scenario(address)
    extreme = {**own, "set": {"linear_damping": {"surge": 1e5}}, "start": {"u": 0.1}}
    with pytest.raises(BadPhysics) as alone:
        run(from_table(extreme, place), found["seed"][2])
    assert str(alone.value) == found["failure"][2]


def test_a_scenario_without_walls_runs_on_the_compiled_engine_by_itself() -> None:
    bare = {"vessel": "otter", "duration": 5.0}
    assert with_fastest_engine(bare) == {**bare, "engine": "compiled"}
    assert with_fastest_engine({**bare, "tank": None})["engine"] == "compiled"
    walls = {**bare, "tank": {"length": 40.0, "width": 20.0}}
    assert with_fastest_engine(walls) is walls
    stated = {**bare, "engine": "mujoco"}
    assert with_fastest_engine(stated) is stated


def test_its_metrics_are_those_of_mujoco_up_to_rounding() -> None:
    table, place = read_scenario("joystick_boat/sway_1")
    table = {**table, "tank": None}
    fast, slow = (
        perform_run(RunTask(one, place, None)) for one in (table, {**table, "engine": "mujoco"})
    )
    assert fast["norms"].keys() == slow["norms"].keys() and fast["norms"]
    for name, (value, unit) in slow["norms"].items():
        assert fast["norms"][name] == [pytest.approx(value, rel=1e-6, abs=1e-9), unit]
