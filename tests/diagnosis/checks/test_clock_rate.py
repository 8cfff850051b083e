"""A clock that runs fast, slowly or unevenly is found, and no single sensor is taken for it."""

from dataclasses import replace

import numpy as np
import pytest
from turning_ship import integral, wandering_rate, winding_ship

from boatsim.diagnosis.checks.clock_rate import check_clock_rate
from boatsim.diagnosis.checks.finding import recording_toml_lines
from boatsim.diagnosis.config import DEFAULT
from boatsim.recordings.table import Recording


def stamped(ship: Recording, rate: np.ndarray) -> Recording:
    recorded = np.concatenate(([0.0], np.cumsum(np.diff(ship.t) / rate)))
    return replace(ship, t=recorded)


def fleet(runs: int = 3) -> list[Recording]:
    return [winding_ship(seed) for seed in range(runs)]


def scaled(ship: Recording, **factors: float) -> Recording:
    signals = {name: ship[name] * factors[name] for name in factors}
    return replace(ship, signals=ship.signals | signals)


def test_a_wandering_clock_and_the_line_that_corrects_it() -> None:
    logs = [stamped(s, wandering_rate(s.t, 0.1, k)) for k, s in enumerate(fleet())]
    found = check_clock_rate(logs, DEFAULT.checks)
    assert [f.name for f in found] == ["clock_wanders"] * 3
    assert recording_toml_lines(found[0], {}) == ['clock = "motion"']


def test_a_gain_of_the_velocities_is_told_from_the_clock() -> None:
    logs = []
    for k, ship in enumerate(fleet()):
        log = stamped(ship, wandering_rate(ship.t, 0.1, k))
        logs.append(scaled(log, u_mps=0.94, v_mps=0.94))
    found = check_clock_rate(logs, DEFAULT.checks)
    assert sorted({f.name for f in found}) == ["clock_wanders", "velocity_gain"]
    gain = next(f for f in found if f.name == "velocity_gain").changes[0].factor
    assert gain == pytest.approx(1.0 / 0.94, abs=0.015)


@pytest.mark.parametrize("rate", [0.9, 1.06])
def test_a_clock_that_is_fast_or_slow(rate: float) -> None:
    logs = [stamped(s, np.full(len(s) - 1, rate)) for s in fleet()]
    found = check_clock_rate(logs, DEFAULT.checks)
    assert [f.name for f in found] == ["clock_rate"] * 3
    assert found[0].changes[0].column == "t_s"
    assert found[0].changes[0].factor == pytest.approx(rate, abs=0.01)


@pytest.mark.parametrize("rates", [(1.06, 1.0, 1.0), (0.9, 1.0), (1.06, 0.94, 1.0)])
def test_files_with_clock_rates_of_their_own(rates: tuple[float, ...]) -> None:
    logs = []
    for ship, rate in zip(fleet(len(rates)), rates, strict=True):
        logs.append(replace(stamped(ship, np.full(len(ship) - 1, rate)), name=f"run_{rate}"))
    found = check_clock_rate(logs, DEFAULT.checks)
    wrong = [rate for rate in rates if rate != 1.0]
    assert [(f.name, f.run) for f in found] == [("clock_rate", f"run_{rate}") for rate in wrong]
    for finding, rate in zip(found, wrong, strict=True):
        assert finding.changes[0].factor == pytest.approx(rate, abs=0.01)
    assert recording_toml_lines(replace(found[0], run="log 1.csv"), {})[0] == (
        '[runs."log 1".columns]'
    )


@pytest.mark.parametrize(("count", "noise"), [(1200, 1.0), (600, 1.0), (600, 0.2)])
@pytest.mark.parametrize("wandering", [{2}, {0, 3}])
def test_only_the_recordings_whose_clock_wanders_are_named(
    wandering: set[int], count: int, noise: float
) -> None:
    logs = []
    for k in range(5):
        log = winding_ship(20 + k, count, noise)
        if k in wandering:
            log = stamped(log, wandering_rate(log.t, 0.1, k))
        logs.append(replace(log, name=f"run_{k}"))
    found = check_clock_rate(logs, DEFAULT.checks)
    assert [(f.name, f.run) for f in found] == [
        ("clock_wanders", f"run_{k}") for k in sorted(wandering)
    ]
    lines = recording_toml_lines(found[0], {})
    assert lines == [f"[runs.{found[0].run}]", 'clock = "motion"']


def test_a_recording_without_turns_has_the_clock_of_the_others() -> None:
    logs = []
    for k in range(4):
        log = winding_ship(20 + k, 1200, 1.0)
        log = replace(stamped(log, wandering_rate(log.t, 0.1, k)), name=f"run_{k}")
        if k == 3:  # too few turns to show it
            kept = log.t < log.t[0] + 0.1 * (log.t[-1] - log.t[0])
            signals = {name: values[kept] for name, values in log.signals.items()}
            log = replace(log, t=log.t[kept], signals=signals)
        logs.append(log)
    found = check_clock_rate(logs, DEFAULT.checks)
    assert {f.run for f in found if f.name == "clock_wanders"} == {f"run_{k}" for k in range(4)}


def test_a_wandering_clock_does_not_hide_a_slow_one() -> None:
    logs = []
    for k, ship in enumerate(fleet(4)):
        rate = np.full(len(ship) - 1, 1.06 if k == 1 else 1.0)
        if k == 3:
            rate = wandering_rate(ship.t, 0.1, k)
        logs.append(replace(stamped(ship, rate), name=f"run_{k}"))
    found = {f.run: f for f in check_clock_rate(logs, DEFAULT.checks)}
    assert {run: f.name for run, f in found.items()} == {
        "run_1": "clock_rate",
        "run_3": "clock_wanders",
    }
    assert found["run_1"].changes[0].factor == pytest.approx(1.06, abs=0.01)


@pytest.mark.parametrize("noise", [0.2, 1.0, 4.0])
def test_right_logs_have_no_finding(noise: float) -> None:
    for seed in range(10):
        ships = []
        for k in range(2):
            ships.append(replace(winding_ship(10 * seed + k, noise=noise), name=f"run_{k}"))
        assert check_clock_rate(ships, DEFAULT.checks) == []


def test_one_sensor_that_is_wrong_alone_is_no_clock() -> None:
    for factors in ({"u_mps": 0.9, "v_mps": 0.9}, {"r_radps": 1.1}):
        assert check_clock_rate([scaled(s, **factors) for s in fleet()], DEFAULT.checks) == []
    rng = np.random.default_rng(1)
    uneven = []
    for k, ship in enumerate(fleet()):
        wander = np.append(wandering_rate(ship.t, 0.1, int(rng.integers(99))), 1.0)
        uneven.append(replace(ship, signals=ship.signals | {"u_mps": ship["u_mps"] * wander}))
        assert len(wander) == len(ship), k
    assert check_clock_rate(uneven, DEFAULT.checks) == []


def test_a_current_or_late_sensors_are_no_clock() -> None:
    drifting, late = [], []
    for ship in fleet():
        moved = ship["x_m"] + integral(ship.t, np.full(len(ship), 0.7))
        drifting.append(replace(ship, signals=ship.signals | {"x_m": moved}))
        velocities = {name: np.roll(ship[name], 3) for name in ("u_mps", "v_mps", "r_radps")}
        late.append(replace(ship, signals=ship.signals | velocities))
    assert check_clock_rate(drifting, DEFAULT.checks) == []
    assert check_clock_rate(late, DEFAULT.checks) == []
