"""Plan of a sweep: scenarios, a grid, samples shared by all grid points, and the runs."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from itertools import chain, compress, product, starmap
from json import dumps
from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.content import find_content_file
from boatsim.physics.signals import Array
from boatsim.simulate.cases import ScenarioLocation, find_scenarios, read_scenario
from boatsim.simulate.evaluation import metric_names
from boatsim.simulate.run import run
from boatsim.simulate.scenario import from_table
from boatsim.sweeps.axes import Axis
from boatsim.sweeps.designs import Design, noise_seed, sampling_design
from boatsim.sweeps.keys import ScenarioTable, Slot, Target, Value, find_target_values, set_values
from boatsim.sweeps.runs import RunTask
from boatsim.sweeps.sampled_keys import SampledKey
from boatsim.version import version

MOST_RUNS = 10_000_000  # more is a mistake in a number
REHEARSED_STEPS = 2  # steps of a run that show whether it can start


class Point(NamedTuple):
    """One point of the parameter grid of a sweep: a scenario with values of all axes.

    Attributes:
        scenario: Name of the scenario.
        values: Values of the axes.
        table: The scenario with these values.
        place: Where the scenario is stored.
        slots: Values of the scenario that each sampled quantity changes.
    """

    scenario: str
    values: tuple[Value, ...]
    table: ScenarioTable
    place: ScenarioLocation
    slots: tuple[list[Slot], ...]


@dataclass(frozen=True)
class Plan:
    """Definition of a sweep: scenarios, grid, sampled quantities, number of samples, seed, design.

    Attributes:
        scenarios: Addresses of the scenarios.
        axes: Axes of the grid.
        sampled: Sampled quantities.
        runs: Samples at each grid point; of Saltelli's design rows of one of its blocks.
        seed: Random seed.
        design: Sampling design.
    """

    scenarios: tuple[str, ...]
    axes: tuple[Axis, ...]
    sampled: tuple[SampledKey, ...]
    runs: int
    seed: int
    design: Design = "random"

    @cached_property
    def points(self) -> tuple[Point, ...]:
        """Points of the parameter grid, scenario by scenario, the last axis fastest.

        Raises BadInput for wrong keys.
        """
        grid = product(*map(attrgetter("values"), self.axes))
        return tuple(starmap(self._make_point, product(self.scenarios, grid)))

    @cached_property
    def probabilities(self) -> Array:
        """Probabilities (N, D) at which the D sampled distributions are inverted for N samples."""
        names = list(map(attrgetter("target.name"), self.sampled))
        return sampling_design(self.design, names, self.runs, self.seed)

    @cached_property
    def samples(self) -> list[tuple[Value, ...]]:
        """Values of the sampled quantities in each of the N samples of the sweep."""
        if not self.sampled:
            return [()] * self.runs
        columns = []
        for sampled, probabilities in zip(self.sampled, self.probabilities.T, strict=True):
            columns.append(sampled.quantiles(probabilities))
        return list(zip(*columns, strict=True))

    @property
    def run_count(self) -> int:
        """Number of runs of the sweep: grid points times samples."""
        return len(self.points) * len(self.samples)

    @property
    def targets(self) -> list[Target]:
        """Scenario keys that the sweep changes: those of the axes, then the sampled ones."""
        return list(map(attrgetter("target"), chain(self.axes, self.sampled)))

    @property
    def columns(self) -> list[str]:
        """Names of the table columns with the varied and sampled values of each run."""
        return [*self._scenario_column, *map(attrgetter("name"), self.targets)]

    @cached_property
    def differing_columns(self) -> list[str]:
        """Names of the table columns in which the grid points of the sweep differ."""
        axes = [axis.target.name for axis in self.axes if len(axis.values) > 1]
        return [*self._scenario_column, *axes]

    @property
    def _scenario_column(self) -> list[str]:
        if len(self.scenarios) > 1:
            return ["scenario"]
        return []

    def point_values(self, number: int) -> tuple[Value, ...]:
        """Return the varied values of a grid point of the sweep, in `differing_columns`.

        Args:
            number: Number of the grid point.
        """
        point = self.points[number]
        several = [len(self.scenarios) > 1, *(len(axis.values) > 1 for axis in self.axes)]
        return tuple(compress((point.scenario, *point.values), several))

    def run_values(self, number: int) -> tuple[Value, ...]:
        """Return the varied and sampled values of a run of the sweep, in the order of `columns`.

        Args:
            number: Number of the run.
        """
        point = self.points[number // len(self.samples)]
        sample = self.samples[number % len(self.samples)]
        scenario = (point.scenario,) if len(self.scenarios) > 1 else ()
        return (*scenario, *point.values, *sample)

    def run_seed(self, number: int) -> int | None:
        """Return the noise seed of a run of the sweep.

        The result is None where the seed itself is varied or sampled.

        Args:
            number: Number of the run.
        """
        if any("seed" in target.keys for target in self.targets):
            return None
        return noise_seed(self.design, self.seed, number % len(self.samples))

    def tasks(self) -> Iterator[tuple[int, RunTask]]:
        """Yield the number and the task of every run of the sweep."""
        for number in range(self.run_count):
            point = self.points[number // len(self.samples)]
            table = self._apply_sample(point, self.samples[number % len(self.samples)])
            yield number, RunTask(table, point.place, self.run_seed(number))

    def smoke_test_corners(self) -> set[str]:
        """Start a short run at each corner of the grid, with sampled quantities at their medians.

        This finds mistakes in keys and values, and compiles the vessels, before the sweep begins.

        Returns:
            Names of the metrics that runs can have.

        Raises:
            BadInput: A key or a value is wrong.
        """
        metrics: set[str] = set()
        medians = [one.quantiles(np.array([0.5]))[0] for one in self.sampled]
        for point in self.points:
            if not all(map(_is_corner, self.axes, point.values)):
                continue
            scenario = from_table(self._apply_sample(point, medians), point.place)
            duration = REHEARSED_STEPS * scenario.file.step
            short = scenario.file.model_copy(update={"duration": duration})
            with suppress(BadPhysics):  # A failure of that run, which its entry reports.
                run(replace(scenario, file=short))
            metrics |= metric_names(scenario)
        return metrics

    def definition(self) -> dict[str, Any]:
        """Return the definition of the sweep with digests of its files.

        It is stored in the journal, so that only the same sweep can continue there.
        """
        return {
            "boatsim": version(),
            "scenarios": list(self.scenarios),
            "vary": {axis.target.name: list(axis.values) for axis in self.axes},
            "draw": {one.target.name: str(one) for one in self.sampled},
            "runs": self.runs,
            "design": self.design,
            "seed": self.seed,
            "files": _file_digests(self.points),
        }

    def _make_point(self, name: str, values: tuple[Value, ...]) -> Point:
        own, place = read_scenario(name)
        table: ScenarioTable = own
        for axis, value in zip(self.axes, values, strict=True):
            table, slots = find_target_values(table, place, axis.target)
            table = set_values(table, place, slots, axis.target.operation, value)
        sampled = []
        for one in self.sampled:
            table, slots = find_target_values(table, place, one.target)
            sampled.append(slots)
        return Point(name, values, table, place, tuple(sampled))

    def _apply_sample(self, point: Point, values: Sequence[Value]) -> ScenarioTable:
        table = point.table
        for one, slots, value in zip(self.sampled, point.slots, values, strict=True):
            table = set_values(table, point.place, slots, one.target.operation, value)
        return table


def _is_corner(axis: Axis, value: Value) -> bool:
    """Whether a value is an end of an axis of numbers; every other value is a corner."""
    return not axis.is_numeric or value in (axis.values[0], axis.values[-1])


def make_plan(
    scenarios: Sequence[str],
    axes: Sequence[Axis],
    sampled: Sequence[SampledKey],
    runs: int,
    seed: int,
    design: Design = "random",
) -> Plan:
    """Return the plan of a sweep after checks of its scenarios, keys and number of runs.

    Args:
        scenarios: Scenarios as a user writes them.
        axes: Axes of the grid.
        sampled: Sampled quantities.
        runs: Samples at each grid point.
        seed: Random seed.
        design: Sampling design.

    Raises:
        BadInput: A scenario is unknown, a key repeats, or there are too many runs.
    """
    names = tuple(chain.from_iterable(map(find_scenarios, scenarios)))
    plan = Plan(names, tuple(axes), tuple(sampled), runs, seed, design)
    unique = [*names, *chain.from_iterable(map(attrgetter("keys"), plan.targets))]
    for name in unique:
        if unique.count(name) > 1:
            raise BadInput(f"{name} is given twice")
    if plan.run_count > MOST_RUNS:
        raise BadInput(f"{plan.run_count} runs are more than {MOST_RUNS}")
    return plan


def _file_digests(points: Sequence[Point]) -> dict[str, str]:
    """Digests of the scenarios and of the files of their vessels and controllers."""
    found: dict[str, str] = {}
    for point in points:
        if point.scenario not in found:
            table = dumps(read_scenario(point.scenario)[0], default=str)
            found[point.scenario] = _digest(table.encode())
        for path in _point_files(point):
            found.setdefault("/".join(path.parts[-2:]), _digest(path.read_bytes()))
    return found


def _point_files(point: Point) -> Iterator[Path]:
    """Files of its vessel and its controller."""
    folder = point.place.path.parent
    yield find_content_file("vessel", str(point.table["vessel"]), folder)
    controller = point.table["controller"]
    if isinstance(controller, Mapping):
        yield find_content_file("controller", str(controller["use"]), folder)


def _digest(data: bytes) -> str:
    return sha256(data).hexdigest()[:12]
