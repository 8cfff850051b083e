"""One clock from many: samples keep their own times, commands act from theirs, and nothing is made
up between."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boatsim.recordings.importing.resample import (
    Samples,
    clean_samples,
    count_unordered_samples,
    longest_command_gap,
    mean_held_values,
    nearest_samples,
    row_times,
)
from boatsim.recordings.table import Recording

ROWS = 0.1 * np.arange(50)


def test_samples_are_sorted_each_time_once_and_numbers_only():
    found = clean_samples(
        np.array([2.0, 1.0, 2.0, 3.0, np.nan]), np.array([1.0, 2.0, 3.0, np.nan, 5.0])
    )
    np.testing.assert_array_equal(found.t, [1.0, 2.0])
    np.testing.assert_array_equal(found.values, [2.0, 3.0])


@given(st.lists(st.floats(0.0, 4.9), min_size=2, max_size=40, unique=True))
def test_every_sample_is_in_one_row_of_its_own_time_and_no_value_is_new(times):
    given_ = clean_samples(np.array(times), np.arange(len(times), dtype=float))
    near = 0.005
    rows = row_times(ROWS, [given_], near)
    found = nearest_samples(rows, given_, near)
    assert (np.diff(rows) > 0).all() and set(ROWS) <= set(rows)
    there = np.isfinite(found)
    assert set(found[there]) <= set(given_.values)
    for t, value in zip(rows[there], found[there], strict=True):
        assert abs(t - given_.t[given_.values == value][0]) <= near
    lost = set(given_.values) - set(
        found[there]
    )  # only ones that lie so near to another that both are in one row
    assert all(
        np.min(np.abs(np.delete(given_.t, int(k)) - given_.t[int(k)])) <= 2 * near
        for k in map(list(given_.values).index, lost)
    )


@given(
    st.lists(
        st.tuples(st.floats(0.0, 4.8), st.floats(-1.0, 1.0)),
        min_size=1,
        max_size=30,
        unique_by=lambda p: round(p[0], 4),
    )
)
def test_the_area_under_a_held_command_is_that_of_the_command_itself(points):
    given_ = clean_samples(
        np.array([0.0, *(t for t, _ in points)]), np.array([0.3, *(v for _, v in points)])
    )
    found = mean_held_values(ROWS, given_)
    ends = np.append(given_.t, ROWS[-1])
    inside = np.diff(np.minimum(ends, ROWS[-1]))
    assert float(found[:-1] @ np.diff(ROWS)) == pytest.approx(
        float(given_.values @ inside), abs=1e-5
    )


def test_a_command_between_whose_rows_none_comes_is_the_command_itself():
    found = mean_held_values(ROWS, Samples(np.array([0.1, 2.0]), np.array([0.123456789, -0.7])))
    assert np.isnan(found[0])
    assert set(found[1:]) == {0.123456789, -0.7} and found[20] == -0.7 and found[19] == 0.123456789


def test_a_command_that_stops_coming_is_said():
    assert longest_command_gap(ROWS, Samples(0.1 * np.arange(10), np.zeros(10))) == pytest.approx(
        4.0
    )
    assert longest_command_gap(ROWS, Samples(ROWS, np.zeros(50))) == 0.0


def test_a_recording_of_mixed_rates_is_thinned_signal_by_signal():
    t = 0.01 * np.arange(1000)
    own = np.where(
        np.arange(1000) % 200 == 7, t, np.nan
    )  # a slow signal in rows that no thinning by rows would keep
    run = Recording(
        "r", t, {"psi_rad": np.where(np.isnan(own), t, np.nan), "x_m": own, "thrust": np.sin(t)}
    ).thinned(10.0)
    np.testing.assert_array_equal(run["x_m"][np.isfinite(run["x_m"])], own[np.isfinite(own)])
    psi = np.isfinite(run["psi_rad"])
    assert abs(psi.sum() - 100) <= 1 and np.median(np.diff(run.t[psi])) == pytest.approx(0.1)
    np.testing.assert_array_equal(run["psi_rad"][psi], run.t[psi])
    assert float(run["thrust"] @ np.diff(np.append(run.t, 10.0))) == pytest.approx(
        float(np.sin(t).sum() * 0.01), abs=1e-9
    )
    np.testing.assert_array_equal(run.orders.signals["thrust"], np.sin(t))


@pytest.mark.parametrize(
    ("times", "wanted"),
    [
        ([], (0, 0, 0.0)),
        ([1.0, 2.0, 3.0], (0, 0, 0.0)),
        ([1.0, 3.0, 2.0, 4.0], (1, 0, 2.0)),
        ([1.0, 2.0, 2.0, 2.0, 3.0], (0, 2, 2.0)),
        ([1.0, 2.0, 1.0, 2.0, 3.0, np.nan], (1, 2, 1.0)),
    ],
)
def test_samples_out_of_order_and_at_one_time_are_counted(
    times: list[float], wanted: tuple[int, int, float]
) -> None:
    assert count_unordered_samples(np.array(times)) == wanted
