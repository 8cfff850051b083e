"""Anemometer: speed and direction of the wind relative to the vessel."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, cos, hypot, sin
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.simulate.sensing import Sensor
from boatsim.simulate.stepper import Stepper


@dataclass(frozen=True)
class Anemometer(Sensor):
    """Measures the apparent wind, the air relative to the moving vessel.

    It is the wind of the vessel's effects `gusty_wind` and `fan_wind`, at the height of the middle
    of the drag areas.
    """

    words: ClassVar[str] = "speed and direction of the wind relative to the vessel, with noise"
    columns: ClassVar = {"wind_mps": "wind_mps", "wind_from_rad": "wind_from_rad"}

    speed_sd: float = param(0.3, low=0.0, high=10.0, unit="m/s", words="noise of the speed")
    direction_sd: float = param(0.05, low=0.0, high=1.0, unit="rad", words="noise of the direction")

    def read(self, engine: Stepper, rng: np.random.Generator) -> Mapping[str, float]:
        """Return speed of the apparent wind and where it comes from, clockwise from the bow."""
        state, north, east = engine.state, 0.0, 0.0
        for effect in engine.vessel.effects:
            air = getattr(effect, "air_velocity", None)
            if air is not None:
                along, across = air(state.t)
                north, east = north + along, east + across
        c, s = cos(state.psi), sin(state.psi)
        ahead, starboard = c * north + s * east - state.u, c * east - s * north - state.v
        n = rng.standard_normal(2).tolist()
        speed = max(hypot(ahead, starboard) + self.speed_sd * n[0], 0.0)
        return {
            "wind_mps": speed,
            "wind_from_rad": atan2(-starboard, -ahead) + self.direction_sd * n[1],
        }
