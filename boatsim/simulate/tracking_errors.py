"""How well a boat follows its goals: every goal that is a signal of the motion is judged, asked for or not."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import degrees, pi, sqrt
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.signals import follower
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording, joined

GOAL = "goal_"  # in front of a goal's key: its column in the log
ENDINGS = ("rms", "largest", "integral")  # of a norm's name


class Tally:
    """Norms of the error e between goal and signal while the goal says something, of a log that comes in pieces.

    rms is sqrt(mean e^2), largest max|e|, integral that of |e| over time, which does not depend on the log's step.
    """

    def __init__(self) -> None:
        self._sums: dict[str, Sums] = {}  # by the goal's key
        self._last: Recording | None = None  # row, which stands for the time until the next one

    def add(self, log: Recording) -> None:
        """The rows that follow."""
        log = joined([self._last, log]) if self._last else log
        for key, signal, _ in _followed(
            n.removeprefix(GOAL) for n in log.signals if n.startswith(GOAL)
        ):
            if signal in log.signals:
                off = _off(signal, log[f"{GOAL}{key}"], log[signal])
                self._sums[key] = self._sums.get(key, Sums()).with_rows(
                    np.abs(off), np.append(np.diff(log.t), 0.0)
                )
        self._last = replace(log, t=log.t[-1:], signals={n: x[-1:] for n, x in log.signals.items()})

    def norms(self) -> dict[str, float]:
        """By name, in the units of `units`."""
        found: dict[str, float] = {}
        for key, _, names in _followed(self._sums):
            if (of := self._sums[key]).time:
                found |= dict(
                    zip(names, (sqrt(of.squares / of.time), of.largest, of.integral), strict=True)
                )
        return found


class Sums(NamedTuple):
    """Of the error |e| of one goal."""

    squares: float = 0.0  # integral of its square over time
    time: float = 0.0  # [s] while the goal said something
    largest: float = 0.0
    integral: float = 0.0

    def with_rows(self, e: Array, lasts: Array) -> "Sums":
        """With |e| (N,) of rows that last so long (N,) [s]."""
        known = np.isfinite(e) & (lasts > 0.0)
        e, dt = e[known], lasts[known]
        squares, time, integral = float((e**2 * dt).sum()), float(dt.sum()), float((e * dt).sum())
        return Sums(
            self.squares + squares,
            self.time + time,
            max(self.largest, float(e.max(initial=0.0))),
            self.integral + integral,
        )


def errors(log: Recording) -> dict[str, float]:
    """The norms of a whole log."""
    tally = Tally()
    tally.add(log)
    return tally.norms()


def units(goals: Iterable[str]) -> dict[str, str]:
    """The norms of these goals, with their units: angles in degrees."""
    found: dict[str, str] = {}
    for _, signal, norms in _followed(goals):
        unit = unit_of(signal).replace("rad", "deg")
        found |= dict(zip(norms, (unit, unit, times_second(unit)), strict=True))
    return found


def times_second(unit: str) -> str:
    """Unit of the time integral of what has a unit: m of m/s, m s of m."""
    return unit.removesuffix("/s") if unit.endswith("/s") else f"{unit} s".strip()


def _followed(goals: Iterable[str]) -> Iterator[tuple[str, str, list[str]]]:
    """Each goal that is a signal of the motion, that signal, its norms: a whole key tells yaw_rad from yaw_radps."""
    signals = {key: signal for key in goals if (signal := follower(key))}
    stems = [key.rpartition("_")[0] for key in signals]
    for (key, signal), stem in zip(signals.items(), stems, strict=True):
        name = key if stems.count(stem) > 1 else stem
        yield key, signal, [f"{name}_error_{ending}" for ending in ENDINGS]


def _off(signal: str, goal: Array, reached: Array) -> Array:
    """Error (N,) in the unit that people read; of a heading the shorter way round."""
    off = reached - goal
    if signal == "psi_rad":
        off = (off + pi) % (2.0 * pi) - pi
    return off * (degrees(1.0) if "rad" in unit_of(signal) else 1.0)
