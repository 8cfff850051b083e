"""A finding about a log: its name, the evidence, and the change of columns that corrects it."""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS, Expression
from boatsim.recordings.table import Recording

Kind = Literal["fault", "mended", "limit", "drive", "unchecked"]
LOG_NOT_BOAT = "probably your log, not your boat"
PLANAR_POSE = ("x_m", "y_m", "psi_rad")
BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")  # a key of TOML that needs no quotes
MAX_LISTED = 5  # places that the text of a finding lists
# units that are written into recording.toml by name instead of as a number
UNITS_BY_NAME = ("deg", "percent", "ms", "us", "ns", "rpm", "rev")


@dataclass(frozen=True)
class Change:
    """A correction of one recorded column: `column` = `source` times `factor` plus `offset`.

    With a `delay` each value of the column belongs to the time that much earlier.
    """

    column: str
    source: str  # a column of the recording before the change
    factor: float = 1.0
    offset: float = 0.0
    delay: float = 0.0  # [s]
    factor_below: float | None = None  # of negative values, if it is another one


@dataclass(frozen=True)
class Finding:
    """One result of the quality checks of a recording, with its evidence and its correction.

    For example, a heading in degrees, a clock that stalls, or too little excitation.

    Attributes:
        name: Name of the finding in diagnosis.json.
        evidence: The facts with numbers, for the user.
        kind: "fault" if the file must be corrected, "mended" if a diagnosis corrects it
            automatically, "limit" if the log is correct but does not identify some coefficients,
            "drive" if it states how a drive answers its orders or how it reports, "unchecked" if a
            check could not be evaluated.
        probability: Probability that the finding is true.
        spans: Intervals [s] in which it appears; empty if it concerns the whole log.
        changes: Changes of columns that correct it.
        alternatives: Other changes that explain the log equally well, each with its words.
        use: Interval [s] of the log that can be used.
        clock: Value of `clock` in recording.toml that corrects the times; "" if they are right.
        remedy: Advice in words, if no line of recording.toml corrects it.
        words: Description in a clause, if the name does not describe it.
        run: File of the recording; for several recordings that of the first.
        of_run_only: Whether the correction is for this recording alone, not for others that share
            its recording.toml.
    """

    name: str
    evidence: str
    kind: Kind = "fault"
    probability: float = 1.0
    spans: tuple[tuple[float, float], ...] = ()
    changes: tuple[Change, ...] = ()
    alternatives: tuple[tuple[str, tuple[Change, ...]], ...] = ()
    use: tuple[float, float] | None = None
    clock: str = ""
    remedy: str = ""
    words: str = ""
    run: str = ""
    of_run_only: bool = False

    @property
    def description(self) -> str:
        """Description of the fault of the recording in a clause."""
        return self.words or self.name.replace("_", " ")

    def invalidates_log(self, config: ChecksConfig) -> bool:
        """Return whether this fault would mislead a diagnosis of the uncorrected recording.

        A diagnosis would attribute the fault to the vessel. This holds for faults that are probable
        enough.
        """
        certain = self.probability >= config.min_verdict_probability
        return self.kind == "fault" and bool(self.changes or self.clock) and certain


def unchecked_finding(question: str, error: Exception) -> Finding:
    """Return the remark that a check of a recording could not be evaluated, with the reason.

    Args:
        question: What the check would have decided, such as "whether the headings are late".
        error: The error that ended the check.
    """
    reason = str(error) or type(error).__name__
    return Finding(
        "not_checked",
        f"{question} could not be computed ({reason})",
        kind="unchecked",
        remedy="the other checks are not affected",
    )


def has_result(findings: Iterable[Finding]) -> bool:
    """Return whether any finding says more than that a check could not be evaluated."""
    return any(finding.kind != "unchecked" for finding in findings)


def scaling_corrections(
    names: Iterable[str], factor: float, offset: float = 0.0
) -> tuple[Change, ...]:
    """Return corrections that multiply each of some recorded columns by a factor and add an offset.

    For example, from degrees to radians.
    """
    return tuple(Change(name, name, factor, offset) for name in names)


def delay_corrections(columns: Iterable[str], seconds: float) -> tuple[Change, ...]:
    """Return corrections that remove a delay [s] from each of some recorded columns."""
    return tuple(Change(column, column, delay=seconds) for column in columns)


def corrected_columns(changes: Iterable[Change]) -> set[str]:
    """Return the names of the recorded columns that corrections overwrite."""
    return {change.column for change in changes}


def longest_uninterrupted_interval(t: Array, breaks: NDArray[np.int64]) -> tuple[float, float]:
    """Return the longest interval of a time axis that contains no cut.

    Args:
        t: Times (N,) [s].
        breaks: Rows (K,) after which the time axis is cut.

    Returns:
        First and last time of the longest part [s].
    """
    parts = np.split(t, breaks + 1)
    durations = [float(np.ptp(part)) if len(part) else 0.0 for part in parts]
    longest = parts[int(np.argmax(durations))]
    return float(longest[0]), float(longest[-1])


