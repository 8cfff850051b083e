"""Implementation of `boatsim new`: write the folder of a vessel from its main particulars."""

from pathlib import Path

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import print_lines
from boatsim.cli.progress import report_stages
from boatsim.errors import BadInput
from boatsim.newboat.particulars import Particulars
from boatsim.newboat.write import VESSEL, boat_files


def create_boat(folder: Path, boat: Particulars, logs: list[Path], force: bool) -> int:
    """Create the folder of a new vessel with vessel.toml, hull.xml and turn.toml, or none of them.

    Args:
        folder: New folder.
        boat: Main particulars.
        logs: Recordings to fit the coefficients of the vessel to; may be empty.
        force: Whether an existing folder may be overwritten.

    Returns:
        Exit code.

    Raises:
        BadInput: The folder exists, or a recording cannot be used.
    """
    if folder.exists() and not force:
        raise BadInput(f"{folder} exists already; --force overwrites it")
    texts = boat_files(boat)
    lines: list[str] = []
    with atomic_folder(folder) as new:
        for name, text in texts.items():
            (new / name).write_text(text, encoding="utf-8")
        if logs:
            lines = _fit_coefficients(new / VESSEL, logs)
    print_lines(
        [
            *lines,
            f"written to {folder}: {', '.join(texts)}",
            f"next: boatsim show {folder}, boatsim run {folder / 'turn.toml'}, "
            f"boatsim diagnose RUN --vessel {folder}",
        ]
    )
    return 0


def _fit_coefficients(vessel: Path, logs: list[Path]) -> list[str]:
    """Fit the coefficients of a vessel file to recordings; return the result in words."""
    from boatsim.newboat import from_log

    with report_stages() as report:
        found = from_log.fit_boat(vessel, logs, report=report)
    lines = from_log.fit_report_lines(found)
    if found.reduces_error:
        vessel.write_text(from_log.fitted_vessel_text(found, logs), encoding="utf-8")
    else:
        lines.append(
            "the fitted coefficients predict held-out data worse than the estimates: "
            "the estimates are kept"
        )
    return lines
