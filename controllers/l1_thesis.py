"""L1 controller of the simulations of Bayless (2017): gradient adaptation with projection.

The steering command passes a low-pass filter.
"""

from dataclasses import dataclass
from math import nan, pi, radians, sin
from typing import Any, ClassVar

from boatsim.control.adaptive import solve_lyapunov
from boatsim.control.allocation import limit
from boatsim.control.base import Estimate
from boatsim.control.compiled import CompiledController, merged, record_type, unlocked
from boatsim.control.gradient_adaptation import (
    STATE_ESTIMATES,
    EstimateBounds,
    adapt_state_estimates,
    estimated_acceleration,
)
from boatsim.physics.base import param

MODEL = ((0.0, -1.0), (1.0, -1.4))  # [1/s] A_m of sway velocity and yaw rate, T8; b = I
((P_VV, P_VR), (_, P_RR)) = solve_lyapunov(MODEL).tolist()
ROOM = pi / 4  # [rad] both motors turn inward as far as this, T9
MODULATED_AT = radians(23.6)  # steering angle at which modulated power is the nominal one, Fig 24
FILTER_ZERO, FILTER_POLE = 17.7, 50.0  # [rad/s] of the low-pass, AppH
# Bounds are assumptions, wide enough for the plants of T10 to T14 and the disturbance of T12.
OMEGA, OTHERS = (0.5, 2.0), (-2.0, 2.0)
LIMITS = EstimateBounds(*OMEGA, *OTHERS, *OTHERS)
BOUNDS = {"omega": OMEGA, "theta_v": OTHERS, "theta_r": OTHERS, "sigma": OTHERS}


@merged
def set_steering_angle(q: Any, m: Any, v: float, r: float) -> float:
    """Set the outboards' steering angle by the filtered control law; return the thrust [N].

    The angle keeps the yaw rate zero while the boat moves sideways.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        v: Sway velocity [m/s].
        r: Yaw rate [rad/s].
    """
    wanted = 0.0 if q.feed_forward_as_published != 0.0 else -MODEL[1][0] * v
    drive = -1.07 * q.filter_gain * (estimated_acceleration(m.yaw, v, r) - wanted) * q.period
    m.slow += FILTER_ZERO / FILTER_POLE * drive
    m.fast += (FILTER_POLE - FILTER_ZERO) / FILTER_POLE * drive - FILTER_POLE * q.period * m.fast
    per_angle = q.slope * q.power / q.inertia  # [1/s^2]
    m.angle = limit(q.neutral - (m.slow + m.fast) / per_angle, 0.0, ROOM)
    m.reached += (m.angle - m.reached) * q.period / max(q.servo_lag, q.period)
    thrust = q.power * (sin(m.reached) / sin(MODULATED_AT) if q.modulated != 0.0 else 1.0)
    m.sway.given, m.yaw.given = thrust * sin(m.angle) / q.mass, per_angle * (q.neutral - m.angle)
    return thrust


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute thrusts and steering angles from the measured sway velocity and yaw rate.

    Args:
        boats: Row numbers of the boats to process.
        settings: Parameters of each controller.
        memory: State of each controller.
        sense: Sensor readings of each boat.
        goal: Not used.
        sent: Commands of each boat, filled in.
    """
    for b in boats:
        q, m, v, r = settings[b], memory[b], sense[b].v, sense[b].r
        if m.started == 0.0:
            m.started = m.sway.omega = m.yaw.omega = 1.0
        vh, rh = m.vh, m.rh
        adapt_state_estimates(
            m.sway, P_VV * (vh - v) + P_VR * (rh - r), v, r, LIMITS, q.adaptation, q.period
        )
        adapt_state_estimates(
            m.yaw, P_VR * (vh - v) + P_RR * (rh - r), v, r, LIMITS, q.adaptation, q.period
        )
        thrust = set_steering_angle(q, m, v, r)
        m.vh += q.period * (
            MODEL[0][0] * vh + MODEL[0][1] * rh + estimated_acceleration(m.sway, v, r)
        )  # E37
        m.rh += q.period * (
            MODEL[1][0] * vh + MODEL[1][1] * rh + estimated_acceleration(m.yaw, v, r)
        )
        sent[b].thrust_port_N, sent[b].thrust_starboard_N = 0.5 * thrust, -0.5 * thrust
        sent[b].steer_port_rad, sent[b].steer_starboard_rad = m.angle, -m.angle


@dataclass
class L1Thesis(CompiledController):
    """L1 adaptive controller that moves a boat sideways and keeps its yaw rate zero by steering.

    The sway thrust has a constant nominal power. The neutral angle of the steering is unknown.

    Equation E37 with a plus sign throughout. Sway is open loop, so that the actual sway speed is
    the demanded one, and the feed-forward is -A_m: v alone demands no rotation.
    `feed_forward_as_published` selects the diagonal feed-forward of the thesis.
    """

    words: ClassVar[str] = "L1 adaptive sway of the thesis' simulations, steering the only control"
    commands: ClassVar[tuple[str, ...]] = (
        "thrust_port_N",
        "thrust_starboard_N",
        "steer_port_rad",
        "steer_starboard_rad",
    )
    law: ClassVar = law
    # predicted states; both poles of the low-pass [rad/s^2]; angle commanded, and where the servo
    # is taken to be
    memory_type: ClassVar = record_type(
        "started",
        "vh",
        "rh",
        "slow",
        "fast",
        "angle",
        "reached",
        sway=STATE_ESTIMATES,
        yaw=STATE_ESTIMATES,
    )

    period: float = param(
        5e-4, low=5e-4, high=0.01, unit="s", words="time between two control steps"
    )
    power: float = param(
        0.5, low=0.01, high=8.0, unit="N", words="nominal power F0: both thrusts together"
    )
    # F = F0 sin d / sin 23.6 deg instead of F0, d the angle the motors have reached
    modulated: bool = False
    servo_lag: float = param(0.15, low=0.0, high=60.0, unit="s", words="assumed, of the steering")
    adaptation: float = param(1e4, low=0.0, high=1e6, unit="", words="gain of the gradient laws")
    mass: float = param(10.4, low=0.1, high=1e3, unit="kg", words="assumed, sway")
    inertia: float = param(2.0, low=0.01, high=1e3, unit="kg m^2", words="assumed, yaw")
    neutral: float = param(0.3875, low=0.0, high=0.7854, unit="rad", words="assumed neutral angle")
    slope: float = param(
        0.62, low=0.01, high=10.0, unit="m/rad", words="assumed fall of the lever with the angle"
    )
    filter_gain: float = param(
        4.5, low=0.01, high=100.0, unit="", words="times 1.07 (s + 17.7)/(s (s + 50)), AppH"
    )
    feed_forward_as_published: bool = False

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return all adaptive estimates with their bounds, and the predicted states.

        The states are sway velocity and yaw rate.
        """
        found: dict[str, Estimate] = {}
        for axis in ("sway", "yaw"):
            for name, bounds in BOUNDS.items():
                found[f"{name}_{axis}"] = Estimate(memory[axis][name], *bounds)
        found["reference_v_mps"] = Estimate(memory["vh"], nan, nan)
        found["reference_r_radps"] = Estimate(memory["rh"], nan, nan)
        return found
