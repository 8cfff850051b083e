"""Measure the speed of many boats in one call: `python -m benchmarks.batch [--boats 10000]`.

It takes about a minute and prints Runge-Kutta boat-steps per second on all cores, medians of three
rounds. The vessel is the joystick boat with its own and four more effects: in open loop with constant
commands and with commands that all change every control period, and in a closed loop with sensor noise.
Where commands change, the share of the steps is printed that are divided because the signal of an
actuator bends.
"""

import argparse
import os
from collections.abc import Callable
from statistics import median
from time import perf_counter

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.engine import COMMANDS, EXTRA, OPEN, STEP, Figure
from boatsim.physics import vessel
from boatsim.physics.kernel.run import ENOUGH, SHORTEST
from boatsim.physics.signals import Array
from boatsim.simulate import scenario
from boatsim.simulate.batch import Batch
from boatsim.simulate.fleet import Fleet

ROUNDS = 3
PERIOD = 4  # [steps]
PERIODS = 25  # control periods of a round in open loop
SPEED = "M boat-steps/s"
SAMPLE = 40  # boats of which divided steps are counted
SECONDS = 60.0  # of the closed loop
CASE = "joystick_boat/sway_1_wind"


def steps_per_second(steps: int, advance: Callable[[], object]) -> float:
    """Return the median of steps per second."""
    found = []
    for _ in range(ROUNDS):
        start = perf_counter()
        advance()
        found.append(steps / (perf_counter() - start))
    return median(found)


def divided_share(jumps: Array) -> float:
    """Return the share of steps that are divided under given commands (periods, boats, C)."""
    batch = Batch(vessel.load_vessel("joystick_boat", extra=EXTRA), jumps.shape[1], STEP)
    batch.reset(commands=batch.program.command_array(COMMANDS))
    fleet, divided, steps = batch.fleet, 0, 0
    for commands in jumps:
        batch.advance(commands, 0)
        for _ in range(PERIOD):
            for b in range(len(batch)):
                part = batch.code.substep_length(
                    fleet.commands[b], fleet.memory[b], STEP, SHORTEST, fleet.p[b], fleet.on
                )
                divided += part < STEP - ENOUGH
                steps += 1
            batch.advance()
    return divided / steps


def open_loop(boats: int) -> list[Figure]:
    """Measure constant commands, and commands of all boats that jump every period."""
    batch = Batch(vessel.load_vessel("joystick_boat", extra=EXTRA), boats, STEP)
    row = batch.program.command_array(COMMANDS)
    low, high = np.array(list(batch.vessels[0].limits().values())).T
    shape = (PERIODS, boats, len(row))
    rng = np.random.default_rng(0)
    jumping = {
        "all commands jump every 80 ms": row + rng.uniform(-0.2, 0.2, shape) * np.abs(row),
        "all jump anywhere in their ranges": rng.uniform(low, high, shape),
    }
    batch.reset(commands=row)
    batch.advance(steps=PERIOD)  # compiles
    steps = boats * PERIODS * PERIOD
    held = steps_per_second(steps, lambda: batch.advance(row, PERIODS * PERIOD))
    found = [Figure(f"open loop, {boats:,} boats, commands held", held / 1e6, SPEED, 8.0)]
    for name, rows in jumping.items():

        def changing(rows: Array = rows) -> None:
            for commands in rows:
                batch.advance(commands, PERIOD)

        batch.reset(commands=row)
        speed = steps_per_second(steps, changing)
        share = 100.0 * divided_share(rows[:, :SAMPLE])
        found += [
            Figure(f"open loop, {name}", speed / 1e6, SPEED, 0.0),
            Figure("  share of divided steps", share, "%", 0.0),
        ]
    return [*found, Figure("memory of a boat", batch.bytes_per_boat, "bytes", 0.0)]


def closed_loop(boats: int) -> list[Figure]:
    """Measure a minute of all boats with a compiled controller, noise and wind."""
    found = []
    for use in ("l1_joystick", "pid_autopilot"):
        fleet = Fleet(scenario.load(CASE, OPEN | {"controller": {"use": use}}), boats)
        fleet.run(1.0)
        fleet.reset()
        start = perf_counter()
        fleet.run(SECONDS)
        took = perf_counter() - start
        steps = boats * round(SECONDS / STEP)
        goal = (3.0, 15.0) if use == "l1_joystick" else (0.0, float("inf"))
        found += [
            Figure(f"{use} compiled, {boats:,} boats", steps / took / 1e6, SPEED, goal[0]),
            Figure(f"{use} compiled, {SECONDS:g} s of them", took, "s", goal[1], at_least=False),
        ]
    return found


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.batch", description="Speed of many boats in one call."
    )
    parser.add_argument("--boats", type=int, default=10_000)
    boats = parser.parse_args().boats
    table = Table(
        "", "measured", "target", "reached", title=f"{len(os.sched_getaffinity(0))} cores"
    )
    for figure in (*open_loop(boats), *closed_loop(boats)):
        table.add_row(*figure.row())
    Console().print(table)


if __name__ == "__main__":
    main()
