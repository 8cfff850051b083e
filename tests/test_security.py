"""The lines of docs/security.md, each by the number it has there."""

import json
import os
import re
import socket
import stat
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import boats
import numpy as np
import pyarrow as pa
import pytest
import typer
from alike import long
from pyarrow import parquet
from typer.testing import CliRunner

from boatsim.cli import app, trust_prompt
from boatsim.cli.exits import LONGEST, one_line, print_error
from boatsim.cli.run_many import plan_runs
from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.loading import vessel_of_recording_file
from boatsim.drive.connections import HANDSHAKE_TIME, MOST_WAITING
from boatsim.drive.driver_input import PATIENCE, DriverInput, Sticks
from boatsim.drive.server import LARGEST as MESSAGE
from boatsim.drive.server import STRANGE, TAKEN, Server
from boatsim.errors import BadInput, BoatsimError, escape_for_terminal
from boatsim.files import MAX_DEPTH, MAX_TOML_BYTES, read_toml
from boatsim.physics import cache, content, trust, vessel
from boatsim.physics.program import Program
from boatsim.recordings import limits
from boatsim.recordings.notes import notes_for
from boatsim.recordings.table import read
from boatsim.simulate import hull_assets, hull_xml_check
from boatsim.sitl.link import LOOPBACK, AutopilotLink
from boatsim.sitl.servo_packet import parse_servo_packet
from boatsim.view import viewer

HERE = Path(__file__)
TRIAL = HERE.parent / "data" / "trials" / "T002" / "run_1.csv"
PAGE = (HERE.parents[1] / "docs" / "security.md").read_text(encoding="utf-8")
EFFECT = """
from dataclasses import dataclass
from pathlib import Path
from numba import njit
from boatsim.physics.base import Force, param, wrench
Path(__file__).with_suffix(".ran").touch()

@njit(inline="always")
def law(m, q):
    return wrench(K=-q.c * m.p)

@dataclass(frozen=True)
class Slime(Force):
    words = "slime resists rolling"
    shown_by = "a decay"
    law = law
    c: float = param(0.1, low=0.0, high=1e3, unit="N m s", words="per rate", fit=True, spread=0.1)
"""
USE = '[[effect]]\nuse = "{}"\n'
STILL = 'duration = 0.1\n[controller]\nuse = "open_loop"\n'


def boatsim(*arguments: object) -> Any:
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def with_slime(folder: Path, use: str = "slime", where: str = "test_boat") -> tuple[Path, Path]:
    """A scenario whose vessel has an effect of its own beside it; the file that says whether it
    ran."""
    place = boats.written(folder, "test_boat", boats.ROLL + USE.format(use))
    (folder / where).mkdir(exist_ok=True)
    (folder / where / "slime.py").write_text(EFFECT)
    scenario = folder / "still.toml"
    scenario.write_text(f'vessel = "{place.name}/"\n{STILL}')
    return scenario, folder / where / "slime.ran"


def refused(done: Any) -> str:
    """The one line of a command that ended so."""
    assert done.exit_code == 2 and done.stderr.count("\n") == 1, done.output
    return str(done.stderr)


# No code from data
# ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["effect", "controller", "measure", "sensor", "vessel's effect"])
def test_1_a_python_file_that_data_name_does_not_run(tmp_path: Path, kind: str) -> None:
    file, ran = with_slime(tmp_path)
    (tmp_path / "slime.py").write_text(EFFECT)
    plain = f'vessel = "kvlcc2_roll"\n{STILL}'
    text = {
        "effect": plain + USE.format("slime"),
        "controller": plain.replace("open_loop", "slime.py"),
        "measure": 'measure = "slime"\n' + plain,
        "sensor": plain + '[[sensor]]\nuse = "slime"\n',
    }
    if kind in text:
        file.write_text(text[kind])
    assert "slime.py is not run" in refused(boatsim("run", file, "--out", tmp_path / "out"))
    assert (
        not ran.exists()
        and not (tmp_path / "slime.ran").exists()
        and not (tmp_path / "out").exists()
    )


def test_1_an_effect_that_a_vessel_asks_to_be_tried_does_not_run(tmp_path: Path) -> None:
    place = boats.written(
        tmp_path, "test_boat", boats.ROLL + '[diagnosis]\nalso = [{ use = "slime" }]\n'
    )
    (place / "slime.py").write_text(EFFECT)
    boat = vessel.load_vessel(f"{place}/")
    with pytest.raises(BadInput, match="is not run"):
        candidate_library(boat)
    assert not (place / "slime.ran").exists()
    with trust.trust_folders(allowed=[place]):
        assert "slime" in candidate_library(boat).tested_names


