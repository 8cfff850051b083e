"""Zig-zag: the helm is reversed each time the heading has changed by a given angle."""

from dataclasses import dataclass, field
from math import copysign, inf
from typing import ClassVar

from boatsim.control.base import HelmManoeuvre, Sense
from boatsim.physics.base import param

REACHED = 1e-7  # [rad] tolerance with which a heading counts as reached


@dataclass
class Zigzag(HelmManoeuvre):
    """Kempf's zig-zag manoeuvre about the heading at the start.

    A positive angle begins to starboard.
    """

    words: ClassVar[str] = (
        "standard manoeuvre: reverses the helm each time the heading has reached an angle"
    )

    heading: float = param(
        0.175, low=0.001, high=3.0, unit="rad", words="heading change at which the helm is reversed"
    )
    reversals: int = param(
        5, low=1, high=1000, unit="", words="number of reversals, after which the run may end"
    )
    _side: float = field(default=0.0, init=False)
    _reversed: int = field(default=0, init=False)

    def reset(self) -> None:
        """Reset the zig-zag manoeuvre to its first execute."""
        super().reset()
        self._side, self._reversed = copysign(1.0, self.angle), 0

    def helm_angle(self, sense: Sense) -> float:
        """Return the helm angle of a zig-zag [rad], reversed when the execute heading is reached.

        Args:
            sense: Sensor readings.
        """
        if self._angle_to_reversal(sense) <= REACHED:
            self._side, self._reversed = -self._side, self._reversed + 1
        return self._side * abs(self.angle)

    def time_to_extra_step(self, sense: Sense) -> float:
        """Return the predicted time [s] until a zig-zag reaches the heading of its next reversal.

        Repeated calls refine it.

        Args:
            sense: Sensor readings.
        """
        left, rate = self._angle_to_reversal(sense), self._side * sense.r
        return left / rate if self._helm and rate > 0.0 and left > REACHED else inf

    def _angle_to_reversal(self, sense: Sense) -> float:
        """Return the angle [rad] to turn before the helm is reversed."""
        return self.heading - self._side * (sense.psi - self._course)

    @property
    def done(self) -> bool:
        """Whether all reversals of the zig-zag manoeuvre are complete."""
        return self._reversed >= self.reversals
