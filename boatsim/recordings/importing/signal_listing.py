"""List of the signals of a log."""

from collections.abc import Sequence

import numpy as np

from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.motion_evidence import correct_classification_by_motion
from boatsim.recordings.importing.signal_classification import UNKNOWN_BODY, Body, classify_signals
from boatsim.recordings.importing.signal_text import printable_name, sampling_rate

MAX_LISTED_SIGNALS = 400  # of a log with more, unknown signals are only counted


def signal_table(log: Log, body: Body = UNKNOWN_BODY) -> list[str]:
    """Return a table of the signals of a log: name, unit, rate, samples, range, classification.

    Args:
        log: The log.
        body: The vessel.
    """
    columns: dict[str, str] = {}
    for g in correct_classification_by_motion(classify_signals(log, body), log):
        columns[g.name] = g.column
    rows = [("signal", "unit", "Hz", "samples", "lowest", "highest", "probably")]
    listed = list(log.signals)
    if len(listed) > MAX_LISTED_SIGNALS:
        listed = list(filter(columns.__contains__, listed))
    for name in listed:
        signal = log.signals[name]
        probably = ", ".join(filter(None, (columns.get(name), signal.about)))
        rows.append((printable_name(name), *_signal_figures(signal), probably))
    lines = _aligned(rows)
    if len(listed) < len(log.signals):
        lines.append(f"and {len(log.signals) - len(listed)} unknown signals")
    return lines


def _signal_figures(signal: Signal) -> tuple[str, str, str, str, str]:
    values = signal.values[np.isfinite(signal.values)]
    low = high = ""
    if len(values):
        low, high = f"{values.min():.6g}", f"{values.max():.6g}"
    return (
        printable_name(signal.unit)[:12],
        f"{sampling_rate(signal):.3g}",
        str(len(values)),
        low,
        high,
    )


def _aligned(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Lines of a table of seven columns, of which four are numbers."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines: list[str] = []
    for row in rows:
        cells = [row[0].ljust(widths[0]), row[1].ljust(widths[1])]
        cells += map(str.rjust, row[2:6], widths[2:6])
        lines.append("  ".join([*cells, row[6]]).rstrip())
    return lines
