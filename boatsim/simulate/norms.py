"""Judges a run: the norms of its measure and the checks of its signals, beside the values they are held against."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from math import inf, sqrt
from typing import Any

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording
from boatsim.simulate.film import FilmMeasure, film
from boatsim.simulate.run import Run
from boatsim.simulate.scenario import CheckTable


@dataclass(frozen=True)
class Norm:
    """One norm of a run beside the paper's value and the band it must lie in."""

    value: float | None  # None: the run never got as far as the norm asks
    unit: str
    published: float | None = None
    bar: dict[str, float | None] | None = None  # low, high; held against the absolute value
    ok: bool | None = None  # None: nothing was asked
    at_reported: float | None = None  # of measures on camera frames: at the rate reported beside the one scored
    noise_floor: float | None = None  # what the camera's noise alone would give, error-free motion, as many frames


def norms(run: Run) -> dict[str, Norm]:
    """All norms the scenario asks for, by name: those of its `measure`, then its checks. Raises BadInput."""
    measure = run.scenario.measure
    found: dict[str, Norm] = {}
    if isinstance(measure, FilmMeasure):
        values, beside = film_values(run, measure, measure.scored), film_values(run, measure, measure.reported)
        floor = measure.noise_floor(round(values["frames"]), run.scenario.camera) if values else {}
        for name, unit in type(measure).units.items():
            found[name] = _judged(run, name, values.get(name), unit, beside.get(name), floor.get(name))
    elif measure:
        values = measure.values(run.recording)
        found = {n: _judged(run, n, values.get(n), measure.unit(n)) for n in type(measure).units}
    return found | {f"{c.signal}_{c.norm}": _checked(run.recording, c) for c in run.scenario.file.check}


def to_json(run: Run, norms: Mapping[str, Norm]) -> dict[str, Any]:
    """Content of norms.json."""
    return {
        "scenario": run.scenario.name,
        "controller": run.scenario.file.controller["use"],
        "seed": run.seed,
        "complete": run.complete,
        "norms": {name: asdict(norm) for name, norm in norms.items()},
    }


def film_values(run: Run, measure: FilmMeasure, rate: float) -> dict[str, float]:
    """Norms of a measure on the frames of a run at a rate [Hz], which the camera's own rate is a multiple of."""
    start = run.scenario.file.start
    every = round(run.scenario.camera.rate / rate)
    return measure.of_film(film(run.camera, run.recording, (start.x, start.y, start.psi), every))


def signal_norm(t: Array, x: Array, kind: str) -> float:
    """Norm of a logged signal; rows without a value (a camera between its frames) are left out.

    Over the time T of the log: inf max|x|, rms sqrt(mean x^2), l2 sqrt(T mean x^2), l1 T mean|x|, so that l1 and l2 are
    integrals that do not depend on the step.
    """
    known = np.abs(x[np.isfinite(x)])
    span = float(t[-1] - t[0])
    return {
        "inf": float(known.max(initial=0.0)),
        "rms": sqrt((known**2).mean()) if len(known) else 0.0,
        "l2": sqrt(span * (known**2).mean()) if len(known) else 0.0,
        "l1": span * float(known.mean()) if len(known) else 0.0,
    }[kind]


def _checked(log: Recording, check: CheckTable) -> Norm:
    if check.signal not in log.signals:
        raise BadInput(unknown_name("[[check]] signal", check.signal, log.signals))
    value = signal_norm(log.t, log[check.signal], check.norm)
    unit = log.unit(check.signal) + {"l2": " s^0.5", "l1": " s"}.get(check.norm, "")
    return Norm(value, unit.strip(), None, {"low": None, "high": check.below}, value < check.below)


def _judged(
    run: Run,
    name: str,
    value: float | None,
    unit: str,
    at_reported: float | None = None,
    floor: float | None = None,
) -> Norm:
    """The norm beside what the scenario says of it; its bar may be widened by the noise floor."""
    table = run.scenario.file.norms.get(name)
    if table is None:
        return Norm(value, unit, at_reported=at_reported, noise_floor=floor)
    low, high = table.low, table.high
    if run.scenario.file.noise_widens_bars and floor is not None:
        low, high = (None if low is None else low - floor), (None if high is None else high + floor)
    if low is None and high is None:
        return Norm(value, unit, table.published, at_reported=at_reported, noise_floor=floor)
    ok = value is not None and (-inf if low is None else low) <= abs(value) <= (inf if high is None else high)
    return Norm(value, unit, table.published, {"low": low, "high": high}, ok, at_reported, floor)
