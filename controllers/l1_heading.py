"""L1 adaptive heading control of a water-jet craft with a second-order reference model.

C. Svendsen et al., L1 adaptive manoeuvring control, IFAC MCMC 2012, section 4.2.
"""

from dataclasses import dataclass
from math import nan, radians
from typing import Any, ClassVar

from boatsim.control.adaptive_loop import (
    adapt_loop,
    compute_loop_input,
    initialise_loop,
    loop_memory_type,
    make_loop_design,
    shift_loop_reference,
)
from boatsim.control.base import Estimate, wrap
from boatsim.control.compiled import (
    CompiledController,
    Records,
    add_nested_records,
    lean,
    merged,
    record_type,
    unlocked,
)
from boatsim.physics.base import param

# chosen, because no bounds are published
THETA_1 = (-3.0, 3.0)
THETA_2 = (-5.0, 5.0)
SIGMA = (-5.0, 5.0)
OMEGA = (0.1, 10.0)
JUMP = 1.0  # [rad/s] a faster change of the reference counts as a jump
STIFFNESS = 1.0  # [1/s^2] stiffness of the reference motion, A_m = [[0, -1], [1, -1.4]]
wrapped = lean(wrap)


@merged
def adapt_over_period(q: Any, m: Any, s: Any, change: float) -> None:
    """Update the adaptive estimates of an L1 heading controller over the last period.

    The reference heading changed steadily in the period or jumps at its end. The reference model is
    advanced by the midpoint rule.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        s: Sensor readings.
        change: Change of the reference heading [rad].
    """
    jump = change if abs(change) > JUMP * q.period else 0.0
    rate = (change - jump) / q.period
    m.loop.drift[0] = rate * q.knows_rate
    m.loop.after[0] = wrapped(m.goal + change - jump - s.psi)
    m.loop.after[1] = s.r
    adapt_loop(m.loop, q.loop, m.jet)
    half = 0.5 * q.period  # the motion asked for, by the midpoint rule
    error = m.error + half * (rate - m.rate)
    turning = m.rate + half * (STIFFNESS * m.error - q.damping * m.rate)
    m.error += q.period * (rate - turning) + jump
    m.rate += q.period * (STIFFNESS * error - q.damping * turning)
    if jump != 0.0:
        shift_loop_reference(m.loop, jump, q.jumps_shift)


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the jet angle of a water-jet craft for the next period, by L1 heading control.

    Args:
        boats: Row numbers of the boats to process.
        settings: Parameters of each controller.
        memory: State of each controller.
        sense: Sensor readings of each boat.
        goal: Set points of each boat.
        sent: Commands of each boat, filled in.
    """
    for b in boats:
        q, m, s, g = settings[b], memory[b], sense[b], goal[b]
        if m.started == 0.0:
            m.error, m.rate, m.started = wrapped(g.psi_rad - s.psi), s.r, 1.0
            m.loop.after[0], m.loop.after[1] = m.error, m.rate
            initialise_loop(m.loop, q.loop, 0.0)
        else:
            adapt_over_period(q, m, s, wrapped(g.psi_rad - m.goal))
        m.goal = g.psi_rad
        m.jet = compute_loop_input(m.loop, q.loop, 0.0, -q.largest, q.largest, q.rate)
        sent[b].jet_rad, sent[b].throttle = m.jet, g.throttle


@dataclass
class L1Heading(CompiledController):
    """L1 adaptive control of heading error e and yaw rate r by the jet angle delta.

    r' = e - damping r + omega delta + theta'(e, r) + sigma

    At bandwidth 80 and an input gain of 3 the input filter has a bandwidth of 240 rad/s: with a
    delay of 10 ms the jet oscillates between its limits, so that the controller must run at 500 Hz
    or faster. Goals: `psi_rad`, and `throttle`, which is passed on.
    """

    words: ClassVar[str] = "L1 adaptive heading of a water-jet craft on its jet"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("psi_rad", "throttle")
    default_goals: ClassVar = {"throttle": 1.0}
    tuned: ClassVar[tuple[str, ...]] = ("damping", "bandwidth")
    law: ClassVar = law
    memory_type: ClassVar = record_type(
        "started", "goal", "jet", "error", "rate", loop=loop_memory_type(2)
    )

    period: float = param(
        0.002, low=0.0001, high=0.1, unit="s", words="time between two control steps"
    )
    substep: float = param(
        2e-4, low=1e-6, high=0.1, unit="s", words="step of predictor, adaptation and filter"
    )
    damping: float = param(
        1.4, low=0.1, high=20.0, unit="1/s", words="damping of the reference motion, A_m"
    )
    bandwidth: float = param(
        80.0, low=0.1, high=1e3, unit="1/s", words="k_h; published condition 60"
    )
    adaptation: float = param(1e5, low=1.0, high=1e7, unit="", words="Gamma_h")
    first_omega: float = param(
        3.0, low=0.1, high=10.0, unit="1/s^2", words="input gain assumed at the start"
    )
    largest: float = param(
        radians(15.0), low=0.0, high=1.5, unit="rad", words="largest jet deflection to either side"
    )
    rate: float = param(
        radians(30.0), low=0.001, high=1e3, unit="rad/s", words="largest rate of the jet"
    )
    jumps_shift: float = param(
        1.0,
        low=0.0,
        high=1.0,
        unit="",
        words="1: a step of the reference shifts the predictor; 0: not, as printed",
    )
    knows_rate: float = param(
        1.0,
        low=0.0,
        high=1.0,
        unit="",
        words="1: the rate of the reference is used; 0: omitted, as printed",
    )
    regressor_as_published: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: sigma is adapted by delta, eq. 32"
    )

    def settings_array(self, count: int = 1) -> Records:
        """Return the controller's parameters and L1 loop design as records for its compiled law.

        Args:
            count: Number of equal controllers.
        """
        am = [[0.0, -1.0], [STIFFNESS, -self.damping]]
        low, high = zip(THETA_1, THETA_2, SIGMA, OMEGA, strict=True)
        loop = make_loop_design(
            am,
            low,
            high,
            (0.0, 0.0, 0.0, self.first_omega),
            gain=self.adaptation,
            bandwidth=self.bandwidth,
            period=self.period,
            step=self.substep,
        )
        if self.regressor_as_published:
            loop["by"][:, 2] = 3
        return add_nested_records(super().settings_array(count), loop=loop)

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the adaptive estimates with their bounds, the set point and the reference heading.

        The estimates are theta, sigma and omega of the model of the class.
        """
        goal, found = memory["goal"], memory["loop"]["estimates"]
        return {
            "theta_1": Estimate(found[..., 0], *THETA_1),
            "theta_2": Estimate(found[..., 1], *THETA_2),
            "sigma_radps2": Estimate(found[..., 2], *SIGMA),
            "omega_1ps2": Estimate(found[..., 3], *OMEGA),
            "reference_goal_rad": Estimate(goal, nan, nan),
            "reference_psi_rad": Estimate(goal - memory["error"], nan, nan),
        }
