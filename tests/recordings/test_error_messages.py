"""What strangers' files have in them: one line that says what is wrong, exit code 2, and nothing
written."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import boats
import pytest
from alike import long
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.cli.exits import LONGEST
from boatsim.recordings.table import read

STILL = 'vessel = "{}"\nduration = 0.1\n[controller]\nuse = "{}"\n'
TRIAL = Path(__file__).parents[1] / "data" / "trials" / "T002" / "run_1.csv"


def line_of(*arguments: object) -> str:
    """The one line of a command that is refused."""
    done: Any = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    assert done.exit_code == 2 and done.stderr.count("\n") == 1, done.output
    assert len(done.stderr) <= LONGEST + 1 and done.stderr[:-1].isprintable()
    return str(done.stderr)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            STILL.format("joystick_boat", "l1_joystick") + "[[goal]]\nspeed = 1.0\n",
            "[[goal]] key 'speed' does not",
        ),
        (
            STILL.format("joystick_boat", "l1_joystick") + '[[goal]]\nsway_mps = "x"\n',
            "should be a valid number",
        ),
        ("step = 5e-4\n" + STILL.format("joystick_boat", "l1_thesis") + "power = 0.0\n", "power"),
        (
            'measure = { use = "activity", signal = "rudder_rad" }\n'
            + STILL.format("joystick_boat", "open_loop"),
            "rudder",
        ),
        ('measure = "roll_decay"\n' + STILL.format("joystick_boat", "open_loop"), "phi_rad"),
        (
            STILL.format("joystick_boat", "open_loop") + "[tank]\nlength = 1e-300\nwidth = 1.0\n",
            "tank.length = 1e-300",
        ),
        (
            STILL.format("joystick_boat", "open_loop") + "[camera]\nrate = 1e9\n",
            "Camera.rate = 1e+09 Hz",
        ),
        ("seed = " + "9" * 400 + "\n", "seed is an integer of 400 digits"),
        ("step = 1e-12\n" + STILL.format("joystick_boat", "open_loop"), "step = 1e-12"),
        (
            '[[effect]]\nuse = "\\u202e\\u001b[2J"\n' + STILL.format("joystick_boat", "open_loop"),
            "",
        ),
    ],
)
def test_a_scenario_that_can_not_be_run(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "odd.toml").write_text(text)
    assert said in line_of("run", tmp_path / "odd.toml", "--out", tmp_path / "out")
    assert [f.name for f in tmp_path.iterdir()] == ["odd.toml"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("length = 1.0", "length = 1e-300", "length = 1e-300"),
        ("beam = 0.4", "beam = 0.0", "beam = 0.0"),
        ("draught = 0.1", "draught = 1e300", "draught = 1e+300"),
        ("mass = 6.0", "mass = 0.0", "body.mass = 0.0"),
        ("mass = 6.0", "mass = nan", "body.mass = nan"),
        ("thrust_port_N =", "t_s =", "'t_s' is not allowed as a name"),
    ],
)
def test_a_vessel_that_can_not_be(tmp_path: Path, old: str, new: str, said: str) -> None:
    place = boats.written(tmp_path, "odd", boats.PLANAR.replace(old, new, 1))
    (tmp_path / "odd.toml").write_text(STILL.format(f"{place.name}/", "open_loop"))
    assert said in line_of("run", tmp_path / "odd.toml", "--out", tmp_path / "out")


def ring(folder: Path) -> Path:
    (folder / "a").symlink_to(folder / "b")
    (folder / "b").symlink_to(folder / "a")
    return folder / "a"


def pipe(folder: Path) -> Path:
    os.mkfifo(folder / "pipe")
    return folder / "pipe"


@pytest.mark.parametrize(
    "odd", [ring, pipe, lambda folder: folder / "none", lambda folder: Path("/dev/zero")]
)
def test_what_is_no_file(tmp_path: Path, odd: Callable[[Path], Path]) -> None:
    path = odd(tmp_path)
    for name in ("x.toml", "x.csv", "x.nmea"):
        (tmp_path / name).symlink_to(path)
    line_of("run", tmp_path / "x.toml", "--out", tmp_path / "out")
    line_of("replay", tmp_path / "x.csv", "--vessel", "trial_boat", "--out", tmp_path / "out")
    line_of("import", tmp_path / "x.nmea")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("out", ["", "\0", "dangling", "file", "o" * 300])
def test_a_folder_that_can_not_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "dangling").symlink_to(tmp_path / "nowhere")
    (tmp_path / "file").touch()
    (tmp_path / "still.toml").write_text(STILL.format("joystick_boat", "open_loop"))
    before = sorted(tmp_path.iterdir())
    line_of("run", "still.toml", "--out", out)
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("text", ["1/0", "def", "raise SystemExit(7)", "", "\0"])
def test_a_controller_of_ones_own_that_can_not_be_read(tmp_path: Path, text: str) -> None:
    (tmp_path / "own.py").write_text(text)
    assert "own.py" in line_of("margins", tmp_path / "own.py")


@pytest.mark.parametrize("name", [long("we\"ird 'q' gr\u00f6\u00dfe 50%n"), "x\udcff new\nline"])
@pytest.mark.slow
def test_a_path_may_have_any_name(tmp_path: Path, name: str) -> None:
    place = tmp_path / name
    try:
        place.mkdir()
    except OSError:
        pytest.skip("not on this file system")
    (place / f"{name}.toml").write_text(
        STILL.format("joystick_boat", "open_loop").replace("0.1", "1.0")
    )
    words = [sys.executable, "-m", "boatsim", "run", place / f"{name}.toml", "--out", place / "out"]
    done = subprocess.run(
        words, capture_output=True, check=False, env=os.environ | {"PYTHONIOENCODING": "ascii"}
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert read(place / "out" / "recording.csv").notes.vessel == "joystick_boat"


def test_a_recording_in_a_path_of_any_name_is_replayed(tmp_path: Path) -> None:
    run = tmp_path / "x\udcff\n\u202e.csv"
    run.write_bytes(TRIAL.read_bytes())
    done: Any = CliRunner().invoke(
        app, ["check", str(run), "--vessel", "trial_boat"], catch_exceptions=False
    )
    assert done.exit_code in (0, 1) and "\\udcff\\n\\u202e" in done.output
