"""Forward prediction of a recorded ship section in beam waves from Capytaine's numbers alone.

The section spans a flume between glass walls (`section_beam_waves`, NTNU). Its coefficients per
length are differences of those of two long bodies, in which the ends cancel. The measured incident
wave is turned into the excitation by the table, over all frequencies; the section moves by its
memory, buoyancy, weight and mass. No number is fitted, and there is no viscous damping. The
recorded motion is that of the log as a diagnosis corrects it, with the poses on the clock of the
waves.
"""

import csv
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from boatsim.diagnosis import loading
from boatsim.hydrodynamics.axes import with_memory
from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.hydrodynamics.response import linear_stiffness
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.files import read_coefficients, write_coefficients
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from boatsim.simulate.open_water import OpenWater
from validation.real import section_beam_waves
from validation.waves.boats import write_vessel
from validation.waves.hulls import Section, write_section

RUNS = Path(__file__).parents[3] / "shared" / "recordings" / "section_beam_waves" / "runs_clean"
# Published particulars: `validation/real/section/vessel.toml`
BEAM, DRAUGHT, BILGE, LENGTH = 0.40, 0.20, 0.0512, 0.586  # [m]
MASS, RAILS, INERTIA = 46.8, 0.303, 0.970  # [kg], [kg] more in sway, [kg m^2]
DEPTH = DRAUGHT - 0.106  # [m] of the mass centre below the waterline; it is 0.106 m above the keel
DENSITY, WATER = 1000.0, 1.0  # [kg/m^3], [m] depth of the flume
BEGIN = 20.0  # [s] the section is at rest until then
RATE = 200.0  # [Hz] of the simulation
LONGEST = 1.0  # [s] shorter waves are counted apart
HELD = {"3": "", "4": "roll", "5": "heave", "6": "sway"}  # by the rig, by the kind of the run
PERIODS: tuple[float, ...] = (1.516, 1.269, 1.238, 1.210, 1.183, 1.158, 1.113)
PERIODS += (1.072, 1.036, 0.897, 0.802, 0.733, 0.678, 0.634)  # [s] by the number of the run
SIGNALS = {"heave": "z_m", "roll": "phi_rad"}
TEXT = """
about = "ship section between walls"
source = "section_beam_waves"
freedoms = ["sway", "heave", "roll"]
length = 0.586
beam = 0.40
draught = 0.20
body = {{ mass = {mass}, centre = [0.0, {depth}], roll_inertia = {inertia}, yaw_inertia = 1.35 }}

[channels]
Y_N = {{ low = -1e4, high = 1e4 }}
Z_N = {{ low = -1e4, high = 1e4 }}
K_Nm = {{ low = -1e4, high = 1e4 }}

[[effect]]
use = "radiation_memory"
coefficients = "{folder}"
coriolis = 0.0

[[effect]]
use = "hydrostatics"
heave = {heave}
roll = {roll}
vertical = 1.0

[[effect]]
use = "applied_load"
name = "excitation"
on = {{ force = "Y_N", moment = "K_Nm" }}
sway = 1.0
roll = 1.0

[[effect]]
use = "applied_load"
name = "vertical_excitation"
on = {{ force = "Z_N" }}
heave = 1.0
"""


class LongBodies(NamedTuple):
    """Two long bodies with the section, whose difference is the section without ends."""

    short: float  # [m] length
    long: float  # [m]
    panel: float  # [m] along the bodies
    section: Section
    depth: float  # [m] of the water, 0: deep
    frequencies: list[float]  # [rad/s]


FLUME = LongBodies(
    short=4.0,  # ten beams
    long=6.0,
    panel=0.25,
    section=Section(BEAM, DRAUGHT, BILGE),
    depth=WATER,
    frequencies=[float(w) for w in np.linspace(2.0, 11.0, 19)],  # waves of 0.57 to 3.1 s
)


class BodyResult(NamedTuple):
    """Result of Capytaine for one long body."""

    rows: list[dict[str, Any]]
    coefficients: Coefficients


