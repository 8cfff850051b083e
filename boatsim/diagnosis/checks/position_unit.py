"""Check for latitude and longitude in columns for metres, and for other units of length.

An impossible speed alone does not tell a wrong unit of the positions from a wrong unit of the time.
A correction needs a second sign that does not depend on the time (the length of the turns), or that
depends on it alone (the recorded speed).
"""

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

TIME_REMEDY = 'correct the times; if they are in minutes: t_s = "t_s * min" in [columns]'
UNIT_REMEDY = (
    'compare with the duration of the trial, then write x_m = "x_m * cm", y_m = "y_m * cm" or '
    't_s = "t_s * min" (or the unit of the log) in [columns] of recording.toml'
)
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
        At most one finding, "latitude_as_metres", "position_unit" or "time_unit". A unit that only
        an impossible speed contradicts has no correction.
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
    return _check_degrees(t, x, y, vessel, config) or _check_scale(
        recording, t, x, y, vessel, config
    )


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
    recording: Recording, t: Array, x: Array, y: Array, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    froude = _froude_number(t, x, y, vessel, config)
    if not froude > config.position_impossible_froude:
        return []
    speed = froude * np.sqrt(GRAVITY * vessel.length)
    too_fast = f"x_m, y_m move at {speed:.3g} m/s, too fast for a hull of {vessel.length:g} m. "
    second_signs = _turn_sign(recording, vessel, config)
    second_signs += _recorded_speed_sign(recording, speed, config)
    in_metres = [sign for factor, sign in second_signs if factor == 1.0]
    for unit in ("cm", "mm"):
        factor = UNITS[unit]
        if not config.position_min_froude < froude * factor < 1.0:
            continue
        evidence = f"{too_fast}In {unit} they move at {speed * factor:.3g} m/s"
        agreeing = [sign for other, sign in second_signs if other == factor]
        if agreeing and not in_metres:
            evidence += f". {agreeing[0]}, too"
            changes = scaling_corrections(("x_m", "y_m"), factor)
            return [Finding("position_unit", evidence, changes=changes)]
    if in_metres:
        evidence = f"{too_fast}{in_metres[0]}, so that the times are wrong"
        return [Finding("time_unit", evidence, remedy=TIME_REMEDY)]
    return _undecided_unit(froude, speed, too_fast, config)


def _undecided_unit(
    froude: float, speed: float, too_fast: str, config: ChecksConfig
) -> list[Finding]:
    """The finding of an impossible speed [m/s] without a second sign, which has no correction."""
    possible = []
    for unit in ("cm", "mm"):
        if config.position_min_froude < froude * UNITS[unit] < 1.0:
            possible.append(f"the positions are in {unit} ({speed * UNITS[unit]:.3g} m/s)")
    if config.position_min_froude < froude / UNITS["min"] < 1.0:
        possible.append(f"the times are in minutes ({speed / UNITS['min']:.3g} m/s)")
    if not possible:
        return []
    possible.append("the times are wrong otherwise")
    evidence = f"{too_fast}Either {', or '.join(possible)}. The log does not show which"
    return [Finding("position_unit", evidence, remedy=UNIT_REMEDY)]


def _turn_sign(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> list[tuple[float, str]]:
    """Factors of the positions by which the turns have a usual length, each with its words.

    The track per turned angle is a length in which the times have no part.
    """
    if not {"x_m", "y_m", "psi_rad"} <= recording.signals.keys():
        return []
    pose = np.array([recording[name] for name in ("x_m", "y_m", "psi_rad")])
    pose = pose[:, np.isfinite(pose).all(axis=0)]
    blocks = min(config.position_turn_blocks, pose.shape[1] - 1)
    if blocks < 2:
        return []
    pose[2] = np.unwrap(pose[2])
    edges = np.linspace(0, pose.shape[1] - 1, blocks + 1).astype(int)
    dx, dy, turned = np.diff(pose[:, edges], axis=1)
    total = float(np.abs(turned).sum())
    if total < config.position_min_turn:
        return []
    lengths = float(np.hypot(dx, dy).sum()) / total / vessel.length
    found = []
    for unit in ("m", "cm", "mm"):
        least, most = config.position_turn_lengths
        if least < lengths * UNITS[unit] < most:
            words = (
                f"In {unit} the track is {lengths * UNITS[unit]:.3g} lengths of the hull for each "
                "radian of turn, which is usual"
            )
            found.append((UNITS[unit], words))
    return found


def _recorded_speed_sign(
    recording: Recording, speed: float, config: ChecksConfig
) -> list[tuple[float, str]]:
    """The factor of the positions by which the track is as fast as recorded, with its words.

    The times have no part in a recorded speed. Without a factor another column is at fault.
    """
    if "u_mps" not in recording.signals:
        return []
    across = np.zeros(len(recording))
    if "v_mps" in recording.signals:
        across = np.nan_to_num(recording["v_mps"])
    recorded = np.hypot(recording["u_mps"], across)
    if not np.isfinite(recorded).any():
        return []
    usual = float(np.nanmedian(recorded))
    for unit in ("cm", "mm"):
        most = config.rates_unit_tolerance * usual
        if usual / config.rates_unit_tolerance < speed * UNITS[unit] < most:
            return [(UNITS[unit], f"In {unit} this is the recorded speed of {usual:.3g} m/s")]
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
