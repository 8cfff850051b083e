"""Docking along a planned path by dynamic positioning."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, hypot, nan, sin
from typing import ClassVar

import numpy as np

from boatsim.control.base import Estimate, clip
from boatsim.control.dynamic_positioning import DynamicPositioning
from boatsim.control.paths import SpeedProfile, speed_profile
from boatsim.control.planned_path import PlannedPath
from boatsim.control.reference_motion import ReferenceMotion
from boatsim.physics.base import UNSET, Array, param

# Lengths of the vessel over which the heading turns from that of the path to that of the berth
ALIGN_LENGTHS = 1.0
# Error of the position over the length of the vessel at which the reference stops and waits. Half
# of it is the error that the thrusters leave in gusts; the reference then moves at half its speed.
WAIT_LENGTHS = 0.5


@dataclass
class Dock(PlannedPath, DynamicPositioning):
    """Docking along a planned path with any set of thrusters that can push sideways.

    The path leads from the pose at the start through the waypoints to the last one, the berth. A
    reference moves along it with a speed profile and waits if the vessel falls behind. It has the
    heading of the path and turns to that of the berth near the end, where dynamic positioning holds
    it.
    """

    words: ClassVar[str] = (
        "docking along a planned path by dynamic positioning, with a heading in the berth"
    )
    goals: ClassVar[tuple[str, ...]] = ("speed_mps",)

    path: str = "spline"
    berth_heading: float = param(
        UNSET,
        low=-7.0,
        high=7.0,
        unit="rad",
        words="heading in the berth; default: that of the end of the path",
    )
    align: float = param(
        UNSET,
        low=1e-3,
        high=1e5,
        unit="m",
        words="distance from the berth at which the heading turns to it; default: one length",
    )

    def start_reference(self, measured: Array) -> None:
        """Plan the path from the first measured pose to the berth.

        Args:
            measured: x, y [m] and heading [rad] (3,).

        Raises:
            BadInput: There is no waypoint, or two successive ones are equal.
        """
        assert self._model is not None
        super().start_reference(measured)
        length = self._model.length
        self._path = self.planned_path(length, measured.tolist())
        acceleration = self._speed * self._bandwidth / 4.0
        turn_rate = 2.0 * self._speed / length
        self._profile: SpeedProfile = speed_profile(
            self._path, self._speed, turn_rate, acceleration, end_speed=0.0
        )
        self._turn_rate, self._acceleration = turn_rate, acceleration
        self._along, self._rate = 0.0, 0.0
        self._heading = ReferenceMotion(4.0 / self._bandwidth)
        self._heading.reset(measured)

    def advance_reference(self, goal: Mapping[str, float]) -> None:
        """Move the reference along the path by one period.

        Args:
            goal: `speed_mps`, the largest speed; without it the setting `speed`.
        """
        assert self._model is not None
        off = self._observer.position - self._reference.position
        behind = hypot(off[0], off[1]) / (WAIT_LENGTHS * self._model.length)
        left = self._path.length - self._along
        most = min(goal.get("speed_mps", self._speed), self._profile.at(self._along))
        # in proportion to the distance near the end, so that the reference arrives without a jerk
        wanted = max(0.0, 1.0 - behind) * min(max(most, 0.0), 0.25 * self._bandwidth * left)
        room = self._acceleration * self.period
        before = self._rate
        self._rate += clip(wanted - self._rate, -2.0 * room, room)
        self._along += 0.5 * self.period * (before + self._rate)
        there = self._path.point(self._along)
        self._turn_heading(there.course)
        tangent = np.array([cos(there.course), sin(there.course)])
        normal = np.array([-tangent[1], tangent[0]])
        change = (self._rate - before) / self.period
        bend = self._rate * self._rate * there.curvature
        turning = self._heading
        reference = self._reference
        reference.position = np.array([there.x, there.y, turning.position[2]])
        reference.velocity = np.array([*(self._rate * tangent), turning.velocity[2]])
        reference.acceleration = np.array(
            [*(change * tangent + bend * normal), turning.acceleration[2]]
        )

    def _turn_heading(self, course: float) -> None:
        """Turn the reference heading towards that of the path, or of the berth near the end."""
        assert self._model is not None
        align = ALIGN_LENGTHS * self._model.length if self.align is UNSET else self.align
        wanted = course
        if self.berth_heading is not UNSET and self._path.length - self._along <= align:
            wanted = self.berth_heading
        self._heading.step(np.array([0.0, 0.0, wanted]), self._speed, self._turn_rate, self.period)

    def estimates(self) -> dict[str, Estimate]:
        """Return those of dynamic positioning, and the course of the path, for the log."""
        found = super().estimates()
        if not found:
            return found
        course, along = 0.0, 0.0
        if self._started:
            course, along = self._path.point(self._along).course, self._along
        found["reference_course_rad"] = Estimate(course, nan, nan)
        found["along_track_m"] = Estimate(along, nan, nan)
        return found
