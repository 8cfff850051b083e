"""The corrected L1 joystick controller: one program for surge, sway and yaw commands at once."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.joystick import AdaptiveJoystick


@dataclass
class L1Joystick(AdaptiveJoystick):
    """Yaw by the gyro, surge by the speed sensor if there is one, sway in open loop."""

    words: ClassVar[str] = "L1 adaptive joystick, corrected: surge, sway and yaw commands at once"
