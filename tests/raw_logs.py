"""A raw table of a logger, proposed and converted by the command line as its owner does it."""

import csv
from collections.abc import Mapping
from pathlib import Path

from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording, read


def imported(
    folder: Path, vessel: Path, log: Mapping[str, Array], change: Mapping[str, str] | None = None
) -> tuple[Recording, str]:
    """The recording after a proposal and a conversion, and the proposed map.

    `change` are texts of the map that its owner replaces.
    """
    names = [folder / name for name in ("raw.csv", "map.toml", "run.csv")]
    with open(names[0], "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(log)
        for row in zip(*log.values(), strict=True):
            rows.writerow([f"{x:.9g}" if x < 1e6 else f"{x:.3f}" for x in row])
    raw, proposal, out = map(str, names)
    done = CliRunner().invoke(app, ["import", raw, "--vessel", str(vessel), "--propose", proposal])
    assert done.exit_code == 0, done.output
    text = names[1].read_text()
    for old, new in (change or {}).items():
        assert old in text
        text = text.replace(old, new)
    names[1].write_text(text)
    done = CliRunner().invoke(app, ["import", raw, "--map", proposal, "--out", out])
    assert done.exit_code == 0, done.output
    return read(names[2]), text
