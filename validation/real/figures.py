"""Figures of a set of recordings: errors of free runs on held-out runs, findings, CPU time.

Each set of the protocol (docs/protocol.md) prints one `Figures` for each form of its files, in the
same table.
"""

import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline
from boatsim.diagnosis.checks import data_cleaning
from boatsim.diagnosis.checks.order_signs import restore_order_signs
from boatsim.diagnosis.evaluation import compared_fits
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import FreeRun, free_runs, rms_errors
from boatsim.diagnosis.model_names import MODELS
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.physics.base import Array
from boatsim.progress import Report
from validation.real.common import effects_of, format_fixed, parameter_text, print_table

# The rms distance from the recorded position is this times the rms error over both coordinates
DISTANCE = 2.0**0.5
HEADER = ("figure", "before", "retuned", "corrected", "corrected / retuned")
# with the errors of a vessel that keeps its first velocities, by which the READMEs measure runs
HEADER_WITH_HELD = (HEADER[0], "velocities held", *HEADER[1:])
HELD = "velocities_held"


@dataclass(frozen=True)
class Figures:
    """Answer of one diagnosis of a set, and how well its models predict the held-out runs."""

    title: str
    diagnosis: Diagnosis
    held_out: Sequence[MappedRecording]
    errors: Mapping[float, Mapping[str, Mapping[str, float]]]  # window, family, model -> rms
    cpu_s: float  # of the diagnosis
    by_source: Mapping[str, Mapping[str, float]] | None = None  # in the windows of the source


@dataclass(frozen=True)
class SourceWindows:
    """Windows in which the README of a set judges models, where it leaves some out.

    Attributes:
        skipped: Time at the start of each run in which none begins [s].
        longest_gap: Longest time without a position in one [s].
    """

    skipped: float
    longest_gap: float

    def contains(self, run: FreeRun) -> bool:
        """Whether the README judges a free run."""
        known = run.t[np.isfinite(run.channels["recorded"]["x_m"])]
        gaps = np.diff(np.concatenate([run.t[:1], known, run.t[-1:]]))
        return bool(gaps.max() <= self.longest_gap)


def split_groups(groups: Mapping[str, Sequence[str]]) -> tuple[list[str], list[str]]:
    """Split runs into fitted and held-out ones by the rule of the protocol.

    In each group every third run, in order of names, is held out; groups of one or two runs are
    fitted as a whole.

    Args:
        groups: Names of the runs of each group.

    Returns:
        Names of the fitted and of the held-out runs.
    """
    fitted, held_out = list[str](), list[str]()
    for names in groups.values():
        for i, name in enumerate(sorted(names)):
            part = held_out if i % 3 == 2 else fitted
            part.append(name)
    return fitted, held_out


def held_out_errors(
    diagnosis: Diagnosis, held_out: Sequence[MappedRecording], window: float
) -> dict[str, dict[str, float]]:
    """Return the rms errors of free runs over the held-out runs: family -> model -> rms.

    Args:
        diagnosis: The diagnosis whose three models are compared.
        held_out: Held-out runs, mapped to its program.
        window: Length of each free run [s].
    """
    return rms_errors(compared_free_runs(diagnosis, held_out, window))


def compared_free_runs(
    diagnosis: Diagnosis, held_out: Sequence[MappedRecording], window: float, skipped: float = 0.0
) -> list[FreeRun]:
    """Return free runs of the three models, and of a vessel that keeps its first velocities.

    Args:
        diagnosis: The diagnosis whose three models are compared.
        held_out: Held-out runs, mapped to its program.
        window: Length of each free run [s].
        skipped: Time from the first row of a run before which none starts [s].
    """
    fits = compared_fits(diagnosis.ranking)
    found = free_runs(diagnosis.problem, fits, held_out, window, skipped)
    fit, program = fits["recalibrated"], diagnosis.problem.program
    first = []
    for mapped in held_out:
        values = diagnosis.problem.parameter_vector(mapped, fit.free, fit.theta)
        on = program.effect_switches(fit.effects)
        for _, states in mapped.free_runs(values, on, fit.levels, window, skipped):
            first.append((mapped, states[0]))
    for run, (mapped, state) in zip(found, first, strict=True):
        run.channels[HELD] = velocities_held(mapped, state, run.t)
    return found


def velocities_held(mapped: MappedRecording, state: Array, t: Array) -> dict[str, Array]:
    """Return the signals of a vessel that keeps its velocities in body axes.

    Args:
        mapped: A recording.
        state: (2 NQ,) coordinates, then rates in body axes, at the first time, as recorded.
        t: Times (M,) [s].
    """
    at = {mapped.signals[c]: code for c, code in enumerate(mapped.codes)}
    rates, after = state[mapped.program.module.NQ :], t - t[0]
    found = {}
    for name, code in at.items():
        if code < mapped.program.module.NQ:
            found[name] = state[code] + rates[code] * after
    if {"x_m", "y_m", "psi_rad"} <= found.keys():
        x, y, psi = at["x_m"], at["y_m"], at["psi_rad"]
        # a path of constant speeds and yaw rate: an arc, whose chord has the mean direction
        half = 0.5 * rates[psi] * after
        chord, bow = after * np.sinc(half / np.pi), state[psi] + half
        found["x_m"] = state[x] + chord * (rates[x] * np.cos(bow) - rates[y] * np.sin(bow))
        found["y_m"] = state[y] + chord * (rates[x] * np.sin(bow) + rates[y] * np.cos(bow))
    return found