def computed_bodies(folder: Path, bodies: LongBodies) -> tuple[BodyResult, BodyResult]:
    """Return the results of the short and of the long body in beam waves.

    Args:
        folder: Working folder.
        bodies: The bodies.
    """
    results = []
    for length in (bodies.short, bodies.long):
        path = folder / f"section_{length:g}.stl"
        path.parent.mkdir(parents=True, exist_ok=True)
        write_section(path, bodies.section, length, round(length / bodies.panel))
        hull = HullMesh(path, DRAUGHT, density=DENSITY, depth=bodies.depth)
        heading = [0.5 * np.pi]
        rows = run_capytaine(hull, bodies.frequencies, heading, lambda stage, share: None)
        results.append(BodyResult(rows, coefficients_of_rows(rows, hull, heading)))
    return results[0], results[1]


def section_coefficients(folder: Path, bodies: LongBodies) -> Coefficients:
    """Return the coefficients of the section, without memory.

    Args:
        folder: Working folder.
        bodies: Bodies of which it is the difference.
    """
    short, long = (result.coefficients for result in computed_bodies(folder, bodies))
    share = LENGTH / (bodies.long - bodies.short)
    values = {}
    for name in (
        "added_mass",
        "damping",
        "infinite_added_mass",
        "excitation",
        "restoring",
        "volume",
    ):
        values[name] = share * (getattr(long, name) - getattr(short, name))
    # sway, heave and roll only: moments along the body have no meaning for the section
    for name in ("added_mass", "damping", "infinite_added_mass"):
        values[name] = values[name].copy()
        for axis in ("surge", "pitch", "yaw"):
            values[name][..., AXES.index(axis), :] = 0.0
            values[name][..., :, AXES.index(axis)] = 0.0
    return replace(long, source=f"{long.source}, of a section", **values)


def run_errors(folder: Path) -> list[tuple[str, float, dict[str, float]]]:
    """Return the errors of all runs: name, period [s], and for each axis error over motion.

    Args:
        folder: Working folder.
    """
    about_waterline = section_coefficients(folder, FLUME)
    stiffness = linear_stiffness(about_waterline, MASS, DEPTH)
    # about the origin of each kind of run
    coefficients = {"sway": _written(folder / "about_mass_centre", at_mass_centre(about_waterline))}
    for held in ("", "roll", "heave"):
        coefficients[held] = _written(folder / "about_waterline", about_waterline)
    results = []
    for recording in corrected_runs():
        held = HELD[recording.name[0]]
        period = PERIODS[int(recording.name[1:3]) - 1]
        table = _read_run(RUNS / f"{recording.name}.csv")
        found = coefficients[held]
        predicted = _predicted(_vessel(folder, found.folder, stiffness, held), found.values, table)
        rest = table["t_s"] < BEGIN
        errors = {}
        for axis, column in SIGNALS.items():
            if axis != held:
                recorded = recording.signals[column]
                error = np.interp(recording.t, table["t_s"], predicted[axis]) - recorded
                motion = recorded - np.nanmean(table[column][rest])
                errors[axis] = float(np.sqrt(np.nanmean(error**2) / np.nanmean(motion**2)))
        results.append((recording.name, period, errors))
    return results


class Written(NamedTuple):
    """Coefficients that were written to a folder."""

    folder: Path
    values: Coefficients


def _written(folder: Path, coefficients: Coefficients) -> Written:
    """Write coefficients, with their memory, to a folder, and read them again."""
    write_coefficients(folder, with_memory(coefficients))
    return Written(folder, read_coefficients(folder))


def at_mass_centre(found: Coefficients) -> Coefficients:
    """Return coefficients of sway and roll about the mass centre instead of the waterline.

    The rig holds the section there, as the natural period of roll shows (`roll_periods`).

    Args:
        found: Coefficients about the waterline.
    """
    moved = np.eye(len(AXES))
    moved[AXES.index("sway"), AXES.index("roll")] = DEPTH
    values = {}
    for name in ("added_mass", "damping", "infinite_added_mass"):
        values[name] = moved.T @ getattr(found, name) @ moved
    return replace(found, excitation=found.excitation @ moved, **values)


