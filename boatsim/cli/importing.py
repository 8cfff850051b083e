"""Implementation of `boatsim import`: propose a map for a log, or convert a log with a map."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from boatsim.cli.exits import print_lines, print_note, print_notes
from boatsim.cli.measured_inputs import measured_text
from boatsim.cli.progress import report_stages
from boatsim.errors import BadInput, escape_for_terminal
from boatsim.files import read_toml, replace_file
from boatsim.physics import vessel as vessels
from boatsim.physics.base import ChannelEffect
from boatsim.physics.content import vessel_reference
from boatsim.physics.effects.propeller import Propeller
from boatsim.physics.effects.thruster import Thruster
from boatsim.physics.vessel import Vessel
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.mapping import read_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.recording_notes import (
    position_fix_type,
    recording_notes_text,
    use_entry_line,
)
from boatsim.recordings.importing.several_logs import open_logs
from boatsim.recordings.importing.signal_classification import UNKNOWN_BODY, Body
from boatsim.recordings.importing.signal_listing import signal_table
from boatsim.recordings.table import read, write_csv
from boatsim.simulate.manoeuvre import approach_speed

CONVERTING, WRITING = 0.6, 0.8  # shares of the work done when these stages start, by experience


def import_log(
    logs: Sequence[Path],
    out: Path | None,
    map: Path | None,
    propose: Path | None,
    vessel: str | None,
    load: Sequence[str],
) -> int:
    """List the signals of a log and propose a map, or convert the log to a recording with a map.

    Args:
        logs: Log of an autopilot, a ROS recording, ...; or several logs of one run.
        out: Recording to write; needed with `map`.
        map: Map from signals of the log to columns; None to propose one.
        propose: File for the proposed map; None to print it.
        vessel: Vessel of the log; None if unknown.
        load: Load conditions of the vessel.

    Returns:
        Exit code.

    Raises:
        BadInput: A file or an argument is wrong.
    """
    if map is None:
        with report_stages() as report:
            report("reading the log")
            opened = open_logs(logs)
        return _propose_map(opened, logs, propose, out, vessel, load)
    if propose:
        raise BadInput("--propose writes a map, --map reads one; give one of them")
    if out is None:
        raise BadInput(f"{logs[0]}: --map converts the log; name the recording with --out run.csv")
    if out.suffix.lower() != ".csv":
        raise BadInput(f"--out {out}: recordings are written as CSV; use a name ending in .csv")
    if out.resolve() in [file.resolve() for file in (*logs, map)]:
        raise BadInput(f"--out {out} would overwrite the input; give another name")
    return _convert_logs(logs, out, map, vessel, load)


def _propose_map(
    log: Log,
    files: Sequence[Path],
    propose: Path | None,
    out: Path | None,
    vessel: str | None,
    load: Sequence[str],
) -> int:
    body = UNKNOWN_BODY
    if vessel:
        boat = vessels.load_vessel(vessel, load)
        body = Body(tuple(boat.limits()), boat.dof, boat.turns_over)
        drives = []
        fed = _fed_channels(boat) - log.signals.keys()
        for channel, (low, high) in boat.limits().items():
            if channel in fed or channel in boat.measured:
                continue
            drives.append(_vessel_channel(boat, channel, low, high))
        speed = partial(_speed_ahead, boat)
        text = propose_map(log, vessel, drives, boat.dof, boat.columns, speed, boat.turns_over)
        text += measured_text(boat, log, body)
    else:
        text = propose_map(log, vessel, [], (), None)
    print_notes(log.remarks)
    print_lines(signal_table(log, body))
    if propose is None:
        introduction = "Proposed map (--propose map.toml writes it; --map map.toml converts):"
        print_lines(["", introduction, "", text.rstrip()])
        return 0
    with replace_file(propose) as temporary:
        temporary.write_text(text, encoding="utf-8")
    names = " ".join(map(str, files))
    command = f"boatsim import {names} --map {propose} --out {out or 'run.csv'}"
    print_lines(
        ["", escape_for_terminal(f"written to {propose}: check every line, then: {command}")]
    )
    return 0


def _fed_channels(boat: Vessel) -> set[str]:
    """Channels whose signal a raw command gives, which logs have in their place."""
    fed: set[str] = set()
    for effect in boat.effects:
        if isinstance(effect, ChannelEffect) and effect.fed_by:
            fed.update(effect.on)
    return fed


def _vessel_channel(boat: Vessel, name: str, low: float, high: float) -> VesselChannel:
    """A channel with what the vessel's effects state about its drive."""
    lever, coefficients = None, None
    for effect in boat.effects:
        if not isinstance(effect, Thruster | Propeller) or not isinstance(effect.on, Mapping):
            continue
        on = effect.on
        if name not in on.values() or isinstance(on.get("angle"), str):
            continue
        if float(on.get("angle", 0.0)) == 0.0:
            lever = -effect.y
            if isinstance(effect, Propeller):
                coefficients = (effect.gain * effect.ahead, effect.gain * effect.astern)
    ahead = boat.manoeuvring.ahead.get(name, 0.0)
    direction = _turn_direction(boat, name)
    return VesselChannel(name, low, high, direction, lever, coefficients, ahead)


