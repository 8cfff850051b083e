"""L1 adaptive joystick control of two outboards: base of controllers with different sensors."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import isnan, nan
from typing import Any, ClassVar

from boatsim.control.adaptive import LoopChannel
from boatsim.control.allocation import (
    HEADING,
    STICK,
    Outboards,
    command_outboards,
    integrate_heading,
    limit,
    thrust_difference_for_sway,
)
from boatsim.control.axis import AXIS, filtered_disturbance
from boatsim.control.base import Estimate
from boatsim.control.compiled import CompiledController, merged, record_type, unlocked
from boatsim.control.operating_points import (
    FeedbackLoop,
    OperatingPoint,
    SampledLaw,
    sampled_l1_law,
)
from boatsim.physics.base import param

# Steady motions at which the loops are analysed on a vessel, and the pulses that excite them there:
# large against the rounding of the commands, and small enough that no motor reverses or saturates
AHEAD = 0.4  # [m/s] a slow speed of the scale boat, Froude number 0.12
RATED_TURN = 0.1396  # [rad/s] 8 deg/s, the rated turn of the boat
SURGE_PULSE = 0.02  # [m/s]
SWAYING_PULSE = 0.005  # [m/s] of surge in sway, where the allocation leaves little thrust to surge
YAW_PULSE = 0.01  # [rad/s]
STEERED_PULSE = 0.02  # [rad/s] in sway, where a step of 1 deg of the servos is 7 mN m
# [1/s] pole to which these pulses belong; a slower controller answers a pulse with a smaller force,
# so that it needs a higher one to be as large against the rounding
PULSED_POLE = 1.4
# X [N], N [N m]: values applied in the last period
REMEMBERS = record_type("acted", "X", "N", yaw=AXIS, surge=AXIS, heading=HEADING)


@merged
def demanded_yaw_rate(q: Any, m: Any, s: Any, wanted: float) -> float:
    """Return the yaw rate [rad/s] that a joystick controller has to reach, and integrate headings.

    It is the stick's rate, corrected for the heading error and limited.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        s: Sensor readings.
        wanted: Yaw rate of the stick [rad/s].
    """
    if m.acted != 0.0:
        integrate_heading(m.heading, s.r, s.psi, wanted, q.period, q.compass_trust)
    bound = q.hold_rate + (q.turn_rate - q.hold_rate) * abs(wanted) / q.rated_yaw
    return limit(wanted + q.heading_gain * (m.heading.wanted - m.heading.own), -bound, bound)


@merged
def yaw_moment(q: Any, m: Any, s: Any, wanted: float) -> float:
    """Return the yaw moment [N m] by which a joystick controller follows a demanded yaw rate.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        s: Sensor readings.
        wanted: Yaw rate of the stick [rad/s].
    """
    reference = demanded_yaw_rate(q, m, s, wanted)
    acted = m.acted != 0.0
    felt = filtered_disturbance(
        m.yaw, s.r, m.N, acted, reference, q.pole, q.inertia, q.yaw_bandwidth, q.period
    )
    return q.inertia * q.pole * reference - felt


@merged
def surge_force(q: Any, m: Any, s: Any, wanted: float) -> float:
    """Return the surge force [N] by which a joystick controller follows a demanded speed.

    Without a speed sensor it is a feed-forward only.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        s: Sensor readings.
        wanted: Demanded speed [m/s].
    """
    if isnan(s.u):
        return q.blind_surge * wanted
    acted = m.acted != 0.0
    felt = filtered_disturbance(
        m.surge, s.u, m.X, acted, wanted, q.pole, q.mass, q.surge_bandwidth, q.period
    )
    return q.mass * q.pole * wanted - felt


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
        moment = yaw_moment(q, m, s, g.yaw_radps)
        surge = surge_force(q, m, s, g.surge_mps)
        room = q.pole * q.mass * abs(g.surge_mps)
        m.X, _, m.N = command_outboards(
            q, surge, thrust_difference_for_sway(q, g.sway_mps), moment, room, sent[b]
        )
        m.acted = 1.0


@dataclass
class AdaptiveJoystick(Outboards, CompiledController):
    """L1 adaptive control of yaw rate and, if measured, surge speed; sway is open-loop thrust.

    Each channel follows x' = -pole (x - x_ref) with an assumed inertia. All other influences (motor
    spacing, arm, reverse thrust, wind, drag) appear as a prediction error, are converted to a force
    or moment sigma and subtracted after a low-pass filter. Goals: `surge_mps`, `sway_mps`,
    `yaw_radps`.
    """

    commands: ClassVar[tuple[str, ...]] = (
        "pwm_port",
        "pwm_starboard",
        "steer_port_rad",
        "steer_starboard_rad",
    )
    goals: ClassVar[tuple[str, ...]] = STICK
    default_goals: ClassVar = dict.fromkeys(STICK, 0.0)
    tuned: ClassVar[tuple[str, ...]] = (
        "pole",
        "yaw_bandwidth",
        "surge_bandwidth",
        "heading_gain",
    )
    law: ClassVar = law
    memory_type: ClassVar = REMEMBERS

    pole: float = param(1.4, low=0.1, high=10.0, unit="1/s", words="pole of the reference motion")
    inertia: float = param(
        2.0, low=0.1, high=50.0, unit="kg m^2", words="assumed yaw inertia, added mass included"
    )
    mass: float = param(5.0, low=0.5, high=500.0, unit="kg", words="assumed surge mass")
    yaw_bandwidth: float = param(
        2.0, low=0.1, high=20.0, unit="rad/s", words="low-pass of the yaw estimate"
    )
    surge_bandwidth: float = param(
        2.0, low=0.05, high=20.0, unit="rad/s", words="low-pass of the surge estimate"
    )
    heading_gain: float = param(
        0.2, low=0.0, high=5.0, unit="1/s", words="yaw rate demanded per heading error"
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

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the estimated disturbances of yaw and surge, and the reference motion."""
        yaw, surge = memory["yaw"], memory["surge"]
        return {
            "sigma_yaw_Nm": Estimate(yaw["sigma"], nan, nan),
            "sigma_surge_N": Estimate(surge["sigma"], nan, nan),
            "reference_u_mps": Estimate(surge["model"], nan, nan),
            "reference_r_radps": Estimate(yaw["model"], nan, nan),
        }

    def largest_goals(self) -> Mapping[str, float]:
        """Return the joystick demands at full stick: largest speeds [m/s] and turn rate [rad/s]."""
        return {**super().largest_goals(), "yaw_radps": self.rated_yaw}

    def feedback_loops(self) -> tuple[LoopChannel, ...]:
        """Return the controller's yaw and surge feedback loops on a nominal boat.

        The true thrust over inertia is 0.5 to 1.8 times the assumed one. Actuators are ideal.
        """
        held = partial(
            LoopChannel, pole=self.pole, hold_s=0.5 * self.period, input_gain=(0.5, 1.0, 1.8)
        )
        return (
            held("yaw", bandwidth=self.yaw_bandwidth, heading_gain=self.heading_gain),
            held("surge", bandwidth=self.surge_bandwidth),
        )

    def operating_points(self) -> tuple[OperatingPoint, ...]:
        """Return the steady motions at which the controller's loops are analysed on a vessel."""
        return joystick_operating_points(self, self.yaw_loop, self.surge_loop(), self.pole)

    def yaw_loop(self, swaying: bool) -> FeedbackLoop:
        """Return the feedback of the yaw rate.

        Args:
            swaying: Whether the boat sways, so that the steering angles give the moment.
        """
        law = sampled_l1_law(
            self.pole, self.inertia, self.yaw_bandwidth, self.heading_gain, self.period
        )
        return outboard_loop(self, "N", swaying, law)

    def surge_loop(self) -> FeedbackLoop:
        """Return the feedback of the surge speed."""
        law = sampled_l1_law(self.pole, self.mass, self.surge_bandwidth, 0.0, self.period)
        return outboard_loop(self, "X", False, law)


