"""Outliers of positions and headings: one or several fixes that leave the course and return to it.

The filter gives a single outlier little weight, but several in a row would look like motion.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.position_jumps import excursions, jump_rows
from boatsim.diagnosis.config import DEFAULT, ChecksConfig, DiagnosisConfig
from boatsim.diagnosis.priors import estimate_sensor_noise, froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

NO_VALUES = np.zeros(0)
PARABOLA, CUBIC = 3, 4  # numbers of coefficients
NOISE_FAMILIES = {
    "x_m": "position_sd_m",
    "y_m": "position_sd_m",
    "psi_rad": "heading_sd_rad",
}


def drop_position_outliers(
    recording: Recording, vessel: Vessel, config: DiagnosisConfig = DEFAULT
) -> Recording:
    """Return a recording without outliers of its positions and headings.

    Args:
        recording: A prepared recording.
        vessel: The vessel; its length scales distances and durations.
        config: Settings; the groups `checks` and `load` are used.

    Returns:
        The recording from its first row that is no outlier; outliers are nan, and remarks count
        them.
    """
    first = outlier_rows_at_start(recording, vessel, config)
    if first:
        kept = recording.between(float(recording.t[first]), float(recording.t[-1]))
        remark = (
            f"{recording.origin}: the rows before t = {recording.t[first]:g} s are "
            "off the course of the following fixes and are not used"
        )
        recording = replace(kept, remarks=(*kept.remarks, remark))
    signals = dict(recording.signals)
    remarks = list(recording.remarks)
    duration = config.checks.outlier_max_duration * froude_time_scale(vessel)
    for names, scale in ((("x_m", "y_m"), vessel.length), (("psi_rad",), 1.0)):
        if not set(names) <= signals.keys():
            continue
        values = np.column_stack([signals[n] for n in names])
        finest = config.load.finest_noise * scale
        outlier = outlier_rows(recording.t, values, finest, duration, config.checks)
        values[outlier] = np.nan
        outlier |= excursion_rows(recording.t, values, config.checks)
        if outlier.any():
            remarks.append(
                f"{recording.origin}: {', '.join(names)} jump away and return "
                f"({int(outlier.sum())} of {len(recording)} rows, first at "
                f"{recording.t[outlier][0]:g} s); these values are not used"
            )
            signals |= {n: np.where(outlier, np.nan, signals[n]) for n in names}
    return replace(recording, signals=signals, remarks=tuple(remarks))


def outlier_rows_at_start(
    recording: Recording, vessel: Vessel, config: DiagnosisConfig = DEFAULT
) -> int:
    """Return the number of rows to drop because a recording begins with outliers of its position.

    A Kalman filter starts from the first fix and cannot reject it. Each of the first fixes is
    therefore compared with a parabola and a cubic through the fixes after it.

    Args:
        recording: A prepared recording.
        vessel: The vessel, for the noise of its sensors.
        config: Settings; the groups `checks` and `load` are used.
    """
    fitted = config.checks.start_course_fixes
    dropped = 0
    for name, family in NOISE_FAMILIES.items():
        column = recording.signals.get(name, NO_VALUES)
        known = np.flatnonzero(np.isfinite(column))[: config.checks.start_max_outliers + fitted]
        if len(known) <= fitted:
            continue
        # values that an instrument holds while nothing moves hide its noise
        specified = recording.notes.noise.get(family, 0.0)
        noise = max(specified, estimate_sensor_noise(vessel, [recording], family, config.load))
        for first in range(len(known) - fitted):
            rows = known[first : first + fitted + 1]
            t = recording.t[rows] - recording.t[rows[0]]
            if _is_off_course(t, column[rows], noise, config.checks):
                dropped = max(dropped, int(rows[0]) + 1)
    return dropped


def _is_off_course(t: Array, y: Array, noise: float, config: ChecksConfig) -> bool:
    """Whether the first of some fixes is off the parabola and the cubic through the others.

    The start of a manoeuvre may be a cubic: a parabola holds for a constant acceleration.
    """
    for coefficients in PARABOLA, CUBIC:
        powers = np.vander(t[1:], coefficients)  # the last one is the value at the first fix
        inverse = np.linalg.pinv(powers.T @ powers)
        course = inverse @ (powers.T @ y[1:])
        freedom = len(t) - 1 - coefficients
        residual = float(np.sqrt(np.sum((y[1:] - powers @ course) ** 2) / freedom))
        limit = config.start_min_sds * max(noise, residual) * np.sqrt(1.0 + inverse[-1, -1])
        if abs(y[0] - course[-1]) <= limit:
            return False
    return True


def outlier_rows(
    t: Array, values: Array, finest: float, duration: float, config: ChecksConfig = DEFAULT.checks
) -> NDArray[np.bool_]:
    """Return which rows of signals are outliers: they leave the trend and return to it soon.

    The trend is predicted from the rows before.

    Args:
        t: Times (N,) [s].
        values: Values (N, C); nan where nothing was measured.
        finest: Least sd of a prediction over one step, in the unit of the values.
        duration: Outliers last less than this time [s].
        config: Thresholds of the quality checks.

    Returns:
        True (N,) for outliers.
    """
    before = config.outlier_speed_fixes
    known = np.flatnonzero(np.isfinite(values).all(axis=1))
    outlier = np.zeros(len(t), dtype=np.bool_)
    if len(known) <= 2 * before:
        return outlier
    t = t[known]
    y = values[known]
    step = float(np.median(np.diff(t)))
    if len(t) <= 2 * duration / step:
        return outlier
    jump = _smallest_jump(t, y, finest, config)
    acceleration = _allowed_acceleration(y, step, duration, config)
    k = before
    while k < len(t):
        since = t[k - before : k] - t[k - before : k].mean()
        middle = y[k - before : k].mean(axis=0)
        speed = since @ y[k - before : k] / (since @ since)
        ahead = slice(k, k + config.outlier_search_rows)
        gap = t[ahead] - t[k - 1]
        off = y[ahead] - middle - speed * (gap + since[-1])[:, None]
        slack = 1.0 + config.outlier_speed_slack * (gap / step - 1.0)
        fits = np.abs(off).max(axis=1) < jump * slack + acceleration * gap**2
        back = int(np.argmax(fits))
        if back and gap[back] < duration and _returns(off, fits, back, jump, config):
            outlier[known[k : k + back]] = True
            share = (gap[:back] / gap[back])[:, None]
            y[k : k + back] = (1.0 - share) * y[k - 1] + share * y[k + back]
            k += back
        k += 1
    return outlier


def excursion_rows(
    t: Array, values: Array, config: ChecksConfig = DEFAULT.checks
) -> NDArray[np.bool_]:
    """Return which rows lie between a jump and a later one that takes it back.

    They may last longer than outliers, because two jumps within one row each are no motion.

    Args:
        t: Times (N,) [s].
        values: Values (N, C); nan where nothing was measured.
        config: Thresholds of the quality checks.

    Returns:
        True (N,) for these rows.
    """
    known = np.flatnonzero(np.isfinite(values).all(axis=1))
    away = np.zeros(len(t), dtype=np.bool_)
    rows = jump_rows(t[known], values[known], config)
    for begin, end in excursions(t[known], values[known], rows, config):
        away[known[begin + 1 : end + 1]] = True
    return away


def _smallest_jump(t: Array, y: Array, finest: float, config: ChecksConfig) -> float:
    """Deviation from a prediction over one step above which a value is an outlier."""
    ratio = ((t[2:] - t[1:-1]) / (t[1:-1] - t[:-2]))[:, None]
    expected = y[1:-1] + (y[1:-1] - y[:-2]) * ratio
    errors = np.abs(y[2:] - expected).max(axis=1)
    # for a normal variable the default quantile lies at two standard deviations
    sd = 0.5 * float(np.quantile(errors, config.outlier_noise_quantile))
    return config.outlier_min_sds * max(sd, finest)


def _allowed_acceleration(y: Array, step: float, duration: float, config: ChecksConfig) -> float:
    """Acceleration that the boat may have had, in the unit of the values per s^2."""
    wide = max(1, round(0.5 * duration / step))
    bend = np.abs(y[2 * wide :] - 2.0 * y[wide:-wide] + y[: -2 * wide]).max(axis=1)
    return config.outlier_max_acceleration * float(np.median(bend)) / (wide * step) ** 2


def _returns(
    off: Array, fits: NDArray[np.bool_], back: int, jump: float, config: ChecksConfig
) -> bool:
    """Whether the values return to the course by a jump in row `back` and stay there."""
    last = np.abs(off[back - 1]).max()
    returned = np.abs(off[back]).max()
    stays = fits[back : back + config.outlier_return_fixes].all()
    return bool(last - returned > max(jump, config.outlier_min_return * last) and stays)
