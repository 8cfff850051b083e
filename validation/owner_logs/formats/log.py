"""What a logger has to write, and what an owner knows of what it wrote."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from validation.owner_logs.boats import Boat
from validation.owner_logs.instruments import Seen


@dataclass(frozen=True)
class Scale:
    """A signal of an order: its values full astern (or helm to port), at rest, full ahead (to starboard)."""

    signal: str
    low: float
    neutral: float
    high: float


@dataclass(frozen=True)
class Written:
    """A log, and of each order (`port`, `helm`, ...) the signal."""

    path: Path
    orders: dict[str, Scale] = field(default_factory=dict)


Writer = Callable[[Seen, Boat, Path, str], Written]  # of a stem and a folder
