"""Nothing is lost and nothing hangs: signals at any moment, a full disk, a process that is killed,
logs cut short."""

import json
import operator
import os
import re
import resource
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long

from boatsim import interruption
from boatsim.atomic_folder import atomic_folder
from boatsim.cli.run_many import shared_times
from boatsim.files import AppendedFile, replace_file
from boatsim.interruption import deferred_signals
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.signals import STATE as OF_HULLS
from boatsim.quiet import SIGNALS
from boatsim.recordings.table import Notes, Recording, read
from boatsim.simulate.camera_metric import CameraFrames, CameraMetricSet
from boatsim.simulate.growing_table import PIECE, FileTable, GrowingTable
from boatsim.simulate.metric import TooShort
from boatsim.view.rerun_command import rerun_command

FILES = {"recording.csv", "camera.csv", "recording.toml", "norms.json", "run.rrd", "report.html"}
ENDLESS = """
about = "Drifts for hours."
vessel = "trial_boat"
duration = 8e4
[controller]
use = "open_loop"
[measure]
use = "activity"
signal = "thrust_port_N"
since = 7e4
[[check]]
signal = "u_mps"
norm = "inf"
below = 9.0
"""
HANGS = """
from dataclasses import dataclass
from pathlib import Path
from boatsim.control.base import Controller

@dataclass
class Hangs(Controller):
    def step(self, sense, goal):
        if sense.t > 1.0:
            Path(__file__).with_name("hangs_now").touch()
        while sense.t > 1.0:
            pass
        return {}
"""
Finish = Callable[[], tuple[int, str]]
BEGUN: list["subprocess.Popen[str]"] = []  # processes of the present test


def heeding() -> None:
    """A shell that runs the tests in the background ignores SIGINT, which a child would inherit."""
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


def begin(*arguments: object, before: Callable[[], None] = heeding) -> "subprocess.Popen[str]":
    command = [sys.executable, "-m", "boatsim", *map(str, arguments)]
    pipe = subprocess.PIPE
    running = subprocess.Popen(
        command, stdout=pipe, stderr=pipe, text=True, start_new_session=True, preexec_fn=before
    )
    BEGUN.append(running)
    return running


@pytest.fixture(autouse=True)
def ends_what_it_began() -> Iterator[None]:
    """A test that fails leaves no endless run behind."""
    yield
    for running in BEGUN:
        if running.poll() is None:
            os.killpg(running.pid, signal.SIGKILL)
            running.communicate()
    BEGUN.clear()


def end(running: "subprocess.Popen[str]", within: float = 60.0) -> tuple[int, str]:
    """Exit code and stderr but for stages; whatever it started must have ended too, else its pipes
    were open."""
    try:
        said = running.communicate(timeout=within)[1]
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGKILL)
        raise
    return running.returncode, "".join(
        x for x in said.splitlines(True) if not x.startswith("progress: ")
    )


def wait_for(there: Callable[[], object], within: float = 180.0) -> None:
    until = time.monotonic() + within
    while not there():
        assert time.monotonic() < until, "it never came"
        time.sleep(0.05)


def logged(out: Path, least: float = 1.0) -> list[Path]:
    """Tables being written that have come as far as so many seconds."""
    found = list(out.parent.glob(f"{out.name}.part-*/recording.csv"))
    return [f for f in found if f.stat().st_size > 20_000 * least]


@pytest.fixture
def endless(tmp_path: Path) -> Path:
    (tmp_path / "endless.toml").write_text(ENDLESS)
    return tmp_path / "endless.toml"


