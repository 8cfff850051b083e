"""Inclinometer: roll angle and roll rate, which the usual sensors do not measure."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.simulate.sensing import Sensor
from boatsim.simulate.stepper import Stepper


@dataclass(frozen=True)
class Inclinometer(Sensor):
    """Measures `phi` and `p` of `Sense`."""

    words: ClassVar[str] = "roll angle and rate, with noise"
    columns: ClassVar = {"phi": "phi_rad", "p": "p_radps"}

    roll_sd: float = param(0.002, low=0.0, high=0.5, unit="rad", words="noise of the angle")
    rate_sd: float = param(
        0.00175, low=0.0, high=0.5, unit="rad/s", words="noise of the rate, 0.1 deg/s"
    )

    def read(self, engine: Stepper, rng: np.random.Generator) -> Mapping[str, float]:
        """Return roll angle and roll rate with noise."""
        s, n = engine.state, rng.standard_normal(2).tolist()
        return {"phi": s.phi + self.roll_sd * n[0], "p": s.p + self.rate_sd * n[1]}
