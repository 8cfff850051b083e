"""Accuracy of locating the missing force: `python -m validation.locate [TRIALS]`.

TRIALS/Txxx/ holds run_1.csv, run_2.csv, answer.json, missing_force_1.csv and missing_force_2.csv:
the force that the nominal vessel lacks (body axes, 1 s averages) at times t_s. For each trial the
noise levels and the nominal coefficients are fitted. The force that
`boatsim.diagnosis.locate.missing_force` estimates, also averaged over 1 s, is compared with the
true force; a sample is one time and axis:

inside     share of samples whose true force lies within 2 sd of the estimate, mean over trials
flagged    samples at which zero lies outside the 2-sd band of the estimate
false      flagged samples whose true force is below the ambient rms of that axis
precision  share of the flagged samples that are not false
there      samples whose true force exceeds twice the ambient rms
recall     share of those that are flagged

by axis and by concealed effect. A trial with two effects counts under both, one without an effect
under "nothing missing". A region found in such a trial is a false alarm; the significance level
allows one in a hundred trials. The last line is the processor time for locating, including the
regions.
"""

import argparse
import json
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from boatsim.diagnosis import priors
from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import dof_in_state_order
from boatsim.diagnosis.loading import open_recording
from boatsim.diagnosis.locate.missing_force import missing_force
from boatsim.diagnosis.locate.regions import Region, find_missing_force_conditions
from boatsim.diagnosis.prior_noise import prior_noise_levels, shared_noise
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from validation.trials import SHARED

RUNS = (1, 2)
NOTHING = "nothing missing"


@dataclass(frozen=True)
class LocatedForce:
    """Estimated and true force of one trial, (samples, axes), in units of the ambient rms."""

    causes: tuple[str, ...]
    found: Array
    sd: Array
    true: Array
    regions: tuple[Region, ...]
    seconds: float

    @property
    def flagged(self) -> Any:
        """Return where zero lies outside the band, (samples, axes)."""
        return np.abs(self.found) > DEFAULT.locate.band_sds * self.sd


def problem_of(trial: Path) -> Problem:
    """Map the recordings of a trial on the vessel's program, as a diagnosis does."""
    opened = [open_recording(trial / f"run_{k}.csv", None, ()) for k in RUNS]
    recordings, boat = [r.thinned(priors.downsampling_rate(b)) for r, b in opened], opened[0][1]
    program = Program(boat, candidate_library(boat).compiled_effects)
    tracks = [map_recording(r, program, shared_noise(boat, recordings)) for r in recordings]
    uncertainty = priors.coefficient_uncertainty(boat)
    return Problem(
        tracks,
        prior_noise_levels(boat, recordings),
        uncertainty | recordings[0].notes.coefficient_uncertainty,
    )


def recalibrate(problem: Problem) -> Fit:
    """Return the nominal vessel with fitted noise, force levels and coefficients."""
    return fit_baseline(problem)[1]


def locate_force(trial: Path) -> LocatedForce:
    """Locate the missing force in one trial."""
    problem = problem_of(trial)
    known = recalibrate(problem)
    begin = time.process_time()
    forces = missing_force(problem, known, problem.recordings)
    found_in = find_missing_force_conditions(problem, known)
    seconds = time.process_time() - begin
    samples = []
    columns = []
    for axis in dof_in_state_order(problem.program.vessel):
        columns.append(f"{axis}_{'Nm' if axis in ('roll', 'yaw') else 'N'}")
    for k, force in zip(RUNS, forces, strict=True):
        truth = np.genfromtxt(trial / f"missing_force_{k}.csv", delimiter=",", names=True)
        # an average over an even number of rows is delayed by half a row
        rows = np.searchsorted(force.t, truth["t_s"], side="right") - 1
        samples.append(
            (force.mean[rows], force.sd[rows], np.column_stack([truth[c] for c in columns]))
        )
    found, sd, true = (
        np.concatenate(s) / problem.ambient.force for s in zip(*samples, strict=True)
    )
    causes = tuple(e["name"] for e in json.loads((trial / "answer.json").read_text())["effects"])
    return LocatedForce(causes or (NOTHING,), found, sd, true, tuple(found_in), seconds)


def table_row(trials: Sequence[LocatedForce], axis: int | slice = slice(None)) -> list[str]:
    """Return one row of the table."""

    def count(which: Callable[[LocatedForce], Any]) -> int:
        return sum(int(which(t)[:, axis].sum()) for t in trials)

    inside = np.mean(
        [
            np.mean(np.abs(t.found - t.true)[:, axis] <= DEFAULT.locate.band_sds * t.sd[:, axis])
            for t in trials
        ]
    )
    flagged, false = count(lambda t: t.flagged), count(lambda t: t.flagged & (np.abs(t.true) < 1.0))
    there = count(lambda t: np.abs(t.true) > 2.0)
    hit = count(lambda t: t.flagged & (np.abs(t.true) > 2.0))
    shares = [
        f"{1.0 - false / flagged:.3f}" if flagged else "-",
        f"{hit / there:.3f}" if there else "-",
    ]
    return [f"{len(trials)}", f"{inside:.3f}", *shares, f"{flagged}", f"{there}"]


def table(trials: Sequence[LocatedForce], axes: Sequence[str]) -> Table:
    """Return the table of all samples, by axis and by effect."""
    out = Table("", *("trials", "inside", "precision", "recall", "flagged", "there"))
    out.columns[0].no_wrap = True
    for column in out.columns[1:]:
        column.justify = "right"
    out.add_row("all", *table_row(trials))
    for i, axis in enumerate(axes):
        out.add_row(axis, *table_row(trials, i), end_section=i == len(axes) - 1)
    for cause in sorted({c for t in trials for c in t.causes}):
        out.add_row(cause, *table_row([t for t in trials if cause in t.causes]))
    return out


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("trials", type=Path, nargs="?", default=SHARED)
    folders = sorted(
        t for t in parser.parse_args().trials.glob("T*") if (t / "missing_force_1.csv").exists()
    )
    if not folders:
        raise SystemExit(f"{parser.parse_args().trials}: no trials with missing_force_1.csv")
    locate_force(folders[0])  # compile before the time is measured
    trials = {t.name: locate_force(t) for t in folders}
    console = Console()
    console.print(
        table(
            list(trials.values()),
            dof_in_state_order(open_recording(folders[0] / "run_1.csv", None, ())[1]),
        )
    )
    none = {n: t for n, t in trials.items() if t.causes == (NOTHING,)}
    accidents = sum(bool(t.regions) for t in none.values())
    console.print(
        f"regions found in nothing-missing trials: {accidents} of {len(none)}, at p < "
        f"{DEFAULT.locate.region_max_p} a trial"
    )
    for name, t in trials.items():
        for region in t.regions:
            console.print(
                f"  {name} ({', '.join(t.causes)}): {region.statement}",
                highlight=False,
                soft_wrap=True,
            )
    seconds = [t.seconds for t in trials.values()]
    console.print(
        f"processor seconds for locating: median {statistics.median(seconds):.3f}, most "
        f"{max(seconds):.3f}"
    )


if __name__ == "__main__":
    main()
