"""Figures of the report: missing forces, free runs and their errors, curves of formulas."""

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from boatsim.diagnosis.answer.described_terms import (
    abscissa_label,
    axis_force_words,
    term_axis,
    term_unit,
)
from boatsim.diagnosis.answer.findings import MissingForceCurve
from boatsim.diagnosis.answer.schema import IntervalEntry
from boatsim.diagnosis.description import FittedTerm
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.model_names import MODEL_WORDS, MODELS
from boatsim.physics.base import Array
from boatsim.view.formatting import capitalize, convenient_unit, format_number
from boatsim.view.svg_plots import MARGIN, SQUARE, Line, Panel, axis_limits, figure

MOST_CROSSINGS = 14  # zero crossings of an oscillation that are drawn
BAND = 2.0  # [sd] half width of the bands
OFF_SCALE = 2.5  # a nominal vessel with so many times the error of the others is cut off
SIGNALS = {"psi_rad": "heading", "phi_rad": "roll", "theta_rad": "pitch", "z_m": "heave"}

Intervals = Sequence[IntervalEntry]


def missing_force_figures(
    runs: Sequence[MissingForceCurve], intervals: Intervals, shared: Sequence[MissingForceCurve]
) -> list[str]:
    """Draw the force that the vessel model does not explain over time, one figure per recording.

    Args:
        runs: Missing force of the recordings to draw.
        intervals: Flagged intervals of all recordings.
        shared: Missing force of the recordings that share one scale per axis.

    Returns:
        Figures as SVG.
    """
    scales = {}
    for axis in shared[0].force:
        parts = []
        for m in shared:
            parts += [m.force[axis] + BAND * m.sd[axis], m.force[axis] - BAND * m.sd[axis]]
            if axis in m.left:
                parts.append(m.left[axis])
        values = np.concatenate(parts)
        unit, factor = convenient_unit(shared[0].unit[axis], float(np.nanmax(np.abs(values))))
        scales[axis] = _limits_around_zero(axis_limits([factor * values])), unit, factor
    drawn = []
    for m in runs:
        panels = []
        for axis in m.force:
            panels.append(_missing_panel(m, axis, intervals, *scales[axis]))
        drawn.append(figure(panels, m.run, wide=len(runs) == 1))
    return drawn


def _limits_around_zero(limits: tuple[float, float]) -> tuple[float, float]:
    """Return limits of an axis on which a curve near zero can be seen, not only above the edge."""
    low, high = limits
    return min(low, -MARGIN * high), high


def _missing_panel(
    m: MissingForceCurve,
    axis: str,
    intervals: Intervals,
    y: tuple[float, float],
    unit: str,
    factor: float,
) -> Panel:
    flags = []
    for i in intervals:
        if (i["run"], i["axis"]) == (m.run, axis):
            flags.append((i["from_s"], i["to_s"]))
    force, sd = factor * m.force[axis], factor * m.sd[axis]
    lines = [Line("missing", m.t, force, "missing")]
    if axis in m.left:
        lines.append(Line("left", m.t, factor * m.left[axis], "missing in the corrected vessel"))
    rms = format_number(float(np.sqrt(np.nanmean(force**2))))
    kind = "force" if axis in ("surge", "sway", "heave") else "moment"
    return Panel(
        f"{axis} {kind} [{unit}]",
        tuple(lines),
        (float(m.t[0]), float(m.t[-1])),
        y,
        "time [s]",
        (m.t, force - BAND * sd, force + BAND * sd),
        tuple(flags),
        about=f"Missing force in {axis} over {m.run}: rms {rms} {unit}; flagged in "
        f"{len(flags)} intervals.",
    )


def free_run_figures(runs: Sequence[FreeRun]) -> list[str]:
    """Draw the simulations of one held-out recording: paths, roll, and the errors over time.

    Args:
        runs: Consecutive free runs (simulations with recorded commands alone) over the recording.

    Returns:
        Figures as SVG.
    """
    signals, name = runs[0].channels["recorded"].keys(), runs[0].run
    plan = {"x_m", "y_m"} <= signals
    found, panels = [], []
    if plan:
        part = "the free run"
        if len(runs) > 1:
            part = "the whole recording"
        found.append(figure([plan_view(runs)], f"{name}: {part}"))
        panels.append(_error_panel(runs, "position"))
    if plan and len(runs) > 1:
        worst = max(runs, key=lambda r: _largest_error(r, "position"))
        title = f"{name}: largest error of the retuned vessel, {_span(worst)}"
        found.append(figure([plan_view([worst])], title))
    if "phi_rad" in signals:
        worst = part_with_largest_error(
            max(runs, key=lambda r: _largest_error(r, "phi_rad")), "phi_rad"
        )
        title = f"{name}: roll, largest error of the retuned vessel, {_span(worst)}"
        found.append(figure([signal_panel([worst], "phi_rad")], title, wide=True))
    for signal in SIGNALS:
        if signal in signals:
            panels.append(_error_panel(runs, signal))
    found.append(figure(panels, f"{name}: error of the free runs", wide=True))
    return found


