"""The command line: what a run leaves, its exit codes, nothing left half done, one line for each
mistake."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from boatsim import __version__
from boatsim.cli import app
from boatsim.cli.run_many import plan_runs
from boatsim.physics import content
from boatsim.recordings import table as recording
from boatsim.sweeps.diagnoses import DiagnosisOptions

FIELDS = {
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
INTERRUPTED = "boatsim: interrupted; what was logged is kept\n"
FILES = {"recording.csv", "camera.csv", "recording.toml", "norms.json", "run.rrd", "report.html"}
PLAIN = """
about = "Two seconds to starboard."
vessel = "joystick_boat"
load = ["light", "narrow"]
duration = 2.0
[controller]
use = "l1_joystick"
[[goal]]
sway_mps = 0.07
[[effect]]
use = "weak_reverse"
astern_factor = 0.694
"""
IMPOSSIBLE = '[[check]]\nsignal = "v_mps"\nnorm = "inf"\nbelow = 1e-9\n'
QUITTER = """
from dataclasses import dataclass
from boatsim.control.base import Controller

@dataclass
class Quitter(Controller):
    def step(self, sense, goal):
        if sense.t > 1.0:
            raise KeyboardInterrupt
        return {"steer_port_rad": 0.1}
"""


def boatsim(*arguments: object) -> Any:
    """The command run in this process: exit_code, stdout, stderr."""
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def write(path: Path, text: str = PLAIN, change: tuple[str, str] = ("", "")) -> Path:
    assert change[0] in text
    path.write_text(text.replace(*change) if change[0] else text, encoding="utf-8")
    return path


def norms_of(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "norms.json").read_text())
    return found


@pytest.fixture(scope="module")
def sway(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, Any]]:
    out = tmp_path_factory.mktemp("runs") / "a" / "sway"
    yield out, boatsim("run", "joystick_boat/sway_1", "--out", out)


@pytest.mark.slow
def test_a_run_leaves_its_files_and_nothing_else(sway: tuple[Path, Any]) -> None:
    out, result = sway
    assert result.exit_code == 0 and not result.stderr
    assert {f.name for f in out.iterdir()} == FILES
    assert list(out.parent.iterdir()) == [out]


def test_norms_json_has_what_the_table_prints(sway: tuple[Path, Any]) -> None:
    out, result = sway
    found = norms_of(out)
    head = {
        "scenario": "joystick_boat/sway_1",
        "controller": "l1_joystick",
        "seed": 0,
        "complete": True,
    }
    head |= {"steps": len(recording.read(out / "recording.csv")) - 1, "saturated_steps": {}}
    assert {k: v for k, v in found.items() if k != "norms"} == head
    for name, norm in found["norms"].items():
        assert set(norm) == FIELDS
        line = next(line for line in result.stdout.splitlines() if name in line)
        assert f"{norm['value']:.4g} {norm['unit']}" in line
        assert (" yes" in line) == (norm["ok"] is True)


def test_norms_json_agrees_with_recording_csv(sway: tuple[Path, Any]) -> None:
    out, _ = sway
    found, log = norms_of(out)["norms"], recording.read(out / "recording.csv")
    t = found["time_to_end"]["value"]
    starboard = np.interp(
        [t - 1.0 / 3.0, t], log.t, log["y_m"]
    )  # at the frame before, and at the frame it was seen
    assert starboard[0] < 0.9 <= starboard[1]
    assert found["surge_offset"]["value"] == pytest.approx(
        np.interp(t, log.t, log["x_m"]), abs=1e-9
    )


def test_scenarios_of_one_name_do_not_share_a_folder() -> None:
    """Neither in one command nor in two."""
    both = ["kynoc/half_speed", "eastward_ho/half_speed"]
    alone = [plan_runs([name], None, None)[0].task.folder for name in both]
    assert (
        alone
        == [run.task.folder for run in plan_runs(both, None, None)]
        == [Path("out") / name for name in both]
    )
    assert [t.task.folder for t in plan_runs(both, Path("dir"), None)] == [
        Path("dir") / name for name in both
    ]
    assert plan_runs(both[:1], Path("dir"), None)[0].task.folder == Path("dir")


def test_camera_csv_is_a_recording_that_knows_its_boat(tmp_path: Path) -> None:
    text = PLAIN.replace("[controller]", "[set.pwm_thrust]\nat_span = 0.314\n[controller]")
    file = write(tmp_path / "s.toml", text.replace("2.0", "8.0"))
    assert boatsim("run", file, "--out", tmp_path / "out").exit_code == 0
    seen = recording.read(tmp_path / "out" / "camera.csv")
    assert (seen.notes.vessel, seen.notes.load) == ("joystick_boat", ("light", "narrow"))
    assert seen.notes.settings == {"pwm_thrust": {"at_span": 0.314}}
    assert set(seen.notes.noise) == {"position_sd_m", "heading_sd_rad"} and not seen.remarks
    assert {"x_m", "y_m", "psi_rad", "pwm_port", "steer_starboard_rad"} <= set(seen.signals)
    assert np.diff(seen.t) == pytest.approx(1.0 / 6.0)
    assert not recording.read(tmp_path / "out" / "recording.csv").notes.noise  # the truth has none


def test_the_same_seed_gives_the_same_bytes_and_another_one_others(tmp_path: Path) -> None:
    file = write(tmp_path / "s.toml")
    for out, seed in (("a", 3), ("b", 3), ("c", 4)):
        assert boatsim("run", file, "--seed", seed, "--out", tmp_path / out).exit_code == 0
        assert norms_of(tmp_path / out)["seed"] == seed
    a, b, c = ((tmp_path / out / "recording.csv").read_bytes() for out in "abc")
    assert a == b != c


WAVES = """
about = "Adrift in waves."
vessel = "trial_boat"
duration = 120.0
[controller]
use = "open_loop"
[[effect]]
use = "wave_forcing"
surge = 0.2
sway = 0.2
yaw = 0.05
damping = 0.3
"""


@pytest.mark.slow
def test_another_seed_is_another_course_of_the_waves(tmp_path: Path) -> None:
    file = write(tmp_path / "waves.toml", WAVES)
    for out, seed in (("a", 1), ("b", 1), ("c", 2)):
        assert boatsim("run", file, "--seed", seed, "--out", tmp_path / out).exit_code == 0
    a, b, c = (recording.read(tmp_path / out / "recording.csv") for out in "abc")
    for name in ("u_mps", "v_mps", "r_radps"):
        assert (a[name] == b[name]).all()
        assert abs(np.corrcoef(a[name], c[name])[0, 1]) < 0.5  # of 120 s the error is 0.1
        assert np.std(c[name]) == pytest.approx(np.std(a[name]), rel=0.3)


def test_several_scenarios_get_a_folder_each_and_one_exit_code(tmp_path: Path) -> None:
    good, missed = (
        write(tmp_path / "good.toml"),
        write(tmp_path / "missed.toml", PLAIN + IMPOSSIBLE),
    )
    assert boatsim("run", good, missed, "--out", tmp_path / "out").exit_code == 1
    assert {f.name for f in (tmp_path / "out").iterdir()} == {"good", "missed"}
    assert all(
        {f.name for f in folder.iterdir()} == FILES for folder in (tmp_path / "out").iterdir()
    )
    assert norms_of(tmp_path / "out" / "missed")["norms"]["v_mps_inf"]["ok"] is False


def test_a_ctrl_c_keeps_what_was_logged(tmp_path: Path) -> None:
    (tmp_path / "quitter.py").write_text(QUITTER)
    text = PLAIN.replace('"l1_joystick"', '"quitter.py"').replace("[[goal]]\nsway_mps = 0.07\n", "")
    quits, good = write(tmp_path / "quits.toml", text), write(tmp_path / "good.toml")
    result = boatsim("run", quits, good, "--out", tmp_path / "out", "--trust")
    assert result.exit_code == 130
    assert [f.name for f in (tmp_path / "out").iterdir()] == ["quits"]  # the next one was not begun
    assert norms_of(tmp_path / "out" / "quits")["complete"] is False
    log = recording.read(tmp_path / "out" / "quits" / "recording.csv")
    assert 0.9 < log.t[-1] < 1.2 and set(log["steer_port_rad"]) == {0.1}


MISTAKES = {  # change of the plain scenario, what its one line must name
    "key": ('about = "', 'abuot = "x"\nabout = "', ("abuot", "did you mean 'about'")),
    "key of a table": ("[[goal]]", "[tank]\nlenght = 3.0\n[[goal]]", ("lenght", "'length'")),
    "setting": ('use = "l1_joystick"', 'use = "l1_joystick"\nperoid = 0.1', ("peroid", "'period'")),
    "goal": ("sway_mps", "sway_mp", ("sway_mp", "'sway_mps'")),
    "vessel": ("joystick_boat", "joystik_boat", ("joystik_boat", "'joystick_boat'")),
    "load": ('"light"', '"lite"', ("lite", "light")),
    "controller": ("l1_joystick", "l1_joystik", ("l1_joystik", "'l1_joystick'")),
    "effect": ('use = "weak_reverse"', 'use = "weak_revers"', ("weak_revers", "'weak_reverse'")),
    "value": ("0.694", "69.4", ("WeakReverse.astern_factor = 69.4", "allowed")),
    "type": ("duration = 2.0", 'duration = "long"', ("duration", "long")),
    "syntax": ("duration = 2.0", "duration = ", ("s.toml", "line")),
    # known only when the run is over
    "check": (
        "[[goal]]",
        '[[check]]\nsignal = "v_mp"\nnorm = "inf"\nbelow = 1.0\n[[goal]]',
        ("v_mp", "'v_mps'"),
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_line_exit_code_2_and_leaves_nothing(mistake: str, tmp_path: Path) -> None:
    old, new, named = MISTAKES[mistake]
    file = write(tmp_path / "s.toml", change=(old, new))
    result = boatsim("run", file, "--out", tmp_path / "out")
    assert result.exit_code == 2 and not result.stdout
    assert result.stderr.count("\n") == 1 and all(part in result.stderr for part in named), (
        result.stderr
    )
    assert list(tmp_path.iterdir()) == [file]


def test_nothing_runs_if_one_of_several_scenarios_is_wrong(tmp_path: Path) -> None:
    result = boatsim(
        "run", write(tmp_path / "s.toml"), "joystick_boat/sway_11", "--out", tmp_path / "out"
    )
    assert result.exit_code == 2 and "did you mean 'joystick_boat/sway_1'" in result.stderr
    assert not (tmp_path / "out").exists()


def test_two_scenarios_never_share_a_folder(tmp_path: Path) -> None:
    file = write(tmp_path / "s.toml")
    result = boatsim("run", file, file, "--out", tmp_path / "out")
    assert (
        result.exit_code == 2 and "named twice" in result.stderr and not (tmp_path / "out").exists()
    )


def test_a_file_where_the_folder_should_be_is_left_alone(tmp_path: Path) -> None:
    taken = write(tmp_path / "taken", "mine")
    result = boatsim("run", write(tmp_path / "s.toml"), "--out", taken)
    assert result.exit_code == 2 and "is a file" in result.stderr and taken.read_text() == "mine"


@pytest.mark.parametrize(
    "arguments", [["run"], ["run", "--jobs", "0", "x"], ["nothing"], ["list", "boats"], ["replay"]]
)
def test_wrong_usage_is_exit_code_2(arguments: list[str]) -> None:
    assert boatsim(*arguments).exit_code == 2


@pytest.mark.parametrize("kind", ["vessel", "controller", "effect", "scenario"])
@pytest.mark.slow
def test_list_has_a_line_about_everything(kind: str) -> None:
    result = boatsim("list", f"{kind}s")
    lines = [line.split(maxsplit=1) for line in result.stdout.splitlines()[1:]]
    assert result.exit_code == 0 and [
        name for name, about in lines if about
    ] == content.shipped_content_names(kind)
    assert result.stdout.strip() in boatsim("list").stdout


def test_margins_prints_the_l1_norm_of_the_yaw_channel() -> None:
    result = boatsim("margins", "l1_joystick_sway")
    assert result.exit_code == 0 and "0.616" in result.stdout
    assert "nominal boat with ideal actuators" in result.stdout and "--vessel" in result.stdout
    assert "did you mean 'l1_joystick'" in boatsim("margins", "l1_joystik").stderr
    assert "--load needs --vessel" in boatsim("margins", "l1_joystick", "--load", "wide").stderr
    assert "give it by --vessel NAME" in boatsim("margins", "l1_differential").stderr


@pytest.mark.slow
def test_margins_on_a_vessel_are_analytic_and_simulated(monkeypatch: pytest.MonkeyPatch) -> None:
    controller = content.load_class("controller", "l1_joystick_sway")
    every = controller.operating_points
    monkeypatch.setattr(controller, "operating_points", lambda self: every(self)[2:3])
    result = boatsim("margins", "l1_joystick_sway", "--vessel", "joystick_boat", "--load", "wide")
    assert result.exit_code == 0 and "0.616" in result.stdout
    turn = [line for line in result.stdout.splitlines() if line.startswith("yaw in a turn")]
    assert turn[0].split()[-4] == "0.156" and abs(float(turn[0].split()[-2])) < 5.0


@pytest.mark.slow
def test_robustness_prints_and_writes_the_largest_value_survived(tmp_path: Path) -> None:
    words = ["robustness", "pid_autopilot", "--vessel", "joystick_boat", "--boats", "3"]
    result = boatsim(*words, "--disturbance", "delay=0.05,2", "--out", str(tmp_path / "out"))
    assert result.exit_code == 0 and "Largest value that 95 % of 3 boats" in result.stdout
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "robustness.csv",
        "robustness.json",
        "report.html",
    }
    for wrong, hint in (("dely", "did you mean 'delay'"), ("delay=x", "'x' is no value")):
        bad = boatsim(*words, "--disturbance", wrong, "--out", str(tmp_path / "bad"))
        assert bad.exit_code == 2 and hint in bad.stderr and not (tmp_path / "bad").exists()
    for wrong, hint in (("kq=1", "did you mean 'kp'"), ("kp=x", "allowed is NAME,KEY=NUMBER")):
        bad = boatsim("robustness", f"pid_autopilot,{wrong}", *words[2:])
        assert bad.exit_code == 2 and hint in bad.stderr
    for value, code in (("true", 0), ("perhaps", 2)):
        switch = f"l1_joystick_projection,input_as_published={value}"
        place = ("--disturbance", "delay=2", "--out", str(tmp_path / value))
        assert boatsim("robustness", switch, *words[2:], *place).exit_code == code
    missing = boatsim(*words, "--draw", "body.mas=uniform(1,2)")
    assert missing.exit_code == 2 and "did you mean 'body.mass'" in missing.stderr


@pytest.mark.parametrize(
    ("option", "value", "hint"),
    [
        ("--gain", "pole=1", "allowed is NAME or NAME=LOW:HIGH"),
        ("--gain", "poles", "did you mean 'pole'"),
        ("--disturbance", "dely", "did you mean 'delay'"),
    ],
)
def test_tune_refuses_wrong_options(tmp_path: Path, option: str, value: str, hint: str) -> None:
    words = ["tune", "l1_joystick", "--vessel", "joystick_boat", option, value]
    result = boatsim(*words, "--out", str(tmp_path / "out"))
    assert result.exit_code == 2 and hint in result.stderr and not (tmp_path / "out").exists()


def test_version() -> None:
    assert boatsim("--version").stdout.split() == ["boatsim", __version__]


def test_options_of_a_diagnosis_reach_it(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def fake(*given: Any) -> int:
        asked.append(given)
        return 0

    for name in ("diagnose", "replay", "compare"):
        monkeypatch.setattr(f"boatsim.cli.diagnosis.{name}", fake)
    boat = ["--vessel", "trial_boat", "--load", "heavy,wide", "--out", "o"]
    kept = [
        "--hold-out",
        "c.csv",
        "--library",
        "wind",
        "--library",
        "own.py",
        "--without",
        "current",
        "--horizon",
        3,
    ]
    assert boatsim("diagnose", "a.csv", "b.csv", *boat, *kept).exit_code == 0
    assert (
        boatsim("replay", "a.csv", *boat).exit_code
        == boatsim("replay", "a.csv", *boat, "--horizon", 4).exit_code
        == 0
    )
    assert boatsim("compare", "a.csv", "--scenario", "s.toml", "--out", "o").exit_code == 0
    a, load, out = Path("a.csv"), ["heavy", "wide"], Path("o")
    assert asked == [
        (
            [a, Path("b.csv")],
            DiagnosisOptions(
                hold_out=("c.csv",),
                vessel="trial_boat",
                load=tuple(load),
                library=("wind", "own.py"),
                without=("current",),
                horizon=3.0,
            ),
            out,
            False,
        ),
        (a, "trial_boat", load, 6.0, out),
        (a, "trial_boat", load, 4.0, out),
        (a, None, [], "s.toml", out),
    ]


# Processes of their own
# ----------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_shipped_scenario_is_a_script(tmp_path: Path) -> None:
    # where the installed `boatsim` lies
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    script = content.content_root() / "scenarios" / "joystick_boat" / "berth.toml"
    done = subprocess.run(
        [script], cwd=tmp_path, env=os.environ | {"PATH": path}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert {f.name for f in (tmp_path / "out" / "joystick_boat" / "berth").iterdir()} == FILES


@pytest.mark.parametrize("name", content.shipped_content_names("scenario"))
def test_every_shipped_scenario_can_be_executed(name: str) -> None:
    file = content.find_content_file("scenario", name)
    assert os.access(file, os.X_OK) and file.read_text().startswith(
        "#!/usr/bin/env -S boatsim run\n"
    )


@pytest.mark.slow
def test_ctrl_c_stops_all_processes_and_keeps_what_each_had(tmp_path: Path) -> None:
    short, *long = (
        write(tmp_path / "short.toml"),
        *(write(tmp_path / f"{n}.toml", change=("2.0", "8e4")) for n in "ab"),
    )
    assert boatsim("run", short, "--out", tmp_path / "alone").exit_code == 0
    out = tmp_path / "out"
    command: list[str | Path] = [
        sys.executable,
        "-m",
        "boatsim",
        "run",
        short,
        *long,
        "--jobs",
        "2",
        "--out",
        out,
    ]
    # a shell that runs us in the background ignores SIGINT, which a child would inherit
    heeding = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=heeding
    ) as running:
        until = time.monotonic() + 120.0
        while len(list(out.glob("[ab].part-*/run.rrd"))) < 2 and time.monotonic() < until:
            time.sleep(0.1)
        os.killpg(running.pid, signal.SIGINT)  # as a terminal sends it: to all of them
        try:
            assert running.wait(60.0) == 130
        except subprocess.TimeoutExpired:
            os.killpg(running.pid, signal.SIGKILL)
            raise
        assert running.stderr
        assert [line for line in running.stderr if not line.startswith("progress: ")] == [
            INTERRUPTED
        ]
    assert sorted(f.name for f in out.iterdir()) == ["a", "b", "short"]
    for folder in out.iterdir():
        assert {f.name for f in folder.iterdir()} == FILES
        assert norms_of(folder)["complete"] is (folder.name == "short")
    same = [
        (folder / "recording.csv").read_bytes() for folder in (tmp_path / "alone", out / "short")
    ]
    assert same[0] == same[1]


def test_a_folder_of_vessel_and_scenarios_runs_the_scenarios_and_one_without_any_is_a_line(
    tmp_path: Path,
) -> None:
    shutil.copytree(content.find_content_file("vessel", "trial_boat").parent, tmp_path / "mine")
    bare = boatsim("run", str(tmp_path / "mine"))
    assert bare.exit_code == 2 and "there is no scenario (*.toml) in this folder" in bare.stderr
    (tmp_path / "mine" / "drift.toml").write_text(
        'vessel = "./vessel.toml"\nduration = 1.0\n[controller]\nuse = "open_loop"\n'
    )
    assert boatsim("run", str(tmp_path / "mine"), "--out", str(tmp_path / "out")).exit_code == 0
    assert (tmp_path / "out" / "norms.json").is_file()


def test_a_recording_that_does_not_exist_is_said_to(tmp_path: Path) -> None:
    for command in ("diagnose", "replay"):
        found = boatsim(command, str(tmp_path / "none.csv"))
        assert found.exit_code == 2 and "none.csv: there is no such file" in found.stderr


LAW = """
from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    return wrench(X=-q.c * m.ur)


