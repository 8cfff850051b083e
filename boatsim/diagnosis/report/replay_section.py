"""The first figure of a report: recorded and simulated paths over held-out data, animated."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.model_names import MODEL_WORDS, model_names_in_words
from boatsim.diagnosis.report.animation import animation_frames
from boatsim.diagnosis.report.figures import (
    SIGNALS,
    group_by_recording,
    model_error,
    plan_view,
    signal_panel,
)
from boatsim.view.formatting import format_number, join_words
from boatsim.view.replay import (
    MARK,
    MARK_SIZE,
    SECTION,
    SECTION_SIZE,
    Outline,
    Replay,
    axis_limits_with_margin,
    scaled_outline,
)
from boatsim.view.svg_plots import Panel, legend, stack_panels

MOST_PATHS = 16  # consecutive free runs in a view from above
MOST_COURSES = 4  # consecutive free runs of a signal over time, which may oscillate
SMALLEST, LARGEST = 0.08, 0.25  # length of the drawn boat, relative to the height of the figure
# outlines: to starboard and astern, relative to beam and length
BOAT = ((0.0, -0.5), (0.5, -0.2), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.2))


def animated_replay(f: Findings) -> Replay | None:
    """Return the animated figure of recorded and simulated motion in the first held-out recording.

    Args:
        f: Findings of a diagnosis.

    Returns:
        The figure; None without free runs or without signals that can be drawn.
    """
    if not f.free_runs:
        return None
    runs = group_by_recording(f.free_runs)[0]
    recorded = runs[0].channels["recorded"].keys()
    simulated = runs[0].channels
    models = []
    if "recalibrated" in simulated:
        models.append("recalibrated")
    if f.has_added_effects and "patched" in simulated:
        models.append("patched")
    if not models:
        return None
    if {"x_m", "y_m"} <= recorded:
        return _paths(f, runs, models)
    signals = [s for s in ("phi_rad", "psi_rad", "theta_rad", "z_m") if s in recorded]
    if not signals:
        return None
    return _signals_over_time(f, runs, models, signals)


def _paths(f: Findings, runs: Sequence[FreeRun], models: Sequence[str]) -> Replay:
    """Return paths seen from above."""
    drawn, worst = _around_largest_error(runs, "position", MOST_PATHS)
    panel = plan_view(drawn, models)
    panel = replace(panel, x=axis_limits_with_margin(panel.x), y=axis_limits_with_margin(panel.y))
    height = panel.y[1] - panel.y[0]
    if "psi_rad" in runs[0].channels["recorded"]:
        outline, scale = _boat(height, f.size)
    else:
        scale, outline = 1.0, scaled_outline(MARK, MARK_SIZE * height, MARK_SIZE * height)
    return Replay(
        _title("Paths", runs, models),
        _caption(runs, drawn, scale),
        _legend(models),
        stack_panels([panel]),
        animation_frames(drawn, models, None, height, outline, worst),
    )


def _signals_over_time(
    f: Findings, runs: Sequence[FreeRun], models: Sequence[str], signals: Sequence[str]
) -> Replay:
    """Return signals over time; the first one is animated."""
    drawn, worst = _around_largest_error(runs, signals[0], MOST_COURSES)
    panels: list[Panel] = []
    for signal in signals:
        panels.append(signal_panel(drawn, signal, models))
    height = panels[0].y[1] - panels[0].y[0]
    outline = scaled_outline(MARK, MARK_SIZE * height, MARK_SIZE * height)
    if signals[0] == "psi_rad":
        outline, _ = _boat(height, f.size)
    if signals[0] == "phi_rad":
        outline = scaled_outline(SECTION, SECTION_SIZE * height, SECTION_SIZE * height)
    return Replay(
        _title(join_words(SIGNALS[s] for s in signals).capitalize(), runs, models),
        _caption(runs, drawn, 1.0),
        _legend(models),
        stack_panels(panels),
        animation_frames(drawn, models, signals[0], height, outline, worst),
    )


def _title(what: str, runs: Sequence[FreeRun], models: Sequence[str]) -> str:
    return (
        f"{what} on held-out data, {runs[0].run}: recorded, and free runs of the "
        f"{join_words(model_names_in_words(models))} vessel"
    )


def _legend(models: Sequence[str]) -> str:
    return legend({model: MODEL_WORDS[model] for model in ("recorded", *models)})


def _around_largest_error(
    runs: Sequence[FreeRun], signal: str, most: int
) -> tuple[list[FreeRun], float]:
    """Return at most so many consecutive free runs around the largest error, and its time [s]."""
    errors, largest = [], []
    for run in runs:
        errors.append(np.nan_to_num(np.abs(model_error(run, "recalibrated", signal))))
        largest.append(errors[-1].max(initial=0.0))
    worst = int(np.argmax(largest))
    first = min(max(worst - most // 2, 0), max(len(runs) - most, 0))
    time = float(runs[worst].t[int(np.argmax(errors[worst]))])
    return list(runs[first : first + most]), time


def _caption(runs: Sequence[FreeRun], drawn: Sequence[FreeRun], scale: float) -> str:
    """Return how to read the figure."""
    start = "The boats start"
    if len(runs) > 1:
        seconds = format_number(float(runs[0].t[-1] - runs[0].t[0]), 2)
        start = f"Every {seconds} s the simulated boats start"
    sentences = [f"{start} at the recorded state and then receive the recorded commands only."]
    if len(drawn) < len(runs):
        sentences.append(
            f"The figure shows {len(drawn)} of {len(runs)} such runs, around the largest error."
        )
    if scale > 1.05:
        sentences.append(f"Boats are drawn {format_number(scale, 2)} times their size.")
    elif scale < 0.95:
        sentences.append(
            f"Boats are drawn smaller than they are, 1 : {format_number(1.0 / scale, 2)}."
        )
    return " ".join(sentences)


def _boat(height: float, size: tuple[float, float]) -> tuple[Outline, float]:
    """Return the outline of a boat of this length and beam [m], and its scale."""
    length, beam = size
    scale = float(np.clip(length, SMALLEST * height, LARGEST * height)) / length
    return scaled_outline(BOAT, scale * beam, scale * length), scale
