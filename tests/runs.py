"""Runs of shipped scenarios, each made once for all tests that look at it."""

from collections.abc import Sequence
from functools import cache
from math import nan
from typing import Any

from boatsim.physics.content import shipped_content_names
from boatsim.simulate import scenario
from boatsim.simulate.cases import read_scenario
from boatsim.simulate.evaluation import Metric, requested_metrics
from boatsim.simulate.run import run

SHIPPED = tuple(
    name for name in shipped_content_names("scenario") if name.startswith("joystick_boat/")
)
TESTS = (
    "sway_1",
    "sway_2",
    "sway_3",
    "sway_4",
    "yaw_1",
    "yaw_2",
    "yaw_3",
    "yaw_4",
)  # of the thesis


def raw(name: str) -> dict[str, Any]:
    """Content of a shipped scenario."""
    return read_scenario(name)[0]


@cache
def found(name: str, seed: int = 0) -> tuple[dict[str, Metric], int]:
    """Norms of a shipped scenario, and in how many steps the hull touched a wall."""
    done = run(scenario.load(name), seed)
    return requested_metrics(done), int((done.recording["contacts"] > 0).sum())


def mean(runs: Sequence[dict[str, Metric]]) -> dict[str, float]:
    """Mean of each norm over runs; nan, which meets no bar, where one of them never reached it."""
    return {
        name: sum(nan if (value := one[name].value) is None else value for one in runs) / len(runs)
        for name in runs[0]
    }


@cache
def mean_of(name: str, seeds: int = 6) -> dict[str, float]:
    """Mean norms over seeds 0, 1, ..."""
    return mean([found(name, seed)[0] for seed in range(seeds)])
