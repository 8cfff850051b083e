"""The first picture of a report: where the boats went in free runs over unseen data, and a film of it for the page."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import TypedDict

import numpy as np

from boatsim.diagnose.free_runs import FreeRun
from boatsim.diagnose.report.drawing import Panel, every, legend, stacked
from boatsim.diagnose.report.figures import SIGNALS, course_of, error_of, in_unit, plan_view
from boatsim.diagnose.report.findings import Findings
from boatsim.diagnose.report.words import listed, number
from boatsim.physics.base import Array

SHOWN = 16  # consecutive free runs; where there are more, those about the largest error
SWUNG = 4  # of a boat without a path: more of its swings make a comb
FRAMES = 1200
LASTS = 40.0  # [s] at most; a longer run is played faster
FASTER = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
BRIDGED = 3.0  # [s] at most between two fixes that the film joins
AIR = 0.06  # of the picture, on each side
SMALLEST, LARGEST = 0.08, 0.25  # length of a boat that is drawn, by the height of the picture
BREADTH = 0.2  # of a midship section that is drawn, by the height of the picture
AGE = {"recorded": "", "recalibrated": " (before)", "patched": " (after)"}
BOW = ((0.5, 0.0), (0.2, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.2, -0.5))  # outline, ahead and to starboard
SECTION = ((-0.5, -0.3), (0.5, -0.3), (0.5, 0.1), (0.3, 0.3), (-0.3, 0.3), (-0.5, 0.1))  # to starboard and down


class Boat(TypedDict):
    """A boat of the film: at each frame its place in the picture, and how far it is turned clockwise."""

    look: str
    x: list[float | None]
    y: list[float | None]
    turned: list[float | None]  # [rad]


class Film(TypedDict):
    """What the page's script plays."""

    t: list[float]  # [s] a time twice is where the boats start anew
    start: int  # frame it begins with: the largest error of the recalibrated boat
    rate: int  # times real time
    plan: bool  # seen from above, in metres: the distance from the recording is told, otherwise the value
    unit: str
    outline: list[tuple[float, float]]  # to the right and down, in units of the picture's height axis
    boats: list[Boat]


@dataclass(frozen=True)
class Replay:
    """Picture and film."""

    title: str
    about: str
    legend: str  # mark-up
    picture: str  # mark-up
    film: Film


def replay(f: Findings) -> Replay | None:
    """That of the first unseen recording; None where nothing was run freely."""
    runs = next((list(group) for _, group in groupby(f.free_runs, key=lambda r: r.run)), [])
    models = [m for m in ("recalibrated", *(["patched"] if f.patched else [])) if runs and m in runs[0].channels]
    there = runs[0].channels["recorded"].keys() if runs else set[str]()
    plan = {"x_m", "y_m"} <= there
    signals = [] if plan else [s for s in ("phi_rad", "psi_rad", "theta_rad", "z_m") if s in there]
    if not models or not (plan or signals):
        return None
    shown, worst = _about_the_worst(runs, "position" if plan else signals[0], SHOWN if plan else SWUNG)
    panels = [_airy(plan_view(shown, models))] if plan else [course_of(shown, s, models) for s in signals]
    outline, scale = _outline(panels[0], f.size if plan else None, signals[:1])
    film = _film(shown, models, None if plan else signals[0], panels[0].y, outline, worst)
    what = "Paths" if plan else listed(SIGNALS[s] for s in signals).capitalize()
    title = f"{what} on unseen data, {runs[0].run}: recorded and free runs of the {listed(models)} vessel"
    looks = {m: m + (AGE[m] if "patched" in models else "") for m in ("recorded", *models)}
    return Replay(title, _about(runs, shown, plan, scale), legend(looks), stacked(panels), film)


def _airy(panel: Panel) -> Panel:
    """The panel with room for boats at the ends of their paths."""
    x, y = ((a - AIR * (b - a), b + AIR * (b - a)) for a, b in (panel.x, panel.y))
    return replace(panel, x=x, y=y)


