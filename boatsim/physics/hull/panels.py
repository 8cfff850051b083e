"""Pressure on the wetted part of a hull's triangles under waves, for compiled laws.

The table of the effect has the numbers of cells and of waves; then for each wave frequency [rad/s],
amplitude [m], wave number [rad/m], cosine and sine of its direction, phase [rad], and exp(-2 k h)
for the depth h of the water; then for each cell of neighbouring triangles its middle (x, y, z) [m],
the place of its first triangle in the table and their number; then nine coordinates [m] of the
corners of each triangle, in SNAME axes from the origin of motion.
"""

from collections.abc import Sequence
from math import cos, exp, sin
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from boatsim.physics.signals import Array, Wrench
from boatsim.physics.waves.field import WaveField

HEAD, WAVE, CELL, TRIANGLE = 2, 7, 5, 9  # numbers of the table of each
# Longest edge of a triangle over the edge of a cell: triangles of a cell may reach beyond it
LONGEST_EDGE = 1.5
ROUNDED = (
    9  # decimals of the place of a triangle in cells, so that a mirrored mesh has mirrored cells
)
CALM = (0.0, 0.0)  # the table without a mesh


def divided(corners: Array, longest: float) -> Array:
    """Return triangles (M, 3, 3) whose edges are no longer than a length.

    Longer edges are halved, in both triangles at an edge alike, so that the surface stays closed.

    Args:
        corners: Corners (N, 3, 3) [m].
        longest: Longest edge [m].
    """
    while True:
        edges = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        first = np.argmax(edges, axis=1)
        long = edges.max(axis=1) > longest
        if not long.any():
            return corners
        turned = (first[long][:, None] + np.arange(3)) % 3
        own = corners[long][np.arange(int(long.sum()))[:, None], turned]
        a, b, c = own[:, 0], own[:, 1], own[:, 2]
        middle = 0.5 * (a + b)
        halves = [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        corners = np.concatenate([corners[~long], *halves])


def cell_numbers(corners: Array, edge: float) -> Array:
    """Return the cubic cell (N, 4) of space in which the middle of each triangle lies.

    Cells are symmetric to port and starboard; the last number is the side.

    Args:
        corners: Corners (N, 3, 3) [m].
        edge: Edge of a cell [m].
    """
    middle = np.round(corners.mean(axis=1), ROUNDED)
    middle[:, [0, 2]] -= middle[:, [0, 2]].min(axis=0)
    side = np.sign(middle[:, 1])
    return np.column_stack([np.floor(np.abs(middle) / edge), side])


def panel_numbers(corners: Array, edge: float, before: int) -> list[float]:
    """Return the numbers of the table for cells and triangles of a hull.

    Args:
        corners: Corners (N, 3, 3) [m], outside on the side of the normal.
        edge: Edge of a cell [m]; 0 for one cell.
        before: Numbers of the table before these.

    Returns:
        Numbers of the cells, then of the triangles, as a law reads them.
    """
    number = np.zeros(len(corners), dtype=int)
    if edge > 0.0:
        _, number = np.unique(cell_numbers(corners, edge), axis=0, return_inverse=True)
        number = number.ravel()
    order = np.argsort(number, kind="stable")
    sizes = np.bincount(number)
    begin = before + CELL * len(sizes)
    cells: list[float] = []
    for cell, size in enumerate(sizes):
        own = corners[number == cell]
        weight = np.linalg.norm(np.cross(own[:, 1] - own[:, 0], own[:, 2] - own[:, 0]), axis=1)
        middle = np.average(own.mean(axis=1), axis=0, weights=weight)
        cells += [*middle.tolist(), float(begin), float(size)]
        begin += TRIANGLE * int(size)
    return cells + corners[order].ravel().tolist()


def panel_table(
    corners: Array, edge: float, field: WaveField | None, depth: float
) -> Sequence[float]:
    """Return the table of a hull and of the waves around it.

    Without waves the hull is one cell with the triangles of its mesh.

    Args:
        corners: Corners (N, 3, 3) [m] from the origin of motion.
        edge: Edge of a cell [m].
        field: The waves; None for still water.
        depth: Depth of the water [m]; 0 for deep water.
    """
    waves: list[float] = []
    if field is None:
        edge = 0.0
    else:
        corners = divided(corners, LONGEST_EDGE * edge)
        bed = np.zeros(len(field))
        if depth > 0.0:
            bed = np.exp(-2.0 * field.wave_number * depth)
        columns = (
            field.frequency,
            field.amplitude,
            field.wave_number,
            np.cos(field.direction),
            np.sin(field.direction),
            field.phase,
            bed,
        )
        waves = np.column_stack(columns).ravel().tolist()
    panels = panel_numbers(corners, edge, HEAD + len(waves))
    cells = (len(panels) - TRIANGLE * len(corners)) // CELL
    return (float(cells), float(len(waves) // WAVE), *waves, *panels)


class PressureHead(NamedTuple):
    """Pressure over density and gravity [m], linear around one place of the hull."""

    level: float  # [m] at the origin of the axes
    x: float  # gradient along the first axis
    y: float  # along the second
    z: float  # along the third, down


class Corner(NamedTuple):
    """Corner of a triangle in the axes of the hull, with the pressure head there."""

    x: float  # [m]
    y: float  # [m]
    z: float  # [m]
    head: float  # [m]


class HeadMoments(NamedTuple):
    """Means of pressure head times place, and of pressure head, over a part of a triangle.

    They are integrals over the part, divided by the area of the whole triangle.
    """

    x: float  # [m^2]
    y: float  # [m^2]
    z: float  # [m^2]
    mean: float  # [m]


@njit
def wave_head(
    north: float, east: float, below: float, t: float, p: Array, first: Any
) -> PressureHead:
    """Return the pressure head of waves at a place, and its gradient north, east and down.

    Below the level of the still water it is that of linear waves, and above that of the surface, so
    that the pressure above that level is hydrostatic.

    Args:
        north: Place in the water, which moves with the current [m].
        east: Place in the water [m].
        below: Depth below the level of the still water [m].
        t: Time [s].
        p: Parameters and tables.
        first: Index of the table.
    """
    level = along = aside = down = 0.0
    depth = max(below, 0.0)
    for i in range(int(p[first + 1])):
        at = first + HEAD + WAVE * i
        k, bed = p[at + 2], p[at + 6]
        theta = p[at] * t - k * (north * p[at + 3] + east * p[at + 4]) + p[at + 5]
        near = exp(-k * depth) / (1.0 + bed)
        far = 0.0
        if bed > 0.0:
            far = bed * exp(k * depth) / (1.0 + bed)
        rise = p[at + 1] * cos(theta)
        slope = p[at + 1] * k * (near + far) * sin(theta)
        level += rise * (near + far)
        along += slope * p[at + 3]
        aside += slope * p[at + 4]
        if below > 0.0:
            down -= k * rise * (near - far)
    return PressureHead(level, along, aside, down)


@njit
def corner(p: Array, at: Any, head: PressureHead) -> Corner:
    """Return a corner of a triangle from the table, with its pressure head.

    Args:
        p: Parameters and tables.
        at: Index of its first coordinate.
        head: Pressure head around it.
    """
    x, y, z = p[at], p[at + 1], p[at + 2]
    return Corner(x, y, z, head.level + head.x * x + head.y * y + head.z * z)


@njit
def whole_moments(a: Corner, b: Corner, c: Corner) -> HeadMoments:
    """Return the moments of the pressure head over a whole triangle.

    Args:
        a: First corner.
        b: Second corner.
        c: Third corner.
    """
    total = a.head + b.head + c.head
    return HeadMoments(
        ((a.x + b.x + c.x) * total + a.x * a.head + b.x * b.head + c.x * c.head) / 12.0,
        ((a.y + b.y + c.y) * total + a.y * a.head + b.y * b.head + c.y * c.head) / 12.0,
        ((a.z + b.z + c.z) * total + a.z * a.head + b.z * b.head + c.z * c.head) / 12.0,
        total / 3.0,
    )


@njit
def tip_moments(a: Corner, b: Corner, c: Corner) -> HeadMoments:
    """Return the moments over the tip of a triangle that the surface cuts off at a corner.

    Args:
        a: Corner that is alone on its side of the surface, where the pressure head is zero.
        b: Second corner.
        c: Third corner.
    """
    first, second = a.head / (a.head - b.head), a.head / (a.head - c.head)
    size = first * second * a.head / 12.0
    return HeadMoments(
        size * (4.0 * a.x + first * (b.x - a.x) + second * (c.x - a.x)),
        size * (4.0 * a.y + first * (b.y - a.y) + second * (c.y - a.y)),
        size * (4.0 * a.z + first * (b.z - a.z) + second * (c.z - a.z)),
        4.0 * size,
    )


@njit
def wetted_moments(a: Corner, b: Corner, c: Corner) -> HeadMoments:
    """Return the moments over the part of a triangle in which the pressure head is positive.

    Args:
        a: First corner.
        b: Second corner.
        c: Third corner.
    """
    if a.head <= 0.0 and b.head <= 0.0 and c.head <= 0.0:
        return HeadMoments(0.0, 0.0, 0.0, 0.0)
    if a.head > 0.0 and b.head > 0.0 and c.head > 0.0:
        return whole_moments(a, b, c)
    # the corner that is alone on its side
    if (a.head > 0.0) == (b.head > 0.0):
        tip = tip_moments(c, a, b)
        alone = c.head
    elif (a.head > 0.0) == (c.head > 0.0):
        tip = tip_moments(b, c, a)
        alone = b.head
    else:
        tip = tip_moments(a, b, c)
        alone = a.head
    if alone > 0.0:
        return tip
    # The head of a dry tip is negative
    whole = whole_moments(a, b, c)
    return HeadMoments(whole.x - tip.x, whole.y - tip.y, whole.z - tip.z, whole.mean - tip.mean)


@njit
def cell_load(head: PressureHead, p: Array, begin: Any, count: Any) -> Wrench:
    """Return force and moment of the pressure on some triangles, over density and gravity.

    Args:
        head: Pressure head around them, in the axes of the hull.
        p: Parameters and tables.
        begin: Index of the first coordinate of the first triangle.
        count: Number of triangles.

    Returns:
        Force [m^3] and moment about the origin [m^4] in the axes of the hull.
    """
    X = Y = Z = K = M = N = 0.0
    for i in range(count):
        at = begin + TRIANGLE * i
        a, b, c = corner(p, at, head), corner(p, at + 3, head), corner(p, at + 6, head)
        wet = wetted_moments(a, b, c)
        # area times the normal, towards the water
        nx = 0.5 * ((b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y))
        ny = 0.5 * ((b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z))
        nz = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x))
        X -= nx * wet.mean
        Y -= ny * wet.mean
        Z -= nz * wet.mean
        K -= wet.y * nz - wet.z * ny
        M -= wet.z * nx - wet.x * nz
        N -= wet.x * ny - wet.y * nx
    return Wrench(X, Y, Z, K, M, N)


@njit
def hull_load(m: Any, p: Array, first: Any) -> Wrench:
    """Return force and moment of the pressure on a hull, over density and gravity.

    Args:
        m: Motion of the hull.
        p: Parameters and tables.
        first: Index of the table.

    Returns:
        Force [m^3] and moment about the origin [m^4] in the axes of the hull.
    """
    cf, sf, ct, st = cos(m.phi), sin(m.phi), cos(m.theta), sin(m.theta)
    cp, sp = m.cos_psi, m.sin_psi
    # axes of the hull in those of the earth
    north_x, north_y, north_z = cp * ct, cp * st * sf - sp * cf, sp * sf + cp * st * cf
    east_x, east_y, east_z = sp * ct, cp * cf + sp * st * sf, sp * st * cf - cp * sf
    down_x, down_y, down_z = -st, ct * sf, ct * cf
    north, east = m.x - m.carried_north, m.y - m.carried_east
    cells, waves = int(p[first]), int(p[first + 1])
    X = Y = Z = K = M = N = 0.0
    for i in range(cells):
        at = first + HEAD + WAVE * waves + CELL * i
        head = PressureHead(m.z, down_x, down_y, down_z)
        if waves > 0:
            x, y, z = p[at], p[at + 1], p[at + 2]
            below = m.z + down_x * x + down_y * y + down_z * z
            wave = wave_head(
                north + north_x * x + north_y * y + north_z * z,
                east + east_x * x + east_y * y + east_z * z,
                below,
                m.t,
                p,
                first,
            )
            down = 1.0 + wave.z
            gx = north_x * wave.x + east_x * wave.y + down_x * down
            gy = north_y * wave.x + east_y * wave.y + down_y * down
            gz = north_z * wave.x + east_z * wave.y + down_z * down
            level = below + wave.level - gx * x - gy * y - gz * z
            head = PressureHead(level, gx, gy, gz)
        f = cell_load(head, p, first + int(p[at + 3]), int(p[at + 4]))
        X += f.X
        Y += f.Y
        Z += f.Z
        K += f.K
        M += f.M
        N += f.N
    return Wrench(X, Y, Z, K, M, N)
