"""Waypoint navigation of Y. Huang and Z. Ji, Autonomous boat dynamics, Appendix B."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, copysign, cos, hypot, nan, pi, sin
from typing import ClassVar

from boatsim.control.base import Controller, Estimate, Sense, wrap
from boatsim.physics.base import param

Place = tuple[float, float]  # [m] x, y in start axes


@dataclass
class Waypoint(Controller):
    """Waypoint navigation: steers to the points given as goals one after another.

    `position_replay` reproduces equation 1 of the paper: positions are integrals of u and v,
    rotated by the present heading.
    """

    words: ClassVar[str] = "waypoints with one azimuth thruster (Huang and Ji)"
    commands: ClassVar[tuple[str, ...]] = ("thrust_N", "azimuth_rad")
    goals: ClassVar[tuple[str, ...]] = ("x_m", "y_m")

    period: float = param(
        0.01, low=0.001, high=10.0, unit="s", words="time between two control steps"
    )
    full: float = param(20.0, low=0.0, high=1e3, unit="N", words="full thrust")
    swing: float = param(
        0.47 * pi,
        low=-pi,
        high=pi,
        unit="rad",
        words="largest azimuth; negative for a thruster astern",
    )
    radius: float = param(
        2.5, low=0.01, high=50.0, unit="m", words="distance at which a point counts as reached"
    )
    near: float = param(
        10.0,
        low=0.1,
        high=200.0,
        unit="m",
        words="distance below which thrust decreases while turning",
    )
    position_replay: bool = False  # the published kinematics; False: the sensed position

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """Clear the list of waypoints and restart dead reckoning."""
        self._ahead: list[Place] = []
        self._given: Place | None = None
        self._travelled = (0.0, 0.0)  # [m] integrals of u and v
        self._before: Sense | None = None
        self._believed = (nan, nan)

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return thrust and azimuth angle that drive the boat towards its next waypoint.

        Args:
            sense: Sensor readings.
            goal: `x_m` and `y_m` of a point.
        """
        self._believed = (
            self._position_as_published(sense) if self.position_replay else (sense.x, sense.y)
        )
        self._append_goal(goal)
        x, y = self._believed
        while (
            len(self._ahead) > 1
            and hypot(self._ahead[0][0] - x, self._ahead[0][1] - y) <= self.radius
        ):
            del self._ahead[0]
        if not self._ahead:
            return {"thrust_N": 0.0, "azimuth_rad": 0.0}
        north, east = self._ahead[0][0] - x, self._ahead[0][1] - y
        return self._commands_towards(hypot(north, east), wrap(atan2(east, north) - sense.psi))

    def estimates(self) -> dict[str, Estimate]:
        """Return the position that the navigation assumes (dead reckoning), for the log."""
        x, y = self._believed
        return {"x_m": Estimate(x, nan, nan), "y_m": Estimate(y, nan, nan)}

    def _commands_towards(self, distance: float, off: float) -> dict[str, float]:
        """Return the commands for a point at this distance [m] and bearing off the bow [rad]."""
        if distance <= self.radius:
            return {"thrust_N": 0.0, "azimuth_rad": 0.0}
        if abs(off) < pi / 2:
            return {"thrust_N": self.full, "azimuth_rad": self.swing * off / (pi / 2)}
        slow = distance / self.near / 3 if distance <= self.near else 0.5
        return {"thrust_N": self.full * slow, "azimuth_rad": self.swing * copysign(1.0, off)}

    def _append_goal(self, goal: Mapping[str, float]) -> None:
        """Append a new goal to the list of points."""
        place = (goal["x_m"], goal.get("y_m", 0.0)) if "x_m" in goal else None
        if place is not None and place != self._given:
            self._ahead.append(place)
        self._given = place

    def _position_as_published(self, sense: Sense) -> Place:
        """Return the position of eq. 1: X = x cos psi - y sin psi, Y = x sin psi + y cos psi."""
        if self._before is not None:
            half = 0.5 * (sense.t - self._before.t)
            x, y = self._travelled
            self._travelled = (
                x + half * (self._before.u + sense.u),
                y + half * (self._before.v + sense.v),
            )
        self._before = sense
        (x, y), c, s = self._travelled, cos(sense.psi), sin(sense.psi)
        return x * c - y * s, x * s + y * c
