"""The wave at a hull from probes elsewhere, by the dispersion of linear waves.

One probe gives the elevation of a wave that travels one way. With two or more probes in a line the
waves of both directions are separated at each frequency by least squares (Mansard and Funke 1980).
"""

from collections.abc import Sequence

import numpy as np
from pydantic import Field, model_validator

from boatsim.files import Table
from boatsim.physics.base import Array
from boatsim.physics.debugging import interpreted
from boatsim.physics.waves.dispersion import wave_number

# Share of the number of probes that is added to the normal equations, so that frequencies at which
# the probes stand half a wavelength apart get no large waves of opposite signs
REGULARISATION = 0.02
PAD = 0.5  # share of the duration by which a record is continued, so that waves do not wrap around


class WaveProbes(Table):
    """Elevation of the wave at a place, from probes in a line along its direction of travel.

    Attributes:
        probes: Expression of a signal, in m and upward -> place of the probe [m].
        place: Place of the hull [m], on the same line.
        depth: Depth of the water [m].
        travels: 1: towards larger places, the wave that is wanted; -1: towards smaller ones.
        low: Lowest frequency of the wave [Hz]; slower changes are left out.
        high: Highest frequency of the wave [Hz].
    """

    probes: dict[str, float] = Field(min_length=1, max_length=20)
    place: float
    depth: float = Field(gt=0.0)
    travels: int = 1
    low: float = Field(0.05, ge=0.0)
    high: float = Field(5.0, gt=0.0)

    @model_validator(mode="after")
    def _possible(self) -> "WaveProbes":
        if self.travels not in (-1, 1):
            raise ValueError(f"travels = {self.travels}; allowed is 1 or -1")
        if not self.low < self.high:
            raise ValueError("low must be less than high")
        return self


def wave_at(step: float, elevations: Sequence[Array], given: WaveProbes) -> Array:
    """Return the elevation of the wave that travels one way, at the place of the hull.

    Args:
        step: Time between two samples [s].
        elevations: Elevations (N,) of the probes [m], in the order of `given`.
        given: Places, depth and direction.

    Returns:
        Elevation (N,) [m].
    """
    count = len(elevations[0])
    length = count + int(PAD * count)
    offsets = given.travels * (np.array(list(given.probes.values())) - given.place)
    frequencies: Array = np.asarray(np.fft.rfftfreq(length, step), dtype=np.float64)
    measured = np.array([np.fft.rfft(_padded(x, length)) for x in elevations])
    k = interpreted(wave_number)(2.0 * np.pi * frequencies, given.depth)
    incident = np.exp(-1j * np.outer(offsets, k))
    inside = (frequencies >= given.low) & (frequencies <= given.high)
    if len(offsets) == 1:
        found = measured[0] / incident[0]
    else:
        # normal equations of both directions; the second one has the conjugate phases
        size = len(offsets) * (1.0 + REGULARISATION)
        cross = np.sum(incident**2, axis=0)
        first = np.sum(np.conj(incident) * measured, axis=0)
        second = np.sum(incident * measured, axis=0)
        found = (size * first - np.conj(cross) * second) / (size**2 - np.abs(cross) ** 2)
    return np.asarray(np.fft.irfft(np.where(inside, found, 0.0), length)[:count])


def _padded(values: Array, length: int) -> Array:
    """A record (N,) continued to its begin by a line, less its value at rest."""
    back = np.linspace(values[-1], values[0], length - len(values) + 2)[1:-1]
    return np.concatenate([values, back]) - np.median(values)
