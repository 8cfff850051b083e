"""Curves of the report as small inline pictures that take the page's colours and width.

Lines are SVG stretched to the page, numbers beside them are text of the page: sharp and readable at every width, in
light and dark and on paper, at a few bytes a point and a millisecond a figure.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnose.description import Written
from boatsim.diagnose.free_runs import FreeRun
from boatsim.diagnose.report.described import axis_of, over_words, share_or_force, what_of
from boatsim.diagnose.report.entries import IntervalEntry
from boatsim.diagnose.report.findings import Missing
from boatsim.diagnose.report.words import capital, handy, number
from boatsim.physics.base import Array

GRID = 2000  # units of the drawing along each edge; whole ones are finer than a pixel
POINTS = 500  # of a line; more are not seen
SWINGS = 14  # zero crossings of roll that are drawn
BAND = 2.0  # [sd] zero outside this band counts as missing
TIMES, SQUARE = 3.2, 1.25  # width of a curve over time and of a map by its height
SIGNALS = {"psi_rad": "heading", "phi_rad": "roll"}


@dataclass(frozen=True)
class Line:
    """One curve; `look` is a class of the page's style sheet."""

    look: str
    x: Array
    y: Array


@dataclass(frozen=True)
class Panel:
    """One set of axes."""

    title: str
    lines: tuple[Line, ...]
    x: tuple[float, float]  # limits
    y: tuple[float, float]
    x_label: str = ""
    band: tuple[Array, Array, Array] | None = None  # x, low, high
    flags: tuple[tuple[float, float], ...] = ()  # stretches of x to shade
    shape: float = TIMES
    about: str = ""  # what a reader who can not see it is told


def legend(looks: Mapping[str, str]) -> str:
    """Line or area samples with their words, by look."""
    shapes = {look: "M0 3H28V13H0Z" if look in ("band", "flag") else "M0 8H28" for look in looks}
    items = (
        f'<li><svg class="key" viewBox="0 0 28 16" aria-hidden="true"><path class="{look}" d="{shapes[look]}"/></svg>'
        f"{escape(words)}</li>"
        for look, words in looks.items()
    )
    return f'<ul class="legend">{"".join(items)}</ul>'


def figure(panels: Sequence[Panel], title: str, wide: bool = False) -> str:
    """Panels under one another with a title; they share x, so the last one carries its numbers."""
    parts = "".join(_panel(p, p is panels[-1]) for p in panels)
    look = "chart wide" if wide else "chart"
    return f'<figure class="{look}"><figcaption>{escape(title)}</figcaption>{parts}</figure>'


def _panel(p: Panel, numbered: bool) -> str:
    """Title, drawing, and the numbers at their share of its width and height."""
    places = [(v, (v - p.x[0]) / (p.x[1] - p.x[0])) for v in ticks(*p.x, 6)]
    heights = [(v, (v - p.y[0]) / (p.y[1] - p.y[0])) for v in ticks(*p.y, 5)]
    drawn = [f'<path class="flag" d="{_box(p, a, b)}"/>' for a, b in p.flags]
    grid = "".join(f"M0 {GRID * (1 - s):.0f}H{GRID}" for _, s in heights)
    grid += "".join(f"M{GRID * s:.0f} 0V{GRID}" for _, s in places)
    drawn.append(f'<path class="grid" d="{grid}"/>')
    if p.y[0] < 0.0 < p.y[1] and p.shape == TIMES:
        drawn.append(f'<path class="zero" d="M0 {GRID * p.y[1] / (p.y[1] - p.y[0]):.0f}H{GRID}"/>')
    if p.band:
        drawn.append(f'<path class="band" d="{_area(p, *p.band)}"/>')
    drawn += [f'<path class="line {line.look}" d="{_curve(p, line)}"/>' for line in p.lines]
    marks = "".join(f'<span class="y" style="bottom:{100 * s:.1f}%">{_tick(v)}</span>' for v, s in heights)
    if numbered:
        marks += "".join(f'<span class="x" style="left:{100 * s:.1f}%">{_tick(v)}</span>' for v, s in places)
    below = f'<p class="along">{escape(p.x_label)}</p>' if numbered else ""
    look = "plot numbered" if numbered else "plot"
    return (
        f'<p class="across">{escape(p.title)}</p><div class="{look}" style="--shape:{p.shape:g}">'
        f'<svg viewBox="0 0 {GRID} {GRID}" preserveAspectRatio="none" role="img" '
        f'aria-label="{escape(p.about or p.title)}">{"".join(drawn)}</svg>{marks}</div>{below}'
    )


