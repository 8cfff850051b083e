"""Plot of response amplitude operators as an SVG file of its own."""

from collections.abc import Sequence
from html import escape
from math import degrees, isfinite

import numpy as np

from boatsim.physics.base import Array
from boatsim.view.polar_plot import COLOURS
from boatsim.view.svg_plots import round_ticks

WIDTH, HEIGHT = 360, 230  # [px] of one degree of freedom
LEFT, RIGHT, TOP, BOTTOM = 58, 12, 30, 42  # [px] around its axes
ACROSS = 2  # degrees of freedom in a row
TICKS = 5  # about this number along each axis
ROOM = 1.05  # of the largest value
LINE = 20  # [px] height of a line of the legend


def response_plot(
    title: str, names: Sequence[str], x_label: str, x: Array, directions: Array, sizes: Array
) -> str:
    """Return curves of response amplitudes over one abscissa as the text of an SVG file.

    Args:
        title: Title.
        names: Labels of the degrees of freedom, with units (D,).
        x_label: Label of the abscissa.
        x: Abscissae (P,).
        directions: Directions of the waves relative to the bow (H,) [rad].
        sizes: Amplitudes (H, P, D).
    """
    rows = -(-len(names) // ACROSS)
    width, below = ACROSS * WIDTH, TOP + rows * HEIGHT
    height = below + LINE * (len(directions) + 1)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
        f"<title>{escape(title)}</title>",
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        f'<text x="{width / 2:g}" y="20" text-anchor="middle" font-size="15">',
        f"{escape(title)}</text>",
    ]
    for d, name in enumerate(names):
        left, top = WIDTH * (d % ACROSS), TOP + HEIGHT * (d // ACROSS)
        parts += _axes(left, top, name, x_label, x, sizes[..., d])
    for i, direction in enumerate(directions.tolist()):
        y = below + LINE * (i + 0.5)
        parts.append(
            f'<line x1="{LEFT}" x2="{LEFT + 40}" y1="{y:g}" y2="{y:g}" stroke-width="2" '
            f'stroke="{COLOURS[i % len(COLOURS)]}"/>'
            f'<text x="{LEFT + 50}" y="{y + 4:g}">{_direction_text(direction)}</text>'
        )
    return "\n".join([*parts, "</svg>\n"])


def axis_ends(x: Array) -> tuple[float, float]:
    """Return the ends of an axis, with room around a single value.

    Args:
        x: Values (P,).
    """
    low, high = float(x.min()), float(x.max())
    if high > low:
        return low, high
    return 0.9 * low, 1.1 * high


def _direction_text(direction: float) -> str:
    """Direction of waves in words."""
    angle = degrees(direction)
    side = {0: " (from astern)", 90: " (from port)", 180: " (from ahead)"}.get(round(angle), "")
    return f"waves run to {angle:.0f}° from the bow{side}"


def _axes(left: int, top: int, name: str, x_label: str, x: Array, sizes: Array) -> list[str]:
    """Axes and curves (H, P) of one degree of freedom."""
    across, down = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM
    low, high = axis_ends(x)
    known = sizes[np.isfinite(sizes)]
    most = ROOM * max(float(known.max(initial=0.0)), 1e-9)
    bottom = top + TOP + down

    def place_x(value: float) -> float:
        return left + LEFT + across * (value - low) / (high - low)

    def place_y(value: float) -> float:
        return bottom - down * value / most

    parts = [f'<text x="{left + LEFT}" y="{top + 20}">{escape(name)}</text>']
    for tick in round_ticks(low, high, TICKS):
        at = place_x(tick)
        parts.append(
            f'<line x1="{at:.1f}" x2="{at:.1f}" y1="{top + TOP}" y2="{bottom}" stroke="#dddddd"/>'
            f'<text x="{at:.1f}" y="{bottom + 16}" text-anchor="middle">{tick:g}</text>'
        )
    for tick in round_ticks(0.0, most, TICKS):
        at = place_y(tick)
        parts.append(
            f'<line x1="{left + LEFT}" x2="{left + LEFT + across}" y1="{at:.1f}" y2="{at:.1f}" '
            f'stroke="#dddddd"/><text x="{left + LEFT - 6}" y="{at + 4:.1f}" text-anchor="end">'
            f"{tick:.4g}</text>"
        )
    for i, curve in enumerate(sizes):
        colour = COLOURS[i % len(COLOURS)]
        points = []
        for a, b in zip(x.tolist(), curve.tolist(), strict=True):
            if isfinite(b):
                points.append((place_x(a), place_y(b)))
        for across_at, down_at in points:
            parts.append(f'<circle cx="{across_at:.1f}" cy="{down_at:.1f}" r="2" fill="{colour}"/>')
        if len(points) > 1:
            line = "L".join(f"{across_at:.1f} {down_at:.1f}" for across_at, down_at in points)
            parts.append(f'<path d="M{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
    middle = left + LEFT + across / 2
    parts.append(
        f'<text x="{middle:g}" y="{bottom + 34}" text-anchor="middle">{escape(x_label)}</text>'
    )
    return parts
