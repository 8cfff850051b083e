"""Waves, loads and free motion of MCSimPython (NTNU) for the sea of boatsim.

MCSimPython reads a vessel from a JSON file. That of its C/S Arctic Drillship comes from MSS: SNAME
axes, directions to which the waves run, and phases that lead the crest. Its first-order loads take
phases that lag behind the crest, and its slow drift takes the phases of the waves with the other
sign than its first-order loads. `read_vessel` and `consistent_file` state what each side takes.
"""

import json
from collections.abc import Callable
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from boatsim.hydrodynamics.rao_table import complete_table
from boatsim.physics.base import Array
from boatsim.physics.coefficients.table import WaveLoads
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.vessel import Vessel
from boatsim.physics.waves.field import WaveField
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State
from validation.waves.boats import write_vessel

COLUMNS = ("x", "y", "z", "phi", "theta", "psi")
MATRICES_AT = 41  # number of the frequency whose added mass and damping its vessel takes
VESSEL = """
about = "model of a drillship with uncoupled coefficients"
source = "C/S Arctic Drillship of MCSimPython"
freedoms = ["surge", "sway", "heave", "roll", "pitch", "yaw"]
length = 2.578
beam = 0.444
draught = 0.133

[body]
mass = {mass[0]}
roll_inertia = {mass[3]}
pitch_inertia = {mass[4]}
yaw_inertia = {mass[5]}

[[effect]]
use = "added_mass"
surge = {added[0]}
sway = {added[1]}
heave = {added[2]}
roll = {added[3]}
pitch = {added[4]}
yaw = {added[5]}

[[effect]]
use = "linear_damping"
surge = {damping[0]}
sway = {damping[1]}
heave = {damping[2]}
roll = {damping[3]}
pitch = {damping[4]}
yaw = {damping[5]}

[[effect]]
use = "hydrostatics"
heave = {stiffness[2]}
roll = {stiffness[3]}
pitch = {stiffness[4]}
"""


def vessel_file() -> Path:
    """Return the file of the drillship in the installed package.

    Raises:
        ImportError: MCSimPython is not installed.
    """
    import MCSimPython  # type: ignore[import-not-found]

    return Path(MCSimPython.__file__).parent / "vessel_data" / "CSAD" / "vessel_json.json"


def read_vessel(path: Path) -> WaveLoads:
    """Return loads and mean drift of a vessel file, whose phases lead the crest.

    Args:
        path: The file.
    """
    found = json.loads(path.read_text())
    frequency, heading = np.array(found["freqs"]), np.array(found["headings"])
    size = np.array(found["forceRAO"]["amp"])[..., 0]
    phase = np.array(found["forceRAO"]["phase"])[..., 0]
    waves = np.stack(np.meshgrid(frequency, heading, indexing="ij"), axis=-1).reshape(-1, 2)
    waves[:, 1] = (waves[:, 1] + np.pi + 1e-9) % (2.0 * np.pi) - np.pi - 1e-9
    loads = (size * np.exp(1j * phase)).transpose(1, 2, 0).reshape(-1, 6)
    drift = np.zeros(loads.shape, dtype=complex)
    drift[:, [0, 1, 5]] = np.array(found["driftfrc"]["amp"])[:3, ..., 0].reshape(3, -1).T
    frequency, angle, values = complete_table(waves, loads, path)
    mean = complete_table(waves, drift, path)[2][..., [0, 1, 5]].real
    return WaveLoads(f"MCSimPython, {path.name}", 0.0, frequency, angle, values, mean)


def consistent_file(path: Path, out: Path, finer: int = 1) -> Path:
    """Write a copy of a vessel file with the phases that MCSimPython's loads take.

    They lag behind the crest, and do not jump by whole turns between headings and frequencies.

    Args:
        path: The file.
        out: The copy.
        finer: Number of intervals into which a spline divides those of the frequencies.
    """
    found = json.loads(path.read_text())
    own = np.array(found["freqs"])
    size, phase = np.array(found["forceRAO"]["amp"]), np.array(found["forceRAO"]["phase"])
    steps = np.arange(finer * (len(own) - 1) + 1) / finer
    frequency = np.interp(steps, np.arange(len(own)), own)
    loads = CubicSpline(own, size * np.exp(1j * phase), axis=1)(frequency)
    phase = -np.unwrap(np.unwrap(np.angle(loads), axis=2), axis=1)
    drift = PchipInterpolator(own, found["driftfrc"]["amp"], axis=1)(frequency)
    found["freqs"] = frequency.tolist()
    found["forceRAO"] = {"amp": np.abs(loads).tolist(), "phase": phase.tolist()}
    found["driftfrc"]["amp"] = drift.tolist()
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(json.dumps(found))
    return out


