"""Silverbox, an exam of others: an oscillator with a stiffening spring in electronics, read as a hull that only rolls.

`python -m benchmarks.real.silverbox`. The displacement [V] is read as a heel [rad], the input [V] as a thrust [N] that
pushes sideways far above the mass centre. The vessel is a linear oscillator and knows nothing of a cubic spring; it is
written into out/real/silverbox/vessel, for the circuit is no boat of this project. Its clock is slower than the
circuit's: 20 rows are one second, so that it swings twice a second, as a boat of its length might, and every rule of a
diagnosis holds as it stands. Fitted are stretches of the training data; judged are free runs over the whole of the
two test sets, each from a state found in its first 50 rows, of which the error is not counted, as is usual.

The input is filtered to 200 Hz and sampled at 610 Hz, so its course between the rows is known: that of the only
signal with nothing beyond half the rate of the rows that passes through them. Held or in straight lines it is another.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path

import numpy as np
from scipy.signal import resample_poly

from benchmarks.real.common import OUT, report, runs_of, table
from boatsim.diagnose import analysis
from boatsim.diagnose.analysis import Diagnosis
from boatsim.diagnose.filter import Track, track
from boatsim.diagnose.problem import Fit
from boatsim.diagnose.report import show
from boatsim.physics import vessel as vessels
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Orders, Recording

NAME = "silverbox"
ROW = 0.0016384  # [s] of the circuit between two rows
SECOND = 20  # rows that are one second of the vessel
FINER = 5  # instants a row at which the input is known
START = 50  # rows in which the first state is found, their error not counted
MULTISINE, ARROW = "test_multisine", "test_arrow"
INSIDE = 32_000  # rows of the arrow whose amplitude the training data reach
SWINGS, DAMPED = 70.0, 0.05  # [Hz], share of critical: about what the circuit is built for, by its description
MASS, ARM = 4.6, 0.1  # [kg], [m] radius of gyration: a boat of 1.2 m
FITTED, UNSEEN = ((0, 2000), (20_000, 22_000), (40_000, 42_000)), ((60_000, 62_000),)  # rows of the training data
GOAL = 1.0  # [mV] over the arrow
MV = 1e3

VESSEL = """\
about = "Silverbox: an electronic oscillator read as a hull that only rolls, one V as one rad, {second} rows as one s"
source = "T. Wigren, J. Schoukens, Three free data sets for development and benchmarking, European Control Conference 2013"
freedoms = ["roll"]
length = 1.2                    # [m] any would do: of this one the times of a diagnosis are those of its rules
beam = 0.3                      # [m]
draught = 0.1                   # [m]
body = {{ mass = {mass}, roll_inertia = {inertia:.6g}, yaw_inertia = 0.4 }}  # [kg], [kg m^2]

[channels]
force_V = {{ low = -1.0, high = 1.0, about = "the input" }}

[[effect]]
use = "linear_damping"
roll = {damping:.6g}            # [N m s] {damped:g} of critical

[[effect]]
use = "righting_arm"
stiffness = {stiffness:.6g}     # [N m] for {swings:g} Hz on the circuit's clock

[[effect]]
use = "thruster"
on = {{ thrust = "force_V", angle = {abeam:.9g} }}
z = {lever:.6g}                 # [m] a steady V then heels it by a V

