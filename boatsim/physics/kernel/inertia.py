"""Mass matrices that are constant over a run: rigid body, added mass, ballast and their sum."""

from typing import Any

from boatsim.physics.kernel.compiling import lean
from boatsim.physics.signals import Array

from .laws import add_inertias
from .motion import CLOSED, FREED

# Surge, heave, pitch; sway, roll, yaw: a hull that is symmetric to port and starboard does not
# couple the two.
BLOCKS = ((0, 2, 4), (1, 3, 5))
# Entries of `MassMatrix` in these blocks
DIAGONAL = ((0, 2, 4), (1, 3, 5))
COUPLINGS = ((6, 7, 8), (9, 10, 11))


@lean
def invert_mass_matrix(m: Array) -> None:
    """Invert a 6 by 6 mass matrix of a symmetric hull by its two 3 by 3 blocks, in place.

    The row of an axis that is not free is that of the identity.
    """
    for b in range(2):
        (i, j, k), (d, e, f), (x, y, z) = DIAGONAL[b], COUPLINGS[b], BLOCKS[b]
        xx, yy = FREED[x] * m[i] + 1.0 - FREED[x], FREED[y] * m[j] + 1.0 - FREED[y]
        zz = FREED[z] * m[k] + 1.0 - FREED[z]
        xy = FREED[x] * FREED[y] * m[d]
        xz = FREED[x] * FREED[z] * m[e]
        yz = FREED[y] * FREED[z] * m[f]
        determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
        m[i] = (yy * zz - yz * yz) / determinant
        m[j] = (xx * zz - xz * xz) / determinant
        m[k] = (xx * yy - xy * xy) / determinant
        m[d] = (xz * yz - xy * zz) / determinant
        m[e] = (xy * yz - yy * xz) / determinant
        m[f] = (xy * xz - xx * yz) / determinant


@lean
def compute_mass_constants(body: Array, p: Array, on: Any, k: Array) -> None:
    """Fill the constants k (42,) of a vessel with its rigid body data and mass matrices.

    After the rigid body follow the `MassMatrix` entries of added mass, ballast and the sum. The sum
    is inverted where one inverse serves all states (`CLOSED`).
    """
    m, x, z = body[0], body[1], body[2]
    for i in range(6):
        k[i] = body[i]
    for i in range(6, 42):
        k[i] = 0.0
    add_inertias(p, on, k[6:18], k[18:30])
    whole = k[30:42]
    whole[0] = whole[1] = whole[2] = m
    whole[3] = body[3] + m * z * z
    whole[4] = body[4] + m * (x * x + z * z)
    whole[5] = body[5] + m * x * x
    whole[7], whole[8], whole[9], whole[10], whole[11] = m * z, -m * x, -m * z, m * x, -m * x * z
    for i in range(12):
        whole[i] += k[6 + i]
        whole[i] += k[18 + i]
    if CLOSED:
        invert_mass_matrix(whole)