def test_1_a_strangers_recording_runs_nothing(tmp_path: Path) -> None:
    _, ran = with_slime(tmp_path)
    (tmp_path / "run.csv").write_bytes(TRIAL.read_bytes())
    (tmp_path / "recording.toml").write_text('vessel = "test_boat/vessel.toml"\n')
    for command in ("diagnose", "replay", "compare"):
        assert "slime.py is not run" in refused(
            boatsim(command, tmp_path / "run.csv", "--out", tmp_path / "out")
        )
    assert not ran.exists()


@pytest.mark.slow
def test_2_content_runs_and_its_names_resolve(tmp_path: Path) -> None:
    home = tmp_path / "mine"
    for folder in ("effects", "models", "scenarios/calm"):
        (home / folder).mkdir(parents=True)
    (home / "effects" / "slime.py").write_text(EFFECT)
    boats.written(home / "models", "slimy", boats.ROLL + USE.format("slime"))
    (home / "scenarios" / "calm" / "still.toml").write_text(
        f'about = "Calm."\nvessel = "slimy"\n{STILL}'
    )
    assert "'calm/still' does not exist" in refused(
        boatsim("run", "calm/still", "--out", tmp_path / "out")
    )
    assert boatsim("run", "calm/still", "--content", home, "--out", tmp_path / "out").exit_code == 0
    listed = boatsim("list", "--content", home).stdout
    assert all(
        re.search(rf"^  {name} ", listed, re.MULTILINE)
        for name in ("slime", "slimy", "calm/still", "thruster")
    )
    (home / "effects" / "thruster.py").write_text("1 / 0")
    with trust.trust_folders(home):
        assert (
            content.load_class("effect", "thruster").__module__
            == "boatsim.physics.effects.thruster"
        )
        assert plan_runs(["calm/still"], None, None)[0].task.name == "calm/still"
    assert "this folder of content does not exist" in refused(
        boatsim("list", "--content", tmp_path / "none")
    )


@pytest.mark.parametrize(
    "arguments", [["list", "effects"], ["show", "slime"], ["show", "slime.py"]]
)
def test_6_a_link_in_a_content_folder_runs_nothing_outside(
    tmp_path: Path, arguments: list[str]
) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "slime.py").write_text(EFFECT)
    own = tmp_path / "own" / "effects"
    own.mkdir(parents=True)
    (own / "slime.py").symlink_to(outside / "slime.py")
    done = boatsim(*arguments, "--content", tmp_path / "own")
    assert done.exit_code == 2 and "slime.py is not run" in done.stderr
    assert done.stderr.count("\n") == 1 and not (outside / "slime.ran").exists()
    shown = boatsim("show", "slime", "--content", tmp_path / "own", "--content", outside)
    assert shown.exit_code == 0 and (outside / "slime.ran").exists()


def test_3_trust_lets_run_what_lies_beside_the_files_of_the_command_line_and_nothing_else(
    tmp_path: Path,
) -> None:
    file, ran = with_slime(tmp_path)
    assert (
        boatsim("run", file, "--trust", "--out", tmp_path / "out").exit_code == 0 and ran.exists()
    )
    (tmp_path / "elsewhere").mkdir()
    other, ran = with_slime(tmp_path / "elsewhere")
    named = tmp_path / "named" / "still.toml"
    named.parent.mkdir()
    named.write_text(other.read_text().replace("test_boat/", f"{tmp_path}/elsewhere/test_boat/"))
    assert "slime.py" in refused(boatsim("run", named, "--trust", "--out", tmp_path / "out"))
    assert not ran.exists()


@pytest.mark.parametrize(
    ("answer", "runs"), [("y\n", True), ("YES\n", True), ("n\n", False), ("", False)]
)
def test_4_a_person_at_a_terminal_is_asked_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: str, runs: bool
) -> None:
    file, ran = with_slime(tmp_path)
    (file.parent / "test_boat" / "slimy.py").write_text(EFFECT.replace("Slime", "Slimy"))
    with (file.parent / "test_boat" / "vessel.toml").open("a") as text:
        text.write(USE.format("slimy"))
    monkeypatch.setattr(trust_prompt, "_is_interactive", lambda: True)
    done = CliRunner().invoke(app, ["run", str(file), "--out", str(tmp_path / "out")], input=answer)
    assert done.stderr.count("Run them? [y/N]") == 1 and ran.exists() == runs
    assert done.exit_code == (0 if runs else 2)


