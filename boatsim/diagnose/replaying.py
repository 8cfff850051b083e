"""Free runs of a vessel as it is written over a recording of commands, nothing fitted."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from boatsim.diagnose.filter import nominal_levels, track
from boatsim.diagnose.free_runs import FreeRun, free_runs
from boatsim.diagnose.levels import fit_noise
from boatsim.diagnose.log.first_orders import begun
from boatsim.diagnose.problem import Fit, Problem
from boatsim.diagnose.tried import composed
from boatsim.errors import BadInput
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, silent
from boatsim.recordings.table import Recording


def replayed(recording: Recording, boat: Vessel, horizon: float, told: Report = silent) -> list[FreeRun]:
    """Free runs of `horizon` [s], model "simulated" beside "recorded". Raises BadInput for too short a recording."""
    problem, fitted = as_written(recording, boat, told)
    told("free runs", 0.8)
    stretches = free_runs(problem, {"simulated": fitted}, problem.tracks, horizon)
    if not stretches:
        name, whole = recording.path or recording.name, recording.t[-1] - recording.t[0]
        raise BadInput(f"{name}: {whole:g} s long; a free run of {horizon:g} s does not fit")
    return stretches


def joined(stretches: Sequence[FreeRun]) -> Recording:
    """Free runs as one recording, with the number of each in `segment`; of a shared time the end of the earlier."""
    shared = [False, *(s.t[0] <= before.t[-1] for before, s in pairwise(stretches))]
    rows = [slice(1 if begins_there else 0, None) for begins_there in shared]
    signals = {
        n: np.concatenate([s.channels["simulated"][n][part] for s, part in zip(stretches, rows, strict=True)])
        for n in stretches[0].channels["simulated"]
    }
    times = [s.t[part] for s, part in zip(stretches, rows, strict=True)]
    signals["segment"] = np.concatenate([np.full(len(t), float(number)) for number, t in enumerate(times)])
    return Recording("replay", np.concatenate(times), signals)


def as_written(recording: Recording, boat: Vessel, told: Report = silent) -> tuple[Problem, Fit]:
    """A vessel file on a recording, nothing fitted but the noise that the smoothed starts need."""
    told("compiling, or loading what was compiled before", 0.1)
    program, acting = composed(boat)
    levels = nominal_levels(boat, [recording])
    problem = Problem([begun(track(recording, program), levels)], levels, {})
    told("fitting the noise", 0.3)
    return problem, fit_noise(problem, replace(problem.nominal(), suspects=acting))
