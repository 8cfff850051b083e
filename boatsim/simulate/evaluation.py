"""Judges a run: the norms of its measure and the checks of its signals, beside the values they are held against."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from math import isfinite, sqrt
from typing import TypedDict

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording
from boatsim.simulate import tracking_errors
from boatsim.simulate.camera_log import FilmMeasure, film
from boatsim.simulate.metric import KINDS, Measure, TooShort
from boatsim.simulate.run import Run
from boatsim.simulate.scenario import CheckTable, NormTable, Scenario

SHORT, NOT_REACHED = (
    "too short",
    "not reached",
)  # a log that ends too soon; what a whole run never did
PIECE = 100_000  # rows of a log looked at together
REPRODUCED, MISSED, UNSTATED = "reproduced", "not reproduced", "no tolerance stated"


class NormEntry(TypedDict):
    """One norm in norms.json: a `Norm` with its verdict."""

    value: float | None
    unit: str
    published: float | None
    tolerance: float | None
    guard: list[float | None] | None  # low, high; an open end is null
    ok: bool | None
    at_reported: float | None
    noise_floor: float | None
    verdict: str | None
    lacking: str | None  # why there is no value
    kind: str  # largest, rms, mean, time integral, sum over frames; "" for what is none of these


class RunEntry(TypedDict):
    """Content of norms.json."""

    scenario: str
    controller: str
    seed: int
    complete: bool
    steps: int
    saturated_steps: Mapping[str, int]  # by channel: more was sent than it takes
    norms: dict[str, NormEntry]


@dataclass(frozen=True)
class Norm:
    """One norm of a run beside the paper's value, and apart from it the band about our own value."""

    value: float | None  # None: the run never got as far as the norm asks
    unit: str
    published: float | None = None
    tolerance: float | None = None  # of what is published, where its document states one
    # low, high: no promise, only that a change does not go unseen
    guard: tuple[float, float] | None = None
    ok: bool | None = None  # whether the value lies within the guard; None: there is none
    # of measures on camera frames: at the rate reported beside the one scored
    at_reported: float | None = None
    # what the camera's noise alone would give, error-free motion, as many frames
    noise_floor: float | None = None
    lacking: str | None = None  # why there is no value
    # which value of a signal it is: largest, rms, mean, time integral, sum over frames
    kind: str = ""

    @property
    def verdict(self) -> str | None:
        """Whether what is published is reproduced, signs included; None where nothing is."""
        if self.published is None:
            return None
        if self.tolerance is None:
            return UNSTATED
        close = self.value is not None and within(self.value, self.published, self.tolerance)
        return REPRODUCED if close else MISSED

    def to_json(self) -> NormEntry:
        """Its entry in norms.json."""
        return {
            "value": self.value,
            "unit": self.unit,
            "published": self.published,
            "tolerance": self.tolerance,
            "guard": None
            if self.guard is None
            else [end if isfinite(end) else None for end in self.guard],
            "ok": self.ok,
            "at_reported": self.at_reported,
            "noise_floor": self.noise_floor,
            "verdict": self.verdict,
            "lacking": self.lacking,
            "kind": self.kind,
        }


def within(value: float, published: float, tolerance: float) -> bool:
    """Whether a value lies so near to a published one, on the edge too."""
    return abs(value - published) <= tolerance * (1 + 1e-9)


def norms(run: Run) -> dict[str, Norm]:
    """All norms the scenario asks for, by name: those of its `measure`, then its checks. Raises BadInput."""
    measure = run.scenario.measure
    found: dict[str, Norm] = {}
    try:
        found = _measured(run, measure) if measure else {}
    except TooShort:
        found = _of_nothing(run, measure)
    except BadInput:
        raise
    except Exception:
        if run.complete:
            raise
        found = _of_nothing(
            run, measure
        )  # of an interrupted run a measure may make nothing; its log is kept
    return found | {
        f"{c.signal}_{c.norm}": _checked(run.recording, c) for c in run.scenario.file.check
    }


def all_norms(run: Run) -> dict[str, Norm]:
    """Those the scenario asks for, and how well it followed its goals, which needs no asking. Raises BadInput."""
    asked, followed, barred = (
        norms(run),
        tracking_errors.errors(run.recording),
        run.scenario.file.norms,
    )
    beside = {
        name: replace(
            _judged(run, name, followed.get(name), unit), kind=KINDS[name.rpartition("_")[2]]
        )
        for name, unit in tracking_errors.units(run.scenario.goal_keys).items()
        if name in followed or name in barred  # a bar on what never was there is missed
    }
    return asked | {name: norm for name, norm in beside.items() if name not in asked}


def names(scenario: Scenario) -> set[str]:
    """Norms that a run of a scenario can have."""
    measured = type(scenario.measure).units if scenario.measure else {}
    checks = (f"{check.signal}_{check.norm}" for check in scenario.file.check)
    return {*measured, *checks, *tracking_errors.units(scenario.goal_keys)}


