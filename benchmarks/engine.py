"""Measure the speed of the physics, of a whole scenario and of a fresh process.

    python -m benchmarks.engine               about two minutes
    python -m benchmarks.engine --scenarios   every scenario, with sensors, controller and log

Runge-Kutta steps per second are medians of five rounds in which the variants alternate, so that a
busy machine slows all of them. The vessel is the joystick boat with its own and four more effects,
with collision detection, in a tank too large to touch; the Otter has six degrees of freedom.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
from rich.console import Console
from rich.table import Table

from boatsim.physics import vessel
from boatsim.physics.base import AXES
from boatsim.physics.content import content_root
from boatsim.simulate import cases, scenario
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.run import run
from boatsim.simulate.tank import Tank

ROUNDS = 5
STEP = 0.02  # [s]
START = State(psi=0.3, u=0.2, v=0.05, r=0.1)
COMMANDS = {
    "pwm_port": 120.0,
    "pwm_starboard": -90.0,
    "steer_port_rad": 0.4,
    "steer_starboard_rad": -0.3,
}
SHAFTS = {"n_port_radps": 80.0, "n_starboard_radps": 60.0}  # [rad/s]
EXTRA = (
    {"use": "weak_reverse", "astern_factor": 0.694},
    {"use": "fan_wind", "speed": 1.5, "toward": 0.8},
    {"use": "current", "north": 0.02, "east": -0.01},
    {"use": "shallow_water", "factor": 1.3},
)
MEMORY = content_root() / "models" / "otter" / "hydrodynamics"
SCENARIO = "joystick_boat/sway_1"
FAST = 100.0  # real-time factor that each scenario should reach
OPEN = {
    "until": {},
    "tank": {"length": 1e4, "width": 1e4},
}  # so that the boat sails on and touches nothing
CLI = [sys.executable, "-c", "from boatsim.cli import main; main()"]


@dataclass
class Variant:
    """One way to step the vessel."""

    name: str
    steps: int
    advance: Callable[[], object]
    rates: list[float] = field(default_factory=list)  # [steps/s]

    def measure(self) -> None:
        """Measure one more round."""
        start = perf_counter()
        self.advance()
        self.rates.append(self.steps / (perf_counter() - start))


@dataclass(frozen=True)
class Figure:
    """A measured number and its target."""

    name: str
    value: float
    unit: str
    target: float
    at_least: bool = True

    def row(self) -> tuple[str, str, str, str]:
        """Return the cells of the printed table."""
        reached = self.value >= self.target if self.at_least else self.value <= self.target
        sign = ">=" if self.at_least else "<="
        target = (
            f"{sign} {self.target:,.10g} {self.unit}" if 0.0 < self.target < float("inf") else ""
        )
        return (
            self.name,
            f"{self.value:,.4g} {self.unit}",
            target,
            "" if not target else "yes" if reached else "NO",
        )


def vessel_with_memory() -> vessel.Vessel:
    """Return the Otter with the memory of its radiation force in place of the added mass.

    The memory has five oscillators for surge, heave and pitch and five for sway, roll and yaw.
    """
    memory = {"use": "radiation_memory", "coefficients": str(MEMORY)}
    none = dict.fromkeys(AXES, 0.0)
    return vessel.load_vessel("otter", settings={"added_mass": none}, extra=[memory])


def measure_stepping() -> list[Figure]:
    """Return the steps per second of MuJoCo with and without forces, and of the compiled engine."""
    boat = vessel.load_vessel("joystick_boat", extra=EXTRA)
    tank = Tank(1e4, 1e4, 1.0)
    engines = {
        name: Engine(boat, tank, STEP, callback=name, show=False) for name in ("native", "python")
    }
    engines["floor"] = Engine(boat, tank, STEP, show=False)
    engines["floor"].callback = None
    compiled_engine, six = Batch(boat, step=STEP), Batch(vessel.load_vessel("otter"), step=STEP)
    remembering = Batch(vessel_with_memory(), step=STEP)
    start = [START.x, START.y, START.psi, START.u, START.v, START.r]

    def coast(name: str, steps: int) -> None:
        engines[name].reset(START, COMMANDS)
        engines[name].advance_without_actuators(steps)

    variants = {
        "native": Variant("native", 40_000, lambda: coast("native", 40_000)),
        "floor": Variant("floor", 40_000, lambda: coast("floor", 40_000)),
        "python": Variant("python", 5_000, lambda: coast("python", 5_000)),
        "twin": Variant(
            "twin",
            1_000_000,
            lambda: compiled_engine.hold_commands(start, COMMANDS, 1_000_000),
        ),
        "six": Variant("six", 300_000, lambda: six.hold_commands([0.0] * 12, SHAFTS, 300_000)),
        "memory": Variant(
            "memory",
            300_000,
            lambda: remembering.hold_commands([0.0] * 12, SHAFTS, 300_000),
        ),
    }
    for variant in variants.values():
        variant.advance()  # the first call compiles
    for _ in range(ROUNDS):
        for variant in variants.values():
            variant.measure()
    share = [n / f for n, f in zip(variants["native"].rates, variants["floor"].rates, strict=True)]
    rate = {name: median(v.rates) for name, v in variants.items()}
    return [
        Figure("engine, no callback (floor)", rate["floor"], "steps/s", 0.0),
        Figure("engine, native callback", rate["native"], "steps/s", 110_000),
        Figure("engine, native callback / floor", 100.0 * median(share), "%", 90),
        Figure("engine, Python callback", rate["python"], "steps/s", 10_000),
        Figure("twin", rate["twin"], "steps/s", 3_000_000),
        Figure("twin, the Otter's six freedoms", rate["six"], "steps/s", 1_000_000),
        Figure("twin, the same with memory of radiation", rate["memory"], "steps/s", 500_000),
    ]


def measure_scenario_speed() -> Figure:
    """Return the real-time factor of a minute with controller, sensors and log, once compiled."""
    seconds = []
    run(scenario.load(SCENARIO, OPEN | {"duration": 1.0}))
    for _ in range(ROUNDS):
        minute = scenario.load(SCENARIO, OPEN | {"duration": 60.0})
        start = perf_counter()
        run(minute)
        seconds.append(perf_counter() - start)
    return Figure(
        "60 s scenario with controller, sensors, log", 60.0 / median(seconds), "x real time", 100
    )


def run_process(arguments: list[str], **environment: str) -> tuple[float, float]:
    """Return the wall time [s] and peak memory [MB] of a process.

    Raises:
        RuntimeError: The process failed; the message contains its output.
    """
    with tempfile.TemporaryFile() as said:
        start = perf_counter()
        child = subprocess.Popen(arguments, stdout=said, stderr=said, env=os.environ | environment)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        took = perf_counter() - start
        if child.returncode not in (0, 1):  # 1: a metric is outside its band, irrelevant here
            said.seek(0)
            raise RuntimeError(f"exit code {child.returncode}: {said.read().decode()}")
    unit = 1e6 if sys.platform == "darwin" else 1e6 / 1024  # ru_maxrss: bytes there, KiB elsewhere
    return took, usage.ru_maxrss / unit


def measure_command_line() -> list[Figure]:
    """Measure the command line: first start with an empty cache, later starts, one hour."""
    with tempfile.TemporaryDirectory() as folder:
        out, cache = f"{folder}/out", f"{folder}/cache"
        cold, _ = run_process([*CLI, "run", SCENARIO, "--out", out], BOATSIM_CACHE=cache)
        warm = median(
            run_process([*CLI, "run", SCENARIO, "--out", out], BOATSIM_CACHE=cache)[0]
            for _ in range(3)
        )
        hour, peak = run_process(
            [*CLI, "run", str(write_hour_scenario(Path(folder))), "--out", out], BOATSIM_CACHE=cache
        )
    return [
        Figure(f"boatsim run {SCENARIO}, first time", cold, "s", 20, at_least=False),
        Figure(f"boatsim run {SCENARIO}, later", warm, "s", 3, at_least=False),
        Figure("boatsim run, 1 h of simulated time", hour, "s", float("inf"), at_least=False),
        Figure("boatsim run, 1 h: peak memory", peak, "MB", 500, at_least=False),
    ]


def write_hour_scenario(folder: Path) -> Path:
    """Write a scenario of one hour in open water and return its path."""
    path = folder / "an_hour.toml"
    path.write_text(
        'about = "An hour under way."\nvessel = "joystick_boat"\nduration = 3600.0\n'
        '[controller]\nuse = "l1_joystick"\n[sensors]\nspeed_sd = 0.01\n[[goal]]\nsway_mps = 0.07\n'
    )
    return path


def print_scenario_speeds(console: Console) -> None:
    """Print the real-time factor of each scenario, the better of two runs, slowest first."""
    found = []
    for name in cases.find_scenarios("*"):
        took = []
        for _ in range(2):  # the first compiles
            whole = scenario.load(name)
            start = perf_counter()
            done = run(whole)
            took.append(perf_counter() - start)
        lasted = float(np.ptp(done.recording.t))
        found.append(
            (
                lasted / min(took),
                name,
                lasted,
                whole.file.step,
                whole.controller.period,
                whole.file.engine,
            )
        )
    table = Table("scenario", "x real time", "lasts s", "step s", "period s", "engine")
    for speed, name, lasted, step, period, engine in sorted(found):
        table.add_row(name, f"{speed:,.0f}", f"{lasted:g}", f"{step:g}", f"{period:g}", engine)
    console.print(table)
    below = [name for speed, name, *_ in found if speed < FAST]
    console.print(
        f"{len(found)} scenarios, {len(below)} below {FAST:g} x real time: {', '.join(below) or 'none'}"
    )


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.engine", description="Speed of the physics."
    )
    parser.add_argument(
        "--scenarios", action="store_true", help="every scenario of the repository instead"
    )
    console = Console()
    if parser.parse_args().scenarios:
        print_scenario_speeds(console)
        return
    table = Table("", "measured", "target", "reached")
    for name, part in (
        ("steps/s of engine and twin", measure_stepping),
        ("a scenario", lambda: [measure_scenario_speed()]),
        ("the command line, cold, warm and for an hour", measure_command_line),
    ):
        with console.status(f"measuring {name}"):
            for figure in part():
                table.add_row(*figure.row())
    console.print(table)


if __name__ == "__main__":
    main()
