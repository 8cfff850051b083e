"""Doppler velocity log: velocity over ground with a rate, a scale error and dropouts."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, nan
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.simulate.graded_sensor import GradedSensor
from boatsim.simulate.outages import Outages
from boatsim.simulate.sample_number import sample_number
from boatsim.simulate.sensing import Instrument
from boatsim.simulate.sensor_motion import velocity_of
from boatsim.simulate.stepper import Stepper


@dataclass(frozen=True)
class Dvl(GradedSensor):
    """Measures `u` and `v` of `Sense`, the velocity of its place over ground along body axes.

    A ping is taken at the first control step at which it is due, and held until the next one.
    Without bottom lock, in an outage or beyond the largest tilt,
    there is no velocity (nan).
    """

    words: ClassVar[str] = "Doppler velocity log with rate, scale error and dropouts"
    columns: ClassVar = {"u": "u_mps", "v": "v_mps"}

    rate: float = param(5.0, low=0.01, high=100.0, unit="Hz", words="pings per second")
    speed_sd: float = param(
        0.005, low=0.0, high=10.0, unit="m/s", words="white noise of each component"
    )
    scale_sd: float = param(
        0.01, low=0.0, high=0.5, unit="", words="relative error, constant in a run"
    )
    largest_tilt: float = param(
        0.5, low=0.0, high=1.6, unit="rad", words="tilt beyond which it loses the bottom"
    )
    outage_interval: float = param(
        0.0, low=0.0, high=1e6, unit="s", words="mean time between two outages; 0: none"
    )
    outage_length: float = param(
        5.0, low=0.01, high=1e5, unit="s", words="mean length of an outage"
    )
    ahead: float = param(0.0, low=-1e3, high=1e3, unit="m", words="ahead of the origin of motion")
    starboard: float = param(0.0, low=-1e3, high=1e3, unit="m", words="to starboard of it")
    below: float = param(0.0, low=-1e3, high=1e3, unit="m", words="below it")

    def start(self, rng: np.random.Generator) -> "DopplerLog":
        """Return the velocity log at the start of a run.

        Args:
            rng: Random generator of its errors.
        """
        return DopplerLog(self, rng)


class DopplerLog(Instrument):
    """A Doppler velocity log in a run: scale error and last ping."""

    def __init__(self, sensor: Dvl, rng: np.random.Generator) -> None:
        """Draw the scale error.

        Args:
            sensor: The sensor.
            rng: Random generator of its errors.
        """
        self._sensor = sensor
        self._place = np.array([sensor.ahead, sensor.starboard, sensor.below])
        self._errors, outages = rng.spawn(2)
        self._outages = Outages(sensor.outage_interval, sensor.outage_length, outages)
        self._scale = 1.0 + sensor.scale_sd * float(self._errors.standard_normal())
        self._ping = -1
        self._velocity = (nan, nan)

    def read(self, engine: Stepper) -> Mapping[str, float]:
        """Return the velocity of the last ping.

        Args:
            engine: The engine, whose vessel is measured.
        """
        sensor, state = self._sensor, engine.state
        ping = sample_number(state.t, sensor.rate)
        if ping > self._ping:
            self._ping = ping
            noise = self._errors.standard_normal(2)
            along = velocity_of(state, self._place)[:2]
            u, v = (self._scale * along + sensor.speed_sd * noise).tolist()
            upright = cos(state.phi) * cos(state.theta)  # cosine of the tilt
            lost = self._outages.at(state.t) or upright < cos(sensor.largest_tilt)
            self._velocity = (nan, nan) if lost else (u, v)
        return dict(zip(("u", "v"), self._velocity, strict=True))
