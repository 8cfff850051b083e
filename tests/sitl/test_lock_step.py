"""A boat under the stand-in for ArduPilot, over UDP on the loopback interface."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from functools import partial
from math import hypot, radians
from pathlib import Path
from queue import Queue
from threading import Thread
from typing import Any

import numpy as np
import pytest
from alike import long
from typer.testing import CliRunner

from boatsim import read
from boatsim.cli import app
from boatsim.cli import sitl as command
from boatsim.cli.sitl import SitlOptions
from boatsim.recordings.table import Recording
from boatsim.simulate.run import run
from boatsim.simulate.scenario import load
from boatsim.sitl.motion_sample import body_components
from boatsim.sitl.surroundings import Surroundings
from tests.ardupilot_stand_in import HeadingHold, Readings, Square, StandIn

GRAVITY = 9.80665
MOTION = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps", "sensed_ax_mps2", "sensed_ay_mps2")
WAIT = 60.0  # [s] longest silence; the tests end a run by its duration, not by silence


class Simulator:
    """`boatsim sitl` in a thread of this process, without page and 3D log.

    Attributes:
        port: UDP port on which it receives servo outputs.
        codes: Its exit code, after its end.
    """

    def __init__(self, options: SitlOptions) -> None:
        self.codes: list[int] = []
        self._options = options
        self._ports: Queue[int] = Queue()
        self._thread = Thread(target=self._serve, daemon=True)
        self._thread.start()
        self.port = self._ports.get(timeout=120.0)

    def _serve(self) -> None:
        task, servos = command.load_task(self._options)
        assert self._options.out
        self.codes.append(
            command.serve_autopilot(
                self._options, task, servos, 0, self._options.out, self._ports.put
            )
        )

    def end(self) -> int:
        """Wait for its end; the exit code."""
        self._thread.join(120.0)
        return self.codes[0]


@pytest.fixture
def light(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs without page and 3D log, which take most of the time of a short run."""
    monkeypatch.setattr(command, "rerun_observers", list)

    class Nothing:
        def add_rows(self, rows: Recording) -> None: ...

        def finish(self, result: object) -> None: ...

    monkeypatch.setattr(command, "page_observer", lambda *_: lambda *_: nullcontext(Nothing()))


@contextmanager
def simulated(vessel: str, out: Path, **options: Any) -> Iterator[Simulator]:
    """A simulator that ends with its run."""
    yield Simulator(SitlOptions(vessel, out=out, port=0, **{"wait": WAIT, **options}))


def changing(frame: int) -> dict[int, int]:
    """Pulses of a frame, which change every 0.3 s."""
    step = frame // 15
    return {1: 1500 + 90 * (step % 5), 3: 1900 - 110 * (step % 4)}


def velocity_error(rows: Sequence[Readings], dt: float) -> float:
    """Largest error [m/s] of the velocity integrated from the inertial readings and gravity."""
    velocity = np.array(rows[0]["velocity"])
    worst = 0.0
    for before, after in zip(rows[:-1], rows[1:], strict=True):
        turned = np.unwrap([before["attitude"], after["attitude"]], axis=0)
        to_body = np.column_stack(
            [body_components(tuple(unit), tuple(turned.mean(axis=0))) for unit in np.eye(3)]
        )
        force = to_body.T @ np.array(after["imu.accel_body"])
        velocity += dt * (force + (0.0, 0.0, GRAVITY))
        worst = max(worst, float(np.abs(velocity - after["velocity"]).max()))
    return worst


