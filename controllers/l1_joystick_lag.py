"""L1 joystick controller whose gains follow from the known delay and lag of the boat."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.joystick import AdaptiveJoystick
from boatsim.control.lag_joystick import HEADING_SHARE, RESERVE
from boatsim.physics.base import UNSET, param

# of the low-pass bandwidth in yaw: at half the assumed input gain, bandwidth and pole are then
# equal, and L1 norm times slope has the value 2 / e = 0.74
POLE_SHARE = 0.5
# of the pole: the L1-norm condition needs more than 1, and noise of the speed log needs little
SURGE_SHARE = 1.2


@dataclass
class L1JoystickLag(AdaptiveJoystick):
    """L1 adaptive joystick of two outboards, designed for the delay and lag of the boat.

    Loops and sensors are those of `l1_joystick`.
    Gains that are not given follow from the known delay and lag of the boat. With the effective
    delay theta = period / 2 + command_delay + motor_lag + 0.3 s the bandwidth of the low-pass in
    yaw is 1 / (2 theta), that of the SIMC rule for an integrating process (S. Skogestad, Journal of
    Process Control 13, 2003). The pole is half of it, the low-pass in surge 1.2 times the pole, and
    the heading gain a fifth of the bandwidth.
    """

    words: ClassVar[str] = (
        "L1 adaptive joystick whose gains follow from the known delay and motor lag of the boat"
    )

    pole: float = param(UNSET, low=0.1, high=10.0, unit="1/s", words="pole of the reference motion")
    yaw_bandwidth: float = param(
        UNSET, low=0.1, high=20.0, unit="rad/s", words="low-pass of the yaw estimate"
    )
    surge_bandwidth: float = param(
        UNSET, low=0.05, high=20.0, unit="rad/s", words="low-pass of the surge estimate"
    )
    heading_gain: float = param(
        UNSET, low=0.0, high=5.0, unit="1/s", words="yaw rate demanded per heading error"
    )
    motor_lag: float = param(
        0.15, low=0.0, high=1.0, unit="s", words="known time constant of the motors"
    )
    command_delay: float = param(
        0.0, low=0.0, high=1.0, unit="s", words="known delay of all commands"
    )

    def __post_init__(self) -> None:
        """Derive the gains that are not given from the known delay and lag.

        Raises:
            BadInput: A parameter is out of bounds.
        """
        delay = 0.5 * self.period + self.command_delay + self.motor_lag + RESERVE
        if self.yaw_bandwidth is UNSET:
            self.yaw_bandwidth = 0.5 / delay
        if self.pole is UNSET:
            self.pole = POLE_SHARE * self.yaw_bandwidth
        if self.surge_bandwidth is UNSET:
            self.surge_bandwidth = SURGE_SHARE * self.pole
        if self.heading_gain is UNSET:
            self.heading_gain = HEADING_SHARE * self.yaw_bandwidth
        super().__post_init__()
