import json
from collections.abc import Callable
from dataclasses import replace
from math import cos, exp, inf, pi, radians, sin, sqrt
from typing import Any

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.metrics.sway import Sway
from boatsim.metrics.yaw import Yaw
from boatsim.recordings.table import Recording
from boatsim.simulate.camera import Camera
from boatsim.simulate.evaluation import Metric, requested_metrics, signal_norm, to_json
from boatsim.simulate.run import Run
from boatsim.simulate.scenario import Scenario, load
from validation.real.thesis_score import rms_distance

CAMERA = Camera(marks={"led": (0.183, 0.0), "button": (-0.117, 0.0)})
CIRCLE = 0.183  # [m] on which the light is to stay (appendix F)
Pose = tuple[float, float, float]
# section 7 and 11 of the thesis review; T22, T23: inf, two, one, heading and inf, rms, one, moved
T22 = [
    (2.8, 8.1, 42.8, 12.2),
    (2.5, 6.2, 32.7, 10.7),
    (2.9, 7.1, 38.9, 8.7),
    (3.6, 10.0, 54.1, 16.0),
]
T23 = [
    (0.07, 0.05, 3.39, 0.06),
    (0.13, 0.09, 5.91, 0.09),
    (0.07, 0.03, 4.49, 0.02),
    (0.20, None, 7.68, 0.14),
]
SET_B = (
    [(2.0, 6.6, 33.0, 7.9), (2.4, 7.5, 36.0, 14.9), (2.2, 7.1, 38.0, 7.7), (2.4, 7.8, 39.0, 14.7)],
    [
        (0.11, 0.07, 6.4, 0.06),
        (0.13, 0.10, 8.9, 0.13),
        (0.14, 0.10, 10.4, 0.06),
        (0.18, 0.12, 12.0, 0.06),
    ],
    [32.0, 32.0, 35.0, 35.0],
)
IDEAL_REVERSE = (
    [
        (2.9, 10.5, 52.0, 16.8),
        (3.1, 12.6, 66.0, 25.8),
        (2.8, 11.0, 58.0, 17.1),
        (3.1, 13.0, 72.0, 27.1),
    ],
    [
        (0.93, 0.62, 48.0, 0.17),
        (0.89, 0.59, 46.0, 0.12),
        (0.85, 0.57, 45.0, 0.19),
        (0.83, 0.54, 43.0, 0.11),
    ],
    [29.0, 29.0, 30.0, 31.0],
)


def scenario(measure: str, **changes: Any) -> Scenario:
    return load(f"joystick_boat/{measure}_1", changes)


def filmed(
    measure: str, pose: Callable[[float], Pose], until: float, marks: float = 0.0, **changes: Any
) -> Run:
    """A run that moves as told, filmed at 6 Hz with marking noise of `marks` [m] (none: nobody's
    hand shakes)."""
    told = scenario(measure, **changes)
    t = np.linspace(0.0, until, round(until / 0.02) + 1)
    truth = Recording(
        "told",
        t,
        dict(zip(("x_m", "y_m", "psi_rad"), np.array([pose(a) for a in t]).T, strict=True)),
    )
    noise = np.random.default_rng(5)
    camera = replace(told.camera, mark_sd=marks)
    frames = [
        camera.take_frame(k / 6, pose(k / 6), noise.standard_normal(4))
        for k in range(int(6 * until) + 1)
    ]
    names = [f"camera_{mark}_{axis}_m" for mark in camera.marks for axis in "xy"]
    columns = dict(zip(names, np.array([f.marks for f in frames]).T, strict=True))
    film = Recording(
        "camera",
        np.array([f.t for f in frames]),
        columns | {"psi_rad": np.array([f.psi for f in frames])},
    )
    return Run(told, 0, truth, film, True)


def swaying(
    rate: float, speed: float = 0.07, surge: float = 0.0, bow: float = 0.0
) -> Callable[[float], Pose]:
    """To starboard of the start heading `bow` at `speed` [m/s] while turning at `rate` [deg/s]."""

    def pose(t: float) -> Pose:
        x, y = surge * t, speed * t
        return cos(bow) * x - sin(bow) * y, sin(bow) * x + cos(bow) * y, bow + radians(rate) * t

    return pose


def turning(period: float, ahead: float, sense: float = 1.0) -> Callable[[float], Pose]:
    """At a constant rate about a point `ahead` [m] of the CG, at rest on the x axis."""

    def pose(t: float) -> Pose:
        psi = sense * 2 * pi * t / period
        return ahead * (1 - cos(psi)), -ahead * sin(psi), psi

    return pose


