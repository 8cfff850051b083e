"""Latitude and longitude in the columns for metres, or positions in millimetres, centimetres or kilometres."""

import numpy as np

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.diagnosis.priors import froude_time
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.importing.frames import radii
from boatsim.recordings.table import Recording

NARROW = 1.0  # [deg] 111 km: a log of latitudes and longitudes keeps within it,
AWAY = 100.0  # and is this many times as far from 0 as it is wide
INTEGERS = 1e-7  # [deg] of the fixes of GNSS receivers that are written as whole numbers
GRAVITY = 9.81  # [m/s^2]
FROUDE = (0.003, 2.0)  # numbers that boats have; above the latter they plane on foils
TOO_FAST = 10.0  # Froude number that no boat reaches


def look(recording: Recording, vessel: Vessel) -> list[Finding]:
    """Whether the boat stands still beside the origin but sails if its place is read as degrees, or flies."""
    if not {"x_m", "y_m"} <= recording.signals.keys():
        return []
    there = np.isfinite(recording["x_m"]) & np.isfinite(recording["y_m"]) & np.isfinite(recording.t)
    t, x, y = recording.t[there], recording["x_m"][there], recording["y_m"][there]
    if len(t) < 10 or np.ptp(t) <= 0.0:
        return []
    return _degrees(t, x, y, vessel) or _far(t, x, y, vessel)


def _degrees(t: Array, x: Array, y: Array, vessel: Vessel) -> list[Finding]:
    for scale in (1.0, INTEGERS):
        lat, lon = x * scale, y * scale
        width = max(float(np.ptp(lat)), float(np.ptp(lon)))
        inside = np.abs(lat).max() <= 90.0 and np.abs(lon).max() <= 180.0 and 0.0 < width < NARROW
        if not inside or np.hypot(lat.mean(), lon.mean()) < AWAY * width:
            continue
        meridian, across = (r * UNITS["deg"] for r in radii(float(np.radians(lat[0]))))
        across *= float(np.cos(np.radians(lat[0])))
        sails = _froude(t, (lat - lat[0]) * meridian, (lon - lon[0]) * across, vessel)
        if FROUDE[0] < sails < FROUDE[1] and _froude(t, x, y, vessel) < FROUDE[0] * (
            1.0 if scale == 1.0 else np.inf
        ):
            evidence = (
                f"x_m stays within {np.ptp(x):.3g} of {x[0]:.8g} and y_m within {np.ptp(y):.3g} of {y[0]:.8g}: read as "
                f"latitude and longitude the boat sails {np.hypot(np.ptp(lat) * meridian, np.ptp(lon) * across):.4g} m"
            )
            changes = tuple(
                Change(n, n, float(f"{m * scale:.10g}"), float(f"{-first * m:.10g}"))
                for n, m, first in (("x_m", meridian, lat[0]), ("y_m", across, lon[0]))
            )
            return [Finding("latitude_as_metres", evidence, sure=0.99, changes=changes)]
    return []


def _far(t: Array, x: Array, y: Array, vessel: Vessel) -> list[Finding]:
    if not (speed := _froude(t, x, y, vessel)) > TOO_FAST:
        return []
    for unit in ("cm", "mm"):
        if FROUDE[0] < speed * UNITS[unit] < 1.0:
            mps = speed * np.sqrt(GRAVITY * vessel.length)
            evidence = f"x_m, y_m move at {mps:.3g} m/s, far beyond a hull of {vessel.length:g} m"
            changes = tuple(Change(n, n, UNITS[unit]) for n in ("x_m", "y_m"))
            return [
                Finding(
                    "position_unit",
                    f"{evidence}; in {unit} at {mps * UNITS[unit]:.3g} m/s",
                    changes=changes,
                )
            ]
    return []


def _froude(t: Array, x: Array, y: Array, vessel: Vessel) -> float:
    """Froude number that half of a log exceeds, over a time of the boat so that noise averages out."""
    after = np.searchsorted(t, t + 2.0 * froude_time(vessel)).clip(max=len(t) - 1)
    far = after > np.arange(len(t))
    if not far.any():
        return 0.0
    speed = np.hypot(x[after] - x, y[after] - y)[far] / (t[after] - t)[far]
    return float(np.median(speed[np.isfinite(speed)])) / float(np.sqrt(GRAVITY * vessel.length))
