"""Interface of the log writers, and the owner's knowledge of the signals."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from validation.owner_logs.boats import Boat
from validation.owner_logs.instruments import RecordedSignals


@dataclass(frozen=True)
class Scale:
    """Signal of an order: values at full astern (helm to port), rest, full ahead (starboard)."""

    signal: str
    low: float
    neutral: float
    high: float


@dataclass(frozen=True)
class WrittenLog:
    """A log and the signal of each order (`port`, `helm`, ...)."""

    path: Path
    orders: dict[str, Scale] = field(default_factory=dict)


Writer = Callable[
    [RecordedSignals, Boat, Path, str], WrittenLog
]  # the last two arguments are stem and folder
