"""Rivals of the diagnosis name what is plain to see, and any tool's answers are scored or refused
in a line."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from validation import trials
from validation.entry import BadEntry, horizon_of, read_answer, read_answers, replay_errors
from validation.practice import __main__ as practice
from validation.practice import hulls
from validation.practice.boats import BOATS
from validation.practice.make import Trial, make_trial
from validation.practice.plans import PLANS
from validation.rivals.__main__ import RIVALS, answer_trial
from validation.rivals.accelerations import acceleration_weights, smoothed_derivative
from validation.rivals.evidence import Judge
from validation.rivals.linear import bounded_least_squares_step

EASY = Trial(
    "T001_martin_tank_model",
    "martin_tank_model",
    "single",
    False,
    False,
    (hulls.righting_arm_stiffening,),
    PLANS["martin_tank_model"],
    BOATS["martin_tank_model"],
)
NOTHING = {"effects": [], "unknown": {"flag": False}}


@pytest.fixture(scope="module")
def easy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("set")
    make_trial(EASY, 4, folder)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("rival", RIVALS)
def test_a_rival_names_what_is_plain_to_see_and_is_scored(
    rival: str,
    easy: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    answer_trial(rival, easy / EASY.name, tmp_path / EASY.name)
    answer = read_answer(tmp_path / EASY.name / "diagnosis.json")
    assert [e["name"] for e in answer["effects"]] == ["righting_arm_stiffening"]
    assert (tmp_path / EASY.name / "replay.csv").is_file()
    monkeypatch.setattr(sys, "argv", ["trials", str(easy), "--answers", str(tmp_path)])
    trials.main()
    said = capsys.readouterr().out
    assert "visible single effects, exactly named        1/1" in said and "seconds" not in said


def test_an_answer_needs_no_more_than_names_and_the_flag(tmp_path: Path) -> None:
    write(tmp_path, {"effects": [{"name": "wind"}], "unknown": {"flag": False}})
    found = read_answers(tmp_path, ["T001"])["T001"]
    assert (
        found["effects"][0] == {"name": "wind", "tied_with": [], "parameters": {}}
        and found["described"] == []
    )


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ({"unknown": {"flag": False}}, "effects is missing; it is a list"),
        ({"effects": []}, "unknown is missing; it is a table"),
        (
            {"effects": [], "unknown": {"flag": "no"}},
            "unknown.flag = 'no'; allowed is true or false",
        ),
        (NOTHING | {"effects": [{"parameters": {}}]}, "effects[0].name is missing; it is a text"),
        (
            NOTHING | {"effects": [{"name": "wind", "parameters": {"force_N": {"value": 1.0}}}]},
            "effects[0].parameters.force_N.sd = None; allowed is a finite number above 0",
        ),
        ([], "a table is needed, with effects and unknown"),
    ],
)
def test_a_bad_answer_is_refused_in_one_line(tmp_path: Path, answer: object, words: str) -> None:
    write(tmp_path, answer)
    with pytest.raises(BadEntry) as refused:
        read_answers(tmp_path, ["T001"])
    assert (
        words in str(refused.value)
        and "\n" not in str(refused.value)
        and "T001" in str(refused.value)
    )


def test_a_missing_folder_or_trial_is_said_in_one_line(
    easy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder, words in (
        ("nowhere", "there is no such folder"),
        (".", "every trial needs an answer"),
    ):
        monkeypatch.setattr(sys, "argv", ["trials", str(easy), "--answers", str(easy / folder)])
        with pytest.raises(SystemExit) as refused:
            trials.main()
        assert words in str(refused.value) and "\n" not in str(refused.value)


def test_trials_make_the_very_set_that_practice_makes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = list[tuple[Path, int]]()
    monkeypatch.setattr(practice, "make_set", lambda out, seed, *_: made.append((out, seed)))
    monkeypatch.setattr(sys, "argv", ["trials", "--make", str(tmp_path), "--seed", "7"])
    trials.main()
    monkeypatch.setattr(sys, "argv", ["practice", "--out", str(tmp_path), "--seed", "7"])
    practice.main()
    assert made == [(tmp_path, 7), (tmp_path, 7)]


def test_free_runs_count_only_if_they_are_long_enough_and_cover_the_run(tmp_path: Path) -> None:
    t = np.arange(0.0, 20.01, 0.25)
    (tmp_path / "recording.toml").write_text('vessel = "joystick_boat"\n')
    np.savetxt(
        tmp_path / "run_3.csv",
        np.column_stack([t, t, t]),
        "%.7g",
        ",",
        header="t_s,x_m,y_m",
        comments="",
    )
    (tmp_path / "run_1.csv").write_text("")

    def errors(length: float, runs: int) -> float | None:
        rows = [
            (x, i, x + 0.3, x)
            for i in range(runs)
            for x in t
            if i * length <= x <= (i + 1) * length
        ]
        np.savetxt(
            tmp_path / "replay.csv", rows, "%.9g", ",", header="t_s,segment,x_m,y_m", comments=""
        )
        return replay_errors(tmp_path, tmp_path / "replay.csv", horizon_of(tmp_path))

    assert errors(6.0, 3) == pytest.approx(0.3 / np.sqrt(2.0))
    assert errors(6.0, 2) is None and errors(2.0, 9) is None
    assert replay_errors(tmp_path, tmp_path / "none.csv", 6.0) is None


# ---- what rivals are made of


def test_bic_asks_more_of_errors_that_are_alike() -> None:
    rng = np.random.default_rng(1)
    white = rng.standard_normal((400, 1))
    slow = np.repeat(rng.standard_normal((40, 1)), 10, axis=0)
    plain, careful = Judge(True, 30), Judge(False, 30)
    for errors in (white, slow):
        assert plain.gain([1.2 * errors], [errors], 1) == pytest.approx(
            400 * np.log(1.2) - 0.5 * np.log(400)
        )
    assert plain.gain([1.2 * white], [white], 1) - careful.gain([1.2 * white], [white], 1) < 40
    assert careful.gain([1.2 * slow], [slow], 1) < 10


def test_derivatives_of_a_parabola_are_exact_and_the_kernel_sees_steps_as_they_do() -> None:
    h, n = 0.1, 9
    t = h * np.arange(60)
    assert smoothed_derivative(3.0 * t**2, n, 2, h)[n:-n] == pytest.approx(6.0)
    acceleration = np.where(np.arange(60) < 30, 0.0, 2.0)
    position = h * h * np.append(0.0, np.cumsum(np.cumsum(acceleration))[:-1])
    seen = np.convolve(acceleration, acceleration_weights(n), "same")
    assert smoothed_derivative(position, n, 2, h)[n:-n] == pytest.approx(seen[n:-n], abs=1e-9)


def test_a_step_keeps_within_bounds() -> None:
    step = bounded_least_squares_step(
        np.eye(2), np.array([-3.0, 1.0]), [0.0, 0.0], [2.0, 9.0], np.array([1.0, 5.0])
    )
    assert step == pytest.approx([1.0, -1.0], rel=1e-3)


def write(folder: Path, answer: object) -> None:
    (folder / "T001").mkdir()
    (folder / "T001" / "diagnosis.json").write_text(json.dumps(answer))
