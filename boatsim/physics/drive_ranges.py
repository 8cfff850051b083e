"""Ranges of the drives of a vessel: thrust ahead and astern, and directions that it can have."""

from collections.abc import Sequence
from math import cos, isfinite, pi, sin
from typing import Any, NamedTuple

from boatsim.physics.debugging import python_function
from boatsim.physics.kinds.effect import Boat, Effect

# Directions of a steered drive at which its race is examined are at most this far apart; the race
# of a propeller is some 10 degrees wide to each side, so that none is missed between two of them.
DIRECTION_STEP = pi / 36.0  # [rad]


class DriveRange(NamedTuple):
    """Range of thrust and direction of one drive, and its mount."""

    x: float  # mount ahead of the origin of motion [m]
    y: float  # mount to starboard of it [m]
    ahead: float  # full thrust ahead [N]
    astern: float  # full thrust astern [N], positive
    smallest_angle: float  # of its direction [rad]
    largest_angle: float  # [rad]

    @property
    def full(self) -> float:
        """Full thrust in the stronger direction [N]."""
        return max(self.ahead, self.astern)

    @property
    def sweep(self) -> float:
        """Angle through which the drive can be turned [rad], at most one turn."""
        return min(self.largest_angle - self.smallest_angle, 2.0 * pi)

    def race_directions(self) -> list[tuple[float, float]]:
        """Return unit vectors (forward, to starboard) of the directions that its race can have."""
        number = max(int(self.sweep / DIRECTION_STEP) + 1, 1)
        found = []
        for k in range(number + 1):
            angle = self.smallest_angle + self.sweep * k / number
            if self.ahead > 0.0:
                found.append((-cos(angle), -sin(angle)))
            if self.astern > 0.0:
                found.append((cos(angle), sin(angle)))
        return found


def drive_ranges(effect: Effect, vessel: Boat) -> list[DriveRange]:
    """Return the ranges of the drives on which an effect acts.

    Args:
        effect: Effect with `per_instance_of` "thruster".
        vessel: Vessel on which it acts.

    Returns:
        One range for each thruster or propeller, in the order of the vessel.
    """
    return [_range(drive, vessel) for drive in vessel.host_effects(effect)]


def _range(drive: Effect, vessel: Boat) -> DriveRange:
    """The range of one thruster, or of an effect that can stand for one."""
    kind: Any = type(drive)
    own: Any = drive
    (power,) = (role for role, about in kind.roles.items() if not about.direction)
    thrusts = []
    for command in _limits(drive, power, vessel):
        signals = kind.signals(**{power: command})
        if hasattr(kind, "as_thruster"):
            signals = python_function(kind.as_thruster)(signals, drive.values())
        thrusts.append(float(own.gain * signals.thrust))
    angles = _limits(drive, "angle", vessel)
    return DriveRange(
        own.x, own.y, max(*thrusts, 0.0), max(*(-thrust for thrust in thrusts), 0.0), *angles
    )


def _limits(drive: Effect, role: str, vessel: Boat) -> Sequence[float]:
    """The smallest and largest value of a signal of a drive; 1 in place of an infinite one."""
    bound = vessel.bindings(drive).get(role, type(drive).roles[role].fixed)
    if not isinstance(bound, str):
        value = float(bound or 0.0)
        return value, value
    low, high = vessel.limits()[bound]
    return low if isfinite(low) else -1.0, high if isfinite(high) else 1.0
