"""L1 joystick controller for surge, sway and yaw demands at the same time."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.joystick import AdaptiveJoystick
from boatsim.control.lag_design import HEADING_SHARE, LagBasedController, bandwidth_for_delay
from boatsim.physics.base import UNSET, param

# of the low-pass bandwidth in yaw: at half the assumed input gain, bandwidth and pole are then
# equal, and L1 norm times slope has the value 2 / e = 0.74
POLE_SHARE = 0.5
# of the pole: the L1-norm condition needs more than 1, and noise of the speed log needs little
SURGE_SHARE = 1.2


@dataclass
class L1Joystick(LagBasedController, AdaptiveJoystick):
    """L1 adaptive joystick controller of a boat with two outboards.

    Yaw is controlled by the gyro and surge by a speed sensor, if present; sway is in open loop.
    Gains that are not given follow from the known lag and delay of the vessel. With the effective
    delay theta = period / 2 + motor_lag + command_delay + 0.33 s the bandwidth of the low-pass in
    yaw is 1 / (2 theta), that of the SIMC rule for an integrating process (S. Skogestad, Journal of
    Process Control 13, 2003). The pole is half of it, the low-pass in surge 1.2 times the pole, and
    the heading gain a fifth of the bandwidth.
    """

    words: ClassVar[str] = (
        "L1 adaptive joystick, corrected: surge, sway and yaw commands at the same time"
    )

    pole: float = param(
        UNSET, low=0.01, high=10.0, unit="1/s", words="pole of the reference motion"
    )
    yaw_bandwidth: float = param(
        UNSET, low=0.02, high=20.0, unit="rad/s", words="low-pass of the yaw estimate"
    )
    surge_bandwidth: float = param(
        UNSET, low=0.01, high=20.0, unit="rad/s", words="low-pass of the surge estimate"
    )
    heading_gain: float = param(
        UNSET, low=0.0, high=5.0, unit="1/s", words="yaw rate demanded per heading error"
    )

    def derive_gains(self) -> None:
        """Set the gains that are not given by the effective delay."""
        if self.yaw_bandwidth is UNSET:
            self.yaw_bandwidth = bandwidth_for_delay(self.effective_delay())
        if self.pole is UNSET:
            self.pole = POLE_SHARE * self.yaw_bandwidth
        if self.surge_bandwidth is UNSET:
            self.surge_bandwidth = SURGE_SHARE * self.pole
        if self.heading_gain is UNSET:
            self.heading_gain = HEADING_SHARE * self.yaw_bandwidth
