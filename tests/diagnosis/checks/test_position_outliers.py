"""Outliers of positions are found by their jumps, ignored, and do not change the diagnosis."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from answers import diagnosed, nothing_missing
from real_boat import Real, recorded

from boatsim.diagnosis.checks.position_outliers import (
    drop_position_outliers,
    outlier_rows,
    outlier_rows_at_start,
)
from boatsim.physics import vessel
from boatsim.recordings.notes import Notes
from boatsim.recordings.table import Recording

FINEST, LONGEST = 1e-4, 1.5  # [m], [s]
BURST, POSITION = slice(100, 106), ("x_m", "y_m")


def astray(run: Recording, off: float, rows: slice = BURST) -> Recording:
    """The recording with some of its fixes off to the north-east."""
    moved = {
        n: run[n] + np.where(np.isin(np.arange(len(run)), np.arange(len(run))[rows]), off, 0.0)
        for n in POSITION
    }
    return replace(run, signals={**run.signals, **moved})


@pytest.mark.parametrize(
    "rows", [slice(100, 101), slice(100, 103), BURST], ids=lambda s: f"{s.stop - s.start} rows"
)
def test_a_burst_of_any_length_is_found_and_nothing_else(rows: slice) -> None:
    run, boat = recorded(Real(), 1), vessel.load_vessel("trial_boat")
    assert (
        not drop_position_outliers(run, boat).remarks
        and not drop_position_outliers(recorded(Real(), 2), boat).remarks
    )
    found = drop_position_outliers(astray(run, 0.4, rows), boat)
    assert np.flatnonzero(np.isnan(found["x_m"])).tolist() == list(range(rows.start, rows.stop))
    assert np.isfinite(found["psi_rad"]).all() and "jump away and return" in found.remarks[-1]


@pytest.mark.parametrize("noise", [0.0, 0.003], ids=["no noise", "noise"])
def test_what_a_boat_can_do_is_no_leap(noise: float) -> None:
    """Hard turns, crash stops, lying still; and an origin that is moved for good."""
    rng, t = np.random.default_rng(3), np.arange(0.0, 60.0, 0.1)
    heading = 0.8 * np.cumsum(np.where(np.sin(0.6 * t) > 0.0, 1.0, -1.0)) * 0.1
    speed = np.where((t > 20.0) & (t < 40.0), 1.0, 0.0)
    speed = np.convolve(speed, np.ones(5) / 5.0, "same")
    path = 0.1 * np.cumsum(
        speed[:, None] * np.column_stack([np.cos(heading), np.sin(heading)]), axis=0
    )
    path += noise * rng.standard_normal(path.shape)
    assert not outlier_rows(t, path, FINEST, LONGEST).any()
    moved = path + np.where(t[:, None] > 30.0, 2.0, 0.0)
    assert not outlier_rows(t, moved, FINEST, LONGEST).any()


@pytest.mark.slow
def test_a_diagnosis_is_not_misled_by_bursts(tmp_path: Path) -> None:
    runs = [astray(recorded(Real(), s), 0.5) for s in (1, 2, 3)]
    nothing_missing(diagnosed(runs, tmp_path, "trial_boat"))


def test_a_turn_that_begins_after_a_row_at_rest_is_no_outlier() -> None:
    """After a dead time of a row the yaw rate is reached in a quarter of a row: a parabola through
    the next eight headings misses the first one by more than six standard deviations."""
    boat = vessel.load_vessel("trial_boat")
    t, sd = 0.2 * np.arange(40), 5e-3
    since = np.maximum(t - 0.2, 0.0)
    heading = 0.3 * (since - 0.05 * (1.0 - np.exp(-since / 0.05)))
    signals = {"psi_rad": heading, "x_m": 0.0 * t, "y_m": 0.0 * t}
    run = Recording("turn", t, signals, notes=Notes(noise={"heading_sd_rad": sd}))
    course = np.polyfit(t[1:9], heading[1:9], 2)
    assert abs(np.polyval(course, 0.0)) > 10.0 * sd  # 6 sds of a prediction by eight fixes
    assert outlier_rows_at_start(run, boat) == 0
    heading[0] += 0.2
    assert outlier_rows_at_start(run, boat) == 1


@pytest.mark.slow
def test_a_recording_that_begins_with_a_fix_astray_begins_a_row_later(tmp_path: Path) -> None:
    """The filter starts from the first fix: one that is off gave the hull other damping (Eastward
    Ho, 36 noise sds)."""
    runs, boat = [recorded(Real(), s) for s in (1, 2, 3)], vessel.load_vessel("trial_boat")
    assert [outlier_rows_at_start(r, boat) for r in runs] == [0, 0, 0]
    first = [astray(runs[0], 0.2, slice(0, 1)), astray(runs[1], -0.2, slice(0, 2)), runs[2]]
    assert [outlier_rows_at_start(r, boat) for r in first] == [1, 2, 0]
    begun = drop_position_outliers(first[1], boat)
    assert begun.t[0] == runs[1].t[2] and f"before t = {begun.t[0]:g} s" in begun.remarks[0]
    nothing_missing(diagnosed(first, tmp_path, "trial_boat"))
