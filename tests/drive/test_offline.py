"""The driver's page without a server: its size and policy, its agreement with the compiled engine,
its sticks and its files, and what a user reads where it is not possible."""

import json
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import chrome
import numpy as np
import pytest
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.drive import offline
from boatsim.drive.driver_input import Sticks, apply_dead_zone
from boatsim.drive.offline import offline_page, write_offline_page
from boatsim.drive.task import DriveTask
from boatsim.errors import BadInput
from boatsim.recordings.table import read
from boatsim.webassembly import compiler as compilers
from boatsim.webassembly.compiler import NoWasmCompiler, WasmCompiler, find_compiler
from boatsim.webassembly.packing import MOST_BYTES

VESSEL = "joystick_boat"
NO_COMPILER = WasmCompiler((), ())  # where the result of the compiler is replaced
BLOCKED = """
window.blocked = [];
addEventListener("securitypolicyviolation", e => blocked.push(e.violatedDirective + " " + e.blockedURI));
addEventListener("error", e => blocked.push(e.message));
addEventListener("unhandledrejection", e => blocked.push(String(e.reason)));
"""
# Drives without the clock: the sticks of each control period, [surge, sway, yaw]
DRIVE = """(() => {
  restart();
  away = "";
  const course = %s;
  sticks = course[0];
  control();
  keepRow();
  while (boat.time < course.length * model.period - 1e-6) {
    sticks = course[Math.min(Math.floor((boat.time + model.step) / model.period + 1e-6), course.length - 1)];
    away = sticks ? "" : "page hidden";
    sticks = sticks || [0, 0, 0];
    step();
  }
  return [recordingText().join(""), scenarioText()];
})()"""
WIND = f"""
vessel = "{VESSEL}"
duration = 60.0
controller = {{ use = "open_loop" }}
log = 0.5
start = {{ x = 3.0, psi = 0.4, u = 0.3, v = -0.1, r = 0.05 }}

[[effect]]
use = "fan_wind"
speed = 0.5

[[effect]]
use = "current"
north = 0.1
east = -0.05
"""


def boatsim(*arguments: object) -> Any:
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


@pytest.fixture(scope="module")
def compiler() -> WasmCompiler:
    try:
        return find_compiler()
    except NoWasmCompiler as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    if chrome.PROGRAM is None:
        pytest.skip("there is no Chromium on this machine")
    with chrome.chromium() as opened:
        yield opened


@pytest.fixture(scope="module")
def file(compiler: WasmCompiler, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("offline") / "page.html"
    write_offline_page(DriveTask(VESSEL, offline=True), path, compiler)
    return path


def opened_page(browser: Any, path: Path) -> Any:
    page = browser(path.as_uri(), chrome.GAMEPAD + BLOCKED)
    page.until("model && boat && frame || blocked.length || over")
    return page


@pytest.fixture
def page(browser: Any, file: Path) -> Iterator[Any]:
    opened = opened_page(browser, file)
    yield opened
    assert opened.run("blocked") == []
    opened.close()


# The file
# --------------------------------------------------------------------------------------------------


def test_the_page_contains_all_it_needs_under_a_policy_without_network(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(offline, "compile_driving_program", lambda *_: b"\0asm")
    text = offline_page(DriveTask(VESSEL, offline=True), NO_COMPILER)
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy and re.fullmatch(
        "default-src 'none'; script-src 'sha256-[^']+' 'wasm-unsafe-eval'; style-src 'sha256-[^']+'; "
        "img-src data:; base-uri 'none'; form-action 'none'",
        policy[1],
    )
    assert "http://" not in text and "https://" not in text and "src=" not in text
    assert "WebSocket" not in text and "<!-- " not in text
    found = re.search(r'<script type="application/json" id="model">(.*?)</script>', text)
    assert found
    content = json.loads(found[1])
    assert content["hello"]["vessel"] == VESSEL
    assert content["simulation"]["columns"][:3] == ["t_s", "x_m", "y_m"]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["joystik_boat"], "did you mean 'joystick_boat'?"),
        ([VESSEL, "--controller", "l1_joystick"], "--controller open_loop lets the sticks"),
        ([VESSEL, "--scenario", "sway_1_wind"], "has a [tank]; the offline page has open water"),
        (["catamaran", "--scenario", "speed_0"], "is written in Python"),
        ([VESSEL, "--port", "8000"], "--port does not apply with --offline"),
        ([VESSEL, "--live"], "--live does not apply with --offline"),
        ([VESSEL, "--out", "out"], "--out does not apply with --offline"),
    ],
)
def test_what_the_page_cannot_do_is_one_line(tmp_path: Path, given: list[str], said: str) -> None:
    done = boatsim("drive", *given, "--offline", tmp_path / "new" / "page.html")
    assert done.exit_code == 2 and said in done.stderr and done.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_without_a_compiler_nothing_is_written(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(compilers, "_candidates", list)
    done = boatsim("drive", VESSEL, "--offline", tmp_path / "new" / "page.html")
    assert done.exit_code == 2 and "boatsim[wasm]" in done.stderr
    assert done.stderr.count("\n") == 1 and not list(tmp_path.iterdir())


def test_a_folder_and_a_page_that_is_too_large_are_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    task = DriveTask(VESSEL, offline=True)
    with pytest.raises(BadInput, match="is a folder"):
        write_offline_page(task, tmp_path, NO_COMPILER)
    monkeypatch.setattr(offline, "offline_page", lambda *_: "x" * (MOST_BYTES + 1))
    with pytest.raises(BadInput, match="1,000,001 bytes; allowed are 1,000,000"):
        write_offline_page(task, tmp_path / "page.html", NO_COMPILER)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_equal_tasks_give_equal_pages_of_much_less_than_a_megabyte(
    compiler: WasmCompiler, file: Path, tmp_path: Path
) -> None:
    done = boatsim("drive", VESSEL, "--offline", tmp_path / "again.html")
    assert done.exit_code == 0 and "needs no server" in done.stdout, done.stderr
    assert (tmp_path / "again.html").read_bytes() == file.read_bytes()
    assert file.stat().st_size < 0.1 * MOST_BYTES


# Its physics
# --------------------------------------------------------------------------------------------------


def course(periods: int) -> list[list[float] | None]:
    """Sticks of each control period; None while no driver holds them."""
    rng, found = np.random.default_rng(1), list[list[float] | None]()
    for i in range(periods):
        if i % 12 == 0:
            sticks = np.round(rng.uniform(-1.2, 1.2, 3).clip(-1.0, 1.0), 3).tolist()
        found.append(None if 60 <= i < 70 else sticks)
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    ("vessel", "engine"),
    [(VESSEL, "mujoco"), ("otter", "compiled"), ("jet_ski", "mujoco"), ("eastward_ho", "compiled")],
)
def test_the_page_simulates_what_the_engines_do(
    vessel: str, engine: str, compiler: WasmCompiler, browser: Any, tmp_path: Path
) -> None:
    write_offline_page(DriveTask(vessel, offline=True), tmp_path / "page.html", compiler)
    assert {"x_m", "psi_rad", "u_mps"} <= compare_with_engine(browser, tmp_path, engine)


