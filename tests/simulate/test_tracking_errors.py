"""How well goals are followed is judged in every scenario, and a norm that is not reached says
why."""

from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.metrics.arrival import Arrival
from boatsim.metrics.crossing import Crossing
from boatsim.recordings.table import Recording
from boatsim.simulate import scenario, tracking_errors
from boatsim.simulate.camera_metric import CameraMetricSet
from boatsim.simulate.evaluation import all_metrics
from boatsim.simulate.metric import MetricSet
from boatsim.simulate.run import run

TEXT = """
vessel = "joystick_boat"
load = ["light", "narrow"]
duration = 2.0
measure = { use = "crossing", signal = "psi_rad", level = 1.0 }
[controller]
use = "l1_joystick"
[[goal]]
sway_mps = 0.07
[[goal]]
from = 1.0
yaw_radps = 0.1
"""


def log(step: float = 0.1, **signals: float) -> Recording:
    """Ten seconds in which every signal stays as it is."""
    t = np.arange(0.0, 10.0 + 0.5 * step, step)
    return Recording("told", t, {name: np.full(len(t), value) for name, value in signals.items()})


def test_a_constant_error_has_its_size_as_rms_and_largest_and_its_size_by_time_as_integral() -> (
    None
):
    found = tracking_errors.compute_errors(log(v_mps=0.5, goal_sway_mps=0.7))
    assert found == pytest.approx(
        {"sway_error_rms": 0.2, "sway_error_largest": 0.2, "sway_error_integral": 2.0}
    )
    assert list(tracking_errors.error_units(["sway_mps"]).values()) == ["m/s", "m/s", "m"]


@pytest.mark.parametrize(("angle", "rate"), [("yaw_rad", "yaw_radps"), ("roll_rad", "roll_radps")])
def test_an_angle_and_its_rate_that_are_both_followed_have_norms_of_their_own(
    angle: str, rate: str
) -> None:
    column = {
        "yaw_rad": "psi_rad",
        "yaw_radps": "r_radps",
        "roll_rad": "phi_rad",
        "roll_radps": "p_radps",
    }
    reached = {column[angle]: 0.5, column[rate]: 0.1}
    found = tracking_errors.compute_errors(
        log(**reached, **{f"goal_{angle}": 0.6, f"goal_{rate}": 0.3})
    )
    assert found[f"{angle}_error_largest"] == pytest.approx(np.degrees(0.1))
    assert found[f"{rate}_error_largest"] == pytest.approx(np.degrees(0.2))
    units = tracking_errors.error_units([angle, rate])
    assert list(units) == list(found) and (
        units[f"{angle}_error_rms"],
        units[f"{rate}_error_rms"],
    ) == ("deg", "deg/s")
    assert list(tracking_errors.error_units([rate, "surge_mps"]))[0] == rate.replace(
        "radps", "error_rms"
    )


def test_the_step_of_the_log_changes_no_norm() -> None:
    def wave(step: float) -> dict[str, float]:
        told = log(step, psi_rad=0.0, goal_psi_rad=0.0)
        return tracking_errors.compute_errors(
            Recording("wave", told.t, {**told.signals, "psi_rad": np.sin(2 * pi * told.t / 10.0)})
        )

    fine, coarse = wave(0.01), wave(0.05)
    for name in fine:
        assert fine[name] == pytest.approx(coarse[name], rel=1e-3)
    assert fine["psi_error_rms"] == pytest.approx(np.degrees(sqrt(0.5)), rel=1e-6)
    assert tracking_errors.error_units(["psi_rad"])["psi_error_integral"] == "deg s"


def test_a_heading_is_off_by_the_shorter_way_round() -> None:
    assert tracking_errors.compute_errors(log(psi_rad=2 * pi - 0.1, goal_psi_rad=0.1))[
        "psi_error_largest"
    ] == pytest.approx(np.degrees(0.2))


