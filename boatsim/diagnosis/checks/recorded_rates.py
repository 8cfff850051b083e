"""Check for recorded velocities that contradict the recorded positions.

Such a velocity has another sign or unit, a delay, or belongs to another point of the hull. Sensors
may have rates of their own: each rate is compared with the poses at times between neighbouring
samples of both, and never across a gap of a sensor. Delays are judged for all sensors together.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.equal_steps import equal_steps, moving_average, values_at_times
from boatsim.diagnosis.checks.finding import PLANAR_POSE, Change, Finding, delay_corrections
from boatsim.diagnosis.checks.late_by_kinematics import late_sensor_findings
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.table import Recording

RATES = ("u_mps", "v_mps", "r_radps")
NOT_BY_DELAY = ("velocity_sign", "velocity_unit")  # faults that are corrected before delays
SPEED_UNITS = ("kn", "kmh", "cmps")


def check_recorded_rates(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Find recorded velocities and turn rates that contradict the recorded positions and headings.

    A rate may have another sign, unit or latency, or belong to another point of the hull.

    Args:
        recording: A prepared recording.
        vessel: The vessel; its length scales lengths and durations.
        config: Thresholds of the quality checks.

    Returns:
        Findings "velocity_sign", "velocity_unit", "velocity_late" and "velocity_elsewhere".
    """
    found = []
    for name in RATES:
        compared = _sampled_comparison(recording, name, vessel, config)
        if compared is not None:
            found += _compare(compared, vessel, config)
    if any(finding.name in NOT_BY_DELAY for finding in found):
        return found
    return late_sensor_findings(recording, vessel, config) or found


@dataclass(frozen=True)
class _Comparison:
    """A recorded rate and the rate of the poses at equally spaced times.

    Attributes:
        name: Column of the rate.
        recorded: The recorded rate (N,), averaged; nan where it was not measured.
        rate: The rate of the poses (N,); nan where they were not measured.
        yaw_rate: The yaw rate of the poses (N,) [rad/s], likewise.
        step: Time between values [s].
        interval: Median time between samples of the slowest compared column [s].
    """

    name: str
    recorded: Array
    rate: Array
    yaw_rate: Array
    step: float
    interval: float

    @property
    def known(self) -> NDArray[np.bool_]:
        """Whether both rates are known, (N,)."""
        return np.isfinite(self.recorded) & np.isfinite(self.rate)


def _sampled_comparison(
    recording: Recording, name: str, vessel: Vessel, config: ChecksConfig
) -> _Comparison | None:
    """The comparison of a recorded rate; None if a column is missing or has too few samples."""
    poses: tuple[str, ...] = PLANAR_POSE
    if name == "r_radps":
        poses = ("psi_rad",)
    intervals = []
    for column in (name, *poses):
        if column not in recording.signals:
            return None
        sampled = recording.t[np.isfinite(recording[column])]
        if len(sampled) < config.rates_min_rows:
            return None
        intervals.append(float(np.median(np.diff(sampled))))
    t = equal_steps(recording.t)
    if not len(t):
        return None
    step = float(t[1] - t[0])
    interval = max(*intervals, step)
    window = 0.5 * config.rates_window * froude_time_scale(vessel)
    half = max(1, round(max(window, interval) / step))
    least = max(config.rates_min_rows, round(config.rates_min_rows * interval / step))
    if len(t) < 4 * half + config.rates_min_rows:
        return None
    columns = {}
    for column in (name, *poses):
        columns[column] = values_at_times(t, recording.t, recording[column], config)
    differenced = _rates_of_poses(t, columns, half)
    recorded = moving_average(columns[name], half)[half : len(t) - half]
    found = _Comparison(name, recorded, differenced[name], differenced["r_radps"], step, interval)
    if found.known.sum() < least:
        return None
    return found


def _rates_of_poses(t: Array, columns: dict[str, Array], k: int) -> dict[str, Array]:
    """Rates u, v, r (N - 2 k,) by central differences over k steps on either side."""
    rows = np.arange(k, len(t) - k)
    span = t[rows + k] - t[rows - k]
    moved = {}
    for name in PLANAR_POSE:
        if name in columns:
            moved[name] = (columns[name][rows + k] - columns[name][rows - k]) / span
    rates = {"r_radps": moved["psi_rad"]}
    if "x_m" in moved and "y_m" in moved:
        psi = moving_average(columns["psi_rad"], k)[rows]
        c = np.cos(psi)
        s = np.sin(psi)
        rates["u_mps"] = c * moved["x_m"] + s * moved["y_m"]
        rates["v_mps"] = c * moved["y_m"] - s * moved["x_m"]
    return rates


