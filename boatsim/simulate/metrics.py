"""Error norms of a run, each defined once: yaw rate of a sway, light on its circle in a turn, the log's own measures.

Sway and turn are measured as the thesis did, from camera frames: 3 Hz is scored, 6 Hz stands beside (the thesis writes
6 Hz, but only 3 Hz can give its tables). Norms are printed in the thesis' units, deg/s and deg, for people read them.
"""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from math import inf, log, pi, sqrt
from typing import Any

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording
from boatsim.simulate.run import Run
from boatsim.simulate.scenario import NORMS, CheckTable
from boatsim.simulate.sensors import Camera

SCORED, REPORTED = 3.0, 6.0  # [Hz] camera frames evaluated
DISTANCE = 0.9  # [m] sway test: three beams (T1)
CIRCLE = 0.183  # [m] radius on which the thesis expects the light (App. F)
AVERAGED = 10  # yaw rates in its moving average
FEWEST = 13  # a sway run is at least this many frames long, so that a few averages remain
DRAWS = 200  # of the camera's noise, for its floor: known to about 2 %
CLIP = 3.0  # largest residual that counts in J
SCALE = {"heading_at_0.9m": 10.0, "moved": 0.1}  # [deg], [m] for these errors in J; all others are log ratios
UNITS = {
    "yaw_rate_inf": "deg/s", "yaw_rate_l2": "deg/s", "yaw_rate_rms": "deg/s", "yaw_rate_l1": "deg/s",
    "heading_at_0.9m": "deg", "time_to_0.9m": "s", "turn_time": "s",
}  # fmt: skip  # all others are lengths


@dataclass(frozen=True)
class Norm:
    """One norm of a run beside the paper's value and the band it must lie in."""

    value: float | None  # None: the run never got as far as the norm asks
    unit: str
    published: float | None = None
    bar: dict[str, float | None] | None = None  # low, high; held against the absolute value
    ok: bool | None = None  # None: nothing was asked
    at_6hz: float | None = None
    noise_floor: float | None = None  # what the camera's noise alone would give, error-free motion, as many frames


@dataclass(frozen=True)
class Film:
    """What the camera saw and what was true at its frames, in start axes (origin and heading of the start)."""

    t: Array  # (n,) s
    light: Array  # (n, 2) m, measured
    button: Array  # (n, 2) m, measured
    place: Array  # (n, 2) m, true CG
    psi: Array  # (n,) rad, true

    def until(self, frame: int) -> "Film":
        """The frames up to and with this one."""
        n = frame + 1
        return Film(self.t[:n], self.light[:n], self.button[:n], self.place[:n], self.psi[:n])


def norms(run: Run) -> dict[str, Norm]:
    """All norms the scenario asks for, by name: those of its `measure`, then its checks. Raises BadInput."""
    file, camera = run.scenario.file, run.scenario.camera
    found: dict[str, Norm] = {}
    if file.measure in ("sway", "yaw"):
        values = camera_values(run, SCORED)
        beside = camera_values(run, REPORTED)
        floor = noise_floor(file.measure, round(values["frames"]), SCORED, camera) if values else {}
        for name in NORMS[file.measure]:
            found[name] = _judged(run, name, values.get(name), beside.get(name), floor.get(name))
    elif measure := run.scenario.measure:
        values = measure.values(run.recording)
        found = {n: _judged(run, n, values.get(n), unit=measure.unit(n)) for n in type(measure).units}
    return found | {f"{c.signal}_{c.norm}": _checked(run.recording, c) for c in file.check}


def to_json(run: Run, norms: Mapping[str, Norm]) -> dict[str, Any]:
    """Content of norms.json."""
    return {
        "scenario": run.scenario.name,
        "controller": run.scenario.file.controller["use"],
        "seed": run.seed,
        "complete": run.complete,
        "steps": run.steps,
        "saturated_steps": run.saturated,  # by channel: more was sent than it takes
        "norms": {name: asdict(norm) for name, norm in norms.items()},
    }


# The thesis' measurement ------------------------------------------------------------------------------------------


def film(run: Run, rate: float) -> Film:
    """The frames of a run at `rate` [Hz], which the camera's own rate is a multiple of."""
    every = round(run.scenario.camera.rate / rate)
    seen, truth, start = run.camera, run.recording, run.scenario.file.start
    t = seen.t[::every]
    c, s = np.cos(start.psi), np.sin(start.psi)

    def ahead(x: Array, y: Array) -> Array:
        dx, dy = x - start.x, y - start.y
        return np.stack([c * dx + s * dy, c * dy - s * dx], axis=-1)

    def mark(name: str) -> Array:
        return ahead(seen[f"camera_{name}_x_m"][::every], seen[f"camera_{name}_y_m"][::every])

    x, y, psi = (np.interp(t, truth.t, truth[name]) for name in ("x_m", "y_m", "psi_rad"))
    return Film(t, mark("led"), mark("button"), ahead(x, y), psi - start.psi)


def camera_values(run: Run, rate: float) -> dict[str, float]:
    """Norms of a sway or yaw run at a frame rate, and how many `frames` they come from; empty if it never got there."""
    measure = {"sway": sway_values, "yaw": yaw_values}[str(run.scenario.file.measure)]
    return measure(film(run, rate))


def sway_values(film: Film) -> dict[str, float]:
    """From the start to the first frame 0.9 m to starboard; empty if there is none."""
    frame = _first(film.place[:, 1] >= DISTANCE, least=FEWEST)
    if frame is None:
        return {}
    part = film.until(frame)
    line = part.light - part.button
    psi = np.unwrap(np.arctan2(line[:, 1], line[:, 0]))
    return {name: float(value) for name, value in yaw_rate_norms(psi, part.t[1] - part.t[0]).items()} | {
        "surge_offset": float(part.place[-1, 0] - part.place[0, 0]),  # x_i - x_0
        "time_to_0.9m": float(part.t[-1]),
        "frames": float(len(part.t)),
    }


