"""Where boats go beside where their bows point, on straight stretches ahead: no model of a boat is needed for that.

In a turn a hull drifts outward, astern it goes stern first, and a current carries it to one side of the world whatever
its heading. What is left on straight stretches ahead, on all headings alike, is a compass that is turned.
"""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.priors import froude_time
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording

STRAIGHT = 0.2  # [rad] by which the heading may change over a stretch, and over the one before it
FAST = 0.5  # of the speed that only a tenth of the stretches pass
FEWEST = 8  # stretches
# of the squared way that other headings must add, so that a current is told from a compass
SEEN = 0.03
LEFT = 0.1  # of that, at most, may be left unexplained by an angle and a current


def aside(recordings: Sequence[Recording], vessel: Vessel) -> float | None:
    """Angle [rad] from the bow to where the boat goes through the water, to starboard; None where it can not be told.

    Whatever its speed, a boat that points a beside its way and drifts with a current c goes across that way by what c
    does: cos a Im q - sin a Re q = Im(c e^-i(psi + a)) dt, with q the way over dt seen from the bow.
    """
    stretches = [_stretches(r, vessel) for r in recordings]
    way = np.concatenate([q for q, _ in stretches])
    psi = np.concatenate([p for _, p in stretches])
    if len(way) < FEWEST:
        return None
    across, drift = (
        np.column_stack([way.imag, -way.real]),
        np.column_stack([np.cos(psi), np.sin(psi)]),
    )
    alone = across - drift @ np.linalg.pinv(drift, rcond=1e-6) @ across
    sizes, axes = np.linalg.eigh(alone.T @ alone)
    if sizes[1] < SEEN * float(np.sum(np.abs(way) ** 2)) or sizes[0] > LEFT * sizes[1]:
        return None
    c, s = axes[:, 0]
    ahead = np.sign(np.sum(way.real * c + way.imag * s))
    return float(np.arctan2(ahead * s, ahead * c))


def _stretches(recording: Recording, vessel: Vessel) -> tuple[Array, Array]:
    """Ways over a Froude time (K,), complex and seen from the bow, and the headings there, of fast ones ahead."""
    t, known = recording.t, np.isfinite(recording["psi_rad"])
    fixed = np.isfinite(recording["x_m"]) & np.isfinite(recording["y_m"])
    if not known.any() or fixed.sum() < FEWEST:
        return np.empty(0, dtype=complex), np.empty(0)
    at, z = t[fixed], recording["x_m"][fixed] + 1j * recording["y_m"][fixed]
    psi, push = (
        np.interp(at, t[known], np.unwrap(recording["psi_rad"][known])),
        np.interp(at, t, _ahead(recording, vessel)),
    )
    rows, lasts = np.arange(len(at)), froude_time(vessel)
    after, before = (
        np.searchsorted(at, at + lasts).clip(max=len(at) - 1),
        np.searchsorted(at, at - lasts),
    )
    way = z[after] - z
    straight = (np.abs(psi[after] - psi) < STRAIGHT) & (np.abs(psi - psi[before]) < STRAIGHT)
    ahead = (push > 0.0) & (push[after] > 0.0) & (push[before] > 0.0)
    fast = np.abs(way) > FAST * np.quantile(np.abs(way), 0.9)
    kept = straight & ahead & fast & (at[after] - at >= 0.9 * lasts) & (rows > before)
    middle = 0.5 * (psi + psi[after])
    return (way * np.exp(-1j * middle))[kept], middle[kept]


def _ahead(recording: Recording, vessel: Vessel) -> Array:
    """(N,) what thrusts are ordered ahead, in shares of full command; a vessel that has none goes ahead always."""
    thrusts = {
        n: c for n, c in vessel.commands.items() if unit_of(n) != "rad" and n in recording.signals
    }
    total = np.zeros(len(recording)) if thrusts else np.ones(len(recording))
    for name, command in thrusts.items():
        total += (recording[name] - command.neutral) / max(abs(command.low), abs(command.high))
    return total
