"""What a sweep gave, by columns: what was varied and drawn in each run, its seed, its norms, or why it failed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from json import dumps
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.physics.signals import Array
from boatsim.sweeps import table
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.plan import Plan

NAME = "sweep.parquet"


@dataclass(frozen=True)
class Results:
    """The runs of a plan that are done, in the order of their numbers."""

    plan: Plan
    entries: Mapping[int, Entry]
    norms: tuple[str, ...] = ()  # that are told and drawn; none: all of them

    @cached_property
    def numbers(self) -> list[int]:
        """Of the runs."""
        return list(self.entries)

    @cached_property
    def units(self) -> dict[str, str]:
        """Norm -> unit, in the order in which runs have them."""
        return {
            name: unit
            for entry in self.entries.values()
            for name, (_, unit) in entry.get("norms", {}).items()
        }

    @property
    def told(self) -> list[str]:
        """Norms that are told and drawn; the table holds all."""
        return [name for name in self.units if name in self.norms or not self.norms]

    @cached_property
    def point(self) -> Array:
        """(R,) number of the grid point of each run."""
        return np.array(self.numbers, dtype=int) // len(self.plan.drawn)

    @cached_property
    def draw(self) -> Array:
        """(R,) number of the draw of each run: runs that share it share all that is drawn."""
        return np.array(self.numbers, dtype=int) % len(self.plan.drawn)

    @cached_property
    def failed(self) -> Array:
        """(R,) whether each run failed."""
        return np.array(
            [entry["failure"] is not None for entry in self.entries.values()], dtype=bool
        )

    @cached_property
    def norm(self) -> dict[str, Array]:
        """(R,) by name: each norm of each run, nan where it has none."""
        found: dict[str, Array] = {}
        for name in self.units:
            values = (
                entry.get("norms", {}).get(name, (None,))[0] for entry in self.entries.values()
            )
            found[name] = np.array(
                [np.nan if value is None else value for value in values], dtype=float
            )
        return found

    def varied(self, name: str) -> list[Any]:
        """(R,) what a column of the plan was in each run."""
        at = self.plan.columns.index(name)
        return [self.plan.values(number)[at] for number in self.numbers]

    @property
    def reasons(self) -> dict[str, int]:
        """Why runs failed, and how many of each, the most first."""
        said = [entry["failure"] for entry in self.entries.values() if entry["failure"] is not None]
        return dict(
            sorted(((r, said.count(r)) for r in dict.fromkeys(said)), key=lambda pair: -pair[1])
        )

    def columns(self) -> dict[str, Sequence[Any]]:
        """All of the table."""
        values = [self.plan.values(number) for number in self.numbers]
        entries = list(self.entries.values())
        varied = {name: [row[k] for row in values] for k, name in enumerate(self.plan.columns)}
        norms = {
            name: [e.get("norms", {}).get(name, (None,))[0] for e in entries] for name in self.units
        }
        seeds = [self.plan.seed_of(number) for number in self.numbers]
        return {
            "run": self.numbers,
            "point": self.point.tolist(),
            "draw": self.draw.tolist(),
            **varied,
            **({"seed": seeds} if "seed" not in varied else {}),
            **norms,
            "guards_met": [e.get("met") for e in entries],
            "failure": [e["failure"] for e in entries],
        }

    def write(self, folder: Path) -> None:
        """sweep.parquet. Raises OSError."""
        about = dumps(self.plan.about(), ensure_ascii=False)
        table.write(self.columns(), self.units, about, folder / NAME)
