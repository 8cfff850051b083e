"""A sweep: what its keys change, which draws it makes, and that nothing of it is lost or differs
when it is cut off."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long
from pyarrow import parquet
from scipy import stats

import boatsim
from boatsim.errors import BadInput
from boatsim.physics.content import content_root
from boatsim.simulate.cases import read_scenario
from boatsim.simulate.run import run
from boatsim.simulate.scenario import Scenario, from_table
from boatsim.sweeps.axes import parse_axis
from boatsim.sweeps.designs import sampling_design
from boatsim.sweeps.execute import run_plan
from boatsim.sweeps.indices import bootstrap_intervals, sobol_indices
from boatsim.sweeps.journal import Journal
from boatsim.sweeps.keys import find_target_values, parse_target, set_values
from boatsim.sweeps.plan import make_plan
from boatsim.sweeps.sampled_keys import parse_sampled_key
from boatsim.sweeps.workers.processes import Processes

SHORT = """
about = "Drifts for a moment."
vessel = "joystick_boat"
load = ["light", "wide"]
duration = 0.2
[controller]
use = "l1_joystick"
pole = 2.0
[[goal]]
sway_mps = 0.05
[[goal]]
from = 0.1
yaw_radps = 0.1
[[check]]
signal = "x_m"
norm = "inf"
below = 9.0
"""


@pytest.fixture
def short(tmp_path: Path) -> str:
    """A scenario that runs in a moment; its norm `x_m_inf` is where it starts."""
    path = tmp_path / "short.toml"
    path.write_text(SHORT)
    return str(path)


def changed(scenario: str, key: str, value: bool | int | float | str) -> Scenario:
    said, place = read_scenario(scenario)
    wanted = parse_target(key)
    told, at = find_target_values(said, place, wanted)
    return from_table(set_values(told, place, at, wanted.operation, value), place)


# Keys
# ---------------------------------------------------------------------------------------------------------------


def value(scenario: Scenario, effect: str, name: str) -> float:
    found = scenario.vessel.effect(effect)
    assert found is not None
    return float(getattr(found, name))


def test_an_effect_of_the_library_is_added_with_its_defaults(short: str) -> None:
    assert changed(short, "fan_wind.speed", 0.5).vessel.effect("fan_wind").speed == 0.5  # type: ignore[union-attr]
    assert value(changed(short, "fan_wind.speed", 0.5), "fan_wind", "side") == 0.114


def test_an_effect_of_the_vessel_or_of_the_scenario_is_changed(short: str) -> None:
    assert value(changed(short, "port.y", -0.2), "port", "y") == -0.2
    windy = changed("joystick_boat/yaw_2", "fan_wind.speed", 0.1)
    assert (value(windy, "fan_wind", "speed"), value(windy, "fan_wind", "toward")) == (0.1, 1.5708)


def test_an_idea_stands_for_all_effects_of_it(short: str) -> None:
    scenario = changed(short, "thruster.x", -0.4)
    assert value(scenario, "port", "x") == value(scenario, "starboard", "x") == -0.4


@pytest.mark.parametrize(
    ("key", "number", "found"), [("port.x+", 0.1, -0.4), ("port.x*", 2.0, -1.0)]
)
def test_a_change_is_of_what_is_stated(short: str, key: str, number: float, found: float) -> None:
    assert value(changed(short, key, number), "port", "x") == pytest.approx(found)


def test_several_keys_take_one_number_each_on_what_it_states(short: str) -> None:
    scenario = changed(short, "port.y,starboard.y+", 0.01)  # wide: 0.28 m
    assert value(scenario, "port", "y") == pytest.approx(-0.27)
    assert value(scenario, "starboard", "y") == pytest.approx(0.29)


def test_numbers_of_the_body_and_defaults_can_be_changed_too(short: str) -> None:
    assert changed(short, "body.yaw_inertia*", 2.0).vessel.body.yaw_inertia == pytest.approx(2.1)
    assert changed(short, "start.x+", 0.3).file.start.x == 0.3
    assert changed(short, "fan_wind.speed+", 0.5).vessel.effect("fan_wind").speed == 2.0  # type: ignore[union-attr]
    assert changed(short, "controller.pole+", 0.5).controller.pole == 2.5  # type: ignore[attr-defined]


def test_a_load_takes_the_place_of_those_it_excludes(short: str) -> None:
    assert changed(short, "load", "heavy").file.load == ["wide", "heavy"]
    assert changed(short, "load", "heavy+narrow").file.load == ["heavy", "narrow"]


def test_another_controller_has_its_defaults_and_the_own_one_keeps_its_settings(short: str) -> None:
    assert (
        type(changed(short, "controller.use", "pid_autopilot").controller).__name__
        == "PidAutopilot"
    )
    assert changed(short, "controller.use", "l1_joystick").controller.pole == 2.0  # type: ignore[attr-defined]


def test_a_goal_is_the_only_one_that_says_the_key_or_one_by_its_number(short: str) -> None:
    assert changed(short, "goal.yaw_radps", 0.2).file.goal[1]["yaw_radps"] == 0.2
    assert changed(short, "goal.1.surge_mps", 0.1).file.goal[0]["surge_mps"] == 0.1


def test_a_table_can_be_left_out() -> None:
    assert changed("joystick_boat/sway_1", "tank", "none").file.tank is None


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("fan_wnd.speed", 1, "key 'fan_wnd' does not exist; did you mean 'fan_wind'?"),
        ("fan_wind.sped", 1, "did you mean 'speed'?"),
        ("fan_wind", 1, "add one of its parameters: speed, toward"),
        ("fan_wind.speed", 99, "allowed 0 to 40 m/s"),
        ("load", "hevy", "did you mean 'heavy'?"),
        ("controller.use", "l1_joistick", "did you mean 'l1_joystick'?"),
        ("controller.poel", 1, "did you mean 'pole'?"),
        ("start.xx", 1, "did you mean 'x'?"),
        ("goal.3.sway_mps", 1, "the scenario has 2, counted from 1"),
        ("goal.surge_mps", 1, "name one"),
        ("duratoin", 1, "did you mean 'duration'?"),
        ("load+", "heavy", "no number is specified"),
        ("port.x+", "heavy", "not a number"),
        ("", 1, "separated by dots"),
        ("a..b", 1, "separated by dots"),
    ],
)
def test_a_key_or_value_that_can_not_be_is_one_line(
    short: str, key: str, value: float | str, said: str
) -> None:
    with pytest.raises(BadInput, match=said.replace("?", r"\?")) as told:
        changed(short, key, value)
    assert "\n" not in str(told.value)


# Axes and draws
# -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a.b=0:0.5:3", (0.0, 0.25, 0.5)),
        ("a.b=3:1:3", (3, 2, 1)),
        ("a.b=0.01:1:3:log", (0.01, 0.1, 1.0)),
        ("a.b=light, heavy", ("light", "heavy")),
        ("a.b=0,2.5,true", (0, 2.5, True)),
    ],
)
def test_an_axis_is_a_range_or_a_list(text: str, values: tuple[object, ...]) -> None:
    assert parse_axis(text).values == values


@pytest.mark.parametrize(
    "text",
    [
        "a.b",
        "a.b=",
        "a.b=0:1",
        "a.b=0:1:1",
        "a.b=0:1:2.5",
        "a.b=1:1:3",
        "a.b=0:1:3:log",
        "a.b=0:x:3",
        "a.b=1,1",
        "=1",
    ],
)
def test_an_axis_that_can_not_be_is_refused(text: str) -> None:
    with pytest.raises(BadInput, match="--vary"):
        parse_axis(text)


@pytest.mark.parametrize(
    ("law", "same"),
    [
        ("normal(0.7,0.05)", stats.norm(0.7, 0.05)),
        ("uniform(-1, 3)", stats.uniform(-1, 4)),
        ("lognormal(2,0.3)", stats.lognorm(0.3, scale=2)),
        ("truncated(0,1,-0.5,2)", stats.truncnorm(-0.5, 2)),
        ("triangular(0,1,4)", stats.triang(0.25, 0, 4)),
        ("loguniform(0.1,10)", stats.loguniform(0.1, 10)),
    ],
)
def test_a_draw_has_the_distribution_that_it_states(law: str, same: Any) -> None:
    u = sampling_design("latin", ["a.b"], 500, 1)[:, 0]
    assert (
        stats.kstest(parse_sampled_key(f"a.b={law}").quantiles(u), same.cdf).statistic
        < 1 / 500 + 1e-9
    )


def test_a_choice_is_made_as_often_of_each() -> None:
    found = parse_sampled_key("load=choice(light,heavy)").quantiles(
        sampling_design("latin", ["load"], 100, 0)[:, 0]
    )
    assert found.count("light") == found.count("heavy") == 50


@pytest.mark.parametrize(
    "law",
    [
        "",
        "3",
        "norml(0,1)",
        "normal(0)",
        "normal(0,-1)",
        "uniform(2,1)",
        "normal(0,x)",
        "choice(1)",
        "loguniform(0,1)",
        "truncated(0,1,2,1)",
        "triangular(0,5,4)",
        "lognormal(-1,1)",
    ],
)
def test_a_draw_that_can_not_be_is_refused(law: str) -> None:
    with pytest.raises(BadInput, match="--draw"):
        parse_sampled_key(f"a.b={law}")


def test_a_latin_hypercube_has_one_value_in_each_stratum_of_each_quantity() -> None:
    found = sampling_design("latin", ["a", "b", "c"], 64, 5)
    assert (np.sort(np.floor(found * 64), axis=0) == np.arange(64)[:, None]).all()
    assert abs(stats.spearmanr(found[:, 0], found[:, 1]).statistic) < 0.4


@pytest.mark.parametrize("kind", ["random", "latin"])
def test_a_further_quantity_leaves_the_others_as_they_were(kind: Any) -> None:
    assert (
        sampling_design(kind, ["b"], 20, 3)[:, 0] == sampling_design(kind, ["a", "b"], 20, 3)[:, 1]
    ).all()


# Runs
# ---------------------------------------------------------------------------------------------------------------


def columns(folder: Path) -> dict[str, list[Any]]:
    return parquet.read_table(folder / "sweep.parquet").to_pydict()


@pytest.mark.slow
def test_a_sweep_has_a_row_for_each_draw_at_each_point_and_the_same_draws_at_all(
    short: str, tmp_path: Path
) -> None:
    done = boatsim.sweep(
        short,
        {
            "load": "light,heavy",
            "controller.use": ["pid_autopilot", "l1_joystick"],
            "start.y": "0:1:3",
        },
        {"port.x+": "normal(0,0.01)", "start.x": "uniform(1,2)"},
        runs=4,
        out=tmp_path / "out",
        jobs=1,
    )
    found = columns(tmp_path / "out")
    assert done.complete and len(found["run"]) == 2 * 2 * 3 * 4
    assert found["run"] == sorted(found["run"]) and found["failure"] == [None] * 48
    for name in ("port.x+", "start.x", "seed"):
        by_point = np.array(found[name]).reshape(12, 4)
        assert (by_point == by_point[0]).all() and len(set(by_point[0])) == 4
    assert {(p.first, p.second, p.pairs) for p in done.pairs} == {
        ("pid_autopilot", "l1_joystick", 4)
    }


def test_a_run_of_a_sweep_is_the_run_of_its_scenario(short: str, tmp_path: Path) -> None:
    boatsim.sweep(
        short, {"start.x": [0.25]}, {"fan_wind.speed": "uniform(0,1)"}, 3, out=tmp_path, jobs=1
    )
    found = columns(tmp_path)
    alone = run(changed(short, "fan_wind.speed", found["fan_wind.speed"][2]), found["seed"][2])
    moved = alone.recording["sway_mps" if "sway_mps" in alone.recording.signals else "v_mps"]
    assert np.isfinite(moved).all()
    assert found["x_m_inf"][2] == pytest.approx(
        0.25 + np.abs(alone.recording["x_m"]).max(), abs=1e-3
    )


def test_units_and_the_plan_stand_in_the_table(short: str, tmp_path: Path) -> None:
    boatsim.sweep(short, runs=2, seed=7, out=tmp_path, jobs=1)
    schema = parquet.read_schema(tmp_path / "sweep.parquet")
    assert schema.field("x_m_inf").metadata == {b"unit": b"m"}
    assert json.loads(schema.metadata[b"boatsim"])["seed"] == 7


def test_what_fails_is_told_with_its_reason_and_ends_nothing(short: str, tmp_path: Path) -> None:
    done = boatsim.sweep(
        short, draw={"fan_wind.speed": "uniform(-1,2)"}, runs=12, out=tmp_path, jobs=1
    )
    found = columns(tmp_path)
    for speed, failure, norm in zip(
        found["fan_wind.speed"], found["failure"], found["x_m_inf"], strict=True
    ):
        assert (failure is None) == (norm is not None) == (speed >= 0.0)
        assert speed >= 0.0 or "allowed 0 to 40 m/s" in failure
    assert done.complete and 0 < sum(done.failures.values()) < 12


def test_scenarios_side_by_side_share_their_draws(short: str, tmp_path: Path) -> None:
    other = tmp_path / "other.toml"
    other.write_text(SHORT.replace("wide", "narrow"))
    boatsim.sweep(
        [short, str(other)], draw={"start.x": "uniform(1,2)"}, runs=3, out=tmp_path / "out", jobs=1
    )
    found = columns(tmp_path / "out")
    assert found["scenario"] == [short] * 3 + [str(other)] * 3
    assert found["start.x"][:3] == found["start.x"][3:]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            {"vary": {"start.x": "0:1:2"}, "draw": {"start.x": "uniform(0,1)"}},
            "start.x is given twice",
        ),
        ({"norms": "x_m_ing"}, "did you mean 'x_m_inf'?"),
        ({"design": "sobol", "draw": {"start.x": "uniform(0,1)"}}, "or more, not 1"),
        (
            {
                "design": "sobol",
                "runs": 6,
                "draw": {"start.x": "uniform(0,1)", "start.y": "uniform(0,1)"},
            },
            "powers of two",
        ),
    ],
)
def test_a_sweep_that_can_not_be_is_refused_before_it_runs(
    short: str, tmp_path: Path, options: dict[str, Any], said: str
) -> None:
    with pytest.raises(BadInput, match=said.replace("?", r"\?")):
        boatsim.sweep(short, **options, out=tmp_path / "out", jobs=1)
    assert not (tmp_path / "out").exists()


def test_the_page_shows_every_norm_against_what_varied_and_fetches_nothing(
    short: str, tmp_path: Path
) -> None:
    strange = tmp_path / "<b>&.toml"
    strange.write_text(SHORT)
    boatsim.sweep(
        str(strange),
        {"start.x": "0:1:3", "load": "light,heavy"},
        {"start.u": "uniform(0,1)"},
        5,
        out=tmp_path / "out",
        jobs=1,
        norms="x_m_inf",
    )
    page = (tmp_path / "out" / "report.html").read_text()
    for caption in ("over start.x", "by load", "over start.u, rank correlation"):
        assert page.count(f"<figcaption>x_m_inf [m] {caption}") == 1
    assert page.count('class="box one"') == 2 and page.count('class="band"') == 1
    dots = re.findall(r'class="dots one" d="([^"]*)"', page)
    assert [d.count("M") for d in dots] == [5 * 3 * 2]
    assert "<b>" not in page and "&lt;b&gt;&amp;" in page
    assert not re.search(r"(src|href)=\"(?!#)", page)


def first_screen(folder: Path) -> str:
    """What the page shows before its sections, without mark-up around the words."""
    page = (folder / "report.html").read_text()
    return page[page.index("<header") : page.index("</header>")]


def test_the_page_begins_with_what_varied_and_what_came_out(short: str, tmp_path: Path) -> None:
    boatsim.sweep(short, {"start.x": "0:2:3"}, out=tmp_path / "out", jobs=1, norms="x_m_inf")
    first = first_screen(tmp_path / "out")
    assert "3 runs of short with start x from 0 to 2." in first
    # the metric is the largest |x|, and the boat starts there and hardly moves
    assert re.search(
        r"X m inf is lowest at start x = 0 \(\S+ m\) and highest at 2 \(2\S* m\)", first
    )
    assert first.count("<figure") == 1 and "x_m_inf [m] over start.x" in first


def test_the_first_sentence_names_the_sampled_quantity_that_matters(
    short: str, tmp_path: Path
) -> None:
    sampled = {"start.x": "uniform(1,2)", "body.mass*": "uniform(1,1.01)"}
    boatsim.sweep(short, draw=sampled, runs=12, out=tmp_path / "out", jobs=1, norms="x_m_inf")
    first = first_screen(tmp_path / "out")
    assert "12 random samples of start x and body mass factor" in first
    assert re.search(r"it rises with start x \(rank correlation (1.00|0.9\d)\)", first)


def test_the_first_sentence_compares_controllers(short: str, tmp_path: Path) -> None:
    boatsim.sweep(
        short,
        {"controller.use": "l1_joystick,pid_autopilot"},
        {"start.x": "uniform(1,2)"},
        4,
        out=tmp_path / "out",
        jobs=1,
    )
    first = first_screen(tmp_path / "out")
    assert "8 runs of short with the controller l1_joystick or pid_autopilot" in first
    assert "4 random samples of start x" in first
    assert re.search(r"lower with (l1_joystick|pid_autopilot) than with|does not differ", first)


def test_files_are_shown_by_their_names_unless_two_have_the_same(
    short: str, tmp_path: Path
) -> None:
    source = (content_root() / "controllers/l1_joystick.py").read_text()
    for folder, name in (("a", "mine"), ("b", "mine"), ("b", "other")):
        (tmp_path / folder).mkdir(exist_ok=True)
        (tmp_path / folder / f"{name}.py").write_text(
            source.replace("class L1Joystick", f"class {name.title()}")
        )
    paths = [str(tmp_path / "a" / "mine.py"), str(tmp_path / "b" / "other.py")]
    boatsim.sweep(short, {"controller.use": paths}, out=tmp_path / "1", jobs=1, norms="x_m_inf")
    page = (tmp_path / "1" / "report.html").read_text()
    assert str(tmp_path) not in page and "the controller mine or other" in page
    paths[1] = str(tmp_path / "b" / "mine.py")
    boatsim.sweep(short, {"controller.use": paths}, out=tmp_path / "2", jobs=1, norms="x_m_inf")
    assert f"the controller {paths[0]} or {paths[1]}" in (tmp_path / "2/report.html").read_text()


def test_failed_runs_are_counted_in_the_first_sentence(short: str, tmp_path: Path) -> None:
    wild = tmp_path / "wild.toml"
    wild.write_text(SHORT.replace("[[check]]", "[start]\nu = 1.0\n[[check]]"))
    boatsim.sweep(str(wild), {"start.u": "0.1,1e9"}, out=tmp_path / "out", jobs=1, norms="x_m_inf")
    assert "1 of them failed" in first_screen(tmp_path / "out")


# Cut off
# ------------------------------------------------------------------------------------------------------------


def heeding() -> None:
    """A shell that runs the tests in the background ignores SIGINT, which a child would inherit."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def begun(short: str, out: Path, jobs: int, runs: int) -> "subprocess.Popen[str]":
    command = [
        sys.executable,
        "-m",
        "boatsim",
        "sweep",
        short,
        "--vary",
        "controller.use=pid_autopilot,l1_joystick",
        "--draw",
        "fan_wind.speed=uniform(-0.1,1)",
        "--runs",
        str(runs),
        "--out",
        str(out),
        "--jobs",
        str(jobs),
    ]
    pipe = subprocess.PIPE
    return subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, preexec_fn=heeding)


