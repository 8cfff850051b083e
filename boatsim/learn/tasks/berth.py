"""Berth: from a few lengths off alongside a quay, and lie there."""

from dataclasses import dataclass
from math import radians
from typing import ClassVar

import numpy as np

from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.learn.tasks.base import Judged, Signal, Task, wrapped
from boatsim.physics.base import param
from boatsim.physics.signals import Array
from boatsim.simulate.world import Tank

POTENTIAL, HELD = 0, 1  # what is remembered
PAID, LOST = 10.0, 5.0  # for lying at the berth; off by touching the quay or leaving the harbour
HASTE = 0.02  # off for each length that full speed would have gone
TURN = 0.5  # lengths that a radian of heading counts for
CLOSE = 0.2  # a second at the berth, less the further from it


@dataclass(frozen=True)
class Berth(Task):
    """Lie `gap` off a quay to port, on its heading, for `hold` seconds.

    Done, and the episode ends, when the origin of motion has been within `place` of the berth, the heading within
    `heading` and the speed of bow and stern below `speed` for `hold` seconds. Over as well, and failed, when a corner
    of the hull touches the quay or the boat is `reach` away.

    The reward is progress: how much smaller the distance [L] + 0.5 |heading error| [rad] got, and 0.2 a
    second times exp(-e / 2), e the sum of squares of distance, heading error and speed over their tolerances, 0.1 L, 5
    degrees and 0.03 L/s unless told. Off go 0.02 for the time that full speed takes for a length, 5 for touching or
    leaving; 10 come on top when it is done.
    """

    words: ClassVar[str] = "from a few lengths off alongside a quay, and lie there"
    shares: ClassVar[int] = 6
    memory: ClassVar[int] = 2

    place: float = param(
        0.1, low=0.01, high=1.0, unit="L", words="from the berth, where it counts as there"
    )
    heading: float = param(
        radians(5.0), low=0.01, high=0.5, unit="rad", words="off the quay's, the same"
    )
    speed: float = param(0.03, low=0.005, high=0.5, unit="L/s", words="of bow and stern, the same")
    hold: float = param(2.0, low=0.0, high=60.0, unit="s", words="how long it must lie so")
    gap: float = param(
        0.15, low=0.0, high=2.0, unit="L", words="between the quay and the boat's side at the berth"
    )
    near: float = param(
        1.5, low=0.3, high=10.0, unit="L", words="from the berth, the nearest start"
    )
    far: float = param(3.0, low=0.3, high=10.0, unit="L", words="the furthest start")
    reach: float = param(
        6.0, low=1.0, high=20.0, unit="L", words="from the berth, where the harbour ends"
    )

    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Where the berth lies from the boat, far and near, heading off the quay's, speed, room to the quay."""
        far, near = self.reach * scale.length, 0.5 * scale.length
        return (
            Signal("ahead_m", far, "the berth, ahead of the boat"),
            Signal("starboard_m", far, "the berth, to starboard of the boat"),
            Signal("ahead_near_m", near, "the same with a bound for the last half length"),
            Signal("starboard_near_m", near, "the same"),
            Signal("sin_heading", 1.0, "of the heading, off the quay's"),
            Signal("cos_heading", 1.0, "the same"),
            Signal(
                "heading_near_rad", 0.3, "off the quay's, with a bound for the last of the turn"
            ),
            Signal("u_mps", 0.5 * scale.speed, "surge velocity over ground"),
            Signal("v_mps", 0.5 * scale.speed, "sway velocity over ground"),
            Signal("r_radps", scale.speed / scale.length, "yaw rate"),
            Signal(
                "u_near_mps",
                0.1 * scale.speed,
                "surge velocity, with a bound for the last of the way",
            ),
            Signal("v_near_mps", 0.1 * scale.speed, "the same of sway"),
            Signal("r_near_radps", 0.2 * scale.speed / scale.length, "the same of yaw"),
            Signal("quay_m", scale.length, "between the quay and the nearest corner of the hull"),
        )

    def basin(self, scale: Scale) -> Tank:
        """The quay is its wall to port."""
        width = 2.0 * self.reach * scale.length
        quay = 0.5 * scale.beam + self.gap * scale.length
        return Tank(width, width, scale.length, centre=(0.0, 0.5 * width - quay))

    def begin(self, shares: Array, scale: Scale) -> tuple[Array, Array]:
        """Off the quay within 60 degrees of square, on any heading within a right angle, almost at rest."""
        away = scale.length * (self.near + (self.far - self.near) * shares[:, 0])
        bearing = radians(60.0) * (2.0 * shares[:, 1] - 1.0)
        moving = 0.05 * scale.speed * (2.0 * shares[:, 3:6] - 1.0) * (1.0, 1.0, 1.0 / scale.length)
        psi = radians(90.0) * (2.0 * shares[:, 2] - 1.0)
        return np.column_stack(
            [away * np.sin(bearing), away * np.cos(bearing), psi, moving]
        ), np.empty((len(psi), 0))

    def look(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Signals, then distance [L], heading error [rad] and speed of bow and stern [L/s]."""
        c, s, off = np.cos(m.psi), np.sin(m.psi), wrapped(m.psi)
        ahead, starboard = -c * m.x - s * m.y, s * m.x - c * m.y
        quay = m.y + (0.5 * scale.beam + self.gap * scale.length)
        room = quay + hulls.middle * s - hulls.ahead * np.abs(s) - hulls.aside * np.abs(c)
        distance = np.sqrt(m.x * m.x + m.y * m.y) / scale.length
        aside = np.abs(m.v) + 0.5 * scale.length * np.abs(m.r)
        speed = np.sqrt(m.u * m.u + aside * aside) / scale.length
        seen = (ahead, starboard, ahead, starboard, s, c, off, m.u, m.v, m.r, m.u, m.v, m.r, room)
        return (*seen, distance, off, speed)

    def start(self, seen: tuple[Array, ...], scale: Scale) -> Array:
        """How far there is to go, and no time held."""
        *_, distance, off, _ = seen
        return np.column_stack([distance + TURN * np.abs(off), np.zeros(len(off))])

    def judge(self, seen: tuple[Array, ...], memory: Array, period: float, scale: Scale) -> Judged:
        """Progress, haste, and what the end is worth."""
        room, distance, off, speed = seen[-4:]
        turned = np.abs(off)
        left = distance + TURN * turned
        there = (distance < self.place) & (turned < self.heading) & (speed < self.speed)
        memory[:, HELD] = (memory[:, HELD] + period) * there
        off_by = (
            (distance / self.place) ** 2 + (turned / self.heading) ** 2 + (speed / self.speed) ** 2
        )
        done = memory[:, HELD] >= self.hold - 1e-9
        lost = ~((room > 0.0) & (distance < self.reach))
        reward = (
            memory[:, POTENTIAL] - left - HASTE * period * scale.speed / scale.length + PAID * done
        )
        reward += CLOSE * period * np.exp(-0.5 * off_by)
        memory[:, POTENTIAL] = left
        return Judged(np.where(lost, -LOST, reward), done | lost)

    def norms(
        self, seen: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Where and how the boat is at the end."""
        room, distance, off, speed = seen[-4:]
        touched = ~(room > 0.0)
        return {
            "is_success": (memory[:, HELD] >= self.hold - 1e-9) & ~touched,
            "touched": touched,
            "distance_L": distance,
            "heading_error_rad": np.abs(off),
            "speed_L": speed,
            "time_s": t,
        }
