"""Hold station: stay at a place on a heading while wind and current push."""

from dataclasses import dataclass
from math import pi, radians
from typing import ClassVar

import numpy as np

from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.learn.tasks.base import Judged, Signal, Task, wrapped
from boatsim.physics.base import param
from boatsim.physics.signals import Array

TIME, PLACE, TURN = (
    0,
    1,
    2,
)  # what is remembered: after `settle`, seconds and integrals of squared errors
LOST = 10.0  # off for leaving


@dataclass(frozen=True)
class HoldStation(Task):
    """Stay within `place` of a station, rms, and within `heading` of its heading, once `settle` seconds have gone.

    The reward of a control step is (1 - e) times its share of a second, e = 2 tanh(distance [L]) + |heading error|
    [rad] / 2 + 0.2 (speed / full speed)^2. An episode ends with time, or, with 10 off, when the boat is `reach` away.
    """

    words: ClassVar[str] = "stay at a place on a heading while wind and current push"
    shares: ClassVar[int] = 3
    memory: ClassVar[int] = 3

    place: float = param(
        0.2, low=0.01, high=2.0, unit="L", words="rms distance that counts as holding it"
    )
    heading: float = param(
        radians(10.0), low=0.01, high=1.0, unit="rad", words="rms heading error, the same"
    )
    settle: float = param(20.0, low=0.0, high=1e4, unit="s", words="after which it counts")
    start_within: float = param(
        0.5, low=0.0, high=5.0, unit="L", words="of the station, each way, at the start"
    )
    reach: float = param(
        4.0, low=0.5, high=20.0, unit="L", words="from the station, where it is lost"
    )

    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Where the station lies from the boat, heading off its own, speed."""
        far, near = self.reach * scale.length, 0.5 * scale.length
        return (
            Signal("ahead_m", far, "the station, ahead of the boat"),
            Signal("starboard_m", far, "the station, to starboard of the boat"),
            Signal("ahead_near_m", near, "the same with a bound for the last half length"),
            Signal("starboard_near_m", near, "the same"),
            Signal("sin_heading", 1.0, "of the heading, off the station's"),
            Signal("cos_heading", 1.0, "the same"),
            Signal("u_mps", 0.5 * scale.speed, "surge velocity over ground"),
            Signal("v_mps", 0.5 * scale.speed, "sway velocity over ground"),
            Signal("r_radps", scale.speed / scale.length, "yaw rate"),
        )

    def begin(self, shares: Array, scale: Scale) -> tuple[Array, Array]:
        """Near the station, at rest, within half a radian of its heading."""
        off = 2.0 * shares - 1.0
        place = self.start_within * scale.length * off[:, :2]
        return np.column_stack([place, 0.5 * off[:, 2], np.zeros((len(off), 3))]), np.empty(
            (len(off), 0)
        )

    def look(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Signals, then distance [L], heading error [rad], and the time."""
        c, s = np.cos(m.psi), np.sin(m.psi)
        ahead, starboard = -c * m.x - s * m.y, s * m.x - c * m.y
        distance = np.sqrt(m.x * m.x + m.y * m.y) / scale.length
        seen = (ahead, starboard, ahead, starboard, s, c, m.u, m.v, m.r)
        return (*seen, distance, np.abs(wrapped(m.psi)), t)

    def judge(self, seen: tuple[Array, ...], memory: Array, period: float, scale: Scale) -> Judged:
        """How near, how straight, how quiet."""
        u, v, _, distance, turned, t = seen[-6:]
        counts = period * (t > self.settle)
        memory[:, TIME] += counts
        memory[:, PLACE] += counts * distance * distance
        memory[:, TURN] += counts * turned * turned
        lost = ~(distance < self.reach)
        quiet = (u * u + v * v) / scale.speed**2
        reward = period * (1.0 - 2.0 * np.tanh(distance) - turned / 2.0 - 0.2 * quiet)
        return Judged(np.where(lost, -LOST, reward), lost)

    def norms(
        self, seen: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Root mean squares after settling."""
        _, _, _, distance, _, _ = seen[-6:]
        time = np.maximum(memory[:, TIME], 1e-9)
        place, turn = np.sqrt(memory[:, PLACE] / time), np.sqrt(memory[:, TURN] / time)
        held = (memory[:, TIME] > 0.0) & (distance < self.reach)
        return {
            "is_success": held & (place < self.place) & (turn < self.heading),
            "distance_rms_L": np.where(held, place, self.reach),
            "heading_rms_rad": np.where(held, turn, pi),
            "time_s": t,
        }
