"""Controllers whose law is compiled: one text for a single run, a batch of boats and loops faster than Python is.

The law works on records (NumPy's structured arrays), a row a boat: `q.pole` and `m.yaw.sigma` read as they would on
objects. `controllers/l1_joystick.py` shows one.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from typing import Any, ClassVar

import numpy as np
from numba.core.errors import NumbaExperimentalFeatureWarning
from numpy.typing import NDArray

from boatsim.control.base import Controller, Sense
from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import lean, merged, unlocked

__all__ = [
    "FELT",
    "SENSE",
    "CompiledController",
    "Records",
    "as_table",
    "columns",
    "lean",
    "merged",
    "record",
    "unlocked",
    "with_parts",
]

# A controller built on another has its settings and more: to numba that is a subtype, with fields
# where they were.
warnings.filterwarnings(
    "ignore", ".*has been considered a subtype of.*", NumbaExperimentalFeatureWarning
)
FELT = tuple(f.name for f in fields(Sense) if f.name != "more")
Records = NDArray[np.void]
ONE = np.zeros(1, dtype=np.int64)  # the only boat of a single run


def record(*names: str, **parts: np.dtype[np.void]) -> np.dtype[np.void]:
    """Record of numbers, and of records within it."""
    return np.dtype([*((n, np.float64) for n in names), *parts.items()])


def with_parts(records: Records, **parts: Records) -> Records:
    """Records with further records within, one for each or one for all."""
    names = records.dtype.names or ()
    fields = [(n, records.dtype[n]) for n in names] + [(n, part.dtype) for n, part in parts.items()]
    whole = np.zeros(len(records), np.dtype(fields))
    for name in names:
        whole[name] = records[name]
    for name, part in parts.items():
        whole[name] = part
    return whole


SENSE = record(*FELT)


class CompiledController(Controller):
    """Base of controllers with `law(boats, settings, memory, sense, goal, sent)`, compiled by `unlocked`.

    `boats` are the rows it is to work on. `settings` hold the controller's parameters by name, `memory` is of the type
    `remembers`, zeros at the start; `sense` has the fields of `Sense`, `goal` those of `goals`, and `sent` those of
    `commands`, to be filled in.
    """

    law: ClassVar[Callable[[NDArray[np.int64], Records, Records, Records, Records, Records], None]]
    remembers: ClassVar[np.dtype[np.void]]
    unsaid: ClassVar[Mapping[str, float]] = {}  # what goals are that may be left out

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """At rest, nothing learnt."""
        self._settings, self._memory = self.settings(), np.zeros(1, type(self).remembers)
        self._sense, self._goal, self._sent = (
            np.zeros(1, t) for t in (SENSE, *self.asked_and_sent())
        )

    def settings(self, count: int = 1) -> Records:
        """Parameters of so many controllers like this one, in records."""
        names = [f.name for f in fields(self) if "param" in f.metadata or f.type in (bool, "bool")]
        row = tuple(float(getattr(self, n)) for n in names)
        return np.full(count, np.array([row], record(*names)))

    @classmethod
    def asked_and_sent(cls) -> tuple[np.dtype[np.void], np.dtype[np.void]]:
        """Types of goals and commands."""
        return record(*cls.goals), record(*cls.commands)

    @classmethod
    def asked(cls, goal: Mapping[str, float]) -> tuple[float, ...]:
        """What a goal says, in the order of `goals`. Raises KeyError for one that must be said."""
        return tuple([goal[n] if n in goal else cls.unsaid[n] for n in cls.goals])

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Commands for the next period."""
        self._sense[0] = tuple([getattr(sense, n) for n in FELT])
        self._goal[0] = self.asked(goal)
        type(self).law(ONE, self._settings, self._memory, self._sense, self._goal, self._sent)
        return dict(zip(type(self).commands, self._sent[0].item(), strict=True))

    @property
    def memory(self) -> Records:
        """What it remembers, a record of one: whoever steps the law instead of it goes on from there."""
        return self._memory

    @property
    def is_its_law(self) -> bool:
        """Whether it does what its law says; one with a `step` of its own does more."""
        return type(self).step is CompiledController.step

    @property
    def remembered(self) -> Any:
        """The record."""
        return self._memory[0]


def as_table(records: Records) -> Array:
    """The numbers of records, a row each; a view."""
    return (
        records.view(np.float64).reshape(len(records), -1)
        if records.dtype.names
        else np.zeros((len(records), 0))
    )


def columns(names: Sequence[str], among: Sequence[str]) -> NDArray[np.int64]:
    """Where names stand among others."""
    return np.array([list(among).index(n) for n in names], dtype=np.int64)
