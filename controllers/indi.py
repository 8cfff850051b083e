"""Incremental nonlinear dynamic inversion (INDI) of yaw rate and surge speed of two outboards."""

from dataclasses import dataclass
from math import exp, isnan
from types import SimpleNamespace
from typing import Any, ClassVar

from boatsim.control.allocation import HEADING, command_outboards, thrust_difference_for_sway
from boatsim.control.compiled import merged, record_type, unlocked
from boatsim.control.joystick import demanded_yaw_rate
from boatsim.control.lag_joystick import LagJoystick, actuator_output
from boatsim.control.operating_points import AxisLaw

# filtered velocity, modelled force of the actuators and the same through the filter [N or N m]
FILTERS = record_type("velocity", "force", "filtered")
REMEMBERS = record_type("acted", "X", "N", yaw=FILTERS, surge=FILTERS, heading=HEADING)


@merged
def incremental_force(
    q: Any, a: Any, measured: float, applied: float, acted: bool, wanted: float, inertia: float
) -> float:
    """Return the force or moment by which a velocity follows its set point.

    It is the present force plus an increment for the missing acceleration. The acceleration is the
    derivative of the filtered velocity; the present force is the output of the modelled actuators
    through the same filter, so that both belong to the same instant.

    Args:
        q: Parameters of the controller.
        a: `FILTERS` record, advanced in place.
        measured: Measured velocity [m/s or rad/s].
        applied: Commanded force of the last period [N or N m].
        acted: False in the first step.
        wanted: Set point of the velocity.
        inertia: Assumed mass or inertia [kg or kg m^2].
    """
    if not acted:
        a.velocity = measured
        return float(inertia * q.pole * (wanted - measured))
    share = 1.0 - exp(-q.bandwidth * q.period)
    a.force = actuator_output(a.force, applied, q.motor_lag + q.command_delay, q.period)
    a.filtered += share * (a.force - a.filtered)
    change = share * (measured - a.velocity)
    a.velocity += change
    wrench: float = a.filtered + inertia * (q.pole * (wanted - measured) - change / q.period)
    return wrench


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the outboard commands of INDI joystick controllers for the next period.

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
        moment = incremental_force(q, m.yaw, s.r, m.N, acted, rate, q.inertia)
        if isnan(s.u):
            surge = q.blind_surge * g.surge_mps
        else:
            surge = incremental_force(q, m.surge, s.u, m.X, acted, g.surge_mps, q.mass)
        room = q.pole * q.mass * abs(g.surge_mps)
        m.X, _, m.N = command_outboards(
            q, surge, thrust_difference_for_sway(q, g.sway_mps), moment, room, sent[b]
        )
        m.acted = 1.0


@dataclass
class Indi(LagJoystick):
    """Incremental nonlinear dynamic inversion of yaw rate and, if measured, surge speed.

    N = F(s) A(s) N + I (p (x_ref - x) - s F(s) x)

    with the low-pass F of the bandwidth, the modelled actuators A (first-order, the known lag) and
    the pole p; sway is open-loop thrust. Without A the increment would be added to a force that the
    motors do not give yet. S. Sieberling, Q. P. Chu, J. A. Mulder, Robust flight control using
    incremental nonlinear dynamic inversion and angular acceleration prediction, Journal of
    Guidance, Control, and Dynamics 33, 2010; E. J. J. Smeur, Q. P. Chu, G. C. H. E. de Croon, the
    same journal 39, 2016.
    """

    words: ClassVar[str] = (
        "incremental nonlinear dynamic inversion with actuator model on the joystick's allocation"
    )
    tuned: ClassVar[tuple[str, ...]] = ("bandwidth", "pole")
    law: ClassVar = law
    memory_type: ClassVar = REMEMBERS

    def axis_law(self, axis: str) -> AxisLaw:
        """Return the law of one axis, without limits, as a function of its state and inputs.

        Args:
            axis: "yaw" or "surge".
        """
        inertia = self.inertia if axis == "yaw" else self.mass

        def step(a: SimpleNamespace, measured: float, applied: float, wanted: float) -> float:
            force: float = incremental_force.py_func(
                self, a, measured, applied, True, wanted, inertia
            )
            return force

        return step
