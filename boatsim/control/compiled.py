"""Controllers with a compiled law, for single runs, batches of boats and fast loops.

The law works on records (NumPy structured arrays), one row for each boat: `q.pole` and
`m.yaw.sigma` read as on objects. See `controllers/l1_joystick.py` for an example.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from typing import Any, ClassVar

import numpy as np
from numba.core.errors import NumbaExperimentalFeatureWarning
from numpy.typing import NDArray

from boatsim.control.base import Controller, Estimate, Sense
from boatsim.control.native_law import ONE, single_boat_law
from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import lean, merged, unlocked

__all__ = [
    "ONE",
    "SENSE_FIELDS",
    "SENSE",
    "CompiledController",
    "Records",
    "add_nested_records",
    "view_as_array",
    "indices_of_names",
    "lean",
    "merged",
    "record_type",
    "unlocked",
]

# numba treats the settings of a derived controller as a subtype of those of its base, with the
# common fields in the same places.
warnings.filterwarnings(
    "ignore", ".*has been considered a subtype of.*", NumbaExperimentalFeatureWarning
)
SENSE_FIELDS = tuple(f.name for f in fields(Sense) if f.name != "more")
Records = NDArray[np.void]


def record_type(*names: str, **parts: np.dtype[np.void]) -> np.dtype[np.void]:
    """Return a numpy record type of numbers and of nested records.

    Args:
        names: Names of the numbers.
        parts: Types of nested records by name.
    """
    return np.dtype([*((n, np.float64) for n in names), *parts.items()])


def add_nested_records(records: Records, **parts: Records) -> Records:
    """Return a record array with further nested records, one for each or one for all.

    Args:
        records: Records (n,).
        parts: Nested records by name, (n,) or (1,).
    """
    names = records.dtype.names or ()
    fields = [(n, records.dtype[n]) for n in names] + [(n, part.dtype) for n, part in parts.items()]
    whole = np.zeros(len(records), np.dtype(fields))
    for name in names:
        whole[name] = records[name]
    for name, part in parts.items():
        whole[name] = part
    return whole


SENSE = record_type(*SENSE_FIELDS)


class CompiledController(Controller):
    """Base of controllers whose control law is compiled, to control one boat or many at once.

    The law is compiled by `unlocked` and has the signature `law(boats, settings, memory, sense,
    goal, sent)`.

    `boats` are the rows to process. `settings` contains the parameters by name, `memory` is of the
    type `memory_type` and zero at the start; `sense` has the fields of `Sense`, `goal` those of
    `goals`, and `sent` those of `commands`, which the law fills in; `channels` are the command
    channels of the vessel in the same order.
    """

    law: ClassVar[Callable[[NDArray[np.int64], Records, Records, Records, Records, Records], None]]
    memory_type: ClassVar[np.dtype[np.void]]
    default_goals: ClassVar[Mapping[str, float]] = {}  # default set points

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """Reset all internal states of the controller."""
        self._settings, self._memory = self.settings_array(), np.zeros(1, type(self).memory_type)
        self._sense, self._goal, self._sent = (
            np.zeros(1, t) for t in (SENSE, *self.record_types())
        )
        self._run_law: Callable[[], object] | None = None

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy or a pickle contains: not the law, which is bound to these arrays."""
        return {**self.__dict__, "_run_law": None}

    def settings_array(self, count: int = 1) -> Records:
        """Return the controller's parameters as an array of equal records for its compiled law.

        Args:
            count: Number of equal controllers.
        """
        names = [f.name for f in fields(self) if "param" in f.metadata or f.type in (bool, "bool")]
        row = tuple(float(getattr(self, n)) for n in names)
        return np.full(count, np.array([row], record_type(*names)))

    @classmethod
    def record_types(cls) -> tuple[np.dtype[np.void], np.dtype[np.void]]:
        """Return the numpy record types of the controller's goals and of its commands."""
        return record_type(*cls.goals), record_type(*cls.commands)

    @classmethod
    def goal_values(cls, goal: Mapping[str, float]) -> tuple[float, ...]:
        """Return the values of given set points as a tuple in the order of the compiled law.

        Args:
            goal: Set points by name.

        Raises:
            KeyError: A set point without a default is missing.
        """
        return tuple([goal[n] if n in goal else cls.default_goals[n] for n in cls.goals])

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the controller's commands for the next period, by name of channel.

        Args:
            sense: Sensor readings.
            goal: Set points by name.
        """
        self._sense[0] = tuple([getattr(sense, n) for n in SENSE_FIELDS])
        self._goal[0] = self.goal_values(goal)
        if self._run_law is None:
            records = (self._settings, self._memory, self._sense, self._goal, self._sent)
            self._run_law = single_boat_law(type(self).law, records)
        self._run_law()
        return dict(zip(self.channels(), self._sent[0].item(), strict=True))

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the estimates of the controller for one state of its memory, or for several.

        Controllers with estimates override it.

        Args:
            memory: One record of the type `memory_type`, or an array of such records; its fields
                are numbers, or arrays with a number for each record.
        """
        return {}

    def estimates(self) -> dict[str, Estimate]:
        """Return the controller's present estimates, for the log of a run."""
        found: dict[str, Estimate] = {}
        for name, (value, low, high) in self.estimates_from(self.single_memory_record).items():
            found[name] = Estimate(float(value), float(low), float(high))
        return found

    @property
    def memory(self) -> Records:
        """State of the controller, a record array (1,), which a compiled run advances in place."""
        return self._memory

    @property
    def only_evaluates_law(self) -> bool:
        """Whether a step of the controller does nothing but evaluate its compiled law.

        A subclass with another `step` has to be called from Python.
        """
        return type(self).step is CompiledController.step

    @property
    def single_memory_record(self) -> Any:
        """State (memory) of the controller as one numpy record, the only one of `memory`."""
        return self._memory[0]


def view_as_array(records: Records) -> Array:
    """Return a record array of numbers as a plain array (a view), one row for each record.

    Args:
        records: Records (n,) of numbers.
    """
    return (
        records.view(np.float64).reshape(len(records), -1)
        if records.dtype.names
        else np.zeros((len(records), 0))
    )


def indices_of_names(names: Sequence[str], among: Sequence[str]) -> NDArray[np.int64]:
    """Return the index of each given name in a sequence of names.

    Args:
        names: Names.
        among: Sequence that contains them.
    """
    return np.array([list(among).index(n) for n in names], dtype=np.int64)
