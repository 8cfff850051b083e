"""Signatures of a vessel's equations of motion. `boatsim.physics.kernel.equations` writes the real ones in its place.

State s = (joint coordinates, their rates) of the freedoms there are, NQ each; k the constants of a pass (`inertia`).
"""

from typing import Any

import numpy as np

from boatsim.physics.signals import Array, Shown

NQ = 0  # positions; the state has twice as many
K = 0  # constants of a pass
FREE: tuple[int, ...] = ()  # of (surge, sway, heave, roll, pitch, yaw)
FREED: tuple[float, ...] = ()  # 1 for each of the six that is free
SHOWS: tuple[int, ...] = ()  # entries of `Shown` in the order of a state
TILTS = False  # axes are fixed in the hull
CLOSED = True  # the whole mass matrix is inverted once
BESIDE = 1e-6  # [m, rad, m/s, rad/s] of a one-sided difference


def step_in_place(
    t: float, y: Array, dt: float, act: Array, p: Array, on: Any, k: Array, extra: Array
) -> None:
    """One Runge-Kutta step of fourth order; act: the actuators at its begin, middle and end."""


def forces(t: float, s: Array, act: Array, at: Any, p: Array, on: Any) -> tuple[float, ...]:
    """Body force of all laws, over the freedoms, under the actuators act[at:]."""
    raise NotImplementedError


def slopes(
    t: float, s: Array, act: Array, p: Array, on: Any, k: Array, extra: Array, out: Array
) -> None:
    """Derivatives of the joint accelerations by the state, one-sided, to out (NQ, 2 NQ)."""


def force_slopes(s: Array, k: Array, A: Array, row: np.int64, column: np.int64) -> None:
    """Derivatives of the joint accelerations by a body force over the freedoms, to A[row:, column:]."""


def feels(
    t: float, s: Any, act: Array, at: Any, p: Array, on: Any, k: Array, extra: Any
) -> tuple[float, ...]:
    """What instruments aboard would feel: psi, r, acceleration over ground along x and y, u, v, x, y, phi, p."""
    raise NotImplementedError


def moved(s: Any) -> Shown:
    """What instruments that show the truth would show of a state."""
    raise NotImplementedError


def observe_level(s: Array, code: int, row: Array) -> float:
    """Expected value of one measured channel and its row of the measurement matrix, axes that do not tilt."""
    raise NotImplementedError


def add_to_mujoco(
    t: float, q: Array, qd: Array, act: Array, at: Any, p: Array, k: Array, force: Array, M: Array
) -> None:
    """Add the passive force and the lower triangle of J' M J, in MuJoCo's z-up joint coordinates."""
