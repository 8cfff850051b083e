"""Scenario files with cases and bases: what each stands for, and that a mistake in one is a clear
line."""

from pathlib import Path

import pytest

from boatsim.cli.run_many import plan_runs
from boatsim.errors import BadInput
from boatsim.physics.content import find_content_file, shipped_content_names
from boatsim.simulate import scenario
from boatsim.simulate.cases import case_names, find_scenarios, merge_tables, read_scenario

HEAD = 'vessel = "trial_boat"\nduration = 2.0\n[controller]\nuse = "open_loop"\nperiod = 0.5\n'


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


# The rule
# -------------------------------------------------------------------------------------------------------------


def test_tables_are_merged_key_by_key_and_all_else_takes_the_place() -> None:
    base = {
        "a": 1,
        "start": {"u": 2.0, "commands": {"x": 1.0, "y": 2.0}},
        "goal": [{"n": 1}, {"n": 2}],
    }
    over = {"b": 3, "start": {"u": 5.0, "commands": {"y": 9.0}}, "goal": [{"n": 7}]}
    assert merge_tables(base, over) == {
        "a": 1,
        "b": 3,
        "start": {"u": 5.0, "commands": {"x": 1.0, "y": 9.0}},
        "goal": [{"n": 7}],
    }
    assert base["start"] == {"u": 2.0, "commands": {"x": 1.0, "y": 2.0}}


def test_a_table_that_says_what_to_use_begins_anew() -> None:
    base = {"controller": {"use": "waypoint", "radius": 2.0}}
    assert merge_tables(base, {"controller": {"use": "replay"}}) == {
        "controller": {"use": "replay"}
    }
    assert merge_tables(base, {"controller": {"radius": 3.0}}) == {
        "controller": {"use": "waypoint", "radius": 3.0}
    }


def test_a_case_lies_on_the_rest_of_its_file_or_on_the_base_it_names(tmp_path: Path) -> None:
    text = HEAD + (
        '[[case]]\nname = "one"\nstart.u = 1.0\ncontroller.period = 0.1\n'
        '[[case]]\nname = "two"\nbase = "one"\nduration = 3.0\n'
        '[[case]]\nname = "three"\n'
    )
    file = write(tmp_path / "mine.toml", text)
    one, two, three = (scenario.load(f"{file}:{case}") for case in ("one", "two", "three"))
    assert [s.name for s in (one, two, three)] == ["one", "two", "three"]
    assert [(s.file.duration, s.file.start.u, s.controller.period) for s in (one, two, three)] == [
        (2.0, 1.0, 0.1),
        (3.0, 1.0, 0.1),
        (2.0, 0.0, 0.5),
    ]


def test_a_file_builds_on_a_shipped_scenario_and_on_files_beside_it(tmp_path: Path) -> None:
    shipped = write(tmp_path / "far.toml", 'base = "joystick_boat/sway_1"\ncontroller.pole = 2.0\n')
    assert read_scenario(str(shipped))[0] == merge_tables(
        read_scenario("joystick_boat/sway_1")[0], {"controller": {"pole": 2.0}}
    )
    write(tmp_path / "_common.toml", HEAD)
    write(tmp_path / "some.toml", 'base = "_common.toml"\n[[case]]\nname = "a"\nstart.u = 4.0\n')
    last = write(tmp_path / "last.toml", 'base = "some.toml:a"\nduration = 1.0\n')
    told = scenario.load(str(last))
    assert (told.name, told.file.duration, told.file.start.u) == ("last", 1.0, 4.0)


def test_paths_start_at_the_file_they_stand_in(tmp_path: Path) -> None:
    own = (Path(__file__).parents[2] / "models" / "trial_boat" / "vessel.toml").read_text()
    write(tmp_path / "common" / "boat" / "vessel.toml", own)
    (tmp_path / "common" / "boat" / "hull.xml").write_bytes(
        (Path(__file__).parents[2] / "models" / "trial_boat" / "hull.xml").read_bytes()
    )
    write(tmp_path / "common" / "base.toml", HEAD.replace('"trial_boat"', '"boat/vessel.toml"'))
    mine = write(tmp_path / "mine" / "one.toml", 'base = "../common/base.toml"\n')
    assert scenario.load(str(mine)).vessel.file == tmp_path / "common" / "boat" / "vessel.toml"


# Names
# ----------------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_every_name_of_a_shipped_scenario_is_a_case_or_a_file_of_its_folder() -> None:
    for name in shipped_content_names("scenario"):
        folder, own = name.split("/")
        path = find_content_file("scenario", name)
        assert path.parent.name == folder and own in (case_names(path) or [path.stem])
        assert read_scenario(name)[1].name == name


