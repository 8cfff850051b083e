"""Commands act within their channels' ranges, neutral where none is sent, wherever they come in."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from boats import PLANAR, planar, written
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.commands import clipped_commands, clipped_recorded_commands
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings import table
from boatsim.recordings.table import Recording
from boatsim.simulate import scenario
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine
from boatsim.simulate.run import Run, run

pytestmark = pytest.mark.usefixtures("trusted")

WILD = {"thrust_port_N": 500.0, "thrust_starboard_N": -500.0, "steer_port_rad": 9.0}
TAMED = {"thrust_port_N": 100.0, "thrust_starboard_N": -100.0, "steer_port_rad": 3.2}
STUBBORN = """
from dataclasses import dataclass
from boatsim.control.base import Controller

@dataclass
class Stubborn(Controller):
    words = "sends what it is told to, whatever the boat takes"
    value: float = 0.0
    fault: str = ""

    def initial_commands(self):
        return {"thrust_port_N": self.value}

    def step(self, sense, goal):
        if self.fault and sense.t > 0.5:
            return {"thrust_port_N": eval(self.fault)}
        return {"thrust_port_N": self.value}
"""


@pytest.fixture
def boat(tmp_path: Path) -> Vessel:
    return planar(tmp_path)


def scenario_text(boat: Vessel, **controller: Any) -> str:
    settings = "\n".join(f"{k} = {json.dumps(v)}" for k, v in controller.items())
    return f'vessel = "{boat.file}"\nduration = 2.0\n[controller]\nuse = "stubborn"\n{settings}\n'


def stubborn(folder: Path, boat: Vessel, **controller: Any) -> Path:
    """A scenario whose controller insists on its command."""
    (folder / "stubborn.py").write_text(STUBBORN)
    file = folder / "own.toml"
    file.write_text(scenario_text(boat, **controller))
    return file


def ran(file: Path) -> Run:
    return run(scenario.load(str(file)))


def boatsim(*arguments: object) -> Any:
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


# ---- what acts


def test_nothing_leaves_its_range(boat: Vessel) -> None:
    assert clipped_commands(boat, WILD).tolist() == [100.0, -100.0, 3.2, 0.0]


def test_rows_of_a_recording_are_limited_and_what_it_lacks_is_neutral(tmp_path: Path) -> None:
    text = PLANAR.replace(
        "steer_starboard_rad = { low", "steer_starboard_rad = { neutral = 0.5, low"
    )
    own = vessel.load_vessel(str(written(tmp_path, "test_boat", text)))
    rows = clipped_recorded_commands(
        own, {"thrust_port_N": np.array([1.0, 500.0]), "sent_thrust_port_N": np.full(2, 7.0)}, 2
    )
    assert rows.tolist() == [[1.0, 0.0, 0.0, 0.5], [100.0, 0.0, 0.0, 0.5]]


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_command_that_is_not_finite_is_refused(boat: Vessel, value: float) -> None:
    for way in (
        lambda: clipped_commands(boat, {"steer_port_rad": value}),
        lambda: Engine(boat).command({"steer_port_rad": value}),
    ):
        with pytest.raises(
            BadInput,
            match=r"^test_boat: command steer_port_rad = -?(nan|inf); allowed -3.2 to 3.2$",
        ):
            way()


def test_too_much_moves_engine_and_twin_as_the_most_does(boat: Vessel) -> None:
    paths = []
    for commands in (WILD, TAMED):
        engine = Engine(boat)
        engine.command(commands)
        engine.advance(50)
        paths.append(engine.state)
    assert paths[0] == paths[1] and abs(paths[0].r) > 0.1
    names_ = list(boat.commands)
    rows = [np.tile([c.get(n, 0.0) for n in names_], (50, 1)) for c in (WILD, TAMED)]
    compiled = Batch(boat, step=0.02)
    wild, tamed = (compiled.rollout([0.0] * 6, r, 0.02) for r in rows)
    assert np.array_equal(wild, tamed)
    assert wild[-1, :2] == pytest.approx(paths[0][1:3], abs=1e-9)


def test_a_diagnosis_sees_the_commands_that_acted(boat: Vessel) -> None:
    t = np.arange(0.0, 10.0, 0.1)
    pose = {n: np.zeros(len(t)) for n in ("x_m", "y_m", "psi_rad")}
    sent = {n: np.zeros(len(t)) for n in boat.commands} | {"thrust_port_N": np.full(len(t), 100.05)}
    laid = map_recording(Recording("r", t, pose | sent), Program(boat))
    assert laid.commands.max() == 100.0


# ---- neutral


def test_a_boat_left_alone_stays_where_it_is() -> None:
    """Nothing is sent, nothing drives it; of pulses from 800 to 2200 us none at all would mean full
    astern."""
    engine = Engine(vessel.load_vessel("twin_usv"))
    engine.advance(100)
    assert np.hypot(engine.state.x, engine.state.y) < 1e-9


@pytest.mark.parametrize("name", shipped_content_names("vessel"))
def test_every_vessel_takes_its_own_neutral(name: str) -> None:
    boat = vessel.load_vessel(name)
    assert clipped_commands(boat, {}).tolist() == [c.neutral for c in boat.commands.values()]


def test_a_pulse_that_is_not_sent_is_the_neutral_one() -> None:
    boat = vessel.load_vessel("twin_usv")
    assert clipped_commands(boat, {}).tolist() == [0.0, 0.0, 1500.0, 1500.0]
    assert clipped_commands(boat, {"pwm_left_us": 0.0}).tolist()[2:] == [800.0, 1500.0]


@pytest.mark.parametrize(
    ("channel", "said"),
    [
        ("low = 1.0, high = 7.0", "neutral is missing and cannot be 0; allowed 1 to 7"),
        ("low = 1.0, high = 7.0, neutral = 8.0", "neutral = 8; allowed 1 to 7"),
        ("low = 7.0, high = 1.0", "low = 7, high = 1; low must be below high"),
    ],
)
def test_a_neutral_must_lie_in_range(tmp_path: Path, channel: str, said: str) -> None:
    place = written(tmp_path, "boat", PLANAR.replace("low = -3.2, high = 3.2", channel, 1))
    with pytest.raises(BadInput, match=r"^boat/vessel.toml: channels.steer_port_rad: ") as raised:
        vessel.load_vessel(str(place))
    assert str(raised.value).endswith(said)


# ---- a run


def test_the_log_has_what_acted_and_what_was_sent(tmp_path: Path, boat: Vessel) -> None:
    found = ran(stubborn(tmp_path, boat, value=500.0))
    log = found.recording
    assert set(log["thrust_port_N"]) == set(log["actual_thrust_port_N"]) == {100.0}
    assert set(log["sent_thrust_port_N"]) == {500.0} and set(log["sent_steer_port_rad"]) == {0.0}
    assert set(found.camera["thrust_port_N"]) == {100.0}
    assert found.steps == 100 and found.saturated == {"thrust_port_N": 100}


def test_the_end_of_the_range_is_not_beyond_it(tmp_path: Path, boat: Vessel) -> None:
    found = ran(stubborn(tmp_path, boat, value=100.0))
    assert found.steps == 100 and not found.saturated


def test_limits_are_counted_in_norms_json_and_said_in_a_line(tmp_path: Path, boat: Vessel) -> None:
    file = stubborn(tmp_path, boat, value=-101.0)
    result = boatsim("run", file, "--out", tmp_path / "out")
    found = json.loads((tmp_path / "out" / "norms.json").read_text())
    assert result.exit_code == 0
    assert (found["steps"], found["saturated_steps"]) == (100, {"thrust_port_N": 100})
    (line,) = result.stderr.splitlines()
    assert line.startswith("boatsim: own: ") and "thrust_port_N in 100 of 100 steps" in line


def test_a_start_beyond_the_range_is_limited_too(tmp_path: Path, boat: Vessel) -> None:
    file = stubborn(tmp_path, boat, value=100.0)
    file.write_text(file.read_text() + "[start]\ncommands = { thrust_port_N = 5000.0 }\n")
    assert ran(file).recording["actual_thrust_port_N"][0] == 100.0


def test_a_recording_with_sent_commands_is_read_without_remarks(
    tmp_path: Path, boat: Vessel
) -> None:
    """`sent_` is one of our own columns: beyond the range it is no mistake of the recording."""
    boatsim("run", stubborn(tmp_path, boat, value=500.0), "--out", tmp_path / "out")
    seen = table.read(tmp_path / "out" / "recording.csv", boat.limits())
    assert not any("sent_" in line.partition("not used:")[2] for line in seen.remarks)
    assert set(seen["sent_thrust_port_N"]) == {500.0}


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ("float('nan')", "test_boat: command thrust_port_N = nan; allowed -100 to 100"),
        ("float('inf')", "test_boat: command thrust_port_N = inf; allowed -100 to 100"),
        ("1 / 0", "ZeroDivisionError: division by zero"),
        ("'full ahead'", "ValueError: could not convert string to float: 'full ahead'"),
    ],
)
def test_what_goes_wrong_in_a_controller_is_one_line(
    fault: str, said: str, tmp_path: Path, boat: Vessel, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = stubborn(tmp_path, boat, fault=fault)
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    result = boatsim("run", file, "--out", tmp_path / "out")
    assert result.exit_code == 2 and not (tmp_path / "out").exists()
    (line,) = result.stderr.splitlines()
    assert line.startswith(f"boatsim: own: controller stubborn at t = 0.56 s: {said}")
    assert not list(here.iterdir())


def test_a_motion_gone_wild_leaves_no_file_in_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """MuJoCo writes MUJOCO_LOG.TXT of its own accord where the state is not finite."""
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    engine = Engine(planar(tmp_path))
    engine.data.qvel[:] = np.nan
    with pytest.raises(Exception, match="no longer finite"):
        engine.advance(3)
    assert not list(here.iterdir())


# ---- forces of the air


BREATH = """
from dataclasses import dataclass
from typing import ClassVar
from numba import njit
from boatsim.physics.base import Force, param, wrench

@njit(inline="always")
def law(m, q):
    return wrench(Y=q.push * m.t)

@dataclass(frozen=True)
class Breath(Force):
    words: ClassVar[str] = "an air that grows"
    law: ClassVar = law
    of_air: ClassVar = True
    push: float = param(0.1, low=0.0, high=1.0, unit="N", words="a second")
"""


def test_a_run_logs_any_force_of_the_air_apart_by_what_it_says_of_itself(
    tmp_path: Path, boat: Vessel
) -> None:
    file = stubborn(tmp_path, boat)
    assert "wind_Y_N" not in ran(file).recording.signals
    (tmp_path / "breath.py").write_text(BREATH)
    file.write_text(file.read_text() + '[[effect]]\nuse = "breath.py"\n')
    log = ran(file).recording
    assert log["wind_Y_N"] == pytest.approx(0.1 * log.t) and not log["wind_X_N"].any()


@pytest.mark.parametrize("name", ["wind", "fan_wind"])
def test_the_winds_of_the_shelf_are_forces_of_the_air(name: str) -> None:
    assert load_class("effect", name).of_air and not load_class("effect", "push").of_air