def wave_load(path: Path, waves: WaveField, sign: float = -1.0) -> Any:
    """Return MCSimPython's loads of the waves of a field.

    Args:
        path: Vessel file.
        waves: The waves.
        sign: Of the phases; -1 for those of its first-order loads, 1 for those of its slow drift.
    """
    from MCSimPython.waves import WaveLoad

    with redirect_stdout(StringIO()):
        return WaveLoad(
            waves.amplitude,
            waves.frequency,
            sign * waves.phase,
            waves.direction,
            str(path),
            g=GRAVITY,
        )


def first_order(loads: Any, t: Array, psi: float, place: tuple[float, float]) -> Array:
    """Return the first-order loads (T, 6) on a hull that is held."""
    pose = np.array([place[0], place[1], 0.0, 0.0, 0.0, psi])
    return np.array([loads.first_order_loads(time, pose) for time in t])


def slow_drift(loads: Any, t: Array, psi: float) -> Array:
    """Return mean and slow drift (T, 3) in surge, sway and yaw on a hull that is held."""
    return np.array([loads.second_order_loads(time, psi)[[0, 1, 5]] for time in t])


def spectra(frequency: Array, height: float, period: float, gamma: float) -> dict[str, Array]:
    """Return its spectra by the name of boatsim's (F,) [m^2 s]."""
    from MCSimPython.waves import JONSWAP, ModifiedPiersonMoskowitz

    return {
        "bretschneider": ModifiedPiersonMoskowitz(frequency)(height, period)[1],
        "jonswap": JONSWAP(frequency)(height, period, gamma)[1],
    }


def uncoupled_vessel(step: float, method: str = "RK4") -> Any:
    """Return MCSimPython's drillship with the diagonals of its matrices.

    boatsim has no effect that states the couplings, so that neither has them.

    Args:
        step: Integration step [s].
        method: Method of integration.
    """
    from MCSimPython.simulator import CSAD_DP_6DOF

    own = CSAD_DP_6DOF(step, method=method)
    for name in ("_Mrb", "_Ma", "_M", "_D", "_G"):
        setattr(own, name, np.diag(np.diag(getattr(own, name))))
    own._Minv = np.linalg.inv(own._M)
    return own


def same_vessel(folder: Path, sea: str) -> Vessel:
    """Return the same vessel in boatsim.

    Args:
        folder: Folder in which it is written.
        sea: Table of the effect `panel_wave_loads`.
    """
    own = uncoupled_vessel(0.01)
    text = VESSEL.format(
        mass=np.diag(own._Mrb).tolist(),
        added=np.diag(own._Ma).tolist(),
        damping=np.diag(own._D).tolist(),
        stiffness=np.diag(own._G).tolist(),
    )
    return write_vessel(folder, text + sea)


def free_motion(loads: Any, psi: float, duration: float, step: float) -> Array:
    """Return the motion (T, 6) of its drillship from rest in first-order loads [m, rad].

    Args:
        loads: Loads of `wave_load`.
        psi: Heading at the start [rad].
        duration: Simulated time [s].
        step: Integration step [s].
    """
    own = uncoupled_vessel(step)
    own.set_eta(np.array([0.0, 0.0, 0.0, 0.0, 0.0, psi]))
    rows = []
    for k in range(round(duration / step)):
        own.integrate(0.0, 0.0, loads.first_order_loads(k * step, own.get_eta()))
        rows.append(own.get_eta())
    return np.array(rows)


def drifting_run(loads: Any, duration: float, step: float) -> Callable[[], None]:
    """Return a run of its drillship from rest in first-order loads and slow drift.

    Args:
        loads: Loads of `wave_load`.
        duration: Simulated time [s].
        step: Euler step [s].
    """

    def run() -> None:
        own = uncoupled_vessel(step, "Euler")
        for k in range(round(duration / step)):
            own.integrate(0.0, 0.0, loads(k * step, own.get_eta()))

    return run


def same_free_motion(vessel: Vessel, psi: float, duration: float, step: float) -> Array:
    """Return the motion (T, 6) of the vessel of boatsim from rest [m, rad]."""
    engine = OpenWater(vessel, step=step)
    engine.reset(State(psi=psi))
    rows = []
    for _ in range(round(duration / step)):
        engine.advance()
        state = engine.state
        rows.append([getattr(state, name) for name in COLUMNS])
    return np.array(rows)
