"""Runs of shipped scenarios, each made once for all tests that look at it."""

import os
import pickle
from collections.abc import Sequence
from functools import cache
from math import nan
from pathlib import Path
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


Found = tuple[dict[str, Metric], int]


@cache
def found(name: str, seed: int = 0) -> Found:
    """Norms of a shipped scenario, and in how many steps the hull touched a wall."""
    # the folder of this test run that its processes share, from conftest.py
    file = Path(os.environ["BOATSIM_TEST_RUNS"]) / f"{name.replace('/', '+')}+{seed}.pickle"
    if file.exists():
        kept: Found = pickle.loads(file.read_bytes())
        return kept
    done = run(scenario.load(name), seed)
    result = requested_metrics(done), int((done.recording["contacts"] > 0).sum())
    part = file.with_suffix(f".{os.getpid()}")
    part.write_bytes(pickle.dumps(result))
    part.replace(file)
    return result


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
