"""L1 adaptive speed control of a water-jet craft by its throttle.

C. Svendsen et al., L1 adaptive manoeuvring control, IFAC MCMC 2012, section 4.1.
"""

from dataclasses import dataclass
from math import exp, nan
from typing import Any, ClassVar

from boatsim.control.adaptive import LinearSystem, l1_norm, uncertainty_to_state_system
from boatsim.control.adaptive_loop import (
    adapt_loop,
    compute_loop_input,
    initialise_loop,
    loop_memory_type,
    make_loop_design,
)
from boatsim.control.allocation import limit
from boatsim.control.base import Estimate
from boatsim.control.compiled import (
    CompiledController,
    Records,
    add_nested_records,
    record_type,
    unlocked,
)
from boatsim.control.jet import power_at_throttle, throttle_for_power
from boatsim.physics.base import param

THETA, SIGMA, OMEGA = (0.2025, 1.7716), (-23.17, 23.17), (0.1, 2.0)  # section 4.1; 1/s, m/s^2, 1
SLOWEST = 0.5  # [m/s] lowest speed in thrust = power / speed
IDLE, FULL = 1.0, 7.0  # throttle
# [1/s], [1/m] drag per mass, Table 3: only where the filter starts
LINEAR = 0.1926
QUADRATIC = 0.0035
NO_LIMIT = 1e9  # [m/s^3] of the thrust's rate


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the throttle of a water-jet craft for the next period, by L1 adaptive speed control.

    Args:
        boats: Row numbers of the boats to process.
        settings: Parameters of each controller.
        memory: State of each controller.
        sense: Sensor readings of each boat.
        goal: Set points of each boat.
        sent: Commands of each boat, filled in.
    """
    for b in boats:
        q, m, s, wanted = settings[b], memory[b], sense[b], goal[b].u_mps
        u = max(s.u, SLOWEST)
        # [m/s^2] thrust per mass at this speed
        low = power_at_throttle(IDLE, q.q2) / u
        high = power_at_throttle(FULL, q.q2) / u
        m.loop.after[0] = s.u
        if m.started == 0.0:
            m.model, m.throttle, m.started = s.u, IDLE, 1.0
            initialise_loop(m.loop, q.loop, limit((LINEAR + QUADRATIC * u) * u, low, high))
        else:
            mean = max(0.5 * (m.speed + s.u), SLOWEST)
            adapt_loop(m.loop, q.loop, power_at_throttle(m.throttle, q.q2) / mean)
            m.model += (1.0 - exp(-q.pole * q.period)) * (m.goal - m.model)
        gain = 1.0 / q.pole if q.gain_as_published != 0.0 else q.pole
        thrust = compute_loop_input(m.loop, q.loop, gain * wanted, low, high, NO_LIMIT)
        m.speed, m.goal, m.throttle = s.u, wanted, throttle_for_power(thrust * u, q.q2)
        sent[b].throttle, sent[b].jet_rad = m.throttle, goal[b].jet_rad


@dataclass
class L1Cruise(CompiledController):
    """L1 adaptive control of the speed by the thrust per mass tau, equations 17 to 24.

    u' = -pole u + omega tau + theta u + sigma

    The thrust is limited to what the throttle gives at the present speed, and the predictor
    receives the limited thrust. Goals: `u_mps`, and `jet_rad`, which is passed on.
    """

    words: ClassVar[str] = "L1 adaptive speed of a water-jet craft on its throttle"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("u_mps", "jet_rad")
    default_goals: ClassVar = {"jet_rad": 0.0}
    tuned: ClassVar[tuple[str, ...]] = ("pole", "bandwidth")
    law: ClassVar = law
    memory_type: ClassVar = record_type(
        "started", "goal", "model", "speed", "throttle", loop=loop_memory_type(1)
    )

    period: float = param(
        0.002, low=0.0001, high=0.1, unit="s", words="time between two control steps"
    )
    substep: float = param(
        1e-4, low=1e-6, high=0.1, unit="s", words="step of predictor, adaptation and filter"
    )
    pole: float = param(
        1.4, low=0.1, high=20.0, unit="1/s", words="-alpha_des, pole of the reference motion"
    )
    bandwidth: float = param(
        35.0, low=0.1, high=1e3, unit="1/s", words="k_u; the L1-norm condition needs 12.1"
    )
    adaptation: float = param(1e4, low=1.0, high=1e7, unit="", words="Gamma_u")
    q2: float = param(
        154.9,
        low=0.0,
        high=1e3,
        unit="m^2/s^3",
        words="constant of the power curve; the source prints 164.5",
    )
    gain_as_published: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: k_g = 1/pole, which is wrong"
    )

    def settings_array(self, count: int = 1) -> Records:
        """Return the controller's parameters and L1 loop design as records for its compiled law.

        Args:
            count: Number of equal controllers.
        """
        low, high = zip(THETA, SIGMA, OMEGA, strict=True)
        loop = make_loop_design(
            [[-self.pole]],
            low,
            high,
            (1.0, 0.0, 1.0),
            gain=self.adaptation,
            bandwidth=self.bandwidth,
            period=self.period,
            step=self.substep,
        )
        return add_nested_records(super().settings_array(count), loop=loop)

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the adaptive estimates with their bounds, and the reference speed, for the log.

        They are theta, sigma and omega of the model of the class.
        """
        found = memory["loop"]["estimates"]
        return {
            "theta_1ps": Estimate(found[..., 0], *THETA),
            "sigma_mps2": Estimate(found[..., 1], *SIGMA),
            "omega": Estimate(found[..., 2], *OMEGA),
            "reference_goal_mps": Estimate(memory["goal"], nan, nan),
            "reference_u_mps": Estimate(memory["model"], nan, nan),
        }

    def filtered_uncertainty(self) -> LinearSystem:
        """Return the linear system from an uncertainty to the speed error of the L1 loop.

        The part of the uncertainty that the low-pass filter cancels is subtracted. The input gain
        is the lowest one. The system's L1 norm is that of the published design.
        """
        return uncertainty_to_state_system([[-self.pole]], [1.0], OMEGA[0] * self.bandwidth)

    def l1_condition(self) -> float:
        """Return the left side of the L1-norm stability condition of the speed loop.

        It is the L1 norm times the largest slope of the uncertainty. Below 1 the loop is bounded
        (Fig. 8).
        """
        return l1_norm(self.filtered_uncertainty()) * THETA[1]
