"""A heading that was interpolated across a full turn has rows that no compass measured."""

from pathlib import Path

import numpy as np
import pytest
from turning_ship import winding_ship

from boatsim.diagnosis.checks.data_cleaning import cleaning_findings
from boatsim.recordings.interpolated_wraps import empty_across_wrap, interpolated_wrap_rows
from boatsim.recordings.table import Recording, read, write_csv

TURN = 2.0 * np.pi


def circling(every: float, begin: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, true heading, and the heading interpolated linearly between wrapped samples."""
    t = 0.5 * np.arange(600)
    samples = np.arange(-1.0, t[-1] + 2.0 * every, every)
    true = 0.05 * t + 0.3
    wrapped = np.remainder(0.05 * samples + 0.3 - begin, TURN) + begin
    return t, true, np.interp(t, samples, wrapped)


@pytest.mark.parametrize("begin", [0.0, -np.pi])
@pytest.mark.parametrize("every", [1.3, 2.7, 4.1])
def test_rows_between_both_ends_of_the_circle_are_found(every: float, begin: float) -> None:
    _, true, heading = circling(every, begin)
    wrong = np.abs(np.remainder(heading - true + np.pi, TURN) - np.pi) > 1e-6
    found = interpolated_wrap_rows(heading)
    assert wrong.any() and (found | ~wrong).all()
    assert found.sum() <= wrong.sum() + 2 * 8  # one row on each side of each of 4 or 5 wraps


def test_headings_that_jump_by_a_turn_between_rows_are_all_measured() -> None:
    t = 0.5 * np.arange(600)
    rng = np.random.default_rng(0)
    for rate in (0.01, 0.1, 0.5):  # [rad/s]
        heading = np.remainder(rate * t + 0.01 * rng.standard_normal(600), TURN)
        assert not interpolated_wrap_rows(heading).any()
    assert not interpolated_wrap_rows(0.3 * np.sin(0.1 * t)).any()


def test_a_recording_keeps_its_true_heading_and_says_what_is_not_used(tmp_path: Path) -> None:
    t, true, heading = circling(2.7)
    ship = winding_ship(0, 600)
    write_csv(Recording("log", t, ship.signals | {"psi_rad": heading}), tmp_path / "log.csv")
    found = read(tmp_path / "log.csv")
    known = np.isfinite(found["psi_rad"])
    assert known.mean() > 0.9
    assert np.abs(found["psi_rad"] - true)[known].max() < 1e-6
    [finding] = cleaning_findings(found)
    assert finding.name == "heading_across_wrap" and finding.kind == "mended"


def test_a_heading_may_be_empty_where_it_jumps_by_a_turn_and_nowhere_else() -> None:
    empty = np.nan
    angle = np.array([empty, 6.1, 6.2, empty, empty, 0.1, 0.2, empty, 0.3, empty])
    assert np.flatnonzero(empty_across_wrap(angle)).tolist() == [3, 4]
