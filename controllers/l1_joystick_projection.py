"""L1 joystick with the adaptive laws of Bayless (2017): gradient adaptation with projection."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from math import exp, isnan, nan
from typing import Any, ClassVar

from boatsim.control.adaptive import LoopChannel, solve_lyapunov
from boatsim.control.allocation import (
    HEADING,
    STICK,
    Outboards,
    command_outboards,
    thrust_difference_for_sway,
)
from boatsim.control.base import Estimate
from boatsim.control.compiled import CompiledController, merged, record_type, unlocked
from boatsim.control.gradient_adaptation import (
    STATE_ESTIMATES,
    adapt_state_estimates,
    estimated_acceleration,
    start_estimates,
)
from boatsim.control.joystick import demanded_yaw_rate
from boatsim.physics.base import param

MODEL = ((0.0, -1.0), (1.0, -1.4))  # [1/s] A_m of sway velocity and yaw rate, table 8; b = I
SURGE_POLE = 1.4  # [1/s] A_m = -1.4 of the surge speed, table 7
# Lyapunov equation A_m'P + P A_m = -I: [[99/70, -1/2], [-1/2, 5/7]] and 1 / 2.8
((P_VV, P_VR), (_, P_RR)) = solve_lyapunov(MODEL).tolist()
P_SURGE = float(solve_lyapunov([[-SURGE_POLE]])[0, 0])
FILTER_POLE = 50.0  # [rad/s] of D(s) = 1.07 (s + 17.7) / (s (s + 50)), appendix H
# One state equation: predicted and measured state, rate of the measured one between two samples,
# and the two poles of the low-pass [m/s^2 or rad/s^2]
CHANNEL = record_type("predicted", "measured", "rate", "slow", "fast", unknown=STATE_ESTIMATES)


@merged
def low_pass_input(
    c: Any, wanted: float, v: float, r: float, bandwidth: float, zero: float, dt: float
) -> None:
    """Advance the control input of a state equation by one step of its low-pass filter.

    input = -D(s) (omega input + theta'x + sigma - wanted) with
    D(s) = bandwidth (1 + s / zero) / (s (1 + s / 50)), exact for a value held over the step.

    Args:
        c: `CHANNEL` of the state equation, changed in place.
        wanted: Acceleration that the control should cause [m/s^2 or rad/s^2].
        v: Sway velocity [m/s].
        r: Yaw rate [rad/s].
        bandwidth: Bandwidth of the closed filter at omega = 1 [rad/s].
        zero: Zero of the filter [rad/s].
        dt: Length of the step [s].
    """
    row, decay = c.unknown, exp(-FILTER_POLE * dt)
    own = row.omega * (c.slow + c.fast - row.given)
    drive = -bandwidth * (estimated_acceleration(row, v, r) + own - wanted)
    lead = FILTER_POLE / zero - 1.0
    c.slow += dt * drive
    c.fast = decay * c.fast + (1.0 - decay) / FILTER_POLE * lead * drive


@merged
def advance_sway_and_yaw(q: Any, m: Any, reference: float, dt: float) -> None:
    """Advance predictor, adaptive estimates and yaw filter of sway velocity and yaw rate.

    If the sway velocity is not measured, it is zero here and its estimates rest.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        reference: Demanded yaw rate [rad/s].
        dt: Length of the step [s].
    """
    sway, yaw = m.sway, m.yaw
    v, r, vh, rh = sway.measured, yaw.measured, sway.predicted, yaw.predicted
    sway_rate = MODEL[0][0] * vh + MODEL[0][1] * rh + estimated_acceleration(sway.unknown, v, r)
    yaw_rate = MODEL[1][0] * vh + MODEL[1][1] * rh + estimated_acceleration(yaw.unknown, v, r)
    yaw.predicted += dt * yaw_rate
    yaw.measured += dt * yaw.rate
    r, r_error, v_error = yaw.measured, yaw.predicted - yaw.measured, 0.0
    if m.sway_measured != 0.0:
        sway.predicted += dt * sway_rate
        sway.measured += dt * sway.rate
        v, v_error = sway.measured, sway.predicted - sway.measured
        pulled = P_VV * v_error + P_VR * r_error
        adapt_state_estimates(sway.unknown, pulled, v, r, q, q.adaptation, dt)
    pulled = P_VR * v_error + P_RR * r_error
    adapt_state_estimates(yaw.unknown, pulled, v, r, q, q.adaptation, dt)
    wanted = reference
    if q.feed_forward_as_published == 0.0:
        wanted = -MODEL[1][0] * v - MODEL[1][1] * reference
    low_pass_input(yaw, wanted, v, r, q.yaw_bandwidth, q.filter_zero, dt)


@merged
def advance_surge(q: Any, m: Any, reference: float, dt: float) -> None:
    """Advance predictor, adaptive estimates and low-pass filter of the surge speed.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        reference: Demanded surge speed [m/s].
        dt: Length of the step [s].
    """
    c = m.surge
    rate = -SURGE_POLE * c.predicted + estimated_acceleration(c.unknown, c.measured, 0.0)
    c.predicted += dt * rate
    c.measured += dt * c.rate
    pulled = P_SURGE * (c.predicted - c.measured)
    adapt_state_estimates(c.unknown, pulled, c.measured, 0.0, q, q.adaptation, dt)
    wanted = SURGE_POLE * reference
    low_pass_input(c, wanted, c.measured, 0.0, q.surge_bandwidth, q.filter_zero, dt)


@merged
def take_measurement(q: Any, m: Any, c: Any, measured: float) -> None:
    """Set the measured rate of a state over the last period, or start its predictor.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        c: `CHANNEL` of the state, changed in place.
        measured: Sensor reading; a missing one counts as zero.
    """
    value = 0.0 if isnan(measured) else measured
    if m.acted != 0.0:
        c.rate = (value - c.measured) / q.period
    else:
        c.predicted = c.measured = value
        start_estimates(c.unknown, q)


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute outboard commands from gyro, measured speeds and stick demands.

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
        reference = demanded_yaw_rate(q, m, s, g.yaw_radps)
        m.sway_measured = 0.0 if isnan(s.v) else 1.0
        take_measurement(q, m, m.sway, s.v)
        take_measurement(q, m, m.yaw, s.r)
        take_measurement(q, m, m.surge, s.u)
        steps = max(1, round(q.period / q.adaptation_step))
        for _ in range(steps):
            advance_sway_and_yaw(q, m, reference, q.period / steps)
            advance_surge(q, m, g.surge_mps, q.period / steps)
        moment = q.inertia * (m.yaw.slow + m.yaw.fast)
        surge = q.mass * (m.surge.slow + m.surge.fast)
        if isnan(s.u):
            surge = q.blind_surge * g.surge_mps
        room = SURGE_POLE * q.mass * abs(g.surge_mps)
        spread = thrust_difference_for_sway(q, g.sway_mps)
        X, Y, N = command_outboards(q, surge, spread, moment, room, sent[b])
        if q.input_as_published != 0.0:
            X, N = surge, moment
        m.surge.unknown.given, m.sway.unknown.given = X / q.mass, Y / q.sway_mass
        m.yaw.unknown.given, m.acted = N / q.inertia, 1.0


@dataclass
class L1JoystickProjection(Outboards, CompiledController):
    """L1 joystick with the predictor and adaptive laws of the thesis (Bayless 2017, eq. 30 to 39).

    x = (sway velocity v, yaw rate r) with A_m = [[0, -1], [1, -1.4]] and b = I, and the surge speed
    with A_m = -1.4. For each state: xh' = A_m xh + omega input + theta'x + sigma; estimate' =
    adaptation Proj(estimate, -(xh - x)'P regressor) with the regressors input, x and 1 of omega,
    theta and sigma, within their bounds, and A_m'P + P A_m = -I. The input is -D(s) (omega input +
    theta'x + sigma - wanted acceleration). Sway is open-loop thrust. Control allocation and heading
    loop are those of `l1_joystick`; heading_gain = 0 controls the yaw rate only, as in the thesis.

    Corrections, each with its parameter; docs/joystick.md has the consequence of each:

    - Predictor, gradient laws and low-pass run in Euler steps of 2 ms between two samples, along
      the line between two measurements. One step per period of 0.08 s exceeds the stability limit
      2 / sqrt(adaptation largest eigenvalue of P) = 0.015 s (`adaptation_step`).
    - Signs are those of Hovakimyan and Cao (2010): +theta'x, and all estimates against the error.
      The printed program adapts sigma along the error (`l1_joystick_as_published`).
    - All bounds contain zero disturbance; those of the thesis do not (`theta_low` and others).
    - The set point is multiplied by -A_m, so that v demands no rotation; the printed gain 1 turns
      a boat that sways (`feed_forward_as_published`).
    - Predictor and gradient laws get the input in force, after saturation and rounding, so that a
      saturated motor is not taken for a disturbance (`input_as_published`).
    - The bandwidth is 2 rad/s instead of 0.379, to meet the L1-norm condition (`yaw_bandwidth`).
    - If v is not measured, it is zero in the yaw equation, and the estimates of sway rest. The
      thesis takes the measured acceleration for it.
    """

    words: ClassVar[str] = (
        "L1 adaptive joystick with the thesis' gradient adaptation and projection"
    )
    commands: ClassVar[tuple[str, ...]] = (
        "pwm_port",
        "pwm_starboard",
        "steer_port_rad",
        "steer_starboard_rad",
    )
    goals: ClassVar[tuple[str, ...]] = STICK
    default_goals: ClassVar = dict.fromkeys(STICK, 0.0)
    law: ClassVar = law
    memory_type: ClassVar = record_type(
        "acted", "sway_measured", surge=CHANNEL, sway=CHANNEL, yaw=CHANNEL, heading=HEADING
    )

    adaptation: float = param(1e4, low=0.0, high=1e8, unit="", words="gain of the gradient laws")
    adaptation_step: float = param(
        0.002, low=1e-5, high=10.0, unit="s", words="Euler step of predictor and gradient laws"
    )
    omega_low: float = param(0.5, low=0.01, high=10.0, unit="", words="least input gain")
    omega_high: float = param(2.0, low=0.01, high=10.0, unit="", words="largest input gain")
    theta_low: float = param(-2.0, low=-100.0, high=100.0, unit="1/s", words="least theta")
    theta_high: float = param(2.0, low=-100.0, high=100.0, unit="1/s", words="largest theta")
    sigma_low: float = param(
        -2.0, low=-100.0, high=100.0, unit="m/s^2", words="least sigma; in yaw [rad/s^2]"
    )
    sigma_high: float = param(
        2.0, low=-100.0, high=100.0, unit="m/s^2", words="largest sigma; in yaw [rad/s^2]"
    )
    inertia: float = param(
        2.0, low=0.1, high=50.0, unit="kg m^2", words="assumed yaw inertia, added mass included"
    )
    mass: float = param(5.0, low=0.5, high=500.0, unit="kg", words="assumed surge mass")
    sway_mass: float = param(
        11.5, low=0.5, high=2000.0, unit="kg", words="assumed sway mass, added mass included"
    )
    yaw_bandwidth: float = param(
        2.0, low=0.1, high=20.0, unit="rad/s", words="low-pass of the yaw control"
    )
    surge_bandwidth: float = param(
        2.0, low=0.05, high=20.0, unit="rad/s", words="low-pass of the surge control"
    )
    filter_zero: float = param(
        17.7, low=1.0, high=50.0, unit="rad/s", words="zero of the low-pass; 50: none"
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
    feed_forward_as_published: bool = False
    input_as_published: bool = False

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return all adaptive estimates with their bounds, and the predicted states."""
        bounds = {
            "omega": (self.omega_low, self.omega_high),
            "theta_v": (self.theta_low, self.theta_high),
            "theta_r": (self.theta_low, self.theta_high),
            "sigma": (self.sigma_low, self.sigma_high),
        }
        found: dict[str, Estimate] = {}
        for axis, state in (("surge", "u_mps"), ("sway", "v_mps"), ("yaw", "r_radps")):
            for name, (low, high) in bounds.items():
                value = memory[axis]["unknown"][name]
                found[f"{name}_{axis}"] = Estimate(value, low, high)
            found[f"predicted_{state}"] = Estimate(memory[axis]["predicted"], nan, nan)
        return found

    def largest_goals(self) -> Mapping[str, float]:
        """Return the joystick demands at full stick: largest speeds [m/s] and turn rate [rad/s]."""
        return {**super().largest_goals(), "yaw_radps": self.rated_yaw}

    def feedback_loops(self) -> tuple[LoopChannel, ...]:
        """Return the yaw and surge feedback loops on a nominal boat, for fast adaptation.

        The true thrust over inertia is 0.5 to 1.8 times the assumed one. Actuators are ideal. The
        zero and the second pole of the low-pass filter are far above the crossover and left out.
        """
        held = partial(LoopChannel, hold_s=0.5 * self.period, input_gain=(0.5, 1.0, 1.8))
        yaw_pole = -MODEL[1][1]
        return (
            held(
                "yaw", pole=yaw_pole, bandwidth=self.yaw_bandwidth, heading_gain=self.heading_gain
            ),
            held("surge", pole=SURGE_POLE, bandwidth=self.surge_bandwidth),
        )
