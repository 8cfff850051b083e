"""The plain rival of the L1 cruise control: throttle for the drag that is assumed, and a little for the speed error."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, isnan, nan
from typing import ClassVar

from boatsim.control.allocation import JetThrottle
from boatsim.control.base import Controller, Estimate, Sense
from boatsim.physics.base import param

JET = JetThrottle()


@dataclass
class FeedForwardSpeed(Controller):
    """Thrust per mass = drag of the speed wanted + gain (speed wanted - speed). Goals: `u_mps`, and `jet_rad`."""

    words: ClassVar[str] = "speed of a water-jet craft on its throttle: known drag and a fixed gain"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("u_mps", "jet_rad")

    period: float = param(0.002, low=0.0001, high=1.0, unit="s", words="time between two control steps")
    gain: float = param(1.4, low=0.0, high=100.0, unit="1/s", words="thrust per mass and speed error")
    linear: float = param(0.1926, low=0.0, high=10.0, unit="1/s", words="drag assumed, Table 3")
    quadratic: float = param(0.0035, low=0.0, high=10.0, unit="1/m", words="drag assumed, Table 3")

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """The speed asked for starts where the craft is."""
        self._model = self._goal = nan

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Throttle for the next period."""
        wanted = goal["u_mps"]
        follow = 1.0 - exp(-self.gain * self.period)
        self._model = sense.u if isnan(self._model) else self._model + follow * (self._goal - self._model)
        self._goal = wanted
        thrust = (self.linear + self.quadratic * abs(wanted)) * wanted + self.gain * (wanted - sense.u)
        return {"throttle": JET.throttle(thrust * max(sense.u, 0.5)), "jet_rad": goal.get("jet_rad", 0.0)}

    def estimates(self) -> dict[str, Estimate]:
        """The speed asked for."""
        return {
            "reference_goal_mps": Estimate(self._goal, nan, nan),
            "reference_u_mps": Estimate(self._model, nan, nan),
        }
