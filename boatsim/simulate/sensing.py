"""Sensors of a vessel: inertial unit, and optionally speed log and position fix.

Further sensors are files of `boatsim/simulate/sensors/`.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import nan
from typing import Any, ClassVar

import numpy as np

from boatsim.control.base import Sense
from boatsim.physics.base import Array, CheckedParameters, param
from boatsim.physics.debugging import python_function
from boatsim.physics.kernel.compiling import lean
from boatsim.simulate.stepper import Stepper

NOISES = 7  # standard normal numbers per sample


@lean
def add_sensor_errors(felt: Array, sensors: Array, noise: Array) -> None:
    """Turn the true readings of a vessel's sensors into measurements with bias and noise, in place.

    Args:
        felt: True values (t, psi, r, ax, ay, u, v, x, y, phi, p), which become measurements; nan
            where there is no sensor.
        sensors: Sizes of the errors, as in `Sensors.error_parameters`.
        noise: Standard normal numbers (7,).
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


_add_sensor_errors_in_python = python_function(add_sensor_errors)


@dataclass(frozen=True)
class Sensors(CheckedParameters):
    """Standard sensors of a vessel: an inertial unit, and optionally speed log and position fix.

    The inertial unit is a BNO055; there is a speed log if `speed_sd` is not negative. One sample of
    the unit's sensor fusion (100 Hz) holds for a whole control step, since readings some
    milliseconds apart return the same sample.
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
    ideal: bool = False  # no noise and no bias; all of the motion is measured, roll too

    def sample(
        self,
        t: float,
        pose: tuple[float, float, float],
        velocity: tuple[float, float, float],
        acceleration: tuple[float, float],
        rng: np.random.Generator,
        roll: tuple[float, float] = (nan, nan),
    ) -> Sense:
        """Return one measurement of all standard sensors at a true state of the vessel.

        Args:
            t: Time [s].
            pose: True x, y [m] and psi [rad].
            velocity: True u, v [m/s] and r [rad/s].
            acceleration: True acceleration along body x and y [m/s^2].
            rng: Random generator of the noise.
            roll: True phi [rad] and p [rad/s].
        """
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
        row: Any = list(felt)
        noise = rng.standard_normal(NOISES).tolist()
        # interpreted: for one vessel that is faster than to call the compiled function
        _add_sensor_errors_in_python(row, self._error_list, noise)
        return Sense(*row)

    def add_errors(self, felt: Array, rng: np.random.Generator) -> None:
        """Turn true readings into measurements in place, with the numbers of `sample`.

        Args:
            felt: True readings (N, 11) at several times, in the order of `SENSE_FIELDS`.
            rng: Random generator of the noise.
        """
        if not self.ideal:
            noise = rng.standard_normal((len(felt), NOISES))
            _add_sensor_errors_in_python(felt.T, self._error_list, noise.T)

    @cached_property
    def error_parameters(self) -> Array:
        """Array with the parameters of the sensor errors, as `add_sensor_errors` takes it.

        The first entry is 1 if the sensors are ideal; standard deviations and biases follow.
        """
        values = [float(getattr(self, name)) for name in type(self).params()]
        return np.array([float(self.ideal), *values])

    @cached_property
    def _error_list(self) -> Any:
        return self.error_parameters.tolist()


@dataclass(frozen=True)
class Sensor(CheckedParameters):
    """Base class of sensors that a scenario adds, as by `[[sensor]]` with `use = "inclinometer"`.

    A reading with the name of a field of `Sense` fills that field; others are in `sense.more`. A
    sensor whose readings depend on earlier ones overrides `start` instead of `read`.
    """

    words: ClassVar[str] = ""  # one line for `boatsim list`
    # reading -> its column in the log after `sensed_`, with the unit
    columns: ClassVar[Mapping[str, str]] = {}

    def start(self, rng: np.random.Generator) -> "Instrument":
        """Return the sensor as it is at the start of a run.

        Args:
            rng: Random generator of its errors.
        """
        return MemorylessInstrument(self, rng)

    def read(self, engine: Stepper, rng: np.random.Generator) -> Mapping[str, float]:
        """Return one measurement of this sensor: the values of all readings in `columns`.

        Args:
            engine: The engine, whose vessel is measured.
            rng: Random generator of the noise.
        """
        raise NotImplementedError


class Instrument(ABC):
    """A sensor in a run, with what it remembers; read once in each control period."""

    @abstractmethod
    def read(self, engine: Stepper) -> Mapping[str, float]:
        """Return one measurement: the values of all readings in `columns` of its sensor.

        Args:
            engine: The engine, whose vessel is measured.
        """


class MemorylessInstrument(Instrument):
    """A sensor whose readings depend on the present motion alone."""

    def __init__(self, sensor: Sensor, rng: np.random.Generator) -> None:
        """Put a sensor into a run.

        Args:
            sensor: The sensor.
            rng: Random generator of its noise.
        """
        self._sensor, self._rng = sensor, rng

    def read(self, engine: Stepper) -> Mapping[str, float]:
        """Return one measurement of the present motion.

        Args:
            engine: The engine, whose vessel is measured.
        """
        return self._sensor.read(engine, self._rng)


def add_further_readings(base: Sense, instruments: Sequence[Instrument], engine: Stepper) -> Sense:
    """Add the readings of a scenario's additional sensors to those of the standard sensors.

    Args:
        base: Sample of the standard sensors.
        instruments: The additional sensors.
        engine: The engine, whose vessel is measured.
    """
    if not instruments:
        return base
    usual = {f.name for f in fields(Sense)} - {"more"}
    read: dict[str, float] = {}
    for instrument in instruments:
        read |= instrument.read(engine)
    return replace(base, **{n: x for n, x in read.items() if n in usual}, more=read)
