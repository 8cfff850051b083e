"""What `boatsim import` does: a log's signals and a map proposed for them, or with a map a recording."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.cli.exits import remark, say
from boatsim.cli.progress import reporting
from boatsim.errors import BadInput, printable
from boatsim.files import replacing
from boatsim.physics import vessel as vessels
from boatsim.physics.content import vessel_address
from boatsim.physics.vessel import Vessel
from boatsim.recordings.importing.convert import convert, notes_of, position_fix
from boatsim.recordings.importing.log import Log, open_log
from boatsim.recordings.importing.mapping import read_map
from boatsim.recordings.importing.mapping_proposal import Drive, listing, proposal
from boatsim.recordings.table import read, write_csv


def import_log(
    log: Path,
    out: Path | None,
    map: Path | None,
    propose: Path | None,
    vessel: str | None,
    load: Sequence[str],
) -> int:
    """List and propose, or convert. Raises BadInput."""
    if map is None:
        return _show(_opened(log), propose, out, vessel, load)
    if propose:
        raise BadInput("--propose writes a map, --map reads one; give one of them")
    if out is None:
        raise BadInput(f"{log}: with --map a recording is written; say where with --out run.csv")
    if out.suffix.lower() != ".csv":
        raise BadInput(f"--out {out}: a recording is written as CSV; call it .csv")
    if any(out.resolve() == given.resolve() for given in (log, map)):
        raise BadInput(f"--out {out}: that is what is read; give another name")
    return _convert(log, out, map, vessel, load)


def _opened(path: Path) -> Log:
    with reporting() as told:
        told("reading the log")
        return open_log(path)


def _show(
    log: Log, propose: Path | None, out: Path | None, vessel: str | None, load: Sequence[str]
) -> int:
    boat = vessels.load(vessel, load) if vessel else None
    drives = (
        [Drive(n, low, high, _turns(boat, n)) for n, (low, high) in boat.limits().items()]
        if boat
        else []
    )
    text = proposal(log, vessel, drives, boat.dof if boat else (), boat.columns if boat else None)
    _say(log.remarks)
    say(listing(log))
    if propose:
        with replacing(propose) as temporary:
            temporary.write_text(text, encoding="utf-8")
        then = f"boatsim import {log.path} --map {propose} --out {out or 'run.csv'}"
        say(["", printable(f"written to {propose}: check every line, then: {then}")])
    else:
        say(
            [
                "",
                "A map for it, which --propose map.toml writes; nothing is converted without --map:",
                "",
                text.rstrip(),
            ]
        )
    return 0


def _turns(boat: Vessel, channel: str) -> int:
    """Which way what is positive turns a boat: 1 to starboard, -1 to port, 0 where its file does not say."""
    said = {"starboard": 1.0, "port": -1.0, "": boat.manoeuvring.steer.get(channel, 0.0)}[
        boat.commands[channel].turns
    ]
    return (said > 0.0) - (said < 0.0)


def _convert(path: Path, out: Path, map: Path, vessel: str | None, load: Sequence[str]) -> int:
    found = read_map(map)
    name = vessel or found.vessel
    boat = vessels.load(name, load) if name else None
    limits = boat.limits() if boat else {}
    with reporting() as told:
        told("reading the log")
        log = open_log(path)
        told("putting its signals on one clock", 0.6)
        recording = convert(log, found, str(map), limits)
        told("writing the recording", 0.8)
        write_csv(recording, out)
    _say(recording.remarks)
    span = f"{len(recording)} rows over {recording.t[-1]:.6g} s"
    say([printable(f"written to {out}: {span}; {', '.join(recording.signals)}")])
    if boat is not None:
        _note(out, boat, position_fix(found))
    try:
        read(out, limits, boat.columns if boat else None)
    except BadInput as error:
        _say([f"a diagnosis would refuse it: {error}"])
    return 0


def _note(out: Path, boat: Vessel, fix: str | None) -> None:
    """Say of which vessel it is, in a recording.toml beside it; one that is there is left alone."""
    file, text = out.parent / "recording.toml", notes_of(out, vessel_address(boat.file), fix)
    if file.exists():
        _say(
            [
                f"{file} is there and left as it is; for this recording it should say: {' / '.join(text.splitlines())}"
            ]
        )
        return
    with replacing(file) as temporary:
        temporary.write_text(text, encoding="utf-8")
    say([printable(f"written to {file}: {boat.name}")])


def _say(remarks: Sequence[str]) -> None:
    for line in remarks:
        remark(line)