def test_4_nobody_is_asked_without_a_terminal() -> None:
    assert not trust_prompt._is_interactive()  # as tests run


def test_5_a_file_that_the_user_names_runs(tmp_path: Path) -> None:
    own = tmp_path / "slime.py"
    own.write_text(EFFECT)
    assert content.load_class("effect", str(own), named=True).__name__ == "Slime"
    other = tmp_path / "other" / "slime.py"
    other.parent.mkdir()
    other.write_text(EFFECT)
    with pytest.raises(BadInput, match="is not run"):
        content.load_class("effect", str(other))


@pytest.mark.parametrize(
    "use", ["../away/slime.py", "{}/away/slime.py", "link.py", "away/slime.py", "slime"]
)
def test_6_a_path_counts_by_where_the_file_really_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, use: str
) -> None:
    (tmp_path / "boat").mkdir()
    file, _ = with_slime(tmp_path / "boat", use.format(tmp_path))
    (tmp_path / "boat" / "test_boat" / "slime.py").unlink()
    away = tmp_path / "away"
    away.mkdir()
    (away / "slime.py").write_text(EFFECT)
    (tmp_path / "boat" / "test_boat" / "link.py").symlink_to(away / "slime.py")
    monkeypatch.chdir(away if use == "slime" else tmp_path)
    refused(boatsim("run", file, "--trust", "--out", tmp_path / "out"))
    assert not (away / "slime.ran").exists()


@pytest.fixture
def far(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A recording four folders below the one that has a recording.toml."""
    monkeypatch.setenv("HOME", str(tmp_path / "nobody"))
    (tmp_path / "recording.toml").write_text('vessel = "trial_boat"\n')
    place = tmp_path / "a" / "b" / "c"
    place.mkdir(parents=True)
    (place / "run.csv").write_bytes(TRIAL.read_bytes())
    yield place / "run.csv"


def test_7_notes_are_found_above(far: Path) -> None:
    assert notes_for(far).notes.vessel == "trial_boat"


def test_7_notes_do_not_count_above_home_repository_or_what_anybody_writes_to(
    far: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    b = far.parents[1]
    monkeypatch.setenv("HOME", str(b))
    assert notes_for(far).notes.vessel is None
    monkeypatch.setenv("HOME", "/nowhere")
    (b / ".git").mkdir()
    assert notes_for(far).notes.vessel is None
    (b / ".git").rmdir()
    b.chmod(0o777)
    assert notes_for(far).notes.vessel is None
    b.chmod(0o755)
    assert notes_for(far).notes.vessel == "trial_boat"


def test_7_paths_in_notes_start_at_their_folder(far: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = far.parents[3]
    boats.written(home, "mine", boats.ROLL)
    (home / "recording.toml").write_text('vessel = "mine/"\n')
    monkeypatch.chdir(far.parent)
    assert vessel_of_recording_file(far, None, []).file == home / "mine" / "vessel.toml"
    with pytest.raises(BadInput):
        vessel_of_recording_file(far, "mine/", [])  # the user's own word starts where he is


@pytest.mark.parametrize(
    "name", ["x\nimport os; os.mkdir('ran')\n#", "\r1/0", "\u2028 1/0", '"""\n1/0\n"""']
)
def test_8_names_do_not_become_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("BOATSIM_CACHE", str(tmp_path / "cache"))
    quoted = (
        name.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\r", "\\r")
    )
    text = boats.ROLL + f'[[effect]]\nuse = "roll_damping"\nname = "{quoted}"\n'
    place = boats.written(tmp_path, 'quo"""ted\n1\n', boats.ROLL)
    (place / "vessel.toml").write_text(
        text.replace('use = "roll_damping"', 'use = "quadratic_damping"\nroll = 0.1')
    )
    program = Program(vessel.load_vessel(str(place / "vessel.toml")))
    assert program.module.HELD == 1 and not (tmp_path / "ran").exists()


@pytest.mark.slow
def test_9_processes_may_run_what_their_parent_may(tmp_path: Path) -> None:
    file, ran = with_slime(tmp_path)
    twin = tmp_path / "twin.toml"
    twin.write_text(file.read_text())
    assert (
        boatsim("run", file, twin, "--jobs", 2, "--trust", "--out", tmp_path / "out").exit_code == 0
    )
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"still", "twin"} and ran.exists()
    with trust.trust_folders(allowed=[tmp_path], ask=lambda folder: True):
        assert trust.trusted_folder_list().ask is None and trust.trusted_folder_list().contains(ran)


