"""Pull-out manoeuvre: a steady turn, then the helm midships, to both sides."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.control.base import HelmManoeuvre, Sense
from boatsim.physics.base import param


@dataclass
class PullOut(HelmManoeuvre):
    """Pull-out manoeuvre: helm to one side, midships, to the other side, midships.

    Each part is held for the same time.
    """

    words: ClassVar[str] = (
        "standard manoeuvre: steady turns to both sides, each followed by helm midships"
    )

    hold: float = param(
        60.0, low=0.1, high=1e5, unit="s", words="time for which each angle is held"
    )

    def helm_angle(self, sense: Sense) -> float:
        """Return the helm angle of the present part of a pull-out manoeuvre [rad].

        Args:
            sense: Sensor readings.
        """
        return (
            self.angle
            * (1.0, 0.0, -1.0, 0.0)[min(int((sense.t - self.execute) / self.hold + 1e-6), 3)]
        )
