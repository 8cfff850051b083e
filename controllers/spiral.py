"""Spiral manoeuvre: the helm moves in steps from side to side and back, each step held."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.base import HelmManoeuvre, Sense
from boatsim.physics.base import param


@dataclass
class Spiral(HelmManoeuvre):
    """Dieudonne's spiral manoeuvre: the helm moves in steps from side to side and back.

    It shows whether a ship has two rates of turn at one helm angle.
    """

    words: ClassVar[str] = (
        "standard manoeuvre: helm in steps from side to side and back (Dieudonne)"
    )

    hold: float = param(
        60.0, low=0.1, high=1e5, unit="s", words="time for which each angle is held"
    )
    steps: int = param(4, low=1, high=50, unit="", words="from midships to the largest angle")

    def helm_angle(self, sense: Sense) -> float:
        """Return the helm angle of the present step of a spiral manoeuvre [rad].

        Args:
            sense: Sensor readings.
        """
        n = min(int((sense.t - self.execute) / self.hold + 1e-6), 4 * self.steps)
        down = self.steps - n  # in steps of angle: +steps .. -steps, then up again
        return self.angle * (down if down >= -self.steps else -2 * self.steps - down) / self.steps
