"""Parameters that effects of a sea have in common: spectrum, height, period, direction, depth."""

from dataclasses import dataclass, replace
from math import pi
from typing import ClassVar, Self

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.debugging import interpreted
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.noise import seeded_realisation
from boatsim.physics.param import UNSET, name_code_parameter, param
from boatsim.physics.terms import index_code
from boatsim.physics.waves.dispersion import wave_number
from boatsim.physics.waves.field import WaveField
from boatsim.physics.waves.sea_state import SPECTRA, components, energy_above
from boatsim.physics.waves.tabulated import read_spectrum, spectrum_table

# Largest share of the energy above the cut: the significant height is then 1 % too low
MOST_LOST = 0.02
NO_SEA = (0.0,)  # table of a sea that is not tabulated


@dataclass(frozen=True)
class SeaParameters(Effect):
    """Parameters of a sea, its elevation, and its realisation by a seed.

    A spectrum of a file, `spectrum` = "tabulated", has the height of the file if none is given, and
    its directions are turned by `toward`. Other seas without a height are calm.
    """

    paths: ClassVar[tuple[str, ...]] = ("spectrum_file",)

    spectrum: str = "bretschneider"  # one of `sea_state.SPECTRA`
    spectrum_file: str = ""  # of spectrum = "tabulated"
    significant_height: float = param(
        UNSET,
        low=0.0,
        high=30.0,
        unit="m",
        words="four times the rms of the elevation; 0: calm; default: that of spectrum_file",
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
            BadInput: There is no such spectrum, its file cannot be read, or more than 2 % of the
                energy lies above the cut.
        """
        super().__post_init__()
        code = index_code(f"{self.name}: spectrum", self.spectrum, SPECTRA)
        object.__setattr__(self, "spectrum_code", code)
        if self.spectrum == "tabulated":
            self._use_file()
            return
        if not self.has_value("significant_height"):
            object.__setattr__(self, "significant_height", 0.0)
        if self.spectrum_file:
            raise BadInput(
                f'{self.name}: spectrum_file applies to spectrum = "tabulated"; here it is '
                f'"{self.spectrum}"'
            )
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

    def _use_file(self) -> None:
        """Check the file of a tabulated sea, and take its height if none is given."""
        if not self.spectrum_file:
            raise BadInput(f'{self.name}: spectrum = "tabulated" needs spectrum_file')
        found = read_spectrum(self.spectrum_file)
        if len(found.direction) and self.spreading > 0.0:
            raise BadInput(
                f"{self.name}.spreading = {self.spreading:g}; {self.spectrum_file} has directions"
            )
        if not self.has_value("significant_height"):
            object.__setattr__(self, "significant_height", found.significant_height)
        table = spectrum_table(found, int(self.components), self.cut)
        shares = np.array(table[4:]).reshape(int(self.components), -1)[:, 0]
        if 1.0 - shares.sum() > MOST_LOST:
            raise BadInput(
                f"{self.name}.cut = {self.cut:g} rad/s omits {100.0 * (1.0 - shares.sum()):.0f} % "
                f"of the energy of {self.spectrum_file}; 0 for its highest frequency"
            )

    def sea_table(self) -> tuple[float, ...]:
        """Return the table of a tabulated sea, as compiled laws read it."""
        if self.spectrum != "tabulated":
            return NO_SEA
        return spectrum_table(read_spectrum(self.spectrum_file), int(self.components), self.cut)

    def wave_field(self) -> WaveField | None:
        """Return the waves of the sea; None if it is calm."""
        if self.significant_height == 0.0:
            return None
        frequency, amplitude, phase, direction = components(
            self.values(), np.array(self.sea_table())
        ).T
        number = interpreted(wave_number)(frequency, self.depth)
        # Components have a trough at phase 0, waves of a field have a crest there
        return WaveField(amplitude, frequency, number, direction, phase + pi)

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the sea whose random waves follow from the seed.

        Args:
            seed: Seed of the scenario.
        """
        return replace(self, realisation=seeded_realisation(self.realisation, seed))
