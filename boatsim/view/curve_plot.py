"""Plot of one curve as a separate SVG file."""

from html import escape

from boatsim.physics.base import Array
from boatsim.view.svg_plots import round_ticks

WIDTH, HEIGHT = 720, 440  # [px] of the drawing
LEFT, RIGHT, TOP, BOTTOM = 80, 24, 48, 56  # [px] around the axes
TICKS = 7  # about this number along each axis
ROOM = 0.05  # share of the range of the values above and below the curve
COLOUR = "#0072b2"


def curve_plot(title: str, labels: tuple[str, str], x: Array, y: Array) -> str:
    """Return a plot of a curve with marked points as the text of an SVG file.

    Args:
        title: Title.
        labels: Words on the horizontal and the vertical axis, with units.
        x: Abscissae (n,), increasing, at least two.
        y: Ordinates (n,).
    """
    x_low, x_high = float(x[0]), float(x[-1])
    y_low, y_high = min(float(y.min()), 0.0), max(float(y.max()), 0.0)
    room = ROOM * max(y_high - y_low, 1e-9)
    y_low, y_high = y_low - room, y_high + room
    across, down = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def place_x(value: float) -> float:
        return LEFT + across * (value - x_low) / (x_high - x_low)

    def place_y(value: float) -> float:
        return TOP + down * (y_high - value) / (y_high - y_low)

    bottom = TOP + down
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="13">',
        f"<title>{escape(title)}</title>",
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        f'<text x="{WIDTH / 2:g}" y="26" text-anchor="middle" font-size="16">'
        f"{escape(title)}</text>",
    ]
    for tick in round_ticks(x_low, x_high, TICKS):
        at = place_x(tick)
        parts.append(
            f'<line x1="{at:.1f}" y1="{TOP}" x2="{at:.1f}" y2="{bottom}" stroke="#dddddd"/>'
            f'<text x="{at:.1f}" y="{bottom + 18}" text-anchor="middle">{tick:g}</text>'
        )
    for tick in round_ticks(y_low, y_high, TICKS):
        at = place_y(tick)
        colour = "#888888" if tick == 0.0 else "#dddddd"
        parts.append(
            f'<line x1="{LEFT}" y1="{at:.1f}" x2="{LEFT + across}" y2="{at:.1f}" '
            f'stroke="{colour}"/>'
            f'<text x="{LEFT - 8}" y="{at + 4:.1f}" text-anchor="end">{tick:.4g}</text>'
        )
    points: list[str] = []
    for a, b in zip(x.tolist(), y.tolist(), strict=True):
        points.append(f"{place_x(a):.1f} {place_y(b):.1f}")
        parts.append(
            f'<circle cx="{place_x(a):.1f}" cy="{place_y(b):.1f}" r="2.5" fill="{COLOUR}"/>'
        )
    middle = TOP + down / 2
    parts += [
        f'<path d="M{"L".join(points)}" fill="none" stroke="{COLOUR}" stroke-width="2"/>',
        f'<text x="{LEFT + across / 2:g}" y="{HEIGHT - 14}" text-anchor="middle">'
        f"{escape(labels[0])}</text>",
        f'<text x="20" y="{middle:g}" text-anchor="middle" '
        f'transform="rotate(-90 20 {middle:g})">{escape(labels[1])}</text>',
        "</svg>\n",
    ]
    return "\n".join(parts)