def test_10_trust_in_python_ends_with_its_block(tmp_path: Path) -> None:
    file, ran = with_slime(tmp_path)
    place = str(file.parent / "test_boat") + "/"
    with pytest.raises(BadInput, match="is not run"):
        vessel.load_vessel(place)
    assert not ran.exists() and not trust.user_content_folders()
    with trust.trust_folders(tmp_path):
        assert vessel.load_vessel(place).effects[-1].name == "slime"
    assert not trust.user_content_folders()


# Compiled programs
# ------------------------------------------------------------------------------------------------


def test_11_the_cache_is_private(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = tmp_path / "cache"
    monkeypatch.setenv("BOATSIM_CACHE", str(place))
    assert cache.cache_folder() == place and stat.S_IMODE(place.stat().st_mode) == 0o700
    place.chmod(0o750)
    assert stat.S_IMODE(cache.cache_folder().stat().st_mode) == 0o700
    place.chmod(0o777)
    with pytest.raises(BadInput, match="every user may write to it"):
        cache.cache_folder()
    place.chmod(0o700)
    monkeypatch.setattr(os, "geteuid", lambda: place.stat().st_uid + 1)
    with pytest.raises(BadInput, match="belongs to another user"):
        cache.cache_folder()


def test_12_without_a_home_the_cache_is_a_new_folder_of_the_process(tmp_path: Path) -> None:
    code = (
        "import os; from boatsim.physics.cache_folder import cache_folder as f; a = f(); print(a, f() == a, "
        "oct(a.stat().st_mode)[-3:], os.environ['BOATSIM_CACHE'] == str(a))"
    )
    (tmp_path / "file").touch()
    environ = {k: v for k, v in os.environ.items() if k not in ("BOATSIM_CACHE", "XDG_CACHE_HOME")}
    environ |= {"HOME": str(tmp_path / "file"), "TMPDIR": str(tmp_path)}
    places = set()
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-c", code], env=environ, capture_output=True, text=True, check=True
        )
        place, same, mode, handed_on = done.stdout.split()
        assert (same, mode, handed_on) == ("True", "700", "True") and Path(place).parent == tmp_path
        assert not Path(place).exists() and f"boatsim-{os.getuid()}" != Path(place).name
        places.add(place)
    assert len(places) == 2


