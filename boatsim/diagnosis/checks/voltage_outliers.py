"""Outliers of measured voltages: readings that no supply of a running drive has."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.physics.base import Array

VOLTAGE_OUTLIERS = "are far from the usual voltage"  # phrase of the remark


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
