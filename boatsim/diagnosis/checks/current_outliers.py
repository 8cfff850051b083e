"""Outliers of measured electric currents: single readings far from those around them."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.physics.base import Array

CURRENT_OUTLIERS = "jump from the readings around them by more than the largest current"


def current_outliers(values: Array, config: ChecksConfig = DEFAULT.checks) -> NDArray[np.bool_]:
    """Return which readings of an electric current are outliers.

    The current of a drive varies between zero and its largest one, so that no reading is far from
    the usual one. An outlier differs from the median of the readings around it by more than the
    largest of these medians.

    Args:
        values: Currents (N,) [A]; nan where nothing was measured.
        config: Thresholds of the quality checks.

    Returns:
        True (N,) for outliers; none where they are too large a part of the readings, or where the
        usual current is zero.
    """
    known = np.isfinite(values)
    rows = config.current_rows
    if known.sum() < rows:
        return np.zeros(len(values), dtype=np.bool_)
    readings = values[known]
    half = rows // 2
    around = sliding_window_view(np.pad(readings, half, mode="reflect"), 2 * half + 1)
    smooth = np.median(around, axis=1)
    largest = float(np.max(np.abs(smooth)))
    outlier = ~known
    outlier[known] = np.abs(readings - smooth) > config.current_largest_jump * largest
    if largest == 0.0 or outlier.mean() > config.current_outlier_share:
        return np.zeros(len(values), dtype=np.bool_)
    return outlier
