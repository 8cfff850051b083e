"""A body on a rig, free in heave and roll, whose radiation force depends on the frequency.

The motion is integrated by scipy and shares no code with boatsim. A motor drives the body with a
recorded force and moment, or it is released and left alone.
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.signal import StateSpace, lsim

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Notes, Recording

FILE = Path("tank.csv")
RATE = 20.0  # [Hz]
SECONDS = 24.0  # [s] of a driven run
SENSOR = 2e-4  # [m, rad] noise of the camera
# heave, roll: [kg, kg m^2] with added mass, [N/m, N m], [N s/m, N m s]
INERTIA = np.array([80.0, 1.3])
STIFFNESS = np.array([2300.0, 30.0])
DAMPING = np.array([60.0, 0.4])
FORCE = np.array([60.0, 0.3])  # [N, N m] standard deviation of the driving force
HULL = """<mujoco model="body"><worldbody><body name="hull">
<geom type="box" size="0.3 0.2 0.13"/></body></worldbody></mujoco>"""
BODY = """
about = "a body on a rig that heaves and rolls"
source = "none"
freedoms = ["heave", "roll"]
length = 0.6
beam = 0.4
draught = 0.2
body = {{ mass = 48.0, roll_inertia = 1.0, yaw_inertia = 1.4 }}

[channels]
force_N = {{ low = -400.0, high = 400.0 }}
moment_Nm = {{ low = -20.0, high = 20.0 }}

[[effect]]
use = "applied_load"
on = {{ force = "force_N", moment = "moment_Nm" }}
heave = 1.0
roll = 1.0

[[effect]]
use = "added_mass"
surge = 0.0
sway = 0.0
heave = 32.0
roll = 0.3
yaw = 0.0
coriolis = 0.0

[[effect]]
use = "linear_damping"
heave = {damping[0]}
roll = {damping[1]}

[[effect]]
use = "hydrostatics"
heave = 2300.0
roll = 30.0
vertical = 1.0

[diagnosis]
rate = 10.0
reasons = {{ rate = "ten rows in a period" }}
coefficient_uncertainty = {{ damping = 0.5 }}
facts = {{ indoors = true, still_water = true }}
"""


@dataclass(frozen=True)
class Radiation:
    """One section of radiation memory in heave and roll."""

    damping: Array = field(default_factory=lambda: np.zeros(2))  # [N s/m, N m s] the largest
    frequency: Array = field(default_factory=lambda: np.array([7.0, 6.0]))  # [rad/s] there
    ratio: Array = field(default_factory=lambda: np.full(2, 0.5))


@dataclass(frozen=True)
class Body:
    """The real body."""

    radiation: Radiation = field(default_factory=Radiation)
    damping: Array = field(default_factory=DAMPING.copy)
    inertia: Array = field(default_factory=INERTIA.copy)


def body_vessel(folder: Path, damping: Array = DAMPING) -> Vessel:
    """The body as a vessel with constant damping [N s/m, N m s] in heave and roll."""
    (folder / "hull.xml").write_text(HULL)
    (folder / "vessel.toml").write_text(BODY.format(damping=damping.tolist()))
    return vessel.load_vessel(str(folder))


def equations(body: Body) -> tuple[Array, Array]:
    """State and input matrices of the body.

    The state has heave and roll, their rates, and place and rate of the oscillators of the memory.
    """
    memory = body.radiation
    a, b = 2.0 * memory.ratio * memory.frequency, memory.frequency**2
    one, none = np.eye(2), np.zeros((2, 2))
    weight = np.diag(1.0 / body.inertia)
    force = [-np.diag(STIFFNESS), -np.diag(body.damping), none, -np.diag(a * memory.damping)]
    rows = [
        np.hstack([none, one, none, none]),
        weight @ np.hstack(force),
        np.hstack([none, none, none, one]),
        np.hstack([none, one, -np.diag(b), -np.diag(a)]),
    ]
    return np.vstack(rows), np.vstack([none, weight, none, none])


def driving_forces(seed: int, t: Array, size: float) -> Array:
    """Force [N] and moment [N m] (2, N) of 24 sines from 1.5 to 12 rad/s with random phases."""
    rng = np.random.default_rng(seed)
    forces = []
    for sd in size * FORCE:
        w = rng.uniform(1.5, 12.0, 24)
        angle = np.outer(w, t) + rng.uniform(0.0, 2.0 * np.pi, 24)[:, None]
        forces.append(sd * np.sqrt(2.0 / 24) * np.sin(angle).sum(axis=0))
    return np.array(forces) * np.clip(t / 2.0, 0.0, 1.0)


def recorded(seed: int, body: Body, released: Array | None, size: float = 1.0) -> Recording:
    """A run of the real body: driven, or released at a place [m, rad] and left alone."""
    t = np.arange(0.0, SECONDS if released is None else 10.0, 0.005)
    forces, begin = np.zeros((2, len(t))), np.zeros(8)
    if released is None:
        forces = driving_forces(seed, t, size)
    else:
        begin[:2] = released
    a, b = equations(body)
    system = StateSpace(a, b, np.eye(8), np.zeros((8, 2)))
    states = lsim(system, forces.T, t, begin)[1]
    noise = np.random.default_rng(100 + seed).standard_normal((2, len(t)))
    signals = {
        "z_m": states[:, 0] + SENSOR * noise[0],
        "phi_rad": states[:, 1] + SENSOR * noise[1],
        "force_N": forces[0],
        "moment_Nm": forces[1],
    }
    notes = Notes(noise={"heave_sd_m": SENSOR, "roll_sd_rad": SENSOR})
    return Recording(f"run {seed}", t, signals, path=FILE, notes=notes).thinned(RATE)


def driven_runs(body: Body) -> list[Recording]:
    """Three driven runs, of which the last one is held out."""
    return [recorded(seed, body, None) for seed in (1, 2, 3)]


def decays(body: Body) -> list[Recording]:
    """Releases from several places, of which the last one is held out."""
    places = ((0.04, 0.04), (0.02, -0.02), (-0.03, 0.03), (0.03, 0.04))
    return [recorded(seed, body, np.array(place)) for seed, place in enumerate(places)]


def diagnosed(runs: list[Recording], folder: Path, damping: Array = DAMPING) -> Diagnosis:
    """A diagnosis with all candidates of all runs but the last one, which is held out."""
    vessels = {FILE: body_vessel(folder, damping)}
    loaded = LoadedRecordings(runs[:-1], runs[-1:], vessels, runs[-1].name, horizon=5.0)
    return pipeline.diagnose_loaded(loaded)
