"""Echo sounder: distance to the bottom."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import acos, cos, nan
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.simulate.graded_sensor import GradedSensor
from boatsim.simulate.sample_number import sample_number
from boatsim.simulate.sensing import Instrument
from boatsim.simulate.sensor_motion import position_of
from boatsim.simulate.stepper import Stepper


@dataclass(frozen=True)
class EchoSounder(GradedSensor):
    """Gives `range_m`, the distance from its transducer to a flat bottom.

    r = h / cos(max(0, tilt - beam / 2)),  h = water depth - depth of the transducer

    The first echo comes from the nearest point of the bottom in the beam. A ping is taken at the
    first control step at which it is due. Beyond the largest range there is no echo (nan).
    """

    words: ClassVar[str] = "echo sounder above a flat bottom, with beam and tilt"
    columns: ClassVar = {"range_m": "range_m"}

    water_depth: float = param(
        10.0, low=0.01, high=12000.0, unit="m", words="depth of the still water"
    )
    rate: float = param(10.0, low=0.01, high=100.0, unit="Hz", words="pings per second")
    range_sd: float = param(0.02, low=0.0, high=100.0, unit="m", words="white noise")
    scale_sd: float = param(
        0.005, low=0.0, high=0.5, unit="", words="relative error by the speed of sound, in a run"
    )
    beam: float = param(0.52, low=0.0, high=3.1, unit="rad", words="whole angle of the beam")
    largest_range: float = param(
        100.0, low=0.1, high=12000.0, unit="m", words="range beyond which there is no echo"
    )
    ahead: float = param(0.0, low=-1e3, high=1e3, unit="m", words="ahead of the origin of motion")
    starboard: float = param(0.0, low=-1e3, high=1e3, unit="m", words="to starboard of it")
    below: float = param(0.0, low=-1e3, high=1e3, unit="m", words="below the still water")

    def start(self, rng: np.random.Generator) -> "Sounder":
        """Return the echo sounder at the start of a run.

        Args:
            rng: Random generator of its errors.
        """
        return Sounder(self, rng)


class Sounder(Instrument):
    """An echo sounder in a run: scale error and last ping."""

    def __init__(self, sensor: EchoSounder, rng: np.random.Generator) -> None:
        """Draw the scale error.

        Args:
            sensor: The sensor.
            rng: Random generator of its errors.
        """
        self._sensor, self._rng = sensor, rng
        self._place = np.array([sensor.ahead, sensor.starboard, sensor.below])
        self._scale = 1.0 + sensor.scale_sd * float(rng.standard_normal())
        self._ping, self._range = -1, nan

    def read(self, engine: Stepper) -> Mapping[str, float]:
        """Return the distance of the last ping.

        Args:
            engine: The engine, whose vessel is measured.
        """
        sensor, state = self._sensor, engine.state
        ping = sample_number(state.t, sensor.rate)
        if ping > self._ping:
            self._ping = ping
            height = sensor.water_depth - float(position_of(state, self._place)[2])
            tilt = acos(cos(state.phi) * cos(state.theta))
            slant = height / cos(max(0.0, tilt - 0.5 * sensor.beam))
            noise = sensor.range_sd * float(self._rng.standard_normal())
            heard = 0.0 <= slant <= sensor.largest_range
            self._range = self._scale * slant + noise if heard else nan
        return {"range_m": self._range}
