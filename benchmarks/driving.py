"""Measure the latency from a stick to the log, and late control periods.

    python -m benchmarks.driving [--seconds 60]
    python -m benchmarks.driving --picture FILE.png   a picture of the page, with a fan on
    python -m benchmarks.driving --offline [--picture FILE.png]   the same for the page without a server

A headless Chromium drives `joystick_boat` with `l1_joystick` and a gamepad that is simulated in the
page. The stick is pushed at random times; page and log use the clock of this machine. "log" is the
first row with another goal, "commands" the first row with another command, which waits for the
controller's period, and "picture" the time at which the page has the state with the new goal.

With `--offline` the page simulates the boat itself. Its size, the time of a step and of a picture, and the
difference to the engine in Python after two minutes are printed; the picture has the width of a phone.
"""

import argparse
import json
import random
import re
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from boatsim.drive.offline import write_offline_page
from boatsim.drive.task import DriveTask
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording, read
from boatsim.simulate import scenario
from boatsim.simulate.run import run as simulate
from boatsim.webassembly.compiler import find_compiler
from tests.chrome import Page, chromium

SHOWN = Path(__file__).parents[1] / "examples" / "swing.toml"
GOAL, SENT = "goal_surge_mps", "sent_pwm_port"
PUSH = """new Promise(done => {
  const before = frame.goals[0][0], at = push(0, %g, 0, 0);
  const look = () => frame.goals[0][0] !== before ? done([at, (performance.timeOrigin + performance.now()) / 1000])
    : setTimeout(look, 1);
  look();
})"""  # returns when the stick was pushed and when the page saw the goal change [s since 1970]

# Drives as fast as possible with other sticks every two seconds; returns recording, scenario and time per step [us]
SIMULATE = """(() => {
  const sequence = %s;
  restart();
  away = "";
  sticks = sequence[0];
  control();
  keepRow();
  const begin = performance.now();
  for (const now of sequence) {
    sticks = now;
    for (let i = 0; i < 100; i++) step();
  }
  const taken = 1000 * (performance.now() - begin) / (100 * sequence.length);
  return [recordingText().join(""), scenarioText(), taken];
})()"""
DRAW = """(() => {
  const taken = [];
  for (let i = 0; i < 200; i++) {
    const begin = performance.now();
    step();
    show();
    figures();
    draw(frame);
    taken.push(performance.now() - begin);
  }
  return taken.sort((a, b) => a - b);
})()"""


def push_stick(page: Page, seconds: float) -> Array:
    """Return the times (N, 2) of pushing the stick and of its display, during a run of `seconds`."""
    rng, found = random.Random(0), []
    page.until("frame && frame.t > 1 && !frame.away")
    while page.run("frame.t") < seconds - 1.5:
        found.append(page.run(PUSH % (0.0 if len(found) % 2 else rng.choice([-0.2, -0.4, -0.6]))))
        time.sleep(rng.uniform(0.2, 0.6))
    return np.array(found, dtype=float)


def delays_to_next_change(log: Recording, column: str, begin: float, at: Array) -> Array:
    """Return the delay [s] from each time in `at` [s since 1970] to the next change of a column."""
    changed = begin + log.t[1:][np.diff(log[column]) != 0.0]
    return np.array([changed[changed > when - 0.001][0] - when for when in at])


def latency_row(name: str, seconds: Array) -> str:
    """Return a row of the table, in ms."""
    ms = 1e3 * seconds
    return f"{name:20}{np.median(ms):8.0f}{np.percentile(ms, 95):8.0f}{ms.max():8.0f}"


@contextmanager
def open_drive_page(folder: Path, seconds: float, *more: str) -> Iterator[Page]:
    """Start a run and yield its page; wait for its end when the block is left."""
    command = [sys.executable, "-m", "boatsim", "drive", "joystick_boat", "--no-open", *more]
    command += ["--seconds", f"{seconds:g}", "--out", str(folder)]
    running = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
    )
    assert running.stderr
    found = re.search(r"http://\S+", running.stderr.readline())
    assert found
    with chromium() as opened:
        yield opened(found[0])
        running.communicate(timeout=60)