def once_it_has(out: Path, lines: int, running: "subprocess.Popen[str]") -> None:
    journal = out / "journal.jsonl"
    while not journal.is_file() or journal.read_bytes().count(b"\n") <= lines:
        assert running.poll() is None, running.communicate()
        time.sleep(0.002)


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, long(2)])
def test_killed_and_continued_it_ends_with_the_same_bytes(
    short: str, tmp_path: Path, jobs: int
) -> None:
    whole, cut = tmp_path / "whole", tmp_path / "cut"
    assert begun(short, whole, jobs, 20).wait() == 0
    running = begun(short, cut, jobs, 20)
    once_it_has(cut, 3, running)
    running.kill()
    running.communicate()
    assert not (cut / "sweep.parquet").exists()
    with (cut / "journal.jsonl").open("ab") as journal:
        journal.write(b'{"run": 39, "fail')  # as a process leaves it that is killed while it writes
    assert begun(short, cut, jobs, 20).wait() == 0
    assert (cut / "sweep.parquet").read_bytes() == (whole / "sweep.parquet").read_bytes()


@pytest.mark.slow
def test_an_interruption_keeps_what_there_is_and_the_same_command_goes_on(
    short: str, tmp_path: Path
) -> None:
    running = begun(short, tmp_path / "out", 2, 500)
    once_it_has(tmp_path / "out", 5, running)
    running.send_signal(signal.SIGINT)
    said = running.communicate()[1]
    assert running.returncode == 130 and "the same command continues" in said
    assert 5 <= len(columns(tmp_path / "out")["run"]) < 1000


