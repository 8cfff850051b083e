"""The first picture of a report: where the boats went in free runs over unseen data, with a film of it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from math import cos, pi, sin

import numpy as np

from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.report.animation import Film, Outline, film
from boatsim.diagnosis.report.figures import SIGNALS, course_of, error_of, plan_view
from boatsim.diagnosis.report.findings import Findings
from boatsim.diagnosis.report.formatting import listed, number
from boatsim.diagnosis.report.svg_plots import Panel, legend, stacked

SHOWN = 16  # consecutive free runs; where there are more, those about the largest error
SWUNG = 4  # of a boat without a path: more of its swings make a comb
AIR = 0.06  # of the picture, on each side
SMALLEST, LARGEST = 0.08, 0.25  # length of a boat that is drawn, by the height of the picture
BREADTH, DOT = 0.2, 0.03  # of a midship section and of a mark, by the height of the picture
AGE = {"recorded": "", "recalibrated": " (before)", "patched": " (after)"}
BOW = (
    (0.0, -0.5),
    (0.5, -0.2),
    (0.5, 0.5),
    (-0.5, 0.5),
    (-0.5, -0.2),
)  # to starboard and astern, by beam and length
SECTION = (
    (-0.5, -0.3),
    (0.5, -0.3),
    (0.5, 0.1),
    (0.3, 0.3),
    (-0.3, 0.3),
    (-0.5, 0.1),
)  # to starboard and down
MARK = tuple((0.5 * cos(k * pi / 4), 0.5 * sin(k * pi / 4)) for k in range(8))


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
    there = runs[0].channels["recorded"].keys() if runs else ()
    plan = "x_m" in there and "y_m" in there
    signals = [] if plan else [s for s in ("phi_rad", "psi_rad", "theta_rad", "z_m") if s in there]
    models = [
        m
        for m in ("recalibrated", *(["patched"] if f.patched else []))
        if runs and m in runs[0].channels
    ]
    if not models or not (plan or signals):
        return None
    shown, worst = _about_the_worst(
        runs, "position" if plan else signals[0], SHOWN if plan else SWUNG
    )
    panels = (
        [_airy(plan_view(shown, models))]
        if plan
        else [course_of(shown, s, models) for s in signals]
    )
    height = panels[0].y[1] - panels[0].y[0]
    outline, scale = _outline(
        height, "psi_rad" if plan and "psi_rad" in there else (signals or ["x_m"])[0], f.size
    )
    looks = {m: m + (AGE[m] if "patched" in models else "") for m in ("recorded", *models)}
    what = "Paths" if plan else listed(SIGNALS[s] for s in signals).capitalize()
    return Replay(
        f"{what} on unseen data, {runs[0].run}: recorded and free runs of the {listed(models)} vessel",
        _about(runs, shown, scale if plan else 1.0),
        legend(looks),
        stacked(panels),
        film(shown, models, None if plan else signals[0], height, outline, worst),
    )


def _airy(panel: Panel) -> Panel:
    """The panel with room for boats at the ends of their paths."""
    x, y = ((a - AIR * (b - a), b + AIR * (b - a)) for a, b in (panel.x, panel.y))
    return replace(panel, x=x, y=y)


def _about_the_worst(
    runs: Sequence[FreeRun], signal: str, most: int
) -> tuple[list[FreeRun], float]:
    """So many consecutive free runs with the largest error of the recalibrated boat among them, and when [s]."""
    errors = [np.nan_to_num(np.abs(error_of(r, "recalibrated", signal))) for r in runs]
    at = int(np.argmax([e.max(initial=0.0) for e in errors]))
    first = min(max(at - most // 2, 0), max(len(runs) - most, 0))
    return list(runs[first : first + most]), float(runs[at].t[int(np.argmax(errors[at]))])


def _about(runs: Sequence[FreeRun], shown: Sequence[FreeRun], scale: float) -> str:
    """How to read the picture."""
    seconds = number(float(runs[0].t[-1] - runs[0].t[0]), 2)
    again = f"Every {seconds} s the boats start" if len(runs) > 1 else "The boats start"
    said = [f"{again} where the real one is and then follow the recorded commands alone."]
    if len(shown) < len(runs):
        said.append(f"Shown are {len(shown)} of {len(runs)} such runs, about the largest error.")
    if scale > 1.05:
        said.append(f"Boats are drawn {number(scale, 2)} times their size.")
    elif scale < 0.95:
        said.append(f"Boats are drawn smaller than they are, 1 : {number(1.0 / scale, 2)}.")
    return " ".join(said)


def _outline(height: float, turned_by: str, size: tuple[float, float]) -> tuple[Outline, float]:
    """What is drawn of a boat of (length, beam) [m], and its scale; a mark where nothing is known to turn it.

    A heading turns what is seen from above, roll what is seen from astern.
    """
    if turned_by == "psi_rad":
        length, beam = size
        scale = float(np.clip(length, SMALLEST * height, LARGEST * height)) / length
        return _sized(BOW, scale * beam, scale * length), scale
    wide, shape = (BREADTH, SECTION) if turned_by == "phi_rad" else (DOT, MARK)
    return _sized(shape, wide * height, wide * height), 1.0


def _sized(shape: Sequence[tuple[float, float]], across: float, down: float) -> Outline:
    return [(float(f"{across * a:.4g}"), float(f"{down * b:.4g}")) for a, b in shape]
