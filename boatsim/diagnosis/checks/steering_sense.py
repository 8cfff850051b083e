"""Which way a recording's rudder steers: some count its angle positive to starboard, some to port."""

from dataclasses import replace

import numpy as np

from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

GRAVITY = 9.81  # [m/s^2]
# sqrt(length / g): the time in which a hull at Froude number 0.14 sails half its length
RESPONSE = 3.5
SURE = 0.3  # correlation of rudder and turning beyond which there is no doubt


def steered(recording: Recording, vessel: Vessel) -> Recording:
    """The recording with rudders counted as the vessel counts them (`turns`); a remark says where a sign changed."""
    for name, command in vessel.commands.items():
        if command.turns and name in recording.signals and "psi_rad" in recording.signals:
            sense = turning(recording, name, vessel.length) * (
                1.0 if command.turns == "starboard" else -1.0
            )
            if sense < -SURE:
                remark = f"{recording.path or recording.name}: positive {name} turns the other way; its sign is changed"
                signals = {**recording.signals, name: -recording.signals[name]}
                recording = replace(
                    recording, signals=signals, remarks=(*recording.remarks, remark)
                )
    return recording


def turned(recording: Recording) -> list[str]:
    """Commands whose sign `steered` has changed, as its remarks say."""
    return [
        n
        for n in recording.signals
        for r in recording.remarks
        if f"positive {n} turns the other way" in r
    ]


def turning(recording: Recording, name: str, length: float) -> float:
    """Correlation of a command with the turning after it, given the turning before: 1 steers to starboard, -1 to port.

    Without the turning before, an unstable hull that is being checked would look as if its rudder acted backwards.
    """
    there = np.isfinite(recording.signals["psi_rad"])
    t, psi, span = (
        recording.t[there],
        recording.signals["psi_rad"][there],
        RESPONSE * np.sqrt(length / GRAVITY),
    )
    inside = (t >= t[0] + span) & (t <= t[-1] - span)
    now = psi[inside]
    if len(now) < 2:
        return 0.0
    before, after = (
        now - np.interp(t[inside] - span, t, psi),
        np.interp(t[inside] + span, t, psi) - now,
    )
    if not before @ before > 0.0:
        return 0.0
    drive, gained = (
        x - before * (x @ before) / (before @ before)
        for x in (recording.signals[name][there][inside], after)
    )
    size = np.linalg.norm(drive) * np.linalg.norm(gained)
    return float(drive @ gained / size) if size > 0.0 else 0.0
