"""A weight on a motor that turns over the top: `python -m validation.real.torque_pendulum`.

The vessel is `models/pendulum`: one degree of freedom, roll, driven by the torque that the drive
reports. It contains the published weights and lengths and no friction. What the vessel cannot
express beforehand: how large the friction is and of which law, whether the reported torque is that
at the axis, and the heavier weight of `energy_1kg`, which has a diagnosis of its own.

The figure is the median over windows, one after another, of the rms error of roll. Windows in which
the pendulum does not move are left out. Some end in a balance on top, which no free run follows, so
the rms over all windows would show those alone.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.model_names import MODELS
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.mapping import read_map
from boatsim.recordings.importing.several_logs import open_logs
from boatsim.recordings.table import write_csv
from validation.real.common import (
    DEG,
    OUT,
    RECORDINGS,
    effects_of,
    out_option,
    parameter_text,
    runs_of,
)
from validation.real.figures import (
    HELD,
    Figures,
    compared_free_runs,
    diagnose_set,
    print_figures,
    split_groups,
)

NAME = "torque_pendulum"
VESSEL = "pendulum"
GROUPS = {"0.546 kg": ("ddp", "ilqr", "pd_fail", "pd_sysid")}
HEAVY = "energy_1kg"  # the only run of its group, fitted as a whole
WINDOWS = (0.5, 1.0)  # [s]
COMPARED = (HELD, *MODELS)
MOVES = 0.2  # [rad] smallest range of the recorded roll in a window that counts
# The map that `boatsim import --propose` writes for these logs and the vessel, unchanged
MAP = """\
vessel = "pendulum"

[columns]
phi_rad = "position"
p_radps = "velocity"
torque_Nm = "torque"
"""


def converted(runs: Sequence[Path], folder: Path = OUT / NAME / "raw") -> dict[str, Path]:
    """Convert the files as published to recordings, by the proposed map.

    Args:
        runs: Files as published.
        folder: Folder of the recordings.

    Returns:
        Recordings by the name of the run.
    """
    folder.mkdir(parents=True, exist_ok=True)
    map_file = folder / "map.toml"
    map_file.write_text(MAP, encoding="utf-8")
    found = {}
    for run in runs:
        found[run.stem] = folder / run.name
        recording = convert_log(open_logs([run]), read_map(map_file), str(map_file), {})
        write_csv(recording, found[run.stem])
    return found


def window_errors(run: FreeRun) -> dict[str, float]:
    """Return the rms error of roll [rad] of each model in a window; empty if nothing moves."""
    phi = run.channels["recorded"]["phi_rad"]
    phi = phi[np.isfinite(phi)]
    if not len(phi) or float(np.ptp(phi)) < MOVES:
        return {}
    errors = {}
    for model in COMPARED:
        (off,) = run.deviations(model, ("phi_rad",))
        errors[model] = float(np.sqrt(np.nanmean(off**2)))
    return errors


def median_errors(
    diagnosis: Diagnosis, runs: Sequence[MappedRecording], window: float
) -> dict[str, float]:
    """Return the median over windows of the rms error of roll [rad] by model.

    Velocities held are a model, too.

    Args:
        diagnosis: The diagnosis whose three models are compared.
        runs: Held-out runs, mapped to its program.
        window: Length of each free run [s].
    """
    windows = filter(None, map(window_errors, compared_free_runs(diagnosis, runs, window)))
    rows = [[errors[model] for model in COMPARED] for errors in windows]
    return dict(zip(COMPARED, np.median(rows, axis=0).tolist(), strict=True))


def with_medians(figures: Figures) -> Figures:
    """Return figures whose errors are medians over windows, in addition to the rms over all."""
    errors = {}
    for window, families in figures.errors.items():
        median = median_errors(figures.diagnosis, figures.held_out, window)
        errors[window] = {**families, "roll_median_rad": median}
    return replace(figures, errors=errors)


def print_set(title: str, runs: dict[str, Path], out: Path) -> None:
    """Diagnose the runs with the lighter weight, and print errors and findings.

    Args:
        title: Form of the files.
        runs: Recordings by the name of the run.
        out: Folder of the report.
    """
    fitted, held_out = split_groups(GROUPS)
    tested = [runs[name] for name in held_out]
    fit = [runs[name] for name in fitted]
    found = diagnose_set(title, fit, tested, VESSEL, WINDOWS, out)
    units = {
        "roll_median_rad": ("roll, median over windows [deg]", DEG),
        "roll_rms_rad": ("roll, rms over windows [deg]", DEG),
    }
    print_figures(with_medians(found), units)


def print_heavy(run: Path, corrected: Path) -> None:
    """Diagnose the run with the heavier weight, on the vessel corrected by the lighter one.

    The sensor of the torque is the same, so a torque that does not fit the masses here shows that
    the masses are others.

    Args:
        run: The recording.
        corrected: File of the vessel as the other runs corrected it.
    """
    diagnosis = pipeline.diagnose([run], vessel=str(corrected), horizon=WINDOWS[0])
    print(f"\n{HEAVY}, on the vessel corrected by the runs with 0.546 kg")
    print(f"  {diagnosis.findings.answer['sentence']}")
    for effect in effects_of(diagnosis):
        print(f"  {effect['kind']}: {effect['name']}: {parameter_text(effect)}")


def main() -> None:
    """Print the figures from the files as published and from the clean ones."""
    parser = argparse.ArgumentParser(description="Figures of a weight on a motor")
    out_option(parser, NAME)
    out = parser.parse_args().out
    published = runs_of(NAME)
    clean = {file.stem: file for file in (RECORDINGS / NAME / "runs_clean").glob("*.csv")}
    print_set(f"{NAME}, as published", converted(list(published.values())), out / "raw_report")
    print_set(f"{NAME}, clean", clean, out / "clean_report")
    print_heavy(clean[HEAVY], out / "clean_report" / "patched.toml")


if __name__ == "__main__":
    main()
