"""The film of a report: free runs as frames of numbers that the page's script plays."""

from collections.abc import Sequence
from typing import TypedDict

import numpy as np

from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.report.figures import in_unit
from boatsim.diagnosis.report.svg_plots import every
from boatsim.physics.base import Array

FRAMES = 1200
LASTS = 40.0  # [s] at most; a longer run is played faster
FASTER = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
BRIDGED = 3.0  # [s] at most between two fixes that the film joins
ANGLES = ("phi_rad", "psi_rad")  # by which what is drawn of a boat is turned

Outline = list[tuple[float, float]]


class Boat(TypedDict):
    """A boat of the film: at each frame its place in the picture, and how far it is turned clockwise."""

    look: str
    x: list[float | None]
    y: list[float | None]
    turned: list[float | None]  # [rad]


class Film(TypedDict):
    """What the page's script plays."""

    t: list[float]  # [s] a time twice is where the boats start anew
    start: int  # frame it begins with
    rate: int  # times real time
    # seen from above, in metres: the distance from the recording is told, otherwise the value
    plan: bool
    unit: str
    outline: Outline  # to the right and down, in units of the picture's height axis
    boats: list[Boat]


def film(
    runs: Sequence[FreeRun],
    models: Sequence[str],
    signal: str | None,
    height: float,
    outline: Outline,
    start: float,
) -> Film:
    """Frames of consecutive free runs, seen from above (`signal` is None) or of a signal over time.

    `height` is what the picture's height stands for, to which frames are exact enough; it begins at `start` [s].
    """
    rows = [every(len(r.t), max(2, FRAMES // len(runs))) for r in runs]
    t = np.concatenate([r.t[k] for r, k in zip(runs, rows, strict=True)])
    decimals = max(0, 4 - int(np.floor(np.log10(height))))
    unit, factor = in_unit(signal, runs) if signal else ("m", 1.0)

    def joined(model: str, name: str) -> Array:
        parts = [bridged(r.t, r.channels[model].get(name, np.zeros(len(r.t)))) for r in runs]
        return np.concatenate([part[k] for part, k in zip(parts, rows, strict=True)])

    def boat(model: str) -> Boat:
        x, y = (
            (t, factor * joined(model, signal))
            if signal
            else (joined(model, "y_m"), joined(model, "x_m"))
        )
        turned = joined(model, signal if signal in ANGLES else "" if signal else "psi_rad")
        return {
            "look": model,
            "x": _told(x, decimals),
            "y": _told(y, decimals),
            "turned": _told(turned, 3),
        }

    seconds = float(t[-1] - t[0])
    return {
        "t": np.round(t, 3).tolist(),
        "start": int(np.argmin(np.abs(t - start))),
        "rate": next((f for f in FASTER if seconds <= f * LASTS), FASTER[-1]),
        "plan": signal is None,
        "unit": unit,
        "outline": outline,
        "boats": [boat(m) for m in ("recorded", *models)],
    }


def bridged(t: Array, values: Array) -> Array:
    """What was measured less often than rows are written, straight between two measurements; gaps stay gaps."""
    seen = np.flatnonzero(np.isfinite(values))
    if len(seen) < 2:
        return values
    rows = np.arange(len(values))
    after = np.clip(np.searchsorted(seen, rows), 1, len(seen) - 1)
    near = t[seen[after]] - t[seen[after - 1]] <= BRIDGED
    within = (rows >= seen[0]) & (rows <= seen[-1])
    return np.where(np.isnan(values) & near & within, np.interp(t, t[seen], values[seen]), values)


def _told(values: Array, decimals: int) -> list[float | None]:
    """Numbers as JSON has them: nothing where nothing was recorded."""
    return [v if np.isfinite(v) else None for v in np.round(values, decimals).tolist()]