[diagnosis]
coefficient_uncertainty = {{ damping = 0.5, restoring = 0.2, thrust = 0.2 }}  # of round numbers
facts = {{ indoors = true }}
"""
HULL = '<mujoco><worldbody><body name="hull"><geom type="box" size="0.6 0.15 0.1"/></body></worldbody></mujoco>\n'


@dataclass(frozen=True)
class Published:
    """Rms errors [mV] of others over the two test sets and over the arrow without its tip; nan where none is printed."""

    model: str
    multisine: float
    arrow: float
    inside: float
    by: str


NONE = float("nan")
PUBLISHED = (
    Published("linear, second order", 7.02, 14.2, 6.63, "README of the data"),
    Published("+ cubic spring", 0.914, 0.961, 0.753, "README of the data"),
    Published("LSTM", 1.50, 2.68, 0.96, "arXiv 2405.10779"),
    Published("GRU", 1.49, 2.80, 0.95, "arXiv 2405.10779"),
    Published("polynomial state space", NONE, 0.26, NONE, "Paduart et al., as quoted"),
)


# ---- the circuit as a vessel


def written(folder: Path = OUT / NAME / "vessel" / NAME) -> Vessel:
    """The linear oscillator, its file made in `folder`."""
    inertia = MASS * ARM**2
    pulsation = 2.0 * pi * SWINGS * SECOND * ROW  # [rad/s] on the vessel's clock
    stiffness = inertia * pulsation**2
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "hull.xml").write_text(HULL, encoding="utf-8")
    text = VESSEL.format(
        second=SECOND, mass=MASS, inertia=inertia, damping=2.0 * DAMPED * inertia * pulsation, damped=DAMPED,
        stiffness=stiffness, swings=SWINGS, abeam=0.5 * pi, lever=-stiffness,
    )  # fmt: skip
    file = folder / "vessel.toml"
    file.write_text(text, encoding="utf-8")
    return vessels.load(str(file))


def opened(path: Path, between: str = "band") -> Recording:
    """A set on the vessel's clock, with the input between its rows as a band-limited signal, in lines or held."""
    columns = np.genfromtxt(path, delimiter=",", names=True)
    force, count = columns["force_V"], len(columns)
    t, fine = np.arange(count) / SECOND, np.arange(count * FINER) / (SECOND * FINER)
    if between == "held":
        courses = np.repeat(force, FINER)
    else:
        # a course is held from each instant to the next, so it is taken in the middle between them
        middle = (np.arange(count * FINER) + 0.5) / FINER
        courses = np.interp(middle, np.arange(count), force) if between == "lines" else _band(force)
    signals = {"phi_rad": columns["displacement_V"], "force_V": courses.reshape(count, FINER).mean(axis=1)}
    return Recording(path.stem, t, signals, path=path, orders=Orders(fine, {"force_V": courses}))


def _band(force: Array) -> Array:
    """The band-limited signal (N FINER,) through equidistant values (N,), in the middle of each of FINER parts."""
    finer = resample_poly(force - force[0], 2 * FINER, 1, window=("kaiser", 8.0), padtype="line")
    return np.asarray(finer[1::2] + force[0])


def part(whole: Recording, begin: int, end: int) -> Recording:
    """Some rows of a set, named by them."""
    half = 0.5 / SECOND
    return replace(whole.between(begin / SECOND, end / SECOND - half), name=f"{whole.name} rows {begin} to {end}")


def diagnosed(whole: Recording, boat: Vessel) -> Diagnosis:
    """What the linear oscillator lacks, by stretches of the training data."""
    fitted, unseen = ([part(whole, *rows) for rows in parts] for parts in (FITTED, UNSEEN))
    note = f"{', '.join(r.name for r in unseen)} were kept unseen"
    return analysis.diagnose_recordings(fitted, unseen, {whole.path: boat}, note)


# ---- the exam


def examined(found: Diagnosis, test: Recording, models: Mapping[str, Fit]) -> dict[str, Array]:
    """Simulated displacement (N,) [V] of each model over a whole set.

    It is given the input, and of the displacement the first rows alone, in which it finds the state it starts from.
    """
    shown = test["phi_rad"].copy()
    shown[START:] = np.nan
    problem = found.problem
    laid = track(replace(test, signals={**test.signals, "phi_rad": shown}), problem.program)
    return {name: _simulated(found, laid, f) for name, f in models.items()}


def _simulated(found: Diagnosis, laid: Track, f: Fit) -> Array:
    values, on = found.problem.values(laid, f.free, f.theta), found.problem.program.switches(f.suspects)
    ((_, states),) = laid.free_runs(values, on, f.levels, float(np.ptp(laid.times)))
    return np.asarray(states[:, 0])


def scores(off: Array, name: str) -> list[float]:
    """Rms errors [mV] that count of a set: of all, and of the arrow without its tip as well."""
    ends = (len(off), INSIDE) if name == ARROW else (len(off),)
    return [MV * float(np.sqrt(np.mean(off[START:end] ** 2))) for end in ends]
