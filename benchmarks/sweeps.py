"""Measure the cost of a run of a sweep in open water: `python -m benchmarks.sweeps [--runs 300]`.

It takes about a minute and prints CPU and wall time of a run of one minute at steps of 20 ms, with all
that a sweep does (loading, simulation, log, camera, metrics, journal). They are differences between a
long and a short sweep, so that the start of the processes, which is printed separately, does not count.
`physics` is the CPU time of the compiled integration of the motion alone, `by steps` that of the same
run with a call from Python for each step, `start` that of the processes, `10,000 runs` the time on two
cores that nothing else uses.
"""

import argparse
import os
import resource
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from typing import Any

import numpy as np

import boatsim
from boatsim.simulate.evaluation import all_metrics
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run import Simulation, build_engine
from boatsim.simulate.run_options import RunOptions
from boatsim.simulate.scenario import Scenario, load

MINUTE = 60.0  # [s]
SHORT = 20  # runs of the short sweep
ALONE = 5  # runs that are measured in this process
MANY, CORES = 10_000, 2  # runs, and the cores on which the last column counts
NAME = 38  # width of the first column
HEADINGS = ("CPU", "wall", "physics", "by steps", "start", "10,000 runs")

OPEN: Mapping[str, Any] = {"engine": ["compiled"], "duration": [MINUTE]}
SEA = """
vessel = "otter"
engine = "compiled"
duration = 60.0
measure = { use = "tracking", signal = "u_mps", reference = "reference_u_mps", goal = "goal_surge_mps" }
sensors = { speed_sd = 0.02, position_sd = 0.1 }
controller = { use = "l1_differential" }
goal = [{ surge_mps = 0.8, yaw_radps = 0.05 }]

[[effect]]
use = "gusty_wind"
speed = 5.0
toward = 1.0
front = 0.3
side = 0.6

[[effect]]
use = "irregular_sea"
significant_height = 0.2
modal_period = 3.0
toward = 1.5708
components = 20.0
"""


@dataclass(frozen=True)
class Case:
    """A sweep: its name, scenario, fixed changes and sampled quantity."""

    name: str
    scenario: str
    vary: Mapping[str, Any]
    draw: Mapping[str, str]


def cases(folder: Path) -> list[Case]:
    """Return the sweeps that are measured."""
    sea = folder / "sea.toml"
    sea.write_text(SEA, encoding="utf-8")
    bare = {**OPEN, "tank": ["none"], "until": ["none"]}
    return [
        Case(
            "L1 joystick, speed sensor, camera",
            "joystick_boat/sway_1",
            bare,
            {"weak_reverse.astern_factor": "normal(0.7,0.05)"},
        ),
        Case("open loop, six dof", "otter/turn", OPEN, {"body.mass*": "uniform(0.9,1.1)"}),
        Case(
            "L1, gusts, waves, sensors, six dof", str(sea), {}, {"gusty_wind.speed": "uniform(3,6)"}
        ),
    ]


def cpu_time() -> float:
    """CPU time of this process and of its children that have ended [s]."""
    total = 0.0
    for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN):
        used = resource.getrusage(who)
        total += used.ru_utime + used.ru_stime
    return total


def sweep_times(case: Case, runs: int, folder: Path) -> tuple[float, float]:
    """CPU and wall time of a sweep [s]."""
    cpu, wall = cpu_time(), perf_counter()
    boatsim.sweep(case.scenario, vary=case.vary, draw=case.draw, runs=runs, out=folder)
    return cpu_time() - cpu, perf_counter() - wall


def loaded(case: Case) -> Scenario:
    """The scenario of a case with its fixed changes."""
    changes = {key: values[0] for key, values in case.vary.items()}
    for key in ("tank", "until"):
        if key in changes:
            changes[key] = {} if key == "until" else None
    return load(case.scenario, changes)


def time_of_steps(case: Case) -> float:
    """CPU time of a run with a call from Python for each step [s], median of several."""
    found = []
    for seed in range(ALONE):
        begin = process_time()
        options = RunOptions(seed=seed, finish=lambda: False)  # asked after every step
        all_metrics(Simulation(loaded(case), options).run())
        found.append(process_time() - begin)
    return median(found)


def time_of_physics(case: Case) -> float:
    """CPU time of the compiled integration of a run, with the commands of its start [s]."""
    engine = build_engine(loaded(case), 0)
    assert isinstance(engine, OpenWater)
    begin = process_time()
    engine.batch.advance(steps=round(MINUTE / engine.step))
    return process_time() - begin


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.sweeps", description="Cost of a run of a sweep in open water."
    )
    parser.add_argument("--runs", type=int, default=300, help="runs of the long sweep")
    runs = SHORT + parser.parse_args().runs
    jobs = len(os.sched_getaffinity(0))
    print(f"a run of {MINUTE:g} s, {jobs} processes; times in ms, start and total in s")
    print(" " * NAME + "".join(f"{heading:>13s}" for heading in HEADINGS), flush=True)
    with TemporaryDirectory() as base:
        folder = Path(base)
        for number, case in enumerate(cases(folder)):
            sweep_times(case, jobs, folder / f"{number}_first")  # compiles the vessel
            short = sweep_times(case, SHORT, folder / f"{number}_short")
            long = sweep_times(case, runs, folder / f"{number}_long")
            cpu, wall = (np.subtract(long, short) / (runs - SHORT)).tolist()
            alone = 1e3 * time_of_physics(case), 1e3 * time_of_steps(case)
            start, total = short[0] - SHORT * cpu, MANY * cpu / CORES
            found = (1e3 * cpu, 1e3 * wall, *alone, start, total)
            print(f"{case.name:{NAME}s}" + "".join(f"{x:13.1f}" for x in found), flush=True)


if __name__ == "__main__":
    main()