@pytest.mark.parametrize(
    "damage", ["laws.py", long("__init__.py"), long("*.nbi"), long("*.nbc"), "cut"]
)
@pytest.mark.slow
def test_13_a_damaged_cache_is_built_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damage: str
) -> None:
    place = boats.written(tmp_path, "test_roller", boats.ROLL)
    monkeypatch.setenv("BOATSIM_CACHE", str(tmp_path / "cache"))
    code = (
        "import sys, numpy as np; from boatsim.physics import vessel; from boatsim.physics.program import Program\n"
        "p = Program(vessel.load_vessel(sys.argv[1]))\n"
        "state, act = np.array([0.1, 0.0]), np.zeros(p.actuator_signal_size)\n"
        "print(p.module.total_body_force(0.0, state, act, np.int64(0), p.values(), p.effect_switches())[0])"
    )

    def moment() -> str:
        words = [sys.executable, "-c", code, str(place) + "/"]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        assert not done.stderr
        return done.stdout

    before = moment()
    (program,) = (tmp_path / "cache").glob("program_*")
    kept = list(program.rglob("*.nbc" if damage == "cut" else damage))
    assert kept
    for file in kept:
        whole = file.read_bytes()
        file.write_bytes(
            whole[: len(whole) // 2] if damage == "cut" else b"\x80garbage" + whole[9:]
        )
    assert moment() == before == moment()


# What is shown
# ----------------------------------------------------------------------------------------------------


def test_14_what_steers_a_terminal_is_shown_as_an_escape(
    capsys: pytest.CaptureFixture[str],
) -> None:
    print_error("a\x1b[2Jb\u202ec\u200bd\udcffe\nf")
    assert capsys.readouterr().err == "boatsim: a\\x1b[2Jb\\u202ec\\u200bd\\udcffe\\nf\n"
    assert escape_for_terminal("Königsberg, 5 °") == "Königsberg, 5 °"


@pytest.mark.slow
def test_14_an_ascii_terminal_gets_escapes(tmp_path: Path) -> None:
    file = tmp_path / "größe.toml"
    file.write_text(f'vessel = "kvlcc2_roll"\n{STILL}')
    words = [sys.executable, "-m", "boatsim", "run", str(file), "--out", str(tmp_path / "größe")]
    done = subprocess.run(
        words, env=os.environ | {"PYTHONIOENCODING": "ascii"}, capture_output=True, check=False
    )
    assert done.returncode == 0 and b"gr\\xf6\\xdfe" in done.stdout and not done.stderr


def test_15_a_line_is_not_too_long(capsys: pytest.CaptureFixture[str]) -> None:
    print_error(one_line(BadInput(f"{'a' * 4000}: first {'b' * 4000} last")))
    line = capsys.readouterr().err
    assert (
        len(line) == LONGEST + 1 and line.startswith("boatsim: aaa") and line.endswith("bbb last\n")
    )


@pytest.mark.slow
def test_16_the_report_escapes_what_it_shows(tmp_path: Path) -> None:
    run = tmp_path / "x<img src=q onerror=alert(1)>.csv"
    run.write_bytes(TRIAL.read_bytes())
    assert (
        boatsim("diagnose", run, "--vessel", "trial_boat", "--out", tmp_path / "out").exit_code == 0
    )
    page = (tmp_path / "out" / "report.html").read_text()
    assert "<img src=q" not in page and "&lt;img src=q" in page and "<script src" not in page


def test_16_a_run_is_served_to_this_machine_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    ended = subprocess.Popen([sys.executable, "-c", ""], start_new_session=True)
    ended.wait()
    monkeypatch.setattr(viewer, "_start_rerun", lambda *options: asked.extend(options) or ended)
    with (
        pytest.raises(BoatsimError, match="does not start"),
        viewer.start_or_find_viewer(serve=True),
    ):
        pass
    assert asked[asked.index("--bind") + 1] == "127.0.0.1"


def test_16_a_window_listens_to_this_machine_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    ended = subprocess.Popen([sys.executable, "-c", ""], start_new_session=True)
    ended.wait()
    monkeypatch.setattr(viewer, "_start_rerun", lambda *options: asked.extend(options) or ended)
    monkeypatch.setattr(viewer, "_is_listening", lambda port: False)
    monkeypatch.setenv("DISPLAY", ":99")
    with viewer.start_or_find_viewer(serve=False) as shown:
        assert shown is None
    assert asked[asked.index("--bind") + 1] == "127.0.0.1"


def test_3_a_check_and_an_import_run_what_is_trusted(tmp_path: Path) -> None:
    file, _ = with_slime(tmp_path)
    boat = f"{tmp_path / 'test_boat'}/"
    run = tmp_path / "run.csv"
    run.write_bytes(TRIAL.read_bytes())
    refused(boatsim("check", run, "--vessel", boat))
    assert "is not run" not in boatsim("check", run, "--vessel", boat, "--trust").stderr


# Limits
# -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a = " + "[" * 10**5 + "]" * 10**5, f"more than {MAX_DEPTH} deep"),
        ("a = " + "[" * (MAX_DEPTH + 1) + "]" * (MAX_DEPTH + 1), f"more than {MAX_DEPTH} deep"),
        (".".join("a" * 10**5) + " = 1", f"more than {MAX_DEPTH} deep"),
        ("#" + "x" * MAX_TOML_BYTES, f"more than {MAX_TOML_BYTES} bytes"),
        (f"a = {1 << 63}", "a is an integer of 19 digits"),
        ("a = " + "9" * 5000, "not a TOML file"),
    ],
    ids=["nested", "a little nested", "dotted", "huge", "65 bits", "5000 digits"],
)
def test_17_toml_has_its_limits(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "a.toml"
    file.write_text(text)
    with pytest.raises(BadInput, match=said):
        read_toml(file)
    file.write_text("a = " + "[" * (MAX_DEPTH - 1) + f"{(1 << 63) - 1}" + "]" * (MAX_DEPTH - 1))
    assert read_toml(file)


def test_18_too_many_columns_are_refused(tmp_path: Path) -> None:
    names = ["t_s", "x_m", *(f"c{i}" for i in range(30_000))]
    (tmp_path / "wide.csv").write_text(
        ",".join(names) + "\n" + "\n".join([",".join("1" for _ in names)] * 30)
    )
    parquet.write_table(
        pa.table({n: np.arange(30.0) for n in names[:3000]}), tmp_path / "wide.parquet"
    )
    for file, found in (("wide.csv", len(names)), ("wide.parquet", 3000)):
        with pytest.raises(
            BadInput, match=rf"has {found} columns; a recording has at most {limits.MAX_COLUMNS}"
        ):
            read(tmp_path / file)
    (tmp_path / "line.csv").write_bytes(b"t_s" * limits.MAX_HEADER_BYTES)
    with pytest.raises(BadInput, match="the first line has more"):
        read(tmp_path / "line.csv")


def test_18_runs_of_one_value_are_refused_by_what_the_file_says(tmp_path: Path) -> None:
    piece = pa.table({n: np.zeros(2_000_000) for n in ("t_s", "x_m", "y_m", "psi_rad", "r_radps")})
    file = tmp_path / "zeros.parquet"
    with parquet.ParquetWriter(file, piece.schema, compression="zstd") as writer:
        for _ in range(11):
            writer.write_table(piece)
    assert file.stat().st_size < 1e6
    with pytest.raises(BadInput, match=r"has 1\.1e\+08 cells; a recording has at most 1e\+08"):
        read(file)


def test_18_lists_in_a_column_are_not_read_and_texts_that_repeat_stay_one(tmp_path: Path) -> None:
    t = np.arange(1000.0)
    long = pa.DictionaryArray.from_arrays(pa.array(np.zeros(1000, dtype="i4")), ["x" * 10**6])
    lists = pa.array([[0.0]] * 1000)
    table = pa.table({"t_s": t, "x_m": t, "psi_rad": 0.0 * t, "note": long, "scan": lists})
    parquet.write_table(table, tmp_path / "run.parquet")
    assert set(read(tmp_path / "run.parquet").signals) == {"x_m", "psi_rad"}


def test_19_what_does_not_fit_the_memory_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert limits.free_memory() > 1e6
    monkeypatch.setattr(limits, "free_memory", lambda: 11.0 * TRIAL.stat().st_size)
    with pytest.raises(BadInput, match="of memory to be read"):
        read(TRIAL)
    monkeypatch.setattr(limits, "free_memory", lambda: 13.0 * TRIAL.stat().st_size)
    assert len(read(TRIAL))


# What listens while a boat is driven
# --------------------------------------------------------------------------------


@pytest.fixture
def server() -> Iterator[Server]:
    pytest.importorskip("websockets")
    with Server(DriverInput()) as made:
        yield made


def answer(url: str, **headers: str) -> int:
    try:
        with urlopen(Request(url, headers=headers), timeout=5) as found:
            return int(found.status)
    except HTTPError as error:
        return error.code


def dialled(server: Server, **more: Any) -> Any:
    """A socket as the page opens it."""
    from websockets.sync.client import connect

    own = f"http://127.0.0.1:{server.port}"
    more = {"origin": own, **more}
    return connect(server.address.replace("http", "ws") + "socket", **more)


def test_20_a_wrong_token_gets_neither_page_nor_socket(server: Server) -> None:
    from websockets.sync.client import connect

    own = f"http://127.0.0.1:{server.port}"
    assert answer(server.address) == 200
    for wrong in ("/", "/x/", f"/{server.address.split('/')[3][:-1]}/", "/socket"):
        assert answer(own + wrong) == 403
        with pytest.raises(Exception, match="403"):
            connect(own.replace("http", "ws") + wrong + "socket", origin=own)


def test_20_another_name_of_the_host_is_refused(server: Server) -> None:
    for host in (
        "evil.example",
        f"evil.example:{server.port}",
        f"127.0.0.1.evil.example:{server.port}",
    ):
        assert answer(server.address, Host=host) == 421


def test_20_a_socket_of_another_page_is_refused(server: Server) -> None:
    for origin in ("http://evil.example", f"http://localhost:{server.port}", None, "null"):
        with pytest.raises(Exception, match="403"):
            dialled(server, origin=origin)


def test_20_only_this_machine_can_reach_it(server: Server) -> None:
    listening = Path("/proc/net/tcp").read_text().splitlines()[1:]
    own = [line.split()[1] for line in listening if line.split()[1].endswith(f":{server.port:04X}")]
    assert own and all(address.startswith("0100007F:") for address in own if address)
    there = {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)}
    for other in (ip for ip in there if not ip.startswith("127.")):
        with socket.socket() as tried:
            tried.settimeout(2.0)
            assert tried.connect_ex((other, server.port)) != 0


