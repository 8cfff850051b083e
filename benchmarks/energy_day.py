"""Measure the loss of energy and momentum in a simulated day.

    python -m benchmarks.energy_day [--hours 24] [--step 0.01]

The vessel is a boat of 6 kg without damping and thrust (case P3 of the reference cases: added mass of
0.6, 3 and 0.3 in surge, sway and yaw, 1 m/s ahead, 0.1 m/s abeam, 0.2 rad/s), on MuJoCo and on the
compiled engine. Energy and momentum in earth-fixed axes are constants of the motion; their change is
the error of the integrator. Growing memory would be a defect of the program.
"""

import argparse
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State

HOUR = 3600.0  # [s]
START = (0.0, 0.0, 0.0, 1.0, 0.1, 0.2)  # x, y, psi, u, v, r
MASS = np.array([6.6, 9.0, 0.8])  # [kg], [kg], [kg m^2] with that of the water
HULL = """<mujoco model="free_boat">
  <custom><numeric name="drawn_for" data="1 0.4 0.1"/></custom>
  <worldbody>
    <body name="hull"><geom name="collision" type="box" size="0.5 0.2 0.1" contype="0" conaffinity="0"/></body>
  </worldbody>
</mujoco>
"""
BOAT = """
about = "a boat that nothing brakes"
source = "reference case P3"
freedoms = ["surge", "sway", "yaw"]
length = 1.0
beam = 0.4
draught = 0.1
body = { mass = 6.0, roll_inertia = 0.1, yaw_inertia = 0.5 }

[channels]
thrust_N = { low = -1.0, high = 1.0 }

[[effect]]
use = "added_mass"
surge = 0.6
sway = 3.0
yaw = 0.3

[[effect]]
use = "thruster"
on = { thrust = "thrust_N", angle = 0.0 }
"""
Advance = Callable[[int], Array]  # number of steps -> x, y, psi, u, v, r


def write_vessel(folder: Path) -> Vessel:
    """Write the vessel into a folder and load it."""
    (folder / "hull.xml").write_text(HULL, encoding="utf-8")
    (folder / "vessel.toml").write_text(BOAT, encoding="utf-8")
    return vessel.load_vessel(str(folder / "vessel.toml"))


def constants_of_motion(state: Array) -> Array:
    """Return energy [J] and momentum north and east [N s]."""
    psi, nu = state[2], state[3:]
    p = MASS * nu
    return np.array(
        [
            0.5 * p @ nu,
            p[0] * np.cos(psi) - p[1] * np.sin(psi),
            p[0] * np.sin(psi) + p[1] * np.cos(psi),
        ]
    )


def mujoco_stepper(made: Vessel, step: float) -> Advance:
    """Return a function that steps the vessel on MuJoCo."""
    engine = Engine(made, step=step, show=False)
    x, y, psi, u, v, r = START
    engine.reset(State(x=x, y=y, psi=psi, u=u, v=v, r=r), {})

    def advance(steps: int) -> Array:
        engine.advance_without_actuators(steps)
        s = engine.state
        return np.array([s.x, s.y, s.psi, s.u, s.v, s.r])

    return advance


def compiled_stepper(made: Vessel, step: float) -> Advance:
    """Return a function that steps the vessel on the compiled engine."""
    compiled_engine, state = Batch(made, step=step), np.array(START)

    def advance(steps: int) -> Array:
        nonlocal state
        state = compiled_engine.hold_commands(state.tolist(), {}, steps)
        return state

    return advance


def peak_memory() -> float:
    """Return the peak memory of this process [MB]."""
    unit = 1e6 / 1024  # ru_maxrss is in KiB
    if sys.platform == "darwin":
        unit = 1e6
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit


def conservation_row(advance: Advance, hours: float, step: float) -> str:
    """Return a row of the table with the largest change of the constants, evaluated every hour."""
    first, worst = constants_of_motion(np.array(START)), np.zeros(3)
    advance(0)
    before, begin = peak_memory(), time.perf_counter()
    for _ in range(round(hours)):
        worst = np.maximum(worst, np.abs(constants_of_motion(advance(round(HOUR / step))) - first))
    took, grown = time.perf_counter() - begin, peak_memory() - before
    total = np.hypot(*first[1:])
    energy, momentum = worst[0] / first[0], np.max(worst[1:]) / total
    return f"{hours * HOUR / step:12.3g}{took:10.1f}{energy:16.1e}{momentum:18.1e}{grown:14.1f}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=24.0, help="simulated")
    parser.add_argument("--step", type=float, default=0.01, help="[s] of integration")
    given = parser.parse_args()
    print(
        f"{'':10}{'steps':>12}{'took [s]':>10}{'energy lost':>16}{'momentum lost':>18}{'grown [MB]':>14}"
    )
    with TemporaryDirectory() as folder:
        made = write_vessel(Path(folder))
        for name, start in (("twin", compiled_stepper), ("engine", mujoco_stepper)):
            print(
                f"{name:10}" + conservation_row(start(made, given.step), given.hours, given.step),
                flush=True,
            )


if __name__ == "__main__":
    main()
