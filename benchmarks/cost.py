"""Measure the cost of a diagnosis: `python -m benchmarks.cost [--quick | --logs]`.

It prints CPU seconds and peak memory of complete `boatsim diagnose` commands, including reading and
writing of files, each in a separate process. The recordings are runs of trial_boat on the compiled
engine with random multi-level joystick steps and camera noise. `analysis` is the wall time without
start and files. The last rows are the first diagnosis with an empty cache and its repetition.

--logs measures sets of three recordings at 10 Hz instead, as owners have them: half an hour of a
planar boat, and eleven minutes of a boat in six degrees of freedom.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from boatsim.physics import vessel
from boatsim.physics.signals import STATE
from boatsim.recordings.table import Recording, read, write_csv
from boatsim.simulate.batch import Batch
from boatsim.simulate.run import run as simulate
from boatsim.simulate.scenario import Scenario

BOAT = "trial_boat"
HELD = 5 / 6  # [s] between joystick steps
STEP = 1 / 60  # [s] integration step
NOISE = (0.003, 0.003, 0.012)  # [m, m, rad] of camera and compass
TRIAL = (80.0, 6.0)  # [s], [Hz] of a practice trial
# rows of --logs -> vessel, minutes of each of three recordings
LOGS = {"3 x 10 min, planar": ("blueboat", 10.0), "3 x 3.7 min, six freedoms": ("otter", 3.7)}
LOG_RATE, LEVELS_HELD, LEVEL = 10.0, 8.0, 0.6  # [Hz], [s], share of the ranges of the channels
# what the vessel file lacks, so that the search has something to find
MISSING = [
    {"use": "current", "north": 0.1, "east": -0.15},
    {"use": "thrust_imbalance", "fraction": 0.1},
]
LOG_NOISE = {"m": 0.02, "rad": 0.005}  # of positions and angles
COLUMNS = {
    "cpu": "CPU [s]",
    "wall": "analysis [s]",
    "peak": "peak RAM [MB]",
    "written": "files [MB]",
}


def simulate_joystick_run(seconds: float, rate: float, seed: int) -> Recording:
    """Return a run of random joystick steps, recorded by a camera at `rate` [Hz]."""
    rng = np.random.default_rng(seed)
    boat = vessel.load_vessel(BOAT)
    steps = rng.uniform(-1.0, 1.0, (int(seconds / HELD) + 1, 4)) * (0.9, 0.9, 0.6, 0.6)
    t = np.arange(0.0, seconds, 1.0 / rate)
    commands = steps[(t / HELD + 1e-9).astype(int)]
    states = Batch(boat, step=STEP if rate < 10 else 1.0 / rate).rollout(
        [0.0] * 6, commands, 1.0 / rate
    )[:-1]
    pose = states[:, :3] + rng.standard_normal((len(t), 3)) * NOISE
    signals = dict(zip(("x_m", "y_m", "psi_rad"), pose.T, strict=True))
    return Recording(f"{seed}", t, signals | dict(zip(boat.commands, commands.T, strict=True)))


def simulate_log(name: str, seconds: float, seed: int) -> Recording:
    """Return a run of a vessel under random levels of its commands, with noise of its pose."""
    rng, boat = np.random.default_rng(seed), vessel.load_vessel(name)
    goals = []
    for begin in np.arange(0.0, seconds, LEVELS_HELD).tolist():
        levels = {"from": begin}
        for channel, command in boat.commands.items():
            levels[channel] = float(LEVEL * rng.uniform(command.low, command.high))
        goals.append(levels)
    scenario = Scenario.from_settings(
        vessel=boat,
        controller={"use": "open_loop"},
        sensors={"ideal": True},
        engine="compiled",
        duration=seconds,
        log=1.0 / LOG_RATE,
        goal=goals,
        effect=MISSING,
    )
    recorded = simulate(scenario).recording
    signals = {channel: recorded[channel] for channel in boat.commands}
    for signal in STATE:
        if not signal.rate and signal.column in recorded.signals and signal.axis in boat.dof:
            noise = LOG_NOISE[signal.column.rpartition("_")[2]]
            signals[signal.column] = recorded[signal.column] + rng.normal(0, noise, len(recorded))
    return Recording(f"{name}_{seed}", recorded.t, signals)


def diagnose_and_print_cost(boat: str, out: str, *runs: str) -> None:
    """Diagnose in this process and print the cost as JSON."""
    from boatsim.cli import app

    try:
        app(["diagnose", *runs, "--vessel", boat, "--out", out])
    except SystemExit as left:
        rss = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024  # Linux counts in KiB
        written = sum(f.stat().st_size for f in Path(out).iterdir()) / 2**20
        cost = {"cpu": time.process_time(), "peak": rss, "code": left.code, "written": written}
        print(json.dumps(cost))


def measure_cost(
    runs: Recording | Sequence[Recording],
    folder: Path,
    cache: Path | None = None,
    boat: str = BOAT,
) -> dict[str, float]:
    """Return CPU [s], wall time [s], peak memory [MB] and size of the files [MB] of one command."""
    files = []
    for run in [runs] if isinstance(runs, Recording) else runs:
        files.append(str(folder / f"run_{run.name}.csv"))
        write_csv(run, files[-1])
    environment = os.environ | ({"BOATSIM_CACHE": str(cache)} if cache else {})
    command = [
        sys.executable,
        "-m",
        "benchmarks.cost",
        "--one",
        boat,
        str(folder / "out"),
        *files,
    ]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    answer = json.loads((folder / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    return found | {"wall": answer["seconds"]}


def print_row(name: str, found: dict[str, float]) -> None:
    """Print a row of the table."""
    print(f"{name:34s}" + "".join(f"{found[key]:14.1f}" for key in COLUMNS), flush=True)


def print_logs() -> None:
    """Print the rows of sets of three recordings, each with an empty cache and with a filled one."""
    for name, (boat, minutes) in LOGS.items():
        with TemporaryDirectory() as base:
            folder = Path(base)
            runs = [simulate_log(boat, 60.0 * minutes, seed) for seed in range(3)]
            for state in ("", ", again"):
                print_row(f"{name}{state}", measure_cost(runs, folder, folder / "cache", boat))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--quick", action="store_true", help="the shortest runs only, and no cold start"
    )
    parser.add_argument("--logs", action="store_true", help="sets of three recordings only")
    parser.add_argument("--one", nargs="+", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one:
        return diagnose_and_print_cost(*given.one)
    print(" " * 34 + "".join(f"{heading:>14s}" for heading in COLUMNS.values()))
    if given.logs:
        return print_logs()
    with TemporaryDirectory() as base:
        folder = Path(base)
        measure_cost(
            simulate_joystick_run(*TRIAL, 0), folder
        )  # fills the cache of compiled programs
        run = simulate_joystick_run(180.0, 50.0, 1)
        write_csv(run, folder / "long.csv")
        begin = time.process_time()
        read(folder / "long.csv", vessel.load_vessel(BOAT).limits())
        took = time.process_time() - begin
        print(
            f"reading {len(run)} rows of {len(run.signals) + 1} columns: {took:.2f} s CPU",
            flush=True,
        )
        for rate in (6.0, 20.0):
            for minutes in (1,) if given.quick else (1, 2, 5, 10):
                run = simulate_joystick_run(60.0 * minutes, rate, minutes)
                print_row(f"{minutes} min at {rate:g} Hz", measure_cost(run, folder))
        for minutes in () if given.quick else (20, 60):  # fewer rows per second are used
            print_row(
                f"{minutes} min at 50 Hz",
                measure_cost(simulate_joystick_run(60.0 * minutes, 50.0, minutes), folder),
            )
        for state in () if given.quick else ("empty", "filled"):
            run = simulate_joystick_run(*TRIAL, 0)
            print_row(f"{TRIAL[0]:g} s, {state} cache", measure_cost(run, folder, folder / "cache"))


if __name__ == "__main__":
    main()
