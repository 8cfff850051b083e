"""Simulated motion of a vessel in the loads that a table of motions of MSS asks for."""

from pathlib import Path

import numpy as np

from boatsim.hydrodynamics.mss import read_mss
from boatsim.physics.base import Array
from boatsim.physics.coefficients.files import write_wave_loads
from boatsim.physics.coefficients.table import WaveLoads
from boatsim.physics.effects.panel_wave_loads import PanelWaveLoads
from boatsim.physics.waves.dispersion import wave_number
from boatsim.physics.waves.field import WaveField
from boatsim.simulate.motion_loads import loads_of_motion
from boatsim.simulate.open_water import OpenWater
from validation.waves.boats import write_vessel

STEP = 0.05  # [s]
SEA = {
    "spectrum": '"jonswap"',
    "significant_height": 0.1,  # [m] small, so that the motion is linear
    "modal_period": 9.0,  # [s]
    "components": 100.0,
}
# Mass and size of the supply vessel. Damping and springs are strong, so that the start is soon
# forgotten: the loads are those with which this vessel moves as the table states.
VESSEL = """
about = "ship in the loads of a table of motions"
source = "supply vessel of MSS"
freedoms = ["surge", "sway", "heave", "roll", "pitch", "yaw"]
length = 82.8
beam = 19.2
draught = 6.0

[body]
mass = 6.36e6
roll_inertia = 2.98e8
pitch_inertia = 2.74e9
yaw_inertia = 2.73e9

[[effect]]
use = "linear_damping"
surge = 1.3e6
sway = 1.3e6
heave = 7e6
roll = 1e8
pitch = 4e9
yaw = 5e8

[[effect]]
use = "hydrostatics"
heave = 1.391e7
roll = 1.338e8
pitch = 7.633e9

[[effect]]
use = "ground_spring"
stiffness_north = 2.5e5
stiffness_east = 2.5e5
turn = 1.1e8
"""


def motions_at(table: Path, work: Path, toward: float, t: Array) -> tuple[Array, WaveField]:
    """Return the simulated motion of the ship in an irregular sea, and its waves.

    Args:
        table: Vessel structure of MSS with motions.
        work: Working folder.
        toward: Direction to which the waves run, relative to the bow [rad].
        t: Times (T,) [s], equally spaced, each a whole number of steps.

    Returns:
        Motion (T, 6) [m, rad], and the waves.
    """
    found = read_mss(table, 0.0, 0.0)
    vessel = write_vessel(work / "ship", VESSEL)
    number = np.asarray(wave_number(found.frequency, 0.0))
    loads, _ = loads_of_motion(vessel, found.frequency, found.heading, found.values, number)
    write_wave_loads(
        work / "loads",
        WaveLoads(found.source, 0.0, found.frequency, found.heading, np.asarray(loads)),
    )
    text = f'\n[[effect]]\nuse = "panel_wave_loads"\ncoefficients = "{work / "loads"}"\n'
    for key, value in SEA.items():
        text += f"{key} = {value}\n"
    vessel = write_vessel(work / "ship", VESSEL + text + f"toward = {toward}\n")
    sea = vessel.effect("panel_wave_loads")
    assert isinstance(sea, PanelWaveLoads)
    waves = sea.wave_field()
    assert waves is not None
    engine = OpenWater(vessel, step=STEP)
    rows, steps = [], 0
    for time in t:
        ahead = round(time / STEP) - steps
        engine.advance(ahead)
        steps += ahead
        own = engine.state
        rows.append([own.x, own.y, own.z, own.phi, own.theta, own.psi])
    return np.array(rows), waves
