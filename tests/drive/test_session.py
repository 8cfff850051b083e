"""A boat driven by hand: what the sticks set, who may hold them, what is recorded, what stops when
they are let go."""

import asyncio
import json
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import chrome
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.drive.background_tasks import background_listener
from boatsim.drive.clock import Clock
from boatsim.drive.driver_input import DEAD, PATIENCE, DriverInput, Sticks, apply_dead_zone
from boatsim.drive.server import ABANDONED, Server
from boatsim.drive.session import Session
from boatsim.drive.stick_mapping import stick_mappings_for
from boatsim.drive.task import DriveTask
from boatsim.errors import BadInput
from boatsim.physics.content import shipped_content_names
from boatsim.recordings.table import Recording, read
from boatsim.simulate import scenario, tracking_errors
from boatsim.simulate.manoeuvre import complete_manoeuvring_table
from boatsim.simulate.run import run as simulate

pytest.importorskip("websockets")

ways = st.floats(-1.0, 1.0)
JOYSTICK = ["joystick_boat", "--controller", "l1_joystick"]


# Hands
# ----------------------------------------------------------------------------------------------------------------


class Time:
    """A clock that a test sets."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


def test_nothing_starts_up_before_the_sticks_were_in_the_middle() -> None:
    hands = DriverInput(Time())
    hands.store_sticks(Sticks(surge=1.0), 0.0)
    assert hands.sticks() is None
    hands.store_sticks(Sticks(), 0.0)
    hands.store_sticks(Sticks(surge=1.0), 0.0)
    assert hands.sticks() == Sticks(surge=1.0)


@pytest.mark.parametrize("why", ["page closed", "page hidden"])
def test_sticks_that_were_let_go_count_again_from_the_middle_on(why: str) -> None:
    hands = DriverInput(Time())
    hands.store_sticks(Sticks(), 0.0)
    hands.release(why)
    hands.store_sticks(Sticks(yaw=-0.5), 0.0)
    assert hands.sticks() is None and hands.release_reason == why
    hands.store_sticks(Sticks(), 0.0)
    assert hands.sticks() == Sticks() and not hands.release_reason


def test_a_page_that_falls_silent_holds_no_sticks() -> None:
    clock = Time()
    hands = DriverInput(clock)
    hands.store_sticks(Sticks(), 0.0)
    hands.store_sticks(Sticks(surge=1.0), 0.0)
    clock.now += 0.9 * PATIENCE
    assert hands.sticks() is not None
    clock.now += 0.2 * PATIENCE
    assert hands.sticks() is None and "no message" in hands.release_reason


@given(ways)
def test_a_stick_is_dead_about_the_middle_and_whole_at_its_ends(way: float) -> None:
    assert (apply_dead_zone(way) == 0.0) if abs(way) < DEAD else (apply_dead_zone(way) * way >= 0.0)
    assert (
        abs(apply_dead_zone(way)) <= 1.0 and apply_dead_zone(1.0) == -apply_dead_zone(-1.0) == 1.0
    )
    assert apply_dead_zone(-way) == -apply_dead_zone(way)


# What they set
# --------------------------------------------------------------------------------------------------------


def of_hands() -> list[str]:
    """Vessels that can be driven by their channels."""
    found = []
    for name in shipped_content_names("vessel"):
        try:
            DriveTask(name)
        except BadInput:
            continue
        found.append(name)
    return found


@pytest.mark.parametrize("name", of_hands())
@settings(max_examples=20)
@given(sticks=st.builds(Sticks, ways, ways, ways))
def test_hands_on_the_channels_stay_within_their_ranges_and_leave_them_neutral_in_the_middle(
    name: str, sticks: Sticks
) -> None:
    task = DRIVEN.setdefault(name, DriveTask(name))
    taken = task.vessel.commands
    asked = task.dials.goal_from_sticks(sticks, 0.02, 0.0)
    assert all(
        taken[key].low - 1e-6 <= value <= taken[key].high + 1e-6 for key, value in asked.items()
    )
    assert task.dials.goal_from_sticks(Sticks(), 0.02, 0.0) == pytest.approx(
        {key: taken[key].neutral for key in asked}, abs=1e-6
    )


DRIVEN: dict[str, DriveTask] = {}


def test_most_vessels_can_be_driven_and_who_is_driven_ahead_goes_ahead() -> None:
    assert len(of_hands()) >= 15
    for name in ("joystick_boat", "otter", "catamaran", "kvlcc2"):
        task = DriveTask(name)
        ahead = task.dials.goal_from_sticks(Sticks(surge=1.0), 0.02, 0.0)
        assert all(
            ahead[n] * value > 0.0
            for n, value in complete_manoeuvring_table(task.vessel).ahead.items()
        )


@pytest.mark.parametrize("controller", ["l1_joystick", "pid_autopilot"])
def test_the_sticks_of_a_joystick_controller_ask_for_its_three_goals_either_way(
    controller: str,
) -> None:
    task = DriveTask("joystick_boat", controller=controller)
    full = task.dials.goal_from_sticks(Sticks(1.0, 1.0, 1.0), 0.02, 0.0)
    assert set(full) == {"surge_mps", "sway_mps", "yaw_radps"} and all(
        x > 0.0 for x in full.values()
    )
    assert task.dials.goal_from_sticks(Sticks(-1.0, -1.0, -1.0), 0.02, 0.0) == {
        key: -x for key, x in full.items()
    }


def test_a_goal_that_is_a_heading_is_turned_from_where_the_boat_points() -> None:
    task = DriveTask("jet_ski", controller="l1_heading")
    assert task.dials.goal_from_sticks(Sticks(), 0.02, 1.5)["psi_rad"] == 1.5
    turned = [task.dials.goal_from_sticks(Sticks(yaw=1.0), 0.02, 9.9)["psi_rad"] for _ in range(50)]
    assert np.all(np.diff(turned) > 0.0)
    task.dials.reset_heading()
    assert task.dials.goal_from_sticks(Sticks(), 0.02, -0.5)["psi_rad"] == -0.5


def test_a_controller_states_its_largest_goals_and_a_load_of_its_own_changes_nothing() -> None:
    task = DriveTask("joystick_boat", "berth")
    made = scenario.load("joystick_boat/berth")
    assert (
        stick_mappings_for(made.vessel, made.controller, "l1_joystick").goal_from_sticks(
            Sticks(yaw=1.0), 0.02, 0.0
        )["yaw_radps"]
        == 0.1396
    )
    assert task.scenario.file.tank == made.file.tank and task.scenario.file.load == made.file.load


def boatsim(*arguments: object):
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


@pytest.mark.parametrize(
    ("given_", "said"),
    [
        (["joystik_boat"], "did you mean 'joystick_boat'?"),
        (["joystick_boat", "--controller", "zigzag"], "takes no goals"),
        (["joystick_boat", "--controller", "l1_thesis"], "takes no goals"),
        (["joystick_boat", "--controller", "pd_heading"], "sets throttle"),
        (["joystick_boat", "--scenario", "brth"], "did you mean 'joystick_boat/berth'?"),
        (["joystick_boat", "--scenario", "otter/turn"], "is for otter, not for joystick_boat"),
        (["joystick_boat", "--scenario", "joystick_boat"], "name one"),
        (["joystick_boat", "--load", "heavi"], "heav"),
        (["catamaran", "--controller", "waypoint"], "takes the goals x_m, y_m; the sticks"),
        (["joystick_boat", "--seconds", "0"], "--seconds"),
    ],
)
def test_what_can_not_be_driven_is_one_line(tmp_path: Path, given_: list[str], said: str) -> None:
    done = boatsim("drive", *given_, "--out", tmp_path / "out")
    assert done.exit_code == 2 and said in done.stderr and done.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir())


# Off, on time, beside
# -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("engine", ["mujoco", "twin"])
def test_while_a_goal_is_off_commands_are_neutral_and_the_controller_begins_anew(
    engine: str,
) -> None:
    goals = [
        {"yaw_radps": 0.1, "sway_mps": 0.05},
        {"from": 4.0, "off": True},
        {"from": 8.0, "yaw_radps": 0.0},
    ]
    rows = 0.0 if engine == "mujoco" else 0.5  # [s] between them: the other may leap in between
    over = {"duration": 12.0, "goal": goals, "tank": None, "engine": engine, "log": rows}
    made = scenario.load("joystick_boat/berth", over)
    log = simulate(made).recording
    off = (log.t >= 4.0 + made.controller.period) & (log.t < 7.99)
    for name, channel in made.vessel.commands.items():
        if name in type(made.controller).commands:
            assert np.all(log[name][off] == channel.neutral) and np.ptp(log[name][~off]) > 0.0
    assert np.isnan(log["goal_yaw_radps"][off]).all()
    assert np.all(log["estimate_sigma_yaw_Nm"][off] == 0.0)
    # it holds the heading that it finds and does not swing back to the one before
    assert abs(log["psi_rad"][-1] - log["psi_rad"][log.t >= 7.99][0]) < 0.1 < log["psi_rad"][-1]


@pytest.mark.parametrize("name", shipped_content_names("controller"))
def test_a_controller_tells_the_same_estimates_after_it_was_reset(name: str) -> None:
    from boatsim.physics.content import load_class

    made = load_class("controller", name)()
    made.reset()
    before = set(made.estimates())
    made.reset()
    assert set(made.estimates()) == before


def test_control_periods_that_begin_late_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [50.0]
    clock = Clock(0.08)
    monkeypatch.setattr(clock, "_clock", lambda: now[0])
    monkeypatch.setattr(clock, "_sleep", lambda s: now.__setitem__(0, now[0] + s))
    for step in range(1, 101):
        if step == 40:  # control is due every four steps
            now[0] += 0.02 + 0.05
        if step == 60:
            now[0] += 5.0  # so far behind that the clock is set back
        clock.wait_until(0.02 * step)
    assert clock.periods == 25 and clock.late == 2 and clock.worst == pytest.approx(5.0, abs=0.1)


def rows(begin: int, end: int) -> Recording:
    t = 0.1 * np.arange(begin, end)
    return Recording("x", t, {"u_mps": np.sin(t), "goal_u_mps": np.cos(t)})


def test_what_is_handed_aside_arrives_whole_and_in_order_and_never_holds_up() -> None:
    came: list[Recording] = []
    gate = threading.Event()

    def slow(piece: Recording) -> None:
        gate.wait(10.0)
        came.append(piece)

    with background_listener(slow, 0.01) as put:
        for begin in range(0, 100, 5):
            put(rows(begin, begin + 5))
        assert not came  # all handed over while the first still waits
        gate.set()
    assert np.concatenate([c.t for c in came]) == pytest.approx(rows(0, 100).t)


def test_what_goes_wrong_aside_ends_the_run() -> None:
    def full(piece: Recording) -> None:
        raise OSError("no room")

    with pytest.raises(OSError, match="no room"), background_listener(full, 0.01) as put:
        put(rows(0, 5))


@given(st.lists(st.integers(1, 99), unique=True).map(sorted))
def test_errors_of_a_log_in_pieces_are_those_of_the_whole(cuts: list[int]) -> None:
    tally = tracking_errors.TrackingErrorSums()
    for begin, end in zip([0, *cuts], [*cuts, 100], strict=True):
        tally.add_rows(rows(begin, end))
    assert tally.metrics() == pytest.approx(tracking_errors.compute_errors(rows(0, 100)))


def until(true, seconds: float = 10.0) -> None:
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end
        time.sleep(0.01)


# A run
# ----------------------------------------------------------------------------------------------------------------


@contextmanager
def driving(
    out: Path, *arguments: object, descriptors: int = 1024
) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """`boatsim drive` with a limit of file descriptors under way, and the address of its page."""
    command = [
        *("bash", "-c", f'ulimit -n {descriptors}; exec "$@"', "bash"),
        sys.executable,
        "-m",
        "boatsim",
        "drive",
        *map(str, arguments),
        "--no-open",
        "--out",
        str(out),
    ]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert running.stderr
        found = re.search(r"http://127\.0\.0\.1:\d+/\S+/", running.stderr.readline())
        assert found, running.communicate()
        yield running, found[0]
    finally:
        running.terminate()
        running.communicate()


def by_hand(
    out: Path, course: Mapping[float, tuple[float, float, float]], *arguments: object
) -> None:
    """A run driven by sticks that are moved at times [s] of it, then ended by the button."""
    with driving(out, *arguments) as (running, page):
        asyncio.run(_moved(page, course))
        assert running.wait(60) == 0


async def _moved(page: str, course: Mapping[float, tuple[float, float, float]]) -> None:
    from websockets.asyncio.client import connect

    now = 0.0
    async with connect(
        page.replace("http", "ws") + "socket", origin=page.rsplit("/", 2)[0]
    ) as page_:

        async def look() -> None:
            nonlocal now
            async for message in page_:
                now = json.loads(message).get("frame", {}).get("t", now)

        looking = asyncio.ensure_future(look())
        while now < max(course):
            sticks = [way for t, way in course.items() if t <= now][-1]
            await page_.send(json.dumps({"sticks": sticks, "moved": time.time()}))
            await asyncio.sleep(0.02)
        await page_.send(json.dumps({"end": True}))
        await looking


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("drive") / "out"
    course = {
        0.0: (0, 0, 0),
        1.0: (0.7, 0, 0.5),
        3.0: (-0.4, 0.8, -1.0),
        5.0: (0, 0, 0),
        7.0: (0, 0, 0),
    }
    by_hand(out, course, "joystick_boat", "--scenario", "sway_1_wind")
    return out


@pytest.mark.slow
def test_what_was_driven_is_recorded_as_any_run(driven: Path) -> None:
    assert {
        "recording.csv",
        "camera.csv",
        "norms.json",
        "run.rrd",
        "report.html",
        "recording.toml",
        "scenario.toml",
    } == {f.name for f in driven.iterdir()}
    log = read(driven / "recording.csv")
    assert log.notes.facts["driven"] is True and log.notes.facts["complete"] is True
    assert np.nanmax(log["goal_surge_mps"]) > 0.1 > -0.1 > np.nanmin(log["goal_yaw_radps"])
    assert "surge_error_rms" in json.loads((driven / "norms.json").read_text())["norms"]


@pytest.mark.slow
def test_what_was_driven_runs_again_from_its_file_to_the_last_bit(
    driven: Path, tmp_path: Path
) -> None:
    done = boatsim("run", driven / "scenario.toml", "--out", tmp_path / "again")
    assert done.exit_code == 0, done.stderr
    assert (tmp_path / "again" / "recording.csv").read_bytes() == (
        driven / "recording.csv"
    ).read_bytes()


@pytest.mark.parametrize("command", ["replay", "compare", "check"])
def test_what_was_driven_is_a_recording_for_other_commands(
    driven: Path, tmp_path: Path, command: str
) -> None:
    out = [] if command == "check" else ["--out", tmp_path / command]
    done = boatsim(command, driven / "recording.csv", *out)
    assert done.exit_code == 0, done.output


@pytest.mark.slow
def test_what_was_driven_can_be_diagnosed(driven: Path, tmp_path: Path) -> None:
    done = boatsim("diagnose", driven / "camera.csv", "--out", tmp_path / "diagnosis")
    assert done.exit_code == 0 and (tmp_path / "diagnosis" / "report.html").is_file()


def test_goals_too_many_for_a_file_are_left_out_of_it_and_what_they_are_of_stays() -> None:
    task = DriveTask("joystick_boat", controller="l1_joystick")
    many = [
        (0.02 * i, {"surge_mps": 0.01 * (i % 50), "sway_mps": 0.0, "yaw_radps": 0.0})
        for i in range(40_000)
    ]
    assert task.scenario_toml(many, 800.0) is None
    assert "l1_joystick" in str(task.scenario_toml([], 800.0)) and "from" not in str(
        task.scenario_toml([], 800.0)
    )


@pytest.mark.slow
@pytest.mark.long
def test_a_flood_of_connections_without_file_descriptors_costs_neither_driver_nor_log(
    tmp_path: Path,
) -> None:
    out = tmp_path / "out"
    with driving(out, "otter", "--seconds", "60", descriptors=100) as (running, page):
        port = int(page.split(":")[2].partition("/")[0])
        flood = [socket.create_connection(("127.0.0.1", port)) for _ in range(300)]
        course = {0.0: (0, 0, 0), 1.0: (0.5, 0, 0), 3.0: (0, 0, 0)}
        asyncio.run(_moved(page, course))
        errors = running.communicate(timeout=60)[1]
        for one in flood:
            one.close()
    assert running.returncode == 0, errors
    assert "Traceback" not in errors and "accept" not in errors
    log = read(out / "recording.csv")
    assert log.t[-1] >= 3.0 and np.nanmax(log["sent_n_port_radps"]) > 10.0


def test_a_port_that_is_taken_is_one_line(tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = boatsim("drive", "otter", "--port", port, "--out", tmp_path / "out")
    assert done.exit_code == 2 and done.stderr.count("\n") == 1
    assert f"port {port}: " in done.stderr and "omit --port" in done.stderr


def test_nobody_waits_for_ever_where_the_package_is_missing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in [n for n in sys.modules if n.partition(".")[0] == "websockets"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "websockets", None)
    done = boatsim("drive", *JOYSTICK, "--out", tmp_path / "out")
    assert (
        done.exit_code == 2
        and 'pip install "boatsim[drive]"' in done.stderr
        and done.stderr.count("\n") == 1
    )


# In a real browser
# ----------------------------------------------------------------------------------------------------

in_browser = pytest.mark.skipif(
    chrome.PROGRAM is None, reason="there is no Chromium on this machine"
)


@pytest.fixture(scope="module")
def opened():
    if chrome.PROGRAM is None:
        pytest.skip("there is no Chromium on this machine")
    with chrome.chromium() as browser:
        yield browser


@pytest.mark.slow
def test_a_gamepads_stick_arrives_as_a_goal_and_a_closed_page_stops_the_thrusters(
    opened, tmp_path: Path
) -> None:
    with driving(tmp_path / "out", *JOYSTICK, "--seconds", 9) as (running, address):
        page = opened(address)
        page.until("frame && frame.t > 0.5 && !frame.away")
        page.run("push(0.2, -1.0, 0.5, 0.0)")
        page.until("frame.t > 4")
        page.close()
        said, told = running.communicate(timeout=60)
    assert running.returncode == 0, told
    assert re.search(
        "page (closed|hidden); commands are neutral", told
    )  # a tab that goes is hidden first
    log = read(tmp_path / "out" / "recording.csv")
    driven = np.isfinite(log["goal_surge_mps"])
    assert log["goal_surge_mps"][driven].max() > 0.6 and log["goal_yaw_radps"][driven].max() > 0.05
    away = log.t >= log.t[driven][-1] + 0.08 + 0.02  # one control period, and the row after it
    assert log.t[away][0] < 7.0
    for name in ("pwm_port", "pwm_starboard", "steer_port_rad", "steer_starboard_rad"):
        assert np.all(log[f"sent_{name}"][away] == 0.0) and log[f"sent_{name}"][driven].any()
    assert abs(log["actual_thrust_port_N"][-1]) < 1e-3


@pytest.mark.slow
def test_a_hidden_page_lets_go_and_takes_over_again_with_the_sticks_in_the_middle(
    opened, tmp_path: Path
) -> None:
    with driving(tmp_path / "out", "otter", "--seconds", 60) as (running, address):
        page = opened(address)
        page.until("frame && frame.t > 0.3 && !frame.away")
        page.run("push(0, -1, 0, 0)")
        page.until("frame.goals[0][0] > 50")
        page.run(
            "Object.defineProperty(document, 'hidden', {value: true, configurable: true});"
            "document.dispatchEvent(new Event('visibilitychange'))"
        )
        page.until("frame.away === 'page hidden' && frame.goals[0][0] === 0")
        page.run("Object.defineProperty(document, 'hidden', {value: false})")
        time.sleep(0.3)
        assert page.run("frame.away")  # the stick is still pushed
        page.run("push(0, 0, 0, 0)")
        page.until("!frame.away")
        page.run("push(0, -1, 0, 0)")
        page.until("frame.goals[0][0] > 50")
        page.run("document.getElementById('end').click()")
        page.until("over.startsWith('Saved to')")
        assert running.wait(30) == 0
        page.close()
    facts = read(tmp_path / "out" / "recording.csv").notes.facts
    assert [line.partition(": ")[2] for line in facts["sticks_let_go"]] == ["page hidden"]


@pytest.mark.slow
def test_a_run_that_goes_wrong_is_told_to_the_page(opened, tmp_path: Path) -> None:
    wild = tmp_path / "wild.py"
    wild.write_text(WILD)
    with driving(tmp_path / "out", "otter", "--controller", wild) as (running, address):
        page = opened(address)
        page.until(
            "over.startsWith('The run has ended: controller') && over.includes('out of hand')"
        )
        assert running.wait(30) == 2
        page.close()
    assert not (tmp_path / "out").exists()


WILD = """
from dataclasses import dataclass
from boatsim.control.base import Controller

