"""Silverbox, a public benchmark of system identification: `python -m validation.real.silverbox`.

The Silverbox is an electronic oscillator with a stiffening spring. It is treated as a hull that
only rolls: the displacement [V] is a roll angle [rad], and the input [V] is a thrust [N] that
pushes sideways far above the mass centre. The vessel is a linear oscillator without a cubic spring.
It is written to out/real/silverbox/vessel, because the circuit is no boat of this project. Its
clock is slower than the circuit's: 20 rows are one second. It then oscillates twice a second, as a
boat of its length might, so the defaults of a diagnosis apply unchanged.

Stretches of the training data are fitted. Free runs over the two whole test sets are judged. Each
starts from a state estimated from its first 50 rows, whose error is not counted, as is usual.

The input is filtered to 200 Hz and sampled at 610 Hz, so its course between the rows is known: it
is the only signal through the rows that has no content beyond half their rate. A held or linearly
interpolated input is a different signal. The interpolation uses ten rows of the input before and
after each instant, and nothing of the displacement.
"""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import starmap
from math import pi
from pathlib import Path

import numpy as np
from scipy.signal import resample_poly

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.locate.residual_structure import find_structure
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.physics import vessel as vessels
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording, TimedCommands
from validation.real.common import (
    OUT,
    format_fixed,
    names_of,
    print_table,
    runs_named,
    runs_of,
    write_report,
)
from validation.real.kvlcc2_roll_decay import simulate, with_effects

NAME = "silverbox"
ROW = 0.0016384  # [s] of the circuit between two rows
SECOND = 20  # rows that are one second of the vessel
FINER = 5  # instants per row at which the input is known
START = 50  # rows from which the first state is estimated, their error not counted
MULTISINE = "test_multisine"
ARROW = "test_arrow"
INSIDE = 32_000  # rows of the arrow whose amplitude the training data reach
# [Hz], share of critical: nominal values of the circuit, by the description of the data
NATURAL_FREQUENCY = 70.0
DAMPING_RATIO = 0.05
# [kg], [m] radius of gyration: a boat of 1.2 m
MASS = 4.6
GYRATION = 0.1
# rows of the training data
FITTED = ((0, 2000), (20_000, 22_000), (40_000, 42_000))
HELD_OUT = (60_000, 62_000)
GOAL = 1.0  # [mV] over the arrow
MV = 1e3  # [mV/V]
BANDS = ((0.0, 20.0), (20.0, 55.0), (55.0, 90.0), (90.0, 200.0), (200.0, 306.0))  # [Hz]
INTERPOLATIONS = {
    "band": "as the band-limited signal",
    "lines": "in straight lines",
    "held": "held until the next",
}
# effects with which the interpolations of the input are compared
COMPARED = ("righting_arm_stiffening", "steady_force")

VESSEL = """\
about = "Silverbox: an oscillator as a hull that only rolls; 1 V is 1 rad, {second} rows are 1 s"
source = "T. Wigren, J. Schoukens, Three free data sets for ... system identification, ECC 2013"
freedoms = ["roll"]
length = 1.2                    # [m] arbitrary: sets the time constants of a diagnosis
beam = 0.3                      # [m]
draught = 0.1                   # [m]
body = {{ mass = {mass}, roll_inertia = {inertia:.6g}, yaw_inertia = 0.4 }}  # [kg], [kg m^2]

[channels]
force_V = {{ low = -1.0, high = 1.0, about = "input of the circuit" }}

[[effect]]
use = "linear_damping"
roll = {damping:.6g}            # [N m s] {damping_ratio:g} of critical

[[effect]]
use = "righting_arm"
stiffness = {stiffness:.6g}     # [N m] for {frequency:g} Hz on the circuit's clock

[[effect]]
use = "thruster"
on = {{ thrust = "force_V", angle = {abeam:.9g} }}
z = {lever:.6g}                 # [m] a steady 1 V then heels it by 1 V

[diagnosis]
coefficient_uncertainty = {{ damping = 0.5, restoring = 0.2, thrust = 0.2 }}  # rounded
facts = {{ indoors = true }}
"""
HULL = (
    '<mujoco><worldbody><body name="hull"><geom type="box" size="0.6 0.15 0.1"/>'
    "</body></worldbody></mujoco>\n"
)


@dataclass(frozen=True)
class Published:
    """Rms errors [mV] of other models over the test sets and over the arrow without its tip.

    A value that is not published is nan.
    """

    model: str
    multisine: float
    arrow: float
    inside: float
    source: str


NONE = float("nan")
PUBLISHED = (
    Published("linear, second order", 7.02, 14.2, 6.63, "README of the data"),
    Published("+ cubic spring", 0.914, 0.961, 0.753, "README of the data"),
    Published("LSTM", 1.50, 2.68, 0.96, "arXiv 2405.10779"),
    Published("GRU", 1.49, 2.80, 0.95, "arXiv 2405.10779"),
    Published("polynomial state space", NONE, 0.26, NONE, "Paduart et al., as quoted"),
)


# ---- the circuit as a vessel


