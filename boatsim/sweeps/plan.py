"""What a sweep is: scenarios, a grid, draws that are the same at every point of it, and the runs that follow."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from itertools import product
from json import dumps
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.content import find
from boatsim.physics.signals import Array
from boatsim.simulate.cases import Place, content, meant
from boatsim.simulate.evaluation import metric_names
from boatsim.simulate.run import run
from boatsim.simulate.scenario import from_table
from boatsim.sweeps.axes import Axis
from boatsim.sweeps.designs import Kind, seed_of, shares
from boatsim.sweeps.keys import Said, Slot, Target, Value, laid, slots
from boatsim.sweeps.runs import Told
from boatsim.sweeps.sampled_keys import Draw
from boatsim.version import version

MOST = 10_000_000  # runs
BEGINNING = 2  # steps of a run in which it shows whether it can begin


class Point(NamedTuple):
    """A point of the grid: one scenario with the values varied, and where the drawn ones stand in it."""

    scenario: str
    varied: tuple[Value, ...]
    said: Said
    place: Place
    drawn: tuple[list[Slot], ...]


@dataclass(frozen=True)
class Plan:
    """All that decides what a sweep computes."""

    scenarios: tuple[str, ...]  # as `meant` gives them
    axes: tuple[Axis, ...]
    draws: tuple[Draw, ...]
    runs: int  # of each point; of Saltelli's design rows of one of its blocks
    seed: int
    kind: Kind = "random"

    @cached_property
    def points(self) -> tuple[Point, ...]:
        """Scenario by scenario, the last axis fastest. Raises BadInput for keys and values that can not be."""
        grid = list(product(*(axis.values for axis in self.axes)))
        return tuple(self._point(name, values) for name in self.scenarios for values in grid)

    @cached_property
    def shares(self) -> Array:
        """(N, D) of the draws at every point."""
        return shares(self.kind, [d.target.name for d in self.draws], self.runs, self.seed)

    @cached_property
    def drawn(self) -> list[tuple[Value, ...]]:
        """The values of each of the N draws."""
        columns = [d.at(self.shares[:, k]) for k, d in enumerate(self.draws)]
        return list(zip(*columns, strict=True)) if columns else [() for _ in range(self.runs)]

    @property
    def count(self) -> int:
        """Runs of all points."""
        return len(self.points) * len(self.drawn)

    @property
    def targets(self) -> list[Target]:
        """What is varied, then what is drawn."""
        return [*(axis.target for axis in self.axes), *(draw.target for draw in self.draws)]

    @property
    def columns(self) -> list[str]:
        """What is varied and drawn, as its columns are called."""
        several = ["scenario"] if len(self.scenarios) > 1 else []
        return [*several, *(target.name for target in self.targets)]

    @cached_property
    def differ(self) -> list[str]:
        """Those columns of the grid in which its points differ."""
        several = ["scenario"] if len(self.scenarios) > 1 else []
        return [*several, *(axis.target.name for axis in self.axes if len(axis.values) > 1)]

    def point(self, number: int) -> tuple[Value, ...]:
        """In what a point of the grid differs from the others, by its number."""
        at = self.points[number]
        varied = (v for v, axis in zip(at.varied, self.axes, strict=True) if len(axis.values) > 1)
        return (*((at.scenario,) if len(self.scenarios) > 1 else ()), *varied)

    def values(self, number: int) -> tuple[Value, ...]:
        """What was varied and drawn in a run."""
        point = self.points[number // len(self.drawn)]
        several = (point.scenario,) if len(self.scenarios) > 1 else ()
        return (*several, *point.varied, *self.drawn[number % len(self.drawn)])

    def seed_of(self, number: int) -> int | None:
        """The seed of a run; None where the seed itself is varied or drawn."""
        if any("seed" in target.keys for target in self.targets):
            return None
        return seed_of(self.kind, self.seed, number % len(self.drawn))

    def tasks(self) -> Iterator[tuple[int, Told]]:
        """Every run: its number, and what it is told."""
        for number in range(self.count):
            point = self.points[number // len(self.drawn)]
            said = self._with_draws(point, self.drawn[number % len(self.drawn)])
            yield number, Told(said, point.place, self.seed_of(number))

    def rehearse(self) -> set[str]:
        """Begin a run at the corners of the grid, all drawn values in their middle: it tells mistakes, and compiles.

        Returns the names of the norms that runs can have. Raises BadInput.
        """
        there = set[str]()
        middle = [d.at(np.array([0.5]))[0] for d in self.draws]
        ends = [
            {axis.values[0], axis.values[-1]} if axis.ranged else set(axis.values)
            for axis in self.axes
        ]
        for point in self.points:
            if all(value in some for value, some in zip(point.varied, ends, strict=True)):
                scenario = from_table(self._with_draws(point, middle), point.place)
                short = scenario.file.model_copy(
                    update={"duration": BEGINNING * scenario.file.step}
                )
                with suppress(BadPhysics):  # that run's failure, and told there
                    run(replace(scenario, file=short))
                there |= metric_names(scenario)
        return there

    def about(self) -> dict[str, Any]:
        """What the sweep is, for whoever goes on with it: plain words, and what the files said when it began."""
        return {
            "boatsim": version(),
            "scenarios": list(self.scenarios),
            "vary": {axis.target.name: list(axis.values) for axis in self.axes},
            "draw": {draw.target.name: str(draw) for draw in self.draws},
            "runs": self.runs,
            "design": self.kind,
            "seed": self.seed,
            "files": _digests(self.points),
        }

    def _point(self, name: str, values: tuple[Value, ...]) -> Point:
        said, place = content(name)
        told: Said = said
        for axis, value in zip(self.axes, values, strict=True):
            told, at = slots(told, place, axis.target)
            told = laid(told, place, at, axis.target.how, value)
        drawn = []
        for draw in self.draws:
            told, at = slots(told, place, draw.target)
            drawn.append(at)
        return Point(name, values, told, place, tuple(drawn))

    def _with_draws(self, point: Point, values: Sequence[Value]) -> Said:
        said = point.said
        for draw, at, value in zip(self.draws, point.drawn, values, strict=True):
            said = laid(said, point.place, at, draw.target.how, value)
        return said


def plan(
    scenarios: Sequence[str],
    axes: Sequence[Axis],
    draws: Sequence[Draw],
    runs: int,
    seed: int,
    kind: Kind = "random",
) -> Plan:
    """The plan of names as a user writes them. Raises BadInput."""
    names = [one for given in scenarios for one in meant(given)]
    made = Plan(tuple(names), tuple(axes), tuple(draws), runs, seed, kind)
    said = [*names, *(key for target in made.targets for key in target.keys)]
    if twice := next((key for key in said if said.count(key) > 1), None):
        raise BadInput(f"{twice} is given twice")
    if made.count > MOST:
        raise BadInput(f"{made.count} runs are more than {MOST}")
    return made


def _digests(points: Sequence[Point]) -> dict[str, str]:
    """Of what the scenarios say, and of the files of their vessels and controllers: a few characters each."""
    found: dict[str, str] = {}
    for point in points:
        if point.scenario not in found:
            found[point.scenario] = _digest(dumps(content(point.scenario)[0], default=str).encode())
        for path in _files(point):
            found.setdefault("/".join(path.parts[-2:]), _digest(path.read_bytes()))
    return found


def _files(point: Point) -> Iterator[Path]:
    """Those of its vessel and its controller."""
    said, folder = point.said, point.place.path.parent
    yield find("vessel", str(said["vessel"]), folder)
    controller = said["controller"]
    if isinstance(controller, Mapping):
        yield find("controller", str(controller["use"]), folder)


def _digest(data: bytes) -> str:
    return sha256(data).hexdigest()[:12]
