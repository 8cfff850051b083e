"""State of the conversion of a log to a recording."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from boatsim.errors import BadInput, nearest_hint
from boatsim.physics.base import Array
from boatsim.recordings.expression import Expression, parse
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import Map
from boatsim.recordings.importing.resample import Samples
from boatsim.recordings.importing.several_logs import Span

# Prefixes of columns that, like commands, are in force until the next value
HELD = (
    "stick_",
    "sent_",
    "reference_",
)


@dataclass(frozen=True)
class Column:
    """A column before resampling to the rows; `held` values are in force until the next sample."""

    given: Samples
    held: bool


@dataclass
class ConversionState:
    """State of a conversion, with the remarks on it.

    Attributes:
        log: The log.
        file: Name of the map in messages.
        map: Signals of the columns.
        channels: Allowed range (low, high) of the vessel's commands.
        columns: Columns so far.
        remarks: Remarks so far.
        begin: First time of the log [s].
        spans: Span of each file of the log.
    """

    log: Log
    file: str
    map: Map
    channels: Mapping[str, tuple[float, float]]
    columns: dict[str, Column] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    begin: float = 0.0
    spans: Mapping[str, Span] = field(default_factory=dict)

    def remark(self, text: str) -> None:
        """Add a remark on the log."""
        self.remarks.append(f"{self.log.path}: {text}")

    def first_of(self, t: Array) -> str:
        """Return when the first of some samples was logged, in words.

        Args:
            t: Times (N,) of the samples [s], at least one.
        """
        return f"first {float(t.min()) - self.begin:.3f} s after the log begins"


def signal_of(work: ConversionState, key: str, text: str) -> tuple[Signal, Expression]:
    """Return the signal of an expression of the map, and the expression.

    Args:
        work: State of the conversion.
        key: Key of the map in messages.
        text: The expression.

    Raises:
        BadInput: The expression is wrong, or the log has no such signal.
    """
    try:
        found = parse(text, work.log.signals.keys())
    except BadInput as error:
        raise BadInput(f"{work.file}: {key} = {text[:80]!r}: {error}") from None
    if found.signal not in work.log.signals:
        hint = nearest_hint(found.signal, work.log.signals)
        raise BadInput(
            f"{work.file}: {key} = {text[:80]!r}: {work.log.path.name} has no signal "
            f"{found.signal!r}{hint} (it has "
            f"{len(work.log.signals)}; boatsim import {work.log.path.name} lists them)"
        )
    return work.log.signals[found.signal], found
