"""Pressure gauge: depth below the water surface."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.physics.vessel.wave_field import wave_field
from boatsim.simulate.graded_sensor import GradedSensor
from boatsim.simulate.sensing import Instrument
from boatsim.simulate.sensor_motion import position_of
from boatsim.simulate.stepper import Stepper


@dataclass(frozen=True)
class PressureGauge(GradedSensor):
    """Gives `depth_m`, the pressure at its place as the depth of still water.

    Waves raise the pressure as if they were long against the depth: the depth is that below the
    wave that passes, without the decay of short waves.
    """

    words: ClassVar[str] = "pressure gauge: depth below the moving surface"
    columns: ClassVar = {"depth_m": "depth_m"}

    depth_sd: float = param(0.002, low=0.0, high=100.0, unit="m", words="white noise")
    bias_sd: float = param(0.25, low=0.0, high=100.0, unit="m", words="error, constant in a run")
    ahead: float = param(0.0, low=-1e3, high=1e3, unit="m", words="ahead of the origin of motion")
    starboard: float = param(0.0, low=-1e3, high=1e3, unit="m", words="to starboard of it")
    below: float = param(0.0, low=-1e3, high=1e3, unit="m", words="below the still water")

    def start(self, rng: np.random.Generator) -> "Gauge":
        """Return the pressure gauge at the start of a run.

        Args:
            rng: Random generator of its errors.
        """
        return Gauge(self, rng)


class Gauge(Instrument):
    """A pressure gauge in a run, with its bias."""

    def __init__(self, sensor: PressureGauge, rng: np.random.Generator) -> None:
        """Draw the bias.

        Args:
            sensor: The sensor.
            rng: Random generator of its errors.
        """
        self._sensor, self._rng = sensor, rng
        self._place = np.array([sensor.ahead, sensor.starboard, sensor.below])
        self._bias = sensor.bias_sd * float(rng.standard_normal())

    def read(self, engine: Stepper) -> Mapping[str, float]:
        """Return the depth of the gauge.

        Args:
            engine: The engine, whose vessel is measured.
        """
        x, y, z = position_of(engine.state, self._place).tolist()
        waves = wave_field(engine.vessel.effects)
        if len(waves):
            z += float(waves.elevation(x, y, engine.state.t))
        noise = self._sensor.depth_sd * float(self._rng.standard_normal())
        return {"depth_m": z + self._bias + noise}
