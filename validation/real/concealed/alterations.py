"""Real recordings written down otherwise than they were made, so that what is wrong with them is known.

Every alteration takes a recording as it is opened, before rows are thinned, and gives another. Commands are altered by
the inverse of a fault: a boat that has the fault and is given what is then written does exactly what was recorded.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

Alteration = Callable[[Recording], Recording]
KINDS = ("", "estimate_")  # of velocities: measured, and an autopilot's that no fit looks at


def unaltered(recording: Recording) -> Recording:
    """As it was recorded."""
    return recording


def chained(*alterations: Alteration) -> Alteration:
    """One after the other."""

    def alter(recording: Recording) -> Recording:
        for one in alterations:
            recording = one(recording)
        return recording

    return alter


# ---- commands


def rewritten(names: Sequence[str], written: Callable[[Array], Array]) -> Alteration:
    """Commands of these channels as `written` makes them of those given, row by row."""

    def alter(recording: Recording) -> Recording:
        changed = {n: written(recording[n]) + 0.0 for n in names}
        return replace(recording, signals={**recording.signals, **changed})

    return alter


def weaker(names: Sequence[str], factor: float) -> Alteration:
    """Motors that give `factor` of their commands: written is what was given, divided by it."""
    return rewritten(names, lambda given: given / factor)


def weaker_astern(names: Sequence[str], factor: float) -> Alteration:
    """The same astern alone."""
    return rewritten(names, lambda given: np.where(given < 0.0, given / factor, given))


def dead_band(names: Sequence[str], width: float) -> Alteration:
    """Motors that lack `width` of every command, in its unit: written is so much more, to the side that it is on."""
    return rewritten(names, lambda given: given + width * np.sign(given))


def off_by(names: Sequence[str], offset: float) -> Alteration:
    """Actuators that add `offset` to every command, in its unit: written is so much less."""
    return rewritten(names, lambda given: given - offset)


def steering_harder(names: Sequence[str], gain: float) -> Alteration:
    """Rudders that add `gain` of the size of every angle: written is what then gives the angle that there was."""
    return rewritten(names, lambda given: given / (1.0 + gain * np.sign(given)))


def late(names: Sequence[str], seconds: float) -> Alteration:
    """Commands that take effect later than they are written, or earlier; whole rows, the end (the beginning) is lost.

    To positions and commands alone that is a clock of the poses that is late by as much.
    """

    def alter(recording: Recording) -> Recording:
        rows = round(seconds / float(np.median(np.diff(recording.t))))
        n = len(recording)
        here, there = (
            (slice(0, n - rows), slice(rows, n))
            if rows >= 0
            else (slice(-rows, n), slice(0, n + rows))
        )
        signals = {k: v[there if k in names else here] for k, v in recording.signals.items()}
        return replace(recording, t=recording.t[here], signals=signals)

    return alter


# ---- the water


def current(north: float, east: float) -> Alteration:
    """The same motion through water that moves over the ground [m/s]: Galilei's transformation.

    Positions drift with it, speeds over the ground change by it; speeds through the water are those that there were.
    """

    def alter(recording: Recording) -> Recording:
        since, psi = recording.t - recording.t[0], recording["psi_rad"]
        c, s = np.cos(psi), np.sin(psi)
        added = {"x_m": north * since, "y_m": east * since}
        for kind in KINDS:
            added |= {f"{kind}u_mps": north * c + east * s, f"{kind}v_mps": east * c - north * s}
        return _plus(recording, added)

    return alter


# ---- instruments


def heading_off(offset: float, cos: float = 0.0, sin: float = 0.0) -> Alteration:
    """A compass that shows psi + offset + cos cos(psi) + sin sin(psi) [rad]; speeds are resolved along that."""

    def alter(recording: Recording) -> Recording:
        psi = recording["psi_rad"]
        off = offset + cos * np.cos(psi) + sin * np.sin(psi)
        rate = sin * np.cos(psi) - cos * np.sin(psi)
        signals = dict(recording.signals)
        for kind in KINDS:
            if f"{kind}u_mps" in signals:
                u, v = signals[f"{kind}u_mps"], signals[f"{kind}v_mps"]
                signals[f"{kind}u_mps"] = np.cos(off) * u + np.sin(off) * v
                signals[f"{kind}v_mps"] = np.cos(off) * v - np.sin(off) * u
            if f"{kind}r_radps" in signals:
                signals[f"{kind}r_radps"] = signals[f"{kind}r_radps"] * (1.0 + rate)
        return replace(recording, signals=signals | {"psi_rad": psi + off})

    return alter


def of_another_point(forward: float, starboard: float) -> Alteration:
    """Position, and speed where it was recorded, of a point so far ahead and to starboard [m]."""

    def alter(recording: Recording) -> Recording:
        psi = recording["psi_rad"]
        c, s = np.cos(psi), np.sin(psi)
        added = {"x_m": c * forward - s * starboard, "y_m": s * forward + c * starboard}
        for kind in KINDS:
            if (r := recording.signals.get(f"{kind}r_radps")) is not None:
                added |= {f"{kind}u_mps": -r * starboard, f"{kind}v_mps": r * forward}
        return _plus(recording, added)

    return alter


def stretched(x: float, y: float) -> Alteration:
    """Positions (1 + x) and (1 + y) times as far from the origin of the tank; speeds are another instrument's."""

    def alter(recording: Recording) -> Recording:
        signals = {"x_m": recording["x_m"] * (1.0 + x), "y_m": recording["y_m"] * (1.0 + y)}
        return replace(recording, signals={**recording.signals, **signals})

    return alter


