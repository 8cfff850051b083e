"""Positions on the ellipsoid, times and attitudes in the conventions of log formats."""

from math import atan2, cos, degrees, hypot, radians, sin, sqrt

import numpy as np

from validation.owner_logs.sail import Array

A, F = 6378137.0, 1.0 / 298.257223563  # WGS 84
ORIGIN = (59.1273, 10.2231)  # [deg]
EPOCH = 1_748_770_000.0  # [s] since 1970 at which a log begins
BOOT = 63.4  # [s] since the autopilot started


def geodetic(north: Array, east: Array) -> tuple[Array, Array]:
    """Return latitudes and longitudes [deg] of points on the tangent plane at ORIGIN.

    The conversion goes through earth-centred coordinates.
    """
    lat0, lon0 = (radians(a) for a in ORIGIN)
    e2 = F * (2.0 - F)
    n0 = A / sqrt(1.0 - e2 * sin(lat0) ** 2)
    x0, y0, z0 = n0 * cos(lat0) * cos(lon0), n0 * cos(lat0) * sin(lon0), n0 * (1 - e2) * sin(lat0)
    found = []
    for dn, de in zip(north, east, strict=True):
        x = x0 - sin(lat0) * cos(lon0) * dn - sin(lon0) * de
        y = y0 - sin(lat0) * sin(lon0) * dn + cos(lon0) * de
        z = z0 + cos(lat0) * dn
        flat, lat = hypot(x, y), lat0
        for _ in range(6):
            n = A / sqrt(1.0 - e2 * sin(lat) ** 2)
            lat = atan2(z + e2 * n * sin(lat), flat)
        found.append((degrees(lat), degrees(atan2(y, x))))
    lat, lon = np.array(found).T
    return lat, lon


def quaternion(yaw: float) -> tuple[float, float, float, float]:
    """Return w, x, y, z of a rotation about the vertical."""
    return cos(yaw / 2), 0.0, 0.0, sin(yaw / 2)


def compass_degrees(psi: Array) -> Array:
    """Return the heading in degrees from 0 to 360."""
    return np.degrees(psi) % 360.0


def last_values(t: Array, values: Array, at: Array) -> Array:
    """Return the last value before each time."""
    return values[np.clip(np.searchsorted(t, at + 1e-9, side="right") - 1, 0, len(t) - 1)]


def merge_streams(*times: Array) -> list[tuple[float, int, int]]:
    """Return (time, stream, row) of several streams in order of time."""
    return sorted((float(t), k, i) for k, stream in enumerate(times) for i, t in enumerate(stream))