# A run that somebody ends
# ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", long("SIGHUP")])
@pytest.mark.slow
def test_a_signal_ends_a_run_and_what_was_logged_is_kept_with_its_norms_so_far(
    name: str, endless: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    running = begin("run", endless, "--out", out)
    wait_for(lambda: logged(out))
    os.kill(running.pid, getattr(signal, name))
    assert end(running) == (130, "boatsim: interrupted; what was logged is kept\n")
    assert sorted(f.name for f in tmp_path.iterdir()) == ["endless.toml", "out"]
    assert {f.name for f in out.iterdir()} == FILES
    content = json.loads((out / "norms.json").read_text())
    assert content["complete"] is False
    assert content["norms"]["u_mps_inf"]["value"] < 9.0  # so far
    assert (
        content["norms"]["peak"]["value"] is None
        and content["norms"]["peak"]["lacking"] == "too short"
    )
    table, log = read(out / "recording.csv"), read(out / "run.rrd")
    np.testing.assert_allclose(log.t, table.t, atol=1e-9)
    assert table.t[-1] > 1.0 and len(table) == content["steps"] + 1
    command = [*rerun_command(), "rrd", "verify", str(out / "run.rrd")]
    assert subprocess.run(command, capture_output=True, check=False).returncode == 0


@pytest.mark.slow
def test_a_process_that_is_killed_leaves_all_but_the_last_second(
    endless: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    running = begin("run", endless, "--out", out)
    wait_for(lambda: logged(out) and list(tmp_path.glob("out.part-*/norms.json")))
    time.sleep(1.0)
    begun = time.time()
    running.kill()
    end(running)
    (left,) = tmp_path.glob("out.part-*")
    assert {f.name for f in left.iterdir()} - {f.name for f in left.glob("*.part-*")} == FILES - {
        "report.html"
    } and not out.exists()
    content = json.loads((left / "norms.json").read_text())
    assert (
        content["complete"] is False
        and content["steps"] > 0
        and content["norms"]["u_mps_inf"]["value"] < 9.0
    )
    assert content["norms"]["peak"]["lacking"] == "too short"
    for name in ("recording.csv", "camera.csv", "run.rrd"):
        assert begun - (left / name).stat().st_mtime < 1.0
    table, log, seen = (read(left / name) for name in ("recording.csv", "run.rrd", "camera.csv"))
    assert seen.notes.vessel == "trial_boat"
    together = min(len(table), len(log))
    np.testing.assert_allclose(table["u_mps"][:together], log["u_mps"][:together], atol=1e-9)
    assert (left / "recording.csv").read_bytes().endswith(b"\n")


@pytest.mark.parametrize("wait", [0.06, 0.3, pytest.param(0.7, marks=pytest.mark.slow), 1.0])
def test_ctrl_c_in_the_first_moments_is_quiet(wait: float, endless: Path, tmp_path: Path) -> None:
    running = begin("run", endless, "--out", tmp_path / "out")
    time.sleep(wait)
    os.kill(running.pid, signal.SIGINT)
    code, said = end(running)
    # Python itself was interrupted while it started, before the first line of ours
    if code == -signal.SIGINT or (code == 1 and "boatsim" not in said):
        assert wait < 0.1
        return
    assert (
        code == 130 and said.count("\n") <= 1 and re.fullmatch("(boatsim: interrupted.*\n)?", said)
    ), said
    assert not list(tmp_path.glob("out.part-*"))


@pytest.mark.slow
def test_a_compiler_at_work_does_not_swallow_a_ctrl_c(
    endless: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BOATSIM_CACHE", str(tmp_path / "cache"))  # empty: all is compiled
    for wait in (1.5, 2.5, 3.5):
        running = begin("run", endless, "--out", tmp_path / "out")
        time.sleep(wait)
        os.kill(running.pid, signal.SIGINT)
        begun = time.monotonic()
        code, said = end(running)
        assert code == 130 and said.startswith("boatsim: interrupted") and said.count("\n") == 1, (
            said
        )
        assert time.monotonic() - begun < 10.0


@pytest.mark.slow
def test_a_controller_that_hangs_ends_at_the_second_ctrl_c(endless: Path, tmp_path: Path) -> None:
    (tmp_path / "hangs.py").write_text(HANGS)
    endless.write_text(ENDLESS.replace('"open_loop"', '"hangs.py"'))
    running = begin("run", endless, "--out", tmp_path / "out", "--trust")
    wait_for((tmp_path / "hangs_now").exists)
    os.kill(running.pid, signal.SIGINT)
    time.sleep(0.5)  # two signals that come at once may be delivered as one
    assert (
        running.poll() is None
    )  # the first one is only noted, because the controller never returns
    os.kill(running.pid, signal.SIGINT)
    assert end(running)[0] == 130
    assert 0.9 < read(tmp_path / "out" / "recording.csv").t[-1] <= 1.1


@pytest.fixture
def listening(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """This process hears signals, whatever started it ignores; what it heard is forgotten
    afterwards."""
    monkeypatch.setattr(interruption, "_received", False)
    before = {s: signal.signal(s, signal.default_int_handler) for s in SIGNALS}
    yield
    for s, handler in before.items():
        signal.signal(s, handler)


@pytest.mark.usefixtures("listening")
def test_signals_wait_while_files_are_moved_and_count_afterwards(tmp_path: Path) -> None:
    with deferred_signals() as stop, atomic_folder(tmp_path / "out") as new:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            stop.finish()
            os.kill(os.getpid(), number)
        (new / "a").write_text("whole")
    assert stop() and (tmp_path / "out" / "a").read_text() == "whole"
    assert [f.name for f in tmp_path.iterdir()] == ["out"]
    with pytest.raises(KeyboardInterrupt), deferred_signals():
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)


# Workers
# -------------------------------------------------------------------------------------------------------------


def test_reading_the_times_of_runs_may_be_interrupted_anywhere() -> None:
    """Ctrl-C while the parent reads them must not leave a lock taken, for which workers wait."""
    context = get_context("spawn")
    times = shared_times(context, 2)

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        for i in range(300):
            with suppress(KeyboardInterrupt):
                signal.setitimer(signal.ITIMER_REAL, 2e-5 + 5e-7 * i)
                while True:
                    assert times[0] == 0.0
    finally:
        signal.signal(signal.SIGALRM, before)
    worker = context.Process(target=operator.setitem, args=(times, 0, 1.0))
    worker.start()
    worker.join(timeout=30.0)
    worker.kill()
    assert times[0] == 1.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "all_of_them"), [("SIGTERM", True), long("SIGHUP", True), ("SIGINT", False)]
)
def test_workers_keep_what_they_have_when_a_signal_comes(
    name: str, all_of_them: bool, endless: Path, tmp_path: Path
) -> None:
    running, out = _two(endless, tmp_path)
    (os.killpg if all_of_them else os.kill)(running.pid, getattr(signal, name))
    assert end(running) == (130, "boatsim: interrupted; what was logged is kept\n")
    assert all({f.name for f in (out / n).iterdir()} == FILES for n in ("endless", "other"))
    assert sorted(f.name for f in out.iterdir()) == ["endless", "other"]


@pytest.mark.slow
def test_workers_end_with_a_parent_that_is_killed_and_keep_what_they_have(
    endless: Path, tmp_path: Path
) -> None:
    running, out = _two(endless, tmp_path)
    running.kill()
    end(running)  # they hold its pipes as long as they live
    assert sorted(f.name for f in out.iterdir()) == ["endless", "other"]
    assert all({f.name for f in (out / n).iterdir()} == FILES for n in ("endless", "other"))


def _two(endless: Path, tmp_path: Path) -> tuple["subprocess.Popen[str]", Path]:
    """Two of them at work."""
    (tmp_path / "other.toml").write_text(ENDLESS)
    out = tmp_path / "out"
    running = begin("run", endless, tmp_path / "other.toml", "--jobs", 2, "--out", out)
    wait_for(lambda: all(logged(out / name) for name in ("endless", "other")))
    return running, out


# A disk that is full: here a limit on the size of a file, at which writing fails in the same place
# ------------------


def _small(most: int) -> None:
    heeding()
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))


