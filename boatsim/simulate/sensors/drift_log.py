"""Drift log: sway velocity, which the usual sensors of a small boat do not measure."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.simulate.sensing import Sensor
from boatsim.simulate.stepper import Stepper


@dataclass(frozen=True)
class DriftLog(Sensor):
    """Measures `v` of `Sense`."""

    words: ClassVar[str] = "sway velocity over ground, with noise"
    columns: ClassVar = {"v": "v_mps"}

    speed_sd: float = param(0.01, low=0.0, high=1.0, unit="m/s", words="noise of the velocity")

    def read(self, engine: Stepper, rng: np.random.Generator) -> Mapping[str, float]:
        """Return the sway velocity with noise."""
        return {"v": engine.state.v + self.speed_sd * float(rng.standard_normal())}
