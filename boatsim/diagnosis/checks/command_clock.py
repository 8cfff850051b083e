"""Check for recordings whose motion follows the commands later or earlier than in the others.

A logger that stamps the commands of one recording differently, or poses of which one recording is
late, cannot be told from slow drives in this recording alone. Drives and hull are the same in all
recordings of a set, so that a delay of one of them against the others is one of its clocks. It is
reported if the others agree, if the heading alone shows it too, and if neither slower drives nor
one late command explain this recording as well.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np
from threadpoolctl import threadpool_limits

from boatsim.diagnosis.checks.command_clock_differences import (
    ClockDifference,
    Delays,
    clock_differences,
    delays_of_files,
)
from boatsim.diagnosis.checks.command_delays import DelayEstimator, Parts, moving_commands
from boatsim.diagnosis.checks.finding import (
    Finding,
    apply_corrections,
    delay_corrections,
    unchecked_finding,
)
from boatsim.diagnosis.checks.unrecorded_push import has_measured_input
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.errors import BadInput
from boatsim.physics.groups import group_of, without_group
from boatsim.recordings.table import Recording
from boatsim.view.formatting import format_odds

CLOCK_EFFECTS = ("clock_offset", "command_delay")  # delays of all sensors or of all commands


def check_command_clock(
    problem: Problem, fit: Fit, recordings: Sequence[MappedRecording], names: Sequence[str]
) -> list[Finding]:
    """Find recordings whose commands act later or earlier than those of the other recordings.

    Args:
        problem: The problem, whose recordings the vessel model is fitted to.
        fit: Fit of the vessel with refitted coefficients, without candidate effects.
        recordings: Mapped recordings of the problem, and then held-out ones.
        names: Their files; the parts of a file have one clock.

    Returns:
        A finding "command_clock" for each file that differs from the others.
    """
    config, vessel = problem.config.checks, problem.program.vessel
    files: dict[str, list[MappedRecording]] = {}
    for mapped, name in zip(recordings, names, strict=True):
        files.setdefault(name, []).append(mapped)
    if len(files) < config.command_clock_min_files or not vessel.commands:
        return []
    if has_measured_input(vessel):
        return []
    fitted = names[: len(problem.recordings)]
    estimator = DelayEstimator(problem, fit)
    found = most_clock_differences(
        delays_of_files(estimator, files),
        estimator,
        lambda suspects: clock_differences(estimator, files, suspects, fitted),
    )
    return [_finding(n, each, files[n], config) for n, each in found.items()]


def most_clock_differences(
    delays: Delays,
    estimator: DelayEstimator,
    differences: Callable[[Mapping[str, float]], dict[str, ClockDifference]],
) -> dict[str, ClockDifference]:
    """Return the differences of the largest set of files of which all differ from the others.

    A file that differs little is hidden by one that differs much, so that further files are tried
    together with those that were found.

    Args:
        delays: Delays of all files.
        estimator: Estimator of these delays.
        differences: Function that returns the differences of files that may differ, with their
            distances [s] from the others; empty unless all of them differ.
    """
    found = dict[str, ClockDifference]()
    most = int(estimator.config.command_clock_max_share * len(delays))
    for count in range(1, most + 1):
        suspects = _suspects(delays, count, estimator)
        if not suspects:
            break
        found = differences(suspects) or found
    return found


def find_command_clocks(problem: Problem, recordings: Sequence[Recording]) -> list[Finding]:
    """Find recordings with another clock of the commands, without a diagnosis of the vessel.

    Args:
        problem: The problem of the vessel as specified.
        recordings: The recordings of the problem.

    Returns:
        Findings "command_clock"; a remark of kind "unchecked" if the comparison fails.
    """
    names = [recording.origin for recording in recordings]
    if len(set(names)) < problem.config.checks.command_clock_min_files:
        return []
    try:
        with threadpool_limits(1, "blas"):
            fit = fit_baseline(problem).recalibrated
            return check_command_clock(problem, fit, problem.recordings, names)
    except (BadInput, np.linalg.LinAlgError, FloatingPointError) as error:
        return [unchecked_finding("whether a recording has another clock", error)]


def recordings_with_one_clock(
    loaded: LoadedRecordings, findings: Sequence[Finding]
) -> LoadedRecordings:
    """Return recordings whose commands act at the same time after their stamps.

    Args:
        loaded: The recordings.
        findings: Findings "command_clock" about them.
    """
    changes = {finding.run: finding.changes for finding in findings}

    def corrected(recordings: Sequence[Recording]) -> list[Recording]:
        return [apply_corrections(one, changes.get(one.origin, ())) for one in recordings]

    return replace(loaded, fitted=corrected(loaded.fitted), held_out=corrected(loaded.held_out))


def candidates_besides_clocks(
    names: Sequence[str], loaded: LoadedRecordings, findings: Sequence[Finding]
) -> tuple[str, ...]:
    """Return candidate effects without delays of groups of corrected recordings alone.

    What the correction leaves of a delay, less than its uncertainty, is no second cause. Recordings
    are corrected to the clock of the others, so that those of a group that needed no correction
    determine a delay of the whole group as before.

    Args:
        names: Names of candidate effects.
        loaded: The recordings; a delay of a group is fitted to the fitted ones.
        findings: Findings "command_clock" about them.
    """
    runs = {finding.run for finding in findings}
    groups = set[str]()
    for recording in (*loaded.fitted, *loaded.held_out):
        if recording.origin in runs:
            groups.update(recording.notes.groups)
    for recording in loaded.fitted:
        if recording.origin not in runs:
            groups.difference_update(recording.notes.groups)
    kept = []
    for name in names:
        if group_of(name) not in groups or without_group(name) not in CLOCK_EFFECTS:
            kept.append(name)
    return tuple(kept)


def _suspects(delays: Delays, count: int, estimator: DelayEstimator) -> dict[str, float]:
    """The files farthest from the median, and their distance from the mean of the others [s]."""
    config = estimator.config
    if len(delays) < config.command_clock_min_files:
        return {}
    seconds = {name: delay.seconds for name, delay in delays.items()}
    middle = float(np.median(list(seconds.values())))
    farthest = sorted(seconds, key=lambda name: abs(seconds[name] - middle))[-count:]
    others = [seconds[name] for name in seconds if name not in farthest]
    found = {}
    for name in farthest:
        off = seconds[name] - float(np.mean(others))
        least = config.command_clock_suspect_sds * delays[name].sd
        if abs(off) < max(least, config.command_clock_min_delay * estimator.time_scale):
            return {}
        found[name] = off
    return found


def _finding(name: str, found: ClockDifference, parts: Parts, config: ChecksConfig) -> Finding:
    """The finding about one file."""
    seconds = found.seconds
    sense, adverb = "later", "late"
    if seconds < 0.0:
        sense, adverb = "earlier", "early"
    names = list(parts[0].program.vessel.commands)
    commands = [names[column] for column in moving_commands(parts)]
    signals = dict.fromkeys(chain.from_iterable(mapped.signals for mapped in parts))
    evidence = (
        f"the motion follows the commands {abs(seconds):.3f} +- {found.sd:.3f} s {sense} than in "
        f"the other {found.others} recordings, which agree with each other. Another lag of the "
        f"drives in this recording explains it less well ({format_odds(found.lead)})"
    )
    return Finding(
        "command_clock",
        evidence,
        probability=config.probability_evident,
        changes=delay_corrections(commands, -seconds),
        alternatives=((f"the sensors are {adverb}", delay_corrections(signals, seconds)),),
        words="the clock of the commands differs from that of the other recordings",
        run=name,
        of_run_only=True,
    )