def _about_the_worst(runs: Sequence[FreeRun], signal: str, most: int) -> tuple[list[FreeRun], float]:
    """So many consecutive free runs with the largest error of the recalibrated boat among them, and when [s]."""
    errors = [np.nan_to_num(np.abs(error_of(r, "recalibrated", signal))) for r in runs]
    at = int(np.argmax([e.max(initial=0.0) for e in errors]))
    first = min(max(at - most // 2, 0), max(len(runs) - most, 0))
    return list(runs[first : first + most]), float(runs[at].t[int(np.argmax(errors[at]))])


def _about(runs: Sequence[FreeRun], shown: Sequence[FreeRun], plan: bool, scale: float) -> str:
    """How to read the picture."""
    seconds = number(float(runs[0].t[-1] - runs[0].t[0]), 2)
    again = f"Every {seconds} s the boats start" if len(runs) > 1 else "The boats start"
    said = [f"{again} where the real one is and then follow the recorded commands alone."]
    if len(shown) < len(runs):
        said.append(f"Shown are {len(shown)} of {len(runs)} such runs, about the largest error.")
    if plan and not 0.95 < scale < 1.05:
        size = (
            f"{number(scale, 2)} times their size"
            if scale > 1.0
            else f"smaller than they are, 1 : {number(1 / scale, 2)}"
        )
        said.append(f"Boats are drawn {size}.")
    return " ".join(said)


def _outline(
    panel: Panel, size: tuple[float, float] | None, signals: Sequence[str]
) -> tuple[list[tuple[float, float]], float]:
    """What is drawn of a boat (length, beam) [m] seen from above, or of its midship section; and its scale."""
    height = panel.y[1] - panel.y[0]
    if size is None:
        shape = SECTION if signals == ["phi_rad"] else tuple((s, -a) for a, s in BOW)
        return [(round(BREADTH * height * a, 6), round(BREADTH * height * b, 6)) for a, b in shape], 1.0
    length, beam = size
    scale = float(np.clip(length, SMALLEST * height, LARGEST * height)) / length
    return [(round(scale * beam * s, 4), round(-scale * length * a, 4)) for a, s in BOW], scale


def _film(
    runs: Sequence[FreeRun],
    models: Sequence[str],
    signal: str | None,
    y: tuple[float, float],
    outline: list[tuple[float, float]],
    start: float,
) -> Film:
    """Frames of consecutive free runs; seen from above, or of a signal over time. It begins at `start` [s]."""
    rows = [every(len(r.t), max(2, FRAMES // len(runs))) for r in runs]
    fine = max(0, 4 - int(np.floor(np.log10(y[1] - y[0]))))  # decimals
    unit, factor = in_unit(signal, runs) if signal else ("m", 1.0)

    def joined(model: str, name: str) -> Array:
        parts = [bridged(r.t, r.channels[model].get(name, np.zeros(len(r.t)))) for r in runs]
        return np.concatenate([part[k] for part, k in zip(parts, rows, strict=True)])

    t = np.concatenate([r.t[k] for r, k in zip(runs, rows, strict=True)])
    boats: list[Boat] = []
    for model in ("recorded", *models):
        turned = joined(model, "psi_rad" if signal is None else signal if signal in ("phi_rad", "psi_rad") else "")
        east, up = (
            (joined(model, "y_m"), joined(model, "x_m")) if signal is None else (t, factor * joined(model, signal))
        )
        boats.append({"look": model, "x": _told(east, fine), "y": _told(up, fine), "turned": _told(turned, 3)})
    rate = next((f for f in FASTER if float(t[-1] - t[0]) <= f * LASTS), FASTER[-1])
    return {"t": np.round(t, 3).tolist(), "start": int(np.argmin(np.abs(t - start))), "rate": rate,
            "plan": signal is None, "unit": unit, "outline": outline, "boats": boats}  # fmt: skip


def bridged(t: Array, values: Array) -> Array:
    """What was measured less often than rows are written, straight between two measurements; gaps stay gaps."""
    seen = np.flatnonzero(np.isfinite(values))
    if len(seen) < 2:
        return values
    after = np.clip(np.searchsorted(seen, np.arange(len(values))), 1, len(seen) - 1)
    near = t[seen[after]] - t[seen[after - 1]] <= BRIDGED
    within = (np.arange(len(values)) >= seen[0]) & (np.arange(len(values)) <= seen[-1])
    return np.where(np.isnan(values) & near & within, np.interp(t, t[seen], values[seen]), values)


def _told(values: Array, decimals: int) -> list[float | None]:
    """Numbers as JSON has them: nothing where nothing was recorded."""
    return [None if np.isnan(v) else v for v in np.round(values, decimals).tolist()]
