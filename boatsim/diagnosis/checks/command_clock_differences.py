"""Differences between the delays of files behind their commands, and what else may explain them.

The vessel model is fitted once more after the files in question are corrected by first estimates,
so that hardly any delay of their clocks acts on the model with which it is estimated.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.checks.command_delays import (
    Delay,
    DelayEstimator,
    Parts,
    Response,
    moving_commands,
    with_response,
)
from boatsim.diagnosis.checks.drive_delays import best_drive_rival, common_lag
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.search.ranking import fit_baseline

HEADING = ("psi_rad", "r_radps")
Delays = Mapping[str, Delay]  # by file


@dataclass(frozen=True)
class ClockDifference:
    """Difference of the delay of one file from those of the others.

    Attributes:
        seconds: The difference [s]; positive: the motion follows later.
        sd: Its standard deviation [s].
        others: Number of the other files.
        lead: Log likelihood beyond that of slower drives or of one late command [nats].
    """

    seconds: float
    sd: float
    others: int
    lead: float = 0.0

    def exceeds(self, config: ChecksConfig, time_scale: float) -> bool:
        """Return whether it is larger than files with equal clocks may show."""
        least = max(
            config.command_clock_min_delay * time_scale, config.command_clock_min_sds * self.sd
        )
        return abs(self.seconds) > least


def delays_of_files(estimator: DelayEstimator, files: Mapping[str, Parts]) -> dict[str, Delay]:
    """Return the delays of the files that have a likeliest one.

    A file in which no command changes has none.

    Args:
        estimator: Estimates the delays, with one vessel model for all files.
        files: Mapped recordings of each file.
    """
    found = {}
    for name, parts in files.items():
        if not moving_commands(parts):
            continue
        delay = estimator.delay(parts)
        if delay is not None:
            found[name] = delay
    return found


def clock_differences(
    estimator: DelayEstimator,
    files: Mapping[str, Parts],
    suspects: Mapping[str, float],
    names: Sequence[str],
) -> dict[str, ClockDifference]:
    """Return differences of files that are refined with another fit; none if one is refuted.

    The vessel is fitted to all recordings of the problem, after the files that may differ are
    corrected by first estimates.

    Args:
        estimator: Estimates the delays, with a vessel model that is fitted to all files.
        files: Mapped recordings of each file.
        suspects: Files that may differ, and their distance from the mean of the others [s].
        names: File of each recording of the estimator's problem.

    Returns:
        The difference of each of these files; empty unless all of them differ.
    """
    corrected = {}
    for name, parts in files.items():
        later = Response(suspects.get(name, 0.0))
        corrected[name] = [with_response(one, later) for one in parts]
    refitted = _refitted(estimator, suspects, names)
    without_lag = delays_of_files(refitted, corrected)
    if not suspects.keys() <= without_lag.keys():
        return {}
    by_heading = delays_of_files(refitted, _with_heading_alone(corrected))
    lag = common_lag(refitted, corrected, without_lag)
    delays = dict[str, Delay]()
    for name, first in without_lag.items():
        delay = refitted.refined(corrected[name], first.seconds, lag)
        if delay is not None:
            delays[name] = delay
    found = {}
    for name, moved in suspects.items():
        others = {other: each for other, each in delays.items() if other not in suspects}
        if name not in delays or len(others) + 1 < estimator.config.command_clock_min_files:
            return {}
        difference = _difference(delays[name], list(others.values()), moved, estimator)
        if not difference.exceeds(estimator.config, estimator.time_scale):
            return {}
        if _has_two_kinds(files[name]):
            own = by_heading.get(name)
            members = [by_heading[other] for other in others if other in by_heading]
            if not _heading_agrees(own, members, difference, estimator):
                return {}
        usual = Response(_mean(list(others.values())), lag)
        rival = best_drive_rival(refitted, files[name], usual)
        lead = delays[name].log_likelihood - rival
        if not estimator.config.command_clock_lead <= lead < np.inf:
            return {}  # it is nan or infinite where the filter diverges
        found[name] = replace(difference, lead=lead)
    return found


def _refitted(
    estimator: DelayEstimator, suspects: Mapping[str, float], names: Sequence[str]
) -> DelayEstimator:
    """The estimator whose vessel model is fitted with the files that may differ corrected."""
    fitted = []
    for mapped, name in zip(estimator.problem.recordings, names, strict=True):
        fitted.append(with_response(mapped, Response(suspects.get(name, 0.0))))
    problem = estimator.problem.with_recordings(fitted)
    return DelayEstimator(problem, fit_baseline(problem).recalibrated)


def _difference(
    own: Delay, others: Sequence[Delay], moved: float, estimator: DelayEstimator
) -> ClockDifference:
    """Difference from other files of a file that was moved by a time [s], with its sd."""
    config = estimator.config
    middle = _mean(others)
    seconds = np.array([each.seconds for each in others])
    precision = sum(each.sd**-2 for each in others)
    weight = config.command_clock_scatter_weight
    expected = config.command_clock_scatter * estimator.time_scale
    squares = float(((seconds - middle) ** 2).sum())
    scatter = (weight * expected**2 + squares) / (weight + len(others) - 1)
    variance = max(own.sd**2, scatter) + max(1.0 / precision, scatter / len(others))
    return ClockDifference(moved + own.seconds - middle, float(np.sqrt(variance)), len(others))


def _mean(delays: Sequence[Delay]) -> float:
    """Mean of delays [s], weighted by their precision."""
    seconds = [each.seconds for each in delays]
    return float(np.average(seconds, weights=[each.sd**-2 for each in delays]))


def _with_heading_alone(files: Mapping[str, Parts]) -> dict[str, list[MappedRecording]]:
    """The recordings of files without measurements other than of the heading and its rate."""
    found = dict[str, list[MappedRecording]]()
    for name, parts in files.items():
        found[name] = []
        for mapped in parts:
            kept = np.isin(mapped.signals, HEADING)
            measured = np.where(kept, mapped.measured, np.nan)
            found[name].append(replace(mapped, measured=measured))
    return found


def _heading_agrees(
    own: Delay | None, others: Sequence[Delay], found: ClockDifference, estimator: DelayEstimator
) -> bool:
    """Whether delays by the heading alone show the difference of a file, so that all sensors do.

    Late positions alone are no fault of the clock of the commands.
    """
    if own is None or not others:
        return False
    moved = 0.0  # the files are corrected already
    left = _difference(own, others, moved, estimator)
    least = estimator.config.command_clock_agreement * float(np.hypot(left.sd, found.sd))
    return abs(left.seconds) < least and least < abs(found.seconds)


def _has_two_kinds(parts: Parts) -> bool:
    """Whether a file has the heading and other measurements of the motion."""
    of_heading = set[bool]()
    for mapped in parts:
        of_heading.update(np.isin(mapped.signals, HEADING).tolist())
    return len(of_heading) == 2