@dataclass(frozen=True)
class MistyDrag(Force):
    law: ClassVar = law
    c: float = param(0.0, low=0.0, high=9.0, unit="N s/m", words="drag", fit=True, spread=1.0)
"""


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("q.c", "q.d", "misty_drag.py:12: Unknown attribute 'd'"),
        ("    law: ClassVar = law\n", "", "class MistyDrag has no compiled law"),
        ('@njit(inline="always")\n', "", "class MistyDrag has no compiled law"),
        (", spread=1.0", "", "line 18 ValueError: a parameter with fit=True needs a spread"),
        ("(Force)", "", "class MistyDrag is no effect"),
        ("class MistyDrag", "class FoggyDrag", "no class MistyDrag in it"),
    ],
)
def test_a_mistake_in_an_effect_of_ones_own_is_a_line_that_says_where(
    tmp_path: Path, right: str, wrong: str, said: str
) -> None:
    shutil.copytree(content.find_content_file("vessel", "trial_boat").parent, tmp_path / "mine")
    text = (tmp_path / "mine" / "vessel.toml").read_text()
    own = '[[effect]]\nuse = "misty_drag.py"\nc = 1.0\n\n'
    (tmp_path / "mine" / "vessel.toml").write_text(
        text.replace("[[effect]]", own + "[[effect]]", 1)
    )
    assert right in LAW
    (tmp_path / "mine" / "misty_drag.py").write_text(LAW.replace(right, wrong, 1))
    (tmp_path / "mine" / "drift.toml").write_text(
        'vessel = "./vessel.toml"\nduration = 1.0\n[controller]\nuse = "open_loop"\n'
    )
    found = boatsim("run", str(tmp_path / "mine"), "--out", str(tmp_path / "out"), "--trust")
    assert found.exit_code == 2 and said in found.stderr and found.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()