@pytest.mark.usefixtures("light")
def test_lock_step_gives_the_numbers_of_a_run_with_the_same_commands(tmp_path: Path) -> None:
    """In waves and a current, in six degrees of freedom; so do the scenario that the run writes and the
    inertial readings."""
    out = tmp_path / "run"
    around = Surroundings(waves=(0.2, 2.5, 30.0), current=(0.3, 90.0))
    with simulated("otter", out, seconds=3.0, surroundings=around, seed=3) as simulator:
        with StandIn(simulator.port) as autopilot:
            rows = [autopilot.exchange(changing(frame)) for frame in range(150)]
        assert simulator.end() == 0
    recording = read(out / "recording.csv")
    assert np.allclose([row["timestamp"][0] for row in rows], recording.t[1:], atol=1e-9)
    assert velocity_error(rows, 0.02) < 1e-9

    goals: list[dict[str, float]] = []
    for frame in range(0, 150, 15):
        pulses = changing(frame)
        port, starboard = (104.0 * (pulses[output] - 1500) / 500 for output in (1, 3))
        goals.append({"from": 0.02 * frame, "n_port_radps": port, "n_starboard_radps": starboard})
    written = load(str(out / "scenario.toml"))
    same = replace(
        load("otter/beam_sea"),
        vessel=written.vessel,
        file=written.file.model_copy(update={"goal": goals}),
        controller=written.controller,
    )
    for scenario in (written, same):
        expected = run(scenario, seed=3).recording
        for name in (*MOTION, "phi_rad", "theta_rad", "z_m", "n_port_radps"):
            assert np.abs(recording[name] - expected[name]).max() < 1e-9, name
    for i, name in enumerate(("x_m", "y_m", "z_m")):
        assert np.abs(recording[name][1:] - [row["position"][i] for row in rows]).max() < 1e-9
    # the mean over a frame is that of the true accelerations at its ends, except where they jump
    felt = np.array([row["imu.accel_body"][0] for row in rows])
    tilt = GRAVITY * np.sin(recording["theta_rad"])
    ends = recording["sensed_ax_mps2"] + tilt
    assert np.median(np.abs(felt - 0.5 * (ends[1:] + ends[:-1]))) < 2e-3


@pytest.mark.usefixtures("light")
def test_a_restart_a_repeated_frame_and_malformed_packets(tmp_path: Path) -> None:
    out = tmp_path / "run"
    with simulated("blueboat", out, seconds=1.0) as simulator:
        ahead = {1: 1800, 3: 1800}
        with StandIn(simulator.port, outputs=32, counter=40) as autopilot:
            for _ in range(20):
                first = autopilot.exchange(ahead)
            sent = autopilot.message
            autopilot.repeat()  # the answer was lost
            assert autopilot.receive() == first and autopilot.message == sent
            autopilot.socket.sendto(b"no servo outputs", autopilot.simulator)
            autopilot.socket.sendto(autopilot.packet[:-2], autopilot.simulator)
            with StandIn(simulator.port) as other:
                other.send(ahead)
                assert other.is_quiet()
            autopilot.counter += 3
            after = autopilot.exchange(ahead)
            assert after["timestamp"][0] == pytest.approx(first["timestamp"][0] + 0.02)
            assert autopilot.is_quiet()
            autopilot.counter = 0
            again = autopilot.exchange(ahead)
            assert again["timestamp"] == pytest.approx((0.02,))
            assert again["position"][0] < first["position"][0]
            for _ in range(49):
                last = autopilot.exchange(ahead)
        assert simulator.end() == 0
    assert last["timestamp"][0] == pytest.approx(1.0)
    begun, repeated = read(out), read(tmp_path / "run-2")
    assert begun.t[-1] == pytest.approx(0.42) and repeated.t[-1] == pytest.approx(1.0)
    facts = (out / "recording.toml").read_text()
    for line in (
        "frames = 21",
        "repeated_frames = 1",
        "missed_frames = 3",
        "malformed_packets = 2",
        "foreign_packets = 1",
        "frame_rates_hz = [50]",
    ):
        assert line in facts
    assert "missed_frames = 0" in (tmp_path / "run-2" / "recording.toml").read_text()


@pytest.mark.usefixtures("light")
def test_the_autopilot_sets_the_length_of_a_frame(tmp_path: Path) -> None:
    """Long frames are divided into steps, and short ones are made as they are."""
    places = {}
    for rate in (10, 50, 400):
        out = tmp_path / str(rate)
        with simulated("blueboat", out, seconds=2.0) as simulator:
            with StandIn(simulator.port, rate) as autopilot:
                for _ in range(2 * rate):
                    last = autopilot.exchange({1: 1900, 3: 1600})
            assert simulator.end() == 0
        assert last["timestamp"][0] == pytest.approx(2.0)
        places[rate] = last["position"][:2]
        assert len(read(out)) == 101
    assert places[10] == pytest.approx(places[50], abs=1e-9)  # the same steps
    assert places[400] == pytest.approx(places[50], abs=1e-6)


