"""Curves as small inline pictures that take the page's colours and width, and tell their values under the pointer.

Lines are SVG stretched to the page, numbers beside them are text of the page: sharp and readable at every width, in
light and dark and on paper, at a few bytes a point and a millisecond a figure. The page's script reads values back from
the lines themselves, so that what is told is what is drawn.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.report.formatting import number
from boatsim.physics.base import Array

GRID = 2000  # units of the drawing along each edge; whole ones are finer than a pixel
POINTS = 500  # of a line; more are not seen
DOTS = 250  # points without a line
PIECES = 100  # stretches of a curve that are drawn each by itself; more are not told apart
FEWEST = 6  # points that a stretch keeps
TIMES, SQUARE = 3.2, 1.25  # width of a curve over time and of a map by its height


@dataclass(frozen=True)
class Line:
    """One curve; `look` is a class of the page's style sheet."""

    look: str
    x: Array
    y: Array
    name: str = ""  # what it is called under the pointer, if not as its look
    t: Array | None = None  # (N,) s, when its points were passed, where x is no time


@dataclass(frozen=True)
class Box:
    """How values are spread at one place: 5, 25, 50, 75 and 95 % lie below."""

    look: str
    x: float
    width: float
    below: tuple[float, float, float, float, float]


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
    dots: tuple[Line, ...] = ()  # points that no line joins
    boxes: tuple[Box, ...] = ()
    names: tuple[str, ...] = ()  # of x = 0, 1, 2, ..., which are then no numbers


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
    look = "chart wide" if wide else "chart"
    return (
        f'<figure class="{look}"><figcaption>{escape(title)}</figcaption>{stacked(panels)}</figure>'
    )


def stacked(panels: Sequence[Panel]) -> str:
    """Panels under one another."""
    return "".join(_panel(p, p is panels[-1]) for p in panels)


