"""Motion in the axes of ROS: REP 103, x east, y north, z up; hull x forward, y port, z up.

Recordings have SNAME axes: x north, y east, z down, heading clockwise from north; hull x forward,
y starboard, z down.
"""

from math import pi

import numpy as np

from boatsim.physics.base import Array


def ros_position(x: Array, y: Array, z: Array) -> Array:
    """Return positions east, north and up (N, 3) [m] from x, y and z, each (N,) [m]."""
    return np.column_stack([y, x, 0.0 - z])


def ros_orientation(phi: Array, theta: Array, psi: Array) -> Array:
    """Return the orientation of a hull as quaternions x, y, z, w (N, 4).

    Roll stays, pitch changes its sign, and yaw = 90 degrees - psi is counted from east to north.

    Args:
        phi: Roll (N,) [rad], starboard down.
        theta: Pitch (N,) [rad], bow up.
        psi: Heading (N,) [rad], clockwise from north.
    """
    roll, pitch, yaw = phi / 2, -theta / 2, (pi / 2 - psi) / 2
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    return np.column_stack(
        [
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        ]
    )


def ros_vector(forward: Array, starboard: Array, down: Array) -> Array:
    """Return vectors forward, to port and up (N, 3) from their SNAME components, each (N,).

    Args:
        forward: u, or the roll rate p.
        starboard: v, or the pitch rate q.
        down: w, or the yaw rate r.
    """
    return np.column_stack([forward, 0.0 - starboard, 0.0 - down])
