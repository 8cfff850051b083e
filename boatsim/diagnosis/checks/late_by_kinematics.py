"""Which sensors of a recording are late, given their delays against each other.

Only differences of delays are known. The fewest sensors whose delays explain all of them are the
late ones; of two halves it is the one that is behind.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from boatsim.diagnosis.checks.finding import PLANAR_POSE, Finding, delay_corrections
from boatsim.diagnosis.checks.sensor_delays import (
    HEADING,
    POSITIONS,
    SENSORS,
    SensorDelay,
    sensor_delays,
)
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

LEAST_VARIANCE = 1e-8  # [s^2] so that the heading, to which all delays refer, has a finite weight


@dataclass(frozen=True)
class _Sensor:
    """A sensor with its delay against the others.

    Attributes:
        name: Name in `SENSORS`.
        delay: Delay behind the heading [s].
        variance: Its variance [s^2].
        least: Smallest delay that is reported [s].
        reference: Name of the sensor with which it was compared; the heading has itself.
        unexplained: Share of their mean square difference that the delays leave.
    """

    name: str
    delay: float
    variance: float
    least: float
    reference: str
    unexplained: float

    def differs(self, other: "_Sensor", config: ChecksConfig) -> bool:
        """Return whether both sensors certainly have different delays."""
        sd = float(np.sqrt(self.variance + other.variance))
        least = max(self.least, other.least, config.sensor_delay_sds * sd)
        return abs(self.delay - other.delay) > least


def late_sensor_findings(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Find sensors that are late against the other sensors of a recording.

    Args:
        recording: A prepared recording.
        vessel: The vessel; its length scales durations.
        config: Thresholds of the quality checks.

    Returns:
        A finding "velocity_late" for each delay, with the columns that have it.
    """
    scale = froude_time_scale(vessel)
    window, longest = config.rates_window * scale, config.rates_max_delay * scale
    delays = sensor_delays(recording, window, longest, config)
    if not delays:
        return []
    least = _least_delays(recording, scale, config)
    sensors = _sensors(delays, least, config)
    late = _fewest_late(sensors, config)
    if not late:
        return []
    others = [sensor for sensor in sensors if sensor not in late]
    found = []
    for together in _with_equal_delays(late, config):
        found.append(_finding(together, others, config))
    if len(sensors) == 2 and late[0].name == HEADING and "x_m" in recording.signals:
        words = "x_m and y_m come from the same instrument as psi_rad"
        changes = delay_corrections(PLANAR_POSE, found[0].changes[0].delay)
        found[0] = replace(found[0], alternatives=((words, changes),))
    return found


def _least_delays(recording: Recording, scale: float, config: ChecksConfig) -> dict[str, float]:
    """Smallest delay [s] that is reported of each sensor."""
    step = float(np.median(np.diff(recording.t)))
    found = {}
    for name, columns in SENSORS.items():
        if columns[0] not in recording.signals:
            continue
        sampled = recording.t[np.isfinite(recording[columns[0]])]
        interval = float(np.median(np.diff(sampled))) if len(sampled) > 1 else step
        found[name] = max(
            config.rates_min_delay * scale,
            config.rates_min_delay_rows * step,
            config.sensor_delay_min_intervals * interval,
        )
    return found


def _sensors(
    delays: Sequence[SensorDelay], least: dict[str, float], config: ChecksConfig
) -> list[_Sensor]:
    """The sensors with their delays behind the heading, as far as these explain a difference."""
    known = {(one.sensor, one.behind): one for one in delays}
    heading = _Sensor(HEADING, 0.0, 0.0, least.get(HEADING, 0.0), HEADING, 0.0)
    found = [heading]
    for (sensor, behind), one in known.items():
        if sensor == HEADING and _explains(delays, behind, least, config):
            own = least[behind]
            found.append(_Sensor(behind, -one.seconds, one.sd**2, own, HEADING, one.unexplained))
    for reference in list(found):
        position = known.get((POSITIONS, reference.name))
        if position is not None:
            variance = reference.variance + position.sd**2
            delay = reference.delay + position.seconds
            own = least[POSITIONS]
            found.append(
                _Sensor(POSITIONS, delay, variance, own, reference.name, position.unexplained)
            )
    return found