def _largest_error(run: FreeRun, signal: str) -> float:
    """Return the largest error of the recalibrated vessel in a free run [SI]."""
    return float(np.nanmax(np.abs(model_error(run, "recalibrated", signal)), initial=0.0))


def _span(run: FreeRun) -> str:
    return f"{run.t[0]:.4g} to {run.t[-1]:.4g}\u00a0s"


def part_with_largest_error(run: FreeRun, signal: str) -> FreeRun:
    """Return the part of a simulation around the largest error of the recalibrated vessel model.

    It contains a few oscillations of a signal; more could not be distinguished in a figure.

    Args:
        run: A free run (simulation with recorded commands alone).
        signal: The oscillating signal.
    """
    recorded = np.nan_to_num(run.channels["recorded"][signal])
    crossings = np.flatnonzero(np.diff(np.sign(recorded - recorded.mean())))
    edges = np.concatenate([[0], crossings, [len(recorded) - 1]])
    if len(edges) <= MOST_CROSSINGS + 1:
        return run
    worst = int(np.nanargmax(np.abs(model_error(run, "recalibrated", signal))))
    middle = np.searchsorted(edges, worst) - MOST_CROSSINGS // 2
    first = int(np.clip(middle, 0, len(edges) - MOST_CROSSINGS - 1))
    rows = slice(int(edges[first]), int(edges[first + MOST_CROSSINGS]) + 1)
    channels = {}
    for model, signals in run.channels.items():
        channels[model] = {name: values[rows] for name, values in signals.items()}
    t = run.t[rows]
    return FreeRun(run.run, float(t[0]), t, channels)


def term_figure(written: FittedTerm) -> str:
    """Draw the force of a symbolic term over the variable it depends on, with the recorded means.

    Args:
        written: A term that has a curve.

    Returns:
        The figure as SVG.
    """
    c = written.curve
    assert c is not None
    unit, axis = term_unit(written.term), term_axis(written.term)
    name, factor = ("%", 100.0)
    if unit:
        name, factor = convenient_unit(unit, float(np.max(np.abs(c.law))))
    law, sd, found = factor * c.law, factor * c.sd, factor * c.found
    band = (c.x, law - BAND * sd, law + BAND * sd)
    along = abscissa_label(c.over)
    first, last = float(c.x[0]), float(c.x[-1])
    panel = Panel(
        f"{axis} [{name}]",
        (Line("recorded", c.x, found, "recorded"), Line("patched", c.x, law, "formula")),
        (first, last),
        axis_limits([*band[1:], found]),
        along,
        band,
        about=f"The formula over {along}, from {format_number(first)} to {format_number(last)}, "
        "and the recorded means.",
    )
    return figure([panel], f"{capitalize(axis_force_words(axis))}, over {along}", wide=True)


def group_by_recording(free_runs: Sequence[FreeRun]) -> list[list[FreeRun]]:
    """Group consecutive free runs (simulations with recorded commands alone) by their recording."""
    return [list(group) for _, group in groupby(free_runs, key=lambda r: r.run)]


def model_names_in(run: FreeRun) -> list[str]:
    """Return the names of the vessel models that a free run simulates, in drawing order."""
    return [m for m in MODELS if m in run.channels]


def model_error(run: FreeRun, model: str, signal: str) -> Array:
    """Return the error over time of a vessel model's simulation of a recording.

    Args:
        run: Free run (simulation with recorded commands alone).
        model: Its model.
        signal: Name of a signal, or "position" for the distance from the recording.

    Returns:
        Error (N,) [SI].
    """
    ours, theirs = run.channels[model], run.channels["recorded"]
    if signal == "position":
        return np.hypot(ours["x_m"] - theirs["x_m"], ours["y_m"] - theirs["y_m"])
    return ours[signal] - theirs[signal]


