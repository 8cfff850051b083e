"""Outer loop of a joystick: demands that move a boat to a position and heading."""

from dataclasses import dataclass, field
from math import atan2, cos, hypot, sin

from boatsim.control.allocation import Stick
from boatsim.control.base import clip, wrap
from boatsim.physics.base import CheckedParameters, param


@dataclass
class Approach(CheckedParameters):
    """Outer control loop that berths a boat: first to a point abeam of the berth, then sideways.

    The loop has integral action. Poses are relative to the berth: x along its heading, y to
    starboard. The gains suit a boat of 1.2 m. The sway demand sets a thrust, so that the sway loop
    is damped by the hull.
    """

    beside: float = param(
        0.8, low=-100.0, high=100.0, unit="m", words="first waypoint, to starboard of the berth"
    )
    within: float = param(
        0.5,
        low=0.0,
        high=100.0,
        unit="m",
        words="distance from that waypoint at which the sideways approach begins",
    )
    cruise: float = param(
        0.2, low=0.01, high=5.0, unit="m/s", words="speed on the way to the waypoint"
    )
    surge_gain: float = param(
        0.2, low=0.0, high=5.0, unit="1/s", words="surge speed per distance ahead"
    )
    creep: float = param(
        0.06, low=0.0, high=5.0, unit="m/s", words="fastest surge speed of the approach"
    )
    sway_gain: float = param(
        0.08, low=0.0, high=5.0, unit="1/s", words="sway stick per distance to starboard"
    )
    sway_damping: float = param(0.9, low=0.0, high=50.0, unit="", words="sway stick per sway speed")
    sway_integral: float = param(
        0.004, low=0.0, high=1.0, unit="1/s^2", words="sway stick per integrated distance"
    )
    sway_most: float = param(0.1, low=0.0, high=5.0, unit="m/s", words="largest sway stick")
    turn_gain: float = param(0.4, low=0.0, high=5.0, unit="1/s", words="yaw rate per heading error")
    turn_most: float = param(
        0.14, low=0.0, high=5.0, unit="rad/s", words="largest yaw rate demanded"
    )
    straight: float = param(
        0.2,
        low=0.01,
        high=3.2,
        unit="rad",
        words="heading error below which the boat leaves the waypoint",
    )
    _straight: bool = field(default=False, init=False)
    _there: bool = field(default=False, init=False)
    _lasting: float = field(default=0.0, init=False)  # [m/s] of the sway stick

    def step(self, pose: tuple[float, float, float], v: float, dt: float) -> Stick:
        """Return the joystick demands of the next control period that move a boat to its berth.

        Args:
            pose: x, y [m] and psi [rad] relative to the berth.
            v: Sway velocity [m/s].
            dt: Length of the period [s].
        """
        x, y, psi = pose
        north, east = -x, self.beside - y
        self._there = self._there or hypot(north, east) < self.within
        if self._there:
            self._straight = self._straight or abs(wrap(psi)) < self.straight
            return self._approach_sideways(
                *_rotate_to_body_axes(-x, -y if self._straight else east, psi), wrap(-psi), v, dt
            )
        off = wrap(atan2(east, north) - psi)
        ahead = clip(1.0 - 2.0 * abs(off), 0.0, 1.0) * min(
            self.cruise, self.surge_gain * hypot(north, east)
        )
        return Stick(ahead, 0.0, self._yaw_demand(off))

    def _approach_sideways(
        self, ahead: float, starboard: float, off: float, v: float, dt: float
    ) -> Stick:
        """Return the demands of the sideways approach."""
        sway = self.sway_gain * starboard + self._lasting - self.sway_damping * v
        if abs(sway) < self.sway_most and abs(starboard) < self.within:
            self._lasting += self.sway_integral * starboard * dt
        surge = clip(self.surge_gain * ahead, -self.creep, self.creep)
        return Stick(surge, clip(sway, -self.sway_most, self.sway_most), self._yaw_demand(off))

    def _yaw_demand(self, off: float) -> float:
        return clip(self.turn_gain * off, -self.turn_most, self.turn_most)


def _rotate_to_body_axes(north: float, east: float, psi: float) -> tuple[float, float]:
    """Return a displacement in body axes."""
    c, s = cos(psi), sin(psi)
    return c * north + s * east, c * east - s * north
