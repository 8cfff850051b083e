"""Active disturbance rejection control (ADRC) of yaw rate and surge speed of two outboards."""

from dataclasses import dataclass
from math import exp, isnan, nan
from types import SimpleNamespace
from typing import Any, ClassVar

from boatsim.control.allocation import HEADING, command_outboards, thrust_difference_for_sway
from boatsim.control.base import Estimate
from boatsim.control.compiled import merged, record_type, unlocked
from boatsim.control.joystick import demanded_yaw_rate
from boatsim.control.lag_joystick import LagJoystick, actuator_output
from boatsim.control.operating_points import AxisLaw

# velocity, total disturbance [acceleration], modelled force of the actuators [N or N m]
OBSERVER = record_type("velocity", "disturbance", "force")
REMEMBERS = record_type("acted", "X", "N", yaw=OBSERVER, surge=OBSERVER, heading=HEADING)


@merged
def rejecting_force(
    q: Any, a: Any, measured: float, applied: float, acted: bool, wanted: float, inertia: float
) -> float:
    """Return the force or moment by which a velocity follows its set point.

    An extended-state observer with two poles at the bandwidth estimates the velocity and the total
    disturbance, an acceleration; the observer is exact for forces held over a period. It receives
    the force behind the known motor lag.

    Args:
        q: Parameters of the controller.
        a: `OBSERVER` record, advanced in place.
        measured: Measured velocity [m/s or rad/s].
        applied: Commanded force of the last period [N or N m].
        acted: False in the first step.
        wanted: Set point of the velocity.
        inertia: Assumed mass or inertia [kg or kg m^2].
    """
    T = q.period
    if acted:
        a.force = actuator_output(a.force, applied, q.motor_lag + q.command_delay, T)
        predicted = a.velocity + T * (a.disturbance + a.force / inertia)
        decay = exp(-q.bandwidth * T)
        error = measured - predicted
        a.velocity = predicted + (1.0 - decay * decay) * error
        a.disturbance += (1.0 - decay) ** 2 / T * error
    else:
        a.velocity = measured
    wrench: float = inertia * (q.pole * (wanted - a.velocity) - a.disturbance)
    return wrench


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the outboard commands of ADRC joystick controllers for the next period.

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
        rate = demanded_yaw_rate(q, m, s, g.yaw_radps)
        moment = rejecting_force(q, m.yaw, s.r, m.N, acted, rate, q.inertia)
        if isnan(s.u):
            surge = q.blind_surge * g.surge_mps
        else:
            surge = rejecting_force(q, m.surge, s.u, m.X, acted, g.surge_mps, q.mass)
        room = q.pole * q.mass * abs(g.surge_mps)
        m.X, _, m.N = command_outboards(
            q, surge, thrust_difference_for_sway(q, g.sway_mps), moment, room, sent[b]
        )
        m.acted = 1.0


@dataclass
class Adrc(LagJoystick):
    """Active disturbance rejection control of yaw rate and, if measured, surge speed.

    x' = N / I + f,  z1' = z2 + N / I + 2 w (x - z1),  z2' = w^2 (x - z1)
    N = I (p (x_ref - z1) - z2)

    with the bandwidth w and the pole p; sway is open-loop thrust. J. Han, From PID to active
    disturbance rejection control, IEEE Trans. Industrial Electronics 56, 2009; Z. Gao, Scaling and
    bandwidth-parameterization based controller tuning, American Control Conference 2003.
    """

    words: ClassVar[str] = (
        "active disturbance rejection (extended-state observer) on the joystick's allocation"
    )
    tuned: ClassVar[tuple[str, ...]] = ("bandwidth", "pole")
    law: ClassVar = law
    memory_type: ClassVar = REMEMBERS

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
            force: float = rejecting_force.py_func(
                self, a, measured, applied, True, wanted, inertia
            )
            return force

        return step
