"""Check of the clock of the poses against accelerometers that felt the same motion.

A camera, a GNSS receiver or a motion capture system has a computer and a clock of its own. Its
poses may then be late, and its clock may run fast or slow, in each recording by another amount.
Accelerometers that are sampled together with the inputs show when the motion happened: the second
derivative of the pose must equal their signal at one and the same time.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize

from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.signals import POSE
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

# pose -> accelerometer that feels its second derivative. Surge and sway are left out: an
# accelerometer along them also measures gravity times the inclination.
WITNESSES = {
    "z_m": "sensed_z_mps2",
    "phi_rad": "sensed_phi_radps2",
    "theta_rad": "sensed_theta_radps2",
    "psi_rad": "sensed_psi_radps2",
}
POSE_CLOCK = "on a clock of their own"  # phrase of the remark, by which the finding is recognised


@dataclass(frozen=True)
class ClockError:
    """Error of the clock of the poses of one recording against the accelerometers.

    The pose that is stamped t + delay + rate (t - middle) was true at t.
    """

    delay: float  # [s] in the middle of the recording, positive: the poses are stamped too late
    rate: float  # [-] by which the clock of the poses runs fast
    middle: float  # [s]
    correlation: float  # of both accelerations with the corrected clock
    recorded_correlation: float  # and with the recorded one

    def delay_at(self, t: Array) -> Array:
        """Return the delay (N,) of the poses at some times.

        Args:
            t: Times (N,) of the accelerometers [s].
        """
        return np.asarray(self.delay + self.rate * (t - self.middle))


@dataclass(frozen=True)
class _Pair:
    """Second derivative of a pose as a function of time, and the accelerometer in each row."""

    pose: CubicSpline
    witness: Array


def correct_pose_clock(recording: Recording, vessel: Vessel, config: ChecksConfig) -> Recording:
    """Return a recording whose poses stand at the times at which accelerometers felt the motion.

    Poses are interpolated by a cubic spline. The recording is unchanged if it has no accelerometers
    named in `WITNESSES`, or if these agree with its poses.

    Args:
        recording: A recording.
        vessel: The vessel; its length scales times.
        config: Thresholds of the quality checks.

    Returns:
        The recording; a remark states the correction.
    """
    error = pose_clock_error(recording, vessel, config)
    if error is None:
        return recording
    stamps = recording.t + error.delay_at(recording.t)
    signals = dict(recording.signals)
    for name in POSE:
        if name in signals:
            signals[name] = _interpolated(recording.t, signals[name], stamps)
    begin, end = error.delay_at(recording.t[[0, -1]]).tolist()
    names = ", ".join(_witnesses(recording).values())
    remark = (
        f"{recording.origin}: the poses are {POSE_CLOCK}: they are "
        f"{begin:+.2f} s late at the beginning and {end:+.2f} s at the end, as the accelerometers "
        f"show ({names}; correlation with the second derivative "
        f"{error.recorded_correlation:.3f} as recorded, {error.correlation:.3f} corrected)"
    )
    return replace(recording, signals=signals, remarks=(*recording.remarks, remark))


def pose_clock_error(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> ClockError | None:
    """Return the error of the clock of the poses, or None if accelerometers show none.

    Args:
        recording: A recording.
        vessel: The vessel; its length scales times.
        config: Thresholds of the quality checks.
    """
    pairs = _pairs(recording, config)
    if not pairs:
        return None
    t = recording.t
    middle = 0.5 * float(t[0] + t[-1])
    longest = config.pose_clock_max_delay * froude_time_scale(vessel)

    def correlation_at_delay(delay: float, rate: float) -> float:
        stamps = t + delay + rate * (t - middle)
        inside = (stamps >= t[0]) & (stamps <= t[-1])
        if inside.sum() < config.pose_clock_min_rows:
            return -1.0
        found = []
        for pair in pairs:
            found.append(_correlation(pair.pose(stamps[inside]), pair.witness[inside]))
        return float(np.mean(found))

    recorded = correlation_at_delay(0.0, 0.0)
    best = _best_clock(correlation_at_delay, longest, config)
    found = correlation_at_delay(*best)
    unexplained = (1.0 - found) / max(1.0 - recorded, 1e-12)
    if found < config.pose_clock_min_correlation or unexplained > config.pose_clock_max_unexplained:
        return None
    return ClockError(best[0], best[1], middle, found, recorded)


def _best_clock(
    correlation: Callable[[float, float], float], longest: float, config: ChecksConfig
) -> tuple[float, float]:
    """Delay [s] and rate of the largest correlation; of nearly equal ones the smallest delay.

    A steady oscillation is the same after a period, so that delays that differ by one are told
    apart only by the beginning and the end of the motion.
    """
    rates = config.pose_clock_max_rate * np.linspace(-1.0, 1.0, 2 * config.pose_clock_rates + 1)
    delays = np.arange(-longest, longest + 1e-9, config.pose_clock_step)
    values = np.array([[correlation(d, r) for r in rates] for d in delays])
    by_delay = values.max(axis=1)
    around = config.pose_clock_neighbours
    refined = []
    for i, value in enumerate(by_delay.tolist()):
        highest = value == by_delay[max(0, i - around) : i + around + 1].max()
        if highest and value > by_delay.max() - config.pose_clock_near:
            start = (float(delays[i]), float(rates[int(np.argmax(values[i]))]))
            refined.append(_refined_clock(correlation, start, config))
    best = max(value for value, _ in refined)
    equal = [clock for value, clock in refined if value > best - config.pose_clock_tie]
    return min(equal, key=lambda clock: abs(clock[0]))


def _refined_clock(
    correlation: Callable[[float, float], float],
    start: tuple[float, float],
    config: ChecksConfig,
) -> tuple[float, tuple[float, float]]:
    """Largest correlation near a delay [s] and a rate, and where it is."""
    scale = np.array([config.pose_clock_step, config.pose_clock_max_rate])
    found = minimize(
        lambda x: -correlation(*(start + scale * x)),
        np.zeros(2),
        method="Nelder-Mead",
        options={"xatol": 1e-3, "fatol": 1e-6},
    )
    delay, rate = start + scale * found.x
    return -float(found.fun), (float(delay), float(rate))


def _witnesses(recording: Recording) -> dict[str, str]:
    """Accelerometers of a recording by the pose whose second derivative they feel."""
    found: dict[str, str] = {}
    for pose, witness in WITNESSES.items():
        if {pose, witness} <= recording.signals.keys():
            found[pose] = witness
    return found


def _pairs(recording: Recording, config: ChecksConfig) -> list[_Pair]:
    """Pairs of a pose and its accelerometer in which both vary alike in size."""
    t = recording.t
    if len(t) < config.pose_clock_min_rows:
        return []
    step = float(np.median(np.diff(t)))
    if np.ptp(np.diff(t)) > config.pose_clock_max_jitter * step:
        return []  # spectra need equal steps
    pairs = []
    for pose, witness in _witnesses(recording).items():
        values, felt = recording[pose], recording[witness]
        measured = np.isfinite(values)
        if not np.isfinite(felt).all() or measured.mean() < config.pose_clock_min_share:
            continue
        filled = np.interp(t, t[measured], values[measured])
        cutoff = _cutoff(felt, step, config)
        padding = int(config.pose_clock_padding * len(t)) + 2
        derived = _filtered(filled, step, cutoff, 2, padding)
        smooth = _filtered(felt, step, cutoff, 0, padding)
        ratio = float(np.std(derived)) / max(float(np.std(smooth)), 1e-300)
        if 1.0 / config.pose_clock_max_ratio < ratio < config.pose_clock_max_ratio:
            pairs.append(_Pair(CubicSpline(t, derived), smooth))
    return pairs


def _cutoff(values: Array, step: float, config: ChecksConfig) -> float:
    """Frequency [Hz] below which an accelerometer has nearly all of its energy."""
    power = np.abs(np.fft.rfft(values - values.mean())) ** 2
    share = np.cumsum(power) / max(float(power.sum()), 1e-300)
    frequencies = np.fft.rfftfreq(len(values), step)
    nearly_all = np.searchsorted(share, config.pose_clock_energy_share)
    return float(config.pose_clock_margin * frequencies[nearly_all])


def _filtered(values: Array, step: float, cutoff: float, order: int, padding: int) -> Array:
    """A derivative of a signal (N,), without what lies above a frequency [Hz].

    The signal is continued to a whole period by a straight line of `padding` rows, both ends
    included, so that it does not jump there.
    """
    n = len(values)
    back = np.linspace(values[-1], values[0], padding)[1:-1]
    whole = np.concatenate([values, back])
    frequencies = np.fft.rfftfreq(len(whole), step)
    spectrum = np.fft.rfft(whole) * (2j * np.pi * frequencies) ** order
    spectrum[frequencies > cutoff] = 0.0
    return np.asarray(np.fft.irfft(spectrum, len(whole))[:n])


def _correlation(a: Array, b: Array) -> float:
    a, b = a - a.mean(), b - b.mean()
    return float(a @ b / max(float(np.sqrt((a @ a) * (b @ b))), 1e-300))


def _interpolated(t: Array, values: Array, stamps: Array) -> Array:
    """Values (N,) at other times, nan where none was measured."""
    measured = np.isfinite(values)
    found = np.full(len(stamps), np.nan)
    if measured.sum() < 4:
        return found
    nearest = np.clip(np.searchsorted(t, stamps), 1, len(t) - 1)
    known = measured[nearest] & measured[nearest - 1] & (stamps >= t[0]) & (stamps <= t[-1])
    found[known] = CubicSpline(t[measured], values[measured])(stamps[known])
    return found