def _compare(compared: _Comparison, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    name = compared.name
    recorded = compared.recorded[compared.known]
    rate = compared.rate[compared.known]
    if not recorded.std() > 0.0 or not rate.std() > 0.0:
        return []
    correlation = float(np.corrcoef(recorded, rate)[0, 1])
    ratio = float(np.sqrt((rate @ rate) / (recorded @ recorded)))
    same_size = 1.0 / config.rates_size_ratio < ratio < config.rates_size_ratio
    if correlation < -config.rates_min_correlation and same_size:
        return [
            Finding(
                "velocity_sign",
                f"{name} has the opposite sign of the rate of x_m, y_m, psi_rad "
                f"(correlation {correlation:.2f})",
                probability=config.probability_evident,
                changes=(Change(name, name, -1.0),),
            )
        ]
    if correlation > config.rates_min_correlation and name != "r_radps" and not same_size:
        found = _check_unit(name, ratio, config)
        if found:
            return found
    if same_size and correlation > config.rates_min_delay_correlation:
        found = _check_delay(compared, vessel, config)
        if found:
            return found
    if name == "v_mps":
        yaw_rate = compared.yaw_rate[compared.known]
        return _check_lever(name, recorded, rate, yaw_rate, vessel, config)
    return []


def _check_unit(name: str, ratio: float, config: ChecksConfig) -> list[Finding]:
    tolerance = config.rates_unit_tolerance
    for unit in SPEED_UNITS:
        if 1.0 / tolerance < ratio / UNITS[unit] < tolerance:
            return [
                Finding(
                    "velocity_unit",
                    f"{name} is {1.0 / ratio:.3g} times the rate of x_m, y_m. It is in {unit}",
                    probability=config.probability_strong,
                    changes=(Change(name, name, UNITS[unit]),),
                )
            ]
    return []


def _check_delay(compared: _Comparison, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    name, step, rate = compared.name, compared.step, compared.rate
    recorded = compared.recorded
    most = round(config.rates_max_delay * froude_time_scale(vessel) / step)
    shortest = round(config.rates_min_delay * froude_time_scale(vessel) / step)
    rows = round(config.rates_min_delay_rows * compared.interval / step)
    least = max(rows, shortest)
    if most <= least or compared.known.sum() < config.rates_min_durations * most:
        return []
    lags = range(-most, most + 1)
    known = np.isfinite(rate[most:-most])
    for lag in lags:
        known &= np.isfinite(recorded[most + lag : len(recorded) - most + lag])
    if known.sum() < config.rates_min_rows * compared.interval / step:
        return []
    true = rate[most:-most][known]
    residuals = {}
    for lag in lags:
        shifted = recorded[most + lag : len(recorded) - most + lag][known]
        residuals[lag] = float(np.mean((shifted - true) ** 2))
    best = min(residuals, key=lambda lag: residuals[lag])
    clear = residuals[best] <= config.rates_max_delay_residual * residuals[0]
    large = residuals[0] > config.rates_min_difference * float(np.mean(rate[compared.known] ** 2))
    if abs(best) < least or abs(best) == most or not clear or not large:
        return []
    removed = 100.0 * (1.0 - residuals[best] / residuals[0])
    delay = abs(best) * step
    late, others, alternatives = _late_columns(name, best > 0, delay)
    sense = "behind" if best > 0 else "ahead of"
    return [
        Finding(
            "velocity_late",
            f"{name} is {delay:.3g} s {sense} {others}. This delay explains {removed:.0f} % of "
            "their difference",
            probability=config.probability_likely,
            changes=delay_corrections(late, delay),
            alternatives=alternatives,
        )
    ]


def _late_columns(
    name: str, behind: bool, delay: float
) -> tuple[tuple[str, ...], str, tuple[tuple[str, tuple[Change, ...]], ...]]:
    """Late columns, those that a rate is compared with, and other columns that may be late.

    No instrument is early: where a rate is ahead of a pose, the pose is late.
    """
    if name == "r_radps":
        if behind:
            return (name,), "psi_rad", ()
        words = "x_m and y_m come from the same instrument as psi_rad"
        return ("psi_rad",), "psi_rad", ((words, delay_corrections(PLANAR_POSE, delay)),)
    if behind:
        return (name,), "x_m, y_m, psi_rad", ()
    return ("x_m", "y_m"), "x_m, y_m, psi_rad", ()


def _check_lever(
    name: str,
    recorded: Array,
    rate: Array,
    yaw_rate: Array,
    vessel: Vessel,
    config: ChecksConfig,
) -> list[Finding]:
    difference = recorded - rate
    A = np.column_stack([yaw_rate, np.ones_like(yaw_rate)])
    (lever, _), *_ = np.linalg.lstsq(A, difference, rcond=None)
    before = float(np.var(difference))
    after = float(np.var(difference - A[:, 0] * lever))
    if abs(lever) < config.rates_min_lever * vessel.length:
        return []
    if after > config.rates_max_lever_residual * before:
        return []
    if before < config.rates_min_difference * float(np.mean(rate**2)):
        return []
    side = "ahead of" if lever > 0.0 else "behind"
    return [
        Finding(
            "velocity_elsewhere",
            f"{name} is the velocity of a point {abs(lever):.3g} m {side} the point of x_m, y_m",
            probability=config.probability_likely,
            changes=(_ignore_column(name),),
        )
    ]


def _ignore_column(name: str) -> Change:
    """Change that gives a column a name that is not used in a fit."""
    return Change(f"estimate_{name}", name)