def values(run: Run) -> dict[str, float]:
    return {
        name: norm.value for name, norm in requested_metrics(run).items() if norm.value is not None
    }


# Sway
# -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", [0.5, -2.0])
def test_steady_turn_during_a_sway_has_known_norms(rate: float) -> None:
    """0.9 m at 0.07 m/s end at the 39th frame of 1/3 s; 39 rates leave 30 averages, each the turn itself."""
    found = values(filmed("sway", swaying(rate), 16.0))
    assert found["time_to_end"] == pytest.approx(13.0)
    assert (found["yaw_rate_inf"], found["yaw_rate_rms"]) == pytest.approx((abs(rate), abs(rate)))
    assert found["yaw_rate_l2"] == pytest.approx(abs(rate) * sqrt(30))
    assert found["yaw_rate_l1"] == pytest.approx(abs(rate) * 30)
    assert found["heading_at_end"] == pytest.approx(rate * 13.0)


def test_twice_as_many_frames_make_the_sums_larger_and_the_largest_the_same() -> None:
    """6 Hz: 0.9 m end at frame 78, 78 rates leave 69 averages."""
    found = requested_metrics(filmed("sway", swaying(1.5), 16.0))
    assert found["yaw_rate_inf"].at_reported == pytest.approx(1.5)
    assert found["yaw_rate_l2"].at_reported == pytest.approx(1.5 * sqrt(69))
    assert found["yaw_rate_l1"].at_reported == pytest.approx(1.5 * 69)


def test_sway_is_measured_in_start_axes() -> None:
    ahead, turned = (
        values(
            filmed("sway", swaying(1.0, surge=0.01, bow=bow), 16.0, start={"psi": bow}, tank=None)
        )
        for bow in (0.0, 2.5)
    )
    assert turned == pytest.approx(ahead)
    assert ahead["surge_offset"] == pytest.approx(0.13)


def test_a_fast_sway_is_still_thirteen_frames_long() -> None:
    found = values(filmed("sway", swaying(1.0, speed=0.5), 10.0))
    assert found["time_to_end"] == pytest.approx(13 / 3)
    assert found["yaw_rate_l1"] == pytest.approx(4.0)


def test_moving_average_halves_a_jump_of_five_frames() -> None:
    """A turn of 6 deg in five intervals of 1/3 s at 3.6 deg/s: ten rates never hold more than those
    five."""
    psi = np.radians(np.concatenate([np.zeros(20), np.linspace(0.0, 6.0, 6), np.full(20, 6.0)]))
    assert float(Sway().yaw_rate_metrics(psi, 1 / 3)["yaw_rate_inf"]) == pytest.approx(3.6 / 2)


def test_what_was_never_reached_has_no_value_and_fails_its_bar() -> None:
    found = requested_metrics(filmed("sway", swaying(0.0, speed=0.03), 16.0))
    assert all(
        norm.value is norm.at_reported is norm.noise_floor is None for norm in found.values()
    )
    assert found["heading_at_end"].ok is False
    assert found["yaw_rate_rms"].ok is None


# Yaw
# --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_light_on_the_ideal_circle_has_no_error(sense: float) -> None:
    """The light, 0.265 m ahead of the CG, is 0.183 m from the point turned about."""
    found = values(filmed("yaw", turning(45.0, 0.265 - CIRCLE, sense), 50.0))
    assert found["turn_time"] == pytest.approx(45.0)
    for name in ("position_inf", "position_rms", "position_l1", "moved"):
        assert found[name] == pytest.approx(0.0, abs=1e-9)
    assert found["excursion"] == pytest.approx(2 * (0.265 - CIRCLE), rel=1e-4)


def test_light_on_a_wider_circle_is_off_by_the_known_chord() -> None:
    """Radius 0.183 + d, touching the ideal circle at the start: the error is d |e^{i a} - 1| = 2 d sin(a/2)."""
    d = 0.02
    found = values(filmed("yaw", turning(45.0, 0.265 - CIRCLE - d), 50.0))
    assert found["position_inf"] == pytest.approx(2 * d, rel=1e-3)
    assert found["position_rms"] == pytest.approx(d * sqrt(2), rel=0.01)
    assert found["position_l1"] == pytest.approx(136 * 4 * d / pi, rel=0.01)


