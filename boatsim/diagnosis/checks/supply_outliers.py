"""Outliers of measured voltages and currents of a supply: interpolated, and counted in a remark."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.known_values import filled
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording

VOLTAGE_OUTLIERS = "are far from the usual voltage"  # phrase of the remark
CURRENT_OUTLIERS = "jump from the readings around them by more than the largest current"
UNITS = ("V", "A")
ROUNDING = 1e-6  # of a number of rows, by steps such as 0.1 s


def replace_supply_outliers(
    recording: Recording, vessel: Vessel, config: ChecksConfig = DEFAULT.checks
) -> Recording:
    """Return a recording whose measured voltages and currents are interpolated at outliers.

    Only columns in V and A that the vessel names in [measured] are changed. A column of which a
    large part are outliers keeps them: the supply was off or another one was measured. Values that
    were not measured are interpolated, too; they are no outliers.

    Args:
        recording: A recording.
        vessel: The vessel that it is a recording of.
        config: Thresholds of the quality checks.

    Returns:
        The recording; its remarks count the outliers of each column.
    """
    signals, remarks = dict(recording.signals), list(recording.remarks)
    for name in vessel.measured:
        if name not in signals or unit_of(name) not in UNITS:
            continue
        values = signals[name]
        known = np.isfinite(values)
        if not known.any():
            continue
        t = recording.t[known]
        readings = values[known]
        outlier, sentence = _outliers(t, readings, unit_of(name), vessel, config)
        if known.all() and not outlier.any():
            continue
        cleaned = values.copy()
        cleaned[known] = np.where(outlier, np.nan, readings)
        signals[name] = filled(recording.t, cleaned)
        if outlier.any():
            remarks.append(
                f"{recording.origin}: {name}: {int(outlier.sum())} of {len(readings)} values "
                f"{sentence} (first at {t[outlier][0]:g} s); they are interpolated"
            )
    return replace(recording, signals=signals, remarks=tuple(remarks))


def _outliers(
    t: Array, readings: Array, unit: str, vessel: Vessel, config: ChecksConfig
) -> tuple[NDArray[np.bool_], str]:
    """Outliers (N,) of the readings of a column, and the words of the remark about them."""
    if unit == "V":
        outlier = voltage_outliers(readings, config)
        usual = float(np.median(readings[~outlier]))
        return outlier, f"{VOLTAGE_OUTLIERS} of {usual:.3g} V"
    outlier = current_outliers(t, readings, froude_time_scale(vessel), config)
    largest = float(np.max(np.abs(readings[~outlier])))
    return outlier, f"{CURRENT_OUTLIERS} of {largest:.3g} A"


def voltage_outliers(readings: Array, config: ChecksConfig = DEFAULT.checks) -> NDArray[np.bool_]:
    """Return which readings of a voltage are outliers.

    Args:
        readings: Voltages (N,) [V] without gaps.
        config: Thresholds of the quality checks.

    Returns:
        True (N,) for outliers; none where they are too large a part of the readings.
    """
    usual = float(np.median(readings))
    low, high = config.voltage_least_share * usual, config.voltage_largest_share * usual
    outlier = (readings < low) | (readings > high)
    return outlier & _are_few(outlier, config.voltage_outlier_share) & (usual > 0.0)


def current_outliers(
    t: Array, readings: Array, time_scale: float = 1.0, config: ChecksConfig = DEFAULT.checks
) -> NDArray[np.bool_]:
    """Return which readings of an electric current are outliers.

    The current of a drive varies between zero and its largest one, so that no reading is far from
    the usual one. An outlier differs from the median of the readings around it by more than the
    largest of these medians. In a slow log fewer readings are used, at least three: the median of
    three differs from the middle one only if this differs from both neighbours. A burst of thrust
    may there be a single reading; if it repeats, it is no outlier.

    Args:
        t: Times (N,) of the readings [s].
        readings: Currents (N,) [A] without gaps.
        time_scale: Factor by which times are longer than on a hull of 1.2 m.
        config: Thresholds of the quality checks.

    Returns:
        True (N,) for outliers; none where they are too large a part of the readings, or where the
        usual current is zero.
    """
    if len(readings) < config.current_rows:
        return np.zeros(len(readings), dtype=np.bool_)
    step = float(np.median(np.diff(t)))
    usual = config.current_rows // 2
    fitting = int(config.current_window * time_scale / step + ROUNDING) // 2
    half = max(min(usual, fitting), 1)
    beyond_ends = "mirror" if half > 1 else "nearest"  # an end has one neighbour only
    around: Array = median_filter(readings, 2 * half + 1, mode=beyond_ends)
    largest = float(np.max(np.abs(around[half:-half])))  # the ends count readings twice
    jump = np.abs(readings - around)
    outlier = jump > config.current_largest_jump * largest
    if fitting < usual:
        outlier[outlier] = ~_repeat(jump[outlier], config.current_repeated_ratio)
    return outlier & _are_few(outlier, config.current_outlier_share) & (largest > 0.0)


def _repeat(sizes: Array, ratio: float) -> NDArray[np.bool_]:
    """Which of some sizes (N,) another one equals within a ratio."""
    order = np.argsort(sizes)
    alike = sizes[order][1:] < ratio * sizes[order][:-1]
    repeat = np.zeros(len(sizes), dtype=np.bool_)
    repeat[order[1:]] = alike
    repeat[order[:-1]] |= alike
    return repeat


def _are_few(outlier: NDArray[np.bool_], share: float) -> bool:
    """Whether outliers (N,) are at most a share of the readings: more are no errors of rows."""
    return float(np.mean(outlier)) <= share