@pytest.mark.slow
def test_water_wind_start_and_log_are_those_of_a_scenario(
    compiler: WasmCompiler, browser: Any, tmp_path: Path
) -> None:
    (tmp_path / "current.toml").write_text(WIND)
    task = DriveTask(VESSEL, str(tmp_path / "current.toml"), offline=True)
    write_offline_page(task, tmp_path / "page.html", compiler)
    assert {"wind_X_N", "wind_Y_N"} <= compare_with_engine(browser, tmp_path, "compiled")


@pytest.mark.slow
def test_six_degrees_of_freedom_in_waves_agree_too(
    compiler: WasmCompiler, browser: Any, tmp_path: Path
) -> None:
    task = DriveTask("otter", "beam_sea", "open_loop", offline=True)
    write_offline_page(task, tmp_path / "page.html", compiler)
    assert {"z_m", "phi_rad", "q_radps"} <= compare_with_engine(browser, tmp_path, "compiled")


def compare_with_engine(browser: Any, folder: Path, engine: str) -> set[str]:
    """Drive in the page, repeat its scenario in Python, compare all columns, and return them."""
    page = opened_page(browser, folder / "page.html")
    recording, scenario = page.run(DRIVE % json.dumps(course(250)))
    assert page.run("blocked") == []
    page.close()
    (folder / "page.csv").write_text(recording)
    text = scenario.replace('engine = "compiled"', f'engine = "{engine}"')
    assert engine in text or engine == "mujoco"
    (folder / "scenario.toml").write_text(text)
    done = boatsim("run", folder / "scenario.toml", "--out", folder / "run")
    assert done.exit_code == 0, done.stderr
    of_page, of_engine = read(folder / "page.csv"), read(folder / "run" / "recording.csv")
    assert len(of_page.t) == len(of_engine.t)
    assert np.abs(of_page.t - of_engine.t).max() < 1e-9
    assert np.ptp(of_page["x_m"]) > 0.2 and set(of_page.signals) <= set(of_engine.signals)
    for name, signal in of_page.signals.items():
        size = max(1.0, float(np.abs(of_engine[name]).max()))
        assert np.abs(signal - of_engine[name]).max() < 1e-9 * size, name
    return set(of_page.signals)


# Its sticks
# --------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_sticks_of_the_page_set_the_commands_of_the_served_page(page: Any) -> None:
    task = DriveTask(VESSEL, offline=True)
    ways = np.round(np.linspace(-1.0, 1.0, 401), 3).tolist()
    of_page = page.run(f"{json.dumps(ways)}.map(x => commandsOf([x, -x, 0.5 * x]))")
    zones = page.run(f"{json.dumps(ways)}.map(beyondDeadZone)")
    assert zones == [apply_dead_zone(x) for x in ways]
    for x, commands in zip(ways, of_page, strict=True):
        held = Sticks(*map(apply_dead_zone, (x, -x, 0.5 * x)))
        wanted = task.dials.goal_from_sticks(held, 0.08, 0.0)
        assert commands == pytest.approx(wanted, abs=1e-12)


