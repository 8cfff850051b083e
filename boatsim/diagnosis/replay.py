"""Replays a recording: free runs of a vessel file with the recorded commands alone."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.candidates import program_to_replay
from boatsim.diagnosis.checks.initial_actuator_state import infer_initial_actuator_state
from boatsim.diagnosis.free_runs import FreeRun, free_runs
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, ignore_progress
from boatsim.recordings.table import Recording


def replay_recording(
    recording: Recording, vessel: Vessel, horizon: float, report: Report = ignore_progress
) -> list[FreeRun]:
    """Simulate a recording with a vessel model: free runs with the recorded commands alone.

    Each run starts from the recorded state and has the given duration.

    Args:
        recording: Measured signals and commands.
        vessel: Vessel file, or a patched one.
        horizon: Length of each free run [s].
        report: Receives the progress.

    Returns:
        Free runs with the channels "simulated" and "recorded".

    Raises:
        BadInput: The recording is shorter than the horizon, or misses a column.
    """
    problem, fitted = fit_noise_only(recording, vessel, report)
    report("free runs", 0.8)
    runs = free_runs(problem, {"simulated": fitted}, problem.recordings, horizon)
    if not runs:
        name, whole = recording.origin, recording.t[-1] - recording.t[0]
        raise BadInput(f"{name}: {whole:g} s long; a free run of {horizon:g} s does not fit")
    return runs


def free_run_columns(runs: Sequence[FreeRun]) -> dict[str, Array]:
    """Return consecutive simulations (free runs) as the columns of one table.

    The columns are t_s, the number of each run in `segment`, and the simulated pose. The time at
    which one run ends and the next begins occurs twice: at the end of one run, and at the start of
    the next.

    Args:
        runs: Free runs of one recording.
    """
    poses, times = list[dict[str, Array]](), list[Array]()
    for run in runs:
        poses.append(run.channels["simulated"])
        times.append(run.t)
    numbers = np.arange(float(len(runs)))
    found = {
        "t_s": np.concatenate(times),
        "segment": np.repeat(numbers, list(map(len, times))),
    }
    for name in poses[0]:
        found[name] = np.concatenate([pose[name] for pose in poses])
    return found


def join_free_runs(runs: Sequence[FreeRun]) -> Recording:
    """Join consecutive simulations (free runs) to one recording, in which each time occurs once.

    At the time at which one run ends and the next begins, the earlier run is kept.

    Args:
        runs: Free runs of one recording.
    """
    signals = free_run_columns(runs)
    first = np.append(True, np.diff(signals["t_s"]) > 0.0)
    signals = {name: values[first] for name, values in signals.items()}
    return Recording("replay", signals.pop("t_s"), signals)


def fit_noise_only(
    recording: Recording, vessel: Vessel, report: Report = ignore_progress
) -> tuple[Problem, Fit]:
    """Fit only the noise levels of a vessel model to a recording, and keep all its parameters.

    Args:
        recording: Measured signals and commands.
        vessel: Vessel file, or a patched one.
        report: Receives the progress.

    Returns:
        The estimation problem of the recording, and the fit.
    """
    report("compiling, or loading what was compiled before", 0.1)
    program, acting = program_to_replay(vessel)
    levels = prior_noise_levels(vessel, [recording])
    mapped = infer_initial_actuator_state(map_recording(recording, program), levels)
    problem = Problem([mapped], levels, {})
    report("fitting the noise", 0.3)
    return problem, fit_noise(problem, replace(problem.nominal_hypothesis(), effects=acting))