def test_a_folder_that_somebody_is_at_work_in_is_refused(tmp_path: Path) -> None:
    with Journal(tmp_path, {"of": "one"}) as journal:
        journal.append_result(3, {"failure": None})
        with pytest.raises(BadInput, match="another command uses this folder"):
            Journal(tmp_path, {"of": "one"})
    with Journal(tmp_path, {"of": "one"}) as again:
        assert again.done == {3: {"run": 3, "failure": None}}


@pytest.mark.parametrize(
    "end",
    [b'{"run": 4', b'{"run": 4, "failure": null}', b"\0\0\0\n", b'{"run": 4, "fa\n{"run": 5}\n'],
)
def test_what_is_no_whole_line_of_a_journal_is_written_over(tmp_path: Path, end: bytes) -> None:
    with Journal(tmp_path, {"of": "one"}) as journal:
        journal.append_result(3, {"failure": None})
    with (tmp_path / "journal.jsonl").open("ab") as file:
        file.write(end)
    with Journal(tmp_path, {"of": "one"}) as again:
        assert list(again.done) == [3]
        again.append_result(4, {"failure": "why"})
    lines = (tmp_path / "journal.jsonl").read_bytes().splitlines()
    assert [json.loads(line).get("run") for line in lines] == [None, 3, 4]


