"""Check for latitude and longitude in columns for metres, and for other units of length."""

import numpy as np

from boatsim.diagnosis.checks.finding import Change, Finding, scaling_corrections
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.importing.frames import curvature_radii
from boatsim.recordings.table import Recording

INTEGER_DEGREES = 1e-7  # [deg] unit of positions that GNSS receivers write as integers


def check_position_unit(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Find recorded positions in a wrong unit: latitude and longitude, centimetres or millimetres.

    In metres the boat would hardly move or be impossibly fast; in the other unit its speed is
    plausible.

    Args:
        recording: The recording as written in the file.
        vessel: The vessel; its length gives the Froude number.
        config: Thresholds of the quality checks.

    Returns:
        At most one finding, "latitude_as_metres" or "position_unit".
    """
    if not {"x_m", "y_m"} <= recording.signals.keys():
        return []
    known = np.isfinite(recording["x_m"]) & np.isfinite(recording["y_m"])
    known &= np.isfinite(recording.t)
    t = recording.t[known]
    x = recording["x_m"][known]
    y = recording["y_m"][known]
    if len(t) < config.position_min_rows or np.ptp(t) <= 0.0:
        return []
    return _check_degrees(t, x, y, vessel, config) or _check_scale(t, x, y, vessel, config)


def _check_degrees(
    t: Array, x: Array, y: Array, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    for scale in (1.0, INTEGER_DEGREES):
        lat = x * scale
        lon = y * scale
        if not _may_be_degrees(lat, lon, config):
            continue
        latitude = float(np.radians(lat[0]))
        meridian, across = np.multiply(curvature_radii(latitude), UNITS["deg"]).tolist()
        across *= float(np.cos(latitude))
        froude = _froude_number(
            t, (lat - lat[0]) * meridian, (lon - lon[0]) * across, vessel, config
        )
        if not config.position_min_froude < froude < config.position_max_froude:
            continue
        moves = _froude_number(t, x, y, vessel, config) >= config.position_min_froude
        if scale == 1.0 and moves:
            continue
        distance = np.hypot(np.ptp(lat) * meridian, np.ptp(lon) * across)
        evidence = (
            f"x_m stays within {np.ptp(x):.3g} of {x[0]:.8g} and y_m within {np.ptp(y):.3g} of "
            f"{y[0]:.8g}. Read as latitude and longitude, the boat moves {distance:.4g} m"
        )
        return [
            Finding(
                "latitude_as_metres",
                evidence,
                probability=config.probability_evident,
                changes=(
                    _degrees_to_metres("x_m", meridian, scale, lat[0]),
                    _degrees_to_metres("y_m", across, scale, lon[0]),
                ),
            )
        ]
    return []


def _may_be_degrees(lat: Array, lon: Array, config: ChecksConfig) -> bool:
    """Whether values are those of a small area, far from 0 deg."""
    width = max(float(np.ptp(lat)), float(np.ptp(lon)))
    if np.abs(lat).max() > 90.0 or np.abs(lon).max() > 180.0:
        return False
    if not 0.0 < width < config.degrees_max_width:
        return False
    return bool(np.hypot(lat.mean(), lon.mean()) >= config.degrees_min_offset * width)


def _degrees_to_metres(name: str, metres: float, scale: float, origin: float) -> Change:
    """Change of a column in degrees (times a scale) to metres from the first row."""
    factor = float(f"{metres * scale:.10g}")
    offset = float(f"{-origin * metres:.10g}")
    return Change(name, name, factor, offset)


def _check_scale(
    t: Array, x: Array, y: Array, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    froude = _froude_number(t, x, y, vessel, config)
    if not froude > config.position_impossible_froude:
        return []
    for unit in ("cm", "mm"):
        if config.position_min_froude < froude * UNITS[unit] < 1.0:
            speed = froude * np.sqrt(GRAVITY * vessel.length)
            evidence = (
                f"x_m, y_m move at {speed:.3g} m/s, too fast for a hull of {vessel.length:g} m. "
                f"In {unit} they move at {speed * UNITS[unit]:.3g} m/s"
            )
            changes = scaling_corrections(("x_m", "y_m"), UNITS[unit])
            return [Finding("position_unit", evidence, changes=changes)]
    return []


def _froude_number(t: Array, x: Array, y: Array, vessel: Vessel, config: ChecksConfig) -> float:
    """Median Froude number of the speed over two Froude times, so that noise averages out."""
    after = np.searchsorted(t, t + config.speed_window * froude_time_scale(vessel)).clip(
        max=len(t) - 1
    )
    later = after > np.arange(len(t))
    if not later.any():
        return 0.0
    speed = np.hypot(x[after] - x, y[after] - y)[later] / (t[after] - t)[later]
    return float(np.median(speed[np.isfinite(speed)])) / float(np.sqrt(GRAVITY * vessel.length))