@pytest.mark.slow
def test_a_gamepad_keys_and_a_dragged_stick_drive_in_real_time(page: Any) -> None:
    page.until("frame.t > 0.2 && !frame.away")
    begin = page.run("[performance.now() / 1000, frame.t]")
    page.run("push(0, -1.0, 0.5, 0)")
    page.until("frame.goals[0][0] > 100 && frame.goals[2][0] < -0.1")
    time.sleep(1.0)
    now = page.run("[performance.now() / 1000, frame.t]")
    assert abs((now[1] - begin[1]) - (now[0] - begin[0])) < 0.3
    page.run("push(0, 0, 0, 0)")
    page.say("Input.dispatchKeyEvent", type="keyDown", code="KeyS", key="s")
    page.until("frame.goals[0][0] < -100")
    page.say("Input.dispatchKeyEvent", type="keyUp", code="KeyS", key="s")
    page.until("frame.goals[0][0] === 0")
    middle = page.run(
        "(b => [b.x + b.width / 2, b.y + b.height / 2])($('left').getBoundingClientRect())"
    )
    for kind, up in (("mousePressed", 0), ("mouseMoved", 25)):
        x, y = middle[0], middle[1] - up
        page.say(
            "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1
        )
    page.until("frame.goals[0][0] > 50")


@pytest.mark.slow
def test_a_hidden_page_pauses_and_the_sticks_count_again_from_the_middle(page: Any) -> None:
    page.until("frame.t > 0.2 && !frame.away")
    page.run("push(0, -1, 0, 0)")
    page.until("frame.goals[0][0] > 50")
    page.run(
        "Object.defineProperty(document, 'hidden', {value: true, configurable: true});"
        "document.dispatchEvent(new Event('visibilitychange'))"
    )
    at = page.run("boat.time")
    time.sleep(0.5)
    assert page.run("boat.time") - at < 0.1
    page.run("Object.defineProperty(document, 'hidden', {value: false})")
    page.until("frame.away === 'page hidden' && frame.goals[0][0] === 0")
    time.sleep(0.3)
    assert page.run("frame.away") and page.run("frame.t") < at + 5.0
    page.run("push(0, 0, 0, 0)")
    page.until("!frame.away")


# Its files, and its look
# --------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_what_was_driven_is_downloaded_and_read_by_other_commands(
    page: Any, tmp_path: Path
) -> None:
    page.say("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    page.run("push(0, -0.8, 0.3, 0)")
    page.until("frame.t > 3")
    for button, suffix in (("recording", "csv"), ("scenario", "toml")):
        page.run(f"$('{button}').click()")
        end = time.monotonic() + 20.0
        while not list(tmp_path.glob(f"{VESSEL}-drive-*.{suffix}")):
            assert time.monotonic() < end
            time.sleep(0.05)
        assert f".{suffix} is among your downloads" in page.run("$('word').textContent")
    page.run("$('again').click()")
    page.until("$('word').textContent.startsWith('Sticks to the middle')")
    page.run("push(0, 0, 0, 0)")
    page.until("frame && frame.t < 2")
    log = next(tmp_path.glob("*.csv"))
    assert np.diff(read(log).t).max() == pytest.approx(0.02)
    done = boatsim("replay", log, "--vessel", VESSEL, "--horizon", 2, "--out", tmp_path / "replay")
    assert done.exit_code == 0, done.stderr
    done = boatsim("run", next(tmp_path.glob("*.toml")), "--out", tmp_path / "run")
    assert done.exit_code == 0, done.stderr


@pytest.mark.slow
def test_a_motion_that_is_no_longer_finite_ends_the_run_and_is_not_recorded(page: Any) -> None:
    page.until("frame.t > 0.2")
    page.run("boat.array('y')[0] = NaN")
    page.until("$('word').textContent.startsWith('The motion is no longer finite')")
    assert page.run("rows.every(row => row.every(Number.isFinite))")
    page.run("$('again').click()")
    page.until("frame && frame.t < 1 && !over")


@pytest.mark.slow
def test_on_a_phone_water_sticks_and_buttons_are_on_the_first_screen(page: Any) -> None:
    for wide in (360, 390):
        page.resize(wide, 844, mobile=True)
        assert page.run("document.documentElement.scrollWidth") <= wide
        for part in ("left", "right", "recording", "scenario", "again", "sea"):
            edges = page.run(f"$('{part}').getBoundingClientRect().toJSON()")
            assert 0 <= edges["top"] < edges["bottom"] <= 844, part
            assert 0 <= edges["left"] < edges["right"] <= wide, part
        assert page.run("$('sea').getBoundingClientRect().height") > 300
    assert page.run("[...document.querySelectorAll('.served')].every(e => !e.offsetParent)")