def test_a_journal_of_something_else_is_refused_and_stays(tmp_path: Path) -> None:
    (tmp_path / "journal.jsonl").write_text("not ours\n")
    with pytest.raises(BadInput, match="is not a journal of boatsim"):
        Journal(tmp_path, {"of": "one"})
    assert (tmp_path / "journal.jsonl").read_text() == "not ours\n"


def test_a_folder_of_another_sweep_is_refused_in_a_line(short: str, tmp_path: Path) -> None:
    boatsim.sweep(short, runs=2, out=tmp_path / "out", jobs=1)
    with pytest.raises(BadInput, match=r"its runs is 2, not 3; choose another --out$"):
        boatsim.sweep(short, runs=3, out=tmp_path / "out", jobs=1)
    Path(short).write_text(SHORT.replace("0.05", "0.06"))
    with pytest.raises(BadInput, match="its files .*short.toml is"):
        boatsim.sweep(short, runs=2, out=tmp_path / "out", jobs=1)


@pytest.mark.slow
def test_processes_and_this_one_give_the_same_table(short: str, tmp_path: Path) -> None:
    made = make_plan(
        [short],
        [parse_axis("load=light,heavy")],
        [parse_sampled_key("fan_wind.speed=uniform(0,1)")],
        5,
        0,
    )
    for name, jobs in (("one", 1), ("two", 2)):
        run_plan(made, tmp_path / name, jobs)
    assert (tmp_path / "one" / "sweep.parquet").read_bytes() == (
        tmp_path / "two" / "sweep.parquet"
    ).read_bytes()