def yaw_rate_norms(psi: Array, dt: float) -> dict[str, Array]:
    """Norms of the smoothed yaw rate e of headings psi (..., n) [rad] every dt [s], wanted: none."""
    rate = np.degrees(np.diff(psi)) / dt
    e = np.lib.stride_tricks.sliding_window_view(rate, AVERAGED, axis=-1).mean(-1)
    return {
        "yaw_rate_inf": np.abs(e).max(-1),  # max |e|
        "yaw_rate_l2": np.sqrt((e**2).sum(-1)),  # sqrt(sum e^2), the thesis' "2-norm"
        "yaw_rate_rms": np.sqrt((e**2).mean(-1)),  # sqrt(mean e^2)
        "yaw_rate_l1": np.abs(e).sum(-1),  # sum |e|
        "heading_at_0.9m": np.degrees(psi[..., -1] - psi[..., 0]),  # psi_i - psi_0
    }


def yaw_values(film: Film) -> dict[str, float]:
    """From the start to the first frame after a full turn either way; empty if there is none."""
    frame = _first(np.abs(film.psi - film.psi[0]) >= 2.0 * pi)
    if frame is None:
        return {}
    part = film.until(frame)
    turn = np.sign(part.psi[-1] - part.psi[0])
    away = np.hypot(*(part.place - part.place[0]).T)
    return {name: float(value) for name, value in circle_norms(part.light, float(turn)).items()} | {
        "turn_time": float(part.t[-1] - part.t[0]),  # T
        "excursion": float(away.max()),  # largest distance of the CG from its start
        "frames": float(len(part.t)),
    }


def circle_norms(light: Array, turn: float) -> dict[str, Array]:
    """Norms of the distance e of measured lights (..., n, 2) [m] to a light on the ideal circle.

    The circle of 0.183 m has the first measured light straight ahead of its middle; the ideal light goes once round it
    at a constant rate in the sense of `turn`, +1 or -1.
    """
    angle = turn * np.linspace(0.0, 2.0 * pi, light.shape[-2])
    ideal = CIRCLE * np.stack([np.cos(angle) - 1.0, np.sin(angle)], axis=-1)
    e = np.linalg.norm(light - light[..., :1, :] - ideal, axis=-1)
    return {
        "position_inf": e.max(-1),  # max e
        "position_rms": np.sqrt((e**2).mean(-1)),  # sqrt(mean e^2)
        "position_l1": e.sum(-1),  # sum e
        "moved": np.linalg.norm(light[..., -1, :] - light[..., 0, :], axis=-1),  # |last light - first light|
    }


def noise_floor(measure: str, frames: int, rate: float, camera: Camera) -> dict[str, float]:
    """Mean of each norm if the boat moved without error and only the camera's marks were noisy.

    The draws are the same whatever the seed of a run, so that the floor depends on the number of frames alone.
    """
    noise = np.random.default_rng(0).normal(0.0, camera.mark_sd, (DRAWS, frames, 2, 2))
    if measure == "sway":
        ahead = camera.baseline + noise[..., 0, 0] - noise[..., 1, 0]
        found = yaw_rate_norms(np.arctan2(noise[..., 0, 1] - noise[..., 1, 1], ahead), 1.0 / rate)
    else:
        angle = np.linspace(0.0, 2.0 * pi, frames)
        found = circle_norms(CIRCLE * np.stack([np.cos(angle), np.sin(angle)], axis=-1) + noise[..., 0, :], 1.0)
    return {name: float(np.abs(value).mean()) for name, value in found.items()}


def _first(reached: Any, least: int = 0) -> int | None:
    """Number of the first frame at which it is so, at least `least`; None if there is none."""
    if not reached.any() or len(reached) <= least:
        return None
    return max(int(np.argmax(reached)), least)


# Checks ---------------------------------------------------------------------------------------------------------------


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
    at_6hz: float | None = None,
    floor: float | None = None,
    unit: str | None = None,
) -> Norm:
    """The norm beside what the scenario says of it; its bar may be widened by the noise floor."""
    table = run.scenario.file.norms.get(name)
    unit = UNITS.get(name, "m") if unit is None else unit
    if table is None:
        return Norm(value, unit, at_6hz=at_6hz, noise_floor=floor)
    low, high = table.low, table.high
    if run.scenario.file.noise_widens_bars and floor is not None:
        low, high = (None if low is None else low - floor), (None if high is None else high + floor)
    if low is None and high is None:
        return Norm(value, unit, table.published, at_6hz=at_6hz, noise_floor=floor)
    ok = value is not None and (-inf if low is None else low) <= abs(value) <= (inf if high is None else high)
    return Norm(value, unit, table.published, {"low": low, "high": high}, ok, at_6hz, floor)


# All tests at once ------------------------------------------------------------------------------------------------


def J(tests: Iterable[tuple[Mapping[str, float], Mapping[str, float]]]) -> float:
    """Distance of several runs to published values: per test the mean of squared residuals, mean over tests, root.

    Each test is (norms, published), by name; what is not published does not count. A residual is the error over 10 deg
    or 0.1 m for heading and distance moved, a log ratio otherwise, clipped to +-3.
    """
    means = [np.mean([_residual(n, values[n], p) ** 2 for n, p in published.items()]) for values, published in tests]
    return sqrt(float(np.mean(means)))


def _residual(name: str, value: float, published: float) -> float:
    error = (value - published) / SCALE[name] if name in SCALE else log(value / published)
    return min(max(error, -CLIP), CLIP)
