"""Columns of the position by latitude and longitude."""

from math import degrees, radians

import numpy as np

from boatsim.errors import BadInput
from boatsim.recordings.importing.conversion_state import Column, ConversionState, signal_of
from boatsim.recordings.importing.frames import local_position
from boatsim.recordings.importing.mapping import Position
from boatsim.recordings.importing.recording_rows import rows_in_use
from boatsim.recordings.importing.resample import clean_samples


def add_position(work: ConversionState, position: Position) -> None:
    """Add the columns of the position by latitude and longitude.

    Args:
        work: State of the conversion.
        position: Expressions of latitude and longitude.

    Raises:
        BadInput: The angles are of two streams, too large, or never known in the part to use.
    """
    north, how_north = signal_of(work, "position.latitude", position.latitude)
    east, how_east = signal_of(work, "position.longitude", position.longitude)
    if len(north.t) != len(east.t) or not np.array_equal(north.t, east.t, equal_nan=True):
        raise BadInput(
            f"{work.file}: position: latitude and longitude are of two streams; allowed are "
            "those of one"
        )
    t, lat, lon = north.t, how_north.convert(north.values), how_east.convert(east.values)
    there = np.isfinite(t) & np.isfinite(lat) & np.isfinite(lon)
    if there.any() and max(np.abs(lat[there]).max() / 0.5, np.abs(lon[there]).max()) > np.pi + 1e-9:
        largest = float(np.abs(lat[there]).max())
        raise BadInput(
            f"{work.file}: position: latitudes up to {largest:g} rad; are they in degrees? write "
            "`* deg` behind them"
        )
    nowhere = there & (lat == 0.0) & (lon == 0.0)
    if nowhere.any():
        count = int(nowhere.sum())
        fixes = "1 fix" if count == 1 else f"{count} fixes"
        work.remark(
            f"omitted {fixes} at latitude and longitude 0, before satellites were found, "
            f"{work.first_of(t[nowhere])}"
        )
    there &= ~nowhere
    inside = there & rows_in_use(work, t)
    if not inside.any():
        raise BadInput(
            f"{work.file}: position: there is no fix of {position.latitude!r} in the part to use"
        )
    t, lat, lon = t[inside], lat[inside], lon[inside]
    first = int(np.argmin(t))
    at = position.origin or (degrees(lat[first]), degrees(lon[first]))
    x, y = local_position(lat, lon, (radians(at[0]), radians(at[1])))
    work.remark(f"x_m and y_m are counted from latitude {at[0]:.8f}, longitude {at[1]:.8f}")
    for name, values in (("x_m", x), ("y_m", y)):
        work.columns[name] = Column(
            clean_samples(t - work.map.latency.get(name, 0.0), values), False
        )