def test_while_no_goal_is_in_force_nothing_is_judged() -> None:
    told = log(u_mps=1.0, goal_u_mps=1.0)
    goal, u = told["goal_u_mps"].copy(), told["u_mps"].copy()
    goal[50:], u[50:] = np.nan, 99.0
    assert (
        tracking_errors.compute_errors(Recording("half", told.t, {"u_mps": u, "goal_u_mps": goal}))[
            "u_error_largest"
        ]
        == 0.0
    )


@pytest.mark.parametrize("key", ["throttle", "jet_rad", "elevator_rad"])
def test_a_goal_that_is_no_signal_of_the_motion_is_not_judged(key: str) -> None:
    assert (
        tracking_errors.error_units([key]) == {}
        and tracking_errors.compute_errors(log(**{f"goal_{key}": 1.0})) == {}
    )


def test_a_run_logs_its_goals_judges_them_and_says_why_a_norm_is_not_reached(
    tmp_path: Path,
) -> None:
    (tmp_path / "two.toml").write_text(TEXT)
    done = run(scenario.load(str(tmp_path / "two.toml")))
    first = done.recording.t < 1.0 - 1e-6
    assert (done.recording["goal_sway_mps"][first] == 0.07).all() and np.isnan(
        done.recording["goal_yaw_radps"][first]
    ).all()
    assert (done.recording["goal_yaw_radps"][~first] == 0.1).all() and np.isnan(
        done.recording["goal_sway_mps"][~first]
    ).all()
    norms = all_metrics(done)
    assert list(norms) == ["time", *tracking_errors.error_units(["sway_mps", "yaw_radps"])]
    assert norms["sway_error_largest"].value == pytest.approx(
        np.abs(0.07 - done.recording["v_mps"][first]).max()
    )
    assert [norms[f"sway_error_{e}"].kind for e in ("rms", "largest", "integral")] == [
        "rms",
        "largest",
        "time integral",
    ]
    largest = done.recording["psi_rad"].max()
    assert norms["time"].value is None
    assert norms["time"].lacking == f"not reached: never reached 1 rad: largest {largest:.4g}"


def test_a_guard_of_a_tracking_norm_is_judged(tmp_path: Path) -> None:
    (tmp_path / "two.toml").write_text(TEXT + "[norms.sway_error_rms]\nguard = [0.0, 1e-9]\n")
    assert all_metrics(run(scenario.load(str(tmp_path / "two.toml"))))["sway_error_rms"].ok is False
    (tmp_path / "two.toml").write_text(TEXT + "[norms.surge_error_rms]\nguard = [0.0, 1e-9]\n")
    with pytest.raises(BadInput, match="surge_error_rms.*sway_error_rms"):
        scenario.load(str(tmp_path / "two.toml"))


def test_why_tells_the_nearest_that_was_reached() -> None:
    assert (
        Crossing(signal="u_mps", level=1.0).explain_missing_value("time", log(u_mps=0.7))
        == "never reached 1 m/s: largest 0.7"
    )
    assert (
        Crossing(signal="u_mps", level=-1.0).explain_missing_value("time", log(u_mps=0.7))
        == "never reached -1 m/s: smallest 0.7"
    )
    far = Arrival(x=5.0, radius=1.0).explain_missing_value("time", log(x_m=2.0, y_m=0.0))
    assert far == "never within 1 m of the point: closest 3"


def test_what_a_norm_is_follows_from_the_end_of_its_name() -> None:
    assert [MetricSet().kind(n) for n in ("x_inf", "rms", "psi_max", "time")] == [
        "largest",
        "rms",
        "largest",
        "",
    ]
    assert (MetricSet().kind("x_l1"), CameraMetricSet().kind("position_l1")) == (
        "time integral",
        "sum over frames",
    )


def test_a_guard_on_a_goal_that_never_comes_is_missed(tmp_path: Path) -> None:
    text = TEXT + "[norms.yaw_error_rms]\nguard = [0.0, 9.0]\n[until]\nstarboard = 1e-4\n"
    (tmp_path / "two.toml").write_text(text)
    norm = all_metrics(run(scenario.load(str(tmp_path / "two.toml"))))["yaw_error_rms"]
    assert (norm.value, norm.ok, norm.unit) == (None, False, "deg/s")
