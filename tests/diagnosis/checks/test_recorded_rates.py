"""Recorded velocities are compared with poses also where every sensor has a rate of its own."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.checks.late_by_kinematics import late_sensor_findings
from boatsim.diagnosis.checks.recorded_rates import check_recorded_rates
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics.base import Array
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

BOAT = load_vessel("trial_boat")
LATE = 0.9  # [s]
STEP = 0.1  # [s] between rows; poses are in every second, the yaw rate in the rows between


def true_motion(t: Array) -> dict[str, Array]:
    """A boat on a winding course, by an integral over 1 ms."""
    fine = np.arange(-5.0, t[-1] + 5.0, 1e-3)
    r = 0.4 * np.sin(0.7 * fine) + 0.2 * np.sin(1.3 * fine)
    psi = np.cumsum(r) * 1e-3
    u = 0.5 + 0.2 * np.sin(0.4 * fine)
    v = 0.1 * np.sin(0.9 * fine)
    x = np.cumsum(u * np.cos(psi) - v * np.sin(psi)) * 1e-3
    y = np.cumsum(u * np.sin(psi) + v * np.cos(psi)) * 1e-3
    every = {"x_m": x, "y_m": y, "psi_rad": psi, "u_mps": u, "v_mps": v, "r_radps": r}
    return {name: np.interp(t, fine, values) for name, values in every.items()}


def log_of_sensors(seed: int, late: float = 0.0, names: tuple[str, ...] = ()) -> Recording:
    """Rows at 10 Hz in which each sensor has empty cells; some columns are late."""
    rng = np.random.default_rng(seed)
    t = STEP * np.arange(900)
    true, delayed = true_motion(t), true_motion(t - late)
    signals = {}
    for name in true:
        values = true[name]
        if name in names:
            values = delayed[name]
        signals[name] = values + 0.003 * rng.standard_normal(len(t))
        every_second = np.arange(len(t)) % 2 == int(name == "r_radps")
        signals[name] = np.where(every_second, signals[name], np.nan)
    return Recording("log", t, signals)


def changed(log: Recording, **columns: Array) -> Recording:
    return replace(log, signals=log.signals | columns)


FAULTS: dict[str, Callable[[Recording], Recording]] = {
    "velocity_sign": lambda log: changed(log, r_radps=-log["r_radps"]),
    "velocity_unit": lambda log: changed(log, u_mps=log["u_mps"] * 3600.0 / 1852.0),
    "velocity_elsewhere": lambda log: changed(
        log, v_mps=log["v_mps"] + 0.4 * true_motion(log.t)["r_radps"]
    ),
}


@pytest.mark.parametrize("seed", range(5))
def test_right_sensors_of_different_rates_have_no_finding(seed: int) -> None:
    assert check_recorded_rates(log_of_sensors(seed), BOAT, DEFAULT.checks) == []


@pytest.mark.parametrize("name", FAULTS)
def test_faults_are_found_in_rows_with_empty_cells(name: str) -> None:
    found = check_recorded_rates(FAULTS[name](log_of_sensors(0)), BOAT, DEFAULT.checks)
    assert [f.name for f in found] == [name]


@pytest.mark.parametrize("late", [("r_radps",), ("psi_rad",), ("x_m", "y_m", "psi_rad")])
def test_a_delay_is_found_in_rows_with_empty_cells(late: tuple[str, ...]) -> None:
    found = check_recorded_rates(log_of_sensors(1, LATE, late), BOAT, DEFAULT.checks)
    changes = [change for f in found if f.name == "velocity_late" for change in f.changes]
    assert {change.column for change in changes} == set(late)
    for change in changes:
        assert change.delay == pytest.approx(LATE, abs=STEP)


SENSOR_ROWS = [  # rows from one sample of a sensor to the next
    {},
    {"x_m": 4, "y_m": 4, "u_mps": 4, "v_mps": 4, "psi_rad": 2},
]


def log_with_delays(late: dict[str, float], rows: dict[str, int], seed: int = 0) -> Recording:
    """Rows at 10 Hz of sensors with intervals and delays of their own [s]."""
    rng = np.random.default_rng(seed)
    t = STEP * np.arange(900)
    signals = {}
    for name in true_motion(t[:1]):
        values = true_motion(t - late.get(name, 0.0))[name] + 0.003 * rng.standard_normal(len(t))
        signals[name] = np.where(np.arange(len(t)) % rows.get(name, 1) == 0, values, np.nan)
    return Recording("log", t, signals)


@pytest.mark.parametrize("rows", SENSOR_ROWS)
@pytest.mark.parametrize(
    ("columns", "delay"),
    [
        (("r_radps",), 0.4),
        (("r_radps",), -0.4),
        (("psi_rad",), 0.4),
        (("x_m", "y_m"), 0.4),
        (("x_m", "y_m"), -0.35),
        (("u_mps", "v_mps"), 0.43),
        (("x_m", "y_m", "psi_rad"), 0.4),
        (("u_mps", "v_mps", "r_radps"), 0.4),
    ],
)
def test_each_late_sensor_is_reported_once_with_its_delay(
    columns: tuple[str, ...], delay: float, rows: dict[str, int]
) -> None:
    log = log_with_delays(dict.fromkeys(columns, delay), rows)
    [found] = check_recorded_rates(log, BOAT, DEFAULT.checks)
    assert found.name == "velocity_late"
    assert tuple(change.column for change in found.changes) == columns
    sd = float(found.evidence.split(" +- ")[1].split(" s ")[0])
    assert 0.0 < sd < 0.04
    for change in found.changes:
        assert change.delay == pytest.approx(delay, abs=4.0 * sd)


def test_sensors_with_two_delays_are_reported_with_each() -> None:
    late = {"x_m": 0.4, "y_m": 0.4, "psi_rad": 0.8}
    found = check_recorded_rates(log_with_delays(late, {}), BOAT, DEFAULT.checks)
    delays = {change.column: change.delay for one in found for change in one.changes}
    assert delays == pytest.approx(late, abs=0.03)
    assert len(found) == 2


def test_an_antenna_elsewhere_is_no_delay() -> None:
    log = log_with_delays({}, {})
    psi = log["psi_rad"]
    moved = changed(log, x_m=log["x_m"] + 0.4 * np.cos(psi), y_m=log["y_m"] + 0.4 * np.sin(psi))
    found = check_recorded_rates(moved, BOAT, DEFAULT.checks)
    assert [one.name for one in found] == ["velocity_elsewhere"]


def test_a_turn_that_no_heading_sensor_saw_is_no_fault() -> None:
    """The heading is missing for 10 s, in which its change is that of the yaw rate."""
    log = log_of_sensors(2)
    away = (log.t > 30.0) & (log.t < 40.0)
    with_gap = changed(log, psi_rad=np.where(away, np.nan, log["psi_rad"]))
    assert check_recorded_rates(with_gap, BOAT, DEFAULT.checks) == []
    late = log_of_sensors(2, LATE, ("r_radps",))
    late = changed(late, psi_rad=np.where(away, np.nan, late["psi_rad"]))
    [found] = check_recorded_rates(late, BOAT, DEFAULT.checks)
    assert found.changes[0].delay == pytest.approx(LATE, abs=STEP)


def test_a_few_samples_are_not_compared() -> None:
    log = log_of_sensors(3, LATE, ("r_radps",))
    few = np.arange(len(log)) % 40 == 1  # 23 of 900 rows
    log = changed(log, r_radps=np.where(few, -log["r_radps"], np.nan))
    assert check_recorded_rates(log, BOAT, DEFAULT.checks) == []


@pytest.mark.parametrize(
    "late",
    [{"r_radps": 0.6}, {"x_m": 0.6, "y_m": 0.6}, {"x_m": 0.4, "y_m": 0.4, "psi_rad": 0.8}],
)
def test_the_share_that_a_delay_explains_concerns_late_sensors_alone(
    late: dict[str, float],
) -> None:
    """Sensors that are on time differ from each other by noise, of which no delay explains any."""
    for found in check_recorded_rates(log_with_delays(late, {}), BOAT, DEFAULT.checks):
        share = float(found.evidence.split("explains ")[1].split(" %")[0])
        assert share > 70.0


def test_a_recording_of_one_row_has_no_delays(recwarn: pytest.WarningsRecorder) -> None:
    log = log_with_delays({}, {}).between(0.0, 0.0)
    assert late_sensor_findings(log, BOAT, DEFAULT.checks) == []
    assert not recwarn.list
