"""Satellite receiver: position with a rate, a latency, slow errors and outages."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, nan, sqrt
from typing import ClassVar

import numpy as np

from boatsim.physics.base import Array, param
from boatsim.simulate.graded_sensor import GradedSensor
from boatsim.simulate.outages import Outages
from boatsim.simulate.sample_number import sample_number
from boatsim.simulate.sensing import Instrument
from boatsim.simulate.sensor_motion import position_of
from boatsim.simulate.stepper import Stepper


@dataclass(frozen=True)
class Gnss(GradedSensor):
    """Measures `x` and `y` of `Sense`, the position of its antenna, and gives `fix_age_s`.

    A fix at k / rate is available after the latency, until the next one. Its error in each
    coordinate is white noise plus a Gauss-Markov process of first order. During an outage there is
    no position (nan), and the age of the last fix grows. At the start the fix of t = 0 is there.
    The antenna moves with roll and pitch; the position is not corrected for it.
    """

    words: ClassVar[str] = "satellite receiver with rate, latency, slow errors and outages"
    columns: ClassVar = {"x": "x_m", "y": "y_m", "fix_age_s": "fix_age_s"}

    rate: float = param(5.0, low=0.01, high=100.0, unit="Hz", words="fixes per second")
    latency: float = param(
        0.2, low=0.0, high=30.0, unit="s", words="time from a fix to its availability"
    )
    position_sd: float = param(
        0.4, low=0.0, high=100.0, unit="m", words="white noise of each coordinate"
    )
    drift_sd: float = param(
        1.7, low=0.0, high=100.0, unit="m", words="slow error of each coordinate"
    )
    drift_time: float = param(
        1100.0, low=0.1, high=1e6, unit="s", words="correlation time of the slow error"
    )
    outage_interval: float = param(
        0.0, low=0.0, high=1e6, unit="s", words="mean time between two outages; 0: none"
    )
    outage_length: float = param(
        5.0, low=0.01, high=1e5, unit="s", words="mean length of an outage"
    )
    ahead: float = param(
        0.0, low=-1e3, high=1e3, unit="m", words="antenna ahead of the origin of motion"
    )
    starboard: float = param(0.0, low=-1e3, high=1e3, unit="m", words="antenna to starboard of it")
    above: float = param(0.0, low=-1e3, high=1e3, unit="m", words="antenna above it")

    def start(self, rng: np.random.Generator) -> "Receiver":
        """Return the receiver at the start of a run.

        Args:
            rng: Random generator of its errors.
        """
        return Receiver(self, rng)


class Receiver(Instrument):
    """A satellite receiver in a run: path of its antenna, last fix and slow error."""

    def __init__(self, sensor: Gnss, rng: np.random.Generator) -> None:
        """Begin with a slow error drawn from its distribution.

        Args:
            sensor: The sensor.
            rng: Random generator of its errors.
        """
        self._sensor = sensor
        self._antenna = np.array([sensor.ahead, sensor.starboard, -sensor.above])
        errors, outages = rng.spawn(2)
        self._errors = errors
        self._outages = Outages(sensor.outage_interval, sensor.outage_length, outages)
        self._drift = sensor.drift_sd * errors.standard_normal(2)
        self._fix = -1  # number of the last fix, also of those in outages
        self._last_fix = 0  # number of the last one that gave a position
        self._position = np.full(2, nan)
        self._path: list[tuple[float, Array]] = []  # times and positions of the antenna

    def read(self, engine: Stepper) -> Mapping[str, float]:
        """Return the last available fix and its age.

        Args:
            engine: The engine, whose vessel is measured.
        """
        sensor, state = self._sensor, engine.state
        self._path.append((state.t, position_of(state, self._antenna)[:2]))
        newest = max(sample_number(state.t - sensor.latency, sensor.rate), 0)
        while self._fix < newest:
            self._take_fix()
        x, y = self._position.tolist()
        return {"x": x, "y": y, "fix_age_s": state.t - self._last_fix / sensor.rate}

    def _take_fix(self) -> None:
        """Compute the next fix."""
        sensor = self._sensor
        self._fix += 1
        t = self._fix / sensor.rate
        noise = self._errors.standard_normal((2, 2))
        if self._fix:
            keeps = exp(-1.0 / (sensor.rate * sensor.drift_time))
            self._drift = keeps * self._drift + sensor.drift_sd * sqrt(1.0 - keeps**2) * noise[0]
        out = self._outages.at(t)
        true = self._antenna_at(t)
        self._position = np.full(2, nan)
        if not out:
            self._position = true + self._drift + sensor.position_sd * noise[1]
            self._last_fix = self._fix

    def _antenna_at(self, t: float) -> Array:
        """Position of the antenna at a time, linear between two control steps."""
        while len(self._path) > 1 and self._path[1][0] <= t:
            self._path.pop(0)
        (begin, first), *later = self._path[:2]
        if not later or t <= begin:
            return first
        end, second = later[0]
        return np.asarray(first + (second - first) * (t - begin) / (end - begin))
