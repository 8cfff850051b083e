"""A raw table with many faults is proposed, converted, and gives the motion of the boat."""

import tomllib
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.logs.table import read
from tests.recordings.importing.test_proposal_by_motion import (
    DOF,
    DRIVES,
    SPEED_AT_80,
    log_of,
    shafts,
    simulated,
)

STALE = slice(200, 260)  # rows in which no message arrived


def cells_of(run: dict[str, np.ndarray]) -> tuple[list[str], list[list[str]]]:
    """Header and rows of a table; the first three rows are from before the first fix."""
    log = log_of(run, **shafts(run))
    columns = {name: signal.values.copy() for name, signal in log.signals.items()}
    for name in columns:
        if name in ("n1", "n2"):
            continue
        columns[name][STALE] = columns[name][STALE.start - 1]
        if name in ("lat", "lon"):
            columns[name][:3] = 0.0
    rows = []
    for i, t in enumerate(run["t"]):
        when = datetime.fromtimestamp(t, UTC).strftime("%Y-%m-%d_%H:%M:%S:%f")
        rows.append([when, *[f"{values[i]:.9g}" for values in columns.values()]])
    return ["", *columns], rows


def with_faults(rows: list[list[str]]) -> list[list[str]]:
    """Rows of which some are doubled, exchanged or empty."""
    faulty = []
    for i, row in enumerate(rows):
        faulty.append(row)
        if i % 50 == 7:
            faulty.append(row)
        if i % 60 == 9:
            faulty.append([""] * len(row))
    for i in range(5, len(faulty) - 5, 40):
        faulty[i], faulty[i + 1] = faulty[i + 1], faulty[i]
    return faulty


def written(folder: Path, header: list[str], rows: list[list[str]], comma: bool = False) -> Path:
    file = folder / "log.csv"
    lines = [";".join(row) for row in (header, *rows)]
    text = "\n".join(lines) + "\n"
    if comma:
        text = text.replace(".", ",")
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize("comma", [False, True])
def test_the_motion_comes_back_from_a_table_with_many_faults(tmp_path, comma):
    run = simulated()
    header, rows = cells_of(run)
    log = read(written(tmp_path, header, with_faults(rows), comma))
    text = propose_map(log, None, DRIVES, DOF, None, lambda: SPEED_AT_80)
    found = convert_log(log, parse_map(tomllib.loads(text), "map.toml"), "map.toml")
    begin = int(round((found.t[-1] - (run["t"][-1] - run["t"][0])) / -0.1))
    assert len(found) == len(run["t"]) - begin
    assert found["n_port_radps"] == pytest.approx(run["port"][begin:], rel=1e-6)
    fresh = np.ones(len(run["t"]), dtype=bool)
    fresh[STALE] = False
    assert np.isnan(found["psi_rad"][~fresh[begin:]]).all()
    assert np.isnan(found["x_m"]).sum() >= 0
    seen = fresh[begin:] & np.isfinite(found["psi_rad"])
    assert seen.sum() > 0.99 * fresh[begin:].sum()
    off = np.angle(np.exp(1j * (found["psi_rad"] - run["psi"][begin:])))[seen]
    assert np.abs(off).max() < 1e-6
    remarks = "\n".join(found.remarks)
    for said in (
        "logged after a later one",
        "time of another one",
        "latitude and longitude 0",
        "no new message had arrived",
        "times are those of column column_1",
    ):
        assert said in remarks


def test_a_heading_that_was_never_sent_is_refused_by_a_given_map_too(tmp_path):
    run = simulated()
    header, rows = cells_of(run)
    place = header.index("current_orientation_3")
    for row in rows:
        row[place] = "0"
    log = read(written(tmp_path, header, rows))
    position = {"latitude": "lat * deg", "longitude": "lon * deg"}
    map = parse_map(
        {"position": position, "columns": {"psi_rad": "current_orientation_3 * deg"}}, "map.toml"
    )
    with pytest.raises(BadInput, match=r"psi_rad is 0 deg in all .* no heading was measured"):
        convert_log(log, map, "map.toml")
