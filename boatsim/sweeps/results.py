"""Results of a sweep by columns: varied and sampled values, seed, metrics or reason of failure."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from json import dumps
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.physics.signals import Array
from boatsim.sweeps import table
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.plan import Plan
from boatsim.view.content_names import plain_names

NAME = "sweep.parquet"


@dataclass(frozen=True)
class Results:
    """Results of the R finished runs of a sweep, in the order of their numbers.

    Attributes:
        plan: The plan.
        entries: Result of each run, by its number.
        selection: Metrics to show; empty for all.
    """

    plan: Plan
    entries: Mapping[int, Entry]
    selection: tuple[str, ...] = ()

    @cached_property
    def run_numbers(self) -> list[int]:
        """Numbers of the finished runs in the sweep's plan."""
        return list(self.entries)

    @cached_property
    def units(self) -> dict[str, str]:
        """Unit of each metric of the sweep's runs, in the order in which runs have the metrics."""
        found: dict[str, str] = {}
        for entry in self.entries.values():
            for name, (_, unit) in entry.get("norms", {}).items():
                found[name] = unit
        return found

    @cached_property
    def labels(self) -> dict[str, str]:
        """Varied text of the sweep -> text that is shown: the name of a file, not its path."""
        labels = plain_names(self.plan.scenarios)
        for axis in self.plan.axes:
            labels |= plain_names([value for value in axis.values if isinstance(value, str)])
        return labels

    @property
    def displayed_metrics(self) -> list[str]:
        """Names of the metrics to show in the report; sweep.parquet holds all metrics."""
        if not self.selection:
            return list(self.units)
        return [name for name in self.units if name in self.selection]

    @cached_property
    def point_numbers(self) -> Array:
        """Number of the grid point of each finished run (R,)."""
        return np.array(self.run_numbers, dtype=int) // len(self.plan.samples)

    @cached_property
    def sample_numbers(self) -> Array:
        """Number of the random sample of each finished run (R,).

        Runs with the same number have the same sampled values.
        """
        return np.array(self.run_numbers, dtype=int) % len(self.plan.samples)

    @cached_property
    def failed_mask(self) -> Array:
        """Whether each run of the sweep failed (R,)."""
        return np.array([reason is not None for reason in self._failures], dtype=bool)

    @cached_property
    def metrics(self) -> dict[str, Array]:
        """Values (R,) of each metric over the runs of the sweep, nan where a run has none."""
        # A float array holds None as nan.
        return {name: np.array(self._metric_values(name), dtype=float) for name in self.units}

    @property
    def _failures(self) -> list[str | None]:
        """Reason of each failed run; None for the others."""
        return list(map(itemgetter("failure"), self.entries.values()))

    def _metric_values(self, metric: str) -> list[float | None]:
        return [entry.get("norms", {}).get(metric, (None,))[0] for entry in self.entries.values()]

    def column_values(self, name: str) -> list[Any]:
        """Return the values (R,) of a varied or sampled quantity, by its column in the table.

        Args:
            name: Name of the column.
        """
        index = self.plan.columns.index(name)
        return [self.plan.run_values(number)[index] for number in self.run_numbers]

    @property
    def failure_counts(self) -> dict[str, int]:
        """Reasons for which runs failed, with numbers of runs, the most frequent first."""
        return dict(Counter(filter(None, self._failures)).most_common())

    def columns(self) -> dict[str, Sequence[Any]]:
        """Return all columns of a sweep's table, from varied values to metrics and failures."""
        columns: dict[str, Sequence[Any]] = {
            "run": self.run_numbers,
            "point": self.point_numbers.tolist(),
            "draw": self.sample_numbers.tolist(),
        }
        rows = list(map(self.plan.run_values, self.run_numbers))
        for index, name in enumerate(self.plan.columns):
            columns[name] = list(map(itemgetter(index), rows))
        if "seed" not in self.plan.columns:
            columns["seed"] = list(map(self.plan.run_seed, self.run_numbers))
        for name in self.units:
            columns[name] = self._metric_values(name)
        columns["guards_met"] = [entry.get("met") for entry in self.entries.values()]
        columns["failure"] = self._failures
        return columns

    def write(self, folder: Path) -> None:
        """Write the results of the sweep to sweep.parquet.

        Args:
            folder: Output folder.

        Raises:
            OSError: The file cannot be written.
        """
        about = dumps(self.plan.definition(), ensure_ascii=False)
        table.write_parquet(self.columns(), self.units, about, folder / NAME)
