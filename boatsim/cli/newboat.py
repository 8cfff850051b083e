"""What `boatsim new` does: particulars in, the folder of a boat out, all of it or nothing."""

from pathlib import Path

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import say
from boatsim.cli.progress import reporting
from boatsim.errors import BadInput
from boatsim.newboat.particulars import Particulars
from boatsim.newboat.write import VESSEL, files


def new_boat(folder: Path, boat: Particulars, logs: list[Path], force: bool) -> int:
    """Write vessel.toml, hull.xml and turn.toml into `folder`, the first fitted to `logs` where there are any."""
    if folder.exists() and not force:
        raise BadInput(f"{folder}: is there already; --force writes a new boat over it")
    lines: list[str] = []
    with atomic_folder(folder) as new:
        for name, text in files(boat).items():
            (new / name).write_text(text, encoding="utf-8")
        if logs:
            from boatsim.newboat import from_log

            with reporting() as told:
                found = from_log.fitted(new / VESSEL, logs, report=told)
            lines += from_log.in_words(found)
            if found.better:
                (new / VESSEL).write_text(from_log.text(found, logs), encoding="utf-8")
            else:
                lines.append(
                    "the fit does worse than the rules on what it has not seen: the rules are kept; see the log"
                )
    say(
        [
            *lines,
            f"written to {folder}: {', '.join(files(boat))}",
            f"next: boatsim show {folder}, boatsim run {folder / 'turn.toml'}, boatsim diagnose RUN --vessel {folder}",
        ]
    )
    return 0