def write_vessel(folder: Path = OUT / NAME / "vessel" / NAME) -> Vessel:
    """Write the linear oscillator into a folder and return it."""
    inertia = MASS * GYRATION**2
    omega = 2.0 * pi * NATURAL_FREQUENCY * SECOND * ROW  # [rad/s] on the vessel's clock
    stiffness = inertia * omega**2
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "hull.xml").write_text(HULL, encoding="utf-8")
    text = VESSEL.format(
        second=SECOND,
        mass=MASS,
        inertia=inertia,
        damping=2.0 * DAMPING_RATIO * inertia * omega,
        damping_ratio=DAMPING_RATIO,
        stiffness=stiffness,
        frequency=NATURAL_FREQUENCY,
        abeam=0.5 * pi,
        lever=-stiffness,
    )
    file = folder / "vessel.toml"
    file.write_text(text, encoding="utf-8")
    return vessels.load_vessel(str(file))


def open_set(path: Path, interpolation: str = "band") -> Recording:
    """Return a set of the data on the vessel's clock.

    Args:
        path: File of the set.
        interpolation: Course of the input between the rows, a key of `INTERPOLATIONS`.
    """
    columns = np.genfromtxt(path, delimiter=",", names=True)
    force, count = columns["force_V"], len(columns)
    t = np.arange(count) / SECOND
    # an order is held from each instant to the next, so it is the value in the middle of them
    middle = (np.arange(count * FINER) + 0.5) / FINER
    if interpolation == "held":
        orders = np.repeat(force, FINER)
    elif interpolation == "lines":
        orders = np.interp(middle, np.arange(count), force)
    else:
        orders = _band_limited(force)
    signals = {
        "phi_rad": columns["displacement_V"],
        "force_V": orders.reshape(count, FINER).mean(axis=1),
    }
    fine = TimedCommands(np.arange(count * FINER) / (SECOND * FINER), {"force_V": orders})
    return Recording(path.stem, t, signals, path=path, orders=fine)


def _band_limited(force: Array) -> Array:
    """Return the band-limited signal (N FINER,) through equidistant values (N,).

    Its instants are the middles of FINER parts of each row.
    """
    finer = resample_poly(force - force[0], 2 * FINER, 1, window=("kaiser", 8.0), padtype="line")
    return np.asarray(finer[1::2] + force[0])


def slice_rows(whole: Recording, begin: int, end: int) -> Recording:
    """Return some rows of a set, named by them."""
    part = whole.between(begin / SECOND, end / SECOND - 0.5 / SECOND)
    return replace(part, name=f"{whole.name} rows {begin} to {end}")


def diagnose(whole: Recording, vessel: Vessel) -> Diagnosis:
    """Diagnose the linear oscillator from stretches of the training data."""
    fitted = list(starmap(partial(slice_rows, whole), FITTED))
    held_out = slice_rows(whole, *HELD_OUT)
    return pipeline.diagnose_loaded(
        LoadedRecordings(fitted, [held_out], {whole.path: vessel}, held_out.name)
    )


# ---- judgement


def map_test(diagnosis: Diagnosis, test: Recording) -> MappedRecording:
    """Return a mapped set with all of the input, and only the first rows of the displacement."""
    phi = test["phi_rad"].copy()
    phi[START:] = np.nan
    return diagnosis.map_recording(replace(test, signals={**test.signals, "phi_rad": phi}))


def simulation_errors(
    diagnosis: Diagnosis, test: Recording, models: Mapping[str, Fit]
) -> dict[str, Array]:
    """Return the simulated minus the recorded displacement (N,) [V] of each model.

    Each is one free run over the whole set, from the state estimated from the first rows.
    """
    mapped = map_test(diagnosis, test)
    off = {}
    for name, model in models.items():
        off[name] = simulate(diagnosis.problem, mapped, model)[:, 0] - test["phi_rad"]
    return off


def rms(off: Array, begin: int = START, end: int | None = None) -> float:
    """Return the rms of some rows of an error (N,) [V] in mV."""
    return MV * float(np.sqrt(np.mean(off[begin:end] ** 2)))


def models_of(diagnosis: Diagnosis) -> dict[str, Fit]:
    """Return the linear oscillator, that with one more effect at a time, and the corrected one."""
    ranking = diagnosis.ranking
    models = {"linear, as written": ranking.nominal, "linear, retuned": ranking.recalibrated}
    identified = names_of(ranking.named)
    names: list[str] = []
    for name in ranking.best.effects:
        if name in identified:
            names.append(name)
            models[f"+ {name}"] = with_effects(diagnosis.problem, ranking.recalibrated, names)
    return models | {"corrected": ranking.best}


# ---- tables


def score_rows(off: Mapping[str, Mapping[str, Array]]) -> list[list[str]]:
    """Return rows with the rms errors of our models and of others.

    Args:
        off: Errors (N,) [V] by set and model.
    """
    rows = []
    for model, arrow in off[ARROW].items():
        inside = rms(arrow, end=INSIDE)
        rows.append(
            [model, *format_fixed(3, rms(off[MULTISINE][model]), rms(arrow), inside), "here"]
        )
    for p in PUBLISHED:
        numbers = [f"{x:g}".replace("nan", "") for x in (p.multisine, p.arrow, p.inside)]
        rows.append([p.model, *numbers, p.source])
    return rows