def test_light_that_drifts_along_its_circle_has_moved() -> None:
    circle = turning(40.0, 0.265 - CIRCLE)
    drifting = filmed(
        "yaw", lambda t: (circle(t)[0] + 0.003 * t, circle(t)[1] - 0.004 * t, circle(t)[2]), 45.0
    )
    found = values(drifting)
    assert found["moved"] == pytest.approx(0.005 * found["turn_time"])
    assert found["position_inf"] == pytest.approx(found["moved"])


def test_less_than_a_turn_has_no_value() -> None:
    assert not values(filmed("yaw", turning(45.0, 0.1), 44.0))


# Camera noise
# -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("rate", "published"),
    [
        (6.0, {"yaw_rate_inf": 1.2, "yaw_rate_l2": 4.2, "yaw_rate_l1": 30.0}),
        (3.0, {"yaw_rate_inf": 0.55, "yaw_rate_l2": 1.4, "yaw_rate_l1": 6.6}),
    ],
)
def test_noise_floor_of_a_sway_is_the_known_one(rate: float, published: dict[str, float]) -> None:
    """Item 4 of the review: zero yaw motion, marks of 2 mm on 0.3 m, for a run of about 14 s."""
    floor = Sway(scored=rate).noise_floor(round(14 * rate) + 1, CAMERA)
    for name, value in published.items():
        assert floor[name] == pytest.approx(value, rel=0.1)


def test_noise_floor_of_the_distance_moved_is_that_of_two_marks() -> None:
    """Two points with independent errors of sd s a coordinate are s sqrt(pi) apart in the mean."""
    assert Yaw(mark="led", radius=CIRCLE).noise_floor(136, CAMERA)["moved"] == pytest.approx(
        0.002 * sqrt(pi), rel=0.1
    )


@pytest.mark.parametrize(
    ("measure", "pose"),
    [("sway", swaying(0.0)), ("yaw", turning(45.0, 0.265 - CIRCLE))],
    ids=["sway", "yaw"],
)
def test_perfect_motion_measured_with_noise_lies_near_its_floor(
    measure: str, pose: Callable[[float], Pose]
) -> None:
    found = requested_metrics(filmed(measure, pose, 50.0, marks=0.002))
    floors = {name: norm for name, norm in found.items() if norm.noise_floor is not None}
    assert len(floors) >= 4
    for name in floors.keys() - {
        "heading_at_end",
        "moved",
    }:  # single numbers scatter as much as they are large
        assert floors[name].value == pytest.approx(floors[name].noise_floor, rel=0.5)


def test_what_is_taken_from_the_truth_has_no_noise_floor() -> None:
    for measure, pose in (("sway", swaying(0.0)), ("yaw", turning(45.0, 0.1))):
        found = requested_metrics(filmed(measure, pose, 50.0))
        for name in {"surge_offset", "time_to_end", "turn_time", "excursion"} & found.keys():
            assert found[name].value is not None and found[name].noise_floor is None


# Bars
# -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("rate", "ok"), [(0.1, False), (0.5, True), (-0.5, False), (0.9, False)])
def test_guards_hold_the_value_with_its_sign(rate: float, ok: bool) -> None:
    guard = {"heading_at_end": {"published": 12.2, "guard": [5.0, 8.0]}}
    judged = requested_metrics(filmed("sway", swaying(rate), 16.0, norms=guard))["heading_at_end"]
    assert (judged.ok, judged.published, judged.band) == (ok, 12.2, (5.0, 8.0))


def test_bands_of_an_angle_may_be_given_in_radians() -> None:
    band = {"published": radians(12.2), "guard": [radians(5.0), radians(8.0)], "unit": "rad"}
    norms = {"heading_at_end": band}
    judged = requested_metrics(filmed("sway", swaying(0.5), 16.0, norms=norms))["heading_at_end"]
    assert judged.unit == "deg" and judged.ok
    assert judged.published == pytest.approx(12.2) and judged.band == pytest.approx((5.0, 8.0))


@pytest.mark.parametrize(
    ("value", "published", "tolerance", "verdict"),
    [
        (0.31, 0.3, 0.02, "reproduced"),
        (-0.3, 0.3, 0.02, "not reproduced"),
        (0.3, -0.3, 0.02, "not reproduced"),
        (-0.31, -0.3, 0.02, "reproduced"),
        (0.33, 0.3, 0.02, "not reproduced"),
        (0.3, 0.3, None, "no tolerance stated"),
        (None, 0.3, 0.02, "not reproduced"),
        (0.3, None, None, None),
    ],
)
def test_what_is_published_is_judged_by_its_own_tolerance_and_sign(
    value: float | None, published: float | None, tolerance: float | None, verdict: str | None
) -> None:
    assert Metric(value, "m", published, tolerance, (-9.0, 9.0), True).verdict == verdict


