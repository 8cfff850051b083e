"""Plots as inline SVG that take the colours and the width of the page.

Lines are SVG that is stretched to the page; numbers are text of the page, so that both are sharp at
every width, in light and dark and on paper. The script of the page reads the values under the
pointer back from the lines.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.view.formatting import format_number

GRID = 2000  # units of the drawing along each edge; one is finer than a pixel
POINTS = 500  # of a line; more are not visible
DOTS = 250  # most points of a scatter plot
MARGIN = 0.06  # of the range of the values, on each side of an axis
STRIP = 0.04  # height of the strip that marks an interval, relative to that of the panel
MOST_PIECES = 100  # pieces of a curve that are drawn separately
FEWEST_POINTS = 6  # of a piece
SHAPES = {"band": "M0 3H28V13H0Z", "flag": "M0 6H28V10H0Z"}  # in the legend; others: a line
TIMES, SQUARE = 3.2, 1.25  # ratio of width to height of a plot over time and of a map


@dataclass(frozen=True)
class Line:
    """One curve of a plot.

    Attributes:
        look: Class of the style sheet.
        x: Abscissae (N,).
        y: Ordinates (N,).
        name: Name under the pointer; "" for the class of the style sheet.
        t: Times (N,) [s] of the points, if the abscissa is no time.
    """

    look: str
    x: Array
    y: Array
    name: str = ""
    t: Array | None = None


@dataclass(frozen=True)
class Box:
    """A box of a box plot, drawn at the abscissa `x`.

    The array `below` holds the 5, 25, 50, 75 and 95 % quantiles of the values.
    """

    look: str
    x: float
    width: float
    below: tuple[float, float, float, float, float]


@dataclass(frozen=True)
class Panel:
    """One set of axes of an SVG plot, with its curves, points, bands and labels.

    Attributes:
        title: Label of the ordinate.
        lines: Curves.
        x: Limits of the abscissa.
        y: Limits of the ordinate.
        x_label: Label of the abscissa.
        band: Abscissae, lower and upper limits of a band.
        flags: Intervals of the abscissa to mark by a strip at the upper edge, above all curves.
        shape: Ratio of width to height.
        about: Description for readers who cannot see the plot.
        dots: Points without a line.
        boxes: Box plots.
        names: Labels of the abscissae 0, 1, 2, ... in the place of numbers.
    """

    title: str
    lines: tuple[Line, ...]
    x: tuple[float, float]
    y: tuple[float, float]
    x_label: str = ""
    band: tuple[Array, Array, Array] | None = None
    flags: tuple[tuple[float, float], ...] = ()
    shape: float = TIMES
    about: str = ""
    dots: tuple[Line, ...] = ()
    boxes: tuple[Box, ...] = ()
    names: tuple[str, ...] = ()


def legend(looks: Mapping[str, str]) -> str:
    """Return the legend of a report's figures as mark-up.

    Args:
        looks: Words of the legend by class of the style sheet.
    """
    items = []
    for look, words in looks.items():
        shape = SHAPES.get(look, "M0 8H28")
        items.append(
            '<li><svg class="key" viewBox="0 0 28 16" aria-hidden="true">'
            f'<path class="{look}" d="{shape}"/></svg>{escape(words)}</li>'
        )
    return f'<ul class="legend">{"".join(items)}</ul>'


def figure(
    panels: Sequence[Panel], title: str, wide: bool = False, key: Mapping[str, str] | None = None
) -> str:
    """Return a titled SVG figure of panels below each other, which share their abscissa.

    Args:
        panels: The panels; the last one has the numbers of the abscissa.
        title: Title of the figure.
        wide: Whether it takes the whole width of the page.
        key: Words of the figure's own legend by class of the style sheet.
    """
    look = "chart wide" if wide else "chart"
    caption = f"<figcaption>{escape(title)}</figcaption>"
    if key:
        caption += legend(key)
    return f'<figure class="{look}">{caption}{stack_panels(panels)}</figure>'


def stack_panels(panels: Sequence[Panel]) -> str:
    """Return plot panels below each other as SVG, without a title."""
    return "".join(_panel(p, p is panels[-1]) for p in panels)


def _panel(p: Panel, numbered: bool) -> str:
    """Return label, drawing and numbers of a panel."""
    places = list(map(float, range(len(p.names)))) or round_ticks(*p.x, 6)
    across, heights = (
        _relative_positions(p.x, places),
        _relative_positions(p.y, round_ticks(*p.y, 5)),
    )
    marks = []
    for v, share in heights.items():
        marks.append(f'<span class="y" style="bottom:{100 * share:.1f}%">{_tick(v)}</span>')
    look, below = "plot", ""
    if numbered:
        look, below = "plot numbered", f'<p class="along">{escape(p.x_label)}</p>'
        for v, share in across.items():
            marks.append(
                f'<span class="x" style="left:{100 * share:.1f}%">{_tick_label(p, v)}</span>'
            )
    drawing = _drawing(p, across.values(), heights.values())
    return (
        f'<p class="across">{escape(p.title)}</p><div class="{look}" style="--shape:{p.shape:g}" '
        f'data-x="{p.x[0]:.9g} {p.x[1]:.9g}" data-y="{p.y[0]:.9g} {p.y[1]:.9g}" '
        f'data-across="{escape(p.x_label)}" data-up="{escape(p.title)}">'
        f'<svg viewBox="0 0 {GRID} {GRID}" preserveAspectRatio="none" role="img" '
        f'aria-label="{escape(p.about or p.title)}">{drawing}</svg>{"".join(marks)}</div>{below}'
    )


def _relative_positions(limits: tuple[float, float], values: Sequence[float]) -> dict[float, float]:
    """Return the position of each value between the limits, as a share of their distance."""
    low, high = limits
    return {v: (v - low) / (high - low) for v in values}


def _drawing(p: Panel, across: Iterable[float], heights: Iterable[float]) -> str:
    """Return the paths of a panel, with a grid at these shares of width and height."""
    paths = []
    for begin, end in p.flags:
        paths.append(f'<path class="flag" d="{_marked_interval(p, begin, end)}"/>')
    grid = ""
    for share in heights:
        grid += f"M0 {GRID * (1 - share):.0f}H{GRID}"
    for share in across:
        grid += f"M{GRID * share:.0f} 0V{GRID}"
    paths.append(f'<path class="grid" d="{grid}"/>')
    if p.y[0] < 0.0 < p.y[1] and p.shape == TIMES:
        zero = GRID * p.y[1] / (p.y[1] - p.y[0])
        paths.append(f'<path class="zero" d="M0 {zero:.0f}H{GRID}"/>')
    if p.band:
        paths.append(f'<path class="band" d="{_area(p, *p.band)}"/>')
    for dots in p.dots:
        paths.append(_dots(p, dots))
    for box in p.boxes:
        paths.append(_box_plot(p, box))
    curves: dict[str, list[Line]] = {}
    for line in p.lines:
        curves.setdefault(line.look, []).append(line)
    for lines in curves.values():
        pieces = _join_pieces(lines)
        most = POINTS
        if len(pieces) > 1:
            most = max(FEWEST_POINTS, 2 * POINTS // len(pieces))
        for line in pieces:
            paths.append(_curve(p, line, most))
    return "".join(paths)


def _join_pieces(lines: Sequence[Line]) -> Sequence[Line]:
    """Return the pieces of a curve, joined where they are too many to be distinguished."""
    if len(lines) <= MOST_PIECES:
        return lines
    x = np.concatenate([line.x for line in lines])
    y = np.concatenate([line.y for line in lines])
    times = [line.t for line in lines if line.t is not None]
    t = np.concatenate(times) if times else None
    return [replace(lines[0], x=x, y=y, t=t)]


def _drawing_coordinates(p: Panel, x: Array, y: Array) -> list[list[int]]:
    """Return drawing coordinates; points far outside are moved to just outside."""
    across = GRID * (np.asarray(x) - p.x[0]) / (p.x[1] - p.x[0])
    down = GRID * (p.y[1] - np.asarray(y)) / (p.y[1] - p.y[0])
    places = np.column_stack([np.clip(across, -GRID, 2 * GRID), np.clip(down, -GRID, 2 * GRID)])
    found: list[list[int]] = places.round().astype(int).tolist()
    return found


def _polyline(points: Sequence[Sequence[int]]) -> str:
    return "M" + "L".join(f"{a} {b}" for a, b in points)


def _curve(p: Panel, line: Line, most: int) -> str:
    seen = np.isfinite(line.x) & np.isfinite(line.y)
    x, y = line.x[seen], line.y[seen]
    rows = rows_of_extremes(y, most) if p.shape == TIMES else evenly_spaced_rows(len(y), most)
    d, data = "", ""
    if len(x):
        d = _polyline(_drawing_coordinates(p, x[rows], y[rows]))
    if line.name:
        data = f' data-name="{escape(line.name)}"'
    if line.t is not None:
        data += f' data-t="{" ".join(f"{t:.6g}" for t in line.t[seen][rows])}"'
    return f'<path class="line {line.look}" d="{d}"{data}/>'


def _dots(p: Panel, dots: Line) -> str:
    seen = np.isfinite(dots.x) & np.isfinite(dots.y)
    x, y = dots.x[seen], dots.y[seen]
    rows = evenly_spaced_rows(len(y), DOTS)
    d = "".join(f"M{a} {b}h0" for a, b in _drawing_coordinates(p, x[rows], y[rows]))
    return f'<path class="dots {dots.look}" d="{d}"/>'


def _box_plot(p: Panel, box: Box) -> str:
    """Return a box for the middle half of the values, a line at the median, and whiskers."""
    sides = np.array([box.x - box.width / 2, box.x, box.x + box.width / 2])
    places = _drawing_coordinates(p, sides[[0, 1, 2, 0, 0]], np.array(box.below))
    (left, low), (middle, lower), (right, half), (_, upper), (_, high) = places
    whiskers = f"M{middle} {low}V{lower}M{middle} {upper}V{high}"
    d = f"{whiskers}M{left} {lower}H{right}V{upper}H{left}ZM{left} {half}H{right}"
    return f'<path class="box {box.look}" d="{d}"/>'


def _tick_label(p: Panel, value: float) -> str:
    if p.names:
        return escape(p.names[int(value)])
    return _tick(value)


def _area(p: Panel, x: Array, low: Array, high: Array) -> str:
    known = np.isfinite(low) & np.isfinite(high)
    x, low, high = x[known], low[known], high[known]
    rows = evenly_spaced_rows(len(x), POINTS)
    around = (
        _drawing_coordinates(p, x[rows], high[rows])
        + _drawing_coordinates(p, x[rows], low[rows])[::-1]
    )
    return f"{_polyline(around)}Z"


def _marked_interval(p: Panel, begin: float, end: float) -> str:
    """Return a strip over an interval of the abscissa, within the margin above the curves."""
    a, b = GRID * (np.clip([begin, end], *p.x) - p.x[0]) / (p.x[1] - p.x[0])
    return f"M{a:.0f} 0H{b:.0f}V{STRIP * GRID:.0f}H{a:.0f}Z"


def rows_of_extremes(y: Array, most: int = POINTS) -> NDArray[np.int64]:
    """Return indices that thin out a long curve for drawing but keep its extremes.

    Minimum and maximum of equal intervals are kept.

    Args:
        y: Ordinates (N,).
        most: Approximate number of rows.
    """
    if len(y) <= most:
        return np.arange(len(y))
    edges = np.linspace(0, len(y), max(1, most // 2) + 1).astype(int)
    rows = [0, len(y) - 1]
    for first, end in pairwise(edges):
        rows.append(first + np.argmin(y[first:end]))
        rows.append(first + np.argmax(y[first:end]))
    return np.unique(np.array(rows))


def evenly_spaced_rows(rows: int, most: int) -> NDArray[np.int64]:
    """Return about `most` evenly spaced row indices, the last row included."""
    return np.unique(np.append(np.arange(0, rows, 1 + rows // most), max(rows - 1, 0)))[:rows]


def round_ticks(low: float, high: float, most: int) -> list[float]:
    """Return about `most` round numbers between two limits, as ticks of an axis."""
    rough = (high - low) / most
    power = 10.0 ** np.floor(np.log10(rough))
    step = float(10.0 * power)
    for factor in (5.0, 2.0, 1.0):
        if factor * power >= rough * (1 - 1e-9):
            step = float(power * factor)
    first, last = int(np.ceil(low / step - 1e-9)), int(np.floor(high / step + 1e-9))
    found: list[float] = (step * np.arange(first, last + 1)).tolist()
    return found


def _tick(value: float) -> str:
    if abs(value) < 1e6:
        return f"{value:.10g}".replace("-", "−")
    return format_number(value)


def axis_limits(values: Sequence[Array], zero: bool = True) -> tuple[float, float]:
    """Return the limits of a plot axis: the range of the finite values with a margin.

    Args:
        values: Values of any shape.
        zero: Whether the limits include zero.
    """
    found = np.zeros(1)
    if values:
        found = np.concatenate([np.asarray(v, float).ravel() for v in values])
    found = found[np.isfinite(found)]
    low, high = (0.0, 1.0)
    if len(found):
        low, high = float(found.min()), float(found.max())
    if zero:
        low, high = min(low, 0.0), max(high, 0.0)
    margin = MARGIN * (high - low) or max(abs(high), 1e-9)
    if low < 0.0 or not zero:
        low -= margin
    return low, high + margin
