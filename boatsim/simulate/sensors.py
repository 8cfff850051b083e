"""Sensors of the joystick boat as the thesis had them: inertial unit, speed log, camera above the tank."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import atan2, cos, nan, sin
from typing import NamedTuple

import numpy as np

from boatsim.control.base import Sense
from boatsim.physics.base import Checked, param


@dataclass(frozen=True)
class Sensors(Checked):
    """What the controller feels: a BNO055 inertial unit, and a speed log if `speed_sd` is not negative.

    One sample of the unit's fusion (100 Hz) serves a whole control step: the five readings of the thesis' loop lie
    within 5 ms and so see the same one.
    """

    heading_sd: float = param(0.0024, low=0.0, high=0.5, unit="rad", words="magnetometer heading noise (set B)")
    gyro_sd: float = param(0.00175, low=0.0, high=0.5, unit="rad/s", words="gyro noise, 0.1 deg/s")
    gyro_bias: float = param(0.00087, low=-0.5, high=0.5, unit="rad/s", words="gyro bias, 0.05 deg/s")
    acceleration_sd: float = param(0.02, low=0.0, high=5.0, unit="m/s^2", words="accelerometer noise")
    acceleration_bias: float = param(0.01, low=-5.0, high=5.0, unit="m/s^2", words="accelerometer bias")
    speed_sd: float = param(-1.0, low=-1.0, high=1.0, unit="m/s", words="surge speed noise; below 0: no such sensor")
    position_sd: float = param(-1.0, low=-1.0, high=10.0, unit="m", words="position fix noise; below 0: none")
    ideal: bool = False  # all of the motion is known as it is, roll too, whatever the noise stated above

    def feel(
        self, t: float, pose: tuple[float, float, float], velocity: tuple[float, float, float],
        acceleration: tuple[float, float], rng: np.random.Generator, roll: tuple[float, float] = (nan, nan),
    ) -> Sense:  # fmt: skip
        """One sample at a true pose (x, y, psi), body velocity (u, v, r), body acceleration (ax, ay), roll (phi, p)."""
        if self.ideal:
            return Sense(t, pose[2], velocity[2], *acceleration, velocity[0], velocity[1], pose[0], pose[1], *roll)
        n = rng.standard_normal(7).tolist()
        log, fix = self.speed_sd >= 0.0, self.position_sd >= 0.0
        return Sense(
            t=t,
            psi=pose[2] + self.heading_sd * n[0],
            r=velocity[2] + self.gyro_bias + self.gyro_sd * n[1],
            ax=acceleration[0] + self.acceleration_bias + self.acceleration_sd * n[2],
            ay=acceleration[1] + self.acceleration_bias + self.acceleration_sd * n[3],
            u=velocity[0] + self.speed_sd * n[4] if log else nan,
            v=nan,
            x=pose[0] + self.position_sd * n[5] if fix else nan,
            y=pose[1] + self.position_sd * n[6] if fix else nan,
        )


class Frame(NamedTuple):
    """One camera frame: the two marked points, and the pose they give."""

    t: float  # [s]
    led_x: float  # [m]
    led_y: float  # [m]
    button_x: float  # [m]
    button_y: float  # [m]
    x: float  # [m] CG
    y: float  # [m]
    psi: float  # [rad] in [-pi, pi]


@dataclass(frozen=True)
class Camera(Checked):
    """The camera above the tank: every fifth frame of 30 per second, two points marked by hand on each."""

    rate: float = param(6.0, low=0.1, high=240.0, unit="Hz", words="frames evaluated per second")
    mark_sd: float = param(0.002, low=0.0, high=0.1, unit="m", words="marking noise per coordinate and point")
    led_ahead: float = param(0.183, low=-100.0, high=100.0, unit="m", words="light ahead of the CG (appendix F)")
    button_ahead: float = param(-0.117, low=-100.0, high=100.0, unit="m", words="push-button ahead of the CG [A]")

    @property
    def baseline(self) -> float:
        """Distance between the two points [m]."""
        return self.led_ahead - self.button_ahead

    def shoot(self, t: float, pose: tuple[float, float, float], noise: list[float]) -> Frame:
        """One frame of a boat at a true pose; noise holds four standard normal numbers."""
        x, y, psi = pose
        c, s, e = cos(psi), sin(psi), [self.mark_sd * n for n in noise]
        lx, ly = x + self.led_ahead * c + e[0], y + self.led_ahead * s + e[1]
        bx, by = x + self.button_ahead * c + e[2], y + self.button_ahead * s + e[3]
        seen = atan2(ly - by, lx - bx)
        share = -self.button_ahead / self.baseline  # of the way from button to light lies the CG
        return Frame(t, lx, ly, bx, by, bx + share * (lx - bx), by + share * (ly - by), seen)

    def due(self, number: int, t: float) -> bool:
        """Whether frame `number` has been taken by the time t [s]."""
        return number / self.rate <= t + 1e-9

    def film(
        self, t0: float, before: tuple[float, float, float], t1: float, after: tuple[float, float, float], first: int,
        rng: np.random.Generator,
    ) -> Iterator[Frame]:  # fmt: skip
        """Frames number `first` on that fall into (t0, t1], the pose interpolated between its two ends."""
        number = first
        while self.due(number, t1):
            w = 1.0 if t1 == t0 else min(max((number / self.rate - t0) / (t1 - t0), 0.0), 1.0)
            pose = (
                before[0] + w * (after[0] - before[0]),
                before[1] + w * (after[1] - before[1]),
                before[2] + w * (after[2] - before[2]),
            )
            yield self.shoot(number / self.rate, pose, rng.standard_normal(4).tolist())
            number += 1
