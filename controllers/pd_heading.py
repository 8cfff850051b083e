"""PD heading control of a water-jet craft, designed on a first-order yaw response.

It is the reference against which the L1 heading control is compared.
"""

from dataclasses import dataclass
from math import nan, radians
from typing import Any, ClassVar

from boatsim.control.allocation import limit
from boatsim.control.base import Estimate, wrap
from boatsim.control.compiled import CompiledController, lean, merged, record_type, unlocked
from boatsim.physics.base import param

wrapped = lean(wrap)


@merged
def advance_reference_model(q: Any, m: Any, s: Any, wanted: float) -> None:
    """Advance the reference model of a heading controller by one period, by the midpoint rule.

    The model starts at the present state.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        s: Sensor readings.
        wanted: Reference heading [rad].
    """
    if m.started == 0.0:
        m.error, m.rate, m.started = wrapped(wanted - s.psi), s.r, 1.0
    else:
        change, dt = wrapped(wanted - m.goal), q.period
        half = m.error + 0.5 * (change - dt * m.rate)
        middle = m.rate + 0.5 * dt * (q.stiffness * m.error - q.damping * m.rate)
        m.error += change - dt * middle
        m.rate += dt * (q.stiffness * half - q.damping * middle)
    m.goal = wanted


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the jet angle of a water-jet craft for the next period, by PD heading control.

    Args:
        boats: Row numbers of the boats to process.
        settings: Parameters of each controller.
        memory: State of each controller.
        sense: Sensor readings of each boat.
        goal: Set points of each boat.
        sent: Commands of each boat, filled in.
    """
    for b in boats:
        q, s, g = settings[b], sense[b], goal[b]
        advance_reference_model(q, memory[b], s, g.psi_rad)
        # [rad/s^2]
        turn = q.stiffness * wrapped(g.psi_rad - s.psi) - (q.damping - 1.0 / q.time_constant) * s.r
        sent[b].jet_rad = limit(turn * q.time_constant / q.gain, -q.largest, q.largest)
        sent[b].throttle = g.throttle


@dataclass
class PdHeading(CompiledController):
    """PD control for the yaw model r' = (K delta - r) / T with assumed K and T.

    psi'' = stiffness e - damping psi'  in closed loop

    Goals: `psi_rad`, and `throttle`, which is passed on.
    """

    words: ClassVar[str] = "PD heading of a water-jet craft on its jet, with fixed gains"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("psi_rad", "throttle")
    default_goals: ClassVar = {"throttle": 1.0}
    tuned: ClassVar[tuple[str, ...]] = ("stiffness", "damping")
    law: ClassVar = law
    memory_type: ClassVar = record_type("started", "goal", "error", "rate")

    period: float = param(
        0.002, low=0.0001, high=1.0, unit="s", words="time between two control steps"
    )
    gain: float = param(
        2.95, low=0.01, high=100.0, unit="1/s", words="assumed K, of the 15 deg step (Table 4)"
    )
    time_constant: float = param(0.97, low=0.01, high=1e3, unit="s", words="assumed T")
    stiffness: float = param(
        1.0, low=0.0, high=100.0, unit="1/s^2", words="of the motion asked for"
    )
    damping: float = param(1.4, low=0.0, high=100.0, unit="1/s", words="of the motion asked for")
    largest: float = param(
        radians(15.0), low=0.0, high=1.5, unit="rad", words="largest jet deflection to either side"
    )

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the set point of the heading and the reference heading, for the log of a run."""
        goal, error = memory["goal"], memory["error"]
        return {
            "reference_goal_rad": Estimate(goal, nan, nan),
            "reference_psi_rad": Estimate(goal - error, nan, nan),
        }
