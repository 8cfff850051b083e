"""L1 adaptive heading control of a water-jet craft: its jet turns it as a second-order model would turn."""

from dataclasses import dataclass
from math import nan, radians
from typing import Any, ClassVar

from boatsim.control.adaptive_loop import (
    act_loop,
    begin_loop,
    designed,
    loop_memory,
    observe_loop,
    shift_loop,
)
from boatsim.control.base import Estimate, wrap
from boatsim.control.compiled import (
    CompiledController,
    Records,
    lean,
    merged,
    record,
    unlocked,
    with_parts,
)
from boatsim.physics.base import param

# chosen: none are published
THETA_1 = (-3.0, 3.0)
THETA_2 = (-5.0, 5.0)
SIGMA = (-5.0, 5.0)
OMEGA = (0.1, 10.0)
JUMP = 1.0  # [rad/s] a reference that changes faster jumps
STIFFNESS = 1.0  # [1/s^2] of the motion asked for, A_m = [[0, -1], [1, -1.4]]
wrapped = lean(wrap)


@merged
def observe(q: Any, m: Any, s: Any, change: float) -> None:
    """One period back: the reference changed steadily, or it jumps now."""
    jump = change if abs(change) > JUMP * q.period else 0.0
    rate = (change - jump) / q.period
    m.loop.drift[0] = rate * q.knows_rate
    m.loop.after[0] = wrapped(m.goal + change - jump - s.psi)
    m.loop.after[1] = s.r
    observe_loop(m.loop, q.loop, m.jet)
    half = 0.5 * q.period  # the motion asked for, by the midpoint rule
    error = m.error + half * (rate - m.rate)
    turning = m.rate + half * (STIFFNESS * m.error - q.damping * m.rate)
    m.error += q.period * (rate - turning) + jump
    m.rate += q.period * (STIFFNESS * error - q.damping * turning)
    if jump != 0.0:
        shift_loop(m.loop, jump, q.jumps_shift)


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Jet deflection for the next period."""
    for b in boats:
        q, m, s, g = settings[b], memory[b], sense[b], goal[b]
        if m.started == 0.0:
            m.error, m.rate, m.started = wrapped(g.psi_rad - s.psi), s.r, 1.0
            m.loop.after[0], m.loop.after[1] = m.error, m.rate
            begin_loop(m.loop, q.loop, 0.0)
        else:
            observe(q, m, s, wrapped(g.psi_rad - m.goal))
        m.goal = g.psi_rad
        m.jet = act_loop(m.loop, q.loop, 0.0, -q.largest, q.largest, q.rate)
        sent[b].jet_rad, sent[b].throttle = m.jet, g.throttle


@dataclass
class L1Heading(CompiledController):
    """Heading error e and yaw rate r, r' = e - damping r + omega delta + theta'(e, r) + sigma; section 4.2.

    At bandwidth 80 and an input gain of 3 the input's filter is as quick as 240 rad/s: a delay of 10 ms makes the jet
    swing from stop to stop, and the control must run at 500 Hz or more. Goals: `psi_rad`, and `throttle`, passed on.
    """

    words: ClassVar[str] = "L1 adaptive heading of a water-jet craft on its jet"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("psi_rad", "throttle")
    default_goals: ClassVar = {"throttle": 1.0}
    law: ClassVar = law
    memory_type: ClassVar = record("started", "goal", "jet", "error", "rate", loop=loop_memory(2))

    period: float = param(
        0.002, low=0.0001, high=0.1, unit="s", words="time between two control steps"
    )
    substep: float = param(
        2e-4, low=1e-6, high=0.1, unit="s", words="of predictor, adaptation and filter"
    )
    damping: float = param(
        1.4, low=0.1, high=20.0, unit="1/s", words="of the motion asked for, A_m"
    )
    bandwidth: float = param(
        80.0, low=0.1, high=1e3, unit="1/s", words="k_h; published condition 60"
    )
    adaptation: float = param(1e5, low=1.0, high=1e7, unit="", words="Gamma_h")
    first_omega: float = param(
        3.0, low=0.1, high=10.0, unit="1/s^2", words="input gain assumed at the start"
    )
    largest: float = param(
        radians(15.0), low=0.0, high=1.5, unit="rad", words="jet deflection either way"
    )
    rate: float = param(
        radians(30.0), low=0.001, high=1e3, unit="rad/s", words="fastest turning of the jet"
    )
    jumps_shift: float = param(
        1.0, low=0.0, high=1.0, unit="", words="0: a step of the reference surprises, as printed"
    )
    knows_rate: float = param(
        1.0, low=0.0, high=1.0, unit="", words="0: the reference's rate is left out, as printed"
    )
    regressor_as_published: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: sigma is adapted by delta, eq. 32"
    )

    def settings(self, count: int = 1) -> Records:
        """Its parameters, and how its loop is laid out."""
        am = [[0.0, -1.0], [STIFFNESS, -self.damping]]
        low, high = zip(THETA_1, THETA_2, SIGMA, OMEGA, strict=True)
        loop = designed(
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
        return with_parts(super().settings(count), loop=loop)

    def estimates(self) -> dict[str, Estimate]:
        """Theta, sigma and omega with their bounds, heading asked for and the one of the model."""
        m = self.remembered
        theta_1, theta_2, sigma, omega = m["loop"]["estimates"].tolist()
        return {
            "theta_1": Estimate(theta_1, *THETA_1),
            "theta_2": Estimate(theta_2, *THETA_2),
            "sigma_radps2": Estimate(sigma, *SIGMA),
            "omega_1ps2": Estimate(omega, *OMEGA),
            "reference_goal_rad": Estimate(float(m["goal"]), nan, nan),
            "reference_psi_rad": Estimate(float(m["goal"] - m["error"]), nan, nan),
        }
