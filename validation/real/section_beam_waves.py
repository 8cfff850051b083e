"""Ship section in regular beam waves (NTNU flume): `python -m validation.real.section_beam_waves`.

The section has no drive. Each run is driven by the measured incident wave alone. The nominal vessel
consists of the published hydrostatics, natural periods and the pressure of the undisturbed wave
(`section/vessel.toml`); coupling of sway and roll, diffraction, drift forces and the forces of the
rig cannot be expressed by published numbers. The figures are those of docs/protocol.md: free runs
from 20 s, at rest, to the end, relative to the rms of the signal.
"""

import argparse
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from boatsim.cli.checking import print_checks
from boatsim.diagnosis import loading, pipeline
from boatsim.diagnosis.evaluation import compared_fits
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import FreeRun, free_runs
from boatsim.diagnosis.model_names import MODELS
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.diagnosis.pipeline import Diagnosis
from validation.real.common import RECORDINGS, out_option, print_table
from validation.real.figures import HEADER, print_statements, progress_printer, split_groups

NAME = "section_beam_waves"
VESSEL = Path(__file__).parent / "section"
WORK = Path("out/real") / NAME
BEGIN = 20.0  # [s] the section is at rest until then
HORIZON = 30.0  # [s] of the free runs by which a diagnosis judges; the shortest run has 32 s
LEFT_OUT = ("4061_2",)  # its camera recorded nothing
SIGNALS = {"heave": "z_m", "roll": "phi_rad", "sway": "y_m"}
# kinds of rig: what it holds
NOTES = """
vessel = "{vessel}"
use = [{begin}, 1000.0]              # [s]

[noise]
position_sd_m = 0.0005              # camera
heave_sd_m = 0.0005
roll_sd_rad = 0.002

[facts]
indoors = true
guided = true
forward_speed_mps = 0.0

[runs."4*".set.held_freedom]
roll = 1.0
[runs."5*".set.held_freedom]
heave = 1.0
[runs."6*".set.held_freedom]
sway = 1.0
"""


def copied_runs(form: str) -> list[Path]:
    """Copy the runs of the set next to notes that name the vessel, and return the copies.

    Args:
        form: "runs_clean".

    Raises:
        SystemExit: The set is not on this machine; one line is printed.
    """
    files = sorted((RECORDINGS / NAME / form).glob("*.csv"))
    if not files:
        print(f"{NAME}: skipped, there are no recordings in ../shared/recordings/{NAME}/{form}")
        raise SystemExit
    return _copied([file for file in files if file.stem not in LEFT_OUT], WORK / form)


def _copied(files: Sequence[Path], folder: Path) -> list[Path]:
    """Copies of recordings in a folder, next to notes that name the vessel."""
    folder.mkdir(parents=True, exist_ok=True)
    notes = NOTES.format(vessel=VESSEL.resolve(), begin=BEGIN)
    (folder / "recording.toml").write_text(notes, encoding="utf-8")
    copies = []
    for file in files:
        copies.append(folder / file.name)
        copies[-1].write_bytes(file.read_bytes())
    return copies


def print_left_out(form: str) -> None:
    """Print what the checks say about the runs that are left out.

    Args:
        form: "runs_clean".
    """
    files = [RECORDINGS / NAME / form / f"{name}.csv" for name in LEFT_OUT]
    print("left out:")
    print_checks(_copied(files, WORK / "left_out"), None, [])


def split_runs(files: Sequence[Path]) -> tuple[list[Path], list[Path]]:
    """Return the fitted and the held-out runs by the rule of the protocol, by kind of rig."""
    groups: dict[str, list[str]] = {}
    by_name = {file.stem: file for file in files}
    for name in by_name:
        groups.setdefault(name[0], []).append(name)
    fitted, held_out = split_groups(groups)
    return [by_name[name] for name in fitted], [by_name[name] for name in held_out]


def free_runs_of(diagnosis: Diagnosis, files: Sequence[Path]) -> list[FreeRun]:
    """Return one free run of each recording, from its first row to its end, by each model."""
    fits = compared_fits(diagnosis.ranking)
    found = []
    for file in files:
        recording, boat = loading.open_recording(file, None, ())
        mapped: MappedRecording = diagnosis.map_recording(recording, vessel=boat)
        whole = float(np.ptp(mapped.times)) - 1e-6
        found += free_runs(diagnosis.problem, fits, [mapped], whole)
    return found


def relative_errors(runs: Sequence[FreeRun]) -> dict[str, dict[str, float]]:
    """Return rms error over rms of the signal, over all runs: signal -> model -> ratio."""
    found: dict[str, dict[str, float]] = {}
    for name, column in SIGNALS.items():
        found[name] = {}
        recorded = np.concatenate([run.channels["recorded"][column] for run in runs])
        known = np.isfinite(recorded)
        for model in MODELS:
            simulated = np.concatenate([run.channels[model][column] for run in runs])
            off = (simulated - recorded)[known]
            ratio = np.sqrt(np.mean(off**2) / np.mean(recorded[known] ** 2))
            found[name][model] = float(ratio)
    return found


def table_rows(errors: Mapping[str, Mapping[str, float]]) -> list[list[str]]:
    """Return the rows of the table of figures."""
    rows = []
    for name, by_model in errors.items():
        values = [by_model[model] for model in MODELS]
        cells = [f"{value:.2f}" for value in (*values, values[2] / values[1])]
        rows.append([f"{name}, error over rms of the signal", *cells])
    return rows


def print_form(form: str, out: Path) -> None:
    """Diagnose one form of the files, write its report and print its statements and figures.

    Args:
        form: "runs_clean".
        out: Folder of the report.
    """
    files = copied_runs(form)
    print_left_out(form)
    fitted, held_out = split_runs(files)
    print(f"held out: {', '.join(file.stem for file in held_out)}")
    start = time.process_time()
    diagnosis = pipeline.diagnose(fitted, held_out, horizon=HORIZON, report=progress_printer())
    print_statements(f"{NAME}, {form}", diagnosis, time.process_time() - start)
    write_diagnosis(diagnosis, out)
    runs = free_runs_of(diagnosis, held_out)
    print_table(f"{NAME}, {form}", HEADER, table_rows(relative_errors(runs)))
    by_run = []
    for run in runs:
        errors = relative_errors([run])
        by_run.append([run.run, *(f"{errors[name]['patched']:.2f}" for name in SIGNALS)])
    print_table("corrected, by held-out run", ("run", *SIGNALS), by_run)


def main() -> None:
    """Print the figures of the set."""
    parser = argparse.ArgumentParser(description="Figures of a ship section in beam waves")
    out_option(parser, NAME)
    print_form("runs_clean", parser.parse_args().out / "report")


if __name__ == "__main__":
    main()
