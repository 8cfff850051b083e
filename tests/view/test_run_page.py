"""The page of a run: what it states is what was logged, and a browser plays it without a network."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import chrome
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boatsim.recordings.table import Recording, read
from boatsim.simulate import scenario
from boatsim.simulate.run_files import run_into_folder
from boatsim.view.content_names import plain_name
from boatsim.view.run_facts import environment_facts
from boatsim.view.run_figures import select_plots
from boatsim.view.run_observers import page_observer
from boatsim.view.run_page import run_command
from boatsim.view.run_sentence import run_sentence
from boatsim.view.thinned_log import BUCKETS, Samples, ThinnedLog

LARGEST = 1_000_000  # [bytes] of the page of a usual run


def written(folder: Path, case: str, **changes: Any) -> str:
    """The page of a run."""
    loaded = scenario.load(case, changes)
    command = run_command(case, None, 3)
    run_into_folder(folder, loaded, observers=[page_observer(loaded, command)])
    return (folder / "report.html").read_text("utf-8")


@pytest.fixture(scope="module")
def berth(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("berth") / "out"
    return folder, written(folder, "joystick_boat/berth", about="A <b>bold</b> test")


def film_of(page: str) -> dict[str, Any]:
    found = re.search(r'<script type="application/json">(.*?)</script>', page, re.DOTALL)
    assert found
    film: dict[str, Any] = json.loads(found[1])
    return film


def limits(page: str, label: str) -> tuple[float, float]:
    """Limits of the vertical axis of a plot."""
    found = re.search(rf'data-y="(\S+) (\S+)" [^>]*data-up="{re.escape(label)}"', page)
    assert found, label
    return float(found[1]), float(found[2])


# The thinned log
# ---------------------------------------------------------------------------------------------------


def log_of(values: Any, step: float = 0.1) -> Recording:
    values = np.asarray(values, float)
    return Recording("log", step * np.arange(len(values)), {"u_mps": values})


def thinned(log: Recording, cuts: list[int]) -> Samples:
    """The log handed over in pieces."""
    made = ThinnedLog()
    for first, end in zip([0, *cuts], [*cuts, len(log)], strict=True):
        signals = {name: values[first:end] for name, values in log.signals.items()}
        made.add_rows(replace(log, t=log.t[first:end], signals=signals))
    found = made.samples()
    assert found is not None
    return found


@settings(max_examples=20)
@given(st.integers(1, 25_000), st.lists(st.integers(0, 25_000), max_size=5), st.integers(0, 99))
def test_a_log_of_any_length_keeps_its_extremes_in_a_bounded_number_of_samples(
    rows: int, cuts: list[int], seed: int
) -> None:
    values = np.random.default_rng(seed).normal(size=rows)
    found = thinned(log_of(values), sorted(min(cut, rows) for cut in cuts))
    assert found.rows == rows and len(found.t) <= 2 * BUCKETS + 1
    assert len(found.t) >= min(rows, BUCKETS)
    assert found.highest["u_mps"].max() == values.max()
    assert found.lowest["u_mps"].min() == values.min()
    assert found.end == pytest.approx(0.1 * (rows - 1)) and found.t[0] == 0.0
    np.testing.assert_allclose(found.first["u_mps"], values[np.round(found.t / 0.1).astype(int)])


def test_a_short_log_is_drawn_as_it_is() -> None:
    values = np.sin(np.arange(500.0))
    t, drawn = thinned(log_of(values), [7, 200]).thinned_curve("u_mps")
    assert len(t) == 500 and np.array_equal(drawn, values)


def test_a_fast_oscillation_keeps_its_amplitude_in_a_long_log() -> None:
    rows = 400_000  # 200 oscillations fall into a bucket
    found = thinned(log_of(np.sin(np.arange(rows) * np.pi / 2.0)), [])
    _, drawn = found.thinned_curve("u_mps")
    assert np.ptp(drawn[:-2].reshape(-1, 2), axis=1).min() == pytest.approx(2.0)


# What the page states
# ---------------------------------------------------------------------------------------------------


def test_the_page_fetches_nothing_and_escapes_what_files_contain(berth: tuple[Path, str]) -> None:
    _, page = berth
    assert not re.search(r'(src|href)="(?!#)', page) and "default-src" in page
    assert "A &lt;b&gt;bold&lt;/b&gt; test" in page and "<b>bold" not in page
    assert len(page.encode()) < LARGEST


def test_the_page_states_vessel_water_seed_and_the_command_that_repeats_the_run(
    berth: tuple[Path, str],
) -> None:
    _, page = berth
    for text in (
        "<code>boatsim run joystick_boat/berth --seed 3</code>",
        "joystick_boat (light and narrow)",
        "basin of 2.4 m × 3 m, 0.1 m deep",
        "Weak reverse (astern factor 0.694)",
        "No wind; no waves; no current",
    ):
        assert text in page, text


def test_the_replay_follows_the_logged_path_and_heading(berth: tuple[Path, str]) -> None:
    folder, page = berth
    log, film = read(folder / "recording.csv"), film_of(page)
    boat = film["boats"][0]
    for drawn, signal in (("x", "y_m"), ("y", "x_m"), ("turned", "psi_rad")):
        logged = np.interp(film["t"], log.t, log[signal])
        np.testing.assert_allclose(boat[drawn], logged, atol=2e-3)
    bow = min(film["outline"], key=lambda corner: corner[1])  # the second number points down
    assert bow[1] < 0.0 and abs(bow[0]) < 1e-3


def test_angles_are_drawn_in_degrees(berth: tuple[Path, str]) -> None:
    folder, page = berth
    heading = np.degrees(read(folder / "recording.csv")["psi_rad"])
    low, high = limits(page, "Heading [°]")
    assert low <= heading.min() and heading.max() <= high < 1.2 * heading.max()
    assert "Angles are in degrees" in page


def test_every_metric_is_in_the_table_with_its_band(berth: tuple[Path, str]) -> None:
    folder, page = berth
    table = page[page.index("<table") : page.index("</table>")]
    metrics = json.loads((folder / "norms.json").read_text())["norms"]
    assert re.findall(r'<th scope="row">(.*?)</th>', table) == list(metrics)
    assert "0 to 0.15\u00a0m" in table and table.count(">yes<") == 3


def test_a_goal_is_drawn_only_while_it_is_in_force(berth: tuple[Path, str]) -> None:
    folder, page = berth
    goal = read(folder / "recording.csv")["goal_sway_mps"]
    parts = int(np.sum(np.diff(np.isfinite(goal).astype(int)) == 1) + np.isfinite(goal[0]))
    assert parts == 2
    assert page.count('data-name="goal of sway"') == parts


def test_a_boat_in_six_degrees_of_freedom_shows_heave_roll_and_pitch(tmp_path: Path) -> None:
    page = written(tmp_path / "out", "otter/turn", duration=2.0)
    for label in ("Roll [°]", "Pitch [°]"):
        limits(page, label)
    assert "Heave, down [" in page and "open water" in page
    low, high = limits(page, "Actuators: n [rad/s]")  # the speed of a shaft is no angle
    assert low <= 60.0 < 80.0 <= high


def test_a_boat_that_only_rolls_is_replayed_over_time(tmp_path: Path) -> None:
    from boatsim.simulate.manoeuvre import manoeuvre_scenario

    loaded = manoeuvre_scenario("roll_decay", "kvlcc2_roll")
    run_into_folder(tmp_path / "out", loaded, observers=[page_observer(loaded)])
    film = film_of((tmp_path / "out" / "report.html").read_text("utf-8"))
    log = read(tmp_path / "out" / "recording.csv")
    assert not film["plan"] and film["unit"] == "°"
    roll = np.degrees(np.interp(film["t"], log.t, log["phi_rad"]))
    np.testing.assert_allclose(film["boats"][0]["y"], roll, atol=0.02)


def test_a_boat_that_lies_still_is_drawn_inside_the_figure(tmp_path: Path) -> None:
    page = written(tmp_path / "out", "otter/turn", duration=1.0, goal=[])
    film = film_of(page)
    low, high = limits(page, "x, forward or north [m]")
    down = [corner[1] for corner in film["outline"]]
    assert low < -max(down) and -min(down) < high
    assert limits(page, "Yaw rate [°/s]") == (-1.0, 1.0)


def test_waypoints_of_the_scenario_are_marked(tmp_path: Path) -> None:
    page = written(tmp_path / "out", "catamaran/heading_90", duration=1.0)
    marks = re.findall(r'class="dots waypoint" d="([^"]*)"', page)
    assert [mark.count("M") for mark in marks] == [1] and "waypoint of the scenario" in page


def test_an_effect_of_the_environment_is_stated_with_its_numbers() -> None:
    facts = dict(environment_facts(scenario.load("eastward_ho/puzzle_rudder_5")))
    stated = facts["Wind, waves and current"]
    assert "irregular sea (significant height 72.8 cm" in stated and "no wind" in stated
    calm = dict(environment_facts(scenario.load("eastward_ho/impulse")))
    assert calm["Wind, waves and current"] == "No wind; no waves; no current"


@pytest.mark.parametrize(
    ("name", "plain"),
    [
        ("l1_joystick", "l1_joystick"),
        ("joystick_boat/sway_1", "joystick_boat/sway_1"),
        ("/home/a/my_course.py", "my_course"),
        ("cases/harbour.toml", "harbour"),
        ("cases/harbour.toml:calm", "calm"),
    ],
)
def test_a_path_is_shown_by_its_name(name: str, plain: str) -> None:
    assert plain_name(name) == plain


def entry(value: float, low: float | None = None, ok: bool | None = None) -> dict[str, Any]:
    guard = None if low is None else [low, None]
    more = dict.fromkeys(("published", "tolerance", "at_reported", "noise_floor", "verdict"))
    return {"value": value, "unit": "deg", "guard": guard, "ok": ok, "lacking": None, **more}


def test_the_sentence_counts_the_metrics_within_their_bands_and_names_those_outside() -> None:
    norms = {"turn_angle": entry(4.0, 5.0, False), "drift": entry(6.0, 5.0, True), "x": entry(1.0)}
    result: Any = {"complete": True, "norms": norms}
    assert run_sentence(result) == (
        "1 of 2 metrics lie within their regression bands; outside: turn angle (4°)."
    )
    assert run_sentence(result | {"complete": False}).startswith("Interrupted before its end; 1 of")


def test_columns_without_any_value_are_not_drawn() -> None:
    nothing = np.full(3, np.nan)
    signals = {"u_mps": np.ones(3), "goal_u_mps": nothing, "phi_rad": nothing}
    samples = thinned(Recording("log", np.arange(3.0), signals), [])
    plots = select_plots(samples, {})
    assert [[curve.column for curve in plot.curves] for plot in plots] == [["u_mps"]]


# In a real browser
# ---------------------------------------------------------------------------------------------------


@pytest.mark.skipif(chrome.PROGRAM is None, reason="there is no Chromium on this machine")
def test_the_replay_is_on_a_phones_first_screen_and_moves_the_boat_and_the_cursors(
    berth: tuple[Path, str],
) -> None:
    folder, _ = berth
    with chrome.chromium() as opened:
        page = opened((folder / "report.html").as_uri(), "")
        page.resize(390, 844, mobile=True)
        box = "document.querySelector('.replay .controls').getBoundingClientRect()"
        assert page.run(f"{box}.bottom") < 844 and page.run("document.body.scrollWidth") <= 390
        top = "document.querySelector('{}').getBoundingClientRect().top"
        replay, title = page.run(top.format(".replay")), page.run(top.format("h1"))
        assert replay < title - 100 and title < 844
        before = page.run("document.querySelector('path.hull').getAttribute('d')")
        page.run(
            "(s => { s.value = 30; s.dispatchEvent(new Event('input')); })"
            "(document.querySelector('.replay input'))"
        )
        assert page.run("document.querySelector('path.hull').getAttribute('d')") != before
        assert page.run("document.querySelector('.replay output').textContent").startswith("30.0")
        left = page.run("parseFloat(document.querySelector('.now').style.left)")
        assert left == pytest.approx(100 * 30 / 75, abs=0.5)
        page.run("document.querySelector('.replay button').click()")
        page.until("Number(document.querySelector('.replay input').value) > 31", 30)
