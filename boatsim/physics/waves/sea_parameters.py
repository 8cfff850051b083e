"""Parameters that effects of a sea have in common: spectrum, height, period, direction, depth."""

from dataclasses import dataclass, replace
from math import pi
from typing import Self

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.debugging import interpreted
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.noise import seeded_realisation
from boatsim.physics.param import name_code_parameter, param
from boatsim.physics.terms import index_code
from boatsim.physics.waves.dispersion import wave_number
from boatsim.physics.waves.field import WaveField
from boatsim.physics.waves.sea_state import SPECTRA, components, energy_above

# Largest share of the energy above the cut: the significant height is then 1 % too low
MOST_LOST = 0.02


@dataclass(frozen=True)
class SeaParameters(Effect):
    """Parameters of a sea, its elevation, and its realisation by a seed."""

    spectrum: str = "bretschneider"  # one of `sea_state.SPECTRA`
    significant_height: float = param(
        0.0, low=0.0, high=30.0, unit="m", words="four times the rms of the elevation; 0: calm"
    )
    modal_period: float = param(
        7.5, low=0.2, high=40.0, unit="s", words="period at the peak of the elevation spectrum"
    )
    toward: float = param(
        0.0, low=-2 * pi, high=2 * pi, unit="rad", words="direction the waves run to"
    )
    cut: float = param(
        0.0,
        low=0.0,
        high=200.0,
        unit="rad/s",
        words="highest frequency; 0: four times the modal frequency",
    )
    components: float = param(
        160.0, low=1.0, high=2000.0, unit="", words="number of wave components"
    )
    realisation: float = param(1.0, low=0.0, high=1e9, unit="", words="number of the realisation")
    gamma: float = param(
        3.3, low=1.0, high=7.0, unit="", words="peak enhancement of the spectrum jonswap"
    )
    spreading: float = param(
        0.0,
        low=0.0,
        high=200.0,
        unit="",
        words="exponent n of the directions, cos^n; 2 to 4 for a wind sea; 0: all waves run alike",
    )
    depth: float = param(
        0.0, low=0.0, high=11000.0, unit="m", words="depth of the water; 0: deep water"
    )
    random_amplitudes: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: the amplitudes are random too, not only phases"
    )
    spectrum_code: float = name_code_parameter("code of the spectrum")

    def __post_init__(self) -> None:
        """Check the spectrum, and that the waves up to the cut have nearly all of its energy.

        Raises:
            BadInput: There is no such spectrum, or more than 2 % of the energy lies above the cut.
        """
        super().__post_init__()
        code = index_code(f"{self.name}: spectrum", self.spectrum, SPECTRA)
        object.__setattr__(self, "spectrum_code", code)
        calm = self.significant_height == 0.0
        if calm or self.cut == 0.0 or self.spectrum == "regular":
            return
        frequency, above = energy_above(self.values())
        lost = float(np.interp(self.cut, frequency, above))
        if lost > MOST_LOST:
            lowest = float(np.interp(-MOST_LOST, -above, frequency))
            raise BadInput(
                f"{self.name}.cut = {self.cut:g} rad/s omits {100.0 * lost:.0f} % of the energy of "
                f"waves of {self.modal_period:g} s; allowed is at least {lowest:.3g} rad/s, "
                "or 0 for the default"
            )

    def wave_field(self) -> WaveField | None:
        """Return the waves of the sea; None if it is calm."""
        if self.significant_height == 0.0:
            return None
        frequency, amplitude, phase, direction = components(self.values()).T
        number = interpreted(wave_number)(frequency, self.depth)
        # Components have a trough at phase 0, waves of a field have a crest there
        return WaveField(amplitude, frequency, number, direction, phase + pi)

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the sea whose random waves follow from the seed.

        Args:
            seed: Seed of the scenario.
        """
        return replace(self, realisation=seeded_realisation(self.realisation, seed))