def test_21_one_drives_and_a_second_page_is_told_so(server: Server) -> None:
    with dialled(server) as first:
        first.send(json.dumps({"sticks": [0, 0, 0], "moved": 1.0}))
        with dialled(server) as second, pytest.raises(Exception, match=str(TAKEN)):
            second.recv(5)
        first.send(json.dumps({"sticks": [0.5, 0, 0], "moved": 2.0}))
        until(lambda: server.hands.sticks() not in (None, Sticks()))
    until(lambda: server.hands.release_reason == "page closed")
    with dialled(server) as third:
        third.send(json.dumps({"sticks": [0, 0, 0], "moved": 3.0}))
        until(lambda: not server.hands.release_reason)


@pytest.mark.parametrize(
    "message",
    [
        "",
        "[",
        "{}",
        '{"sticks": [2, 0, 0], "moved": 0}',
        '{"sticks": [NaN, 0, 0], "moved": 0}',
        "[" * 900,
        '{"sticks": [0, 0], "moved": 0}',
        '{"sticks": "abc", "moved": 0}',
        b"\xff\xfe",
        "x" * 5000,
        '{"sticks": [%s, 0, 0], "moved": 0}' % ("9" * 400),
        '{"sticks": [0, 0, 0], "moved": -%s}' % ("9" * 400),
        '{"sticks": [0, 0, 0], "moved": 1e308}',
        '{"sticks": [0, 0, 0], "moved": null}',
        '{"sticks": [0, 0, 0], "moved": "1"}',
        '{"sticks": [true, 0, 0], "moved": 0}',
        '{"sticks": ["0.5", 0, 0], "moved": 0}',
        '{"sticks": [[0], 0, 0], "moved": 0}',
        '{"sticks": {"a": 0, "b": 0, "c": 0}, "moved": 0}',
        '{"sticks": "010", "moved": 0}',
        '{"sticks": [0, 0, 0], "moved": 0, "more": 0}',
        '{"end": 1}',
        '{"hidden": "true"}',
        "null",
        "9" * 400,
    ],
)
def test_22_what_is_no_message_of_the_page_ends_the_socket_and_moves_nothing(
    server: Server, message: str
) -> None:
    with dialled(server) as page:
        page.send(message)
        with pytest.raises(Exception, match=f"{STRANGE}|1009|1007"):
            page.recv(5)
    until(lambda: server._driver is None)
    assert server.hands.sticks() is None and not server.ended


