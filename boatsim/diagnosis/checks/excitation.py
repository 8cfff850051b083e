"""What a log can not tell, because the boat never did what would show it."""

from collections.abc import Iterator

import numpy as np

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.priors import froude_time
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

# [rad] that the heading must pass for a current or wind to be told from a steady push
HEADINGS = 1.0
VARIES = 0.2  # of its size, by which a speed must vary for the shape of the damping to be told
MOVES = 0.02  # of its range, from which a command is moved


def look(recording: Recording, vessel: Vessel) -> list[Finding]:
    """By which channels moved and what speeds and headings were passed."""
    return [
        Finding(name, evidence, "limit", remedy=remedy)
        for name, evidence, remedy in _untold(recording, vessel)
    ]


def _untold(recording: Recording, vessel: Vessel) -> Iterator[tuple[str, str, str]]:
    drives = [n for n in vessel.actuators if n in recording.signals and n not in vessel.angles]
    astern = [n for n in drives if vessel.commands[n].low < vessel.commands[n].neutral]
    if astern and all((recording[n] >= vessel.commands[n].neutral).all() for n in astern):
        yield (
            "never_astern",
            f"{', '.join(astern)} never go astern",
            "a weak reverse can not be told; go astern once",
        )
    still = [n for n in vessel.actuators if n in recording.signals and _still(recording, vessel, n)]
    if still:
        doing = " and ".join(still)
        yield (
            "never_moved",
            f"{doing} never move",
            f"what {doing} do, and how late, can not be told; move them",
        )
    if "psi_rad" in recording.signals and "yaw" in vessel.dof:
        passed = float(np.nanmax(recording["psi_rad"]) - np.nanmin(recording["psi_rad"]))
        if passed < HEADINGS:
            evidence = f"the heading stays within {np.degrees(passed):.0f} deg"
            yield (
                "never_turned",
                evidence,
                "wind or current can not be told from a steady push; turn to other headings",
            )
    if (varies := _speeds(recording, vessel)) is not None and varies < VARIES:
        evidence = f"the speed stays within {100.0 * varies:.0f} % of its mean"
        yield (
            "one_speed",
            evidence,
            "how damping grows with speed can not be told; sail at other speeds",
        )


def _still(recording: Recording, vessel: Vessel, name: str) -> bool:
    command = vessel.commands[name]
    reach = command.high - command.low if np.isfinite(command.high - command.low) else 0.0
    return float(np.ptp(recording[name])) <= MOVES * reach


def _speeds(recording: Recording, vessel: Vessel) -> float | None:
    """By how much of its mean the speed varies, from one time of the boat to another; None if it is not recorded."""
    if not {"x_m", "y_m"} <= recording.signals.keys():
        return None
    there = np.isfinite(recording["x_m"]) & np.isfinite(recording["y_m"])
    t, x, y = recording.t[there], recording["x_m"][there], recording["y_m"][there]
    after = np.searchsorted(t, t + 2.0 * froude_time(vessel)).clip(max=len(t) - 1)
    far = after > np.arange(len(t))
    if int(far.sum()) < 10:
        return None
    speed = np.hypot(x[after] - x, y[after] - y)[far] / (t[after] - t)[far]
    low, high = np.quantile(speed, [0.05, 0.95])
    return float((high - low) / max(float(speed.mean()), 1e-9))