def map_held_out(
    diagnosis: Diagnosis, fitted: Sequence[Path], held_out: Sequence[Path], vessel: str
) -> list[MappedRecording]:
    """Return held-out runs with the corrections of the diagnosis, mapped to its program.

    All their rows are kept: a diagnosis thins many long runs and leaves out times such as rest,
    while the README judges models by everything that was recorded.

    Args:
        diagnosis: The diagnosis.
        fitted: Recordings that it fitted; they decide about corrections of all.
        held_out: Held-out recordings.
        vessel: Name or path of the vessel.
    """
    opened = [loading.open_recording(file, vessel, ()) for file in (*fitted, *held_out)]
    runs = restore_order_signs([run for run, _ in opened], opened[0][1], len(fitted))
    mapped = []
    for run, (_, boat) in list(zip(runs, opened, strict=True))[len(fitted) :]:
        cleaned = data_cleaning.clean_recording(run, boat)
        mapped.append(diagnosis.map_recording(cleaned, vessel=boat))
    return mapped


def diagnose_set(
    title: str,
    fitted: Sequence[Path],
    held_out: Sequence[Path],
    vessel: str,
    windows: Sequence[float],
    out: Path,
    source: SourceWindows | None = None,
) -> Figures:
    """Diagnose the fitted runs of a set and judge its models on the held-out runs.

    The statements are printed, and the files of the report written, before the free runs begin.

    Args:
        title: Name of the set and form of its files.
        fitted: Recordings that are fitted.
        held_out: Recordings that are held out.
        vessel: Name or path of the nominal vessel.
        windows: Lengths of the free runs [s]; the first one is that of the diagnosis.
        out: Folder of the report.
        source: Windows of the README, if it leaves some out; they have the first length.
    """
    start = time.process_time()
    diagnosis = pipeline.diagnose(
        fitted, held_out, vessel=vessel, horizon=windows[0], report=progress_printer()
    )
    cpu_s = time.process_time() - start
    print_statements(title, diagnosis, cpu_s)
    write_diagnosis(diagnosis, out)
    print(f"  report: {out / 'report.html'}", flush=True)
    runs = map_held_out(diagnosis, fitted, held_out, vessel)
    errors = {window: held_out_errors(diagnosis, runs, window) for window in windows}
    by_source = None
    if source:
        begun = compared_free_runs(diagnosis, runs, windows[0], source.skipped)
        by_source = rms_errors([run for run in begun if source.contains(run)])
    return Figures(title, diagnosis, runs, errors, cpu_s, by_source)


def progress_printer() -> Report:
    """Return a progress callback that prints each new stage to stderr, with the CPU time so far."""
    printed = [""]

    def print_stage(stage: str, share: float = 0.0, detail: str = "") -> None:
        line = f"{stage} {detail}".rstrip()
        if line != printed[-1]:
            printed.append(line)
            print(f"{time.process_time():8.1f} s CPU: {line}", file=sys.stderr, flush=True)

    return print_stage


def print_statements(title: str, diagnosis: Diagnosis, cpu_s: float) -> None:
    """Print the summary, log findings and named effects of a diagnosis, and its CPU time.

    Args:
        title: Name of the set and form of its files.
        diagnosis: The diagnosis.
        cpu_s: CPU time of the diagnosis [s].
    """
    answer = diagnosis.findings.answer
    print(f"\n{title}: statements")
    print(f"  {answer['sentence']}")
    for entry in answer.get("log", []):
        print(f"  log, {entry['run']}: {entry['name']} ({entry['kind']}): {entry['evidence']}")
    for effect in effects_of(diagnosis):
        print(f"  {effect['kind']}: {effect['name']}: {parameter_text(effect)}")
    print(f"  CPU: {cpu_s:.0f} s", flush=True)


def print_figures(figures: Figures, units: Mapping[str, tuple[str, float]]) -> None:
    """Print the errors of free runs on the held-out runs.

    Args:
        figures: The figures.
        units: Family of signals -> text of the figure with its unit, and factor from SI.
    """
    rows = []
    for window, families in figures.errors.items():
        rows += error_rows(f"{window:g} s", families, units)
    if figures.by_source:
        window = next(iter(figures.errors))
        rows += error_rows(f"{window:g} s, windows of the README", figures.by_source, units)
    print_table(figures.title, HEADER_WITH_HELD, rows)


def error_rows(
    window: str,
    families: Mapping[str, Mapping[str, float]],
    units: Mapping[str, tuple[str, float]],
) -> list[list[str]]:
    """Return one row of a table of errors for each family of signals.

    Args:
        window: Text of the free runs, with their length.
        families: Rms errors by family and model.
        units: Family of signals -> text of the figure with its unit, and factor from SI.
    """
    rows = []
    for family, (text, factor) in units.items():
        rms = [families[family][model] * factor for model in (HELD, *MODELS)]
        rows.append([f"{text}, {window}", *format_fixed(2, *rms), f"{rms[3] / rms[2]:.2f}"])
    return rows
