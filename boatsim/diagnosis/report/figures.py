"""What the report draws: missing forces, free runs and their errors, described laws."""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.description import Written
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.report.described_terms import axis_of, over_words, share_or_force, what_of
from boatsim.diagnosis.report.findings import Missing
from boatsim.diagnosis.report.formatting import capital, handy, number
from boatsim.diagnosis.report.schema import IntervalEntry
from boatsim.diagnosis.report.svg_plots import SQUARE, Line, Panel, figure, limits
from boatsim.physics.base import Array

SWINGS = 14  # zero crossings of roll that are drawn
BAND = 2.0  # [sd] zero outside this band counts as missing
SIGNALS = {"psi_rad": "heading", "phi_rad": "roll", "theta_rad": "pitch", "z_m": "heave"}

Intervals = Sequence[IntervalEntry]


def missing_figures(
    runs: Sequence[Missing], intervals: Intervals, shared: Sequence[Missing]
) -> list[str]:
    """One figure per run: the missing force of each axis over time, one scale per axis for all of `shared`."""
    scales = {}
    for axis in shared[0].force if shared else ():
        parts = [
            v
            for m in shared
            for v in (m.force[axis] + BAND * m.sd[axis], m.force[axis] - BAND * m.sd[axis])
        ]
        unit, factor = handy(shared[0].unit[axis], max(float(np.nanmax(np.abs(v))) for v in parts))
        scales[axis] = limits([factor * v for v in parts]), unit, factor
    return [
        figure(
            [_missing_panel(m, axis, intervals, *scales[axis]) for axis in m.force],
            m.run,
            wide=len(runs) == 1,
        )
        for m in runs
    ]


def _missing_panel(
    m: Missing, axis: str, intervals: Intervals, y: tuple[float, float], unit: str, factor: float
) -> Panel:
    flags = tuple(
        (i["from_s"], i["to_s"]) for i in intervals if (i["run"], i["axis"]) == (m.run, axis)
    )
    force, sd = factor * m.force[axis], factor * m.sd[axis]
    lines = [Line("missing", m.t, force, "missing")]
    if axis in m.left:
        lines.append(Line("left", m.t, factor * m.left[axis], "left in the patched vessel"))
    rms = number(float(np.sqrt(np.nanmean(force**2))))
    about = f"Missing force in {axis} over {m.run}: rms {rms} {unit}; flagged in {len(flags)} intervals."
    band, x = (m.t, force - BAND * sd, force + BAND * sd), (float(m.t[0]), float(m.t[-1]))
    kind = "force" if axis in ("surge", "sway", "heave") else "moment"
    return Panel(
        f"{axis} {kind} [{unit}]", tuple(lines), x, y, "time [s]", band, flags, about=about
    )


def free_run_figures(runs: Sequence[FreeRun]) -> list[str]:
    """Figures of one unseen recording: where the boat went and where each model went, then the errors over time."""
    signals = runs[0].channels["recorded"]
    name = runs[0].run
    found = []
    if {"x_m", "y_m"} <= signals.keys():
        whole = "the whole of it" if len(runs) > 1 else "the free run"
        found.append(figure([plan_view(runs)], f"{name}: {whole}"))
        if len(runs) > 1:
            worst = max(
                runs, key=lambda r: float(np.nanmax(position_error(r, "recalibrated"), initial=0.0))
            )
            where = f"{worst.t[0]:.4g} to {worst.t[-1]:.4g}\u00a0s"
            found.append(
                figure(
                    [plan_view([worst])], f"{name}: where the recalibrated boat errs most, {where}"
                )
            )
    errors = [_error_panel(runs, "position")] if {"x_m", "y_m"} <= signals.keys() else []
    errors += [_error_panel(runs, s) for s in SIGNALS if s in signals]
    if "phi_rad" in signals:
        worst = max(
            runs,
            key=lambda r: float(
                np.nanmax(np.abs(error_of(r, "recalibrated", "phi_rad")), initial=0.0)
            ),
        )
        look = closer(worst, "phi_rad")
        where = f"{look.t[0]:.4g} to {look.t[-1]:.4g}\u00a0s"
        title = f"{name}: roll, where the recalibrated boat errs most, {where}"
        found.append(figure([course_of([look], "phi_rad")], title, wide=True))
    found.append(figure(errors, f"{name}: error of the free runs", wide=True))
    return found


