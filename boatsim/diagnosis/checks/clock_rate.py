"""Check of the clock of a log: do the track and the heading ask for another time than the rows?

Positions and velocities tell how long a stretch of the track took, heading and yaw rate how long a
turn took. These are two independent clocks. One sensor with a wrong gain, a current, or a velocity
through the water changes one of them. If both deviate from the times of the rows in the same way,
the times of the rows are wrong: rows that were resampled by time stamps that came late or early, or
a logger whose clock runs fast or slow.

Each file has its own clock. A wander is sought in each file about its mean rate, and then in all
files together that show none alone; one constant rate of the files without a wander is compared
with one rate per file.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.checks.clock_rate_comparison import RateComparison, compare_clock_rates
from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.recordings.motion_clock import (
    Stretches,
    estimate_clock_rates,
    motion_stretches,
)
from boatsim.recordings.notes import CLOCK_BY_MOTION
from boatsim.recordings.table import Recording

SPEEDS = ("u_mps", "v_mps")
MIN_RATE_SD = 1e-6  # against division by 0 in logs without noise


def check_clock_rate(recordings: Sequence[Recording], config: ChecksConfig) -> list[Finding]:
    """Find a clock that runs fast, slowly or unevenly, from what all sensors see of the motion.

    All recordings are examined together, because one instrument and one logger made them. Files
    whose constant rates differ are judged one by one.

    Args:
        recordings: Prepared recordings of one vessel, or parts of them.
        config: Thresholds of the quality checks.

    Returns:
        Findings "clock_wanders" or "clock_rate", and "velocity_gain", for each recording that has
        the columns of positions, heading, velocities and yaw rate.
    """
    examined = [r for r in recordings if not r.notes.clock]
    long, files = [], []
    for recording in examined:
        run = motion_stretches(recording.t, recording.signals, config.clock_stretch_rows)
        if run:
            long.append(run)
            files.append(recording.origin)
    compared = compare_clock_rates(long, files, config)
    if compared is None:
        return []
    gain, gain_sd = compared.velocity_gain()
    wrong_gain = abs(gain - 1.0) > max(config.clock_min_gain, config.clock_gain_sds * gain_sd)
    found, uneven = list[Finding](), list[int]()
    wandering = _wandering_files(compared, config)
    count = sum(map(len, wandering))
    for together in wandering:
        uneven += together
        names = {files[file] for file in together}
        if len(together) == len(np.unique(compared.file)):
            names = set(files)  # those without any turn, too
        ours = [recording for recording in examined if recording.origin in names]
        own = compared.selected(np.isin(compared.file, together))
        for finding in _wander(ours, gain if wrong_gain else 1.0, own, config):
            found.append(replace(finding, of_run_only=count < len(np.unique(compared.file))))
    if not wrong_gain:
        names = {files[file] for file in uneven}
        even = [recording for recording in examined if recording.origin not in names]
        steady = compared.selected(~np.isin(compared.file, uneven))
        runs = [(n, run) for n, run in zip(files, long, strict=True) if n not in names]
        if len(steady.track) >= config.clock_min_stretches:
            found += _constant_rates(even, steady, runs, files, config)
    if found and wrong_gain:
        found += [_velocity_gain(recording, gain, gain_sd, config) for recording in examined]
    return found


def _wandering_files(compared: RateComparison, config: ChecksConfig) -> list[list[int]]:
    """Files whose clocks run unevenly: each that shows it alone, and others that do together.

    Where no file with enough stretches runs evenly, all have the clock of one logger.
    """
    alone, rest = list[list[int]](), list[int]()
    for file in np.unique(compared.file).tolist():
        own = compared.selected(compared.file == file)
        if len(own.track) >= config.clock_min_stretches and own.agrees(config):
            alone.append([file])
        else:
            rest.append(file)
    if alone and not any(_runs_evenly(compared, file, config) for file in rest):
        return [sorted([*rest, *(file for files in alone for file in files)])]
    others = compared.selected(np.isin(compared.file, rest))
    if len(others.track) < config.clock_min_stretches or not others.agrees(config):
        return alone
    each = {file: others.selected(others.file == file) for file in rest}
    shared = sum(len(own.track) * own.covariance()[0] for own in each.values()) / len(others.track)
    together = []
    for file, own in each.items():
        covariance, sd = own.covariance()
        if covariance > shared - config.clock_share_sds * sd:
            together.append(file)
    if together:
        alone.append(together)
    return alone


def _runs_evenly(compared: RateComparison, file: int, config: ChecksConfig) -> bool:
    """Whether the rates of a file do not vary alike, although it has enough stretches for that."""
    own = compared.selected(compared.file == file)
    enough = len(own.track) >= config.clock_min_stretches
    return enough and own.correlation < config.clock_min_correlation


def _constant_rates(
    recordings: Sequence[Recording],
    compared: RateComparison,
    runs: Sequence[tuple[str, Stretches]],
    files: Sequence[str],
    config: ChecksConfig,
) -> list[Finding]:
    """Findings of constant rates, one for each file where they differ, else one for all files."""
    different = _different_rates(compared, config)
    if not different:
        return _constant_rate(recordings, compared, _track_rate([run for _, run in runs]), config)
    found = list[Finding]()
    for file in different:
        ours = [recording for recording in recordings if recording.origin == files[file]]
        own = compared.selected(compared.file == file)
        everywhere = _track_rate([run for name, run in runs if name == files[file]])
        for finding in _constant_rate(ours, own, everywhere, config):
            found.append(replace(finding, of_run_only=True))
    return found


def _different_rates(compared: RateComparison, config: ChecksConfig) -> list[int]:
    """Files that have constant clock rates of their own; empty if one rate explains all files.

    The log likelihood of one rate per file must exceed that of a common rate, for each further
    rate, by as much as a deviation of `clock_min_sds` standard deviations.
    """
    files, middles, precisions = list[int](), list[float](), list[float]()
    for file in np.unique(compared.file).tolist():
        own = compared.selected(compared.file == file)
        if len(own.track) < config.clock_min_stretches:
            continue
        middle, sd = own.mean_clock_rate()
        files.append(file)
        middles.append(middle)
        precisions.append(1.0 / max(sd, MIN_RATE_SD) ** 2)
    if len(files) < 2:
        return []
    rates, precision = np.array(middles), np.array(precisions)
    off = rates - float(np.average(rates, weights=precision))
    gain = 0.5 * float((precision * off**2).sum())
    penalty = 0.5 * config.clock_min_sds**2 * (len(files) - 1)
    if gain > penalty and float(np.ptp(rates)) > config.clock_min_rate:
        return files
    return []


def _track_rate(runs: Sequence[Stretches]) -> float:
    """Mean clock rate by positions and velocities over all stretches."""
    along = sum(float((run.travelled * run.moved).sum()) for run in runs)
    return along / sum(float((run.travelled**2).sum()) for run in runs)


def _wander(
    recordings: Sequence[Recording], gain: float, compared: RateComparison, config: ChecksConfig
) -> list[Finding]:
    """The finding of an uneven clock in each recording."""
    runs = [motion_stretches(recording.t, recording.signals) for recording in recordings]
    known = [run for run in runs if run]
    estimate = estimate_clock_rates(known, gain)
    if estimate.sd < config.clock_min_wander:
        return []
    rates = iter(estimate.rates)
    count, where = len({recording.origin for recording in recordings}), ""
    if count > 1:
        where = f" in {count} recordings"
    found = []
    for recording, run in zip(recordings, runs, strict=True):
        if run is None:
            continue
        own = next(rates)
        lowest, highest = np.quantile(own, config.clock_stated_quantiles)
        evidence = (
            f"a second of the log lasted {lowest:.2f} to {highest:.2f} s, {own.mean():.2f} s on "
            "average, by the distances and the turns of the vessel. Track and heading agree in "
            f"this (correlation {compared.correlation:.2f} over {len(compared.track)} stretches "
            f"of turning{where}), so that neither speed sensor nor yaw rate is the cause"
        )
        found.append(
            Finding(
                "clock_wanders",
                evidence,
                probability=config.probability_evident,
                clock=CLOCK_BY_MOTION,
                words="the times of the rows run unevenly",
                run=recording.origin,
            )
        )
    return found


def _constant_rate(
    recordings: Sequence[Recording],
    compared: RateComparison,
    everywhere: float,
    config: ChecksConfig,
) -> list[Finding]:
    """The finding of a clock that runs too fast or too slowly, on straight courses and in turns."""
    rate, sd = compared.mean_clock_rate()
    if abs(rate - 1.0) < max(config.clock_min_rate, config.clock_min_sds * sd):
        return []
    if (everywhere - 1.0) / (rate - 1.0) < config.clock_min_track_share:
        return []
    found = []
    for recording in recordings:
        evidence = (
            f"a second of the log lasted {rate:.3f} +- {sd:.3f} s, by the distances and by the "
            f"turns of the vessel ({len(compared.track)} stretches of turning)"
        )
        found.append(
            Finding(
                "clock_rate",
                evidence,
                probability=config.probability_strong,
                changes=(Change("t_s", "t_s", rate),),
                words="the clock of the log runs too fast or too slowly",
                run=recording.origin,
            )
        )
    return found


def _velocity_gain(recording: Recording, gain: float, sd: float, config: ChecksConfig) -> Finding:
    """The finding of velocities that are too small or too large, by the corrected clock."""
    evidence = (
        f"the positions move {gain:.3f} +- {sd:.3f} times as fast as u_mps and v_mps, after the "
        "error of the clock, which the headings show too"
    )
    return Finding(
        "velocity_gain",
        evidence,
        probability=config.probability_strong,
        changes=tuple(Change(name, name, gain) for name in SPEEDS),
        words="the recorded velocities have a wrong gain",
        run=recording.origin,
    )
