"""Zig-zag: the helm is reversed each time the heading has changed by a given angle."""

from dataclasses import dataclass, field
from math import copysign, inf
from typing import ClassVar

from boatsim.base import param
from boatsim.control import Sense, Steered


@dataclass
class Zigzag(Steered):
    """Kempf's manoeuvre; a positive angle begins to starboard."""

    words: ClassVar[str] = "standard manoeuvre: reverses the helm each time the heading has reached an angle"

    heading: float = param(0.175, low=0.001, high=3.0, unit="rad", words="heading change at which the helm is reversed")
    reversals: int = 5  # after which it is over
    _side: float = field(default=0.0, init=False)
    _reversed: int = field(default=0, init=False)
    _begun: float = field(default=inf, init=False)  # [rad] heading at the begin

    def reset(self) -> None:
        """Back on course."""
        super().reset()
        self._side, self._reversed, self._begun = copysign(1.0, self.angle), 0, inf

    def helm(self, sense: Sense) -> float:
        """The angle, on the side that turns the ship back."""
        if self._begun == inf:
            self._begun = sense.psi
        if self._side * (sense.psi - self._begun) >= self.heading:
            self._side, self._reversed = -self._side, self._reversed + 1
        return self._side * abs(self.angle)

    @property
    def done(self) -> bool:
        """Reversed often enough."""
        return self._reversed >= self.reversals
