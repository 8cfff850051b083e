"""Offset-free model predictive control (MPC) of yaw rate and surge speed of two outboards."""

from dataclasses import dataclass
from math import exp, isnan, nan
from types import SimpleNamespace
from typing import Any, ClassVar

from boatsim.control.allocation import (
    HEADING,
    PWM_MAX,
    command_outboards,
    limit,
    thrust_at_pwm,
    thrust_difference_for_sway,
)
from boatsim.control.base import Estimate
from boatsim.control.compiled import merged, record_type, unlocked
from boatsim.control.joystick import demanded_yaw_rate
from boatsim.control.lag_joystick import LagJoystick, actuator_output
from boatsim.control.operating_points import AxisLaw
from boatsim.control.receding_horizon import predictive_gains
from boatsim.physics.base import UNSET, param

# estimated velocity, total disturbance [acceleration], modelled force of the actuators [N or N m]
OBSERVER = record_type("velocity", "disturbance", "force")
REMEMBERS = record_type("acted", "X", "N", yaw=OBSERVER, surge=OBSERVER, heading=HEADING)


@merged
def predictive_force(
    q: Any, a: Any, measured: float, applied: float, acted: bool, wanted: float, inertia: float
) -> float:
    """Return the force or moment by which a velocity follows its set point.

    An observer with two poles at the bandwidth estimates velocity and disturbance; the gains are
    those of the first optimal command over the horizon.

    Args:
        q: Parameters of the controller.
        a: `OBSERVER` record, advanced in place.
        measured: Measured velocity [m/s or rad/s].
        applied: Commanded force of the last period [N or N m].
        acted: False in the first step.
        wanted: Set point of the velocity.
        inertia: Assumed mass or inertia [kg or kg m^2].
    """
    if acted:
        a.force = actuator_output(a.force, applied, q.motor_lag + q.command_delay, q.period)
        predicted = a.velocity + q.period * (a.disturbance + a.force / inertia)
        decay = exp(-q.bandwidth * q.period)
        error = measured - predicted
        a.velocity = predicted + (1.0 - decay * decay) * error
        a.disturbance += (1.0 - decay) ** 2 / q.period * error
    else:
        a.velocity = measured
    command: float = inertia * (
        q.velocity_gain * (wanted - a.velocity) - q.disturbance_gain * a.disturbance
    )
    command -= q.force_gain * a.force + q.before_gain * applied
    return command


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the outboard commands of MPC joystick controllers for the next period.

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
        acted = m.acted != 0.0
        ahead, astern = thrust_at_pwm(q, PWM_MAX), -thrust_at_pwm(q, -PWM_MAX)
        rate = demanded_yaw_rate(q, m, s, g.yaw_radps)
        largest = q.half_spacing * (ahead + astern)
        moment = predictive_force(q, m.yaw, s.r, m.N, acted, rate, q.inertia)
        if isnan(s.u):
            surge = q.blind_surge * g.surge_mps
        else:
            surge = predictive_force(q, m.surge, s.u, m.X, acted, g.surge_mps, q.mass)
        room = q.pole * q.mass * abs(g.surge_mps)
        m.X, _, m.N = command_outboards(
            q,
            limit(surge, -2.0 * astern, 2.0 * ahead),
            thrust_difference_for_sway(q, g.sway_mps),
            limit(moment, -largest, largest),
            room,
            sent[b],
        )
        m.acted = 1.0


@dataclass
class Mpc(LagJoystick):
    """Offset-free model predictive control of yaw rate and, if measured, surge speed.

    The predicted motion I x' = F + d, T F' = u - F contains the known motor lag T and the estimated
    disturbance d. Eight commands over two time constants minimise the squared deviation from a
    reference that approaches the set point with the pole, and the squared changes of the command;
    the first one is applied for one period, within the limits of the motors. Sway is open-loop
    thrust.
    """

    words: ClassVar[str] = (
        "offset-free predictive control with disturbance estimate on the joystick's allocation"
    )
    law: ClassVar = law
    memory_type: ClassVar = REMEMBERS

    velocity_gain: float = param(
        UNSET, low=0.0, high=1e3, unit="1/s", words="gain of the velocity error; default: optimal"
    )
    disturbance_gain: float = param(
        UNSET, low=0.0, high=1e2, unit="", words="gain of the disturbance; default: optimal"
    )
    force_gain: float = param(
        UNSET, low=-1e2, high=1e2, unit="", words="gain of the actuators' force; default: optimal"
    )
    before_gain: float = param(
        UNSET, low=-1e2, high=1e2, unit="", words="gain of the last command; default: optimal"
    )

    def derive_gains(self) -> None:
        """Set the gains that are not given by the optimal commands over the horizon.

        Raises:
            BadInput: The pole is not positive.
        """
        super().derive_gains()
        gains = predictive_gains(self.pole, self.motor_lag + self.command_delay)
        for name, value in gains._asdict().items():
            if getattr(self, f"{name}_gain") is UNSET:
                setattr(self, f"{name}_gain", value)

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the estimated disturbances of yaw and surge as a moment and a force."""
        yaw, surge = memory["yaw"]["disturbance"], memory["surge"]["disturbance"]
        return {
            "sigma_yaw_Nm": Estimate(self.inertia * yaw, nan, nan),
            "sigma_surge_N": Estimate(self.mass * surge, nan, nan),
        }

    def axis_law(self, axis: str) -> AxisLaw:
        """Return the law of one axis, without limits, as a function of its state and inputs.

        Args:
            axis: "yaw" or "surge".
        """
        inertia = self.inertia if axis == "yaw" else self.mass

        def step(a: SimpleNamespace, measured: float, applied: float, wanted: float) -> float:
            force: float = predictive_force.py_func(
                self, a, measured, applied, True, wanted, inertia
            )
            return force

        return step
