"""Free runs: simulations from a recorded state with the recorded commands alone."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, free_run_segments
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array

FAMILIES = {
    "position_rms_m": ("x_m", "y_m"),
    "heading_rms_rad": ("psi_rad",),
    "roll_rms_rad": ("phi_rad",),
    "heave_rms_m": ("z_m",),
}
# Rms error [m or rad] that is stated where a simulation diverges, so that it stays a number; far
# above that of any simulation that does not
DIVERGED = 1e6


@dataclass(frozen=True)
class FreeRun:
    """A stretch of a recording, with a simulation of it by each of several vessel models.

    Each simulation starts from the state at the first row and uses the recorded commands alone.
    """

    run: str  # name of the recording
    start_s: float
    t: Array  # (M,) s
    # "recorded" or the name of a model -> those of x_m, y_m, z_m, phi_rad, psi_rad that were
    # recorded, each (M,)
    channels: dict[str, dict[str, Array]]

    def deviations(self, model: str, signals: Sequence[str]) -> list[Array]:
        """Return simulated minus recorded values of some signals, an array (M,) for each of them.

        They are nan where nothing was recorded, and infinite where the simulation has diverged.

        Args:
            model: Name of the model.
            signals: Columns; those that were not recorded are omitted.
        """
        found = list[Array]()
        for name in signals:
            if name in self.channels["recorded"]:
                recorded, simulated = self.channels["recorded"][name], self.channels[model][name]
                diverged = ~np.isfinite(simulated) & ~np.isnan(recorded)
                with np.errstate(invalid="ignore"):
                    found.append(np.where(diverged, np.inf, simulated - recorded))
        return found


def free_run_horizon(problem: Problem, held_out: Sequence[MappedRecording]) -> float:
    """Return the duration [s] of free runs, at most that of the longest held-out recording.

    A free run is a simulation from a recorded state with the recorded commands alone.

    Args:
        problem: Problem with the usual length.
        held_out: Held-out recordings, at least one.
    """
    longest = max(float(np.ptp(mapped.times)) for mapped in held_out)
    if longest < problem.horizon:
        return min(problem.horizon, float(f"{longest:.3g}"))
    return problem.horizon


def free_runs(
    problem: Problem,
    fits: Mapping[str, Fit],
    recordings: Sequence[MappedRecording],
    horizon: float,
    skipped: float = 0.0,
) -> list[FreeRun]:
    """Simulate fitted models over stretches of recordings with the recorded commands alone.

    A run of each model starts at every multiple of the horizon, from the state that this model's
    smoother estimates there.

    Args:
        problem: Problem with the program and the priors.
        fits: Fits by the name of the model.
        recordings: Recordings mapped to a program of the same vessel.
        horizon: Length of each free run [s].
        skipped: Time from the first row of a recording before which none starts [s].

    Returns:
        One free run per stretch, with the recorded signals and those of each model.
    """
    found = []
    for mapped in recordings:
        runs = {}
        for name, fit in fits.items():
            values = problem.parameter_vector(mapped, fit.free, fit.theta)
            on = problem.program.effect_switches(fit.effects)
            acting = problem.switches_in(mapped, fit.free, on)
            runs[name] = mapped.free_runs(values, acting, fit.levels, horizon, skipped)
        segments = zip(*free_run_segments(mapped.times, horizon, skipped), strict=True)
        for i, (begin, end) in enumerate(segments):
            simulated = {name: own[i][1] for name, own in runs.items()}
            found.append(_free_run(mapped, begin, end, simulated))
    return found


def _free_run(
    mapped: MappedRecording, begin: int, end: int, simulated: Mapping[str, Array]
) -> FreeRun:
    """A stretch of a recording with the simulated channels (M, 2 NQ) of each model."""
    channels: dict[str, dict[str, Array]] = {name: {} for name in ("recorded", *simulated)}
    for c, code in enumerate(mapped.codes):
        if code < mapped.program.module.NQ:
            signal = mapped.signals[c]
            channels["recorded"][signal] = mapped.measured[begin : end + 1, c]
            for name, states in simulated.items():
                channels[name][signal] = states[:, code]
    t = mapped.times[begin : end + 1]
    return FreeRun(mapped.name, float(t[0]), t, channels)


def rms_errors(runs: Sequence[FreeRun]) -> dict[str, dict[str, float]]:
    """Return the rms errors of free runs (simulations with the recorded commands alone).

    The first key is the family of signals (position, heading, roll or heave), the second one the
    model. The rms error of the position is that over both coordinates; the rms distance from the
    recorded position is 1.41 times as large. Where a simulation diverges it is `DIVERGED`.

    Args:
        runs: Free runs with the same models.
    """
    found: dict[str, dict[str, float]] = {}
    if not runs:
        return found
    models = [model for model in runs[0].channels if model != "recorded"]
    for family, signals in FAMILIES.items():
        if not any(signal in runs[0].channels["recorded"] for signal in signals):
            continue
        found[family] = {}
        for model in models:
            off: list[Array] = []
            for run in runs:
                off += run.deviations(model, signals)
            found[family][model] = min(float(np.sqrt(mean_square(off))), DIVERGED)
    return found


def mean_square(off: Sequence[Array]) -> float:
    """Return the mean square of deviations, ignoring nan; nan if there are no deviations.

    Args:
        off: Arrays of deviations.
    """
    deviations = np.concatenate(off)
    deviations = deviations[~np.isnan(deviations)]
    return float(np.mean(deviations**2)) if len(deviations) else float("nan")
