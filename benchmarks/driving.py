"""Measure the latency from a stick to the log, and late control periods.

    python -m benchmarks.driving [--seconds 60]
    python -m benchmarks.driving --picture FILE.png   a picture of the page, with a fan on

A headless Chromium drives `joystick_boat` with `l1_joystick` and a gamepad that is simulated in the
page. The stick is pushed at random times; page and log use the clock of this machine. "log" is the
first row with another goal, "commands" the first row with another command, which waits for the
controller's period, and "picture" the time at which the page has the state with the new goal.
"""

import argparse
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

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording, read
from tests.chrome import Page, chromium

SHOWN = Path(__file__).parents[1] / "examples" / "swing.toml"
GOAL, SENT = "goal_surge_mps", "sent_pwm_port"
PUSH = """new Promise(done => {
  const before = frame.goals[0][0], at = push(0, %g, 0, 0);
  const look = () => frame.goals[0][0] !== before ? done([at, (performance.timeOrigin + performance.now()) / 1000])
    : setTimeout(look, 1);
  look();
})"""  # returns when the stick was pushed and when the page saw the goal change [s since 1970]


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


def main(given: Sequence[str] | None = None) -> None:
    """Measure, or save the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--picture", type=Path)
    asked = parser.parse_args(given)
    with TemporaryDirectory() as folder:
        if asked.picture:
            save_picture(Path(folder) / "out", asked.picture)
        else:
            measure_latencies(Path(folder) / "out", asked.seconds)


if __name__ == "__main__":
    main()
