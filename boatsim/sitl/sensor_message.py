"""Messages with the sensor readings that ArduPilot's software in the loop expects.

A message is one line of JSON with a line feed before and after it. ArduPilot does not parse JSON in
general: it searches for the names of the fields and reads the numbers one character after the colon
or bracket, so that the text contains no blanks. Source: libraries/SITL/SIM_JSON.cpp and
examples/JSON/readme.md of ArduPilot.
"""

import json
from math import atan2, hypot

from boatsim.control.base import wrap
from boatsim.sitl.motion_sample import InertialReading, MotionSample, body_components
from boatsim.sitl.true_wind import Velocity


def sensor_message(
    motion: MotionSample, inertial: InertialReading, wind: Velocity | None = None
) -> bytes:
    """Return the message about the end of one frame.

    Args:
        motion: Motion at the end of the frame.
        inertial: Readings of the inertial unit over the frame.
        wind: Velocity of the air over ground, to north and east [m/s]; None if it is not known.
    """
    fields: dict[str, object] = {
        "timestamp": motion.t,
        "imu": {"gyro": inertial.rates, "accel_body": inertial.specific_force},
        "position": motion.position,
        "attitude": tuple(map(wrap, motion.attitude)),
        "velocity": motion.velocity,
    }
    if wind is not None:
        fields["windvane"] = apparent_wind(motion, wind)
    return b"\n" + json.dumps(fields, separators=(",", ":"), allow_nan=False).encode() + b"\n"


def apparent_wind(motion: MotionSample, wind: Velocity) -> dict[str, float]:
    """Return direction and speed of the wind as a vane on the vessel shows them.

    Args:
        motion: Motion of the vessel.
        wind: Velocity of the air over ground, to north and east [m/s].

    Returns:
        `direction` that the wind comes from, clockwise from the bow [rad], and `speed` [m/s].
    """
    north, east = wind[0] - motion.velocity[0], wind[1] - motion.velocity[1]
    heading = (0.0, 0.0, motion.attitude[2])
    ahead, across, _ = body_components((north, east, 0.0), heading)
    speed = hypot(ahead, across)
    direction = 0.0
    if speed > 0.0:
        direction = atan2(-across, -ahead)
    return {"direction": direction, "speed": speed}
