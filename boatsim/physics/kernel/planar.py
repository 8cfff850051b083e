"""Surge, sway and yaw: the equations of motion in joint coordinates, and what MuJoCo's callback adds to them.

State y = (x, y, psi, x', y', psi') in earth axes, SNAME. The origin of motion is the mass centre. Constants k of one
pass (see `constants`): rigid mass, inverse of the whole mass matrix, added mass, ballast.
"""

from math import cos, sin
from typing import Any

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import compiled, inlined, lean
from boatsim.physics.kernel.laws import flow, inertias, sees, wrench

NQ = 3  # positions; the state has twice as many
K = 13  # constants of a pass
FREEDOMS = (0, 1, 3)  # of (surge, sway, roll, yaw)
BESIDE = 1e-6  # [m, rad, m/s, rad/s] of a one-sided difference
SHOWS = (0, 1, 2, 4, 5, 7)  # entries of `Shown` in the order of a state


@compiled
def constants(body: Array, p: Array, on: Any, k: Array) -> None:
    """Fill k (13,): mass; inverse i11 i22 i26 i66; water a11 a22 a26 a66; ballast b11 b22 b26 b66."""
    water, hull = np.zeros(7), np.zeros(7)
    inertias(p, on, water, hull)
    k[0] = body[0]
    for i in range(4):
        k[5 + i], k[9 + i] = water[i], hull[i]
    m22, m26, m66 = body[0] + water[1] + hull[1], water[2] + hull[2], body[2] + water[3] + hull[3]
    determinant = m22 * m66 - m26 * m26
    k[1] = 1.0 / (body[0] + water[0] + hull[0])
    k[2], k[3], k[4] = m66 / determinant, -m26 / determinant, m22 / determinant


@inlined
def accelerations(t: float, y: Any, act: Array, p: Array, on: Any, k: Array, extra: Any) -> Any:
    """Earth-axes accelerations (x'', y'', psi''); extra is a further body force (X, Y, N)."""
    c, s, r = cos(y[2]), sin(y[2]), y[5]
    u, v = c * y[3] + s * y[4], c * y[4] - s * y[3]
    north, east = flow(p, on)
    uc, vc = c * north + s * east, c * east - s * north
    w = wrench(sees(t, y[0], y[1], y[2], 0.0, u, v, 0.0, r, u - uc, v - vc, c, s, act), p, on)
    # body-axes equation: the Coriolis force of water and ballast is part of their laws; a hull that turns in a uniform
    # current sees the water accelerate by (r vc, -r uc)
    X = w.X + extra[0] + k[0] * v * r + k[5] * r * vc
    Y = w.Y + extra[1] - k[0] * u * r - k[6] * r * uc
    N = w.N + extra[2] - k[7] * r * uc
    along, across = k[1] * X - r * v, k[2] * Y + k[3] * N + r * u
    return c * along - s * across, s * along + c * across, k[3] * Y + k[4] * N


@inlined
def step(t: float, y: Any, dt: float, act: Array, p: Array, on: Any, k: Array, extra: Any) -> Any:
    """One Runge-Kutta step of fourth order with the actuators held; state tuple in, state tuple out."""
    z, at = y, 0.0
    s0 = s1 = s2 = r0 = r1 = r2 = 0.0
    for stage in range(4):  # a loop, so that the laws are compiled once
        a0, a1, a2 = accelerations(t + at, z, act, p, on, k, extra)
        w = 1.0 if stage == 0 or stage == 3 else 2.0
        s0 += w * z[3]
        s1 += w * z[4]
        s2 += w * z[5]
        r0 += w * a0
        r1 += w * a1
        r2 += w * a2
        at = dt if stage == 2 else 0.5 * dt
        z = (
            y[0] + at * z[3], y[1] + at * z[4], y[2] + at * z[5],
            y[3] + at * a0, y[4] + at * a1, y[5] + at * a2,
        )  # fmt: skip
    w = dt / 6.0
    return y[0] + w * s0, y[1] + w * s1, y[2] + w * s2, y[3] + w * r0, y[4] + w * r1, y[5] + w * r2


@lean
def step_in_place(t: float, y: Array, dt: float, act: Array, p: Array, on: Any, k: Array, extra: Array) -> None:
    """`step` on arrays."""
    z = step(t, (y[0], y[1], y[2], y[3], y[4], y[5]), dt, act, p, on, k, (extra[0], extra[1], extra[2]))
    for i in range(6):
        y[i] = z[i]


