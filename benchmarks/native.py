"""Print what numba and C need for a diagnosis: `python -m benchmarks.native [VESSEL]`.

The program has all candidate effects of the vessel. Nothing is cached at the begin: each compiler
works in an own process with an empty cache. The times are CPU times of that process and of the
compilers that it starts, for the first run of the Kalman filter over a recording of 40 s at 6 Hz,
for each further run, and for a call that computes next to nothing.
"""

import os
import resource
import subprocess
import sys
import tempfile
from time import process_time

import numpy as np

ROWS = 240  # of the recording
RATE = 6.0  # [Hz]
REPEATED = 50
CALLS = 2000
NAMES = {"1": "C", "0": "numba"}  # by the environment variable BOATSIM_NATIVE


def cpu_s() -> float:
    """Return the CPU time of this process and of those that it has started [s]."""
    return process_time() + resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def measure(name: str) -> tuple[float, float, float]:
    """Return CPU times of the first run of the filter [s], of a further one and of a short call."""
    from boatsim.diagnosis.candidates import diagnosis_program
    from boatsim.diagnosis.filter import map_recording, prior_noise_levels
    from boatsim.diagnosis.problem import Problem
    from boatsim.physics.vessel import load_vessel
    from boatsim.recordings.table import Recording

    vessel = load_vessel(name)
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
    values = problem.values(mapped, hypothesis.free, hypothesis.theta)
    on = program.effect_switches(program.candidate_names)
    mapped.smooth(values, on, problem.ambient)
    first, begin = cpu_s() - begin, process_time()
    for i in range(REPEATED):
        values[0] *= 1.0 + 1e-9 * i
        mapped.log_likelihood(values, on, problem.ambient)
    each, begin = (process_time() - begin) / REPEATED, process_time()
    k = np.zeros(program.module.K)
    for _ in range(CALLS):
        program.functions.compute_mass_constants(program.body, values, on, k)
    return first, each, (process_time() - begin) / CALLS


def main() -> None:
    """Measure each compiler in a process of its own."""
    name = (sys.argv[1:] or ["trial_boat"])[0]
    if "BOATSIM_MEASURED" in os.environ:
        print(*measure(name))
        return
    print(f"{name}, program of a diagnosis")
    print(f"{'':8}{'first run [s]':>15}{'further run [ms]':>18}{'short call [us]':>17}")
    for switch, compiler in NAMES.items():
        with tempfile.TemporaryDirectory() as cache:
            own = {"BOATSIM_CACHE": cache, "BOATSIM_NATIVE": switch, "BOATSIM_MEASURED": "1"}
            command = [sys.executable, "-m", "benchmarks.native", name]
            done = subprocess.run(
                command, env=os.environ | own, capture_output=True, text=True, check=True
            )
        first, each, call = map(float, done.stdout.split())
        print(f"{compiler:8}{first:15.1f}{1e3 * each:18.2f}{1e6 * call:17.1f}")


if __name__ == "__main__":
    main()
