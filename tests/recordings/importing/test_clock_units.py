"""Units of the times of a table: by name, by the row below it, as counts of days; lost digits."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.clock_units import unit_of_clock, with_unit, without_unit
from boatsim.recordings.logs.table import read

T = 0.1 * np.arange(60)  # [s]
HEADING = 10.0 + 3.0 * np.sin(T)


def table(folder: Path, clock: str, cells: list[str], units: str = "") -> Path:
    rows = [f"{cell};{x:.2f}" for cell, x in zip(cells, HEADING, strict=True)]
    file = folder / "log.csv"
    file.write_text("\n".join([f"{clock};heading_deg", *filter(None, [units]), *rows]) + "\n")
    return file


def times(file: Path) -> np.ndarray:
    return read(file).signals["heading_deg"].t


@pytest.mark.parametrize(
    ("clock", "seconds"),
    [
        *[("Time [s]", 1.0), ("time_sec", 1.0), ("Time [ms]", 1e-3), ("t_us", 1e-6)],
        *[("Time (ns)", 1e-9), ("Time [min]", 60.0), ("time_min", 60.0), ("Time (h)", 3600.0)],
        *[("elapsed_hours", 3600.0), ("Time [days]", 86400.0), ("Zeit [min]", 60.0)],
    ],
)
def test_the_unit_in_the_name_of_the_times_counts(tmp_path, clock, seconds):
    file = table(tmp_path, clock, [f"{t / seconds:.9f}" for t in T])
    assert times(file) == pytest.approx(T, abs=1e-4)


def test_minutes_and_hours_get_a_remark(tmp_path):
    remarks = read(table(tmp_path, "time_min", [f"{t / 60.0:.7f}" for t in T])).remarks
    assert any("the times of column time_min are in minutes" in remark for remark in remarks)


def test_the_unit_in_the_row_below_the_header_counts(tmp_path):
    file = table(tmp_path, "Time", [f"{t / 60.0:.7f}" for t in T], "min;deg")
    assert times(file) == pytest.approx(T, abs=1e-4)


def test_a_clock_on_the_wall_is_in_seconds_whatever_its_name(tmp_path):
    cells = [f"12:18:{12.0 + t:06.3f}" for t in T]
    assert np.diff(times(table(tmp_path, "Time [h]", cells))) == pytest.approx(0.1)


@pytest.mark.parametrize("name", ["min", "day", "hour", "time", "time of day", "datetime", "h"])
def test_a_part_of_a_date_is_no_unit(name):
    assert unit_of_clock(name) == ""
    assert without_unit(name) == name


def test_only_units_of_times_belong_to_a_clock():
    assert with_unit("time", "ms") == "time [ms]"
    assert with_unit("time_s", "ms") == "time_s"
    assert with_unit("time", "deg") == "time"


EPOCH = datetime(2024, 4, 23, 12, 18, 12, tzinfo=UTC)


@pytest.mark.parametrize(
    ("day", "name"),  # of 2000-01-01 00:00 UTC
    [(36526.0, ""), (730486.0, "MATLAB's datenum"), (2451544.5, "Julian dates")],
)
@pytest.mark.parametrize("column", ["time", "n"])
def test_counts_of_days_are_seconds_since_1970(tmp_path, day, name, column):
    since = (EPOCH - datetime(2000, 1, 1, tzinfo=UTC)).total_seconds() + T
    log = read(table(tmp_path, column, [f"{day + s / 86400.0:.10f}" for s in since]))
    found = log.signals["heading_deg"].t
    assert found == pytest.approx(EPOCH.timestamp() + T, abs=1e-4)
    assert any(f"are read as {name}" in remark for remark in log.remarks) == bool(name)


def test_seconds_of_a_clock_that_runs_for_days_are_no_days(tmp_path):
    begin = 739000.0
    assert times(table(tmp_path, "time", [f"{begin + t:.1f}" for t in T])) == pytest.approx(
        begin + T
    )


def test_times_with_too_few_digits_get_a_remark(tmp_path):
    milliseconds = 1000.0 * (EPOCH.timestamp() + T)
    log = read(table(tmp_path, "time", [f"{t:.9E}" for t in milliseconds]))
    said = "of the rows have the time of the row before: if the times have too few digits"
    assert said in "".join(log.remarks)
    same = read(table(tmp_path, "time", [f"{t:.5E}" for t in milliseconds]))
    assert "column time is 1.71387e+12 in all rows" in "".join(same.remarks)
    full = read(table(tmp_path, "time", [f"{t:.0f}" for t in milliseconds]))
    assert not full.remarks
