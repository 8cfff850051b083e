"""Drive map: what an actuator gives for the raw command that its motor controller is sent."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, param


@njit(inline="always")
def channel(x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> Course:
    """Command plus full ((|source - neutral| - dead) / (rated - dead))^exponent, to the side of neutral it is on."""
    off = source - q.neutral
    drive = (abs(off) - q.dead) / (q.rated - q.dead)
    if drive <= 0.0:
        return x
    given = q.full * drive**q.exponent if off > 0.0 else -q.full * drive**q.exponent
    return Course(x.begin + given, x.middle + given, x.end + given)


@dataclass(frozen=True)
class DriveMap(Channel):
    """Thrust or rate of a drive fed by a duty, a servo pulse or revolutions; its own command adds to it."""

    words: ClassVar[str] = "the drive follows its raw command by a curve"
    shown_by: ClassVar[str] = "a staircase of raw commands"
    acts_on: ClassVar[str] = "thrust"
    channel: ClassVar = channel

    full: float = param(1.0, low=-1e6, high=1e6, unit="", words="what it gives, in its own unit, at the rated command")
    rated: float = param(1.0, low=1e-6, high=1e6, unit="", words="raw command, from neutral, at which it gives that")
    neutral: float = param(0.0, low=-1e6, high=1e6, unit="", words="raw command at which it stands still")
    dead: float = param(0.0, low=0.0, high=1e6, unit="", words="from neutral, below which nothing turns")
    exponent: float = param(1.0, low=0.5, high=3.0, unit="", words="of the curve")
