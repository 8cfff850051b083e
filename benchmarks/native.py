"""Print what numba and C need for a vessel: `python -m benchmarks.native [VESSEL]`.

Nothing is cached at the begin: each compiler works in processes of its own with an empty cache. The
times are CPU times of these processes and of the compilers that they start.

First table: the program of a diagnosis with all candidate effects of the vessel, the first run of
the Kalman filter over a recording of 40 s at 6 Hz and each further run; then 10 s on MuJoCo at 50
steps a second, the first time and per step later; and a step in open water, three short calls from
Python. Second table: whole commands, the first time and again.
"""

import os
import resource
import subprocess
import sys
import tempfile
from time import process_time

import numpy as np

from boatsim.physics.vessel import Vessel
from boatsim.simulate.stepper import Stepper

ROWS = 240  # of the recording
RATE = 6.0  # [Hz]
REPEATED = 50
STEPS = 500  # of a simulation
COMMANDS = (("run", "joystick_boat/sway_1", "--out", "run"), ("demo", "--out", "demo"))
NAMES = {"1": "C", "0": "numba"}  # by the environment variable BOATSIM_NATIVE


def cpu_s() -> float:
    """Return the CPU time of this process and of those that it has started [s]."""
    return process_time() + resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def measure_filter(vessel: Vessel) -> tuple[float, float]:
    """Return CPU times of the first run of the filter over a recording, and of a further one."""
    from boatsim.diagnosis.candidates import diagnosis_program
    from boatsim.diagnosis.prior_noise import prior_noise_levels
    from boatsim.diagnosis.problem import Problem
    from boatsim.diagnosis.recording_mapping import map_recording
    from boatsim.recordings.table import Recording

    t = np.arange(ROWS) / RATE
    signals = {"x_m": 0.1 * t, "y_m": np.sin(0.1 * t), "psi_rad": 0.1 * t}
    for command, channel in vessel.commands.items():
        signals[command] = 0.1 * channel.high * np.ones(ROWS)
    recording = Recording("straight", t, signals)
    program, _ = diagnosis_program(vessel)
    begin = cpu_s()
    mapped = map_recording(recording, program)
    problem = Problem([mapped], prior_noise_levels(vessel, [recording]), {})
    hypothesis = problem.nominal_hypothesis()
    values = problem.parameter_vector(mapped, hypothesis.free, hypothesis.theta)
    on = program.effect_switches(program.candidate_names)
    mapped.smooth(values, on, problem.ambient)
    first, begin = cpu_s() - begin, process_time()
    for i in range(REPEATED):
        values[0] *= 1.0 + 1e-9 * i
        mapped.log_likelihood(values, on, problem.ambient)
    return first, (process_time() - begin) / REPEATED


def measure_steps(kind: type[Stepper], vessel: Vessel) -> tuple[float, float]:
    """Return CPU times of a first simulation and of each further step."""
    begin = cpu_s()
    engine = kind(vessel)
    engine.command({name: 0.1 * channel.high for name, channel in vessel.commands.items()})
    engine.advance(STEPS)
    first, begin = cpu_s() - begin, process_time()
    engine.advance(10 * STEPS)
    return first, (process_time() - begin) / (10 * STEPS)


def measure(name: str) -> None:
    """Print the CPU times of one compiler [s]."""
    from boatsim.physics.vessel import load_vessel
    from boatsim.simulate.engine import Engine
    from boatsim.simulate.open_water import OpenWater

    vessel = load_vessel(name)
    print(*measure_steps(Engine, vessel), measure_steps(OpenWater, vessel)[1])
    print(*measure_filter(vessel))


def in_own_process(command: list[str], switch: str, cache: str) -> tuple[str, float]:
    """Return what a command prints and its CPU time [s]."""
    own = {"BOATSIM_CACHE": cache, "BOATSIM_NATIVE": switch, "BOATSIM_MEASURED": "1"}
    own["PYTHONPATH"] = os.getcwd()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [sys.executable, *command],
        env=os.environ | own,
        cwd=cache,
        capture_output=True,
        text=True,
        check=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.stdout, cpu


def main() -> None:
    """Measure each compiler in processes of its own."""
    name = (sys.argv[1:] or ["trial_boat"])[0]
    if "BOATSIM_MEASURED" in os.environ:
        measure(name)
        return
    print(f"{name}: filter of a diagnosis and simulations, CPU time")
    print(f"{'':8}{'filter: first [s]':>18}{'further [ms]':>14}", end="")
    print(f"{'MuJoCo: first [s]':>20}{'step [us]':>11}{'open water: step [us]':>23}")
    for switch, compiler in NAMES.items():
        with tempfile.TemporaryDirectory() as cache:
            printed, _ = in_own_process(["-m", "benchmarks.native", name], switch, cache)
        engine, step, open_step, first, further = map(float, printed.split())
        print(f"{compiler:8}{first:18.1f}{1e3 * further:14.2f}{engine:20.1f}", end="")
        print(f"{1e6 * step:11.1f}{1e6 * open_step:23.1f}")
    print("\nwhole commands, CPU time [s]")
    print(f"{'':8}{'command':36}{'first':>8}{'again':>8}")
    for switch, compiler in NAMES.items():
        for command in COMMANDS:
            with tempfile.TemporaryDirectory() as cache:
                whole = ["-m", "boatsim", *command]
                times = [in_own_process(whole, switch, cache)[1] for _ in range(2)]
            print(f"{compiler:8}{'boatsim ' + ' '.join(command[:2]):36}", end="")
            print(f"{times[0]:8.1f}{times[1]:8.1f}")


if __name__ == "__main__":
    main()
