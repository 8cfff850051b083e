"""Implementation of `boatsim check`: print the findings of the quality checks of recordings."""

import sys
from pathlib import Path

from boatsim.cli.exits import Exit, one_line, print_error, print_lines
from boatsim.diagnosis.answer.log_entry import finding_lines
from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT
from boatsim.diagnosis.log_check import check_files
from boatsim.errors import escape_for_terminal

# kinds of findings that are no fault of the log, with their titles
INFORMATION = {
    "limit": "cannot be identified",
    "drive": "drive",
    "unchecked": "not checked",
}
NO_FINDINGS = "the checks found nothing wrong with this recording"


def print_checks(runs: list[Path], vessel: str | None, load: list[str]) -> int:
    """Check the quality of recordings and print the findings of each.

    Args:
        runs: Recordings.
        vessel: Nominal vessel; None for the one that recording.toml names.
        load: Load conditions.

    Returns:
        Exit code: 0 without findings, 1 with findings, 2 if a recording cannot be read.

    Raises:
        BadInput: An argument is wrong.
    """
    findings, refused = check_files(runs, vessel, load)
    any_finding = False
    for path, entries in findings.items():
        wrong = [entry for entry in entries if entry["kind"] not in INFORMATION]
        any_finding |= bool(wrong)
        summary = NO_FINDINGS
        if wrong:
            summary = "a diagnosis corrects this automatically"
        if any(entry["kind"] == "fault" for entry in wrong):
            summary = LOG_NOT_BOAT
        if wrong or not refused:
            print_lines([f"{escape_for_terminal(str(path))}: {summary}"])
        for entry in wrong:
            print_lines(map("  {}".format, finding_lines(entry)))
        for entry in entries:
            if entry["kind"] in INFORMATION:
                remedy = entry.get("remedy", "")
                title = INFORMATION[entry["kind"]]
                print_lines([f"  {title}: {entry['evidence']}: {remedy}"])
    for error in refused:
        print_error(one_line(error))
    sys.stdout.flush()
    if refused:
        return Exit.BAD_INPUT
    if any_finding:
        return Exit.MISSED
    return Exit.MET
