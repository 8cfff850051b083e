"""Tracking errors: metrics of the difference between each goal and the motion signal it is for."""

from collections.abc import Iterable
from dataclasses import replace
from math import degrees, pi, sqrt
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.signals import measured_column_for_goal
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording, join_recordings

GOAL = "goal_"  # prefix of a goal's column in the log
ENDINGS = ("rms", "largest", "integral")  # of a metric's name


class TrackingErrorSums:
    """Accumulates the tracking errors of a run whose log arrives in pieces.

    With the error e between goal and signal while the goal is in force, rms is sqrt(mean e^2),
    largest is max|e| and integral is the time integral of |e|, which does not depend on the log's
    step.
    """

    def __init__(self) -> None:
        """Begin with an empty log."""
        self._sums: dict[str, ErrorSums] = {}  # by the goal's key
        self._last: Recording | None = None  # last row, which holds until the next one

    def add_rows(self, log: Recording) -> None:
        """Include the next rows of the log in the tracking errors."""
        if self._last:
            log = join_recordings([self._last, log])
        goals = [name.removeprefix(GOAL) for name in log.signals if name.startswith(GOAL)]
        durations = np.append(np.diff(log.t), 0.0)
        for key, signal, _ in _tracked_goals(goals):
            if signal in log.signals:
                error = np.abs(_tracking_error(signal, log[f"{GOAL}{key}"], log[signal]))
                sums = self._sums.get(key, ErrorSums())
                self._sums[key] = sums.with_rows(error, durations)
        last = {name: x[-1:] for name, x in log.signals.items()}
        self._last = replace(log, t=log.t[-1:], signals=last)

    def metrics(self) -> dict[str, float]:
        """Return the tracking errors of all log rows so far: metric -> value.

        The units are those of `error_units`.
        """
        found: dict[str, float] = {}
        for key, _, names in _tracked_goals(self._sums):
            sums = self._sums[key]
            if sums.time:
                values = (sqrt(sums.squares / sums.time), sums.largest, sums.integral)
                found |= zip(names, values, strict=True)
        return found


class ErrorSums(NamedTuple):
    """Sums from which rms, largest value and time integral of one goal's tracking error follow.

    They cover the time in which the goal is in force.
    """

    squares: float = 0.0  # time integral of e^2
    time: float = 0.0  # [s]
    largest: float = 0.0
    integral: float = 0.0

    def with_rows(self, error: Array, durations: Array) -> "ErrorSums":
        """Return the sums of a tracking error with the errors of further log rows added.

        Args:
            error: |e| of the rows (N,), nan where no goal is in force.
            durations: How long each row holds (N,) [s].
        """
        known = np.isfinite(error) & (durations > 0.0)
        e, dt = error[known], durations[known]
        return ErrorSums(
            self.squares + float((e**2 * dt).sum()),
            self.time + float(dt.sum()),
            max(self.largest, float(e.max(initial=0.0))),
            self.integral + float((e * dt).sum()),
        )


def compute_errors(log: Recording) -> dict[str, float]:
    """Return the tracking errors of all goals in a complete log: metric -> value."""
    tally = TrackingErrorSums()
    tally.add_rows(log)
    return tally.metrics()


def error_units(goals: Iterable[str]) -> dict[str, str]:
    """Return names and units of the tracking-error metrics of goals; angles are in degrees.

    Args:
        goals: Keys of the goals.
    """
    found: dict[str, str] = {}
    for _, signal, names in _tracked_goals(goals):
        unit = unit_of(signal).replace("rad", "deg")
        found |= zip(names, (unit, unit, time_integral_unit(unit)), strict=True)
    return found


def time_integral_unit(unit: str) -> str:
    """Return the unit of a quantity's time integral, such as "m" for "m/s" and "m s" for "m"."""
    if unit.endswith("/s"):
        return unit.removesuffix("/s")
    return f"{unit} s".strip()


def _tracked_goals(goals: Iterable[str]) -> list[tuple[str, str, list[str]]]:
    """Each goal that is for a motion signal: its key, the signal and the names of its metrics.

    The metrics have the key without its unit, unless that is ambiguous: yaw_rad and yaw_radps.
    """
    signals: dict[str, str] = {}
    for key in goals:
        if signal := measured_column_for_goal(key):
            signals[key] = signal
    stems = [key.rpartition("_")[0] for key in signals]
    found: list[tuple[str, str, list[str]]] = []
    for (key, signal), stem in zip(signals.items(), stems, strict=True):
        name = key if stems.count(stem) > 1 else stem
        found.append((key, signal, [f"{name}_error_{ending}" for ending in ENDINGS]))
    return found


def _tracking_error(signal: str, goal: Array, reached: Array) -> Array:
    """Error (N,), in degrees for angles; that of a heading is at most half a turn."""
    error = reached - goal
    if signal == "psi_rad":
        error = (error + pi) % (2.0 * pi) - pi
    return error * (degrees(1.0) if "rad" in unit_of(signal) else 1.0)
