"""Otter USV in Oslo harbour: `python -m validation.real.otter_oslo [--form clean|raw] [DAY...]`.

Students of OsloMet drove a catamaran of 2 m with two propellers on three days of 2024. Each day is
a group of the protocol (docs/protocol.md), with another program, load and water, and is diagnosed
by itself. The runs come in two forms: the files as published, imported by the map that
`boatsim import --propose` writes, and the files of runs_clean.

The vessel, otter/vessel.toml, is Fossen's model in the plane. It cannot express what the closed
box of the vehicle does with a command between the revolutions that the program asks for and those
of the shafts.
"""

import argparse
import io
import re
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

from boatsim.cli.importing import import_log
from boatsim.errors import BadInput
from validation.real.common import DEG, OUT, RECORDINGS, out_option, runs_of
from validation.real.figures import (
    DISTANCE,
    SourceWindows,
    diagnose_set,
    print_figures,
    split_groups,
)

NAME = "otter_oslo"
VESSEL = str(Path(__file__).parent / "otter" / "vessel.toml")
DAYS = ("mar07", "mar22", "apr23")
TOO_SHORT = ("mar07_1529", "apr23_1208")  # less than 15 s
FORMS = ("raw", "clean")
WINDOW = 10.0  # [s] of a free run
# The README leaves these out, and stretches where heading and yaw rate disagree, without a limit
SOURCE = SourceWindows(skipped=4.0, longest_gap=1.6)
UNITS = {
    "position_rms_m": ("distance [m]", DISTANCE),
    "heading_rms_rad": ("heading [deg]", DEG),
}
# What the owner adds to the proposed map. The program of 7 March logs a force and a moment; it
# limits the moment to 115 N m and takes 0.01108 n^2 for the thrust in both senses (README).
OWNERS_LINES = {
    "mar07": (
        'n_port_radps = { sum = ["tau_X * 0.5", { signal = "tau_N", '
        "points = [[-115, -145.57], [115, 145.57]] }], coefficient = 0.01108, exponent = 2.0, "
        "inverse = true }",
        'n_starboard_radps = { sum = ["tau_X * 0.5", { signal = "tau_N", '
        "points = [[-115, 145.57], [115, -145.57]] }], coefficient = 0.01108, exponent = 2.0, "
        "inverse = true }",
    )
}


def main() -> None:
    """Print the figures of each day in each form."""
    parser = argparse.ArgumentParser(description="Figures of the Otter in Oslo harbour")
    parser.add_argument("days", nargs="*", help=f"of {', '.join(DAYS)}; all without any")
    parser.add_argument("--form", choices=FORMS, help="form of the files; both without it")
    out_option(parser, NAME)
    given = parser.parse_args()
    runs = runs_of(NAME)
    print_unusable()
    for day in given.days or DAYS:
        names = [name for name in runs if name.startswith(day) and name not in TOO_SHORT]
        fitted, held_out = split_groups({day: names})
        for form in FORMS:
            if given.form in (None, form):
                print_day(day, form, fitted, held_out, given.out)


def print_unusable() -> None:
    """Print what an import says about the files without usable poses."""
    print("files without usable poses:")
    for file in sorted((RECORDINGS / NAME / "runs_nofix").glob("*.csv")):
        try:
            propose(file, OUT / NAME / "nofix.toml")
            print(f"  {file.name}: a map was proposed")
        except BadInput as error:
            print(f"  {error}")


def print_day(
    day: str, form: str, fitted: Sequence[str], held_out: Sequence[str], out: Path
) -> None:
    """Diagnose the runs of one day in one form, print the figures and write the report."""
    source = files_of_form(form, [*fitted, *held_out], day)
    title = f"{NAME}, {day}, {form}: {len(fitted)} runs fitted, held out {', '.join(held_out)}"
    parts = ([source[name] for name in fitted], [source[name] for name in held_out])
    figures = diagnose_set(title, *parts, VESSEL, (WINDOW,), out / f"{day}_{form}", SOURCE)
    print_figures(figures, UNITS)


def files_of_form(form: str, names: Sequence[str], day: str) -> dict[str, Path]:
    """Return the recordings of a form by run; those of the published files are imported."""
    if form == "clean":
        return {name: RECORDINGS / NAME / "runs_clean" / f"{name}.csv" for name in names}
    found = {}
    print(f"{day}: files as published, imported by the proposed map; what the import repaired:")
    for name in names:
        log = RECORDINGS / NAME / "runs" / f"{name}.csv"
        found[name], remarks = imported(log, OWNERS_LINES.get(day, ()))
        for remark in remarks:
            print(f"  {name}: {remark}")
    for line in OWNERS_LINES.get(day, ()):
        print(f"  line completed by the owner: {line}")
    return found


def imported(log: Path, lines: Sequence[str]) -> tuple[Path, list[str]]:
    """Import a log by the proposed map, in which the owner replaces lines of some columns.

    Returns:
        The recording, and the remarks of the import.
    """
    folder = OUT / NAME / "imported"
    folder.mkdir(parents=True, exist_ok=True)
    map, out = folder / f"{log.stem}.map.toml", folder / f"{log.stem}.csv"
    propose(log, map)
    text = map.read_text(encoding="utf-8")
    for line in lines:
        column = line.split(" = ")[0]
        text = re.sub(rf"^#? ?{column} = .*$", line, text, flags=re.MULTILINE)
    map.write_text(text, encoding="utf-8")
    notes = io.StringIO()
    with redirect_stdout(io.StringIO()), redirect_stderr(notes):
        import_log([log], out, map, None, VESSEL, [])
    remarks = notes.getvalue().split("note: ")[1:]
    return out, [" ".join(remark.split()).removeprefix(f"{log}: ") for remark in remarks]


def propose(log: Path, map: Path) -> None:
    """Write the map that `boatsim import --propose` writes for a log. Raises BadInput."""
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        import_log([log], None, None, map, VESSEL, [])


if __name__ == "__main__":
    main()
