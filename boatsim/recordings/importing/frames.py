"""Conversion of positions and attitudes to north, east and SNAME body axes."""

import re
from collections.abc import Mapping

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.log import Signal

# WGS 84 (NIMA TR8350.2, 3rd ed., table 3.1): semi-major axis and flattening
SEMI_MAJOR, FLATTENING = 6378137.0, 1.0 / 298.257223563  # [m], 1
QUATERNION = re.compile(r"^(.*?)(?:\.([xyzw])|\[([0-3])\])$")
ATTITUDE = re.compile(r"(^|[._/])(q|quat|quaternion|orientation|rotation|attitude)$")
UNIT_LENGTH = 0.01  # largest difference of a quaternion's length from 1


def local_position(
    latitude: Array, longitude: Array, origin: tuple[float, float]
) -> tuple[Array, Array]:
    """Return the position north and east of an origin, each (N,) [m].

    north = (lat - lat0) M, east = (lon - lon0) N cos(lat0), with the radii of curvature of WGS 84
    at the origin. The error grows with the square of the distance: less than 2 mm at 100 m and 0.2
    m at 1 km at latitudes up to 60 degrees (checked by tests/recordings/importing/test_frames.py).

    Args:
        latitude: Geodetic latitude (N,) [rad].
        longitude: Longitude (N,) [rad].
        origin: Latitude and longitude of the origin [rad].
    """
    lat0, lon0 = origin
    meridian, across = curvature_radii(lat0)
    turned = np.remainder(longitude - lon0 + np.pi, 2.0 * np.pi) - np.pi  # across the date line
    return (latitude - lat0) * meridian, turned * across * np.cos(lat0)


def curvature_radii(latitude: float) -> tuple[float, float]:
    """Return the radii of curvature M and N of WGS 84 [m] at a latitude [rad]."""
    squared = FLATTENING * (2.0 - FLATTENING)  # of the first eccentricity
    w = 1.0 - squared * np.sin(latitude) ** 2
    across = SEMI_MAJOR / np.sqrt(w)
    return float(across * (1.0 - squared) / w), float(across)


def quaternions_to_euler_angles(
    w: Array, x: Array, y: Array, z: Array
) -> tuple[Array, Array, Array]:
    """Return roll, pitch and yaw, each (N,) [rad], of quaternions.

    The rotations are in the order yaw, pitch, roll.
    """
    roll = np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2.0 * (w * y - z * x), -1.0, 1.0))
    return roll, pitch, np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def with_euler_angles(signals: Mapping[str, Signal]) -> dict[str, Signal]:
    """Return all signals, with roll, pitch and yaw of each quaternion added: `q.yaw`.

    The parts of a quaternion are named by letters, or numbered from the real part.
    """
    found = dict(signals)
    groups: dict[str, dict[str, Signal]] = {}
    for name, signal in signals.items():
        if (parts := QUATERNION.match(name)) and ATTITUDE.search(parts[1]):
            groups.setdefault(parts[1], {})[parts[2] or "wxyz"[int(parts[3])]] = signal
    for base, group in groups.items():
        if set(group) != set("wxyz") or len({len(s.t) for s in group.values()}) > 1:
            continue
        w, x, y, z = (group[part].values for part in "wxyz")
        with np.errstate(over="ignore", invalid="ignore"):
            valid = np.abs(np.sqrt(w * w + x * x + y * y + z * z) - 1.0) < UNIT_LENGTH
        w, x, y, z = (np.where(valid, part, np.nan) for part in (w, x, y, z))
        for name, angle in zip(
            ("roll", "pitch", "yaw"), quaternions_to_euler_angles(w, x, y, z), strict=True
        ):
            found[f"{base}.{name}"] = Signal(group["w"].t, angle, "rad")
    return found
