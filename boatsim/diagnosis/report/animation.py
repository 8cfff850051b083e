"""The animation of a report: free runs as frames that the script of the page plays."""

from collections.abc import Callable, Sequence

import numpy as np

from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.model_names import MODEL_WORDS
from boatsim.diagnosis.report.figures import unit_for_signal
from boatsim.physics.base import Array
from boatsim.view.replay import Animation, Boat, Outline, playback_speed, rounded_or_none
from boatsim.view.svg_plots import evenly_spaced_rows

FRAMES = 1200
LONGEST_GAP = 3.0  # [s] between two position fixes that the animation interpolates
ANGLES = ("phi_rad", "psi_rad")  # signals that rotate the outline of a boat


def animation_frames(
    runs: Sequence[FreeRun],
    models: Sequence[str],
    signal: str | None,
    height: float,
    outline: Outline,
    start: float,
) -> Animation:
    """Return the frames of the report's animation of recorded and simulated motion.

    Args:
        runs: Consecutive free runs (simulations with recorded commands alone) over one recording.
        models: Names of the vessel models to show in addition to the recording.
        signal: Signal to show over time; None for a view from above.
        height: Range of the vertical axis, which sets the rounding of the frames.
        outline: Outline of a boat.
        start: Time [s] of the first frame shown.
    """
    rows, times = [], []
    for run in runs:
        rows.append(evenly_spaced_rows(len(run.t), max(2, FRAMES // len(runs))))
        times.append(run.t[rows[-1]])
    t = np.concatenate(times)
    decimals = max(0, 4 - int(np.floor(np.log10(height))))
    unit, factor = ("m", 1.0)
    if signal:
        unit, factor = unit_for_signal(signal, runs)

    def join_free_runs_of_model(model: str, name: str) -> Array:
        parts = []
        for run, k in zip(runs, rows, strict=True):
            values = run.channels[model].get(name, np.zeros(len(run.t)))
            parts.append(fill_short_gaps(run.t, values)[k])
        return np.concatenate(parts)

    boats = []
    for model in ("recorded", *models):
        boats.append(_boat(model, join_free_runs_of_model, t, signal, factor, decimals))
    return {
        "t": np.round(t, 3).tolist(),
        "start": int(np.argmin(np.abs(t - start))),
        "rate": playback_speed(float(t[-1] - t[0])),
        "plan": signal is None,
        "unit": unit,
        "outline": outline,
        "boats": boats,
    }


def _boat(
    model: str,
    joined: Callable[[str, str], Array],
    t: Array,
    signal: str | None,
    factor: float,
    decimals: int,
) -> Boat:
    """Return the frames of one boat; `joined` returns a signal of a model in all frames."""
    if signal is None:
        x, y, turned = joined(model, "y_m"), joined(model, "x_m"), joined(model, "psi_rad")
    else:
        x, y, turned = t, factor * joined(model, signal), np.zeros(len(t))
        if signal in ANGLES:
            turned = joined(model, signal)
    return {
        "look": model,
        "name": MODEL_WORDS[model],
        "x": rounded_or_none(x, decimals),
        "y": rounded_or_none(y, decimals),
        "turned": rounded_or_none(turned, 3),
    }


def fill_short_gaps(t: Array, values: Array) -> Array:
    """Fill short gaps of a measured signal by linear interpolation.

    Args:
        t: Times (N,) [s].
        values: Values (N,); nan where nothing was measured.

    Returns:
        Values (N,); gaps longer than `LONGEST_GAP` remain nan.
    """
    seen = np.flatnonzero(np.isfinite(values))
    if len(seen) < 2:
        return values
    rows = np.arange(len(values))
    after = np.clip(np.searchsorted(seen, rows), 1, len(seen) - 1)
    near = t[seen[after]] - t[seen[after - 1]] <= LONGEST_GAP
    within = (rows >= seen[0]) & (rows <= seen[-1])
    return np.where(np.isnan(values) & near & within, np.interp(t, t[seen], values[seen]), values)
