"""Free runs of a vessel as it is written over a recording of commands, nothing fitted."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.candidates import composed
from boatsim.diagnosis.checks.initial_actuator_state import with_initial_actuators
from boatsim.diagnosis.filter import map_recording, nominal_levels
from boatsim.diagnosis.free_runs import FreeRun, free_runs
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, silent
from boatsim.recordings.table import Recording


def replayed(
    recording: Recording, boat: Vessel, horizon: float, told: Report = silent
) -> list[FreeRun]:
    """Free runs of `horizon` [s], model "simulated" beside "recorded". Raises BadInput for too short a recording."""
    problem, fitted = as_written(recording, boat, told)
    told("free runs", 0.8)
    stretches = free_runs(problem, {"simulated": fitted}, problem.recordings, horizon)
    if not stretches:
        name, whole = recording.path or recording.name, recording.t[-1] - recording.t[0]
        raise BadInput(f"{name}: {whole:g} s long; a free run of {horizon:g} s does not fit")
    return stretches


def columns(stretches: Sequence[FreeRun]) -> dict[str, Array]:
    """Free runs one below the other, each whole: t_s, the number of each in `segment`, pose.

    Where one ends as the next begins, that time is there twice: where the one has come to, where the other starts.
    """
    poses = [s.channels["simulated"] for s in stretches]
    found = {"t_s": np.concatenate([s.t for s in stretches])}
    found["segment"] = np.repeat(np.arange(float(len(stretches))), [len(s.t) for s in stretches])
    return found | {name: np.concatenate([pose[name] for pose in poses]) for name in poses[0]}


def joined(stretches: Sequence[FreeRun]) -> Recording:
    """The same as one recording, which has each time once: of a shared one the end of the earlier run."""
    every = columns(stretches)
    first = np.append(True, np.diff(every["t_s"]) > 0.0)
    signals = {name: values[first] for name, values in every.items()}
    return Recording("replay", signals.pop("t_s"), signals)


def as_written(recording: Recording, boat: Vessel, told: Report = silent) -> tuple[Problem, Fit]:
    """A vessel file on a recording, nothing fitted but the noise that the smoothed starts need."""
    told("compiling, or loading what was compiled before", 0.1)
    program, acting = composed(boat)
    levels = nominal_levels(boat, [recording])
    problem = Problem(
        [with_initial_actuators(map_recording(recording, program), levels)], levels, {}
    )
    told("fitting the noise", 0.3)
    return problem, fit_noise(problem, replace(problem.nominal(), effects=acting))