@pytest.mark.slow
def test_23_connections_that_send_nothing_are_few_and_short_and_do_not_stop_the_driver(
    server: Server,
) -> None:
    with dialled(server) as driver:
        driver.send(json.dumps({"sticks": [0, 0, 0], "moved": 1.0}))
        silent = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(100)]
        assert answer(server.address) == 200  # a new page is served all the same
        until(lambda: sum(map(is_open, silent)) <= MOST_WAITING)
        for surge in (0.0, 0.5):
            driver.send(json.dumps({"sticks": [surge, 0, 0], "moved": 2.0}))
        until(lambda: server.hands.sticks() not in (None, Sticks()))
        for one in silent:
            one.settimeout(HANDSHAKE_TIME + 3.0)
            assert one.recv(1) == b""
            one.close()
        driver.send(json.dumps({"end": True}))
        until(lambda: server.ended)


def is_open(connection: socket.socket) -> bool:
    """Whether the other side has left a connection open on which it sends nothing."""
    connection.setblocking(False)
    try:
        return connection.recv(1, socket.MSG_PEEK) != b""
    except BlockingIOError:
        return True
    except ConnectionError:
        return False


def until(true: Callable[[], bool], seconds: float = 10.0) -> None:
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end
        time.sleep(0.01)


@pytest.mark.parametrize(
    "inside",
    [
        '<keyframe><key qpos="0"/></keyframe>',
        '<worldbody><replicate count="100000000"><geom size="1"/></replicate></worldbody>',
        '<asset><hfield nrow="100000" ncol="100000" size="1 1 1 1"/></asset>',
        '<asset><mesh name="m" file="pipe.stl"/></asset>',
        f"<worldbody>{5001 * '<geom/>'}</worldbody>",
    ],
)
def test_24_a_hull_without_end_is_refused(tmp_path: Path, inside: str) -> None:
    place = boats.written(tmp_path, "test_boat", boats.ROLL)
    os.mkfifo(place / "pipe.stl")
    (place / "hull.xml").write_text(f"<mujoco>{inside}</mujoco>")
    (tmp_path / "still.toml").write_text(f'vessel = "test_boat/"\n{STILL}')
    done = boatsim("run", tmp_path / "still.toml", "--out", tmp_path / "out")
    assert done.exit_code == 2 and done.stderr.count("\n") == 1 and "test_boat/" in done.stderr
    assert not (tmp_path / "out").exists()


