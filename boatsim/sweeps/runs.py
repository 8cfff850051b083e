"""One run of a sweep: from the table of its scenario to its metrics or the reason of failure."""

from collections.abc import Mapping
from math import isfinite
from typing import Any, NamedTuple

from boatsim.errors import BoatsimError
from boatsim.interruption import signal_received
from boatsim.simulate.cases import ScenarioLocation
from boatsim.simulate.evaluation import all_metrics
from boatsim.simulate.run import run
from boatsim.simulate.scenario import from_table
from boatsim.sweeps.journal import Entry

LONGEST_REASON = 300  # characters


class RunTask(NamedTuple):
    """Task to run one scenario of a sweep.

    It holds plain values, so that it can be sent to a process or a node.

    Attributes:
        table: The scenario.
        place: Where the scenario is stored.
        seed: Random seed; None for the scenario's own.
    """

    table: Mapping[str, Any]
    place: ScenarioLocation
    seed: int | None


def perform_run(task: RunTask) -> Entry:
    """Perform one run of a sweep and return its metrics.

    Args:
        task: The run.

    Returns:
        Metrics with their units, and whether all regression bands are met; or only the reason of a
        failure.
    """
    try:
        scenario = from_table(with_fastest_engine(task.table), task.place)
        done = run(scenario, task.seed, progress=_stop_if_interrupted)
        if not done.complete:
            raise KeyboardInterrupt
        metrics = all_metrics(done)
    except BoatsimError as error:
        return failure_entry(str(error))
    except Exception as error:  # An error in a controller, an effect or a metric of the user.
        return failure_entry(f"{type(error).__name__}: {error}")
    met: bool | None = None
    norms = {}
    for name, metric in metrics.items():
        norms[name] = [_finite_or_none(metric.value), metric.unit]
        if metric.ok is not None:
            met = metric.ok and met is not False
    return {"failure": None, "met": met, "norms": norms}


def with_fastest_engine(table: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a scenario that runs on the compiled engine if it has no walls and states no engine.

    The numbers are those of MuJoCo up to rounding, in less time (`python -m benchmarks.sweeps`).

    Args:
        table: The scenario.
    """
    if table.get("tank") or "engine" in table:
        return table
    return {**table, "engine": "compiled"}


def _finite_or_none(value: float | None) -> float | None:
    if value is None or not isfinite(value):
        return None
    return value


def _stop_if_interrupted(t: float) -> None:
    if signal_received():
        raise KeyboardInterrupt


def failure_entry(reason: str) -> Entry:
    """Return the journal entry of a task of a campaign that failed.

    Args:
        reason: Why; it is stored in one line and cut if it is long.
    """
    return {"failure": " ".join(reason.split())[:LONGEST_REASON]}
