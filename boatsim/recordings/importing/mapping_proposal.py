"""Proposal of a map for a log."""

from collections.abc import Callable, Mapping, Sequence

from boatsim.files import toml_key, toml_value
from boatsim.recordings.expression import parse
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.channels_by_motion import Unnamed
from boatsim.recordings.importing.command_lines import command_lines
from boatsim.recordings.importing.drive_evidence import motion_of_log
from boatsim.recordings.importing.further_lines import further_lines
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.motion_by_track import (
    with_rate_unit,
    with_speed_units,
    without_contradictions,
)
from boatsim.recordings.importing.motion_evidence import correct_classification_by_motion
from boatsim.recordings.importing.motion_lines import motion_lines
from boatsim.recordings.importing.revolution_unit import RevolutionUnit
from boatsim.recordings.importing.signal_classification import (
    Body,
    Classification,
    classify_signals,
)
from boatsim.recordings.importing.signal_text import expression_of, printable_name
from boatsim.recordings.importing.signal_words import tokenize_name
from boatsim.recordings.importing.single_axis import names_load
from boatsim.recordings.importing.time_lines import begin_lines, rate_lines, time_lines
from boatsim.recordings.importing.track import Track, reason_poses_unusable, track_of
from boatsim.recordings.importing.turning import Turning
from boatsim.recordings.importing.unnamed_drives import numbered_outputs
from boatsim.recordings.raw_table import file_error


def propose_map(
    log: Log,
    vessel: str | None = None,
    drives: Sequence[VesselChannel] = (),
    dof: Sequence[str] = (),
    stated: Mapping[str, str] | None = None,
    approach_speed: Callable[[], float] = lambda: 0.0,
    turns_over: bool = False,
) -> str:
    """Return the text of a map: the most probable signals, with others in comments.

    Args:
        log: The log.
        vessel: Name or path of the vessel.
        drives: Command channels of the vessel.
        dof: Degrees of freedom of the vessel.
        stated: Column -> expression of a signal, by the vessel's file.
        approach_speed: Speed of the vessel at the commands `ahead` of its channels [m/s], which is
            computed only where the unit of revolutions is not known; 0 if unknown.
        turns_over: Whether the vessel may roll to any angle.

    Raises:
        BadInput: The log has no poses.
    """
    known, used_signals = _stated_columns(log, stated or {})
    best: dict[str, list[Classification]] = {}
    stated_motion: dict[str, list[Classification]] = {}
    classified = classify_signals(log, Body([d.name for d in drives], dof, turns_over))
    numbered = numbered_outputs(log, classified)
    for g in correct_classification_by_motion(classified, log):
        if g.column not in known and g.name not in used_signals:
            best.setdefault(g.column, []).append(g)
        elif known.get(g.column) == expression_of(g):
            stated_motion.setdefault(g.column, []).append(g)
    if reason := reason_poses_unusable(log, best, "yaw" in dof):
        raise file_error(log.path, reason)
    track = track_of(best)
    best = with_speed_units(with_rate_unit(best), track)
    best, doubtful = without_contradictions(best, track)
    body, used = motion_lines(log, best, dof, known)
    body += doubtful
    for column, expression in known.items():
        body.append(f"{toml_key(column)} = {toml_value(expression)}  # by the vessel's file")
    open_drives = [d for d in drives if d.name not in known]
    driven: list[Classification] = []
    unit = RevolutionUnit(track, approach_speed)
    if drives and not open_drives:
        commands = ["# all are above"]
    else:
        enu = log.frame == "ENU"
        seen = {**best, **stated_motion}
        turning = Turning(seen, enu)
        motion = motion_of_log(seen, turning, track or track_of(seen), enu)
        unnamed = Unnamed(numbered, motion)
        commands, driven = command_lines(best, open_drives, turning, unit, unnamed)
        if not drives and numbered:
            names = ", ".join(printable_name(g.name) for g in numbered)
            commands.append(f"# {names} may be outputs to drives: --vessel shows which")
    # a measured force acts between the rows, too: its samples are all kept
    measured = any(names_load(tokenize_name(drive.name)) for drive in drives)
    lines = [
        "# Proposed from the names, units and ranges of the signals in the log: check every line.",
        f'vessel = "{vessel}"' if vessel else '# vessel = "NAME"',
        *([] if measured else rate_lines((*used, *driven))),
        "# use = [0.0, 60.0]  # [s] since the log begins, the part to convert",
        *time_lines(log),
        *begin_lines(log, best),
        "",
        *body,
        "",
        "# commands: what was sent to the drives",
        *(commands or ["# none was found"]),
        *further_lines(best, drives, driven, unit),
    ]
    return "\n".join(lines) + "\n"


def track_and_heading(log: Log, body: Body) -> tuple[Track | None, Classification | None]:
    """Return the motion by the positions of a log, and its most probable heading; None if unknown.

    Args:
        log: The log.
        body: The vessel.
    """
    best: dict[str, list[Classification]] = {}
    for g in correct_classification_by_motion(classify_signals(log, body), log):
        best.setdefault(g.column, []).append(g)
    return track_of(best), next(iter(best.get("psi_rad", [])), None)


def _stated_columns(log: Log, stated: Mapping[str, str]) -> tuple[dict[str, str], set[str]]:
    """Columns that the vessel's file states and the log has, and the signals that they use."""
    known: dict[str, str] = {}
    used_signals: set[str] = set()
    for column, expression in stated.items():
        signal = parse(expression, log.signals.keys()).signal
        if signal in log.signals:
            known[column] = expression
            used_signals.add(signal)
    return known, used_signals