def _measured(run: Run, measure: Measure) -> dict[str, Norm]:
    """Norms of a measure, on the log or on the camera's frames."""
    units = type(measure).units
    if not isinstance(measure, FilmMeasure):
        values = measure.values(run.recording)
        return {
            n: _of(measure, run, _judged(run, n, values.get(n), measure.unit(n)), n) for n in units
        }
    values, beside = (
        film_values(run, measure, measure.scored),
        film_values(run, measure, measure.reported),
    )
    floor = measure.noise_floor(round(values["frames"]), run.scenario.camera) if values else {}
    found = {
        n: _judged(run, n, values.get(n), unit, beside.get(n), floor.get(n))
        for n, unit in units.items()
    }
    return {n: _of(measure, run, norm, n) for n, norm in found.items()}


def _of(measure: Measure, run: Run, norm: Norm, name: str) -> Norm:
    """A norm with what its measure says of it: which value it is, and why there is none."""
    why = ""
    if norm.lacking == NOT_REACHED:
        with suppress(
            ArithmeticError, LookupError, ValueError
        ):  # an explanation that fails must not cost the run
            why = measure.why(name, run.recording)
    return replace(
        norm, kind=measure.kind(name), lacking=f"{NOT_REACHED}: {why}" if why else norm.lacking
    )


def _of_nothing(run: Run, measure: Measure | None) -> dict[str, Norm]:
    """Norms of a measure that the log is too short for."""
    if measure is None:
        return {}
    return {
        n: replace(_judged(run, n, None, measure.unit(n)), lacking=SHORT)
        for n in type(measure).units
    }


def to_json(run: Run, norms: Mapping[str, Norm]) -> RunEntry:
    """Content of norms.json."""
    return {
        "scenario": run.scenario.name,
        "controller": str(run.scenario.file.controller["use"]),
        "seed": run.seed,
        "complete": run.complete,
        "steps": run.steps,
        "saturated_steps": run.saturated,
        "norms": {name: norm.to_json() for name, norm in norms.items()},
    }


def film_values(run: Run, measure: FilmMeasure, rate: float) -> dict[str, float]:
    """Norms of a measure on the frames of a run at a rate [Hz], which the camera's own rate is a multiple of."""
    start = run.scenario.file.start
    every = round(run.scenario.camera.rate / rate)
    return measure.of_film(
        film(run.camera, run.recording, (start.x, start.y, start.psi), every, measure.begin)
    )


def signal_norm(t: Array, x: Array, kind: str) -> float:
    """Norm of a logged signal; rows without a value (a camera between its frames) are left out.

    Over the time T of the log: inf max|x|, rms sqrt(mean x^2), l2 sqrt(T mean x^2), l1 T mean|x|, so that l1 and l2 are
    integrals that do not depend on the step.
    """
    count, largest, total, squares = 0, 0.0, 0.0, 0.0
    for start in range(0, len(x), PIECE):  # a day of rows is not copied
        part = x[start : start + PIECE]
        known = np.abs(part[np.isfinite(part)])
        count, largest = count + len(known), float(known.max(initial=largest))
        total, squares = total + float(known.sum()), squares + float((known**2).sum())
    if kind == "inf" or not count:
        return largest
    span = float(t[-1] - t[0])
    return {
        "rms": sqrt(squares / count),
        "l2": sqrt(span * squares / count),
        "l1": span * total / count,
    }[kind]


def _checked(log: Recording, check: CheckTable) -> Norm:
    if check.signal not in log.signals:
        raise BadInput(unknown_name("[[check]] signal", check.signal, log.signals))
    value = signal_norm(log.t, log[check.signal], check.norm)
    unit = log.unit(check.signal)
    unit = {"l2": f"{unit} s^0.5".strip(), "l1": tracking_errors.times_second(unit)}.get(
        check.norm, unit
    )
    return Norm(
        value, unit, guard=(0.0, check.below), ok=value < check.below, kind=KINDS[check.norm]
    )


def _judged(
    run: Run,
    name: str,
    value: float | None,
    unit: str,
    at_reported: float | None = None,
    floor: float | None = None,
) -> Norm:
    """The norm beside what the scenario says of it; its guard may be widened by the noise floor."""
    table = run.scenario.file.norms.get(name, NormTable())
    value = value if value is not None and isfinite(value) else None
    guard, ok = table.guard, None
    if guard is not None:
        more = floor if run.scenario.file.noise_widens_guards and floor is not None else 0.0
        guard = (guard[0] - more, guard[1] + more)
        ok = value is not None and guard[0] <= value <= guard[1]
    lacking = None if value is not None else NOT_REACHED if run.complete else SHORT
    return Norm(
        value, unit, table.published, table.tolerance, guard, ok, at_reported, floor, lacking
    )