def outboard_loop(outboards: Outboards, axis: str, swaying: bool, law: SampledLaw) -> FeedbackLoop:
    """Return the feedback of the velocity along one axis to a force or moment of two outboards.

    Args:
        outboards: The controller with its allocation.
        axis: "X", "Y" or "N".
        swaying: Whether the boat sways, so that the steering angles give the moment.
        law: The control law.
    """
    return FeedbackLoop(
        {"X": "u", "Y": "v", "N": "r"}[axis],
        axis,
        law,
        partial(outboards.command_slopes, axis, swaying),
        partial(outboards.wrench_slopes, axis, swaying),
    )


def joystick_operating_points(
    outboards: Outboards,
    yaw_loop: Callable[[bool], FeedbackLoop],
    surge_loop: FeedbackLoop,
    pole: float = PULSED_POLE,
) -> tuple[OperatingPoint, ...]:
    """Return the steady motions at which the loops of a joystick controller are analysed.

    Straight ahead, surge and yaw do not influence each other. In a turn the surge speed is not
    measured, so that the margin is that of the yaw loop alone. In sway both loops are closed;
    without the surge loop the boat would drift ahead until the steering is at its limit.

    Args:
        outboards: The controller.
        yaw_loop: Returns the yaw loop with or without a sway demand.
        surge_loop: The surge loop.
        pole: Pole of the response to a set point [1/s].
    """
    ahead, turn = {"surge_mps": AHEAD}, {"yaw_radps": RATED_TURN}
    sway = {"sway_mps": outboards.rated_sway}
    higher = PULSED_POLE / pole
    pulse, blind = {"yaw_radps": higher * YAW_PULSE}, ("u", "v")
    steered = {"yaw_radps": higher * STEERED_PULSE, "surge_mps": higher * SWAYING_PULSE}
    return (
        OperatingPoint("surge", (surge_loop,), ahead, {"surge_mps": higher * SURGE_PULSE}, ("v",)),
        OperatingPoint("yaw ahead", (yaw_loop(False),), ahead, pulse, blind),
        OperatingPoint("yaw in a turn", (yaw_loop(False),), turn, pulse, blind),
        OperatingPoint("yaw, surge in sway", (yaw_loop(True), surge_loop), sway, steered, ("v",)),
    )
