"""Motion of a sensor that is not at the origin of the vessel, in six degrees of freedom."""

from math import cos, sin

import numpy as np

from boatsim.physics.signals import Array
from boatsim.simulate.stepper import State


def body_to_earth(phi: float, theta: float, psi: float) -> Array:
    """Return the rotation matrix (3, 3) from body axes to north, east and down.

    T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, eq. 2.31.

    Args:
        phi: Roll angle [rad].
        theta: Pitch angle [rad].
        psi: Heading [rad].
    """
    cf, sf = cos(phi), sin(phi)
    ct, st = cos(theta), sin(theta)
    cp, sp = cos(psi), sin(psi)
    return np.array(
        [
            [cp * ct, cp * st * sf - sp * cf, sp * sf + cp * cf * st],
            [sp * ct, cp * cf + sf * st * sp, st * sp * cf - cp * sf],
            [-st, ct * sf, ct * cf],
        ]
    )


def rotation_of(state: State) -> Array:
    """Return the rotation matrix (3, 3) of a vessel from body axes to north, east and down.

    Args:
        state: State of the vessel.
    """
    return body_to_earth(state.phi, state.theta, state.psi)


def position_of(state: State, place: Array) -> Array:
    """Return the position (3,) of a point of a vessel: north, east, down of the start [m].

    Args:
        state: State of the vessel.
        place: The point (3,): ahead, to starboard and below the origin of motion [m].
    """
    return np.array([state.x, state.y, state.z]) + rotation_of(state) @ place


def velocity_of(state: State, place: Array) -> Array:
    """Return the velocity (3,) of a point of a vessel over ground, in body axes [m/s].

    Args:
        state: State of the vessel.
        place: The point (3,): ahead, to starboard and below the origin of motion [m].
    """
    turning = np.array([state.p, state.q, state.r])
    return np.array([state.u, state.v, state.w]) + np.cross(turning, place)
