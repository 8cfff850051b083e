"""Stale samples of a log, and maps that distribute orders to drives."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.recordings.conversion import Allocation, Curve
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import Map, parse_map
from boatsim.recordings.repeated_values import stale_rows

T = 0.1 * np.arange(400)


def noisy_heading(seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.round(20.0 * np.sin(0.2 * T) + 0.1 * rng.normal(size=len(T)), 3)


def test_samples_that_repeat_exactly_between_new_ones_are_stale():
    values = noisy_heading()
    rng = np.random.default_rng(1)
    late = np.sort(rng.choice(np.arange(1, len(T)), 40, replace=False))
    for row in late:
        values[row] = values[row - 1]
    assert np.array_equal(np.flatnonzero(stale_rows(values)), late)


@pytest.mark.parametrize("digits", [0, 1])
def test_a_steady_value_that_its_resolution_repeats_is_not_stale(digits):
    steady = np.round(5.0 * np.clip(np.sin(0.2 * T), -0.5, 0.5), digits)
    assert not stale_rows(steady).any()
    rng = np.random.default_rng(2)
    coarse = np.round(20.0 * np.sin(0.2 * T) + 0.3 * rng.normal(size=len(T)), digits)
    assert not stale_rows(coarse).any()


def test_commands_go_on_in_rows_without_a_new_message():
    heading = noisy_heading()
    order = np.sin(0.5 * T)
    heading[100:200] = heading[99]
    heading[250:260:2] = heading[249:259:2]
    signals = {"yaw": Signal(T, heading), "order": Signal(T, order)}
    map = Map(columns={"psi_rad": "yaw * deg", "thrust_port_N": "order"})
    run = convert_log(Log(Path("log.csv"), signals), map, "map.toml")
    assert run["thrust_port_N"] == pytest.approx(order)
    assert np.isnan(run["psi_rad"][100:200]).all()
    assert int(np.isnan(run["psi_rad"]).sum()) == 105
    [remark] = [one for one in run.remarks if "psi_rad: 105 of 400 samples repeat" in one]
    assert f"first {T[100] - T[0]:.3f} s after the log begins" in remark


def test_an_allocation_gives_the_shaft_rate_of_a_thrust_within_its_limits():
    allocation = Allocation(
        sum=["X"],
        low=-50.0,
        high=100.0,
        coefficient=0.01,
        exponent=2.0,
        inverse=True,
        coefficient_below=0.005,
    )
    assert allocation.convert(np.array([100.0, 400.0, -50.0, -300.0, 0.0])) == pytest.approx(
        [100.0, 100.0, -100.0, -100.0, 0.0]
    )
    forward = allocation.model_copy(update={"inverse": False})
    assert forward.convert(np.array([10.0, -10.0])) == pytest.approx([1.0, -0.5])


def test_terms_of_different_streams_hold_their_values_and_a_curve_saturates():
    signals = {
        "yaw": Signal(T, noisy_heading()),
        "X": Signal(T, np.full(len(T), 10.0)),
        "N": Signal(T[::10], np.where(T[::10] < 20.0, 3.0, 30.0)),
    }
    term = Curve(signal="N", points=[(-10.0, -20.0), (10.0, 20.0)])
    map = Map(columns={"psi_rad": "yaw * deg", "thrust_port_N": Allocation(sum=["X * 0.5", term])})
    run = convert_log(Log(Path("log.csv"), signals), map, "map.toml")
    assert run["thrust_port_N"][10] == pytest.approx(11.0)
    assert run["thrust_port_N"][-1] == pytest.approx(25.0)
    assert any("outside -10 to 10" in remark for remark in run.remarks)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"sum": []}, "sum"),
        ({"sum": ["X"], "low": 1.0, "high": 0.0}, "low must be less than high"),
        ({"sum": ["X"], "limit": 3.0}, "limit"),
        ({"sum": [{"signal": "N", "points": [[0.0, 1.0]]}]}, "points"),
    ],
)
def test_a_wrong_allocation_is_one_line_with_its_key(table, said):
    with pytest.raises(BadInput) as caught:
        parse_map({"columns": {"psi_rad": "yaw", "thrust_port_N": table}}, "map.toml")
    assert said in str(caught.value) and "\n" not in str(caught.value)