@dataclass
class Wild(Controller):
    passes_on = True

    def step(self, sense, goal):
        if sense.t > 0.5:
            raise RuntimeError("out of hand")
        return {}
"""


@pytest.mark.slow
def test_keys_drive_too(opened, tmp_path: Path) -> None:
    with driving(tmp_path / "out", *JOYSTICK, "--seconds", 60) as (running, address):
        page = opened(address, "")
        page.until("frame && !frame.away")
        page.say("Input.dispatchKeyEvent", type="keyDown", code="KeyW", key="w")
        page.say("Input.dispatchKeyEvent", type="keyDown", code="ArrowLeft", key="ArrowLeft")
        page.until("frame.goals[0][0] > 0.6 && frame.goals[2][0] < -0.1")
        page.say("Input.dispatchKeyEvent", type="keyUp", code="KeyW", key="w")
        page.until("frame.goals[0][0] === 0 && frame.goals[2][0] < -0.1")
        page.run("document.getElementById('end').click()")
        assert running.wait(30) == 0
        page.close()


@pytest.fixture
def page_server() -> Iterator[Server]:
    with Server(DriverInput()) as made:
        yield made


def phone(page: chrome.Page) -> None:
    """The screen of a phone held upright."""
    page.resize(390, 844, mobile=True)


def test_while_the_boat_is_compiled_the_page_shows_it_and_takes_no_sticks(
    opened, page_server: Server
) -> None:
    session = Session(DriveTask(*JOYSTICK[:1], controller=JOYSTICK[2]), page_server, print)
    session.show_preparation()
    page = opened(page_server.address)
    page.until("hello && !document.getElementById('ready').hidden")
    assert "joystick_boat are being compiled" in page.run(
        "document.getElementById('ready').textContent"
    )
    first = page.run("document.querySelector('#ready progress').value")
    page.until(f"document.querySelector('#ready progress').value > {first}")
    drawn = (
        "[...$('sea').getContext('2d').getImageData(0, 0, $('sea').width, $('sea').height).data]"
    )
    assert page.run(f"new Set({drawn}).size") > 20  # water, grid and hull
    assert page.run("$('end').disabled") and page_server.hands.sticks() is None
    page_server.send_initial_data(session._painter.initial_data(ready=True))
    page.until("document.getElementById('ready').hidden && !$('end').disabled")
    until(lambda: page_server.hands.sticks() is not None)
    page.close()


def test_on_a_phone_water_sticks_and_the_button_are_on_the_first_screen(
    opened, page_server: Server
) -> None:
    session = Session(DriveTask("joystick_boat"), page_server, print)
    page_server.send_initial_data(session._painter.initial_data(ready=True))
    page = opened(page_server.address)
    phone(page)
    page.until("hello && hello.ready")
    for part in ("left", "right", "end", "sea"):
        box = page.run(f"JSON.stringify($('{part}').getBoundingClientRect())")
        edges = json.loads(box)
        assert 0 <= edges["top"] < edges["bottom"] <= 844, part
        assert 0 <= edges["left"] < edges["right"] <= 390, part
    assert page.run("$('sea').getBoundingClientRect().height") > 300
    page.close()


@pytest.mark.slow
@pytest.mark.long
def test_a_page_closed_before_the_sticks_were_moved_ends_the_run_and_leaves_nothing(
    opened, tmp_path: Path
) -> None:
    place = tmp_path / "new" / "run"
    with driving(place, *JOYSTICK) as (running, address):
        page = opened(address)
        page.until("frame && frame.t > 0.1")
        page.close()
        _, told = running.communicate(timeout=ABANDONED + 40)
    assert running.returncode == 130 and "nothing is saved" in told
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_page_that_is_closed_after_driving_ends_the_run_which_is_saved(
    opened, tmp_path: Path
) -> None:
    with driving(tmp_path / "out", *JOYSTICK) as (running, address):
        page = opened(address)
        page.until("frame && frame.t > 0.1 && !frame.away")
        page.run("push(0, -1.0, 0, 0)")
        page.until("frame.goals[0][0] > 0.1")
        page.close()
        _, told = running.communicate(timeout=ABANDONED + 40)
    assert running.returncode == 0, told
    log = read(tmp_path / "out" / "recording.csv")
    assert log.notes.facts["complete"] is True and log.t[-1] < ABANDONED + 30


@pytest.mark.slow
def test_a_page_that_is_loaded_again_goes_on_driving(opened, page_server: Server) -> None:
    assert not page_server.is_abandoned  # nobody has come yet
    page = opened(page_server.address)
    page.close()
    until(lambda: page_server._left_at is not None)
    again = opened(page_server.address)
    until(lambda: page_server._left_at is None)
    assert not page_server.is_abandoned
    again.close()