class Resources(HTMLParser):
    """Every address that a page names, and every script or style that stands in a tag."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [
            f"{name}={value}" for name, value in attrs if name in ("src", "href", "style", "action")
        ]
        self.found += [name for name, _ in attrs if name.startswith("on")]


def test_22_the_page_fetches_nothing_and_may_run_its_own_script_alone(server: Server) -> None:
    with urlopen(server.address, timeout=5) as found:
        page, headers = found.read().decode(), found.headers
    policy = headers["Content-Security-Policy"]
    assert (
        "default-src 'none'" in policy
        and "unsafe" not in policy
        and f"connect-src ws://127.0.0.1:{server.port};" in policy
    )
    assert headers["Cache-Control"] == "no-store" and headers["Referrer-Policy"] == "no-referrer"
    reader = Resources()
    reader.feed(page)
    assert reader.found == ["href=data:,"]


def test_25_an_autopilot_is_heard_on_this_machine_only_and_alone() -> None:
    command = typer.main.get_command(app).commands["sitl"]
    addresses = [option.default for option in command.params if option.name == "address"]
    assert addresses == [LOOPBACK]
    assert parse_servo_packet(bytes(1000)) is None
    frame = struct.pack("<HHI16H", 18458, 50, 1, *[1500] * 16)
    with (
        AutopilotLink(LOOPBACK, 0, 5.0) as link,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as first,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as second,
    ):
        first.sendto(frame, (LOOPBACK, link.port))
        assert link.next_frame() is not None
        second.sendto(frame, (LOOPBACK, link.port))
        first.sendto(frame.replace(b"\1\0\0\0", b"\2\0\0\0"), (LOOPBACK, link.port))
        received = link.next_frame()
    assert received is not None and received.frame.counter == 2
    assert link.foreign == 1 and link.peer != second


def test_every_line_of_the_page_has_its_test() -> None:
    lines = {int(n) for n in re.findall(r"^(\d+)\. ", PAGE, re.MULTILINE)}
    tests = {
        int(n)
        for n in re.findall(r"^def test_(\d+)_", HERE.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert lines == tests == set(range(1, 26))


def test_the_page_states_the_limits_that_are() -> None:
    said = " ".join(PAGE.split())
    assert (
        f"at most {limits.MAX_COLUMNS} columns" in said
        and f"{limits.MAX_CELLS // 10**6} million cells" in said
    )
    assert (
        f"{limits.MAX_FILE_BYTES >> 30} GiB" in said
        and f"{limits.BYTES_PER_CELL} bytes for each cell" in said
    )
    assert (
        f"{MAX_TOML_BYTES >> 20} MiB, {MAX_DEPTH} nested tables" in said
        and f"at most {LONGEST} characters" in said
    )
    assert f"At most {MOST_WAITING} connections" in said and f"{HANDSHAKE_TIME:g} s" in said
    assert f"at most {hull_xml_check.MOST_ELEMENTS} elements" in said
    assert f"{hull_xml_check.LARGEST >> 20} MiB of XML" in said
    assert f"{hull_assets.LARGEST >> 20} MiB of meshes" in said
    assert f"{hull_xml_check.MOST_CELLS / 1e6:.3g} million pixels" in said
    assert f"at most {MESSAGE} bytes" in said and f"silent for {PATIENCE:g} s" in said
    assert limits.MEMORY_PER_BYTE == 12 and limits.MAX_HEADER_BYTES == 1 << 20