def test_a_guard_that_is_open_is_null_in_the_file() -> None:
    assert Metric(2.0, "m", band=(1.0, inf), ok=True).to_json()["guard"] == [1.0, None]


def test_guards_of_a_mean_are_widened_by_the_noise_floor_for_one_run() -> None:
    guards = {"heading_at_end": {"guard": [5.0, 8.0]}, "time_to_end": {"guard": [0.0, 12.5]}}
    found = requested_metrics(
        filmed("sway", swaying(0.35), 16.0, norms=guards, noise_widens_guards=True)
    )
    heading, time = found["heading_at_end"], found["time_to_end"]
    assert (
        heading.value == pytest.approx(4.55)
        and heading.noise_floor is not None
        and heading.noise_floor > 0.4
    )
    assert heading.band == (5.0 - heading.noise_floor, 8.0 + heading.noise_floor) and heading.ok
    assert time.band == (0.0, 12.5) and time.ok is False


def test_a_norm_that_is_not_measured_can_not_be_judged() -> None:
    with pytest.raises(
        BadInput, match=r"sway_1: \[norms\] key 'yaw_rate_ifn' .* did you mean 'yaw_rate_inf'"
    ):
        scenario("sway", norms={"yaw_rate_ifn": {"guard": [0.0, 1.0]}})


def test_a_camera_that_misses_the_frames_of_a_norm_is_refused() -> None:
    with pytest.raises(BadInput, match=r"\[camera\] rate = 10 Hz; allowed .* multiple of 6 Hz"):
        scenario("yaw", camera={"rate": 10.0})


# Berth and checks
# -------------------------------------------------------------------------------------------------


def berthed(x: float, y: float, psi: float, contacts: list[float]) -> Run:
    told = load("joystick_boat/berth")
    n = len(contacts)
    signals = {
        "x_m": np.linspace(0.0, x, n),
        "y_m": np.linspace(0.0, y, n),
        "psi_rad": np.linspace(0.0, psi, n),
    }
    log = Recording("told", np.arange(n) / 50, {**signals, "contacts": np.array(contacts)})
    return Run(told, 0, log, log, True)


@pytest.mark.parametrize("turn", [pi, -pi, 3 * pi])
def test_boat_back_in_its_berth_the_other_way_round(turn: float) -> None:
    found = requested_metrics(berthed(0.03, -0.04, turn + radians(2.0), [0.0] * 30))
    assert {name: norm.value for name, norm in found.items()} == pytest.approx(
        {"return_distance": 0.05, "return_heading": 2.0, "wall_contacts": 0.0}
    )
    assert all(norm.ok for norm in found.values())


def test_touching_a_wall_fails_the_berth() -> None:
    found = requested_metrics(berthed(0.0, 0.0, pi, [0.0, 1.0, 2.0, 0.0]))
    assert found["wall_contacts"].value == 2.0 and found["wall_contacts"].ok is False


def test_check_norms_do_not_depend_on_the_step() -> None:
    """A signal of 2 for 3 s and 0 for 1 s: integrals 6 and 12; gaps in a sensor's column are left
    out."""
    for step in (0.01, 0.002):
        t = np.arange(0.0, 4.0, step)
        x = np.where(t < 3.0, -2.0, 0.0)
        found = {kind: signal_norm(t, x, kind) for kind in ("inf", "rms", "l2", "l1")}
        assert found == pytest.approx(
            {"inf": 2.0, "rms": sqrt(3.0), "l2": sqrt(12.0), "l1": 6.0}, rel=0.01
        )
        x[::3] = np.nan
        assert signal_norm(t, x, "l1") == pytest.approx(6.0, rel=0.01)


def test_checks_stand_among_the_norms() -> None:
    check = [
        {"signal": "psi_rad", "norm": "inf", "below": 0.2},
        {"signal": "psi_rad", "norm": "l1", "below": 1.0},
    ]
    found = requested_metrics(filmed("sway", swaying(1.0), 16.0, check=check))
    assert found["psi_rad_inf"] == Metric(
        pytest.approx(radians(16.0)), "rad", band=(0.0, 0.2), ok=False, kind="largest"
    )
    assert found["psi_rad_l1"].unit == "rad s" and found["psi_rad_l1"].value == pytest.approx(
        radians(128.0)
    )
    with pytest.raises(BadInput, match="'psi_red' does not exist; did you mean 'psi_rad'"):
        requested_metrics(
            filmed(
                "sway",
                swaying(1.0),
                16.0,
                check=[{"signal": "psi_red", "norm": "inf", "below": 0.2}],
            )
        )


