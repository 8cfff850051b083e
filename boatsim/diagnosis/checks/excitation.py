"""Check for motions that the log lacks, so that some coefficients cannot be identified."""

import numpy as np

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


def check_excitation(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find motions and commands that vary too little in a recording to identify some coefficients.

    For example, a boat that never goes astern or turns, or that sails at one speed only.

    Args:
        recording: A prepared recording.
        vessel: The vessel with its commands.
        config: Thresholds of the quality checks.

    Returns:
        Findings of kind "limit", each with advice for the next log.
    """
    found = [
        *_never_astern(recording, vessel),
        *_never_moved(recording, vessel, config),
        *_never_turned(recording, vessel, config),
    ]
    variation = _speed_variation(recording, vessel, config)
    if variation is not None and variation < config.excitation_min_speed_variation:
        found.append(
            _limit(
                "one_speed",
                f"the speed stays within {100.0 * variation:.0f} % of its mean",
                "the growth of damping with speed cannot be identified; sail at other speeds",
            )
        )
    return found


def _limit(name: str, evidence: str, remedy: str) -> Finding:
    return Finding(name, evidence, "limit", remedy=remedy)


def _never_astern(recording: Recording, vessel: Vessel) -> list[Finding]:
    reversible = []
    for name in vessel.actuators:
        if name not in recording.signals or name in vessel.angles:
            continue
        command = vessel.commands[name]
        if command.low < command.neutral:
            reversible.append(name)
            if not (recording[name] >= command.neutral).all():
                return []
    if not reversible:
        return []
    return [
        _limit(
            "never_astern",
            f"{', '.join(reversible)} never go astern",
            "weak thrust astern cannot be identified; go astern once",
        )
    ]


def _never_moved(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    recorded = [name for name in vessel.commands if name in recording.signals]
    still = []
    for name in recorded:
        if _is_constant(recording, vessel, name, config):
            still.append(name)
    if not still:
        return []
    if still == recorded:
        return [
            _limit(
                "never_moved",
                "no command moves",
                "thrust, steering and their delays cannot be identified; if the boat was "
                "controlled, the log lacks its commands",
            )
        ]
    names = " and ".join(still)
    return [
        _limit(
            "never_moved",
            f"{names} never move",
            f"the effect and the delay of {names} cannot be identified; move them",
        )
    ]


def _never_turned(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    if "psi_rad" not in recording.signals or "yaw" not in vessel.dof:
        return []
    span = float(np.nanmax(recording["psi_rad"]) - np.nanmin(recording["psi_rad"]))
    if span >= config.excitation_min_heading_span:
        return []
    return [
        _limit(
            "never_turned",
            f"the heading stays within {np.degrees(span):.0f} deg",
            "wind or current cannot be distinguished from a constant force of the hull; "
            "turn to other headings",
        )
    ]


def _is_constant(recording: Recording, vessel: Vessel, name: str, config: ChecksConfig) -> bool:
    command = vessel.commands[name]
    span = command.high - command.low
    if not np.isfinite(span):
        span = 0.0
    return float(np.ptp(recording[name])) <= config.excitation_min_command_span * span


def _speed_variation(recording: Recording, vessel: Vessel, config: ChecksConfig) -> float | None:
    """Range of the speed over its mean, each averaged over two Froude times; None if unknown."""
    if not {"x_m", "y_m"} <= recording.signals.keys():
        return None
    known = np.isfinite(recording["x_m"]) & np.isfinite(recording["y_m"])
    t = recording.t[known]
    x = recording["x_m"][known]
    y = recording["y_m"][known]
    after = np.searchsorted(t, t + config.speed_window * froude_time_scale(vessel)).clip(
        max=len(t) - 1
    )
    later = after > np.arange(len(t))
    if int(later.sum()) < config.excitation_min_speed_rows:
        return None
    speed = np.hypot(x[after] - x, y[after] - y)[later] / (t[after] - t)[later]
    low, high = np.quantile(speed, config.excitation_speed_quantiles)
    return float((high - low) / max(float(speed.mean()), 1e-9))
