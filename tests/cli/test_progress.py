"""Long commands say what they are doing, on stderr: a line a stage where nobody watches, a bar
where somebody does."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from boatsim.cli import app, progress, trust_prompt
from boatsim.diagnosis.pipeline import diagnose
from boatsim.progress import report_part_of

DATA = Path(__file__).parents[1] / "data"
TRIAL = [DATA / "trials" / "T002" / f"run_{i}.csv" for i in (1, 2)]
STAGES = (
    "reading",
    "checking the log",
    "fitting",
    "screening 46 candidate effects",
    "selecting",
    "free runs",
    "writing",
)


def boatsim(*arguments: object):
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def lines(stderr: str) -> list[str]:
    return [
        line.removeprefix("progress: ")
        for line in stderr.splitlines()
        if line.startswith("progress: ")
    ]


@pytest.mark.slow
def test_a_diagnosis_says_its_stages_in_their_order_each_once_and_none_on_stdout(
    tmp_path: Path,
) -> None:
    done = boatsim("diagnose", *TRIAL, "--out", tmp_path / "out")
    told = lines(done.stderr)
    assert done.exit_code == 0 and len(told) == len(set(told)) and "progress" not in done.stdout
    places = [next(i for i, line in enumerate(told) if line.startswith(stage)) for stage in STAGES]
    assert places == sorted(places) and len(told) < 16


def test_a_stage_that_comes_back_is_told_once_and_the_first_with_the_second(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with progress.report_stages() as report:
        report("reading", 0.0)
        assert capsys.readouterr().err == ""
        for stage in ("selecting", "judging", "selecting", "judging", "writing"):
            report(stage, 0.5)
    assert lines(capsys.readouterr().err) == ["reading", "selecting", "judging", "writing"]


@pytest.mark.slow
def test_the_share_of_the_work_only_grows_and_the_library_prints_nothing(
    capsys: pytest.CaptureFixture[str],
) -> None:
    shares: list[float] = []
    diagnose(TRIAL, report=lambda stage, share=0.0, detail="": shares.append(share))
    assert (
        shares[0] == 0.0
        and shares == sorted(shares)
        and 0.8 < shares[-1] < 1.0
        and len(shares) > 40
    )
    assert capsys.readouterr() == ("", "")


def test_what_is_refused_while_it_is_read_is_one_line(tmp_path: Path) -> None:
    bad = tmp_path / "bad.csv"
    bad.write_text("t_s,x_m\n0,0\n0,0\n")
    for command in ("diagnose", "replay", "compare"):
        done = boatsim(command, bad, "--vessel", "trial_boat", "--out", tmp_path / "out")
        assert done.exit_code == 2 and done.stderr.count("\n") == 1, done.stderr


@pytest.mark.parametrize("command", ["replay", "compare"])
def test_free_runs_of_a_recording_say_their_stages(tmp_path: Path, command: str) -> None:
    told = lines(boatsim(command, TRIAL[0], "--out", tmp_path / "out").stderr)
    assert told[0] == "reading the recording" and "fitting the noise" in told


@pytest.mark.slow
def test_a_new_boat_fitted_to_a_log_says_its_stages(tmp_path: Path) -> None:
    rows = [
        line.split(",")[:6] for line in TRIAL[0].read_text().splitlines()
    ]  # without the angles of steering
    (tmp_path / "log.csv").write_text("\n".join(map(",".join, rows)) + "\n")
    drives = [
        "--thruster=-0.6,-0.19",
        "--thruster=-0.6,0.19",
        "--thrust",
        "1",
        "--from-log",
        tmp_path / "log.csv",
    ]
    done = boatsim(
        "new", tmp_path / "own", "--length", "1.2", "--beam", "0.44", "--mass", "4.6", *drives
    )
    assert {"fitting the coefficients", "validating on held-out data"} <= set(lines(done.stderr)), (
        done.stderr
    )


def test_a_log_that_is_imported_says_its_stages(tmp_path: Path) -> None:
    log = DATA / "logs" / "table.csv"
    assert boatsim("import", log, "--propose", tmp_path / "map.toml").exit_code == 0
    done = boatsim("import", log, "--map", tmp_path / "map.toml", "--out", tmp_path / "run.csv")
    told = ["reading the log", "resampling the signals to one time base", "writing the recording"]
    assert done.exit_code == 0 and lines(done.stderr) == told, done.stderr


def test_several_runs_are_counted_and_a_single_one_says_nothing(tmp_path: Path) -> None:
    both = ["joystick_boat/sway_1", "joystick_boat/sway_2"]
    assert lines(boatsim("run", *both, "--out", tmp_path / "out").stderr) == [
        f"{i + 1} of 2: {both[i]}" for i in (0, 1)
    ]
    assert boatsim("run", both[0], "--out", tmp_path / "one").stderr == ""


def test_a_manoeuvre_says_that_it_runs(tmp_path: Path) -> None:
    done = boatsim(
        "manoeuvre", "zigzag", "--vessel", "mariner", "--angle", "10", "--out", tmp_path / "out"
    )
    assert (
        done.exit_code == 0
        and len(lines(done.stderr)) == 1
        and lines(done.stderr)[0].startswith("running ")
    )


@pytest.mark.parametrize(
    ("elapsed", "share", "said"),
    [
        (10.0, 0.5, "about 10 s left"),
        (60.0, 0.1, "about 9 min left"),
        (0.2, 0.5, ""),
        (30.0, 0.0, ""),
        (50.0, 0.999, "nearly done"),
    ],
)
def test_the_time_left_is_what_the_rest_takes_at_the_same_pace(
    elapsed: float, share: float, said: str
) -> None:
    assert progress.time_left(elapsed, share) == said


def test_the_first_of_many_tasks_which_waits_for_the_compiler_does_not_count(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = [0.0]
    monkeypatch.setattr(progress, "monotonic", lambda: now[0])
    with progress.show_task_progress() as report:
        for time, done in ((100.0, 1), (110.0, 2), (130.0, 4)):
            now[0] = time
            report("runs", done / 10, f"{done} of 10")
    assert lines(capsys.readouterr().err) == [
        "1 of 10",
        "2 of 10, about 80 s left",
        "4 of 10, about 60 s left",
    ]


def test_a_long_stage_tells_its_time(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = [0.0]
    monkeypatch.setattr(progress, "monotonic", lambda: now[0])
    with progress.report_stages() as report:
        report("reading", 0.0)
        for time in (1.0, 20.0, 32.0, 50.0, 64.0):
            now[0] = time
            report("selecting", time / 128.0)
    assert lines(capsys.readouterr().err) == [
        "reading",
        "selecting",
        "32 s so far, about 2 min left",
        "64 s so far, about 64 s left",
    ]


def test_the_bar_makes_way_for_a_question(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[str] = []

    class Bars:
        def stop(self) -> None:
            seen.append("stop")

        def start(self) -> None:
            seen.append("start")

    class Answer:
        def readline(self) -> str:
            seen.append("asked")
            return "y\n"

    monkeypatch.setattr(progress, "_active", Bars())
    monkeypatch.setattr(trust_prompt.sys, "stdin", Answer())
    assert trust_prompt._ask_to_trust(Path("mine")) and seen == ["stop", "asked", "start"]


def test_a_part_of_the_work_is_told_as_its_share_of_the_whole() -> None:
    told: list[tuple[str, float, str]] = []
    inner = report_part_of(report_part_of(lambda *news: told.append(news), 0.2, 0.6), 0.5, 1.0)
    inner("a", 0.5, "b")
    inner("a", 7.0)
    assert told == [("a", pytest.approx(0.5), "b"), ("a", pytest.approx(0.6), "")]


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="there is no terminal to pretend")
@pytest.mark.slow
def test_a_terminal_gets_a_bar_with_the_stage_and_the_time_and_it_is_gone_in_the_end(
    tmp_path: Path,
) -> None:
    ours, theirs = os.openpty()
    command = [
        sys.executable,
        "-m",
        "boatsim",
        "diagnose",
        *map(str, TRIAL),
        "--out",
        str(tmp_path / "out"),
    ]
    environ = os.environ | {"TERM": "xterm", "COLUMNS": "120"}
    running = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=theirs, env=environ
    )
    os.close(theirs)
    shown = b""
    while True:
        try:
            piece = os.read(ours, 4096)
        except OSError:  # the other end is closed
            break
        if not piece:
            break
        shown += piece
    out, _ = running.communicate()
    os.close(ours)
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown.decode(errors="replace"))
    assert running.returncode == 0 and b"The model leaves out" in out
    assert (
        "━" in text
        and "screening 46 candidate effects" in text
        and "left" in text
        and "best so far" in text
    )
    assert "progress: " not in text and shown.rstrip().endswith(b"\x1b[2K")
