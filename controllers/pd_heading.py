"""The plain rival of the L1 heading control: PD on heading and yaw rate, laid out on a first-order yaw response."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import nan, radians
from typing import ClassVar

from boatsim.control.base import Controller, Estimate, Sense, clip, wrap
from boatsim.physics.base import param


@dataclass
class PdHeading(Controller):
    """With the assumed gain K and time constant T, (K delta - r) / T, the loop is psi'' = stiffness e - damping psi'.

    Goals: `psi_rad`, and `throttle`, which is passed on.
    """

    words: ClassVar[str] = "PD heading of a water-jet craft on its jet, with fixed gains"
    commands: ClassVar[tuple[str, ...]] = ("throttle", "jet_rad")
    goals: ClassVar[tuple[str, ...]] = ("psi_rad", "throttle")

    period: float = param(0.002, low=0.0001, high=1.0, unit="s", words="time between two control steps")
    gain: float = param(2.95, low=0.01, high=100.0, unit="1/s", words="assumed K, of the 15 deg step (Table 4)")
    time_constant: float = param(0.97, low=0.01, high=1e3, unit="s", words="assumed T")
    stiffness: float = param(1.0, low=0.0, high=100.0, unit="1/s^2", words="of the motion asked for")
    damping: float = param(1.4, low=0.0, high=100.0, unit="1/s", words="of the motion asked for")
    largest: float = param(radians(15.0), low=0.0, high=1.5, unit="rad", words="jet deflection either way")

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """The motion asked for starts where the craft is."""
        self._goal = self._error = self._rate = nan

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Jet deflection for the next period."""
        self._follow(goal["psi_rad"], sense)
        error = wrap(goal["psi_rad"] - sense.psi)
        turn = self.stiffness * error - (self.damping - 1.0 / self.time_constant) * sense.r  # [rad/s^2]
        jet = clip(turn * self.time_constant / self.gain, -self.largest, self.largest)
        return {"throttle": goal.get("throttle", 1.0), "jet_rad": jet}

    def estimates(self) -> dict[str, Estimate]:
        """Heading wanted, and the one of the motion asked for."""
        return {
            "reference_goal_rad": Estimate(self._goal, nan, nan),
            "reference_psi_rad": Estimate(self._goal - self._error, nan, nan),
        }

    def _follow(self, wanted: float, sense: Sense) -> None:
        """One period of the motion asked for, by the midpoint rule."""
        if self._goal != self._goal:  # first step
            self._error, self._rate = wrap(wanted - sense.psi), sense.r
        else:
            change, dt = wrap(wanted - self._goal), self.period
            half = self._error + 0.5 * (change - dt * self._rate)
            middle = self._rate + 0.5 * dt * (self.stiffness * self._error - self.damping * self._rate)
            self._error += change - dt * middle
            self._rate += dt * (self.stiffness * half - self.damping * middle)
        self._goal = wanted
