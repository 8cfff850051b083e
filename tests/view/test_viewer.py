"""A run that somebody watches: at the pace of the clock, in a window or a browser, and it never
waits for either."""

import os
import re
import signal
import socket
import subprocess
import sys
import time
from functools import partial
from pathlib import Path
from urllib.request import urlopen

import pytest
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.simulate import scenario
from boatsim.simulate.real_time_pace import Pace
from boatsim.simulate.run import Simulation
from boatsim.simulate.run_options import RunOptions
from boatsim.view import viewer


class Clock:
    """A clock that goes on while somebody sleeps, and by what work takes."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


@pytest.mark.parametrize("speed", [0.5, 1.0, 4.0])
def test_a_run_takes_its_time_divided_by_the_speed(speed: float) -> None:
    clock = Clock()
    pace = Pace(speed, clock, clock.sleep)
    for step in range(1001):
        clock.now += 1e-4  # of work
        pace.wait_until(0.01 * step)
    assert clock.now - 100.0 == pytest.approx(10.0 / speed, rel=1e-3)


def test_a_run_that_was_held_up_goes_on_at_its_pace_and_does_not_rush() -> None:
    clock = Clock()
    pace = Pace(1.0, clock, clock.sleep)
    for step in range(201):
        if step == 100:
            clock.now += 30.0
        pace.wait_until(0.01 * step)
    assert clock.now - 100.0 == pytest.approx(32.0, abs=0.02)


def test_whoever_stops_a_run_does_not_wait_for_its_clock() -> None:
    clock = Clock()
    pace = Pace(1e-3, clock, clock.sleep)
    pace.wait_until(0.0)
    pace.wait_until(10.0, lambda: clock.now > 101.0)
    assert clock.now < 102.0


def test_a_paced_run_is_the_same_run() -> None:
    made = scenario.load("joystick_boat/sway_1")
    clock = Clock()
    paced = RunOptions(pace=Pace(1.0, clock, clock.sleep))
    whole = Simulation(made).run().recording
    other = Simulation(made, paced).run().recording
    assert (whole["x_m"] == other["x_m"]).all() and clock.now - 100.0 == pytest.approx(
        other.t[-1], abs=0.1
    )


def boatsim(*arguments: object):
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def test_without_a_display_it_is_said_in_one_line_where_the_run_can_be_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(viewer, "_is_listening", lambda port: False)
    monkeypatch.setattr(viewer, "has_display", lambda: False)
    monkeypatch.setattr(Pace, "wait_until", lambda *_: pytest.fail("nobody watches"))
    done = boatsim("run", "joystick_boat/sway_1", "--live", "--out", tmp_path / "out")
    assert done.exit_code == 0 and (tmp_path / "out" / "run.rrd").is_file()
    (line,) = done.stderr.splitlines()
    assert (
        line.startswith("boatsim: no viewer") and "--serve" in line and "http://127.0.0.1:" in line
    )


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--speed", "2"], "--speed = 2"),
        (["--live", "--speed", "fast"], "0 or more"),
        (["--live", "--speed", "-1"], "0 or more"),
        (["--live", "--speed", "nan"], "0 or more"),
        (["--serve", "--jobs", "2", "joystick_boat/sway_2"], "one run at a time"),
    ],
)
def test_what_can_not_be_shown_is_refused_before_it_runs(
    tmp_path: Path, options: list[str], said: str
) -> None:
    done = boatsim("run", "joystick_boat/sway_1", *options, "--out", tmp_path / "out")
    assert done.exit_code == 2 and said in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def served(tmp_path: Path, *options: str) -> tuple["subprocess.Popen[str]", str]:
    """A run with --serve under way, and the address of its page."""
    command = [sys.executable, "-m", "boatsim", "run", "joystick_boat/sway_1", "--serve", *options]
    running = subprocess.Popen(
        [*command, "--out", str(tmp_path / "out")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),  # whatever started us
    )
    assert running.stderr is not None
    page = re.search(r"http://127\.0\.0\.1:\d+/\?url=\S+", running.stderr.readline())
    assert page, running.communicate()
    return running, page[0]


def port_of(page: str) -> int:
    found = re.search(r":(\d+)/", page)
    assert found
    return int(found[1])


def listens(port: int) -> bool:
    with socket.socket() as tried:
        return tried.connect_ex(("127.0.0.1", port)) == 0


@pytest.mark.slow
def test_the_page_is_there_while_the_run_is_and_gone_with_it(tmp_path: Path) -> None:
    running, page = served(tmp_path, "--speed", "4")
    with urlopen(page, timeout=10) as answer:
        assert answer.status == 200 and b"erun" in answer.read()
    assert running.wait(60) == 0 and not listens(port_of(page))
    assert {"recording.csv", "run.rrd", "norms.json"} <= {
        f.name for f in (tmp_path / "out").iterdir()
    }


@pytest.mark.slow
def test_ctrl_c_ends_a_watched_run_at_once_keeps_it_and_takes_the_page_away(tmp_path: Path) -> None:
    running, page = served(tmp_path, "--speed", "0.01")
    until = time.monotonic() + 30
    while not any(tmp_path.glob("out.part-*/recording.csv")) and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(0.5)
    os.kill(running.pid, signal.SIGINT)
    _, said = running.communicate(timeout=30)
    assert running.returncode == 130 and "interrupted; what was logged is kept" in said
    assert not listens(port_of(page)) and (tmp_path / "out" / "recording.csv").stat().st_size > 0