def closer(run: FreeRun, signal: str) -> FreeRun:
    """The few swings of a signal about the largest error of the recalibrated boat: more of them only make a comb."""
    recorded = np.nan_to_num(run.channels["recorded"][signal])
    crossings = np.flatnonzero(np.diff(np.sign(recorded - recorded.mean())))
    edges = np.concatenate([[0], crossings, [len(recorded) - 1]])
    if len(edges) <= SWINGS + 1:
        return run
    worst = int(np.nanargmax(np.abs(error_of(run, "recalibrated", signal))))
    first = int(np.clip(np.searchsorted(edges, worst) - SWINGS // 2, 0, len(edges) - SWINGS - 1))
    begin, end = int(edges[first]), int(edges[first + SWINGS]) + 1
    channels = {m: {n: v[begin:end] for n, v in c.items()} for m, c in run.channels.items()}
    return FreeRun(run.run, float(run.t[begin]), run.t[begin:end], channels)


def law_figure(written: Written) -> str:
    """A described term over what it goes with, and the means of what was recorded there."""
    c = written.curve
    assert c is not None
    unit = share_or_force(written.term)
    name, factor = ("%", 100.0) if not unit else handy(unit, float(np.max(np.abs(c.law))))
    law, sd, found = factor * c.law, factor * c.sd, factor * c.found
    band = (c.x, law - BAND * sd, law + BAND * sd)
    along = over_words(c.over)
    about = f"The law over {along}, from {number(float(c.x[0]))} to {number(float(c.x[-1]))}, beside what was recorded."
    lines = (
        Line("recorded", c.x, found, "what was recorded"),
        Line("patched", c.x, law, "the law"),
    )
    title = f"{axis_of(written.term)} [{name}]"
    panel = Panel(
        title,
        lines,
        (float(c.x[0]), float(c.x[-1])),
        limits([*band[1:], found]),
        along,
        band,
        about=about,
    )
    return figure([panel], f"{capital(what_of(axis_of(written.term)))}, over {along}", wide=True)


def models_in(run: FreeRun) -> list[str]:
    """The boats that were run freely, in the order they are drawn (the last on top)."""
    return [m for m in ("nominal", "recalibrated", "patched") if m in run.channels]


def position_error(run: FreeRun, model: str) -> Array:
    """Distance (M,) [m] between a model and the recording."""
    ours, theirs = run.channels[model], run.channels["recorded"]
    return np.hypot(ours["x_m"] - theirs["x_m"], ours["y_m"] - theirs["y_m"])


def error_of(run: FreeRun, model: str, signal: str) -> Array:
    """Error (M,) of a signal, or of "position" (its distance), in SI units."""
    if signal == "position":
        return position_error(run, model)
    return run.channels[model][signal] - run.channels["recorded"][signal]


def plan_view(runs: Sequence[FreeRun], models: Sequence[str] = ()) -> Panel:
    """Seen from above, x up and y to the right, both to one scale; all models unless some are given."""
    models = ["recorded", *(models or models_in(runs[0]))]
    lines = [
        Line(m, r.channels[m]["y_m"], r.channels[m]["x_m"], t=r.t) for m in models for r in runs
    ]
    shown = [line for line in lines if line.look != "nominal"]
    across, up = limits([v.x for v in shown], False), limits([v.y for v in shown], False)
    height = max(up[1] - up[0], (across[1] - across[0]) / SQUARE)
    x, y = (
        ((a + b) / 2 - size / 2, (a + b) / 2 + size / 2)
        for (a, b), size in ((across, SQUARE * height), (up, height))
    )
    about = "Path seen from above: the recording and the free runs of each boat."
    return Panel(
        "x, forward or north [m]",
        tuple(lines),
        x,
        y,
        "y, to starboard or east [m]",
        shape=SQUARE,
        about=about,
    )


def _error_panel(runs: Sequence[FreeRun], signal: str) -> Panel:
    """Errors of the free runs over time; the nominal boat may leave the scale of the others, and it is said."""
    errors = {m: [error_of(r, m, signal) for r in runs] for m in models_in(runs[0])}
    largest = {
        m: max(float(np.nanmax(np.abs(e), initial=0.0)) for e in found)
        for m, found in errors.items()
    }
    others = max((v for m, v in largest.items() if m != "nominal"), default=0.0)
    kept = {
        m: e
        for m, e in errors.items()
        if m != "nominal" or largest[m] <= 2.5 * others or not others
    }
    unit, factor = handy(
        "m" if signal == "position" else _si(signal), max(largest[m] for m in kept)
    )
    lines = tuple(
        Line(m, r.t, factor * e)
        for m, found in errors.items()
        for r, e in zip(runs, found, strict=True)
    )
    left = (
        ""
        if "nominal" in kept
        else f"; nominal up to {number(factor * largest['nominal'])}, out of the picture"
    )
    y = limits([factor * e for found in kept.values() for e in found])
    words = "position" if signal == "position" else SIGNALS[signal]
    x = float(runs[0].t[0]), float(runs[-1].t[-1])
    about = f"Largest error in {words}: " + ", ".join(
        f"{m} {number(factor * v)} {unit}" for m, v in largest.items()
    )
    return Panel(f"error in {words} [{unit}]{left}", lines, x, y, "time [s]", about=about)


def course_of(runs: Sequence[FreeRun], signal: str, models: Sequence[str] = ()) -> Panel:
    """A signal over time, of all models unless some are given."""
    models = ["recorded", *(models or models_in(runs[0]))]
    unit, factor = in_unit(signal, runs)
    lines = tuple(Line(m, r.t, factor * r.channels[m][signal]) for m in models for r in runs)
    x = float(runs[0].t[0]), float(runs[-1].t[-1])
    y = limits([v.y for v in lines if v.look != "nominal"])
    about = f"{SIGNALS[signal]} over time: the recording and the free runs of each boat"
    return Panel(f"{SIGNALS[signal]} [{unit}]", lines, x, y, "time [s]", about=about)


def in_unit(signal: str, runs: Sequence[FreeRun]) -> tuple[str, float]:
    """A handy unit of what was recorded of a signal, and the factor to it from SI units."""
    largest = max(
        (float(np.nanmax(np.abs(r.channels["recorded"][signal]), initial=0.0)) for r in runs),
        default=0.0,
    )
    return handy(_si(signal), largest)


def _si(signal: str) -> str:
    return "rad" if signal.endswith("_rad") else "m"
