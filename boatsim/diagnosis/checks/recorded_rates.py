"""Check for recorded velocities that contradict the recorded positions.

Such a velocity has another sign or unit, a delay, or belongs to another point of the hull.
"""

import numpy as np

from boatsim.diagnosis.checks.finding import PLANAR_POSE, Change, Finding, delay_corrections
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.table import Recording

RATES = ("u_mps", "v_mps", "r_radps")
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
    for name in PLANAR_POSE:
        if name not in recording.signals or not np.isfinite(recording[name]).all():
            return []
    half = _half_window(recording, vessel, config)
    too_short = len(recording) < 4 * half + config.rates_min_rows
    if too_short or not set(RATES) & recording.signals.keys():
        return []
    differenced = _rates_of_poses(recording, half)
    found = []
    for name, rate in differenced.items():
        if name in recording.signals and np.isfinite(recording[name]).all():
            recorded = _moving_average(recording[name], half)[half : len(recording) - half]
            step = float(np.median(np.diff(recording.t)))
            yaw_rate = differenced["r_radps"]
            found += _compare(name, recorded, rate, yaw_rate, step, vessel, config)
    return found


def _half_window(recording: Recording, vessel: Vessel, config: ChecksConfig) -> int:
    """Rows on either side over which positions are differenced."""
    step = float(np.median(np.diff(recording.t)))
    return max(1, round(0.5 * config.rates_window * froude_time_scale(vessel) / step))


def _rates_of_poses(recording: Recording, k: int) -> dict[str, Array]:
    """Rates u, v, r (N - 2 k,) by central differences over k rows on either side."""
    rows = np.arange(k, len(recording) - k)
    span = recording.t[rows + k] - recording.t[rows - k]
    dx, dy, dpsi = ((recording[n][rows + k] - recording[n][rows - k]) / span for n in PLANAR_POSE)
    psi = _moving_average(recording["psi_rad"], k)[rows]
    c = np.cos(psi)
    s = np.sin(psi)
    return {"u_mps": c * dx + s * dy, "v_mps": c * dy - s * dx, "r_radps": dpsi}


def _moving_average(values: Array, k: int) -> Array:
    """Mean (N,) over k rows on either side; the first and last k values are unchanged."""
    total = np.concatenate(([0.0], np.cumsum(values)))
    mean = values.copy()
    mean[k:-k] = (total[2 * k + 1 :] - total[: -2 * k - 1])[: len(values) - 2 * k] / (2 * k + 1)
    return mean


def _compare(
    name: str,
    recorded: Array,
    rate: Array,
    yaw_rate: Array,
    step: float,
    vessel: Vessel,
    config: ChecksConfig,
) -> list[Finding]:
    if len(rate) < config.rates_min_rows or not recorded.std() > 0.0 or not rate.std() > 0.0:
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
        found = _check_delay(name, recorded, rate, step, vessel, config)
        if found:
            return found
    if name == "v_mps":
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


def _check_delay(
    name: str, recorded: Array, rate: Array, step: float, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    most = round(config.rates_max_delay * froude_time_scale(vessel) / step)
    shortest = round(config.rates_min_delay * froude_time_scale(vessel) / step)
    least = max(config.rates_min_delay_rows, shortest)
    if most <= least or len(rate) < config.rates_min_durations * most:
        return []
    residuals = {}
    for lag in range(-most, most + 1):
        shifted = recorded[most + lag : len(recorded) - most + lag]
        residuals[lag] = float(np.mean((shifted - rate[most:-most]) ** 2))
    best = min(residuals, key=lambda lag: residuals[lag])
    clear = residuals[best] <= config.rates_max_delay_residual * residuals[0]
    large = residuals[0] > config.rates_min_difference * float(np.mean(rate**2))
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
