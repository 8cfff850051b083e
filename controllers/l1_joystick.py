"""L1 joystick controller for surge, sway and yaw demands at the same time."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.joystick import AdaptiveJoystick


@dataclass
class L1Joystick(AdaptiveJoystick):
    """L1 control of yaw (gyro) and surge (speed sensor, if present); sway in open loop."""

    words: ClassVar[str] = (
        "L1 adaptive joystick, corrected: surge, sway and yaw commands at the same time"
    )
