"""Check for required columns that the file has under another name."""

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.signal_classification import (
    Body,
    Classification,
    classify_signals,
)
from boatsim.recordings.importing.signal_words import side_from_tokens, tokenize_name
from boatsim.recordings.table import Recording

POSE_AXES = {"x_m": "surge", "y_m": "sway", "psi_rad": "yaw"}
SIDES = {"port", "starboard"}


def check_column_names(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find required columns that a recording has under another name.

    A substitute is proposed for a missing column if exactly one other column fits.

    Args:
        recording: The recording as written in the file.
        vessel: The vessel, which determines the required columns.
        config: Thresholds of the quality checks.

    Returns:
        At most one finding "column_names" for all missing columns.
    """
    poses = _missing_poses(recording, vessel)
    commands = [n for n in vessel.actuators if n not in recording.signals]
    if not poses and not commands:
        return []
    other = _other_columns(recording, vessel)
    evidence = []
    changes = []
    for name in (*poses, *commands):
        if name in poses:
            candidates = [guess for guess in other if guess.column == name]
        else:
            candidates = _command_guesses(name, other)
        if len(candidates) == 1:
            guess = candidates[0]
            evidence.append(f"{name} is missing, and {guess.name} may be it")
            changes.append(Change(name, guess.name, _factor(guess)))
    if not changes:
        return []
    return [
        Finding(
            "column_names",
            ", ".join(evidence),
            probability=config.probability_likely,
            changes=tuple(changes),
        )
    ]


def _missing_poses(recording: Recording, vessel: Vessel) -> list[str]:
    missing = []
    for name, axis in POSE_AXES.items():
        if axis in vessel.dof and name not in recording.signals:
            missing.append(name)
    if {"u_mps", "v_mps"} & recording.signals.keys():
        return ["psi_rad"] if "psi_rad" in missing else []
    return missing


def _other_columns(recording: Recording, vessel: Vessel) -> list[Classification]:
    """Classify the columns that are neither a pose nor an input of the vessel."""
    known = {*POSE_AXES, *vessel.inputs}
    signals = {
        name: Signal(recording.t, values)
        for name, values in recording.signals.items()
        if name not in known
    }
    body = Body(vessel.actuators, vessel.dof, vessel.turns_over)
    return classify_signals(Log(recording.path or vessel.file, signals), body)


def _command_guesses(name: str, other: list[Classification]) -> list[Classification]:
    """Command columns of the same side; those that share a word with the name come first."""
    words = set(tokenize_name(name))
    side = side_from_tokens(frozenset(words))
    same_side = [g for g in other if g.column == "command" and side_from_tokens(g.tokens) == side]
    same_word = [g for g in same_side if words & g.tokens - SIDES]
    return same_word or same_side


def _factor(guess: Classification) -> float:
    """Conversion factor that the words of a guess stand for."""
    factor = 1.0
    if not guess.word:
        return factor
    for word in guess.word.split(" * "):
        factor *= UNITS[word] if word in UNITS else float(word)
    return factor