@lean
def steps(t: float, y: Array, dt: float, n: int, act: Array, p: Array, on: Any, k: Array) -> None:
    """N steps with the actuators held, in place."""
    z = (y[0], y[1], y[2], y[3], y[4], y[5])
    for i in range(n):
        z = step(t + i * dt, z, dt, act, p, on, k, (0.0, 0.0, 0.0))
    for i in range(6):
        y[i] = z[i]


@lean
def forces(t: float, y: Array, act: Array, p: Array, on: Any) -> tuple[float, float, float]:
    """Body-axes wrench (X, Y, N) of all laws at a state."""
    c, s = cos(y[2]), sin(y[2])
    u, v = c * y[3] + s * y[4], c * y[4] - s * y[3]
    north, east = flow(p, on)
    uc, vc = c * north + s * east, c * east - s * north
    w = wrench(sees(t, y[0], y[1], y[2], 0.0, u, v, 0.0, y[5], u - uc, v - vc, c, s, act), p, on)
    return w.X, w.Y, w.N


@lean
def slopes(t: float, y: Array, act: Array, p: Array, on: Any, k: Array, extra: Array, out: Array) -> None:
    """Derivatives of the accelerations by the state, one-sided, to out[:3, :6]."""
    force = (extra[0], extra[1], extra[2])
    b0 = b1 = b2 = 0.0
    for j in range(-1, 6):  # a loop, so that the laws are compiled once
        z = (
            y[0] + BESIDE * (j == 0), y[1] + BESIDE * (j == 1), y[2] + BESIDE * (j == 2),
            y[3] + BESIDE * (j == 3), y[4] + BESIDE * (j == 4), y[5] + BESIDE * (j == 5),
        )  # fmt: skip
        a0, a1, a2 = accelerations(t, z, act, p, on, k, force)
        if j < 0:
            b0, b1, b2 = a0, a1, a2
        else:
            out[0, j], out[1, j], out[2, j] = (a0 - b0) / BESIDE, (a1 - b1) / BESIDE, (a2 - b2) / BESIDE


@inlined
def force_slopes(y: Array, k: Array, A: Any, row: int, column: int) -> None:
    """Derivatives of the accelerations by a body force (X, Y, N), to A[row:row + 3, column:column + 3]."""
    c, s = cos(y[2]), sin(y[2])
    A[row, column], A[row, column + 1], A[row, column + 2] = c * k[1], -s * k[2], -s * k[3]
    A[row + 1, column], A[row + 1, column + 1], A[row + 1, column + 2] = s * k[1], c * k[2], c * k[3]
    A[row + 2, column], A[row + 2, column + 1], A[row + 2, column + 2] = 0.0, k[3], k[4]


@inlined
def moved(y: Array) -> Any:
    """What instruments that show the truth would show of a state: x, y, psi, phi, u, v, p, r."""
    c, s = cos(y[2]), sin(y[2])
    return y[0], y[1], y[2], 0.0, c * y[3] + s * y[4], c * y[4] - s * y[3], 0.0, y[5]


@inlined
def add_to_mujoco(t: float, q: Array, qd: Array, act: Array, p: Array, k: Array, f: Array, M: Array) -> None:
    """Add the passive force (3,) and the lower triangle (6,) of J' M J, MuJoCo's z-up joint coordinates.

    z up means y, psi and their rates change sign on the way in, sway force and yaw moment on the way out. This is the
    only place where the two conventions meet while stepping; `boatsim.simulate.engine` translates poses.
    """
    on = ()
    c, s, r = cos(-q[2]), sin(-q[2]), -qd[2]
    u, v = c * qd[0] - s * qd[1], -c * qd[1] - s * qd[0]
    north, east = flow(p, on)
    ur, vr = u - (c * north + s * east), v - (c * east - s * north)
    w = wrench(sees(t, q[0], -q[1], -q[2], 0.0, u, v, 0.0, r, ur, vr, c, s, act), p, on)
    X = w.X - r * (k[5] * vr + k[9] * v)  # - M (J' q'' without its q'' part)
    Y = w.Y + r * (k[6] * ur + k[10] * u)
    f[0] += c * X - s * Y
    f[1] -= s * X + c * Y
    f[2] -= w.N + r * (k[7] * ur + k[11] * u)
    a11, a22, a26 = k[5] + k[9], k[6] + k[10], k[7] + k[11]
    M[0] += c * c * a11 + s * s * a22
    M[1] -= c * s * (a11 - a22)
    M[2] += s * s * a11 + c * c * a22
    M[3] += s * a26
    M[4] += c * a26
    M[5] += k[8] + k[12]
