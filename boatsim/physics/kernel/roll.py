"""Roll alone: a hull that rolls about a fixed axis, as in a roll decay test.

State y = (phi, phi'). The origin of motion is the mass centre; roll is the same rotation in SNAME and in z-up axes.
"""

from typing import Any

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import compiled, inlined, lean
from boatsim.physics.kernel.laws import inertias, sees, wrench

NQ = 1
K = 2
FREEDOMS = (2,)  # of (surge, sway, roll, yaw)
BESIDE = 1e-6  # [rad, rad/s] of a one-sided difference
SHOWS = (3, 6)  # entries of `Shown` in the order of a state


@compiled
def constants(body: Array, p: Array, on: Any, k: Array) -> None:
    """Fill k (2,): inverse of the whole roll inertia; inertia that water and ballast add."""
    water, hull = np.zeros(7), np.zeros(7)
    inertias(p, on, water, hull)
    k[1] = water[5] + hull[5]
    k[0] = 1.0 / (body[1] + k[1])


@lean
def accelerations(t: float, y: Any, act: Array, p: Array, on: Any, k: Array, extra: Any) -> Any:
    """Roll acceleration phi''; extra is a further moment (K,)."""
    w = wrench(sees(t, 0.0, 0.0, 0.0, y[0], 0.0, 0.0, y[1], 0.0, 0.0, 0.0, 1.0, 0.0, act), p, on)
    return k[0] * (w.K + extra[0])


@inlined
def step(t: float, y: Any, dt: float, act: Array, p: Array, on: Any, k: Array, extra: Any) -> Any:
    """One Runge-Kutta step of fourth order; state tuple in, state tuple out."""
    h = 0.5 * dt
    a = accelerations(t, y, act, p, on, k, extra)
    y2 = (y[0] + h * y[1], y[1] + h * a)
    b = accelerations(t + h, y2, act, p, on, k, extra)
    y3 = (y[0] + h * y2[1], y[1] + h * b)
    c = accelerations(t + h, y3, act, p, on, k, extra)
    y4 = (y[0] + dt * y3[1], y[1] + dt * c)
    d = accelerations(t + dt, y4, act, p, on, k, extra)
    w = dt / 6.0
    return y[0] + w * (y[1] + 2.0 * y2[1] + 2.0 * y3[1] + y4[1]), y[1] + w * (a + 2.0 * b + 2.0 * c + d)


@lean
def step_in_place(t: float, y: Array, dt: float, act: Array, p: Array, on: Any, k: Array, extra: Array) -> None:
    """`step` on arrays."""
    y[0], y[1] = step(t, (y[0], y[1]), dt, act, p, on, k, (extra[0],))


@lean
def steps(t: float, y: Array, dt: float, n: int, act: Array, p: Array, on: Any, k: Array) -> None:
    """N steps with the actuators held, in place."""
    z = (y[0], y[1])
    for i in range(n):
        z = step(t + i * dt, z, dt, act, p, on, k, (0.0,))
    y[0], y[1] = z


@lean
def forces(t: float, y: Array, act: Array, p: Array, on: Any) -> tuple[float]:
    """Roll moment (K,) of all laws at a state."""
    w = wrench(sees(t, 0.0, 0.0, 0.0, y[0], 0.0, 0.0, y[1], 0.0, 0.0, 0.0, 1.0, 0.0, act), p, on)
    return (w.K,)


@lean
def slopes(t: float, y: Array, act: Array, p: Array, on: Any, k: Array, extra: Array, out: Array) -> None:
    """Derivatives of the acceleration by the state, one-sided, to out[0, :2]."""
    base = accelerations(t, (y[0], y[1]), act, p, on, k, (extra[0],))
    out[0, 0] = (accelerations(t, (y[0] + BESIDE, y[1]), act, p, on, k, (extra[0],)) - base) / BESIDE
    out[0, 1] = (accelerations(t, (y[0], y[1] + BESIDE), act, p, on, k, (extra[0],)) - base) / BESIDE


@inlined
def force_slopes(y: Array, k: Array, A: Any, row: int, column: int) -> None:
    """Derivative of the acceleration by a moment (K,), to A[row, column]."""
    A[row, column] = k[0]


@inlined
def moved(y: Array) -> Any:
    """What instruments that show the truth would show of a state: x, y, psi, phi, u, v, p, r."""
    return 0.0, 0.0, 0.0, y[0], 0.0, 0.0, y[1], 0.0


@inlined
def add_to_mujoco(t: float, q: Array, qd: Array, act: Array, p: Array, k: Array, f: Array, M: Array) -> None:
    """Add the passive moment (1,) and the inertia (1,) that MuJoCo does not have."""
    w = wrench(sees(t, 0.0, 0.0, 0.0, q[0], 0.0, 0.0, qd[0], 0.0, 0.0, 0.0, 1.0, 0.0, act), p, ())
    f[0] += w.K
    M[0] += k[1]