def _panel(p: Panel, numbered: bool) -> str:
    """Title, drawing, and the numbers at their share of its width and height."""
    shown = [float(i) for i in range(len(p.names))] or ticks(*p.x, 6)
    places = [(v, (v - p.x[0]) / (p.x[1] - p.x[0])) for v in shown]
    heights = [(v, (v - p.y[0]) / (p.y[1] - p.y[0])) for v in ticks(*p.y, 5)]
    drawn = [f'<path class="flag" d="{_box(p, a, b)}"/>' for a, b in p.flags]
    grid = "".join(f"M0 {GRID * (1 - s):.0f}H{GRID}" for _, s in heights)
    grid += "".join(f"M{GRID * s:.0f} 0V{GRID}" for _, s in places)
    drawn.append(f'<path class="grid" d="{grid}"/>')
    if p.y[0] < 0.0 < p.y[1] and p.shape == TIMES:
        drawn.append(f'<path class="zero" d="M0 {GRID * p.y[1] / (p.y[1] - p.y[0]):.0f}H{GRID}"/>')
    if p.band:
        drawn.append(f'<path class="band" d="{_area(p, *p.band)}"/>')
    drawn += [_dots(p, dots) for dots in p.dots] + [_boxed(p, box) for box in p.boxes]
    for look in dict.fromkeys(line.look for line in p.lines):
        pieces = _pieces([line for line in p.lines if line.look == look])
        most = POINTS if len(pieces) == 1 else max(FEWEST, 2 * POINTS // len(pieces))
        drawn += [_curve(p, line, most) for line in pieces]
    marks = "".join(
        f'<span class="y" style="bottom:{100 * s:.1f}%">{_tick(v)}</span>' for v, s in heights
    )
    if numbered:
        marks += "".join(
            f'<span class="x" style="left:{100 * s:.1f}%">{_named(p, v)}</span>' for v, s in places
        )
    below = f'<p class="along">{escape(p.x_label)}</p>' if numbered else ""
    look = "plot numbered" if numbered else "plot"
    return (
        f'<p class="across">{escape(p.title)}</p><div class="{look}" style="--shape:{p.shape:g}" '
        f'data-x="{p.x[0]:.9g} {p.x[1]:.9g}" data-y="{p.y[0]:.9g} {p.y[1]:.9g}" '
        f'data-across="{escape(p.x_label)}" data-up="{escape(p.title)}">'
        f'<svg viewBox="0 0 {GRID} {GRID}" preserveAspectRatio="none" role="img" '
        f'aria-label="{escape(p.about or p.title)}">{"".join(drawn)}</svg>{marks}</div>{below}'
    )


def _pieces(lines: Sequence[Line]) -> Sequence[Line]:
    """The stretches of a curve; in one where they are more than can be told apart."""
    if len(lines) <= PIECES:
        return lines
    x, y = (np.concatenate([getattr(line, n) for line in lines]) for n in "xy")
    times = [line.t for line in lines if line.t is not None]
    return [replace(lines[0], x=x, y=y, t=np.concatenate(times) if times else None)]


def _place(p: Panel, x: Array, y: Array) -> list[list[int]]:
    """Drawing coordinates; what is far outside is put just outside."""
    across = GRID * (np.asarray(x) - p.x[0]) / (p.x[1] - p.x[0])
    down = GRID * (p.y[1] - np.asarray(y)) / (p.y[1] - p.y[0])
    places = np.column_stack([np.clip(across, -GRID, 2 * GRID), np.clip(down, -GRID, 2 * GRID)])
    found: list[list[int]] = places.round().astype(int).tolist()
    return found


def _curve(p: Panel, line: Line, most: int) -> str:
    seen = np.isfinite(line.x) & np.isfinite(line.y)
    x, y = line.x[seen], line.y[seen]
    rows = thinned(y, most) if p.shape == TIMES else every(len(y), most)
    d = "M" + "L".join(f"{a} {b}" for a, b in _place(p, x[rows], y[rows])) if len(x) else ""
    told = f' data-name="{escape(line.name)}"' if line.name else ""
    if line.t is not None:
        told += f' data-t="{" ".join(f"{t:.6g}" for t in line.t[seen][rows])}"'
    return f'<path class="line {line.look}" d="{d}"{told}/>'


def _dots(p: Panel, dots: Line) -> str:
    seen = np.isfinite(dots.x) & np.isfinite(dots.y)
    x, y = dots.x[seen], dots.y[seen]
    rows = every(len(y), DOTS)
    return f'<path class="dots {dots.look}" d="{"".join(f"M{a} {b}h0" for a, b in _place(p, x[rows], y[rows]))}"/>'


def _boxed(p: Panel, box: Box) -> str:
    """A box for the middle half, a stroke for the median, whiskers."""
    sides = np.array([box.x - box.width / 2, box.x, box.x + box.width / 2])
    places = _place(p, sides[[0, 1, 2, 0, 0]], np.array(box.below))
    (left, low), (middle, lower), (right, half), (_, upper), (_, high) = places
    d = f"M{middle} {low}V{lower}M{middle} {upper}V{high}M{left} {lower}H{right}V{upper}H{left}ZM{left} {half}H{right}"
    return f'<path class="box {box.look}" d="{d}"/>'


def _named(p: Panel, value: float) -> str:
    return escape(p.names[int(value)]) if p.names else _tick(value)


def _area(p: Panel, x: Array, low: Array, high: Array) -> str:
    rows = every(len(x), POINTS)
    around = _place(p, x[rows], high[rows]) + _place(p, x[rows], low[rows])[::-1]
    return "M" + "L".join(f"{a} {b}" for a, b in around) + "Z"


def _box(p: Panel, begin: float, end: float) -> str:
    a, b = (GRID * (np.clip(v, *p.x) - p.x[0]) / (p.x[1] - p.x[0]) for v in (begin, end))
    return f"M{a:.0f} 0H{b:.0f}V{GRID}H{a:.0f}Z"


def thinned(y: Array, most: int = POINTS) -> NDArray[np.int64]:
    """Rows that keep the shape of a long curve: of each bucket its lowest and its highest."""
    if len(y) <= most:
        return np.arange(len(y))
    edges = np.linspace(0, len(y), max(1, most // 2) + 1).astype(int)
    rows = [a + f(y[a:b]) for a, b in pairwise(edges) for f in (np.argmin, np.argmax)]
    return np.unique(np.array([0, *rows, len(y) - 1]))


def every(rows: int, most: int) -> NDArray[np.int64]:
    """At most about so many of the rows, evenly, the last among them."""
    return np.unique(np.append(np.arange(0, rows, 1 + rows // most), max(rows - 1, 0)))[:rows]


def ticks(low: float, high: float, most: int) -> list[float]:
    """At most about `most` round numbers within the limits."""
    rough = (high - low) / most
    power = 10.0 ** np.floor(np.log10(rough))
    step = float(power * next(s for s in (1.0, 2.0, 5.0, 10.0) if s * power >= rough * (1 - 1e-9)))
    return [
        float(k * step)
        for k in range(int(np.ceil(low / step - 1e-9)), int(np.floor(high / step + 1e-9)) + 1)
    ]


def _tick(value: float) -> str:
    return f"{value:.10g}".replace("-", "−") if abs(value) < 1e6 else number(value)


def limits(values: Sequence[Array], zero: bool = True) -> tuple[float, float]:
    """Limits with a little air around finite values."""
    found = np.concatenate([np.asarray(v, float).ravel() for v in values] or [np.zeros(1)])
    found = found[np.isfinite(found)]
    low, high = (float(found.min()), float(found.max())) if len(found) else (0.0, 1.0)
    if zero:
        low, high = min(low, 0.0), max(high, 0.0)
    air = 0.06 * (high - low) or max(abs(high), 1e-9)
    return (low - air if low < 0.0 or not zero else low), high + air