def plan_view(runs: Sequence[FreeRun], models: Sequence[str] = ()) -> Panel:
    """Draw the recorded and the simulated paths seen from above, x up and y to the right, to scale.

    Args:
        runs: Free runs over one recording.
        models: Models to draw; all of them if none is given.
    """
    lines, across, up = [], [], []
    for model in ("recorded", *(models or model_names_in(runs[0]))):
        for r in runs:
            path = r.channels[model]
            lines.append(Line(model, path["y_m"], path["x_m"], MODEL_WORDS[model], r.t))
            if model != "nominal":
                across.append(path["y_m"])
                up.append(path["x_m"])
    left, right = axis_limits(across, False)
    bottom, top = axis_limits(up, False)
    height = max(top - bottom, (right - left) / SQUARE)
    return Panel(
        "x, forward or north [m]",
        tuple(lines),
        _centred(left, right, SQUARE * height),
        _centred(bottom, top, height),
        "y, to starboard or east [m]",
        shape=SQUARE,
        about="Path seen from above: the recording and the free runs of each model.",
    )


def _centred(low: float, high: float, size: float) -> tuple[float, float]:
    """Return limits of this size about the same centre."""
    return (low + high) / 2 - size / 2, (low + high) / 2 + size / 2


def _error_panel(runs: Sequence[FreeRun], signal: str) -> Panel:
    """Return the errors of the free runs over time; a far larger one of the nominal is cut off."""
    errors, largest = {}, {}
    for model in model_names_in(runs[0]):
        errors[model] = [model_error(r, model, signal) for r in runs]
        largest[model] = float(np.nanmax(np.abs(np.concatenate(errors[model])), initial=0.0))
    others = max(largest.get("recalibrated", 0.0), largest.get("patched", 0.0))
    cut_off = bool(others) and largest.get("nominal", 0.0) > OFF_SCALE * others
    kept = [m for m in errors if m != "nominal" or not cut_off]
    words, si = ("position", "m")
    if signal != "position":
        words, si = SIGNALS[signal], _si(signal)
    unit, factor = convenient_unit(si, max(largest[m] for m in kept))
    title, lines, drawn, sizes = f"error in {words} [{unit}]", [], [], []
    for model, found in errors.items():
        sizes.append(f"{MODEL_WORDS[model]} {format_number(factor * largest[model])} {unit}")
        for r, e in zip(runs, found, strict=True):
            lines.append(Line(model, r.t, factor * e, MODEL_WORDS[model]))
            if model in kept:
                drawn.append(factor * e)
    if cut_off:
        title += f"; before: up to {format_number(factor * largest['nominal'])}, outside the figure"
    about = f"Largest error in {words}: {', '.join(sizes)}"
    x = float(runs[0].t[0]), float(runs[-1].t[-1])
    return Panel(title, tuple(lines), x, axis_limits(drawn), "time [s]", about=about)


def signal_panel(runs: Sequence[FreeRun], signal: str, models: Sequence[str] = ()) -> Panel:
    """Draw a recorded signal and its simulations over time.

    Args:
        runs: Free runs over one recording.
        signal: The signal.
        models: Models to draw; all of them if none is given.
    """
    unit, factor = unit_for_signal(signal, runs)
    lines, drawn = [], []
    for model in ("recorded", *(models or model_names_in(runs[0]))):
        for r in runs:
            lines.append(Line(model, r.t, factor * r.channels[model][signal], MODEL_WORDS[model]))
            if model != "nominal":
                drawn.append(lines[-1].y)
    return Panel(
        f"{SIGNALS[signal]} [{unit}]",
        tuple(lines),
        (float(runs[0].t[0]), float(runs[-1].t[-1])),
        axis_limits(drawn),
        "time [s]",
        about=f"{SIGNALS[signal]} over time: the recording and the free runs of each model",
    )


def unit_for_signal(signal: str, runs: Sequence[FreeRun]) -> tuple[str, float]:
    """Return a convenient unit in which to draw a signal, and the factor to it from the SI unit.

    It suits the size of the recorded values.

    Args:
        signal: The signal.
        runs: Free runs over one recording.
    """
    largest = 0.0
    for r in runs:
        recorded = np.abs(r.channels["recorded"][signal])
        largest = max(largest, float(np.nanmax(recorded, initial=0.0)))
    return convenient_unit(_si(signal), largest)


def _si(signal: str) -> str:
    if signal.endswith("_rad"):
        return "rad"
    return "m"
