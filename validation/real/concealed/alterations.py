"""Alterations of real recordings: what a known fault would have recorded.

Each alteration takes a recording with all of its rows and returns another. Commands are altered by
the inverse of a fault: a boat with the fault that receives the altered commands moves exactly as
recorded.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

Alteration = Callable[[Recording], Recording]
KINDS = ("", "estimate_")  # of velocities: measured, and an autopilot's, which no fit uses
POSITIONS = ("x_m", "y_m")


def unaltered(recording: Recording) -> Recording:
    """Return the recording itself."""
    return recording


def chain(*alterations: Alteration) -> Alteration:
    """Return several alterations in sequence."""

    def alter(recording: Recording) -> Recording:
        for alteration in alterations:
            recording = alteration(recording)
        return recording

    return alter


def _replace_signals(recording: Recording, signals: Mapping[str, Array]) -> Recording:
    """Return a recording with other values of some signals."""
    return replace(recording, signals={**recording.signals, **signals})


def _add_to_signals(recording: Recording, added: Mapping[str, Array]) -> Recording:
    """Return a recording with values added to the signals that it has."""
    signals = dict(recording.signals)
    for name in signals.keys() & added.keys():
        signals[name] = signals[name] + added[name]
    return replace(recording, signals=signals)


# ---- commands


def rewrite_commands(names: Sequence[str], written: Callable[[Array], Array]) -> Alteration:
    """Replace commands by a function of them.

    Args:
        names: Channels.
        written: Returns the altered commands (N,) for those given.
    """

    def alter(recording: Recording) -> Recording:
        return _replace_signals(recording, {name: written(recording[name]) + 0.0 for name in names})

    return alter


def weaken_motors(names: Sequence[str], factor: float) -> Alteration:
    """Motors that give a factor of their commands."""
    return rewrite_commands(names, lambda given: given / factor)


def weaken_motors_astern(names: Sequence[str], factor: float) -> Alteration:
    """Motors that give a factor of their commands astern."""
    return rewrite_commands(names, lambda given: np.where(given < 0.0, given / factor, given))


def add_dead_band(names: Sequence[str], width: float) -> Alteration:
    """Motors that lack a constant width of every command, in its unit."""
    return rewrite_commands(names, lambda given: given + width * np.sign(given))


def offset_commands(names: Sequence[str], offset: float) -> Alteration:
    """Actuators that add an offset to every command, in its unit."""
    return rewrite_commands(names, lambda given: given - offset)


def steer_harder_to_one_side(names: Sequence[str], gain: float) -> Alteration:
    """Rudders that add a share of the size of every angle: they steer harder to one side."""
    return rewrite_commands(names, lambda given: given / (1.0 + gain * np.sign(given)))


def delay_commands(names: Sequence[str], seconds: float) -> Alteration:
    """Commands that take effect later [s] than they were recorded, or earlier if negative.

    The delay is rounded to whole rows, and rows without commands are removed. For positions and
    commands alone this is equivalent to a delayed clock of the poses.
    """

    def alter(recording: Recording) -> Recording:
        rows, n = round(seconds / float(np.median(np.diff(recording.t)))), len(recording)
        kept = slice(max(-rows, 0), n - max(rows, 0))
        moved = slice(max(rows, 0), n - max(-rows, 0))
        signals = {name: x[kept] for name, x in recording.signals.items()}
        for name in signals.keys() & set(names):
            signals[name] = recording[name][moved]
        return replace(recording, t=recording.t[kept], signals=signals)

    return alter


# ---- the water


def add_current(north: float, east: float) -> Alteration:
    """A current [m/s] that carries the same motion through the water: a Galilean transformation.

    Positions drift, and speeds over the ground change; speeds through the water stay the same.
    """

    def alter(recording: Recording) -> Recording:
        since, psi = recording.t - recording.t[0], recording["psi_rad"]
        c, s = np.cos(psi), np.sin(psi)
        added = {"x_m": north * since, "y_m": east * since}
        for kind in KINDS:
            added |= {f"{kind}u_mps": north * c + east * s, f"{kind}v_mps": east * c - north * s}
        return _add_to_signals(recording, added)

    return alter


# ---- instruments


def add_compass_error(offset: float, cos: float = 0.0, sin: float = 0.0) -> Alteration:
    """A compass that reads psi + offset + cos cos(psi) + sin sin(psi) [rad].

    Recorded speeds are resolved along the reading.
    """

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


def move_antenna(forward: float, starboard: float) -> Alteration:
    """Position, and speed where it was recorded, of a point ahead and to starboard [m]."""

    def alter(recording: Recording) -> Recording:
        psi = recording["psi_rad"]
        c, s = np.cos(psi), np.sin(psi)
        added = {"x_m": c * forward - s * starboard, "y_m": s * forward + c * starboard}
        for kind in KINDS:
            r = recording.signals.get(f"{kind}r_radps")
            if r is not None:
                added |= {f"{kind}u_mps": -r * starboard, f"{kind}v_mps": r * forward}
        return _add_to_signals(recording, added)

    return alter


def stretch_positions(x: float, y: float) -> Alteration:
    """Positions (1 + x) and (1 + y) times as far from the origin, and unchanged speeds."""

    def alter(recording: Recording) -> Recording:
        factors = {"x_m": 1.0 + x, "y_m": 1.0 + y}
        return _replace_signals(
            recording, {name: recording[name] * k for name, k in factors.items()}
        )

    return alter


def delay_positions(seconds: float) -> Alteration:
    """Positions that are recorded later [s] than all other signals, by whole rows."""
    return delay_commands(POSITIONS, -seconds)


def alter_roll(offset: float = 0.0, scale: float = 1.0) -> Alteration:
    """Roll readings multiplied by a scale, plus an offset [rad]; scale -1 is a reversed sensor."""

    def alter(recording: Recording) -> Recording:
        signals = {"phi_rad": scale * recording["phi_rad"] + offset}
        if "p_radps" in recording.signals:
            signals["p_radps"] = scale * recording["p_radps"]
        return _replace_signals(recording, signals)

    return alter


def scale_clock(factor: float) -> Alteration:
    """A clock that counts `factor` s per second from the first row on, for poses alone."""

    def alter(recording: Recording) -> Recording:
        return replace(recording, t=recording.t[0] + (recording.t - recording.t[0]) * factor)

    return alter


# ---- changes of the frame, which no recording shows


def shift_clock(seconds: float) -> Alteration:
    """Another zero of the clock."""
    return lambda recording: replace(recording, t=recording.t + seconds)


def shift_origin(x: float, y: float) -> Alteration:
    """Another origin of positions [m]."""
    return lambda recording: _add_to_signals(
        recording, {"x_m": np.full(len(recording), x), "y_m": np.full(len(recording), y)}
    )


def rotate_axes(angle: float) -> Alteration:
    """Another direction of the axes [rad]: positions and heading are rotated together."""

    def alter(recording: Recording) -> Recording:
        x, y, c, s = recording["x_m"], recording["y_m"], np.cos(angle), np.sin(angle)
        signals = {"x_m": c * x - s * y, "y_m": s * x + c * y}
        return _replace_signals(recording, signals | {"psi_rad": recording["psi_rad"] + angle})

    return alter
