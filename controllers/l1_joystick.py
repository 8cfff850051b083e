"""L1 joystick controller for surge, sway and yaw demands at the same time."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.joystick import AdaptiveJoystick


@dataclass
class L1Joystick(AdaptiveJoystick):
    """L1 adaptive joystick controller of a boat with two outboards.

    Yaw is controlled by the gyro and surge by a speed sensor, if present; sway is in open loop.
    """

    words: ClassVar[str] = (
        "L1 adaptive joystick, corrected: surge, sway and yaw commands at the same time"
    )