def _speed_ahead(boat: Vessel) -> float:
    """Speed of the vessel under its commands straight ahead [m/s]; 0 if it does not move."""
    try:
        return approach_speed(boat)
    except BadInput:
        return 0.0


def _turn_direction(boat: Vessel, channel: str) -> int:
    """Turn that a positive command causes: 1 starboard, -1 port, 0 unknown."""
    turns = boat.commands[channel].turns
    if turns:
        return {"starboard": 1, "port": -1}[turns]
    steer = boat.manoeuvring.steer.get(channel, 0.0)
    return (steer > 0.0) - (steer < 0.0)


def _convert_logs(
    paths: Sequence[Path], out: Path, map: Path, vessel: str | None, load: Sequence[str]
) -> int:
    mapping = read_map(map)
    boat = _vessel_of_log(vessel, mapping.vessel, map, load)
    limits = boat.recorded_limits() if boat else {}
    with report_stages() as report:
        report("reading the log")
        log = open_logs(paths)
        report("resampling the signals to one time base", CONVERTING)
        recording = convert_log(log, mapping, str(map), limits)
        report("writing the recording", WRITING)
        write_csv(recording, out)
    print_notes(recording.remarks)
    span = f"{len(recording)} rows over {recording.t[-1]:.6g} s"
    print_lines([escape_for_terminal(f"written to {out}: {span}; {', '.join(recording.signals)}")])
    if boat is not None:
        _write_vessel(out, boat, position_fix_type(mapping), recording.notes.use)
    elif recording.notes.use:
        print_note(
            f"write into {out.parent / 'recording.toml'}: {use_entry_line(recording.notes.use)}"
        )
    try:
        if boat is None:
            read(out, limits)
        else:
            read(out, limits, boat.columns, boat.turns_over)
    except BadInput as error:
        print_note(f"a diagnosis would refuse this recording: {error}")
    return 0


def _vessel_of_log(
    given: str | None, mapped: str | None, map: Path, load: Sequence[str]
) -> Vessel | None:
    """The vessel of the command line, or that of the map, whose path starts beside the map."""
    if given:
        return vessels.load_vessel(given, load)
    if mapped is None:
        return None
    try:
        return vessels.load_vessel(mapped, load, base_folder=map.resolve().parent)
    except BadInput:  # a name that the user would give here
        return vessels.load_vessel(mapped, load)


def _write_vessel(
    out: Path, boat: Vessel, fix: str | None, use: Sequence[tuple[float, float]]
) -> None:
    """Write the vessel of a recording to recording.toml in its folder.

    The recording is added to an existing file that has no notes on it; notes on it are kept.
    """
    file = out.parent / "recording.toml"
    text = recording_notes_text(out, vessel_reference(boat.file), fix, use)
    try:
        with replace_file(file) as temporary:
            temporary.write_text(_notes_before(file, out.stem) + text, encoding="utf-8")
            read_toml(temporary)  # nothing is written that could not be read again
    except BadInput:
        lines = " / ".join(text.splitlines())
        print_note(f"{file} exists and is kept; for this recording it should contain: {lines}")
        return
    print_lines([escape_for_terminal(f"written to {file}: {boat.name}")])


def _notes_before(file: Path, run: str) -> str:
    """The text of recording.toml before the notes on a run. Raises BadInput if it has them."""
    if not file.exists():
        return ""
    runs = read_toml(file).get("runs", {})
    if not isinstance(runs, dict) or run in runs:
        raise BadInput(f"{file}: has notes on {run}")
    return file.read_text(encoding="utf-8-sig").rstrip() + "\n\n"
