"""Measures of any signal, on signals with a closed form."""

from math import exp, log, pi

import numpy as np
import pytest

from boatsim.metrics.activity import Activity
from boatsim.metrics.levels import Levels
from boatsim.metrics.staircase import Staircase
from boatsim.metrics.step_response import StepResponse
from boatsim.metrics.tracking import Tracking
from boatsim.metrics.zigzag_swings import ZigzagSwings
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

T: Array = 0.01 * np.arange(2001.0)


def log_of(**signals: Array) -> Recording:
    return Recording("made", T, signals)


def test_step_response_of_a_first_order_lag() -> None:
    since, lag = 2.0, 1.5
    y = 1.0 + 3.0 * np.where(since < T, 1.0 - np.exp(-np.maximum(T - since, 0.0) / lag), 0.0)
    found = StepResponse(signal="u_mps", target=4.0, since=since).values(log_of(u_mps=y))
    times = {
        "time_50": 0.5,
        "time_63": 1.0 - exp(-1.0),
        "time_90": 0.9,
        "time_95": 0.95,
        "settle": 0.95,
    }
    assert {n: found[n] for n in times} == pytest.approx(
        {n: -lag * log(1.0 - x) for n, x in times.items()}, abs=1e-3
    )
    assert found["rise"] == pytest.approx(lag * log(9.0), abs=1e-3)
    assert found["overshoot"] == 0.0 and found["end_error"] == pytest.approx(
        100.0 * exp(-18.0 / lag)
    )
    assert found["end"] == y[-1] and StepResponse(signal="u_mps").unit("end") == "m/s"


def test_step_response_downwards_that_overshoots() -> None:
    y = -(1.0 - np.exp(-0.7 * T) * (np.cos(2.0 * T) + 0.35 * np.sin(2.0 * T)))
    found = StepResponse(signal="psi_rad", target=-1.0).values(log_of(psi_rad=y))
    assert found["overshoot"] == pytest.approx(100.0 * exp(-0.7 * pi / 2.0), rel=1e-3)
    assert "time_95" in found and found["settle"] > found["time_95"]


def test_a_step_that_is_not_reached_has_no_time() -> None:
    found = StepResponse(signal="u_mps", target=1.0).values(log_of(u_mps=0.6 * T / 20.0))
    assert set(found) == {"time_50", "overshoot", "end_error", "end"}


def test_staircase_of_lags() -> None:
    y = (
        sum(
            5.0 * np.where(b <= T, 1.0 - np.exp(-np.maximum(T - b, 0.0) / 0.5), 0.0)
            for b in (5.0, 12.0)
        )
        + 2.0
    )
    found = Staircase(signal="u_mps", bottom=2.0, height=5.0, since=5.0, every=7.0).values(
        log_of(u_mps=np.array(y))
    )
    assert [found[n] for n in ("time_95_1", "time_95_2")] == pytest.approx(
        [0.5 * log(20.0)] * 2, abs=1e-3
    )
    assert [found[n] for n in ("rise_1", "rise_2")] == pytest.approx([0.5 * log(9.0)] * 2, abs=1e-3)
    assert found["end_error"] < 1e-4 and "time_95_3" not in found


def test_levels_at_the_end_of_each_interval() -> None:
    found = Levels(signal="u_mps", every=5.0).values(log_of(u_mps=T**2))
    assert found == pytest.approx({f"level_{i}": (5.0 * i) ** 2 for i in range(1, 5)})


def test_tracking_of_a_sine_in_degrees() -> None:
    wanted = 0.2 * np.sin(2.0 * pi * T / 10.0)
    made = log_of(psi_rad=wanted + 0.1, reference_psi_rad=wanted, zero=np.zeros(len(T)))
    tracking = Tracking(signal="psi_rad", reference="reference_psi_rad", goal="zero", until=20.0)
    found = tracking.values(made)
    assert (found["rms"], found["max"]) == pytest.approx((np.degrees(0.1), np.degrees(0.1)))
    assert found["rms_goal"] == pytest.approx(
        np.degrees(np.hypot(0.1, 0.2 / np.sqrt(2.0))), rel=1e-3
    )
    assert (tracking.unit("rms"), Tracking(signal="u_mps").unit("rms")) == ("deg", "m/s")


def test_activity_of_a_triangle() -> None:
    triangle = 0.1 * np.abs((T % 2.0) - 1.0)
    found = Activity(signal="jet_rad").values(log_of(jet_rad=triangle))
    assert found == pytest.approx({"peak": np.degrees(0.1), "rate_rms": np.degrees(0.1)})
    assert Activity(signal="jet_rad").unit("rate_rms") == "deg/s"


def test_swings_of_a_square_helm() -> None:
    made = log_of(
        jet_rad=np.where((T // 3.0) % 2.0 == 0.0, 0.2, -0.2),
        psi_rad=np.sin(T),
        r_radps=2.0 * np.cos(T),
        v_mps=-0.5 * np.sin(T),
        u_mps=10.0 + np.cos(T),
    )
    found = ZigzagSwings().values(made)
    assert [found[f"reversal_{i}"] for i in (1, 2, 3, 4)] == pytest.approx(
        [3.0, 6.0, 9.0, 12.0], abs=0.011
    )
    wanted = {
        "period": 6.0,
        "heading": np.degrees(1.0),
        "yaw_rate": np.degrees(2.0),
        "sway": 0.5,
        "speed": 11.0,
    }
    assert {n: found[n] for n in wanted} == pytest.approx(wanted, rel=2e-3) and "roll" not in found
