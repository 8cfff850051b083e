"""L1 joystick controller for surge, sway and yaw demands at the same time."""

from dataclasses import dataclass
from math import exp, isnan, nan
from typing import Any, ClassVar

from boatsim.control.allocation import (
    HEADING,
    command_outboards,
    thrust_difference_for_sway,
)
from boatsim.control.axis import AXIS
from boatsim.control.base import Estimate
from boatsim.control.compiled import merged, record_type, unlocked
from boatsim.control.joystick import (
    AdaptiveJoystick,
    joystick_operating_points,
    surge_force,
    yaw_moment,
)
from boatsim.control.lag_design import HEADING_SHARE, LagBasedController, bandwidth_for_delay
from boatsim.control.operating_points import OperatingPoint
from boatsim.physics.base import UNSET, param

# of the low-pass bandwidth in yaw: at half the assumed input gain, bandwidth and pole are then
# equal, and L1 norm times slope has the value 2 / e = 0.74
POLE_SHARE = 0.5
# of the pole: the L1-norm condition needs more than 1, and noise of the speed log needs little
SURGE_SHARE = 1.2
# [1/s] reference motion of the scale boat (Bayless 2017, tables 7 and 8); a faster response
# saturates its motors
FASTEST_RESPONSE = 1.4
# X [N], N [N m]: values applied in the last period; r [rad/s], u [m/s]: response to the stick
REMEMBERS = record_type("acted", "X", "N", "r", "u", yaw=AXIS, surge=AXIS, heading=HEADING)


@merged
def response_force(inertia: float, pole: float, faster: float, wanted: float, now: float) -> float:
    """Return the force or moment by which an axis responds to the stick faster than its loop.

    The law drives x' = -pole (x - wanted); with this feed-forward x follows the response
    now' = faster (wanted - now).

    Args:
        inertia: Assumed mass or inertia [kg or kg m^2].
        pole: Pole of the loop's reference motion [1/s].
        faster: Pole of the response to the stick [1/s].
        wanted: Demanded velocity [m/s or rad/s].
        now: Present velocity of the response [m/s or rad/s].
    """
    return inertia * (faster - pole) * (wanted - now)


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the outboard commands of L1 joystick controllers for the next period.

    The inputs are gyro, surge speed if measured, and stick demands.

    Args:
        boats: Row numbers of the boats to process.
        settings: Parameters of each controller.
        memory: State of each controller.
        sense: Sensor readings of each boat.
        goal: Demands of each boat.
        sent: Commands of each boat, filled in.
    """
    for b in boats:
        q, m, s, g = settings[b], memory[b], sense[b], goal[b]
        faster = max(q.response_pole, q.pole)
        step = 1.0 - exp(-faster * q.period)
        moment = yaw_moment(q, m, s, g.yaw_radps)
        moment += response_force(q.inertia, q.pole, faster, g.yaw_radps, m.r)
        surge = surge_force(q, m, s, g.surge_mps)
        if not isnan(s.u):
            surge += response_force(q.mass, q.pole, faster, g.surge_mps, m.u)
        m.r += step * (g.yaw_radps - m.r)
        m.u += step * (g.surge_mps - m.u)
        room = faster * q.mass * abs(g.surge_mps)
        m.X, _, m.N = command_outboards(
            q, surge, thrust_difference_for_sway(q, g.sway_mps), moment, room, sent[b]
        )
        m.acted = 1.0


@dataclass
class L1Joystick(LagBasedController, AdaptiveJoystick):
    """L1 adaptive joystick controller of a boat with two outboards.

    Yaw is controlled by the gyro and surge by a speed sensor, if present; sway is in open loop.
    Gains that are not given follow from the known lag and delay of the vessel. With the effective
    delay theta = period / 2 + motor_lag + command_delay + 0.33 s the bandwidth of the low-pass in
    yaw is 1 / (2 theta), that of the SIMC rule for an integrating process (S. Skogestad, Journal of
    Process Control 13, 2003). The pole is half of it, the low-pass in surge 1.2 times the pole, and
    the heading gain a fifth of the bandwidth. The response to the stick is a feed-forward and needs
    no reserve for unknown delays: its pole follows from the same rule without the 0.33 s, up to the
    1.4 1/s of the scale boat's reference motion, and is never below that of the loop.
    """

    words: ClassVar[str] = (
        "L1 adaptive joystick, corrected: surge, sway and yaw commands at the same time"
    )
    law: ClassVar = law
    memory_type: ClassVar = REMEMBERS

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
    response_pole: float = param(
        UNSET, low=0.01, high=10.0, unit="1/s", words="pole of the response to the stick"
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
        if self.response_pole is UNSET:
            quick = POLE_SHARE * bandwidth_for_delay(self.known_delay())
            self.response_pole = max(self.pole, min(quick, FASTEST_RESPONSE))

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the estimated disturbances of yaw and surge, and the response to the stick."""
        return {
            **super().estimates_from(memory),
            "reference_u_mps": Estimate(memory["u"], nan, nan),
            "reference_r_radps": Estimate(memory["r"], nan, nan),
        }

    def operating_points(self) -> tuple[OperatingPoint, ...]:
        """Return the steady motions at which the controller's loops are analysed on a vessel."""
        return joystick_operating_points(self, self.yaw_loop, self.surge_loop(), self.response_pole)
