"""Small charts as SVG, readable in light and dark and at the width of a telephone.

The colours are those of Okabe and Ito, which colour-blind readers can distinguish; lines also
differ in their dashes. A chart in a page takes its colours from `docs/_static/site.css`; one that
is a file of its own carries that style sheet.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from math import isfinite
from pathlib import Path
from textwrap import wrap

from boatsim.physics.signals import Array
from boatsim.view.svg_plots import axis_limits, round_ticks

WIDTH = 420  # units of a drawing, about one pixel each on a telephone
LEFT, RIGHT, BOTTOM = 48, 16, 40  # margins of the axes
ROW = 17  # height of a line of text
GAP = 27  # between axes, for the numbers of the upper ones
CONSTANT = 1e-9  # relative range below which a curve is a constant
LETTER = 7.2  # widest mean width of a letter of the labels
LONGEST_LABEL = 52  # characters of a line of a label beside its note
STYLES = ("one", "two", "three")  # classes of the curves
STYLE_SHEET = Path(__file__).parents[1] / "_static" / "site.css"
BEGIN_OF_STYLE = "/* charts */"


@dataclass(frozen=True)
class Curve:
    """A curve of a chart.

    Attributes:
        name: Its name in the legend; "" for none.
        x: Abscissae (N,).
        y: Ordinates (N,).
        style: Class of the style sheet; "" for that of its place among the curves.
        sizes: Radii (N,) of points that are drawn in addition to the line.
    """

    name: str
    x: Array
    y: Array
    style: str = ""
    sizes: Sequence[float] = ()


@dataclass(frozen=True)
class Axes:
    """Axes with curves; several of them stand below each other over one abscissa.

    Attributes:
        label: Label of the ordinate, with its unit.
        curves: Curves.
        limits: Limits of the ordinate; None for those of the curves.
    """

    label: str
    curves: Sequence[Curve]
    limits: tuple[float, float] | None = None


@dataclass(frozen=True)
class Bar:
    """A value on a chart of rows, with its interval and its goal.

    Attributes:
        label: Words above the bar.
        note: Words at the end of the label's line, such as the value.
        value: Length of the bar.
        interval: Interval of uncertainty of the value; None for none.
        goal: Goal; None for none.
        met: Whether the goal is met; None without a goal.
    """

    label: str
    note: str
    value: float
    interval: tuple[float, float] | None
    goal: float | None
    met: bool | None


def line_chart(
    axes: Sequence[Axes], x_label: str, about: str, height: int = 170, in_file: bool = False
) -> str:
    """Return a chart of curves as SVG.

    Args:
        axes: Axes from top to bottom.
        x_label: Label of the abscissa, with its unit.
        about: Description for readers who cannot see the chart.
        height: Height of each drawing area.
        in_file: Whether the chart is a file of its own.
    """
    every = [curve.x for panel in axes for curve in panel.curves]
    low = min(float(x.min()) for x in every)
    high = max(float(x.max()) for x in every)
    parts: list[str] = []
    top = 0.0
    for panel in axes:
        if top:
            top += GAP
        top = _draw_axes(parts, panel, (low, high), top, height)
    left = LEFT + (WIDTH - LEFT - RIGHT) / 2
    parts.append(_text(left, top + 35, x_label, "middle"))
    return _svg(parts, top + BOTTOM, about, in_file)


def _draw_axes(
    parts: list[str], panel: Axes, x_limits: tuple[float, float], top: float, height: int
) -> float:
    """Append the drawing of one set of axes; return the place of its lower edge."""
    parts.append(_text(LEFT, top + 12, panel.label, "start"))
    top = _draw_legend(parts, panel, top + ROW) + 6
    y_limits = panel.limits or _limits(panel)
    right, low = WIDTH - RIGHT, top + height

    def x_at(value: float) -> float:
        share = (value - x_limits[0]) / (x_limits[1] - x_limits[0])
        return LEFT + share * (right - LEFT)

    def y_at(value: float) -> float:
        return low - (value - y_limits[0]) / (y_limits[1] - y_limits[0]) * height

    for value in round_ticks(*y_limits, 5):
        look = "zero" if value == 0.0 else "grid"
        parts.append(_path(look, f"M{LEFT} {y_at(value):.1f}H{right}"))
        parts.append(_text(LEFT - 6, y_at(value) + 4, tick(value), "end"))
    for value in round_ticks(*x_limits, 6):
        look = "zero" if value == 0.0 else "grid"
        parts.append(_path(look, f"M{x_at(value):.1f} {top:.1f}V{low:.1f}"))
        parts.append(_text(x_at(value), low + 18, tick(value), "middle"))
    for style, curve in zip(STYLES, panel.curves, strict=False):
        look = curve.style or style
        parts.append(_path(f"curve {look}", _polyline(curve, x_at, y_at)))
        for x, y, size in zip(curve.x, curve.y, curve.sizes, strict=False):
            at = f'cx="{x_at(x):.1f}" cy="{y_at(y):.1f}" r="{size:.1f}"'
            parts.append(f'<circle class="point {look}" {at}/>')
    return low


def _limits(panel: Axes) -> tuple[float, float]:
    """Return the limits of the ordinate; those of a constant include zero."""
    every = [curve.y for curve in panel.curves]
    low, high = axis_limits(every, zero=False)
    if high - low < CONSTANT * max(abs(low), abs(high)):
        return axis_limits(every)
    return low, high


def _polyline(curve: Curve, x_at, y_at) -> str:  # type: ignore[no-untyped-def]
    """Return the path of a curve, with gaps where it is not finite."""
    path, command = "", "M"
    for x, y in zip(curve.x.tolist(), curve.y.tolist(), strict=True):
        if not isfinite(y):
            command = "M"
            continue
        path += f"{command}{x_at(x):.1f} {y_at(y):.1f}"
        command = "L"
    return path


def _draw_legend(parts: list[str], panel: Axes, top: float) -> float:
    """Append the legend of named curves, in as many lines as it needs; return its lower edge."""
    left, used = float(LEFT), False
    for style, curve in zip(STYLES, panel.curves, strict=False):
        if not curve.name:
            continue
        wide = 34 + LETTER * len(curve.name)
        if used and left + wide > WIDTH:
            left, top = float(LEFT), top + ROW
        parts.append(_path(f"curve {curve.style or style}", f"M{left:.1f} {top + 8:.1f}h22"))
        parts.append(_text(left + 27, top + 12, curve.name, "start"))
        left, used = left + wide + 14, True
    return top + ROW if used else top


def bar_chart(
    bars: Sequence[Bar],
    limits: tuple[float, float],
    x_label: str,
    about: str,
    in_file: bool = False,
) -> str:
    """Return a chart of horizontal bars with intervals and goals as SVG.

    Each bar has its label above it, so that the chart is readable on a narrow page.

    Args:
        bars: Bars from top to bottom.
        limits: Limits of the abscissa.
        x_label: Label of the abscissa.
        about: Description for readers who cannot see the chart.
        in_file: Whether the chart is a file of its own.
    """
    left, right = 16, WIDTH - 16
    top = ROW + 12
    lines = [wrap(bar.label, LONGEST_LABEL) for bar in bars]
    low = top + sum(map(len, lines)) * ROW + len(bars) * (ROW + 5)
    parts = _goal_legend(left)

    def x_at(value: float) -> float:
        inside = min(max(value, limits[0]), limits[1])
        return left + (inside - limits[0]) / (limits[1] - limits[0]) * (right - left)

    for value in round_ticks(*limits, 6):
        parts.append(_path("grid", f"M{x_at(value):.1f} {top}V{low}"))
        parts.append(_text(x_at(value), low + 14, tick(value), "middle"))
    for bar, words in zip(bars, lines, strict=True):
        parts.append(_text(right, top + 12, bar.note, "end"))
        for line in words:
            parts.append(_text(left, top + 12, line, "start"))
            top += ROW
        top -= ROW
        middle = top + ROW + 7
        met = "missed" if bar.met is False else "met"
        parts.append(_path(f"bar {met}", f"M{left} {middle}H{max(x_at(bar.value), left + 1):.1f}"))
        if bar.interval:
            begin, end = map(x_at, bar.interval)
            parts.append(
                _path(
                    "interval",
                    f"M{begin:.1f} {middle}H{end:.1f}M{begin:.1f} {middle - 3}v6"
                    f"M{end:.1f} {middle - 3}v6",
                )
            )
        if bar.goal is not None:
            parts.append(_path("goal", f"M{x_at(bar.goal):.1f} {middle - 8}v16"))
        top += 2 * ROW + 5
    parts.append(_text((left + right) / 2, low + 31, x_label, "middle"))
    return _svg(parts, low + BOTTOM, about, in_file)


def _goal_legend(left: float) -> list[str]:
    """Return the legend of a chart of bars."""
    parts, top = [], 10
    for look, words, wide in (
        ("bar met", "goal met, or none", 140),
        ("bar missed", "goal missed", 106),
    ):
        parts.append(_path(look, f"M{left} {top}h20"))
        parts.append(_text(left + 26, top + 4, words, "start"))
        left += wide
    parts.append(_path("goal", f"M{left + 6} {top - 8}v16"))
    parts.append(_text(left + 14, top + 4, "goal", "start"))
    return parts


def tick(value: float) -> str:
    """Return a number as the label of a tick."""
    return f"{value:.6g}".replace("-", "−")


def _path(look: str, d: str) -> str:
    return f'<path class="{look}" d="{d}"/>'


def _text(x: float, y: float, words: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(words)}</text>'


def _svg(parts: Sequence[str], height: float, about: str, in_file: bool) -> str:
    """Return the whole drawing; a file of its own has the style sheet in it."""
    style, name = "", ""
    if in_file:
        name = ' xmlns="http://www.w3.org/2000/svg"'
        style = (
            f"<style>\n{BEGIN_OF_STYLE}{STYLE_SHEET.read_text().split(BEGIN_OF_STYLE)[1]}</style>"
        )
    return (
        f'<svg{name} class="chart" viewBox="0 0 {WIDTH} {height:.0f}" role="img" '
        f'aria-label="{escape(about)}">{style}{"".join(parts)}</svg>'
    )