def input_rows(whole: Path, diagnosis: Diagnosis) -> list[list[str]]:
    """Return rows that compare the interpolations of the input.

    The same structure is fitted with each, and judged on held-out training data.
    """
    problem = diagnosis.problem
    rows = []
    for interpolation, words in INTERPOLATIONS.items():
        recording = open_set(whole, interpolation)
        parts = starmap(partial(slice_rows, recording), FITTED)
        fitted = [map_recording(part, problem.program) for part in parts]
        refitted = Problem(fitted, problem.ambient, problem.uncertainty)
        _, base = fit_baseline(refitted)
        models = {"linear": base, "found": with_effects(refitted, base, COMPARED)}
        off = simulation_errors(diagnosis, slice_rows(recording, *HELD_OUT), models)
        evidence = f"{models['found'].evidence:.0f}"
        rows.append([words, *format_fixed(3, *map(rms, off.values())), evidence])
    return rows


def amplitude_rows(off: Mapping[str, Array], test: Recording) -> list[list[str]]:
    """Return rows with the errors in eighths of the arrow, whose amplitude grows."""
    edges = np.linspace(START, len(test), 9).astype(int).tolist()
    phi = test["phi_rad"] - float(np.mean(test["phi_rad"]))
    rows = []
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        amplitude = rms(phi, a, b)
        left = [rms(e, a, b) for e in off.values()]
        share = f"{100 * left[-1] / amplitude:.2f}"
        rows.append([f"rows {a} to {b}", f"{amplitude:.1f}", *format_fixed(3, *left), share])
    return rows


def band_rows(off: Mapping[str, Array]) -> list[list[str]]:
    """Return rows with the shares of the errors by frequency on the circuit's clock."""
    rows = []
    for low, high in BANDS:
        shares = []
        for e in off.values():
            spectrum = np.abs(np.fft.rfft(e[START:])) ** 2
            hertz = np.fft.rfftfreq(len(e) - START, ROW)
            inside = (hertz >= low) & (hertz < high)
            shares.append(100 * float(spectrum[inside].sum() / spectrum.sum()))
        rows.append([f"{low:g} to {high:g} Hz", *format_fixed(0, *shares)])
    return rows


def residual_text(diagnosis: Diagnosis) -> str:
    """Return what the diagnosis reports about the residual of the best model."""
    best = diagnosis.ranking.best
    structure = find_structure(diagnosis.problem, best)
    ratio = float(best.levels.force[0] / diagnosis.problem.ambient.force[0])
    total = best.evidence - diagnosis.ranking.recalibrated.evidence
    return (
        f"residual: a moment of {ratio:.1f} times the tolerated one; it correlates best with "
        f"{structure.goes_with}, by {structure.gain:.0f} nats of {total:.0f}"
    )


def main() -> None:
    """Diagnose on training data, simulate the test sets, compare."""
    runs = runs_of(NAME)
    vessel = write_vessel()
    begin = time.perf_counter()
    diagnosis = diagnose(open_set(runs["train"]), vessel)
    took = time.perf_counter() - begin
    write_report(diagnosis, NAME)
    rows = int(np.diff(FITTED).sum())
    print(
        f"fitted on {rows} rows ({rows * ROW:.1f} s of the circuit) in {took:.0f} s; "
        f"{diagnosis.findings.held_out_note}"
    )
    models = models_of(diagnosis)
    off = {}
    for name in (MULTISINE, ARROW):
        test = open_set(runs[name])
        off[name] = simulation_errors(diagnosis, test, models)
    header = ["model", MULTISINE, ARROW, "arrow without its tip", "source"]
    print_table("Rms error [mV] of one free run over each whole test set", header, score_rows(off))
    nominal, linear, *_, arrow = map(rms, off[ARROW].values())
    verdict = "met"
    if arrow >= GOAL:
        verdict = "missed"
    print(f"  goal: {GOAL:g} mV over the arrow: {verdict}, {arrow:.3f} mV")
    header = ["over", "before", "retuned", "corrected", "ratio"]
    cells = ["arrow", *format_fixed(3, nominal, linear, arrow, arrow / linear)]
    print_table("Rms error [mV], one free run", header, [cells])
    header = ["input between its rows", "linear", "+ " + ", ".join(COMPARED), "evidence [nats]"]
    title = "Rms error [mV] over a held-out stretch of the training data, by interpolation of input"
    print_table(title, header, input_rows(runs["train"], diagnosis))
    few = ["linear, retuned", *list(models)[-2:]]
    left = dict(zip(few, runs_named(off[ARROW], few), strict=True))
    header = ["of the arrow", "recorded [mV]", *few, "patched [% of recorded]"]
    title = "Residual, rms error [mV], by amplitude"
    print_table(title, header, amplitude_rows(left, test))
    title = "Residual over the arrow, share of its square [%] by frequency"
    print_table(title, ["band", *few], band_rows(left))
    print(f"\n{residual_text(diagnosis)}")


if __name__ == "__main__":
    main()
