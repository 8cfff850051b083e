"""Sea trials of R/V Gunnerus: `python -m validation.real.gunnerus_trials`.

Two rows: the files as published, imported by the proposed map and with the corrections that the
checks of the log offer, and the files that were put right by hand (`runs_clean`). The split is that
of docs/protocol.md; the vessel is that of `gunnerus_vessel`. `published` or `clean` as an argument
prints one row.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from boatsim.cli.importing import import_log
from validation.real.common import OUT, RECORDINGS, out_option, runs_named, runs_of
from validation.real.corrections import accept_corrections
from validation.real.figures import DISTANCE, Figures, diagnose_set, print_figures, split_groups
from validation.real.gunnerus_vessel import NAME, write_vessel

WINDOW = 60.0  # [s]
UNITS = {
    "position_rms_m": ("distance [m]", DISTANCE),
    "heading_rms_rad": ("heading [deg]", 57.29578),
}
# one run was cut in two by hand
CLEAN_PARTS = {"12_zigzag_170": ("12_zigzag_170a", "12_zigzag_170b")}


def import_published(runs: Sequence[Path], vessel: str, folder: Path) -> list[Path]:
    """Import the published files by a proposed map, and accept the corrections of the checks.

    Args:
        runs: The published files.
        vessel: Path of the vessel.
        folder: Folder of the imported recordings.

    Returns:
        The recordings.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "recording.toml").unlink(missing_ok=True)
    map = folder / "map.toml"
    import_log(runs[:1], None, None, map, vessel, ())
    print("the proposed map, without a change:")
    print(map.read_text(encoding="utf-8"))
    files = []
    for run in runs:
        files.append(folder / run.name)
        import_log([run], files[-1], map, None, vessel, ())
    (folder / "recording.toml").unlink(missing_ok=True)
    print("accepted corrections:")
    for line in accept_corrections(files, vessel):
        print(f"  {line}")
    return files


def clean_files(names: Sequence[str]) -> list[Path]:
    """Return the files that were put right by hand of some runs, with all their parts."""
    files = []
    for name in names:
        for part in CLEAN_PARTS.get(name, (name,)):
            files.append(RECORDINGS / NAME / "runs_clean" / f"{part}.csv")
    return files


def figures_of_published(vessel: str, out: Path) -> Figures:
    """Return the figures from the files as published; the report is written to a folder."""
    runs = runs_of(NAME)
    fitted, held_out = split_groups({"all": list(runs)})
    files = import_published(list(runs.values()), vessel, OUT / NAME / "published")
    by_run = {file.stem: file for file in files}
    return diagnose_set(
        f"{NAME}, files as published",
        runs_named(by_run, fitted),
        runs_named(by_run, held_out),
        vessel,
        (WINDOW,),
        out,
    )


def figures_of_clean(vessel: str, out: Path) -> Figures:
    """Return the figures from the files that were put right by hand, and write the report."""
    fitted, held_out = split_groups({"all": list(runs_of(NAME))})
    return diagnose_set(
        f"{NAME}, runs_clean", clean_files(fitted), clean_files(held_out), vessel, (WINDOW,), out
    )


def main() -> None:
    """Print the figures of the rows that are named, or of both."""
    parser = argparse.ArgumentParser(description="Figures of the sea trials of R/V Gunnerus")
    parser.add_argument("rows", nargs="*", help="of published, clean; both without any")
    out_option(parser, NAME)
    given = parser.parse_args()
    vessel = str(write_vessel())
    for name, figures in (("published", figures_of_published), ("clean", figures_of_clean)):
        if not given.rows or name in given.rows:
            print_figures(figures(vessel, given.out / f"{name}_report"), UNITS)


if __name__ == "__main__":
    main()