def apply_corrections(recording: Recording, changes: Sequence[Change]) -> Recording:
    """Return a recording with corrections applied to its columns, such as changes of unit or sign.

    Args:
        recording: The recording; commands at times of their own are corrected too.
        changes: The changes; those whose source is missing are ignored.
    """

    def correct_columns(columns: Mapping[str, Array]) -> dict[str, Array]:
        result = dict(columns)
        for change in changes:
            if change.source not in columns:
                continue
            values = columns[change.source]
            factor: float | Array = change.factor
            if change.factor_below is not None:
                factor = np.where(values < 0.0, change.factor_below, change.factor)
            result[change.column] = values * factor + change.offset
        return result

    orders = recording.orders
    if orders is not None:
        orders = replace(orders, signals=correct_columns(orders.signals))
    signals = correct_columns({"t_s": recording.t, **recording.signals})
    t = signals.pop("t_s")
    delays: dict[str, float] = {}
    for change in changes:
        if change.delay and change.column in signals:
            delays[change.column] = change.delay
    return replace(recording, t=t, signals=signals, orders=orders).without_latency(delays)


def apply_corrections_to_all(
    recordings: Iterable[Recording], changes: Sequence[Change]
) -> list[Recording]:
    """Return several recordings, each with the same corrections applied to its columns."""
    return [apply_corrections(recording, changes) for recording in recordings]


def columns_table_lines(changes: Sequence[Change], sources: Mapping[str, Expression]) -> list[str]:
    """Return the lines of the table `[columns]` of recording.toml that correct recorded columns.

    Args:
        changes: Corrections of columns, such as another unit or sign.
        sources: Expressions from which the columns are computed so far.
    """
    lines = []
    for change in changes:
        if change.delay:
            continue
        source = sources.get(change.source, Expression(change.source))
        if change.factor_below is not None:
            lines.append(_range_line(change, source))
            continue
        expression = Expression(
            source.signal,
            change.factor * source.factor,
            change.factor * source.offset + change.offset,
        )
        lines.append(f'{change.column} = "{_expression_text(expression, change.column)}"')
    return lines


def _range_line(change: Change, source: Expression) -> str:
    """The line of a column with one factor above zero and another one below it, for per cent."""
    signal = _expression_text(source, change.source)
    least, most = -100.0 * (change.factor_below or 0.0), 100.0 * change.factor
    return (
        f'{change.column} = {{ signal = "{signal}", low = -100, neutral = 0, high = 100, '
        f"least = {least:g}, most = {most:g} }}"
    )


def _expression_text(expression: Expression, column: str) -> str:
    text = expression.signal
    if expression.factor < 0.0:
        text = f"-{text}"
    if abs(expression.factor) != 1.0:
        text += f" * {_factor_text(abs(expression.factor))}"
    if expression.offset == 0.0:
        return text
    sign = "-" if expression.offset < 0.0 else "+"
    size = abs(expression.offset)
    if column.endswith("_rad"):
        return f"{text} {sign} {np.degrees(size):.4g} * deg"
    return f"{text} {sign} {size:.12g}"


def _factor_text(factor: float) -> str:
    for unit in UNITS_BY_NAME:
        if abs(factor / UNITS[unit] - 1.0) < 1e-9:
            return unit
    return f"{factor:.10g}"


def recording_toml_lines(finding: Finding, sources: Mapping[str, Expression]) -> list[str]:
    """Return the lines to write into recording.toml in order to correct a fault of a recording.

    Args:
        finding: The finding; of several alternatives the first is used.
        sources: Expressions from which the columns are computed so far.
    """
    lines = []
    if finding.use:
        begin, end = finding.use
        lines.append(f"use = [{begin:.9g}, {end:.9g}]")
    if finding.clock:
        lines.append(f'clock = "{finding.clock}"')
    lines += correction_lines(finding.changes, sources)
    return _lines_of_finding(lines, finding)


def alternative_lines(
    finding: Finding, changes: Sequence[Change], sources: Mapping[str, Expression]
) -> list[str]:
    """Return the lines of recording.toml for another explanation of a finding.

    Args:
        finding: The finding.
        changes: Changes of columns of the other explanation.
        sources: Expressions from which the columns are computed so far.
    """
    return _lines_of_finding(correction_lines(changes, sources), finding)


def _lines_of_finding(lines: list[str], finding: Finding) -> list[str]:
    """Lines for all recordings of a folder, or for the recording of the finding alone."""
    if finding.of_run_only:
        return _lines_of_run(lines, Path(finding.run).stem)
    return lines


def _lines_of_run(lines: Sequence[str], name: str) -> list[str]:
    """Lines of recording.toml in the tables `[runs.NAME]` of one recording."""
    if not BARE_KEY.fullmatch(name):
        name = json.dumps(name, ensure_ascii=False)
    found = []
    if lines and not lines[0].startswith("["):
        found.append(f"[runs.{name}]")
    for line in lines:
        if line.startswith("["):
            line = f"[runs.{name}.{line[1:]}"
        found.append(line)
    return found


def correction_lines(changes: Sequence[Change], sources: Mapping[str, Expression]) -> list[str]:
    """Return the lines of recording.toml, with their tables, that make changes of columns.

    Args:
        changes: Corrections of columns: another unit or sign, or a delay.
        sources: Expressions from which the columns are computed so far.
    """
    lines = []
    columns = columns_table_lines(changes, sources)
    if columns:
        lines += ["[columns]", *columns]
    delays = []
    for change in changes:
        if change.delay:
            delays.append(f"{change.column} = {change.delay:.4g}")
    if delays:
        lines += ["[latency]", *delays]
    return lines
