"""Free runs: what a boat does from a recorded state with the recorded commands alone, and how far off it is."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, segments
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array

MODELS = ("recorded", "nominal", "recalibrated", "patched")  # what a free run compares
FAMILIES = {
    "position_rms_m": ("x_m", "y_m"),
    "heading_rms_rad": ("psi_rad",),
    "roll_rms_rad": ("phi_rad",),
}


@dataclass(frozen=True)
class FreeRun:
    """A stretch of unseen recording, and what each boat does from its first row with the recorded commands alone."""

    run: str  # name of the recording
    start_s: float
    t: Array  # (M,) s
    channels: dict[
        str, dict[str, Array]
    ]  # one of `MODELS` -> x_m, y_m, psi_rad, phi_rad (those there are), each (M,)


def free_runs(
    problem: Problem, fits: Mapping[str, Fit], tracks: Sequence[MappedRecording], horizon: float
) -> list[FreeRun]:
    """Free runs of all models over recordings, each started at its own smoothed state every `horizon` s."""
    nq = problem.program.module.NQ
    out = []
    for track in tracks:
        runs = {
            name: track.free_runs(
                problem.values(track, f.free, f.theta),
                problem.program.switches(f.effects),
                f.levels,
                horizon,
            )
            for name, f in fits.items()
        }
        for i, (begin, end) in enumerate(zip(*segments(track.times, horizon), strict=True)):
            channels: dict[str, dict[str, Array]] = {"recorded": {}, **{name: {} for name in fits}}
            for c, code in enumerate(track.codes):
                if code < nq:
                    channels["recorded"][track.signals[c]] = track.measured[begin : end + 1, c]
                    for name in fits:
                        channels[name][track.signals[c]] = runs[name][i][1][:, code]
            t = track.times[begin : end + 1]
            out.append(FreeRun(track.name, float(t[0]), t, channels))
    return out


def errors(stretches: Sequence[FreeRun]) -> dict[str, dict[str, float]]:
    """Rms error per family of signals and model over all stretches."""
    found: dict[str, dict[str, float]] = {}
    for family, signals in FAMILIES.items():
        if not stretches or not any(s in stretches[0].channels["recorded"] for s in signals):
            continue
        found[family] = {}
        for model in (m for m in stretches[0].channels if m != "recorded"):
            off = [
                (s.channels[model][n] - s.channels["recorded"][n]).ravel()
                for s in stretches
                for n in signals
                if n in s.channels["recorded"]
            ]
            found[family][model] = float(np.sqrt(mean_square(off)))
    return found


def mean_square(off: Sequence[Array]) -> float:
    """Of errors where anything was recorded; nan if nothing was."""
    errors_there = np.concatenate(off)
    errors_there = errors_there[~np.isnan(errors_there)]
    return float(np.mean(errors_there**2)) if len(errors_there) else float("nan")
