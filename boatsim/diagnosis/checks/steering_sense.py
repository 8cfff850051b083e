"""Sign convention of a recording's rudder: its angle may be positive to starboard or to port."""

from dataclasses import replace

import numpy as np

from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.base import Array
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

# text of the remark about a command
REMARK = "positive {} turns the hull to the other side; its sign is changed"


def correct_rudder_sense(recording: Recording, vessel: Vessel, config: ChecksConfig) -> Recording:
    """Return a recording with rudder angles in the sign convention of the vessel model.

    The sign of a rudder command is changed if the turns of the recorded heading show that it is
    reversed.

    Args:
        recording: The recording, with unwrapped angles.
        vessel: The vessel; each rudder command specifies to which side it turns.
        config: Thresholds of the quality checks.

    Returns:
        The recording, with a remark for each changed sign.
    """
    for name, command in vessel.commands.items():
        if not command.turns or not {name, "psi_rad"} <= recording.signals.keys():
            continue
        duration = config.rudder_response_time * np.sqrt(vessel.length / GRAVITY)
        correlation = steering_correlation(recording, name, duration)
        if command.turns != "starboard":
            correlation = -correlation
        if correlation < -config.rudder_min_correlation:
            remark = f"{recording.origin}: {REMARK.format(name)}"
            recording = replace(
                recording,
                signals={**recording.signals, name: -recording.signals[name]},
                remarks=(*recording.remarks, remark),
            )
    return recording


def commands_with_corrected_sign(recording: Recording) -> list[str]:
    """Return the rudder commands whose sign was corrected automatically in a recording.

    They are read from the remarks of the recording.
    """
    remarks = "\n".join(recording.remarks)
    return [name for name in recording.signals if REMARK.format(name) in remarks]


def steering_correlation(recording: Recording, name: str, duration: float) -> float:
    """Return the partial correlation of a rudder command with the turn that follows it.

    The turn before the command must be taken into account: the rudder that checks the turn of an
    unstable hull would otherwise seem to act backwards.

    Args:
        recording: The recording with a heading.
        name: The command.
        duration: Response time of the hull [s].

    Returns:
        Between -1 and 1; positive for a command that steers to starboard.
    """
    known = np.isfinite(recording.signals["psi_rad"])
    t = recording.t[known]
    psi = recording.signals["psi_rad"][known]
    inside = (t >= t[0] + duration) & (t <= t[-1] - duration)
    now = psi[inside]
    if len(now) < 2:
        return 0.0
    before = now - np.interp(t[inside] - duration, t, psi)
    after = np.interp(t[inside] + duration, t, psi) - now
    if not before @ before > 0.0:
        return 0.0
    command = _orthogonal(recording.signals[name][known][inside], before)
    turn = _orthogonal(after, before)
    size = np.linalg.norm(command) * np.linalg.norm(turn)
    if not size > 0.0:
        return 0.0
    return float(command @ turn / size)


def _orthogonal(values: Array, reference: Array) -> Array:
    """The part of values (N,) that is orthogonal to a reference (N,)."""
    return np.asarray(values - reference * (values @ reference) / (reference @ reference))
