"""Spectra of buoys and wave models, read and written by wavespectra.

Its data sets have frequencies in Hz, directions from which the waves come in degrees clockwise from
north, and densities in m^2/Hz/deg, or in m^2/Hz without directions.
"""

from collections.abc import Callable
from importlib.util import find_spec
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.waves.tabulated import TabulatedSpectrum, close_sector

NEEDED = 'spectra of buoys and models need wavespectra: pip install "boatsim[spectra]"'
WRITERS = {".nc": "to_netcdf", ".swn": "to_swan", ".json": "to_json"}
PER_DEGREE = pi / 180.0
START = "2000-01-01"  # time of a written spectrum, which has none


def check_installed() -> None:
    """Raise BadInput with the command that installs wavespectra if it is missing."""
    if find_spec("wavespectra") is None:
        raise BadInput(NEEDED)


def read_formats() -> list[str]:
    """Return the names of the formats that wavespectra reads.

    Raises:
        BadInput: wavespectra is not installed.
    """
    check_installed()
    import wavespectra

    names = [name.removeprefix("read_") for name in dir(wavespectra) if name.startswith("read_")]
    return sorted(set(names) - {"dataset"})


def read_file(path: Path, kind: str, time: int, site: int) -> TabulatedSpectrum:
    """Read one spectrum of a file of a buoy or model.

    Args:
        path: The file.
        kind: Name of its format, as wavespectra has it: swan, ww3, ndbc, ndbc_ascii, ...
        time: Number of the time, from 0; -1 for the last one.
        site: Number of the site, from 0.

    Raises:
        BadInput: wavespectra is not installed or cannot read the file, or there is no such format,
            time or site.
    """
    formats = read_formats()
    if kind not in formats:
        raise BadInput(unknown_name_message(f"{path}: --format", kind, formats))
    if not path.exists():
        raise BadInput(f"{path}: there is no such file")
    import wavespectra

    read: Callable[[str], Any] = getattr(wavespectra, f"read_{kind}")
    try:
        efth = read(str(path)).efth.load()
    except Exception as error:  # whatever the readers of wavespectra raise
        words = " ".join(str(error).split()) or type(error).__name__
        raise BadInput(f"{path}: wavespectra cannot read it as {kind}: {words}") from None
    for name, number, option in (("time", time, "--time"), ("site", site, "--site")):
        if name in efth.dims:
            count = efth.sizes[name]
            if not -count <= number < count:
                raise BadInput(f"{path}: {option} = {number}; the file has {count}, from 0 on")
            efth = efth.isel({name: number})
    others = [name for name in efth.dims if name not in ("freq", "dir")]
    efth = efth.isel(dict.fromkeys(others, 0))
    return spectrum_of(efth, path)


def spectrum_of(efth: Any, path: Path) -> TabulatedSpectrum:
    """Return the spectrum of a data array of wavespectra over frequency, with or without direction.

    Args:
        efth: Data array of the density with the coordinate freq, and dir.
        path: File, for messages.

    Raises:
        BadInput: A density is missing or negative, there are no waves, or fewer than four
            directions.
    """
    frequency = 2.0 * pi * np.asarray(efth.freq, dtype=float)
    order = np.argsort(frequency)
    direction = np.zeros(0)
    if "dir" in efth.dims:
        density = np.asarray(efth.transpose("freq", "dir"), dtype=float)
        density = density / (2.0 * pi * PER_DEGREE)
        toward = (np.radians(np.asarray(efth.dir, dtype=float)) + pi) % (2.0 * pi)
        toward[toward > 2.0 * pi - 1e-6] = 0.0
        direction, first = np.unique(np.round(toward, 9), return_index=True)
        if len(direction) < 4:
            raise BadInput(f"{path}: {len(direction)} directions; at least four are required")
        direction, density = close_sector(direction, density[:, first])
    else:
        density = np.asarray(efth, dtype=float) / (2.0 * pi)
    if not np.isfinite(density).all() or np.any(density < 0.0):
        raise BadInput(f"{path}: a density is missing or negative")
    found = TabulatedSpectrum(frequency[order], direction, density[order])
    if len(frequency) < 3 or found.significant_height <= 0.0:
        raise BadInput(f"{path}: the spectrum has no waves, or fewer than three frequencies")
    return found


def write_file(path: Path, found: TabulatedSpectrum) -> None:
    """Write a spectrum with directions by wavespectra; the suffix decides the format.

    Args:
        path: The file, .nc (netCDF of wavespectra), .swn (SWAN) or .json.
        found: The spectrum.

    Raises:
        BadInput: wavespectra is not installed, or the spectrum has no directions.
    """
    check_installed()
    if not len(found.direction):
        raise BadInput(f"{path}: a spectrum without directions is written as .csv only")
    import xarray
    from wavespectra.core.attributes import set_spec_attributes

    coming = np.degrees(found.direction + pi) % 360.0
    order = np.argsort(coming)
    density = found.density[:, order] * 2.0 * pi * PER_DEGREE
    data = xarray.DataArray(
        density[None, None],
        dims=("time", "site", "freq", "dir"),
        coords={
            "time": [np.datetime64(START, "ns")],
            "site": [1],
            "freq": found.frequency / (2.0 * pi),
            "dir": coming[order],
            "lon": ("site", [0.0]),
            "lat": ("site", [0.0]),
        },
        name="efth",
    ).to_dataset()
    set_spec_attributes(data)
    getattr(data.spec, WRITERS[path.suffix.lower()])(str(path))
