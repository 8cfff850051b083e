"""Lines of a proposed map on times: rate of the rows, times of a table, begin of each file."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.files import toml_key
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.motion_begin import begins_by_motion
from boatsim.recordings.importing.several_logs import (
    begins_by_shared_clock,
    file_spans,
    files_with_unrelated_clocks,
    files_without_common_time,
)
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import sampling_rate
from boatsim.recordings.importing.time_zones import shifts_of_zones

MAX_ROW_RATE = 50.0  # [Hz] a higher rate of rows is not needed for the motion of boats


def rate_lines(used: Sequence[Classification]) -> list[str]:
    """Return a line that limits the rate of the rows if a signal is faster, else none.

    Args:
        used: Signals of the map.
    """
    fastest = max((sampling_rate(g.signal) for g in used), default=0.0)
    if fastest <= 1.01 * MAX_ROW_RATE:
        return []
    return [f"rate = {MAX_ROW_RATE:g}  # [Hz] of rows; the fastest signal has {fastest:.3g}"]


def time_lines(log: Log) -> list[str]:
    """Return a line for each table in which no column holds the times.

    Args:
        log: The log.
    """
    lines = []
    for source in dict.fromkeys(signal.source for signal in log.signals.values()):
        t = next(signal.t for signal in log.signals.values() if signal.source == source)
        if np.array_equal(t, np.arange(len(t))):
            is_clock = any(np.array_equal(signal.values, t) for signal in log.signals.values())
            key = f"time.{toml_key(source)}" if source else "time"
            if not is_clock:
                why = "no column holds times; rows are taken as 1 s apart"
                lines.append(f'# {key} = "..."  # CHECK: {why}')
    return lines


def begin_lines(log: Log, best: Mapping[str, Sequence[Classification]]) -> list[str]:
    """Return lines that state when the further files of a run begin, if they share no clock.

    Args:
        log: The log.
        best: Column -> classified signals, the most probable first.
    """
    spans = file_spans(log)
    if len(spans) < 2:
        return []
    first = next(iter(spans))
    unrelated = files_with_unrelated_clocks(spans, {})
    apart = files_without_common_time(spans)
    if not unrelated and not apart:
        return []
    shared = begins_by_shared_clock(spans)
    by_motion = begins_by_motion(best, {name: span.begin for name, span in spans.items()})
    zones = shifts_of_zones(spans, {name: begin.seconds for name, begin in by_motion.items()})
    lines = [f"# begin of each file in s after that of {first}; UTC needs no line"]
    for name in spans:
        if name not in (*unrelated, *apart):
            continue
        seconds, why = 0.0, "CHECK: no common clock, 0 is a guess"
        key = f"begins.{toml_key(name)}"
        if name in shared:
            seconds, why = (
                shared[name],
                f"by its times, which are of one clock with those of {first}",
            )
        elif name in zones:
            seconds, why = zones[name].seconds, f"CHECK: {zones[name].in_words()}"
            if name in by_motion:
                why += (
                    "; the turning that both files show agrees (correlation "
                    f"{by_motion[name].correlation:.2f})"
                )
        elif name in by_motion:
            seconds = by_motion[name].seconds
            why = (
                "CHECK: by the turning that both files show (correlation "
                f"{by_motion[name].correlation:.2f})"
            )
        elif name in apart:
            spanned = f"{spans[name].in_words()}, of {first} {spans[first].in_words()}"
            lines.append(f"# {key} = SECONDS  # CHECK: its times are {spanned}: none in common")
            continue
        lines.append(f"{key} = {seconds!r}  # {why}")
    return lines
