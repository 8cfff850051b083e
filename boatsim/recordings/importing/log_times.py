"""Times of the signals of a log: by the map, and without steps of the clock."""

from dataclasses import replace

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array
from boatsim.recordings.importing.clock_steps import continue_clock
from boatsim.recordings.importing.conversion_state import ConversionState, signal_of
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import Map


def with_time_of_map(log: Log, map: Map, file: str) -> Log:
    """Return the log with the times of the map.

    Args:
        log: The log.
        map: The map.
        file: Name of the map in messages.

    Raises:
        BadInput: An expression is wrong, or names a file or signal that the log does not have.
    """
    if not map.time:
        return log
    given = map.time
    names = {signal.source for signal in log.signals.values()}
    if isinstance(given, str):
        given = dict.fromkeys(sorted(names)[:1], given)
        if len(names) > 1:
            raise BadInput(f"{file}: time is one expression; of several files write time.FILE")
    signals = dict(log.signals)
    for source, text in given.items():
        if source not in names:
            raise BadInput(f"{file}: {unknown_name_message('time: file', source, sorted(names))}")
        clock, how = signal_of(ConversionState(log, file, map, {}), "time", text)
        t = how.convert(clock.values)
        for name, signal in signals.items():
            if signal.source == source and len(signal.values) == len(t):
                signals[name] = replace(signal, t=t)
    return replace(log, signals=signals)


def with_continued_clocks(log: Log) -> Log:
    """Return the log with times that go on where a clock was set back, and remarks on these."""
    streams: dict[int, dict[str, Array]] = {}
    for name, signal in log.signals.items():
        streams.setdefault(id(signal.t), {})[name] = signal.values
    times: dict[int, Array] = {}
    remarks = dict[str, None]()
    for name, signal in log.signals.items():
        key = id(signal.t)
        if key in times:
            continue
        times[key], steps = continue_clock(signal.t, streams[key])
        for step in steps:
            stream = signal.source or name.rpartition(".")[0] or log.path.name
            moved = f"goes back by {step.seconds:.6g} s"
            if step.seconds < 0.0:
                moved = f"is put forward by {-step.seconds:.6g} s"
            text = (
                f"{log.path}: {stream}: the clock {moved} after sample {step.row}, but the samples "
                "go on; the later ones are moved so that they follow. "
                "If the log was begun again there, cut it"
            )
            remarks[text] = None
    if not remarks:
        return log
    signals: dict[str, Signal] = {}
    for name, signal in log.signals.items():
        signals[name] = replace(signal, t=times[id(signal.t)])
    return replace(log, signals=signals, remarks=(*log.remarks, *remarks))