def late_fixes(seconds: float) -> Alteration:
    """Positions that reach the log later than all beside them; whole rows, the beginning is lost."""

    def alter(recording: Recording) -> Recording:
        rows, n = round(seconds / float(np.median(np.diff(recording.t)))), len(recording)
        old = ("x_m", "y_m")
        signals = {k: v[: n - rows] if k in old else v[rows:] for k, v in recording.signals.items()}
        return replace(recording, t=recording.t[rows:], signals=signals)

    return alter


def rolled(offset: float = 0.0, scale: float = 1.0) -> Alteration:
    """Roll shown `scale` times as large, then `offset` [rad] more; -1: a sensor the wrong way round."""

    def alter(recording: Recording) -> Recording:
        signals = {"phi_rad": scale * recording["phi_rad"] + offset}
        if "p_radps" in recording.signals:
            signals["p_radps"] = scale * recording["p_radps"]
        return replace(recording, signals={**recording.signals, **signals})

    return alter


def ticking(factor: float) -> Alteration:
    """A clock of the log that shows `factor` s for every second, from the first row on; poses alone."""

    def alter(recording: Recording) -> Recording:
        return replace(recording, t=recording.t[0] + (recording.t - recording.t[0]) * factor)

    return alter


# ---- what nothing can tell: the same physics in another frame


def begun_later(seconds: float) -> Alteration:
    """Another zero of the clock."""
    return lambda recording: replace(recording, t=recording.t + seconds)


def moved(x: float, y: float) -> Alteration:
    """Another origin of positions [m]."""
    return lambda recording: _plus(
        recording, {"x_m": np.full(len(recording), x), "y_m": np.full(len(recording), y)}
    )


def turned(angle: float) -> Alteration:
    """Another bearing of the axes [rad]: positions and heading turned together."""

    def alter(recording: Recording) -> Recording:
        x, y, c, s = recording["x_m"], recording["y_m"], np.cos(angle), np.sin(angle)
        signals = {
            "x_m": c * x - s * y,
            "y_m": s * x + c * y,
            "psi_rad": recording["psi_rad"] + angle,
        }
        return replace(recording, signals={**recording.signals, **signals})

    return alter


def _plus(recording: Recording, added: dict[str, Array]) -> Recording:
    """With something added to those of the signals that there are."""
    there = {n: recording[n] + x for n, x in added.items() if n in recording.signals}
    return replace(recording, signals={**recording.signals, **there})
