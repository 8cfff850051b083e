"""Motion of a vessel in the axes of an autopilot, and the readings of its inertial unit.

The axes of the earth are north, east and down; those of the body are fixed in the hull and point
forward, right and down (FRD). Angles are roll, pitch and yaw (Euler angles in the order yaw, pitch,
roll), as in SNAME.
"""

from math import cos, sin
from typing import NamedTuple

from boatsim.simulate.stepper import Stepper

# [m/s^2] standard gravity, which ArduPilot's estimator adds to the measured specific force
GRAVITY = 9.80665
Vector = tuple[float, float, float]


class MotionSample(NamedTuple):
    """Motion of a vessel's origin at one time.

    Attributes:
        t: Time [s].
        position: North, east and down [m].
        attitude: Roll, pitch and yaw, not wrapped [rad].
        velocity: Over ground, to north, east and down [m/s].
    """

    t: float
    position: Vector
    attitude: Vector
    velocity: Vector


class InertialReading(NamedTuple):
    """Means of an inertial unit at the origin of the vessel over one frame, in body axes.

    Attributes:
        rates: Angular velocity about the forward, right and down axis [rad/s].
        specific_force: Acceleration over ground less gravity [m/s^2]; (0, 0, -9.81) at rest.
    """

    rates: Vector
    specific_force: Vector


def sample_motion(engine: Stepper) -> MotionSample:
    """Return the present motion of an engine's vessel.

    Args:
        engine: The engine.
    """
    state = engine.state
    return MotionSample(
        state.t,
        (state.x, state.y, state.z),
        (state.phi, state.theta, state.psi),
        engine.velocity_over_ground(),
    )


def inertial_reading(before: MotionSample, after: MotionSample) -> InertialReading:
    """Return what an inertial unit measures on average between two samples of the motion.

    The means are those of an integrating unit: the sum over frames of the specific force, turned
    into the axes of the earth, plus gravity is the change of the velocity. The attitude for turning
    is the mean of both.

    Args:
        before: Motion at the begin of the frame.
        after: Motion at its end, later.
    """
    dt = after.t - before.t
    mean, turned, gained = [], [], []
    for old, new in zip(before.attitude, after.attitude, strict=True):
        mean.append(0.5 * (old + new))
        turned.append((new - old) / dt)
    for old, new in zip(before.velocity, after.velocity, strict=True):
        gained.append((new - old) / dt)
    roll, pitch, yaw = mean
    roll_rate, pitch_rate, yaw_rate = turned
    rates = (
        roll_rate - yaw_rate * sin(pitch),
        pitch_rate * cos(roll) + yaw_rate * cos(pitch) * sin(roll),
        yaw_rate * cos(pitch) * cos(roll) - pitch_rate * sin(roll),
    )
    force = body_components((gained[0], gained[1], gained[2] - GRAVITY), (roll, pitch, yaw))
    return InertialReading(rates, force)


def body_components(vector: Vector, attitude: Vector) -> Vector:
    """Return the components in body axes of a vector that is given in earth axes.

    Args:
        vector: Components to north, east and down.
        attitude: Roll, pitch and yaw of the body [rad].
    """
    north, east, down = vector
    roll, pitch, yaw = attitude
    ahead, across = cos(yaw) * north + sin(yaw) * east, cos(yaw) * east - sin(yaw) * north
    forward, below = cos(pitch) * ahead - sin(pitch) * down, sin(pitch) * ahead + cos(pitch) * down
    return (
        forward,
        cos(roll) * across + sin(roll) * below,
        cos(roll) * below - sin(roll) * across,
    )
