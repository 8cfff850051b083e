"""A sea and its loads on a hull at rest in boatsim, and the difference to those of a program."""

from math import pi
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array, make_motion
from boatsim.physics.coefficients.files import write_wave_loads
from boatsim.physics.coefficients.table import WaveLoads
from boatsim.physics.effects.panel_wave_loads import PanelWaveLoads
from boatsim.physics.waves.field import WaveField

COMPONENTS = 100.0  # waves of an irregular sea
SAMPLES = 16  # of a period of a regular wave


def sea_of_table(folder: Path, loads: WaveLoads, **sea: object) -> PanelWaveLoads:
    """Return the wave loads of a table in a sea.

    Args:
        folder: Folder in which the table is written.
        loads: The table.
        **sea: Parameters of the sea, and `drift`.
    """
    write_wave_loads(folder, loads)
    given = {"coefficients": str(folder), "depth": 0.0, "components": COMPONENTS} | sea
    return PanelWaveLoads(**given)  # type: ignore[arg-type]


def waves_of(sea: PanelWaveLoads) -> WaveField:
    """Return the waves of a sea that is not calm."""
    field = sea.wave_field()
    assert field is not None
    return field


def regular_sea(sea: PanelWaveLoads, frequency: float) -> dict[str, object]:
    """Return the settings that make a sea a regular wave of an amplitude of 1 m.

    Args:
        sea: The sea, for its direction.
        frequency: Angular frequency [rad/s].
    """
    return {
        "spectrum": "regular",
        "significant_height": 2.0,
        "modal_period": 2.0 * pi / frequency,
        "toward": sea.toward,
    }


def times_of_period(frequency: float) -> Array:
    """Return equally spaced times of one period (S,) [s]."""
    return np.arange(SAMPLES) * (2.0 * pi / frequency / SAMPLES)


def loads_at(
    sea: PanelWaveLoads, t: Array, psi: float, place: tuple[float, float] = (0.0, 0.0)
) -> Array:
    """Return the loads of a sea on a hull that is held (T, 6) [N, N m].

    Args:
        sea: The sea.
        t: Times (T,) [s].
        psi: Heading of the hull [rad].
        place: Place of the hull, x and y [m].
    """
    table, values = np.array([*sea.table(), 0.0]), sea.values()
    rows = []
    for time in t:
        motion = make_motion(t=time, x=place[0], y=place[1], psi=psi)
        rows.append(tuple(PanelWaveLoads.law(motion, values, table, np.int64(0))))
    return np.array(rows)


def relative_difference(own: Array, theirs: Array) -> Array:
    """Return the rms of the difference over the largest rms of each column (C,).

    It is that of the heading with the largest one.

    Args:
        own: Values of boatsim (H, T, C) at several headings.
        theirs: Values of the other program.
    """
    rms = np.sqrt(np.mean(own**2, axis=1))
    difference = np.sqrt(np.mean((own - theirs) ** 2, axis=1)).max(axis=0)
    largest = rms.max(axis=0)
    return np.asarray(difference / np.where(largest > 0.0, largest, np.inf))


def spectrum_difference(own: Array, theirs: Array) -> tuple[float, float]:
    """Return the largest difference of two spectra over the peak, and the ratio of the heights.

    Args:
        own: Density of boatsim over equally spaced frequencies (F,) [m^2 s].
        theirs: That of the other program.
    """
    peak = np.abs(own - theirs).max() / own.max()
    return float(peak), float(np.sqrt(theirs.sum() / own.sum()))
