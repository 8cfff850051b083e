"""Metrics of a run: those of its metric set and of its checks, with published values and bands."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from math import isfinite, sqrt
from typing import TypedDict

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording
from boatsim.simulate import tracking_errors
from boatsim.simulate.camera_metric import CameraMetricSet, select_camera_frames
from boatsim.simulate.metric import KINDS, MetricSet, TooShort
from boatsim.simulate.run import Run
from boatsim.simulate.scenario import CheckTable, MetricTable, Scenario

SHORT = "too short"  # reason for a missing value: the log ends before the data are complete
NOT_REACHED = "not reached"  # reason for a missing value: a complete run did not meet the condition
PIECE = 100_000  # [rows] of a log processed at a time, so that a log of a day is not copied
REPRODUCED = "reproduced"
MISSED = "not reproduced"
NO_TOLERANCE = "no tolerance stated"


class MetricEntry(TypedDict):
    """Entry of one metric in norms.json: value, published value, regression band and verdict."""

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
    kind: str  # largest, rms, mean, time integral, sum over frames; "" for others


class RunEntry(TypedDict):
    """Content of norms.json: the metrics of a run and what was run."""

    scenario: str
    controller: str
    seed: int
    complete: bool
    steps: int
    saturated_steps: Mapping[str, int]  # channel -> steps in which a command exceeded its range
    norms: dict[str, MetricEntry]


@dataclass(frozen=True)
class Metric:
    """Value of one metric of a run, with published value and regression band for comparison.

    Attributes:
        value: The value; None if the run did not reach the metric's condition.
        unit: Unit of all values.
        published: Value in the publication that the scenario reproduces.
        tolerance: Tolerance of `published`, where the publication states one.
        band: Regression band (low, high). It makes a change visible and promises no accuracy.
        ok: Whether the value lies within the band; None without a band.
        at_reported: For metrics on camera frames, the value at the second, reported frame rate.
        noise_floor: Value that the camera's noise alone causes for error-free motion and as many
            frames.
        lacking: Why there is no value.
        kind: How the metric summarises its signal: largest, rms, mean, time integral, sum over
            frames.
    """

    value: float | None
    unit: str
    published: float | None = None
    tolerance: float | None = None
    band: tuple[float, float] | None = None
    ok: bool | None = None
    at_reported: float | None = None
    noise_floor: float | None = None
    lacking: str | None = None
    kind: str = ""

    @property
    def verdict(self) -> str | None:
        """Whether a metric reproduces its published value, sign included; None without one."""
        if self.published is None:
            return None
        if self.tolerance is None:
            return NO_TOLERANCE
        if self.value is not None and within_tolerance(self.value, self.published, self.tolerance):
            return REPRODUCED
        return MISSED

    def to_json(self) -> MetricEntry:
        """Return the entry of a metric in norms.json."""
        ends = None
        if self.band is not None:
            ends = [end if isfinite(end) else None for end in self.band]
        return {
            "value": self.value,
            "unit": self.unit,
            "published": self.published,
            "tolerance": self.tolerance,
            "guard": ends,
            "ok": self.ok,
            "at_reported": self.at_reported,
            "noise_floor": self.noise_floor,
            "verdict": self.verdict,
            "lacking": self.lacking,
            "kind": self.kind,
        }


def within_tolerance(value: float, published: float, tolerance: float) -> bool:
    """Return whether a metric differs from its published value by at most the tolerance."""
    return abs(value - published) <= tolerance * (1 + 1e-9)


def requested_metrics(run: Run) -> dict[str, Metric]:
    """Return the metrics of a run that its scenario requests.

    Args:
        run: A run, which may have been interrupted.

    Returns:
        Metrics by name: those of the scenario's metric set, then those of its checks.

    Raises:
        BadInput: If a signal is missing.
    """
    metric_set = run.scenario.measure
    found: dict[str, Metric] = {}
    try:
        if metric_set:
            found = _metrics_of_set(run, metric_set)
    except TooShort:
        found = _metrics_without_values(run, metric_set)
    except BadInput:
        raise
    except Exception:
        if run.complete:
            raise
        # a metric set may fail on the log of an interrupted run, which is kept all the same
        found = _metrics_without_values(run, metric_set)
    for check in run.scenario.file.check:
        found[f"{check.signal}_{check.norm}"] = _check_metric(run.recording, check)
    return found


def all_metrics(run: Run) -> dict[str, Metric]:
    """Return all metrics of a run: those its scenario requests, and tracking errors of its goals.

    Tracking errors are always computed.

    Args:
        run: A run, which may have been interrupted.

    Returns:
        Metrics by name.

    Raises:
        BadInput: If a signal is missing.
    """
    found = requested_metrics(run)
    errors = tracking_errors.compute_errors(run.recording)
    for name, unit in tracking_errors.error_units(run.scenario.goal_keys).items():
        # a band on a tracking error that never occurred is not met
        if name not in found and (name in errors or name in run.scenario.file.norms):
            kind = KINDS[name.rpartition("_")[2]]
            found[name] = replace(_make_metric(run, name, errors.get(name), unit), kind=kind)
    return found


def metric_names(scenario: Scenario) -> set[str]:
    """Return the names of all metrics that runs of a scenario can have."""
    found = set(tracking_errors.error_units(scenario.goal_keys))
    found |= {f"{check.signal}_{check.norm}" for check in scenario.file.check}
    if scenario.measure:
        found |= type(scenario.measure).units.keys()
    return found


def _metrics_of_set(run: Run, metric_set: MetricSet) -> dict[str, Metric]:
    """Metrics of a metric set, computed from the log or from the camera frames."""
    found: dict[str, Metric] = {}
    if not isinstance(metric_set, CameraMetricSet):
        values = metric_set.values(run.recording)
        for name in type(metric_set).units:
            metric = _make_metric(run, name, values.get(name), metric_set.unit(name))
            found[name] = _add_kind_and_reason(metric_set, run, metric, name)
        return found
    values = camera_metrics(run, metric_set, metric_set.scored)
    reported = camera_metrics(run, metric_set, metric_set.reported)
    floor: dict[str, float] = {}
    if values:
        floor = metric_set.noise_floor(round(values["frames"]), run.scenario.camera)
    for name, unit in type(metric_set).units.items():
        metric = _make_metric(
            run, name, values.get(name), unit, reported.get(name), floor.get(name)
        )
        found[name] = _add_kind_and_reason(metric_set, run, metric, name)
    return found


def _add_kind_and_reason(metric_set: MetricSet, run: Run, metric: Metric, name: str) -> Metric:
    """Add the kind of a metric and, where it has no value, the reason."""
    reason = ""
    if metric.lacking == NOT_REACHED:
        # an explanation that fails must not cost the run
        with suppress(ArithmeticError, LookupError, ValueError):
            reason = metric_set.explain_missing_value(name, run.recording)
    lacking = f"{NOT_REACHED}: {reason}" if reason else metric.lacking
    return replace(metric, kind=metric_set.kind(name), lacking=lacking)


def _metrics_without_values(run: Run, metric_set: MetricSet | None) -> dict[str, Metric]:
    """Metrics of a metric set whose log is too short."""
    found: dict[str, Metric] = {}
    if metric_set is not None:
        for name in type(metric_set).units:
            metric = _make_metric(run, name, None, metric_set.unit(name))
            found[name] = replace(metric, lacking=SHORT)
    return found


def to_json(run: Run, metrics: Mapping[str, Metric]) -> RunEntry:
    """Return the content of norms.json for a run: its metrics, seed, steps and saturated commands.

    Args:
        run: The run.
        metrics: Its metrics by name.
    """
    return {
        "scenario": run.scenario.name,
        "controller": str(run.scenario.file.controller["use"]),
        "seed": run.seed,
        "complete": run.complete,
        "steps": run.steps,
        "saturated_steps": run.saturated,
        "norms": {name: metric.to_json() for name, metric in metrics.items()},
    }


def camera_metrics(run: Run, metric_set: CameraMetricSet, rate: float) -> dict[str, float]:
    """Compute the metrics of a run from its camera frames, at a lower frame rate.

    Args:
        run: The run.
        metric_set: What to compute.
        rate: Frame rate [Hz]; the camera's own rate is a multiple of it.

    Returns:
        Value by metric.
    """
    start = run.scenario.file.start
    every = round(run.scenario.camera.rate / rate)
    pose = (start.x, start.y, start.psi)
    return metric_set.values_from_frames(
        select_camera_frames(run.camera, run.recording, pose, every, metric_set.begin)
    )


def signal_norm(t: Array, x: Array, kind: str) -> float:
    """Compute a norm of a logged signal over the duration T of the log.

    Rows without a value are ignored.

    Args:
        t: Times (N,) [s].
        x: Signal (N,); rows between two frames of a camera are nan.
        kind: "inf" max|x|, "rms" sqrt(mean x^2), "l2" sqrt(T mean x^2) or "l1" T mean|x|; l1 and
            l2 are integrals, which do not depend on the step.

    Returns:
        The norm; 0 if there is no value.
    """
    count, largest, total, squares = 0, 0.0, 0.0, 0.0
    for start in range(0, len(x), PIECE):
        part = x[start : start + PIECE]
        known = np.abs(part[np.isfinite(part)])
        count += len(known)
        largest = float(known.max(initial=largest))
        total += float(known.sum())
        squares += float((known**2).sum())
    if kind == "inf" or not count:
        return largest
    span = float(t[-1] - t[0])
    return {
        "rms": sqrt(squares / count),
        "l2": sqrt(span * squares / count),
        "l1": span * total / count,
    }[kind]


def _check_metric(log: Recording, check: CheckTable) -> Metric:
    if check.signal not in log.signals:
        raise BadInput(unknown_name_message("[[check]] signal", check.signal, log.signals))
    value = signal_norm(log.t, log[check.signal], check.norm)
    unit = log.unit(check.signal)
    if check.norm == "l2":
        unit = f"{unit} s^0.5".strip()
    elif check.norm == "l1":
        unit = tracking_errors.time_integral_unit(unit)
    ok = value < check.below
    return Metric(value, unit, band=(0.0, check.below), ok=ok, kind=KINDS[check.norm])


def _make_metric(
    run: Run,
    name: str,
    value: float | None,
    unit: str,
    at_reported: float | None = None,
    floor: float | None = None,
) -> Metric:
    """The metric with the scenario's published value and band, which the noise floor may widen."""
    table = run.scenario.file.norms.get(name, MetricTable())
    lacking = None
    if value is None or not isfinite(value):
        value = None
        lacking = NOT_REACHED if run.complete else SHORT
    factor = table.unit_factor(unit)
    published, tolerance = _scale(table.published, factor), _scale(table.tolerance, factor)
    band = None
    ok = None
    if table.guard is not None:
        band = (factor * table.guard[0], factor * table.guard[1])
        if run.scenario.file.noise_widens_guards and floor is not None:
            band = (band[0] - floor, band[1] + floor)
        ok = value is not None and band[0] <= value <= band[1]
    return Metric(value, unit, published, tolerance, band, ok, at_reported, floor, lacking)


def _scale(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value
