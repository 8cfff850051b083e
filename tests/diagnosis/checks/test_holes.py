"""Holes of a log: what is proposed in their place, and what is compared with the vessel."""

import tomllib

import numpy as np
import pytest

from boatsim.diagnosis.checks.holes import check_holes, part_before_first_hole
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Recording

CHECKS = DEFAULT.checks


@pytest.fixture(scope="module")
def boat() -> Vessel:
    return load_vessel("joystick_boat")  # 1.2 m


def with_hole(begin: float, end: float) -> Recording:
    """A recording of 100 s with 10 rows a second, none of them within the hole."""
    t = np.arange(0.0, 100.0, 0.1)
    t = t[(t <= begin + 1e-9) | (t >= end - 1e-9)]
    return Recording("log", t, {"x_m": 0.1 * t, "y_m": 0.0 * t, "psi_rad": 0.0 * t})


def test_a_hole_is_answered_with_the_parts_beside_it(boat: Vessel) -> None:
    (finding,) = check_holes(with_hole(40.0, 60.0), boat, CHECKS)
    assert finding.kind == "fault" and finding.spans == ((40.0, 60.0),)
    use = tomllib.loads(finding.remedy.partition(": ")[2])["use"]
    assert use == [[0.0, 40.0], [60.0, 99.9]]


def test_a_short_interval_without_rows_is_no_hole_and_a_larger_hull_has_longer_ones(
    boat: Vessel,
) -> None:
    assert not check_holes(with_hole(40.0, 45.0), boat, CHECKS)
    ship = load_vessel("mariner")  # 160 m: times are eleven times as long
    assert not check_holes(with_hole(40.0, 60.0), ship, CHECKS)


def test_reinterpretations_are_compared_on_one_side_of_a_hole(boat: Vessel) -> None:
    """Over a hole the model follows one command, and any other heading may fit as well."""
    before = part_before_first_hole(with_hole(40.0, 60.0), boat, CHECKS)
    assert before.t[0] == 0.0 and before.t[-1] == pytest.approx(40.0)
    behind = part_before_first_hole(with_hole(2.0, 60.0), boat, CHECKS)  # 21 rows before it
    assert behind.t[0] == pytest.approx(60.0)
    whole = with_hole(40.0, 41.0)
    assert len(part_before_first_hole(whole, boat, CHECKS)) == len(whole)
