"""Times counted in days since an epoch, as spreadsheets, MATLAB and astronomers count them."""

from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.clock_units import DAY

# Name -> 1970-01-01 [days]: of a spreadsheet since 1899-12-30, of MATLAB's datenum since the year 0
# (R2024a documentation), and of the Julian date since 4713 BC, noon
EPOCHS = {"": 25569.0, "MATLAB's datenum": 719529.0, "Julian dates": 2440587.5}
YEARS = (10957.0, 47482.0)  # [days] since 1970 of the years 2000 to 2100
# [days] A larger median step between rows, 43 s, is of no log; seconds have larger steps than this
MAX_STEP = 5e-4


class DayCount(NamedTuple):
    """Count of days: its name, "" for that of spreadsheets, and 1970-01-01 in it [days]."""

    name: str
    epoch: float

    def seconds(self, days: Array) -> Array:
        """Convert days (N,) to seconds since 1970 (N,)."""
        return (days - self.epoch) * DAY


def day_count(t: Array) -> DayCount | None:
    """Return how finite times (N,) are counted in days; None for other times.

    Two signs are needed: all are of the years 2000 to 2100, and the steps are far smaller than the
    rows of a log would be apart in seconds.

    Args:
        t: The times as logged.
    """
    if len(t) < 2 or not np.ptp(t) > 0.0:
        return None
    steps = np.abs(np.diff(t))
    if not float(np.median(steps[steps > 0.0])) < MAX_STEP:
        return None
    for name, epoch in EPOCHS.items():
        if epoch + YEARS[0] < t.min() and t.max() < epoch + YEARS[1]:
            return DayCount(name, epoch)
    return None
