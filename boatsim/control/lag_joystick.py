"""Joystick controllers of two outboards that are designed by one rule from the lag of the boat.

They differ only in the law of one axis, from a demanded velocity to a force or moment. Nominal
inertias, the outer loop of the heading, the control allocation and the rule for the gains are the
same, so that a comparison is one of the laws.
"""

from dataclasses import dataclass
from math import exp
from typing import ClassVar

from boatsim.control.allocation import STICK, Outboards
from boatsim.control.compiled import CompiledController, merged
from boatsim.control.joystick import joystick_operating_points, outboard_loop
from boatsim.control.lag_design import (
    HEADING_SHARE,
    POLE_SHARE,
    LagBasedController,
    bandwidth_for_delay,
)
from boatsim.control.operating_points import (
    AxisLaw,
    FeedbackLoop,
    OperatingPoint,
    sampled_linear_law,
)
from boatsim.physics.base import UNSET, param


@merged
def actuator_output(before: float, commanded: float, lag: float, period: float) -> float:
    """Return the modelled force of a first-order actuator at the end of a period [N or N m].

    Args:
        before: Force at the begin of the period [N or N m].
        commanded: Commanded force [N or N m].
        lag: Time constant [s].
        period: Length of the period [s].
    """
    if lag <= 0.0:
        return commanded
    return commanded + (before - commanded) * exp(-period / lag)


@dataclass
class LagJoystick(LagBasedController, Outboards, CompiledController):
    """Base of joystick controllers whose gains follow from one bandwidth.

    With the effective delay theta = period / 2 + command_delay + motor_lag + 0.33 s the bandwidth
    is 1 / (2 theta), that of the SIMC rule for an integrating process (S. Skogestad, Journal of
    Process Control 13, 2003). The pole of the response to a set point is half of it, the heading
    gain a fifth. A known command delay counts as part of the motor lag in the model of the
    actuators. Goals: `surge_mps`, `sway_mps`, `yaw_radps`.
    """

    commands: ClassVar[tuple[str, ...]] = (
        "pwm_port",
        "pwm_starboard",
        "steer_port_rad",
        "steer_starboard_rad",
    )
    goals: ClassVar[tuple[str, ...]] = STICK
    default_goals: ClassVar = dict.fromkeys(STICK, 0.0)

    inertia: float = param(
        2.0, low=0.1, high=50.0, unit="kg m^2", words="assumed yaw inertia, added mass included"
    )
    mass: float = param(5.0, low=0.5, high=500.0, unit="kg", words="assumed surge mass")
    bandwidth: float = param(
        UNSET,
        low=0.05,
        high=20.0,
        unit="rad/s",
        words="bandwidth of the rejection of disturbances; default: 1 / (2 theta)",
    )
    pole: float = param(
        UNSET,
        low=0.02,
        high=10.0,
        unit="1/s",
        words="pole of the response to a set point; default: half the bandwidth",
    )
    heading_gain: float = param(
        UNSET,
        low=0.0,
        high=5.0,
        unit="1/s",
        words="yaw rate demanded per heading error; default: a fifth of the bandwidth",
    )
    hold_rate: float = param(
        0.1, low=0.01, high=2.0, unit="rad/s", words="largest yaw rate without a yaw command"
    )
    turn_rate: float = param(
        0.25, low=0.01, high=2.0, unit="rad/s", words="largest yaw rate in a rated turn"
    )
    rated_yaw: float = param(
        0.1396, low=0.01, high=2.0, unit="rad/s", words="the rated turn, 8 deg/s"
    )
    blind_surge: float = param(
        1.0, low=0.0, high=100.0, unit="N s/m", words="surge force per m/s with no speed sensor"
    )

    def derive_gains(self) -> None:
        """Set the gains that are not given by the rule of this class."""
        if self.bandwidth is UNSET:
            self.bandwidth = bandwidth_for_delay(self.effective_delay())
        if self.pole is UNSET:
            self.pole = POLE_SHARE * self.bandwidth
        if self.heading_gain is UNSET:
            self.heading_gain = HEADING_SHARE * self.bandwidth

    def axis_law(self, axis: str) -> AxisLaw:
        """Return the law of one axis, without limits, as a function of its state and inputs.

        Args:
            axis: "yaw" or "surge".
        """
        raise NotImplementedError

    def operating_points(self) -> tuple[OperatingPoint, ...]:
        """Return the steady motions at which the controller's loops are analysed on a vessel."""
        return joystick_operating_points(
            self, self.yaw_loop, self._loop("surge", 0.0, False), self.pole
        )

    def yaw_loop(self, swaying: bool) -> FeedbackLoop:
        """Return the feedback of the yaw rate and of its integral, the heading.

        Args:
            swaying: Whether the boat sways, so that the steering angles give the moment.
        """
        return self._loop("yaw", self.heading_gain, swaying)

    def _loop(self, axis: str, heading_gain: float, swaying: bool) -> FeedbackLoop:
        names = type(self).memory_type[axis].names or ()
        law = sampled_linear_law(self.axis_law(axis), names, heading_gain, self.period)
        return outboard_loop(self, {"yaw": "N", "surge": "X"}[axis], swaying, law)

    def largest_goals(self) -> dict[str, float]:
        """Return the joystick demands at full stick: largest speeds [m/s] and turn rate [rad/s]."""
        return {**super().largest_goals(), "yaw_radps": self.rated_yaw}