@pytest.mark.usefixtures("light")
def test_two_autopilots_control_two_boats_at_once(tmp_path: Path) -> None:
    """On the compiled engine: MuJoCo's callback belongs to a process, and two processes take longer."""
    scenario = tmp_path / "calm.toml"
    scenario.write_text(
        'vessel = "blueboat"\nduration = 1.0\nengine = "compiled"\nsensors = { ideal = true }\n'
        'controller = { use = "open_loop" }\n'
    )
    headings = (radians(30.0), radians(-60.0))
    options = {"scenario": str(scenario), "seconds": 6.0}
    with (
        simulated("blueboat", tmp_path / "0", **options) as one,
        simulated("blueboat", tmp_path / "1", **options) as two,
        StandIn(one.port) as first,
        StandIn(two.port) as second,
    ):
        pilots = (first, second)
        laws = [HeadingHold(heading, 0.3, 50) for heading in headings]
        rows = [pilot.exchange({1: 1500, 3: 1500}) for pilot in pilots]
        for _ in range(299):
            for pilot, law, row in zip(pilots, laws, rows, strict=True):
                pilot.send(law(row))
            rows = [pilot.receive() for pilot in pilots]
        assert (one.end(), two.end()) == (0, 0)
    for row, heading in zip(rows, headings, strict=True):
        assert row["attitude"][2] == pytest.approx(heading, abs=0.15)


@pytest.mark.usefixtures("light")
def test_a_run_ends_when_the_autopilot_is_silent(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with simulated("blueboat", tmp_path / "run", wait=0.3) as simulator:
        with StandIn(simulator.port) as autopilot:
            autopilot.exchange({1: 1900, 3: 1900})
        assert simulator.end() == 0
    assert (tmp_path / "run" / "recording.csv").read_text().count("\n") == 3
    assert "no servo outputs for 0.3 s; the run has ended" in capsys.readouterr().err


# ---- command line


def test_nothing_hangs_if_no_autopilot_is_there(tmp_path: Path) -> None:
    words = ["sitl", "ardupilot", "blueboat", "--port", "0", "--wait", "0.2", "--out"]
    result = CliRunner().invoke(app, [*words, str(tmp_path / "run")], catch_exceptions=False)
    assert result.exit_code == 2
    last = result.stderr.strip().splitlines()[-1]
    assert last.startswith("boatsim: no servo outputs arrived on 127.0.0.1, UDP port ")
    assert "0.2 s; 0 other packets. Start ArduPilot with --model JSON:127.0.0.1" in last
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["px4", "otter"], "ardupilot"),
        (["ardupilot", "oter"], "did you mean 'otter'?"),
        (["ardupilot", "pendulum"], "cannot surge and yaw"),
        (["ardupilot", "otter", "--servo", "1=rudder"], "rudder"),
        (["ardupilot", "otter", "--servo-file", "none.toml"], "no such file"),
        (["ardupilot", "otter", "--servo", "1=n_port_radps", "--servo-file", "s.toml"], "exclude"),
        (["ardupilot", "otter", "--wind", "5"], "SPEED,FROM"),
        (["ardupilot", "otter", "--waves", "1,2"], "HEIGHT,PERIOD,FROM"),
        (["ardupilot", "otter", "--waves", "0.2,-2,0"], "HEIGHT,PERIOD,FROM"),
        (["ardupilot", "otter", "--current", "fast,90"], "SPEED,TOWARD"),
        (["ardupilot", "otter", "--current", "50,90"], "allowed"),
        (["ardupilot", "otter", "--scenario", "joystick_boat/yaw_1"], "is for joystick_boat"),
        (["ardupilot", "otter", "--instance", "-1"], "--instance"),
        (["ardupilot", "otter", "--instances", "0"], "--instances"),
        (["ardupilot", "otter", "--port", "65530", "--instance", "2"], "65550"),
        (["ardupilot", "otter", "--port", "70000"], "--port"),
        (["ardupilot", "otter", "--wait", "0"], "--wait"),
        (["ardupilot", "otter", "--seconds", "0"], "--seconds"),
        (["ardupilot", "otter", "--address", "999.1.1.1", "--port", "0"], "999.1.1.1"),
    ],
)
def test_a_mistake_in_an_option_ends_with_one_line_and_exit_code_2(
    words: list[str], said: str
) -> None:
    result = CliRunner().invoke(app, ["sitl", *words], catch_exceptions=False)
    assert result.exit_code == 2 and not result.stdout
    assert result.stderr.count("\n") == 1 and result.stderr.startswith("boatsim: ")
    assert said in result.stderr


