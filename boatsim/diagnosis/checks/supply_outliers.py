"""Outliers of measured voltages and currents of a supply: interpolated, and counted in a remark."""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.current_outliers import CURRENT_OUTLIERS, current_outliers
from boatsim.diagnosis.checks.voltage_outliers import VOLTAGE_OUTLIERS, voltage_outliers
from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording


class Rule(NamedTuple):
    """Rule for the outliers of one quantity of a supply.

    Attributes:
        find: Returns which readings (N,) are outliers.
        phrase: Words of the remark.
        usual: Returns the usual value, which the remark states, of the other readings (N,).
    """

    find: Callable[[Array, ChecksConfig], NDArray[np.bool_]]
    phrase: str
    usual: Callable[[Array], float]


def _median(values: Array) -> float:
    return float(np.median(values))


def _largest(values: Array) -> float:
    return float(np.max(np.abs(values)))


# Unit of a measured quantity -> its rule
RULES = {
    "V": Rule(voltage_outliers, VOLTAGE_OUTLIERS, _median),
    "A": Rule(current_outliers, CURRENT_OUTLIERS, _largest),
}


def replace_supply_outliers(
    recording: Recording, vessel: Vessel, config: ChecksConfig = DEFAULT.checks
) -> Recording:
    """Return a recording whose measured voltages and currents are interpolated at outliers.

    Only columns in V and A that the vessel names in [measured] are changed. A column of which a
    large part are outliers is left as it is: the supply was off or another one was measured.

    Args:
        recording: A recording.
        vessel: The vessel that it is a recording of.
        config: Thresholds of the quality checks.

    Returns:
        The recording; its remarks count the values of each column that are replaced.
    """
    signals, remarks = dict(recording.signals), list(recording.remarks)
    for name in vessel.measured:
        unit = unit_of(name)
        if name not in signals or unit not in RULES:
            continue
        values, rule = signals[name], RULES[unit]
        outlier = rule.find(values, config)
        if not outlier.any():
            continue
        good = ~outlier
        signals[name] = np.interp(recording.t, recording.t[good], values[good])
        remarks.append(
            f"{recording.origin}: {name}: {int(outlier.sum())} of {len(values)} values "
            f"{rule.phrase} of {rule.usual(values[good]):.3g} {unit} (first at "
            f"{recording.t[outlier][0]:g} s); they are interpolated"
        )
    return replace(recording, signals=signals, remarks=tuple(remarks))
