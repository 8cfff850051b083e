"""What a boat carries to feel its own motion: inertial unit, and where it has them speed log and position fix.

Any further sensor is a file of `boatsim/simulate/sensors/`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import nan
from typing import ClassVar

import numpy as np

from boatsim.control.base import Sense
from boatsim.physics.base import Array, Checked, param
from boatsim.physics.kernel.compiling import lean
from boatsim.simulate.stepper import Stepper

NOISES = 7  # normal numbers that a sample takes


@lean
def disturb(felt: Array, sensors: Array, noise: Array) -> None:
    """Make what is true (t, psi, r, ax, ay, u, v, x, y, phi, p) what the unit says, in place.

    `sensors` are the numbers of `Sensors`, whether they are ideal first; noise (7,) is standard normal.
    """
    if sensors[0] != 0.0:
        return
    heading_sd, gyro_sd, gyro_bias = sensors[1], sensors[2], sensors[3]
    acceleration_sd, acceleration_bias, speed_sd, position_sd = (
        sensors[4],
        sensors[5],
        sensors[6],
        sensors[7],
    )
    felt[1] += heading_sd * noise[0]
    felt[2] = felt[2] + gyro_bias + gyro_sd * noise[1]
    felt[3] = felt[3] + acceleration_bias + acceleration_sd * noise[2]
    felt[4] = felt[4] + acceleration_bias + acceleration_sd * noise[3]
    felt[5] = felt[5] + speed_sd * noise[4] if speed_sd >= 0.0 else nan
    felt[6] = nan
    felt[7] = felt[7] + position_sd * noise[5] if position_sd >= 0.0 else nan
    felt[8] = felt[8] + position_sd * noise[6] if position_sd >= 0.0 else nan
    felt[9] = felt[10] = nan


@dataclass(frozen=True)
class Sensors(Checked):
    """What the controller feels: a BNO055 inertial unit, and a speed log if `speed_sd` is not negative.

    One sample of the unit's fusion (100 Hz) serves a whole control step: readings some ms apart see the same one.
    """

    heading_sd: float = param(
        0.0024, low=0.0, high=0.5, unit="rad", words="magnetometer heading noise"
    )
    gyro_sd: float = param(0.00175, low=0.0, high=0.5, unit="rad/s", words="gyro noise, 0.1 deg/s")
    gyro_bias: float = param(
        0.00087, low=-0.5, high=0.5, unit="rad/s", words="gyro bias, 0.05 deg/s"
    )
    acceleration_sd: float = param(
        0.02, low=0.0, high=5.0, unit="m/s^2", words="accelerometer noise"
    )
    acceleration_bias: float = param(
        0.01, low=-5.0, high=5.0, unit="m/s^2", words="accelerometer bias"
    )
    speed_sd: float = param(
        -1.0, low=-1.0, high=1.0, unit="m/s", words="surge speed noise; below 0: no such sensor"
    )
    position_sd: float = param(
        -1.0, low=-1.0, high=10.0, unit="m", words="position fix noise; below 0: none"
    )
    # all of the motion is known as it is, roll too, whatever the noise stated above
    ideal: bool = False

    def sample(
        self,
        t: float,
        pose: tuple[float, float, float],
        velocity: tuple[float, float, float],
        acceleration: tuple[float, float],
        rng: np.random.Generator,
        roll: tuple[float, float] = (nan, nan),
    ) -> Sense:
        """One sample at a true pose (x, y, psi), body velocity (u, v, r), body acceleration (ax, ay), roll (phi, p)."""
        felt = (
            t,
            pose[2],
            velocity[2],
            *acceleration,
            velocity[0],
            velocity[1],
            pose[0],
            pose[1],
            *roll,
        )
        if self.ideal:
            return Sense(*felt)
        row = np.array(felt)
        disturb(row, self.numbers, rng.standard_normal(NOISES))
        return Sense(*row.tolist())

    @cached_property
    def numbers(self) -> Array:
        """What `disturb` takes of it."""
        return np.array(
            [float(self.ideal), *(float(getattr(self, name)) for name in type(self).params())]
        )


@dataclass(frozen=True)
class Sensor(Checked):
    """Base of further sensors: `[[sensor]]` with `use = "inclinometer"` in a scenario puts one aboard.

    What it reads under the name of a field of `Sense` fills that field; any other name is found in `sense.more`.
    """

    words: ClassVar[str] = ""  # one line for `boatsim list`
    columns: ClassVar[
        Mapping[str, str]
    ] = {}  # what it reads -> its column in the log, with the unit, after `sensed_`

    def read(self, engine: Stepper, rng: np.random.Generator) -> Mapping[str, float]:
        """One sample of everything in `columns` from the boat as it is."""
        raise NotImplementedError


def sensed(
    base: Sense, aboard: Sequence[Sensor], engine: Stepper, rngs: Sequence[np.random.Generator]
) -> Sense:
    """What the usual sensors say, with what the further ones read; each has randomness of its own."""
    if not aboard:
        return base
    usual = {f.name for f in fields(Sense)} - {"more"}
    read: dict[str, float] = {}
    for sensor, rng in zip(aboard, rngs, strict=True):
        read |= sensor.read(engine, rng)
    return replace(base, **{n: x for n, x in read.items() if n in usual}, more=read)