def started(words: Sequence[str]) -> subprocess.Popen[str]:
    """`boatsim sitl` as a user starts it."""
    return subprocess.Popen(
        [sys.executable, "-m", "boatsim", "sitl", "ardupilot", *words],
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),  # whatever started us
    )


def ports_of(process: "subprocess.Popen[str]", count: int) -> list[int]:
    """The ports on which it waits, in the order of the instances."""
    found: dict[int, int] = {}
    assert process.stderr
    while len(found) < count:
        line = process.stderr.readline()
        assert line, "it has ended"
        if " waits for ArduPilot" in line:
            words = line.split()
            found[int(words[2])] = int(words[-1])
    return [found[number] for number in sorted(found)]


@pytest.mark.slow
def test_an_interruption_keeps_what_was_logged(tmp_path: Path) -> None:
    process = started(["blueboat", "--port", "0", "--out", str(tmp_path / "run")])
    with StandIn(ports_of(process, 1)[0]) as autopilot:
        for _ in range(50):
            autopilot.exchange({1: 1900, 3: 1900})
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=120.0)
    assert process.returncode == 130
    assert said.strip().splitlines()[-1] == "boatsim: interrupted; what was logged is kept"
    assert len(read(tmp_path / "run")) >= 50
    assert {"report.html", "run.rrd", "scenario.toml"} <= {*os.listdir(tmp_path / "run")}


@pytest.mark.slow
def test_several_instances_run_in_processes_and_end_together(tmp_path: Path) -> None:
    words = ["blueboat", "--instances", "2", "--instance", "3", "--port", "0", "--seconds", "600"]
    process = started([*words, "--out", str(tmp_path / "run")])
    ports = ports_of(process, 2)
    for port in ports:
        with StandIn(port) as autopilot:
            for _ in range(25):
                autopilot.exchange({1: 1700, 3: 1700})
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=120.0)
    assert process.returncode == 130
    for number in (3, 4):
        assert len(read(tmp_path / "run" / f"instance_{number}")) >= 25


@pytest.mark.slow
@pytest.mark.usefixtures("light")
@pytest.mark.parametrize(
    ("vessel", "skid", "side", "wind"),
    [long("otter", True, 15.0, 2.0), ("joystick_boat", False, 10.0, 0.3)],
)
def test_a_boat_drives_a_square_in_wind(
    vessel: str, skid: bool, side: float, wind: float, tmp_path: Path
) -> None:
    around = Surroundings(wind=(wind, 200.0))
    with simulated(vessel, tmp_path / "run", seconds=150.0, surroundings=around) as simulator:
        with StandIn(simulator.port, 100) as autopilot:
            law = Square(side, 0.8, 100, skid)
            rows = autopilot.drive(law, 150.0)
        assert simulator.end() == 0
    assert law.passed >= 4
    tracks = np.array([row["position"][:2] for row in rows])
    assert np.abs(tracks - side / 2).max() < side
    assert all(hypot(*row["velocity"][:2]) < 5.0 for row in rows)
    assert rows[-1]["windvane.speed"][0] > 0.0
    assert velocity_error(rows, 0.01) < 1e-9
