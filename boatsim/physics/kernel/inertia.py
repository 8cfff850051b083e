"""The mass of a pass: rigid body, water and ballast, and what the equations need of the whole."""

from typing import Any

from boatsim.physics.kernel.compiling import lean
from boatsim.physics.signals import Array

from .laws import inertias
from .motion import CLOSED, FREED

BLOCKS = (
    (0, 2, 4),
    (1, 3, 5),
)  # surge, heave, pitch and sway, roll, yaw: alike on both sides, they do not mix
DIAGONAL, COUPLINGS = ((0, 2, 4), (1, 3, 5)), ((6, 7, 8), (9, 10, 11))  # entries of `Mass`


@lean
def invert(m: Array) -> None:
    """Inverse of a mass matrix by its two blocks, in place; a held axis stands apart with a one of its own."""
    for b in range(2):
        (i, j, k), (d, e, f), (x, y, z) = DIAGONAL[b], COUPLINGS[b], BLOCKS[b]
        xx, yy = FREED[x] * m[i] + 1.0 - FREED[x], FREED[y] * m[j] + 1.0 - FREED[y]
        zz = FREED[z] * m[k] + 1.0 - FREED[z]
        xy, xz, yz = (
            FREED[x] * FREED[y] * m[d],
            FREED[x] * FREED[z] * m[e],
            FREED[y] * FREED[z] * m[f],
        )
        determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
        m[i], m[j], m[k] = (
            (yy * zz - yz * yz) / determinant,
            (xx * zz - xz * xz) / determinant,
            (xx * yy - xy * xy) / determinant,
        )
        m[d], m[e], m[f] = (
            (xz * yz - xy * zz) / determinant,
            (xy * yz - yy * xz) / determinant,
            (xy * xz - xx * yz) / determinant,
        )


@lean
def constants(body: Array, p: Array, on: Any, k: Array) -> None:
    """Fill k (42,): body (m, x_G, z_G, I_x, I_y, I_z), then the entries of `Mass` of water, of ballast, of the whole.

    `body` is as in k. The whole is inverted where that can be done once for all.
    """
    m, x, z = body[0], body[1], body[2]
    for i in range(6):
        k[i] = body[i]
    for i in range(6, 42):
        k[i] = 0.0
    inertias(p, on, k[6:18], k[18:30])
    whole = k[30:42]
    whole[0] = whole[1] = whole[2] = m
    whole[3], whole[4], whole[5] = (
        body[3] + m * z * z,
        body[4] + m * (x * x + z * z),
        body[5] + m * x * x,
    )
    whole[7], whole[8], whole[9], whole[10], whole[11] = m * z, -m * x, -m * z, m * x, -m * x * z
    for i in range(12):
        whole[i] += k[6 + i]
        whole[i] += k[18 + i]
    if CLOSED:
        invert(whole)