def _place(p: Panel, x: Array, y: Array) -> list[list[int]]:
    """Drawing coordinates; what is far outside is put just outside."""
    across = GRID * (np.asarray(x) - p.x[0]) / (p.x[1] - p.x[0])
    down = GRID * (p.y[1] - np.asarray(y)) / (p.y[1] - p.y[0])
    found: list[list[int]] = np.column_stack([across, np.clip(down, -GRID, 2 * GRID)]).round().astype(int).tolist()
    return found


def _curve(p: Panel, line: Line) -> str:
    seen = np.isfinite(line.x) & np.isfinite(line.y)
    x, y = line.x[seen], line.y[seen]
    rows = thinned(y) if p.shape == TIMES else np.arange(0, len(y), 1 + len(y) // POINTS)
    return "M" + "L".join(f"{a} {b}" for a, b in _place(p, x[rows], y[rows])) if len(x) else ""


def _area(p: Panel, x: Array, low: Array, high: Array) -> str:
    rows = np.arange(0, len(x), 1 + len(x) // POINTS)
    around = _place(p, x[rows], high[rows]) + _place(p, x[rows], low[rows])[::-1]
    return "M" + "L".join(f"{a} {b}" for a, b in around) + "Z"


def _box(p: Panel, begin: float, end: float) -> str:
    a, b = (GRID * (np.clip(v, *p.x) - p.x[0]) / (p.x[1] - p.x[0]) for v in (begin, end))
    return f"M{a:.0f} 0H{b:.0f}V{GRID}H{a:.0f}Z"


def thinned(y: Array) -> NDArray[np.int64]:
    """Rows that keep the shape of a long curve: of each bucket its lowest and its highest."""
    if len(y) <= POINTS:
        return np.arange(len(y))
    edges = np.linspace(0, len(y), POINTS // 2 + 1).astype(int)
    rows = [a + f(y[a:b]) for a, b in pairwise(edges) for f in (np.argmin, np.argmax)]
    return np.unique(np.array([0, *rows, len(y) - 1]))


def ticks(low: float, high: float, most: int) -> list[float]:
    """At most about `most` round numbers within the limits."""
    rough = (high - low) / most
    power = 10.0 ** np.floor(np.log10(rough))
    step = float(power * next(s for s in (1.0, 2.0, 5.0, 10.0) if s * power >= rough * (1 - 1e-9)))
    return [float(k * step) for k in range(int(np.ceil(low / step - 1e-9)), int(np.floor(high / step + 1e-9)) + 1)]


def _tick(value: float) -> str:
    return f"{value:.10g}".replace("-", "−") if abs(value) < 1e6 else number(value)


def limits(values: Sequence[Array], zero: bool = True) -> tuple[float, float]:
    """Limits with a little air around finite values."""
    every = np.concatenate([np.asarray(v, float).ravel() for v in values] or [np.zeros(1)])
    every = every[np.isfinite(every)]
    low, high = (float(every.min()), float(every.max())) if len(every) else (0.0, 1.0)
    if zero:
        low, high = min(low, 0.0), max(high, 0.0)
    air = 0.06 * (high - low) or max(abs(high), 1e-9)
    return (low - air if low < 0.0 or not zero else low), high + air


Intervals = Sequence[IntervalEntry]


def missing_figures(runs: Sequence[Missing], intervals: Intervals, shared: Sequence[Missing]) -> list[str]:
    """One figure per run: the missing force of each axis over time, one scale per axis for all of `shared`."""
    scales = {}
    for axis in shared[0].force if shared else ():
        parts = [v for m in shared for v in (m.force[axis] + BAND * m.sd[axis], m.force[axis] - BAND * m.sd[axis])]
        unit, factor = handy(shared[0].unit[axis], max(float(np.nanmax(np.abs(v))) for v in parts))
        scales[axis] = limits([factor * v for v in parts]), unit, factor
    return [
        figure([_missing_panel(m, axis, intervals, *scales[axis]) for axis in m.force], m.run, wide=len(runs) == 1)
        for m in runs
    ]


def _missing_panel(
    m: Missing, axis: str, intervals: Intervals, y: tuple[float, float], unit: str, factor: float
) -> Panel:
    flags = tuple((i["from_s"], i["to_s"]) for i in intervals if (i["run"], i["axis"]) == (m.run, axis))
    force, sd = factor * m.force[axis], factor * m.sd[axis]
    lines = [Line("missing", m.t, force)] + ([Line("left", m.t, factor * m.left[axis])] if axis in m.left else [])
    rms = number(float(np.sqrt(np.nanmean(force**2))))
    about = f"Missing force in {axis} over {m.run}: rms {rms} {unit}; flagged in {len(flags)} intervals."
    band, x = (m.t, force - BAND * sd, force + BAND * sd), (float(m.t[0]), float(m.t[-1]))
    kind = "force" if axis in ("surge", "sway") else "moment"
    return Panel(f"{axis} {kind} [{unit}]", tuple(lines), x, y, "time [s]", band, flags, about=about)


def free_run_figures(runs: Sequence[FreeRun]) -> list[str]:
    """Figures of one unseen recording: where the boat went and where each model went, then the errors over time."""
    signals = runs[0].channels["recorded"]
    name = runs[0].run
    found = []
    if {"x_m", "y_m"} <= signals.keys():
        whole = "the whole of it" if len(runs) > 1 else "the free run"
        found.append(figure([_map(runs)], f"{name}: {whole}"))
        if len(runs) > 1:
            worst = max(runs, key=lambda r: float(np.nanmax(position_error(r, "recalibrated"), initial=0.0)))
            where = f"{worst.t[0]:.4g} to {worst.t[-1]:.4g}\u00a0s"
            found.append(figure([_map([worst])], f"{name}: where the recalibrated boat errs most, {where}"))
    errors = [_error_panel(runs, "position")] if {"x_m", "y_m"} <= signals.keys() else []
    errors += [_error_panel(runs, s) for s in SIGNALS if s in signals]
    if "phi_rad" in signals:
        worst = max(runs, key=lambda r: float(np.nanmax(np.abs(error_of(r, "recalibrated", "phi_rad")), initial=0.0)))
        look = closer(worst, "phi_rad")
        where = f"{look.t[0]:.4g} to {look.t[-1]:.4g}\u00a0s"
        title = f"{name}: roll, where the recalibrated boat errs most, {where}"
        found.append(figure([_signal_panel([look], "phi_rad")], title, wide=True))
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
    lines = (Line("recorded", c.x, found), Line("patched", c.x, law))
    title = f"{axis_of(written.term)} [{name}]"
    panel = Panel(title, lines, (float(c.x[0]), float(c.x[-1])), limits([*band[1:], found]), along, band, about=about)
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


def _map(runs: Sequence[FreeRun]) -> Panel:
    """Seen from above, x up and y to the right, both to one scale."""
    models = ["recorded", *models_in(runs[0])]
    lines = [Line(m, r.channels[m]["y_m"], r.channels[m]["x_m"]) for r in runs for m in models]
    shown = [line for line in lines if line.look != "nominal"]
    across, up = limits([v.x for v in shown], False), limits([v.y for v in shown], False)
    height = max(up[1] - up[0], (across[1] - across[0]) / SQUARE)
    x, y = (
        ((a + b) / 2 - size / 2, (a + b) / 2 + size / 2) for (a, b), size in ((across, SQUARE * height), (up, height))
    )
    about = "Path seen from above: the recording and the free runs of each boat."
    return Panel(
        "x, forward or north [m]", tuple(lines), x, y, "y, to starboard or east [m]", shape=SQUARE, about=about
    )


def _error_panel(runs: Sequence[FreeRun], signal: str) -> Panel:
    """Errors of the free runs over time; the nominal boat may leave the scale of the others, and it is said."""
    errors = {m: [error_of(r, m, signal) for r in runs] for m in models_in(runs[0])}
    largest = {m: max(float(np.nanmax(np.abs(e), initial=0.0)) for e in found) for m, found in errors.items()}
    others = max((v for m, v in largest.items() if m != "nominal"), default=0.0)
    kept = {m: e for m, e in errors.items() if m != "nominal" or largest[m] <= 2.5 * others or not others}
    unit, factor = handy("m" if signal == "position" else "rad", max(largest[m] for m in kept))
    lines = tuple(Line(m, r.t, factor * e) for m, found in errors.items() for r, e in zip(runs, found, strict=True))
    left = "" if "nominal" in kept else f"; nominal up to {number(factor * largest['nominal'])}, out of the picture"
    y = limits([factor * e for found in kept.values() for e in found])
    words = "position" if signal == "position" else SIGNALS[signal]
    x = float(runs[0].t[0]), float(runs[-1].t[-1])
    about = f"Largest error in {words}: " + ", ".join(f"{m} {number(factor * v)} {unit}" for m, v in largest.items())
    return Panel(f"error in {words} [{unit}]{left}", lines, x, y, "time [s]", about=about)


def _signal_panel(runs: Sequence[FreeRun], signal: str) -> Panel:
    unit, factor = handy("rad", 1.0)
    models = ["recorded", *models_in(runs[0])]
    lines = tuple(Line(m, r.t, factor * r.channels[m][signal]) for r in runs for m in models)
    x = float(runs[0].t[0]), float(runs[-1].t[-1])
    y = limits([v.y for v in lines if v.look != "nominal"])
    about = f"{SIGNALS[signal]} over time: the recording and the free runs of each boat"
    return Panel(f"{SIGNALS[signal]} [{unit}]", lines, x, y, "time [s]", about=about)
