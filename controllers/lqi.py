"""Linear-quadratic regulator with integral action (LQI) of yaw rate and surge speed."""

from dataclasses import dataclass
from math import isnan, sqrt
from types import SimpleNamespace
from typing import Any, ClassVar

from boatsim.control.allocation import HEADING, command_outboards, thrust_difference_for_sway
from boatsim.control.compiled import merged, record_type, unlocked
from boatsim.control.joystick import demanded_yaw_rate
from boatsim.control.lag_joystick import LagJoystick, actuator_output
from boatsim.control.linear_model import read_linear_model
from boatsim.control.linear_quadratic import axis_parameters, integral_gains
from boatsim.control.operating_points import AxisLaw
from boatsim.physics.base import UNSET, param

# integral of the error [m or rad], modelled force of the actuators and missed force [N or N m]
LOOP = record_type("integral", "force", "missed")
REMEMBERS = record_type("acted", "X", "N", yaw=LOOP, surge=LOOP, heading=HEADING)
# Of the demand: a larger difference to the commanded force is one of the limits, a smaller one that
# of commands rounded to whole PWM values. Full thrust has 255 of them.
ROUNDING = 0.02  # [N] or [N m]


@merged
def regulating_force(
    q: Any,
    a: Any,
    measured: float,
    applied: float,
    wanted: float,
    integral_gain: float,
    velocity_gain: float,
    force_gain: float,
) -> float:
    """Return the force or moment by which a velocity follows its set point.

    The integral stops where it would increase a force that the motors do not give.

    Args:
        q: Parameters of the controller.
        a: `LOOP` record, advanced in place.
        measured: Measured velocity [m/s or rad/s].
        applied: Commanded force of the last period [N or N m].
        wanted: Set point of the velocity.
        integral_gain: Gain of the integral of the error.
        velocity_gain: Gain of the velocity.
        force_gain: Gain of the modelled force of the actuators.
    """
    a.force = actuator_output(a.force, applied, q.motor_lag + q.command_delay, q.period)
    error = wanted - measured
    if a.missed * error <= 0.0 or abs(a.missed) <= ROUNDING:
        a.integral += q.period * error
    wrench: float = integral_gain * a.integral - velocity_gain * measured - force_gain * a.force
    return wrench


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the outboard commands of LQI joystick controllers for the next period.

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
        rate = demanded_yaw_rate(q, m, s, g.yaw_radps)
        moment = regulating_force(
            q, m.yaw, s.r, m.N, rate, q.yaw_integral, q.yaw_velocity, q.yaw_force
        )
        if isnan(s.u):
            surge = q.blind_surge * g.surge_mps
        else:
            surge = regulating_force(
                q, m.surge, s.u, m.X, g.surge_mps, q.surge_integral, q.surge_velocity, q.surge_force
            )
        room = q.pole * q.mass * abs(g.surge_mps)
        m.X, _, m.N = command_outboards(
            q, surge, thrust_difference_for_sway(q, g.sway_mps), moment, room, sent[b]
        )
        m.yaw.missed, m.surge.missed = moment - m.N, surge - m.X
        m.acted = 1.0


@dataclass
class Lqi(LagJoystick):
    """Linear-quadratic regulator with integral action of yaw rate and, if measured, surge speed.

    N = k_i (integral of x_ref - x) - k_x x - k_F F

    F is the modelled force of the actuators, a first-order lag. The gains minimise the integral of
    the squared error integral and of the squared command for the model I x' = F - d x; its numbers
    are the nominal inertias and the damping `yaw_damping`, `surge_damping`, or those of the file
    `model` that `boatsim linearise VESSEL --out FILE.json` wrote, with its motor lag and command
    delay. The weight of the command is such that the natural frequency is the geometric mean of
    bandwidth and pole. Sway is open-loop thrust.
    """

    words: ClassVar[str] = (
        "linear-quadratic regulator with integral action on the joystick's allocation"
    )
    law: ClassVar = law
    memory_type: ClassVar = REMEMBERS

    model: str = ""  # .json of boatsim linearise; replaces inertia, mass, damping, lag and delay
    yaw_damping: float = param(
        0.0, low=0.0, high=1e3, unit="N m s", words="assumed linear damping of the yaw rate"
    )
    surge_damping: float = param(
        0.0, low=0.0, high=1e3, unit="N s/m", words="assumed linear damping of the surge speed"
    )
    yaw_integral: float = param(
        UNSET, low=0.0, high=1e4, unit="N m/rad", words="gain of the integral of the yaw rate error"
    )
    yaw_velocity: float = param(
        UNSET, low=0.0, high=1e4, unit="N m s/rad", words="gain of the yaw rate"
    )
    yaw_force: float = param(
        UNSET, low=0.0, high=1e2, unit="", words="gain of the modelled yaw moment"
    )
    surge_integral: float = param(
        UNSET, low=0.0, high=1e4, unit="N/m", words="gain of the integral of the speed error"
    )
    surge_velocity: float = param(
        UNSET, low=0.0, high=1e4, unit="N s/m", words="gain of the surge speed"
    )
    surge_force: float = param(
        UNSET, low=0.0, high=1e2, unit="", words="gain of the modelled surge force"
    )

    def derive_gains(self) -> None:
        """Set the gains that are not given by the linear-quadratic problem.

        Raises:
            BadInput: An inertia, the pole or the period is not positive, or the file of the linear
                model cannot be used.
        """
        if self.model:
            for name, value in axis_parameters(read_linear_model(self.model)).items():
                setattr(self, name, value)
        super().derive_gains()
        lag = self.motor_lag + self.command_delay
        axes = (("yaw", self.inertia, self.yaw_damping), ("surge", self.mass, self.surge_damping))
        # one pair of poles instead of those of an observer and of the response: between both
        frequency = sqrt(self.bandwidth * self.pole)
        for axis, inertia, damping in axes:
            gains = integral_gains(inertia, damping, lag, self.period, frequency)
            for name, value in gains._asdict().items():
                if getattr(self, f"{axis}_{name}") is UNSET:
                    setattr(self, f"{axis}_{name}", value)

    def axis_law(self, axis: str) -> AxisLaw:
        """Return the law of one axis, without limits, as a function of its state and inputs.

        Args:
            axis: "yaw" or "surge".
        """
        gains = [getattr(self, f"{axis}_{name}") for name in ("integral", "velocity", "force")]

        def step(a: SimpleNamespace, measured: float, applied: float, wanted: float) -> float:
            a.missed = 0.0  # of the limits
            output = regulating_force.py_func(self, a, measured, applied, wanted, *gains)
            return float(output)

        return step
