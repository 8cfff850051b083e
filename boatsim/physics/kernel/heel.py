"""Surge, sway, yaw and roll: a hull that heels as it manoeuvres, its equations and what MuJoCo's callback adds to them.

State y = (x, y, psi, phi, x', y', psi', p), earth-axes velocities, SNAME. Body axes turn with the heading and do not
heel, so r = psi' and p = phi'. The origin of motion is the mass centre, about which pitch and yaw inertia are alike.
"""

from math import cos, sin
from typing import Any

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import compiled, inlined, lean
from boatsim.physics.kernel.laws import flow, inertias, sees, wrench

NQ = 4
K = 22
BESIDE = 1e-6  # [m, rad, m/s, rad/s] of a one-sided difference
FREEDOMS = (0, 1, 3, 2)  # of (surge, sway, roll, yaw)
SHOWS = (0, 1, 2, 3, 4, 5, 7, 6)  # entries of `Shown` in the order of a state


@compiled
def constants(body: Array, p: Array, on: Any, k: Array) -> None:
    """Fill k (22,): mass; inverse of the whole mass, water and ballast, the last three in the order of `Mass`."""
    water, hull = np.zeros(7), np.zeros(7)
    inertias(p, on, water, hull)
    k[0] = body[0]
    for i in range(7):
        k[8 + i], k[15 + i] = water[i], hull[i]
    m11, a, b, c = body[0], body[0], 0.0, body[2]  # surge; sway, sway-yaw, yaw
    d, e, f = 0.0, body[1], 0.0  # sway-roll, roll, roll-yaw
    m11 += water[0] + hull[0]
    a += water[1] + hull[1]
    b += water[2] + hull[2]
    c += water[3] + hull[3]
    d += water[4] + hull[4]
    e += water[5] + hull[5]
    f += water[6] + hull[6]
    determinant = a * (c * e - f * f) - b * (b * e - d * f) + d * (b * f - c * d)
    k[1] = 1.0 / m11
    k[2] = (c * e - f * f) / determinant
    k[3] = (d * f - b * e) / determinant
    k[4] = (a * e - d * d) / determinant
    k[5] = (b * f - c * d) / determinant
    k[6] = (a * c - b * b) / determinant
    k[7] = (b * d - a * f) / determinant


@inlined
def accelerations(t: float, y: Any, act: Array, p: Array, on: Any, k: Array, extra: Any) -> Any:
    """Accelerations (x'', y'', psi'', p'); extra is a further body force (X, Y, N, K)."""
    c, s, r = cos(y[2]), sin(y[2]), y[6]
    u, v = c * y[4] + s * y[5], c * y[5] - s * y[4]
    north, east = flow(p, on)
    uc, vc = c * north + s * east, c * east - s * north
    w = wrench(sees(t, y[0], y[1], y[2], y[3], u, v, y[7], r, u - uc, v - vc, c, s, act), p, on)
    # as in the plane: Coriolis forces of water and ballast are in their laws; the hull turns in a uniform current
    X = w.X + extra[0] + k[0] * v * r + k[8] * r * vc
    Y = w.Y + extra[1] - k[0] * u * r - k[9] * r * uc
    N = w.N + extra[2] - k[10] * r * uc
    L = w.K + extra[3] - k[12] * r * uc
    along, across = k[1] * X - r * v, k[2] * Y + k[3] * N + k[5] * L + r * u
    turning, rolling = k[3] * Y + k[4] * N + k[7] * L, k[5] * Y + k[7] * N + k[6] * L
    return c * along - s * across, s * along + c * across, turning, rolling


@inlined
def step(t: float, y: Any, dt: float, act: Array, p: Array, on: Any, k: Array, extra: Any) -> Any:
    """One Runge-Kutta step of fourth order with the actuators held; state tuple in, state tuple out."""
    z, at = y, 0.0
    s0 = s1 = s2 = s3 = r0 = r1 = r2 = r3 = 0.0
    for stage in range(4):  # a loop, so that the laws are compiled once
        a0, a1, a2, a3 = accelerations(t + at, z, act, p, on, k, extra)
        w = 1.0 if stage == 0 or stage == 3 else 2.0
        s0 += w * z[4]
        s1 += w * z[5]
        s2 += w * z[6]
        s3 += w * z[7]
        r0 += w * a0
        r1 += w * a1
        r2 += w * a2
        r3 += w * a3
        at = dt if stage == 2 else 0.5 * dt
        z = (
            y[0] + at * z[4], y[1] + at * z[5], y[2] + at * z[6], y[3] + at * z[7],
            y[4] + at * a0, y[5] + at * a1, y[6] + at * a2, y[7] + at * a3,
        )  # fmt: skip
    w = dt / 6.0
    return (
        y[0] + w * s0, y[1] + w * s1, y[2] + w * s2, y[3] + w * s3,
        y[4] + w * r0, y[5] + w * r1, y[6] + w * r2, y[7] + w * r3,
    )  # fmt: skip


@lean
def step_in_place(t: float, y: Array, dt: float, act: Array, p: Array, on: Any, k: Array, extra: Array) -> None:
    """`step` on arrays."""
    z = (y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7])
    z = step(t, z, dt, act, p, on, k, (extra[0], extra[1], extra[2], extra[3]))
    for i in range(8):
        y[i] = z[i]


