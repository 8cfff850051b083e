"""Places and attitudes in other frames, brought to ours: x north, y east, heading clockwise, SNAME body axes."""

import re
from collections.abc import Mapping

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.log import Signal

# WGS 84 (NIMA TR8350.2, 3rd ed., table 3.1): semi-major axis and flattening
SEMI_MAJOR, FLATTENING = 6378137.0, 1.0 / 298.257223563  # [m], 1
QUATERNION = re.compile(r"^(.*?)(?:\.([xyzw])|\[([0-3])\])$")
ATTITUDE = re.compile(r"(^|[._/])(q|quat|quaternion|orientation|rotation|attitude)$")
UNIT_LENGTH = 0.01  # by which a quaternion's length may miss 1


def local(latitude: Array, longitude: Array, origin: tuple[float, float]) -> tuple[Array, Array]:
    """North and east (N,) m of an origin from geodetic latitude and longitude (N,) rad; the origin is in rad too.

    north = (lat - lat0) M, east = (lon - lon0) N cos(lat0), with the radii of curvature of WGS 84 at the origin. What
    that neglects goes with the square of the distance: less than 2 mm 100 m away and 0.2 m 1 km away at latitudes up
    to 60 degrees, where it is largest in the north (tests/test_frames.py holds it to that).
    """
    lat0, lon0 = origin
    meridian, across = radii(lat0)
    turned = np.remainder(longitude - lon0 + np.pi, 2.0 * np.pi) - np.pi  # over the date line
    return (latitude - lat0) * meridian, turned * across * np.cos(lat0)


def radii(latitude: float) -> tuple[float, float]:
    """Radii of curvature [m] of WGS 84 along the meridian, M, and across it, N, at a latitude [rad]."""
    squared = FLATTENING * (2.0 - FLATTENING)  # of the first eccentricity
    w = 1.0 - squared * np.sin(latitude) ** 2
    across = SEMI_MAJOR / np.sqrt(w)
    return float(across * (1.0 - squared) / w), float(across)


def angles(w: Array, x: Array, y: Array, z: Array) -> tuple[Array, Array, Array]:
    """Roll, pitch, yaw (N,) rad of quaternions, about x, y, z of whatever axes they are in, yaw first."""
    roll = np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2.0 * (w * y - z * x), -1.0, 1.0))
    return roll, pitch, np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def with_angles(signals: Mapping[str, Signal]) -> dict[str, Signal]:
    """All signals, and roll, pitch and yaw beside each attitude that is a quaternion: `q.yaw`, `orientation.yaw`.

    Letters name the parts of one; numbers count from its real part.
    """
    found, groups = dict(signals), dict[str, dict[str, Signal]]()
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
        for name, angle in zip(("roll", "pitch", "yaw"), angles(w, x, y, z), strict=True):
            found[f"{base}.{name}"] = Signal(group["w"].t, angle, "rad")
    return found
