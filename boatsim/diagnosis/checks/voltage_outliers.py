"""Outliers of measured voltages: readings that no supply of a running drive has."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording

OUTLIERS = "are far from the usual voltage"  # phrase of the remark


def replace_voltage_outliers(
    recording: Recording, vessel: Vessel, config: ChecksConfig = DEFAULT.checks
) -> Recording:
    """Return a recording whose measured voltages are interpolated where they are outliers.

    Only columns in V that the vessel names in [measured] are changed. A column of which a large
    part is far from its median is left as it is: the supply was off or another one was measured.

    Args:
        recording: A recording.
        vessel: The vessel that it is a recording of.
        config: Thresholds of the quality checks.

    Returns:
        The recording; its remarks count the values of each column that are replaced.
    """
    signals, remarks = dict(recording.signals), list(recording.remarks)
    for name in vessel.measured:
        if name not in signals or unit_of(name) != "V":
            continue
        values = signals[name]
        outlier = voltage_outliers(values, config)
        if not outlier.any():
            continue
        good = ~outlier
        signals[name] = np.interp(recording.t, recording.t[good], values[good])
        remarks.append(
            f"{recording.origin}: {name}: {int(outlier.sum())} of {len(values)} values {OUTLIERS} "
            f"of {np.median(values[good]):.3g} V (first at {recording.t[outlier][0]:g} s); they "
            "are interpolated"
        )
    return replace(recording, signals=signals, remarks=tuple(remarks))


def voltage_outliers(values: Array, config: ChecksConfig = DEFAULT.checks) -> NDArray[np.bool_]:
    """Return which readings of a voltage are outliers.

    Args:
        values: Voltages (N,) [V]; nan where nothing was measured.
        config: Thresholds of the quality checks.

    Returns:
        True (N,) for outliers; none where they are too large a part of the readings.
    """
    usual = np.nanmedian(values) if np.isfinite(values).any() else 0.0
    low, high = config.voltage_least_share * usual, config.voltage_largest_share * usual
    outlier = ~((values >= low) & (values <= high))
    if usual <= 0.0 or outlier.mean() > config.voltage_outlier_share:
        return np.zeros(len(values), dtype=np.bool_)
    return np.asarray(outlier, dtype=np.bool_)
