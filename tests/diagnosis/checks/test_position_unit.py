"""A unit of positions is corrected only if a second sign agrees with the impossible speed."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.checks.position_unit import check_position_unit
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

BOAT = load_vessel("otter")  # 2 m long
SPEED = 1.0  # [m/s]


def log_of(factor: float = 1.0, seconds: float = 1.0, turning: bool = True) -> Recording:
    """A boat on a winding or a straight course; positions and times times a factor each.

    The winding course has 10 lengths of the hull for 4 radians of turn.
    """
    fine = np.arange(0.0, 120.0, 0.01)
    course = np.sin(2.0 * np.pi * fine / 20.0) * float(turning)
    x, y = (0.01 * SPEED * np.cumsum(f(course)) for f in (np.cos, np.sin))
    x, y, psi, t = (values[::20] for values in (x, y, course, fine))
    rng = np.random.default_rng(1)
    psi = psi + 0.01 * rng.standard_normal(len(t))
    signals = {"x_m": factor * x, "y_m": factor * y, "psi_rad": psi}
    return Recording("log", seconds * t, signals)


@pytest.mark.parametrize("factor", [100.0, 1000.0])
def test_a_unit_of_positions_that_turns_confirm_is_corrected(factor: float) -> None:
    [found] = check_position_unit(log_of(factor), BOAT, DEFAULT.checks)
    assert found.name == "position_unit"
    assert [c.factor for c in found.changes] == pytest.approx([1.0 / factor] * 2)


def test_a_recorded_speed_confirms_the_unit_too() -> None:
    log = log_of(100.0, turning=False)
    log = replace(log, signals=log.signals | {"u_mps": np.full(len(log), SPEED)})
    [found] = check_position_unit(log, BOAT, DEFAULT.checks)
    assert [c.factor for c in found.changes] == pytest.approx([0.01, 0.01])


def test_times_that_are_too_short_do_not_change_the_positions() -> None:
    [found] = check_position_unit(log_of(seconds=1.0 / 60.0), BOAT, DEFAULT.checks)
    assert found.name == "time_unit" and not found.changes
    assert "t_s * min" in found.remedy


@pytest.mark.parametrize(("factor", "seconds"), [(60.0, 1.0), (1.0, 1.0 / 60.0)])
def test_an_impossible_speed_alone_names_both_units(factor: float, seconds: float) -> None:
    """On a straight course both logs have the same positions and speeds up to their scale."""
    [found] = check_position_unit(log_of(factor, seconds, turning=False), BOAT, DEFAULT.checks)
    assert found.name == "position_unit" and not found.changes
    assert "in cm" in found.evidence and "in minutes" in found.evidence


@pytest.mark.parametrize("turning", [True, False])
def test_a_right_log_has_no_finding(turning: bool) -> None:
    assert check_position_unit(log_of(turning=turning), BOAT, DEFAULT.checks) == []
