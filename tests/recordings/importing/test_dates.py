"""Times of rows in the forms that programs and spreadsheets write."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from boatsim.recordings.importing.cells import column_of_cells
from boatsim.recordings.importing.clocks import time_column, times_in_seconds
from boatsim.recordings.importing.dates import month_number, seconds_from_dates, zone_name

BEGIN = datetime(2024, 4, 23, 12, 18, 12, 250_000, UTC)
STEPS = [timedelta(milliseconds=100 * i) for i in range(30)]
FORMS = {
    "iso": "%Y-%m-%dT%H:%M:%S.%f",
    "blank": "%Y/%m/%d %H:%M:%S.%f",
    "colon before the fraction": "%Y-%m-%d_%H:%M:%S:%f",
    "german": "%d.%m.%Y %H:%M:%S,%f",
    "british": "%d/%m/%Y %H:%M:%S.%f",
    "american": "%m/%d/%Y %I:%M:%S.%f %p",
    "named month": "%d %b %Y %H:%M:%S.%f",
    "month first": "%b %d, %Y %I:%M:%S.%f %p",
    "C library": "%a %b %d %H:%M:%S.%f %Y",
    "day of the week": "%A, %d %B %Y %H:%M:%S.%f",
    "day of the year": "%Y-%jT%H:%M:%S.%f",
    "day of the year and colons": "%Y:%j:%H:%M:%S.%f",
    "dashes": "%Y-%m-%d-%H-%M-%S-%f",
    "digits": "%Y%m%d%H%M%S.%f",
    "digits only": "%Y%m%d%H%M%S%f",
    "brackets": "[%Y-%m-%d %H:%M:%S.%f]",
    "quotes": "'%Y-%m-%d %H:%M:%S.%f'",
    "name of a zone": "%Y-%m-%d %H:%M:%S.%f CEST",
    "C library with a zone": "%a %b %d %H:%M:%S CEST %Y",
}


@pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
def test_every_form_of_a_date_gives_its_seconds_since_1970(form):
    cells = [(BEGIN + step).strftime(form) for step in STEPS]
    expected = [(BEGIN + step).timestamp() for step in STEPS]
    if "%f" not in form:
        expected = np.floor(expected)
    assert seconds_from_dates(cells) == pytest.approx(expected, abs=1e-5)


def test_a_fraction_behind_a_dash_may_be_whole_milliseconds():
    t = seconds_from_dates([f"2024-04-23-12-18-12-{ms}" for ms in (8, 58, 108, 158)])
    assert np.diff(t) == pytest.approx(0.05, abs=1e-6)
    tenths = seconds_from_dates([f"2024-04-23-12-18-12-{digit}" for digit in (3, 4, 5)])
    assert np.diff(tenths) == pytest.approx(0.1, abs=1e-6)


def test_a_duration_counts_its_days():
    t = seconds_from_dates(["0 days 23:59:59.5", "1 days 00:00:00.5", "1 day, 0:00:01.5"])
    assert t == pytest.approx([86399.5, 86400.5, 86401.5])


def test_the_day_of_a_year_begins_with_one():
    [first] = seconds_from_dates(["2024-001T00:00:00"])
    assert first == datetime(2024, 1, 1, tzinfo=UTC).timestamp()
    assert seconds_from_dates(["2024-367T00:00:00"]) is None


def test_names_of_zones_are_ignored_only_where_all_are_alike():
    there = ["2024-04-23 12:18:12 CEST", "2024-04-23 12:18:13 CEST"]
    assert zone_name(there) == "CEST"
    assert zone_name(["2024-04-23 12:18:12 GMT"]) == ""
    assert seconds_from_dates([there[0], "2024-04-23 12:18:13 EST"]) is None
    assert column_of_cells(there, ";").remarks == (
        ("the name of the time zone, CEST, is ignored", 0),
    )


def test_digits_of_a_date_do_not_leap_at_the_minute():
    cells = [(BEGIN + 20 * step).strftime("%Y%m%d%H%M%S.%f")[:-4] for step in STEPS]
    found = column_of_cells(cells, ",")
    assert found.are_dates
    assert np.diff(found.values) == pytest.approx(2.0)


def test_a_zone_is_taken_into_account():
    [here], [there] = (
        seconds_from_dates(["2024-04-23 12:18:12.5+02:00"]),
        seconds_from_dates(["2024-04-23 10:18:12.5Z"]),
    )
    assert here == there


def test_times_of_day_go_on_after_midnight():
    t = seconds_from_dates(["23:59:59.5", "23:59:59.9", "00:00:00.3", "00:00:00.7"])
    assert np.diff(t) == pytest.approx([0.4, 0.4, 0.4])


def test_minutes_of_a_spreadsheet_go_on_after_the_hour():
    t = seconds_from_dates(["59:59.5", "59:59.9", "00:00.3"])
    assert np.diff(t) == pytest.approx([0.4, 0.4])


@pytest.mark.parametrize("cells", [["1.5", "2.5"], ["20240423"], ["-12.5"], ["auto", "manual"]])
def test_numbers_and_words_are_no_dates(cells):
    assert seconds_from_dates(cells) is None


@pytest.mark.parametrize(
    ("name", "number"), [("mai", 5), ("okt", 10), ("Dez.", 12), ("mars", 3), ("ago", 8), ("x", 0)]
)
def test_months_are_known_in_several_languages(name, number):
    assert month_number(name) == number


def table(**columns):
    return {name: np.asarray(values, dtype=float) for name, values in columns.items()}


T = 1.7e9 + 0.1 * np.arange(50)


def test_the_time_is_a_column_of_dates_before_one_that_only_counts_since_1970():
    columns = table(stamp_of_fix=np.repeat(T[::5], 5), written=T, x=np.sin(T))
    assert time_column(columns, ["written"]) == "written"


def test_a_time_of_the_row_before_and_a_duration_are_not_the_time():
    columns = table(previous_time=T - 0.1, cycle_time=np.full(50, 0.1), current_time=T)
    assert time_column(columns) == "current_time"


def test_without_any_name_a_column_that_counts_since_1970_is_the_time():
    assert time_column(table(a=np.sin(T), b=1000.0 * T)) == "b"
    assert time_column(table(a=np.sin(T), b=np.arange(50.0))) is None


def test_days_of_a_spreadsheet_become_seconds_since_1970():
    days = 45405.0 + (12 * 3600.0 + 0.1 * np.arange(50)) / 86400.0
    t = times_in_seconds("date", days)
    assert t[0] == pytest.approx(datetime(2024, 4, 23, 12, tzinfo=UTC).timestamp(), abs=1e-3)
    assert np.diff(t) == pytest.approx(0.1, abs=1e-4)


def test_seconds_of_a_long_log_are_not_taken_for_days():
    seconds = 40_000.0 + 0.1 * np.arange(50)
    assert np.array_equal(times_in_seconds("t_s", seconds), seconds)