def test_a_folder_a_pattern_and_a_file_stand_for_their_scenarios(tmp_path: Path) -> None:
    everything = shipped_content_names("scenario")
    assert (
        find_scenarios("jet_ski")
        == find_scenarios("jet_ski/")
        == [n for n in everything if n.startswith("jet_ski/")]
    )
    assert find_scenarios("joystick_boat/sway_?") == [
        f"joystick_boat/sway_{n}" for n in (1, 2, 3, 4)
    ]
    assert find_scenarios("joystick_boat/sway_1") == ["joystick_boat/sway_1"]
    file = write(tmp_path / "mine.toml", HEAD + '[[case]]\nname = "one"\n[[case]]\nname = "two"\n')
    alone = write(tmp_path / "plain.toml", HEAD)
    write(tmp_path / "_common.toml", HEAD)
    assert find_scenarios(str(file)) == [f"{file}:one", f"{file}:two"] and find_scenarios(
        str(alone)
    ) == [str(alone)]
    assert find_scenarios(str(tmp_path)) == [f"{file}:one", f"{file}:two", str(alone)]


def test_cases_run_into_folders_of_their_own_names(tmp_path: Path) -> None:
    file = write(tmp_path / "mine.toml", HEAD + '[[case]]\nname = "one"\n[[case]]\nname = "two"\n')
    assert [t.task.folder for t in plan_runs([str(file)], tmp_path, None)] == [
        tmp_path / "one",
        tmp_path / "two",
    ]
    assert [t.task.name for t in plan_runs(["joystick_boat/yaw_[12]"], tmp_path, None)] == [
        "joystick_boat/yaw_1",
        "joystick_boat/yaw_2",
    ]


# Mistakes
# -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "asked", "line"),
    [
        (
            '[[case]]\nname = "a"\nbase = "b"\n[[case]]\nname = "b"\nbase = "a"',
            ":a",
            "base .*a -> b -> a",
        ),
        ('[[case]]\nname = "a"\nbase = "a"', ":a", "mine.toml: a: base leads back .*: a -> a"),
        (
            '[[case]]\nname = "a"\n[[case]]\nname = "a"',
            ":a",
            r"mine\.toml: case 'a' occurs twice",
        ),
        ("[[case]]\nduration = 1.0", ":a", r"mine\.toml: \[\[case\]\] 1: name = None; allowed are"),
        ('[[case]]\nname = "a/b"', ":a", r"mine\.toml: \[\[case\]\] 1: name = 'a/b'; allowed are"),
        ('[case]\nname = "a"', ":a", r"mine\.toml: case = .*; allowed are \[\[case\]\] tables"),
        (
            '[[case]]\nname = "calm"',
            ":clam",
            r"mine\.toml: case 'clam' does not exist; did you mean 'calm'",
        ),
        (
            '[[case]]\nname = "calm"',
            "",
            r"mine\.toml holds several cases; name one: mine\.toml:calm",
        ),
        (
            '[[case]]\nname = "a"\nbase = "sway_1"',
            ":a",
            "a: base: scenario 'sway_1' .* mean 'joystick_boat/sway_1'",
        ),
        (
            '[[case]]\nname = "a"\nbase = "gone.toml"',
            ":a",
            r"mine\.toml: a: base: gone\.toml: no such file",
        ),
        ('[[case]]\nname = "a"\nbase = 3', ":a", r"mine\.toml: a: base: 3; allowed is the name"),
        (
            '[[case]]\nname = "a"\nduratoin = 3',
            ":a",
            r"mine\.toml: a: key 'duratoin' .*did you mean 'duration'",
        ),
    ],
)
def test_a_mistake_in_a_case_is_one_line(tmp_path: Path, text: str, asked: str, line: str) -> None:
    file = write(tmp_path / "mine.toml", f"{HEAD}{text}\n")
    with pytest.raises(BadInput, match=line) as caught:
        scenario.load(f"{file}{asked}")
    assert "\n" not in str(caught.value)


def test_a_base_that_leads_round_through_files_is_one_line(tmp_path: Path) -> None:
    write(tmp_path / "a.toml", 'base = "b.toml"\n')
    write(tmp_path / "b.toml", 'base = "a.toml"\n')
    with pytest.raises(
        BadInput, match=r"a\.toml: base leads back .*: a\.toml -> b\.toml -> a\.toml"
    ):
        scenario.load(str(tmp_path / "a.toml"))


def test_a_pattern_that_nothing_is_like_is_one_line() -> None:
    with pytest.raises(
        BadInput, match=r"no scenario is like 'joystick_boat/swy_\*' \(they are in catamaran, "
    ):
        plan_runs(["joystick_boat/swy_*"], None, None)