def roll_periods(folder: Path) -> tuple[float, float]:
    """Return the natural period of roll, undamped, held in sway at mass centre and waterline [s].

    Args:
        folder: Working folder.
    """
    found = section_coefficients(folder, FLUME)
    stiffness = linear_stiffness(found, MASS, DEPTH)[AXES.index("roll"), AXES.index("roll")]
    at_centre = _roll_period(at_mass_centre(found), stiffness, INERTIA)
    return at_centre, _roll_period(found, stiffness, INERTIA + MASS * DEPTH**2)


def _roll_period(found: Coefficients, stiffness: float, inertia: float) -> float:
    """Period at which inertia and stiffness of roll balance [s]."""
    roll = AXES.index("roll")
    balance = (inertia + found.added_mass[:, roll, roll]) * found.frequency**2 - stiffness
    above = int(np.argmax(balance > 0.0))
    pair = slice(above - 1, above + 1)
    return float(2.0 * np.pi / np.interp(0.0, balance[pair], found.frequency[pair]))


def corrected_runs() -> list[Recording]:
    """Return the recordings from the begin of the waves, as a diagnosis corrects them.

    The accelerometers show that the poses of most runs are on a clock of their own.
    """
    files = section_beam_waves.copied_runs(RUNS.name)
    loaded = loading.load_recordings(loading.Request(files[:1], hold_out=files[1:]))
    return sorted([*loaded.fitted, *loaded.held_out], key=lambda one: one.name)


def _read_run(path: Path) -> dict[str, Array]:
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key] or "nan") for row in rows]) for key in rows[0]}


def _vessel(folder: Path, coefficients: Path, stiffness: Array, held: str) -> Vessel:
    """Return the section; the rig holds the given degree of freedom, if any."""
    depth = DEPTH
    if held == "sway":
        depth = 0.0  # the origin is the mass centre
    text = TEXT.format(
        mass=MASS,
        depth=depth,
        inertia=INERTIA,
        folder=coefficients.resolve(),
        heave=stiffness[2, 2],
        roll=stiffness[3, 3],
    )
    if held:
        text += f'\n[[effect]]\nuse = "held_freedom"\n{held} = 1.0\n'
    return write_vessel(folder / f"section_{held or 'free'}", text)


def _predicted(vessel: Vessel, found: Coefficients, table: dict[str, Array]) -> dict[str, Array]:
    """Return the motion of the section under the measured wave, at the rows of the table."""
    t, wave = table["t_s"], np.nan_to_num(table["wave_in_m"])
    fine = np.arange(t[0], t[-1], 1.0 / RATE)
    elevation = CubicSpline(t, wave)(fine)
    # The waves run to port, which is the mirror of those to starboard
    spectrum = np.fft.rfft(elevation)
    w = 2.0 * np.pi * np.fft.rfftfreq(len(fine), 1.0 / RATE)
    inside = (w >= found.frequency[0]) & (w <= found.frequency[-1])
    loads = {}
    for axis, channel, sign in (
        ("sway", "Y_N", -1.0),
        ("heave", "Z_N", 1.0),
        ("roll", "K_Nm", -1.0),
    ):
        transfer = CubicSpline(found.frequency, found.excitation[:, 0, AXES.index(axis)])(
            np.clip(w, found.frequency[0], found.frequency[-1])
        )
        loads[channel] = np.fft.irfft(spectrum * sign * transfer * inside, len(fine))
    engine = OpenWater(vessel, step=1.0 / RATE)
    rows = []
    for i in range(len(fine)):
        rows.append([engine.state.z, engine.state.phi])
        engine.command({channel: float(values[i]) for channel, values in loads.items()})
        engine.advance()
    motion = np.array(rows)
    return {
        "heave": np.interp(t, fine, motion[:, 0]),
        "roll": np.interp(t, fine, motion[:, 1]),
    }
