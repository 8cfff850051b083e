"""PID heading and PI surge control with the allocation of the L1 joystick."""

from dataclasses import dataclass
from functools import partial
from math import isnan
from typing import Any, ClassVar

from boatsim.control.adaptive import LoopChannel
from boatsim.control.allocation import (
    HEADING,
    STICK,
    Outboards,
    allocate,
    integrate_heading,
    limit,
    nominal_wrench,
    thrust_difference_for_sway,
    write_outboard_commands,
)
from boatsim.control.compiled import CompiledController, merged, record_type, unlocked
from boatsim.control.joystick import joystick_operating_points, outboard_loop
from boatsim.control.operating_points import FeedbackLoop, OperatingPoint, sampled_pid_law
from boatsim.physics.base import param

ROUNDING = 1e-9  # [N m], [N] a smaller difference is rounding and must not stop an integrator
# Integral parts [N m], [N]; asked for minus applied in the last step [N m], [N].
REMEMBERS = record_type(
    "acted", "moment_held", "surge_held", "moment_missed", "surge_missed", heading=HEADING
)


@merged
def unmet_demand(wanted: float, given: float) -> float:
    """Return the part of a demand that saturated outboards do not deliver.

    Differences by rounding count as zero.

    Args:
        wanted: Demanded force or moment.
        given: Delivered force or moment.
    """
    return wanted - given if abs(wanted - given) > ROUNDING else 0.0


@merged
def yaw_moment(q: Any, m: Any, s: Any, wanted: float) -> float:
    """Return the yaw moment [N m] by which a PID controller follows a demanded yaw rate.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        s: Sensor readings.
        wanted: Demanded yaw rate [rad/s].
    """
    if m.acted != 0.0:
        integrate_heading(m.heading, s.r, s.psi, wanted, q.period, q.compass_trust)
    error = limit(m.heading.wanted - m.heading.own, -q.largest_error, q.largest_error)
    if m.moment_missed * error <= 0.0:
        m.moment_held += q.period * q.inertia * q.ki * error
    return q.inertia * (q.kp * error + q.kd * (wanted - s.r)) + m.moment_held


@merged
def surge_force(q: Any, m: Any, s: Any, wanted: float) -> float:
    """Return the surge force [N] by which a PI controller follows a demanded speed.

    Without a speed sensor it is a feed-forward only.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        s: Sensor readings.
        wanted: Demanded speed [m/s].
    """
    if isnan(s.u):
        return q.blind_surge * wanted
    error = wanted - s.u
    if m.surge_missed * error <= 0.0:
        m.surge_held += q.period * q.mass * q.surge_ki * error
    return q.blind_surge * wanted + q.mass * q.surge_kp * error + m.surge_held


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the outboard commands of PID controllers for the next period.

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
        room = q.surge_kp * q.mass * abs(g.surge_mps) + abs(q.blind_surge * g.surge_mps)
        port, starboard, angle = allocate(
            q, surge, thrust_difference_for_sway(q, g.sway_mps), moment, room
        )
        write_outboard_commands(q, port, starboard, angle, sent[b])
        X, _, N = nominal_wrench(q, port, starboard, angle)
        m.surge_missed, m.moment_missed, m.acted = (
            unmet_demand(surge, X),
            unmet_demand(moment, N),
            1.0,
        )


@dataclass
class PidAutopilot(Outboards, CompiledController):
    """PID on the integrated gyro with rate feed-forward; conditional integration at saturation.

    Gains are per unit of assumed inertia: kp [1/s^2], ki [1/s^3], kd [1/s]. Goals: `surge_mps`,
    `sway_mps`, `yaw_radps`.
    """

    words: ClassVar[str] = "PID heading and PI surge speed on the joystick's allocation"
    commands: ClassVar[tuple[str, ...]] = (
        "pwm_port",
        "pwm_starboard",
        "steer_port_rad",
        "steer_starboard_rad",
    )
    goals: ClassVar[tuple[str, ...]] = STICK
    default_goals: ClassVar = dict.fromkeys(STICK, 0.0)
    tuned: ClassVar[tuple[str, ...]] = ("kp", "ki", "kd", "surge_kp", "surge_ki")
    law: ClassVar = law
    memory_type: ClassVar = REMEMBERS

    inertia: float = param(
        2.0, low=0.1, high=50.0, unit="kg m^2", words="assumed yaw inertia, added mass included"
    )
    mass: float = param(5.0, low=0.5, high=500.0, unit="kg", words="assumed surge mass")
    kp: float = param(
        0.64, low=0.0, high=25.0, unit="1/s^2", words="yaw acceleration per heading error"
    )
    ki: float = param(
        0.1, low=0.0, high=25.0, unit="1/s^3", words="the same per integrated heading error"
    )
    kd: float = param(
        1.3, low=0.0, high=25.0, unit="1/s", words="yaw acceleration per yaw rate error"
    )
    surge_kp: float = param(
        0.5, low=0.0, high=25.0, unit="1/s", words="surge acceleration per speed error"
    )
    surge_ki: float = param(
        0.1, low=0.0, high=25.0, unit="1/s^2", words="the same per integrated speed error"
    )
    largest_error: float = param(
        0.5, low=0.01, high=3.1, unit="rad", words="limit of the heading error"
    )
    blind_surge: float = param(
        1.0, low=0.0, high=100.0, unit="N s/m", words="surge force per m/s with no speed sensor"
    )

    def feedback_loops(self) -> tuple[LoopChannel, ...]:
        """Return the heading and speed feedback loops on a nominal boat with ideal actuators.

        PI control of a speed is PD control of its integral.
        """
        held = partial(LoopChannel, hold_s=0.5 * self.period, input_gain=(0.5, 1.0, 1.8))
        return (
            held("yaw", pid=(self.kp, self.ki, self.kd)),
            held("surge", pid=(self.surge_ki, 0.0, self.surge_kp)),
        )

    def operating_points(self) -> tuple[OperatingPoint, ...]:
        """Return the steady motions at which the controller's loops are analysed on a vessel."""
        law = sampled_pid_law(self.surge_ki, 0.0, self.surge_kp, self.mass, self.period)
        surge = outboard_loop(self, "X", False, law)
        return joystick_operating_points(self, self.yaw_loop, surge)

    def yaw_loop(self, swaying: bool) -> FeedbackLoop:
        """Return the feedback of the yaw rate and of its integral, the heading.

        Args:
            swaying: Whether the boat sways, so that the steering angles give the moment.
        """
        law = sampled_pid_law(self.kp, self.ki, self.kd, self.inertia, self.period)
        return outboard_loop(self, "N", swaying, law)
