"""Elevator servo: the machine that lowers the bucket of a water jet."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.effects.servo import Servo


@dataclass(frozen=True)
class ElevatorServo(Servo):
    """The bucket follows its command inside a range and a rate limit."""

    words: ClassVar[str] = "the bucket follows with a limited rate and range"
    shown_by: ClassVar[str] = "switching between ahead and astern"
    source: ClassVar[str] = "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013: 0 to 55 deg; the rate is assumed"
    acts_on: ClassVar[str] = "elevator"
