"""Polar plot as an SVG file of its own, with curves over the direction from the bow."""

from collections.abc import Mapping
from html import escape
from math import ceil, cos, sin

import numpy as np

from boatsim.physics.base import Array
from boatsim.view.svg_plots import round_ticks

SIZE, RADIUS = 640, 240  # [px] width and height of the drawing, and radius of the outer circle
TOP = 60  # [px] above the outer circle, for the title
LINE = 20  # [px] height of a line of the legend
# colours of Okabe and Ito, which are told apart by readers with colour blindness; then dashed
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
RINGS = 5  # about this number of circles with a value


def polar_plot(title: str, unit: str, angles: Array, curves: Mapping[str, Array]) -> str:
    """Return a polar plot of curves over an angle as the text of an SVG file.

    The bow of a vessel points up, and starboard is on the right.

    Args:
        title: Title.
        unit: Unit of the values.
        angles: Angles, clockwise from the bow (n,) [rad].
        curves: Values (n,) of each curve by its name.
    """
    largest = max((float(values.max(initial=0.0)) for values in curves.values()), default=0.0)
    ticks = round_ticks(0.0, max(largest, 1e-9), RINGS)
    step = ticks[1] if len(ticks) > 1 else max(largest, 1e-9)
    outer = step * max(ceil(largest / step - 1e-9), 1)
    height = TOP + 2 * RADIUS + 50 + LINE * len(curves)
    middle_x, middle_y = SIZE / 2, TOP + RADIUS + 20
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {height:g}" '
        f'width="{SIZE}" height="{height:g}" font-family="sans-serif" font-size="13">',
        f"<title>{escape(title)}</title>",
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        f'<text x="{middle_x:g}" y="24" text-anchor="middle" font-size="16">{escape(title)}</text>',
    ]
    for k in range(1, round(outer / step) + 1):
        radius = RADIUS * k * step / outer
        parts.append(
            f'<circle cx="{middle_x:g}" cy="{middle_y:g}" r="{radius:.1f}" fill="none" '
            'stroke="#cccccc"/>'
        )
        at = middle_x + radius * sin(0.26), middle_y - radius * cos(0.26)  # 15 deg beside the bow
        words = f"{k * step:g}" + (f" {unit}" if k * step >= outer - 1e-9 else "")
        parts.append(f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" fill="#555555">{words}</text>')
    for degrees in range(0, 360, 30):
        angle = np.radians(degrees)
        x, y = float(sin(angle)), float(-cos(angle))
        parts.append(
            f'<line x1="{middle_x:g}" y1="{middle_y:g}" x2="{middle_x + RADIUS * x:.1f}" '
            f'y2="{middle_y + RADIUS * y:.1f}" stroke="#dddddd"/>'
            f'<text x="{middle_x + (RADIUS + 18) * x:.1f}" '
            f'y="{middle_y + (RADIUS + 18) * y + 4:.1f}" text-anchor="middle">{degrees}°</text>'
        )
    # outline of a vessel that points up
    parts.append(
        f'<path d="M{middle_x - 9:g} {middle_y + 26:g}v-36l9 -18l9 18v36z" fill="#eeeeee" '
        'stroke="#888888"/>'
    )
    for number, (name, values) in enumerate(curves.items()):
        points = []
        for angle, value in zip(angles.tolist(), values.tolist(), strict=True):
            radius = RADIUS * value / outer
            points.append(
                f"{middle_x + radius * sin(angle):.1f} {middle_y - radius * cos(angle):.1f}"
            )
        colour = COLOURS[number % len(COLOURS)]
        width = 3 if number == 0 else 1.8
        dash = ' stroke-dasharray="6 4"' if number >= len(COLOURS) else ""
        parts.append(
            f'<path d="M{"L".join(points)}Z" fill="none" stroke="{colour}" '
            f'stroke-width="{width}" stroke-linejoin="round"{dash}/>'
        )
        y = TOP + 2 * RADIUS + 60 + LINE * number
        parts.append(
            f'<line x1="40" y1="{y - 4:g}" x2="76" y2="{y - 4:g}" stroke="{colour}" '
            f'stroke-width="{width}"{dash}/><text x="84" y="{y:g}">{escape(name)}</text>'
        )
    parts.append("</svg>\n")
    return "\n".join(parts)
