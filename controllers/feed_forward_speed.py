"""Speed control by feed-forward of an assumed drag and proportional feedback.

It is the reference against which the L1 cruise control is compared.
"""

from dataclasses import dataclass
from math import exp, nan
from typing import Any, ClassVar

from boatsim.control.base import Estimate
from boatsim.control.compiled import CompiledController, record_type, unlocked
from boatsim.control.jet import JET_Q2, throttle_for_power
from boatsim.physics.base import param


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the throttle for the next period from wanted speed, assumed drag and speed error.

    The reference speed starts at the present speed.

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
        if m.started == 0.0:
            m.model, m.started = s.u, 1.0
        else:
            m.model += (1.0 - exp(-q.gain * q.period)) * (m.goal - m.model)
        m.goal = wanted
        thrust = (q.linear + q.quadratic * abs(wanted)) * wanted + q.gain * (wanted - s.u)
        sent[b].throttle = throttle_for_power(thrust * max(s.u, 0.5), JET_Q2)
        sent[b].jet_rad = goal[b].jet_rad


@dataclass
class FeedForwardSpeed(CompiledController):
    """Speed control by a feed-forward of the assumed drag and proportional feedback.

    Thrust per mass = drag at the wanted speed + gain (wanted speed - speed). Goals: `u_mps`, and
    `jet_rad`, which is passed on.
    """

    words: ClassVar[str] = "speed of a water-jet craft on its throttle: known drag and a fixed gain"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("u_mps", "jet_rad")
    default_goals: ClassVar = {"jet_rad": 0.0}
    tuned: ClassVar[tuple[str, ...]] = ("gain",)
    law: ClassVar = law
    memory_type: ClassVar = record_type("started", "goal", "model")

    period: float = param(
        0.002, low=0.0001, high=1.0, unit="s", words="time between two control steps"
    )
    gain: float = param(
        1.4, low=0.0, high=100.0, unit="1/s", words="thrust per mass and speed error"
    )
    linear: float = param(0.1926, low=0.0, high=10.0, unit="1/s", words="assumed drag, Table 3")
    quadratic: float = param(0.0035, low=0.0, high=10.0, unit="1/m", words="assumed drag, Table 3")

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the set point of the speed and the reference speed, for the log of a run."""
        return {
            "reference_goal_mps": Estimate(memory["goal"], nan, nan),
            "reference_u_mps": Estimate(memory["model"], nan, nan),
        }
