"""Reliability curve as SVG: observed frequency against stated probability, with 95 % intervals."""

from collections.abc import Sequence

from validation.calibration.table import Bin, wilson_interval

SIZE, EDGE = 360, 50  # side of the square of the axes, and width of the margin [px]
TICKS = (0.0, 0.25, 0.5, 0.75, 1.0)
FONT = 'font-family="sans-serif" font-size="13"'


def reliability_curve(table: Sequence[Bin]) -> str:
    """Return the SVG of a reliability table.

    Args:
        table: Statements by ranges of their probability.
    """
    whole = SIZE + 2 * EDGE
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {whole} {whole}" {FONT}>',
        f'<rect width="{whole}" height="{whole}" fill="white"/>',
        _path([(0.0, 0.0), (1.0, 1.0)], 'stroke="#999" stroke-dasharray="5 4"'),
        _path([(0.0, 0.0), (1.0, 0.0)], 'stroke="#333"'),
        _path([(0.0, 0.0), (0.0, 1.0)], 'stroke="#333"'),
    ]
    for tick in TICKS:
        x, y = _place(tick, tick)
        base, left = SIZE + EDGE, EDGE
        parts.append(f'<text x="{x:.0f}" y="{base + 18}" text-anchor="middle">{tick:g}</text>')
        parts.append(f'<text x="{left - 8}" y="{y + 4:.0f}" text-anchor="end">{tick:g}</text>')
    for row in table:
        low, high = wilson_interval(row.right, row.count)
        x, y = _place(row.stated, row.right)
        parts.append(_path([(row.stated, low), (row.stated, high)], 'stroke="#1f6fb4"'))
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="#1f6fb4"/>')
    parts.append(_path([(row.stated, row.right) for row in table], 'stroke="#1f6fb4"'))
    middle = EDGE + SIZE / 2
    parts.append(
        f'<text x="{middle:g}" y="{whole - 8}" text-anchor="middle">stated probability</text>'
        f'<text x="14" y="{middle:g}" text-anchor="middle" '
        f'transform="rotate(-90 14 {middle:g})">share of right names</text></svg>\n'
    )
    return "\n".join(parts)


def _place(x: float, y: float) -> tuple[float, float]:
    """Coordinates [px] of a point of the unit square."""
    return EDGE + SIZE * x, EDGE + SIZE * (1.0 - y)


def _path(points: Sequence[tuple[float, float]], style: str) -> str:
    """SVG path through points of the unit square."""
    steps = []
    for point in points:
        x, y = _place(*point)
        steps.append(f"{x:.1f} {y:.1f}")
    return f'<path d="M{" L".join(steps)}" fill="none" {style}/>'
