"""Settings of a planned path, which controllers that follow one have in common."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan

import numpy as np

from boatsim.control.paths import Legs, Path, Spline, courses_at, dubins_path
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import UNSET, CheckedParameters, param

SHAPES = ("legs", "spline", "dubins")
# lengths of the vessel: the guideline of Fossen 2021, section 12.4.2, for circles of acceptance
ACCEPTANCE_LENGTHS = 2.0
# Lengths of the vessel: half the tactical diameter of at most 5 lengths that IMO resolution
# MSC.137(76) demands of ships.
TURN_LENGTHS = 2.5


@dataclass
class PlannedPath(CheckedParameters):
    """Settings of a planned path: waypoints and the way in which they are connected.

    `path = "legs"` are straight legs with circles of acceptance, "spline" a cubic spline through
    all waypoints, and "dubins" the shortest path with turns of `turn_radius`.
    """

    # x, y [m] in start axes and, for spline and dubins, a course [rad]
    waypoints: Sequence[Sequence[float]] = ()
    path: str = "legs"  # one of SHAPES
    acceptance: float = param(
        UNSET,
        low=1e-3,
        high=1e5,
        unit="m",
        words="radius of the circles of acceptance of legs; default: two lengths",
    )
    turn_radius: float = param(
        UNSET,
        low=1e-3,
        high=1e5,
        unit="m",
        words="radius of turns of a Dubins path; default: two and a half lengths",
    )

    def __post_init__(self) -> None:
        """Check the settings.

        Raises:
            BadInput: There is no such shape, a waypoint is no pair or triple of numbers, or a
                parameter is out of bounds.
        """
        super().__post_init__()
        name = type(self).__name__
        if self.path not in SHAPES:
            raise BadInput(unknown_name_message(f"{name}: path", self.path, SHAPES))
        for i, point in enumerate(self.waypoints):
            if len(point) not in (2, 3):
                raise BadInput(
                    f"{name}: waypoint {i + 1} has {len(point)} numbers; allowed are x, y and "
                    "optionally a course"
                )

    def radius_of_turns(self, length: float) -> float:
        """Return the radius of turns [m].

        Args:
            length: Length of the vessel [m].
        """
        return TURN_LENGTHS * length if self.turn_radius is UNSET else self.turn_radius

    def planned_path(self, length: float, start: Sequence[float] = ()) -> Path:
        """Return the planned path.

        Args:
            length: Length of the vessel [m].
            start: x, y [m] and course [rad] of a pose before the first waypoint.

        Raises:
            BadInput: There are less than two waypoints, or two successive ones are equal.
        """
        points = [list(start), *self.waypoints] if start else list(self.waypoints)
        places, given = [], []
        for point in points:
            places.append(tuple(point[:2]))
            given.append(float(point[2]) if len(point) > 2 else nan)
        if len(places) < 2:
            raise BadInput(
                f"{type(self).__name__}: {len(self.waypoints)} waypoints; a path needs at least "
                f"{1 if start else 2}"
            )
        waypoints = np.array(places, float)
        if self.path == "legs":
            acceptance = self.acceptance
            if acceptance is UNSET:
                acceptance = ACCEPTANCE_LENGTHS * length
            return Legs(waypoints, acceptance)
        if self.path == "spline":
            return Spline(waypoints, (given[0], given[-1]))
        poses = []
        for (x, y), course in zip(places, courses_at(waypoints, given), strict=True):
            poses.append((float(x), float(y), course))
        return dubins_path(poses, self.radius_of_turns(length))
