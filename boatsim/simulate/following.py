"""How well a boat follows its goals: every goal that is a signal of the motion is judged, asked for or not."""

from collections.abc import Iterable, Iterator
from math import degrees, pi, sqrt

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.signals import follower
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording

GOAL = "goal_"  # in front of a goal's key: its column in the log
ENDINGS = ("rms", "largest", "integral")  # of a norm's name


def errors(log: Recording) -> dict[str, float]:
    """Norms of the error e between goal and signal while the goal says something, in the units of `units`.

    rms is sqrt(mean e^2), largest max|e|, integral that of |e| over time, which does not depend on the log's step.
    """
    found: dict[str, float] = {}
    for key, signal, norms in _followed(n.removeprefix(GOAL) for n in log.signals if n.startswith(GOAL)):
        if signal not in log.signals:
            continue
        off = _off(signal, log[f"{GOAL}{key}"], log[signal])
        lasts = np.append(np.diff(log.t), 0.0)  # [s] a row stands for
        known = np.isfinite(off) & (lasts > 0.0)
        e, dt = np.abs(off[known]), lasts[known]
        if not len(e):
            continue
        values = sqrt(float((e**2 * dt).sum() / dt.sum())), float(e.max()), float((e * dt).sum())
        found |= dict(zip(norms, values, strict=True))
    return found


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
