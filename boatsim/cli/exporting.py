"""Implementation of `boatsim export`: write a recording in the log format of other programs."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.api import read
from boatsim.cli.exits import print_lines, print_notes
from boatsim.errors import BadInput, escape_for_terminal
from boatsim.recordings.exporting.mcap import SUFFIX, write_mcap


def export_recording(path: Path, out: Path | None, vessel: str | None, load: Sequence[str]) -> int:
    """Write a recording to an MCAP file.

    Args:
        path: File of the recording.
        out: File to write; None for one next to the recording.
        vessel: Vessel of the recording; None for the one that recording.toml names.
        load: Load conditions.

    Returns:
        Exit code.

    Raises:
        BadInput: If the recording can not be read, or a library is not installed.
    """
    if out is None:
        out = path.with_suffix(SUFFIX)
    if out.resolve() == path.resolve():
        raise BadInput(f"--out {out} would overwrite the recording; give another name")
    recording = read(path, vessel, load)
    count = write_mcap(recording, out)
    print_notes(recording.remarks)
    print_lines(
        [escape_for_terminal(f"written to {out}: {len(recording)} rows in {count} messages")]
    )
    return 0
