"""What `boatsim check` does: recordings in, what is wrong with them out, before any physics is suspected."""

import sys
from pathlib import Path

from boatsim.cli.exits import Exit, complain, say, words
from boatsim.diagnosis.checks.entry import entry_text
from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT
from boatsim.diagnosis.log_check import check_files
from boatsim.errors import printable

CLEAN = "nothing is wrong with this log that could be found"


def check_logs(runs: list[Path], vessel: str | None, load: list[str]) -> int:
    """Print the findings of each file; 0 where there are none. Raises BadInput."""
    found, refused = check_files(runs, vessel, load)
    for path, entries in found.items():
        wrong = [e for e in entries if e["kind"] != "limit"]
        faults = any(e["kind"] == "fault" for e in entries)
        if wrong or not refused:
            say(
                [
                    f"{printable(str(path))}: {LOG_NOT_BOAT if faults else 'a diagnosis corrects this automatically' if wrong else CLEAN}"
                ]
            )
        for e in wrong:
            say(f"  {line}" for line in entry_text(e))
        for e in entries:
            if e["kind"] == "limit":
                say([f"  can not be identified: {e['evidence']}: {e.get('remedy', '')}"])
    for error in refused:
        complain(words(error))
    sys.stdout.flush()
    if refused:
        return Exit.BAD_INPUT
    return (
        Exit.MISSED
        if any(e["kind"] != "limit" for entries in found.values() for e in entries)
        else Exit.MET
    )
