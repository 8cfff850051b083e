"""Robustness benchmark: neutral disturbances change nothing, margins agree, seeds decide all."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from alike import long

from boatsim.control.base import Controller
from boatsim.errors import BadInput
from boatsim.physics.content import load_class
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate import vessel_margins
from boatsim.sweeps.robustness.benchmark import Robustness, run_benchmark
from boatsim.sweeps.robustness.disturbances import DISTURBANCES
from boatsim.sweeps.robustness.drawn_boats import draw_boats, drive_gains
from boatsim.sweeps.robustness.files import CSV, JSON, write_csv, write_json
from boatsim.sweeps.robustness.page import NAME, write_page
from boatsim.sweeps.robustness.survival import judged_bars, surviving_boats, wilson_interval
from boatsim.sweeps.robustness.tables import limits_table, notes

FEW = 4  # boats of a test that needs no statistics


def boat(*loads: str) -> Vessel:
    return load_vessel("joystick_boat", loads)


def controllers(*names: str) -> dict[str, Controller]:
    return {name: load_class("controller", name)() for name in names}


@pytest.fixture(scope="module")
def found() -> Robustness:
    """Both joystick controllers under two delays and two winds."""
    both = controllers("pid_autopilot", "l1_joystick")
    ladders = {"delay": [0.05, 0.6], "wind": [1.0]}
    return run_benchmark(both, boat(), FEW, 3, ladders=ladders)


@pytest.mark.parametrize("disturbance", DISTURBANCES, ids=lambda one: one.name)
def test_a_disturbance_of_neutral_value_changes_no_number_of_any_boat(disturbance) -> None:
    vessel = disturbance.add_effects(boat())
    boats = draw_boats(vessel, FEW, 0)
    for key, values in disturbance.changes(boats, disturbance.neutral).items():
        owner = key.partition(".")[0]
        if vessel.effect(owner) is not None and key.endswith((".toward", ".arm")):
            continue  # direction and lever of a force of zero
        assert values.tolist() == boats.value(key).tolist()


@pytest.mark.slow
def test_the_neutral_point_of_every_ladder_is_the_run_without_disturbance() -> None:
    one = controllers("pid_autopilot")
    tiny = {d.name: [d.neutral] for d in DISTURBANCES}
    result = run_benchmark(one, boat(), FEW, ladders=tiny)
    plain = run_benchmark(one, boat(), FEW, ladders={"delay": [0.0]}).ladders[0].points[0]
    assert len(result.ladders) == len(DISTURBANCES)
    for ladder in result.ladders:
        assert len(ladder.points) == 1
        assert (ladder.points[0].errors == plain.errors).all()


@pytest.mark.slow
def test_the_same_seed_gives_the_same_numbers_and_another_seed_others(found: Robustness) -> None:
    both = controllers("pid_autopilot", "l1_joystick")
    again = run_benchmark(both, boat(), FEW, 3, ladders={"delay": [0.05]})
    other = run_benchmark(both, boat(), FEW, 4, ladders={"delay": [0.05]})
    first = found.ladder("l1_joystick", "delay").points[1]
    assert (again.ladder("l1_joystick", "delay").points[1].errors == first.errors).all()
    assert (other.ladder("l1_joystick", "delay").points[1].errors != first.errors).any()


def test_a_boat_is_the_same_among_few_and_among_many() -> None:
    few, many = draw_boats(boat(), 3, 1), draw_boats(boat(), 7, 1)
    assert (few.directions == many.directions[:3]).all()
    for key, values in few.coefficients.items():
        assert (values == many.coefficients[key][:3]).all()


def test_boats_without_spread_have_the_numbers_of_the_vessel_file() -> None:
    assert draw_boats(boat(), 3, 1, spread=0.0).coefficients == {}


def test_drawn_coefficients_have_the_median_of_the_file_and_the_stated_spread() -> None:
    boats = draw_boats(boat(), 4000, 0)
    mass = boats.coefficients["body.mass"] / boat().body.mass
    assert np.median(mass) == pytest.approx(1.0, abs=0.01)
    assert mass.std() == pytest.approx(0.1, rel=0.05)
    port, starboard = (boats.coefficients[key] for key in drive_gains(boat()))
    assert np.std(port / starboard) == pytest.approx(0.05 * 2**0.5, rel=0.1)


def test_a_controller_without_feedback_survives_nothing_where_another_one_tracks() -> None:
    both = controllers("pid_autopilot")
    both["none"] = load_class("controller", "pid_autopilot")(
        kp=0.0, ki=0.0, kd=0.0, surge_kp=0.0, surge_ki=0.0, blind_surge=0.0
    )
    result = run_benchmark(both, boat(), FEW, ladders={"delay": [0.1]})
    assert result.ladder("pid_autopilot", "delay").points[0].share == 1.0
    broken = result.ladder("none", "delay")
    assert broken.points[0].share == 0.0 and np.isnan(broken.largest_survived)


def test_a_loop_of_enormous_gain_survives_no_delay() -> None:
    wild = {"wild": load_class("controller", "pid_autopilot")(inertia=50.0, kp=25.0, kd=25.0)}
    result = run_benchmark(wild, boat(), FEW, ladders={"delay": [0.1]})
    assert result.ladder("wild", "delay").points[1].share == 0.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "loads"),
    [
        long("l1_joystick", ("light", "wide")),
        long("l1_joystick", ("heavy", "narrow")),
        long("pid_autopilot", ("light", "wide")),
        ("pid_autopilot", ("heavy", "narrow")),
    ],
)
def test_the_delay_survived_is_close_to_the_delay_margin(
    name: str, loads, monkeypatch: pytest.MonkeyPatch
) -> None:
    # only the analytic margin is needed; tests of the margins compare it with the simulated one
    monkeypatch.setattr(vessel_margins, "simulated_delay_margin", lambda *_: float("nan"))
    vessel = boat(*loads)
    rows = vessel_margins.margins_on_vessel(controllers(name)[name], vessel)
    margin = min(row.delay_s for row in rows)
    ladder = (margin * np.linspace(0.7, 1.1, 5)).tolist()
    result = run_benchmark(
        controllers(name), vessel, FEW, spread=0.0, ladders={"delay": ladder}
    ).ladders[0]
    # an oscillation that noise keeps up near the margin exceeds the bar before it grows
    assert 0.75 * margin <= result.largest_survived <= 1.05 * margin


def test_wilson_intervals_are_those_of_the_literature() -> None:
    # R. G. Newcombe, Statistics in Medicine 17, 1998, table I, method 3
    assert wilson_interval(81 / 263, 263) == pytest.approx((0.2553, 0.3662), abs=1e-4)
    assert wilson_interval(15 / 148, 148) == pytest.approx((0.0624, 0.1605), abs=1e-4)
    assert wilson_interval(0 / 20, 20) == pytest.approx((0.0, 0.1611), abs=1e-4)


def test_a_signal_that_no_controller_tracks_is_not_judged() -> None:
    bars = np.array([1.0, 1.0])
    good, bad = np.array([[0.1, 5.0]] * 3), np.array([[9.0, 6.0]] * 3)
    assert judged_bars([good, bad], bars).tolist() == [1.0, np.inf]
    assert judged_bars([bad], bars).tolist() == [1.0, 1.0]


def test_only_judged_errors_below_their_bar_survive_and_divergence_never_does() -> None:
    errors = np.array([[0.5, 9.0], [1.5, 0.0], [np.inf, 0.0], [np.nan, 0.0]])
    assert surviving_boats(errors, np.array([1.0, np.inf])).tolist() == [True, False, False, False]


def test_ladders_grow_by_the_law_of_froude_in_round_numbers() -> None:
    delay = next(one for one in DISTURBANCES if one.name == "delay")
    noise = next(one for one in DISTURBANCES if one.name == "sensor_noise")
    assert delay.scaled_ladder(100.0) == tuple(10.0 * value for value in delay.scaled_ladder(1.0))
    assert delay.scaled_ladder(1.2) == delay.ladder
    assert noise.scaled_ladder(100.0) == noise.ladder


def test_files_hold_a_row_for_each_value_and_the_page_loads_nothing(
    found: Robustness, tmp_path: Path
) -> None:
    for write in (write_csv, write_json, write_page):
        write(found, tmp_path)
    with (tmp_path / CSV).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == sum(len(ladder.points) for ladder in found.ladders)
    assert {row["boats"] for row in rows} == {str(FEW)}
    content = json.loads((tmp_path / JSON).read_text(encoding="utf-8"))
    assert [limit["largest_survived"] for limit in content["limits"]] == [
        ladder.largest_survived for ladder in found.ladders
    ]
    page = (tmp_path / NAME).read_text(encoding="utf-8")
    assert "http" not in page.replace("http-equiv", "")
    assert "l1_joystick" in page and "Criterion of survival" in page


def test_the_table_names_the_largest_value_and_the_next_one(found: Robustness) -> None:
    rows = {(row[0], row[1]): row for row in limits_table(found).rows}
    assert rows["delay [s]", "l1_joystick"][2::2] == ["0.05", "0.6"]
    assert rows["wind [m/s]", "pid_autopilot"][2] == "1 or more"
    assert "sway [m/s] is not judged" in notes(found)[1]


@pytest.mark.parametrize(
    ("names", "ladders", "message"),
    [
        (["l1_joystick_blind"], {}, "has no compiled law.*pid_autopilot"),
        (["pd_heading"], {}, "does not fit joystick_boat"),
        (["l1_joystick"], {"dely": []}, "did you mean 'delay'"),
        (["l1_joystick"], {"motor_loss": [2.0]}, "allowed 0 to 1"),
        (["l1_joystick"], {"sensor_noise": [0.5]}, "allowed 1 to inf"),
    ],
)
def test_bad_input_gets_one_clear_line(names, ladders, message: str) -> None:
    with pytest.raises(BadInput, match=message) as error:
        run_benchmark(controllers(*names), boat(), FEW, ladders=ladders)
    assert "\n" not in str(error.value)


@pytest.mark.slow
def test_a_disturbance_that_does_not_apply_is_named_with_its_reason() -> None:
    one = controllers("l1_cruise")
    ladders = {"motor_loss": [0.5], "delay": [0.0]}
    result = run_benchmark(one, load_vessel("jet_ski"), FEW, spread=0.0, ladders=ladders)
    assert result.disturbances == ["delay"]
    assert re.search("fewer than two drives", result.unavailable["motor_loss"])
    with pytest.raises(BadInput, match="does not apply to jet_ski: .*fewer than two"):
        run_benchmark(one, load_vessel("jet_ski"), FEW, ladders={"motor_loss": [0.5]})
