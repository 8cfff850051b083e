"""One run of a sweep: from what its scenario says to its norms, or the reason why there are none."""

from collections.abc import Mapping
from math import isfinite
from typing import Any, NamedTuple

from boatsim.errors import BoatsimError
from boatsim.interruption import signal_received
from boatsim.simulate.cases import Place
from boatsim.simulate.evaluation import all_metrics
from boatsim.simulate.run import run
from boatsim.simulate.scenario import from_table
from boatsim.sweeps.journal import Entry

LONGEST = 300  # characters of a reason


class Told(NamedTuple):
    """What a run is told: plain values, so that it can be sent to a process or a node."""

    said: Mapping[str, Any]  # all that its scenario says
    place: Place  # where it says so
    seed: int | None  # None: the scenario's own


def carried_out(told: Told) -> Entry:
    """Norms by name, each with its unit, and whether all guards are met; or why it failed."""
    try:
        done = run(from_table(told.said, told.place), told.seed, progress=_ended)
        if not done.complete:
            raise KeyboardInterrupt
        norms = all_metrics(done)
    except BoatsimError as error:
        return {"failure": reason(str(error))}
    except Exception as error:  # of a controller, a law, a measure: this boat's, not the sweep's
        return {"failure": reason(f"{type(error).__name__}: {error}")}
    judged = [norm.ok for norm in norms.values() if norm.ok is not None]
    return {
        "failure": None,
        "met": all(judged) if judged else None,
        "norms": {name: [_finite(norm.value), norm.unit] for name, norm in norms.items()},
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and isfinite(value) else None


def _ended(t: float) -> None:
    """Ends a run that somebody wants to end."""
    if signal_received():
        raise KeyboardInterrupt


def reason(text: str) -> str:
    """Why something failed, as a table has it: one line, not too long."""
    return " ".join(text.split())[:LONGEST]