def deadly(told: tuple[str, int]) -> dict[str, Any]:
    """Work that kills its process: the first time, always, or never."""
    mark, number = told
    if number == 3 or (number == 5 and not Path(mark).exists()):
        Path(mark).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"failure": None, "number": number}


@pytest.mark.slow
def test_a_task_that_kills_its_process_costs_nobody_else(tmp_path: Path) -> None:
    mark = str(tmp_path / "mark")
    tasks = [(n, (mark, n)) for n in (5, 0, 1, 2, 3, 4)]
    found = dict(Processes(2)(deadly, tasks, bool))
    assert found[3] is None
    assert {n: e["number"] for n, e in found.items() if e is not None} == {
        n: n for n in (0, 1, 2, 4, 5)
    }


# Sensitivity
# --------------------------------------------------------------------------------------------------------


def blocks(
    law: Callable[..., np.ndarray], ends: Sequence[tuple[float, float]], runs: int
) -> np.ndarray:
    """A function on Saltelli's design, in the order of its rows."""
    u = sampling_design("sobol", [f"x{k}" for k in range(len(ends))], runs, 0)
    x = [low + (high - low) * u[:, k] for k, (low, high) in enumerate(ends)]
    return law(*x).reshape(len(ends) + 2, runs)


def test_sobol_indices_of_ishigamis_function_are_the_known_ones() -> None:
    a, b = 7.0, 0.1
    found = blocks(
        lambda x, y, z: np.sin(x) + a * np.sin(y) ** 2 + b * z**4 * np.sin(x), [(-pi, pi)] * 3, 4096
    )
    first, total = sobol_indices(found)
    variance = a**2 / 8 + b * pi**4 / 5 + b**2 * pi**8 / 18 + 0.5
    alone = 0.5 * (1 + b * pi**4 / 5) ** 2, a**2 / 8, 0.0
    beside = b**2 * pi**8 * (1 / 18 - 1 / 50)
    assert first == pytest.approx(np.array(alone) / variance, abs=0.02)
    assert total == pytest.approx(
        np.array([alone[0] + beside, alone[1], beside]) / variance, abs=0.02
    )
    for known, ends in zip((first, total), bootstrap_intervals(found, 0), strict=True):
        assert (
            (ends[0] <= known).all()
            and (known <= ends[1]).all()
            and (ends[1] - ends[0] < 0.2).all()
        )


def test_the_design_is_that_of_scipy() -> None:
    found = blocks(lambda x, y: x + 3 * y**2, [(0, 1), (0, 1)], 256)
    given = {"f_A": found[:1], "f_B": found[1:2], "f_AB": found[2:, None, :]}
    theirs = stats.sobol_indices(func=given, n=256)
    first, total = sobol_indices(found)
    assert first == pytest.approx(np.ravel(theirs.first_order), abs=0.02)
    assert total == pytest.approx(np.ravel(theirs.total_order), abs=1e-6)


def test_a_norm_is_laid_to_the_quantity_it_depends_on(short: str, tmp_path: Path) -> None:
    drawn = {"start.x": "uniform(1,2)", "start.y": "uniform(1,2)"}
    done = boatsim.sweep(
        short, draw=drawn, runs=16, design="sobol", out=tmp_path, jobs=1, norms="x_m_inf"
    )
    assert len(columns(tmp_path)["run"]) == 16 * 4
    found = {index.quantity: (index.first, index.total) for index in done.indices}
    assert found["start.x"] == pytest.approx((1.0, 1.0), abs=0.2)
    assert found["start.y"] == pytest.approx((0.0, 0.0), abs=1e-6)