def _explains(
    delays: Sequence[SensorDelay], behind: str, least: dict[str, float], config: ChecksConfig
) -> bool:
    """Whether delays behind a sensor are small, or explain most of the difference."""
    own = [one for one in delays if one.behind == behind]
    small = all(abs(one.seconds) < max(least[one.sensor], least[behind]) for one in own)
    return small or own[0].unexplained <= config.rates_max_delay_residual


def _fewest_late(sensors: Sequence[_Sensor], config: ChecksConfig) -> list[_Sensor]:
    """The fewest sensors without which all others have the same delay; [] if all have it."""
    if not any(a.differs(b, config) for a, b in combinations(sensors, 2)):
        return []
    for count in range(1, len(sensors) // 2 + 1):
        found = list[list[_Sensor]]()
        for late in combinations(sensors, count):
            others = [sensor for sensor in sensors if sensor not in late]
            equal = not any(a.differs(b, config) for a, b in combinations(others, 2))
            apart = all(a.differs(b, config) for a in late for b in others)
            if equal and apart:
                found.append(list(late))
        if found:
            return max(found, key=lambda late: float(np.mean([one.delay for one in late])))
    return []


def _with_equal_delays(late: Sequence[_Sensor], config: ChecksConfig) -> list[list[_Sensor]]:
    """Late sensors in groups of equal delays."""
    found = list[list[_Sensor]]()
    for sensor in late:
        for together in found:
            if not any(sensor.differs(other, config) for other in together):
                together.append(sensor)
                break
        else:
            found.append([sensor])
    return found


def _finding(late: Sequence[_Sensor], others: Sequence[_Sensor], config: ChecksConfig) -> Finding:
    """The finding about sensors with one delay behind the others."""
    own, usual = _mean(late), _mean(others)
    seconds = own[0] - usual[0]
    sd = float(np.sqrt(own[1] + usual[1]))
    columns = _columns(late)
    verb, sense = "is", "behind"
    if len(columns) > 1:
        verb = "are"
    if seconds < 0.0:
        sense = "ahead of"
    removed = 100.0 * (1.0 - _unexplained(late, others))
    return Finding(
        "velocity_late",
        f"{', '.join(columns)} {verb} {abs(seconds):.3f} +- {sd:.3f} s {sense} "
        f"{', '.join(_columns(others))}. This delay explains {removed:.0f} % of their difference",
        probability=config.probability_likely,
        changes=delay_corrections(columns, seconds),
    )


def _unexplained(late: Sequence[_Sensor], others: Sequence[_Sensor]) -> float:
    """Largest share that the delays leave of a difference between a late sensor and another one.

    Sensors that were compared with each other and have the same delay differ by noise alone.
    """
    names = {one.name for one in late}
    shares = []
    for one in (*late, *others):
        if (one.name in names) != (one.reference in names):
            shares.append(one.unexplained)
    return max(shares, default=1.0)  # no pair shows what the delays explain


def _mean(sensors: Sequence[_Sensor]) -> tuple[float, float]:
    """Mean delay [s] of sensors by their precision, and the largest of their variances [s^2]."""
    precision = [1.0 / max(one.variance, LEAST_VARIANCE) for one in sensors]
    delay = float(np.average([one.delay for one in sensors], weights=precision))
    return delay, max(one.variance for one in sensors)


def _columns(sensors: Sequence[_Sensor]) -> tuple[str, ...]:
    """Columns of sensors in the order of `SENSORS`."""
    names = {one.name for one in sensors}
    found = list[str]()
    for name, columns in SENSORS.items():
        if name in names:
            found += columns
    return tuple(found)