def save_picture(folder: Path, path: Path) -> None:
    """Save a picture of the page after some seconds of turning."""
    with open_drive_page(folder, 21.0, "--scenario", str(SHOWN)) as page:
        page.until("frame && frame.t > 1 && !frame.away")
        for until, push in (
            (8, "0.0, -0.6, 0.6, 0"),
            (14, "0.0, -0.5, -0.9, 0"),
            (19, "0.8, -0.1, 0.4, 0"),
        ):
            page.run(f"push({push})")
            page.until(f"frame.t > {until}")
        page.run("for (let i = 0; i < 3; i++) $('in').click()")  # nearer
        page.picture(path, 1120, 770)


def measure_latencies(folder: Path, seconds: float) -> None:
    """Drive one run and print its latencies."""
    with open_drive_page(folder, seconds, "--controller", "l1_joystick") as page:
        moved = push_stick(page, seconds)
    log = read(folder / "recording.csv")
    facts = log.notes.facts
    begin = float(str(facts["began_unix_s"]))
    print(f"{len(moved)} pushes in {log.t[-1]:.0f} s, [ms]")
    print(f"{'from stick to':20}{'median':>8}{'95 %':>8}{'most':>8}")
    print(latency_row("log", delays_to_next_change(log, GOAL, begin, moved[:, 0])))
    print(latency_row("commands", delays_to_next_change(log, SENT, begin, moved[:, 0])))
    print(latency_row("picture", moved[:, 1] - moved[:, 0]))
    late, worst = facts["late_periods"], facts["latest_ms"]
    print(
        f"{facts['periods']} control periods, {late} begun late; the latest {worst} ms behind time"
    )


def measure_offline_page(folder: Path, picture: Path | None) -> None:
    """Print size, speed and accuracy of the page without a server; save a picture if asked for."""
    file = folder / "page.html"
    size = write_offline_page(
        DriveTask("joystick_boat", str(SHOWN), "open_loop", offline=True), file, find_compiler()
    )
    print(f"page.html: {size:,} bytes")
    rng = random.Random(0)
    sequence = [[rng.uniform(-1.0, 1.0), 0.0, rng.uniform(-1.0, 1.0)] for _ in range(60)]
    with chromium() as opened:
        page = opened(file.as_uri())
        page.until("frame && frame.t > 0.5 && !frame.away")
        recording, text, step = page.run(SIMULATE % json.dumps(sequence))
        drawn = page.run(DRAW)
        (folder / "page.csv").write_text(recording)
        (folder / "scenario.toml").write_text(text)
        of_page = read(folder / "page.csv")
        of_engine = simulate(scenario.load(str(folder / "scenario.toml"))).recording
        largest = 0.0
        for name in ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps"):
            largest = max(largest, float(np.abs(of_page[name] - of_engine[name]).max()))
        print(f"a step of 20 ms with its row: {step:.0f} us")
        print(f"a picture with its steps: median {np.median(drawn):.1f} ms")
        print(
            f"largest difference of motion to Python in {of_page.t[-1]:.0f} s: {largest:.1e} m, rad"
        )
        if picture:
            page.run("$('again').click()")
            page.until("frame && frame.t > 0.5 && !frame.away")
            page.run("push(0.0, -0.8, 0.5, 0)")
            page.until("frame.t > 7")
            page.run("push(0.0, -0.6, -0.7, 0)")
            page.until("frame.t > 12")
            page.picture(picture, 390, 844)


def main(given: Sequence[str] | None = None) -> None:
    """Measure, or save the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--offline", action="store_true")
    asked = parser.parse_args(given)
    with TemporaryDirectory() as folder:
        if asked.offline:
            measure_offline_page(Path(folder), asked.picture)
        elif asked.picture:
            save_picture(Path(folder) / "out", asked.picture)
        else:
            measure_latencies(Path(folder) / "out", asked.seconds)


if __name__ == "__main__":
    main()