@lean
def steps(t: float, y: Array, dt: float, n: int, act: Array, p: Array, on: Any, k: Array) -> None:
    """N steps with the actuators held, in place."""
    z = (y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7])
    for i in range(n):
        z = step(t + i * dt, z, dt, act, p, on, k, (0.0, 0.0, 0.0, 0.0))
    for i in range(8):
        y[i] = z[i]


@lean
def forces(t: float, y: Array, act: Array, p: Array, on: Any) -> tuple[float, float, float, float]:
    """Body-axes wrench (X, Y, N, K) of all laws at a state."""
    c, s = cos(y[2]), sin(y[2])
    u, v = c * y[4] + s * y[5], c * y[5] - s * y[4]
    north, east = flow(p, on)
    uc, vc = c * north + s * east, c * east - s * north
    w = wrench(sees(t, y[0], y[1], y[2], y[3], u, v, y[7], y[6], u - uc, v - vc, c, s, act), p, on)
    return w.X, w.Y, w.N, w.K


@lean
def slopes(t: float, y: Array, act: Array, p: Array, on: Any, k: Array, extra: Array, out: Array) -> None:
    """Derivatives of the accelerations by the state, one-sided, to out[:4, :8]."""
    force = (extra[0], extra[1], extra[2], extra[3])
    b0 = b1 = b2 = b3 = 0.0
    for j in range(-1, 8):  # a loop, so that the laws are compiled once
        z = (
            y[0] + BESIDE * (j == 0), y[1] + BESIDE * (j == 1), y[2] + BESIDE * (j == 2), y[3] + BESIDE * (j == 3),
            y[4] + BESIDE * (j == 4), y[5] + BESIDE * (j == 5), y[6] + BESIDE * (j == 6), y[7] + BESIDE * (j == 7),
        )  # fmt: skip
        a0, a1, a2, a3 = accelerations(t, z, act, p, on, k, force)
        if j < 0:
            b0, b1, b2, b3 = a0, a1, a2, a3
        else:
            out[0, j], out[1, j] = (a0 - b0) / BESIDE, (a1 - b1) / BESIDE
            out[2, j], out[3, j] = (a2 - b2) / BESIDE, (a3 - b3) / BESIDE


@inlined
def force_slopes(y: Array, k: Array, A: Any, row: int, column: int) -> None:
    """Derivatives of the accelerations by a body force (X, Y, N, K), to A[row:row + 4, column:column + 4]."""
    c, s = cos(y[2]), sin(y[2])
    A[row, column], A[row + 1, column], A[row + 2, column], A[row + 3, column] = c * k[1], s * k[1], 0.0, 0.0
    for j in range(3):
        to_sway = k[2] if j == 0 else k[3] if j == 1 else k[5]
        A[row, column + 1 + j], A[row + 1, column + 1 + j] = -s * to_sway, c * to_sway
    A[row + 2, column + 1], A[row + 2, column + 2], A[row + 2, column + 3] = k[3], k[4], k[7]
    A[row + 3, column + 1], A[row + 3, column + 2], A[row + 3, column + 3] = k[5], k[7], k[6]


@inlined
def moved(y: Array) -> Any:
    """What instruments that show the truth would show of a state: x, y, psi, phi, u, v, p, r."""
    c, s = cos(y[2]), sin(y[2])
    return y[0], y[1], y[2], y[3], c * y[4] + s * y[5], c * y[5] - s * y[4], y[7], y[6]


@inlined
def add_to_mujoco(t: float, q: Array, qd: Array, act: Array, p: Array, k: Array, f: Array, M: Array) -> None:
    """Add the passive force (4,) and the lower triangle (10,) of J' M J, MuJoCo's z-up joints x, y, psi, phi.

    z up means y, psi and their rates change sign on the way in, sway force and yaw moment on the way out; roll is the
    same rotation in both.
    """
    on = ()
    c, s, r = cos(-q[2]), sin(-q[2]), -qd[2]
    u, v = c * qd[0] - s * qd[1], -c * qd[1] - s * qd[0]
    north, east = flow(p, on)
    ur, vr = u - (c * north + s * east), v - (c * east - s * north)
    w = wrench(sees(t, q[0], -q[1], -q[2], q[3], u, v, qd[3], r, ur, vr, c, s, act), p, on)
    X = w.X - r * (k[8] * vr + k[15] * v)  # - M (J' q'' without its q'' part)
    Y = w.Y + r * (k[9] * ur + k[16] * u)
    f[0] += c * X - s * Y
    f[1] -= s * X + c * Y
    f[2] -= w.N + r * (k[10] * ur + k[17] * u)
    f[3] += w.K + r * (k[12] * ur + k[19] * u)
    a11, a22, a26, a66 = k[8] + k[15], k[9] + k[16], k[10] + k[17], k[11] + k[18]
    a24, a44, a46 = k[12] + k[19], k[13] + k[20], k[14] + k[21]
    M[0] += c * c * a11 + s * s * a22
    M[1] -= c * s * (a11 - a22)
    M[2] += s * s * a11 + c * c * a22
    M[3] += s * a26
    M[4] += c * a26
    M[5] += a66
    M[6] -= s * a24
    M[7] -= c * a24
    M[8] -= a46
    M[9] += a44