# norms.json
# -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("measure", "pose"), [("sway", swaying(0.0, speed=0.03)), ("yaw", turning(45.0, 0.1))]
)
def test_json_has_the_fields_and_names_that_were_agreed(
    measure: str, pose: Callable[[float], Pose]
) -> None:
    run = filmed(measure, pose, 50.0)
    content = json.loads(json.dumps(to_json(run, requested_metrics(run)), allow_nan=False))
    assert {k: v for k, v in content.items() if k != "norms"} == {
        "scenario": f"joystick_boat/{measure}_1",
        "controller": "l1_joystick",
        "seed": 0,
        "complete": True,
        "steps": 0,
        "saturated_steps": {},
    }
    assert tuple(content["norms"]) == tuple(type(run.scenario.measure).units)
    for norm in content["norms"].values():
        assert set(norm) == {
            "value",
            "unit",
            "published",
            "tolerance",
            "verdict",
            "guard",
            "ok",
            "at_reported",
            "noise_floor",
            "lacking",
            "kind",
        }
        assert norm["guard"] is None or len(norm["guard"]) == 2


# J
# ----------------------------------------------------------------------------------------------------------------


def named(names: tuple[str, ...], row: tuple[float | None, ...]) -> dict[str, float]:
    return {name: value for name, value in zip(names, row, strict=True) if value is not None}


SWAY = ("yaw_rate_inf", "yaw_rate_l2", "yaw_rate_l1", "heading_at_end")
YAW = ("position_inf", "position_rms", "position_l1", "moved", "turn_time")


@pytest.mark.parametrize(
    ("column", "sway", "yaw", "both"),
    [(SET_B, 0.26, 0.51, 0.41), (IDEAL_REVERSE, 0.62, 1.77, 1.33)],
    ids=["set B", "ideal reverse"],
)
def test_score_of_the_published_columns_is_the_published_score(
    column: Any, sway: float, yaw: float, both: float
) -> None:
    """Section 10 of the review: J by changing the reverse efficiency alone."""
    swings, turns, times = column
    of_sway = [(named(SWAY, a), named(SWAY, b)) for a, b in zip(swings, T22, strict=True)]
    of_yaw = [
        (named(YAW, (*a, t)), named(YAW, (*b, 44.0)))
        for a, t, b in zip(turns, times, T23, strict=True)
    ]
    assert (
        rms_distance(of_sway),
        rms_distance(of_yaw),
        rms_distance([*of_sway, *of_yaw]),
    ) == pytest.approx((sway, yaw, both), abs=0.01)


def test_one_wild_test_counts_three_at_most() -> None:
    wild = [({"moved": 9.0, "position_inf": 1e-9}, {"moved": 0.1, "position_inf": 0.1})]
    assert rms_distance(wild) == pytest.approx(3.0)
    assert rms_distance(
        [*wild, ({"position_inf": exp(1.0)}, {"position_inf": 1.0})]
    ) == pytest.approx(sqrt(5.0))


def test_every_norm_has_a_unit() -> None:
    for run in (
        filmed("sway", swaying(1.0), 16.0),
        filmed("yaw", turning(40.0, 0.1), 45.0),
        berthed(0, 0, pi, [0.0]),
    ):
        for name, norm in requested_metrics(run).items():
            expected = (
                ""
                if name == "wall_contacts"
                else "s"
                if "time" in name
                else "deg/s"
                if "rate" in name
                else None
            )
            assert norm.unit == (
                expected if expected is not None else "deg" if "heading" in name else "m"
            )


@pytest.mark.parametrize("kind", ["inf", "rms", "l2", "l1"])
def test_a_norm_of_pieces_is_that_of_the_whole(kind, monkeypatch):
    t = np.arange(1000.0)
    x = np.where(t % 7 == 0, np.nan, np.sin(t))
    whole = signal_norm(t, x, kind)
    monkeypatch.setattr("boatsim.simulate.evaluation.PIECE", 300)
    assert signal_norm(t, x, kind) == pytest.approx(whole, rel=1e-14)
