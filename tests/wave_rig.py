"""A ship section on a rig in a measured beam wave, as it might really be, free in one axis.

The motion is integrated by scipy and shares no code with boatsim. The forces of the wave are exact
for each of its components: no filter acts.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Notes, Recording

PARTS = ("elevation", "rate", "acceleration")
SMOOTHING = 1.5 / np.sqrt(9.80665 / 0.4)  # [s] over which drift forces follow the wave, two lags
SENSOR = 2e-4  # [m] noise of the camera
RATE = 20.0  # [Hz] of both
FILE = Path("tank.csv")
SEEDS = (1, 2, 3)  # of the runs; the last one is held out
HULL = """<mujoco model="section"><worldbody><body name="hull">
<geom type="box" size="0.3 0.2 0.13"/></body></worldbody></mujoco>"""
SECTION = """
about = "a section on a rig in beam waves"
source = "none"
freedoms = ["{axis}"]
length = 0.6
beam = 0.4
draught = 0.2
body = {{ mass = 48.0, roll_inertia = 1.0, yaw_inertia = 1.4 }}

[measured]
wave_m = {{}}

[[effect]]
use = "added_mass"
surge = 0.0
sway = 32.0
heave = 32.0
yaw = 0.0

[[effect]]
use = "linear_damping"
{axis} = {damping}

[diagnosis]
rate = 10.0
reasons = {{ rate = "ten rows in a period of the wave" }}
coefficient_uncertainty = {{ wave = {uncertain} }}
facts = {{ guided = true, indoors = true, forward_speed_mps = 0.0 }}
"""
HYDROSTATICS = """
[[effect]]
use = "hydrostatics"
heave = 2300.0
vertical = 1.0
"""


class Axis(NamedTuple):
    """Numbers of the vessel file about one axis."""

    name: str
    column: str
    inertia: float  # [kg] with added mass
    damping: float  # [N s/m]
    restoring: float  # [N/m] of the water
    excitation: Array  # force per elevation [N/m], rate [N s/m] and acceleration [kg] of the wave


SWAY = Axis("sway", "y_m", 80.0, 15.0, 0.0, np.array([-300.0, -200.0, -5.0]))
HEAVE = Axis("heave", "z_m", 80.0, 60.0, 2300.0, np.array([-1800.0, -40.0, -25.0]))


@dataclass(frozen=True)
class Rig:
    """What the real section has, in addition to the inertia and damping of the vessel file."""

    axis: Axis
    excited: float = 1.0  # forces of the wave over those of `Axis`
    stiffness: float = 0.0  # [N/m] of a spring to the ground
    drift: float = 0.0  # [N/m^2] force per mean square of the elevation
    released: float = 0.0  # [m] place where the section is released
    height: float = 0.012  # [m] amplitude of a regular wave, standard deviation of an irregular one
    regular: bool = False
    seconds: float = 40.0
    probe_sd: float = 2e-5  # [m] noise of the wave probe


def section(folder: Path, axis: Axis, excited: float, uncertain: float) -> Vessel:
    """The section as a vessel with this share of the wave forces, uncertain by that share."""
    text = SECTION.format(axis=axis.name, damping=axis.damping, uncertain=uncertain)
    if axis.restoring:
        text += HYDROSTATICS
    text += '\n[[effect]]\nuse = "wave_excitation"\non = { elevation = "wave_m" }\n'
    for part, value in zip(PARTS, axis.excitation, strict=True):
        text += f"{axis.name}_{part} = {excited * value:.6g}\n"
    (folder / "hull.xml").write_text(HULL)
    (folder / "vessel.toml").write_text(text)
    return vessel.load_vessel(str(folder))


def frequencies(seed: int, rig: Rig) -> Array:
    """Frequencies of the components of a wave [rad/s]: of one, or of 30 with random phases."""
    rng = np.random.default_rng(seed)
    if rig.regular:
        return rng.uniform(4.0, 7.0, 1)
    return rng.normal(5.5, 1.0, 30)


def wave(seed: int, rig: Rig, t: Array) -> Array:
    """Elevation [m], rate [m/s] and acceleration [m/s^2] (3, N) of a wave that arrives in 4 s."""
    w = frequencies(seed, rig)
    size, phase = np.array([rig.height]), np.zeros(1)
    if not rig.regular:
        phase = np.random.default_rng(50 + seed).uniform(0.0, 2.0 * np.pi, len(w))
        size = np.full(len(w), rig.height * np.sqrt(2.0 / len(w)))
    angle = np.outer(w, t) + phase[:, None]
    arrived = np.clip(t / 4.0, 0.0, 1.0)
    parts = [size @ np.sin(angle), (size * w) @ np.cos(angle), -(size * w**2) @ np.sin(angle)]
    return arrived * np.array(parts)


def recorded(seed: int, rig: Rig) -> Recording:
    """A run of the real section with noise of camera and wave probe."""
    axis = rig.axis

    def slopes(t: float, y: Array) -> list[float]:
        elevation = wave(seed, rig, np.array([t]))[:, 0]
        force = rig.excited * float(axis.excitation @ elevation) + rig.drift * y[3]
        force -= axis.damping * y[1] + (axis.restoring + rig.stiffness) * y[0]
        lags = (elevation[0] ** 2 - y[2]) / SMOOTHING, (y[2] - y[3]) / SMOOTHING
        return [y[1], force / axis.inertia, *lags]

    t = np.arange(0.0, rig.seconds, 1.0 / RATE)
    begin = (rig.released, 0.0, 0.0, 0.0)
    run = solve_ivp(slopes, (0.0, rig.seconds), begin, "RK45", t, rtol=1e-8, max_step=0.05)
    noise = np.random.default_rng(100 + seed).standard_normal((2, len(t)))
    elevation = wave(seed, rig, t)[0] + rig.probe_sd * noise[1]
    signals = {axis.column: run.y[0] + SENSOR * noise[0], "wave_m": elevation}
    notes = Notes(noise={"position_sd_m": SENSOR, "heave_sd_m": SENSOR})
    return Recording(f"run {seed}", t, signals, path=FILE, notes=notes).thinned(10.0)


def diagnosed(rig: Rig, folder: Path, excited: float = 1.0, uncertain: float = 0.05) -> Diagnosis:
    """A diagnosis with all candidates of the runs of two seeds; a third run is held out.

    The vessel file contains the given share of the wave forces, with a relative uncertainty.
    """
    runs = [recorded(seed, rig) for seed in SEEDS]
    vessels = {FILE: section(folder, rig.axis, excited, uncertain)}
    loaded = LoadedRecordings(runs[:2], runs[2:], vessels, runs[2].name, horizon=10.0)
    return pipeline.diagnose_loaded(loaded)
