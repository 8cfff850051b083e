"""Signatures of a vessel's equations of motion.

`boatsim.physics.kernel.source` generates the file that replaces this.

State s = (joint coordinates, their rates) of the vessel's degrees of freedom, NQ each. k: masses
(`inertia`).
"""

from typing import Any

import numpy as np

from boatsim.physics.signals import Array, MeasuredMotion

NQ = 0  # positions; the state has twice as many
K = 0  # masses, constant over a run
FREE: tuple[int, ...] = ()  # places among (surge, sway, heave, roll, pitch, yaw)
FREED: tuple[float, ...] = ()  # for each of the six: 1 if it is free, else 0
SHOWS: tuple[int, ...] = ()  # entries of `MeasuredMotion` in the order of a state
HULL_FIXED_AXES = False  # whether the body axes are fixed in the hull; else they are level
CLOSED = True  # whether one inverse of the mass matrix serves all states
DIFFERENCE = 1e-6  # [m, rad, m/s, rad/s] step of one-sided finite differences


def step_in_place(
    t: float, y: Array, dt: float, act: Array, p: Array, on: Any, k: Array, extra: Array
) -> None:
    """Advance the vessel's state y by one Runge-Kutta step of fourth order.

    `extra` is a further body force (NQ,).
    """


def advance_memory_of_motion(
    t: float, s: Array, dt: float, memory: Array, act: Array, p: Array, on: Any
) -> None:
    """Advance the states of effects that remember the motion to s, where a step dt begins."""


def total_body_force(
    t: float, s: Array, act: Array, at: Any, p: Array, on: Any
) -> tuple[float, ...]:
    """Return the sum (NQ,) of the body forces of all effects, with the actuators act[at:]."""
    raise NotImplementedError


def air_body_force(t: float, s: Array, act: Array, at: Any, p: Array, on: Any) -> tuple[float, ...]:
    """Return the sum (NQ,) of the body forces of the air, with the actuators act[at:]."""
    raise NotImplementedError


def acceleration_jacobian(
    t: float, s: Array, act: Array, p: Array, on: Any, k: Array, extra: Array, out: Array
) -> None:
    """Write the derivatives of the vessel's accelerations by its state to out (NQ, 2 NQ).

    The accelerations are those of the joint coordinates.
    """


def acceleration_per_force(s: Array, k: Array, A: Array, row: np.int64, column: np.int64) -> None:
    """Write d(acceleration)/d(body force) into the filter's system matrix A, at row and column."""


def instrument_readings(
    t: float, s: Any, act: Array, at: Any, p: Array, on: Any, k: Array, extra: Any
) -> tuple[float, ...]:
    """Return noiseless readings of instruments on board for a state of the vessel.

    They are psi, r, acceleration along x and y, u, v, x, y, phi, p.
    """
    raise NotImplementedError


def pose_and_velocities(s: Any) -> MeasuredMotion:
    """Return the true values of all recorded signals (pose and velocities) in a state."""
    raise NotImplementedError


def expected_measurement_of_level_hull(s: Array, code: int, row: Array) -> float:
    """Return the expected value of one measured channel for axes that stay level.

    Fills its row of the measurement matrix.
    """
    raise NotImplementedError


def add_force_and_inertia_to_mujoco(
    t: float, q: Array, qd: Array, act: Array, at: Any, p: Array, k: Array, force: Array, M: Array
) -> None:
    """Add the vessel's passive force and added inertia J' M J to MuJoCo's arrays.

    Only the lower triangle of J' M J is added. Both are in MuJoCo's coordinates.
    """