@pytest.mark.slow
def test_a_run_on_a_full_disk_ends_with_one_line_and_keeps_what_was_whole(
    endless: Path, tmp_path: Path
) -> None:
    running = begin("run", endless, "--out", tmp_path / "out", before=partial(_small, 2_000_000))
    code, said = end(running)
    (left,) = tmp_path.glob("out.part-*")
    assert code == 2 and said.count("\n") == 1 and f"stays in {left}" in said, said
    assert not (tmp_path / "out").exists()
    table = read(left / "recording.csv")
    assert table.t[-1] > 1.0 and (left / "recording.csv").read_bytes().endswith(b"\n")
    log = read(left / "run.rrd")
    together = min(len(table), len(log))
    np.testing.assert_allclose(table["u_mps"][:together], log["u_mps"][:together], atol=1e-9)


@pytest.mark.slow
def test_a_comparison_on_a_full_disk_ends_with_one_line_and_leaves_what_was_there(
    tmp_path: Path,
) -> None:
    t = 0.2 * np.arange(75)
    rows = [f"{a:.3f},{0.15 * np.exp(-0.03 * a) * np.cos(2.46 * a):.6f}" for a in t]
    (tmp_path / "run.csv").write_text("\n".join(["t_s,phi_rad", *rows]) + "\n")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "compare.csv").write_text("earlier")
    boat = ["--vessel", "kvlcc2_roll", "--out", tmp_path / "out"]
    code, said = end(begin("compare", tmp_path / "run.csv", *boat, before=partial(_small, 10_000)))
    said = "".join(
        line for line in said.splitlines(keepends=True) if not line.startswith("progress: ")
    )
    assert code == 2 and said.count("\n") == 1 and "File too large" in said, said
    assert [f.name for f in (tmp_path / "out").iterdir()] == ["compare.csv"]
    assert (tmp_path / "out" / "compare.csv").read_text() == "earlier"
    assert sorted(f.name for f in tmp_path.iterdir()) == ["out", "run.csv"]


def test_of_a_piece_that_does_not_fit_nothing_stays(tmp_path: Path) -> None:
    class Full:
        """A file with room for ten bytes, five at a time."""

        def __init__(self) -> None:
            self.content, self.at = bytearray(), 0

        def seek(self, at: int) -> None:
            self.at = at

        def truncate(self, size: int) -> None:
            del self.content[size:]

        def write(self, data: bytes) -> int:
            if self.at >= 10:
                raise OSError(28, "No space left on device")
            part = data[: min(5, 10 - self.at)]
            self.content[self.at : self.at + len(part)] = part
            self.at += len(part)
            return len(part)

    full: Any = Full()
    file = AppendedFile(full, Path("log"))
    file.append(b"sevenby")
    with pytest.raises(OSError, match="No space left on device") as caught:
        file.append(b"another")
    assert caught.value.filename == "log" and full.content == b"sevenby"
    file.append(b"two")
    assert full.content == b"sevenbytwo"


# Files that appear together
# ------------------------------------------------------------------------------------------


def test_a_temporary_name_is_visible_says_what_it_is_and_goes(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), replace_file(tmp_path / "run.csv") as temporary:
        temporary.write_text("half")
        assert temporary.name == f"run.part-{os.getpid()}.csv"
        raise ZeroDivisionError
    assert not list(tmp_path.iterdir())


def test_a_folder_where_a_file_should_be_costs_nothing_that_is_there(tmp_path: Path) -> None:
    (tmp_path / "out" / "b").mkdir(parents=True)
    (tmp_path / "out" / "a").write_text("earlier")
    with pytest.raises(Exception, match="b: is a folder"), atomic_folder(tmp_path / "out") as new:
        (new / "a").write_text("new")
        (new / "b").write_text("new")
    assert (tmp_path / "out" / "a").read_text() == "earlier" and len(list(tmp_path.iterdir())) == 1


# Logs in a file, and short ones
# --------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [0, 1, PIECE - 1, PIECE, PIECE + 1, 3 * PIECE + 7])
def test_a_log_in_a_file_is_the_one_in_memory(count: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(count)
    logs: Sequence[GrowingTable] = (
        GrowingTable(["t_s", "a", "b"], 2),
        FileTable(["t_s", "a", "b"], tmp_path),
    )
    for i in range(count):
        row = [float(i), *rng.standard_normal(2)]
        for log in logs:
            if i % 7 == 3:  # the last row so far changes, before and after a look at all of it
                log.rows(0, log.count)
                log.replace_last_values(2, np.array([-1.0]))
            log.append_row(row)
    for start, stop in (
        (0, count),
        (count // 2, count),
        (max(count - 3, 0), count),
        (0, count // 3),
    ):
        np.testing.assert_array_equal(logs[0].rows(start, stop), logs[1].rows(start, stop))
    assert not list(tmp_path.iterdir())  # it has no name


MEASURES = shipped_content_names("measure")


@pytest.mark.parametrize("rows", [0, 1, 2, 5])
@pytest.mark.parametrize("name", MEASURES)
def test_a_measure_of_a_short_log_has_numbers_or_says_that_it_is_too_short(
    name: str, rows: int
) -> None:
    """Of boats that move and of such that lie still; no warning, no infinite number, no other
    error."""
    made = load_class("measure", name)()
    for slope in (0.0, 0.3, -0.3):
        t = 0.02 * np.arange(rows)
        signals = [s.column for s in OF_HULLS] + [
            "jet_rad",
            "delta_rad",
            "rudder_rad",
            "thrust_N",
            "reference_helm_rad",
            "reference_x_m",
            "reference_y_m",
            "reference_course_rad",
            "steer_port_rad",
            "contacts",
        ]
        log = Recording(
            "short",
            t,
            {n: slope * (1.0 + np.sin(i + 9.0 * t)) for i, n in enumerate(signals)},
            Notes(),
        )
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            if isinstance(made, CameraMetricSet):
                place = np.zeros((rows, 2))
                found = made.values_from_frames(
                    CameraFrames(t, slope * t, {"bow": place}, place, slope * t)
                )
                assert found == {}
                continue
            try:
                found = made.values(log)
            except TooShort:
                continue
        assert rows > 0 or not found
        assert (
            found.keys() <= type(made).units.keys() and np.isfinite(list(found.values())).all()
        ), found


@pytest.mark.parametrize(
    "name", ["activity", "heading_hold", "tracking", "zigzag_swings", "step_response"]
)
def test_a_log_that_ends_before_a_measure_begins_is_too_short(name: str) -> None:
    signals = ("psi_rad", "delta_rad", "jet_rad", "u_mps", "v_mps", "r_radps")
    log = Recording("early", np.arange(5.0), {n: np.arange(5.0) for n in signals}, Notes())
    with pytest.raises(TooShort, match="early: 0 rows"):
        load_class("measure", name)(since=10.0).values(log)
