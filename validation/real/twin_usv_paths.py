"""A small USV of unknown size follows a path: `python -m validation.real.twin_usv_paths`.

There is one closed-loop run. It is noisy and weakly excited, and neither mass nor dimensions are
known, so the coefficients are lumped per unit of mass and inertia. The middle third is held out.
The script prints what was found, upper limits of what was not, and what cannot be determined.
"""

import numpy as np

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.free_runs import rms_errors
from boatsim.diagnosis.pipeline import Diagnosis
from validation.real.common import (
    DEG,
    MODEL_COLUMNS,
    effects_of,
    format_fixed,
    print_table,
    runs_of,
    scale_errors,
    write_report,
)

NAME = "twin_usv_paths"
VESSEL = "twin_usv"
HORIZON = 10.0  # [s] of a free run
# ratio of held-out errors above which an effect is only a hint, because it hardly helps
HINT_RATIO = 0.9
# share of its prior sd below which the sd of a coefficient means that the data determine it
DETERMINED = 0.5
QUANTITIES = {"position_rms_m": ("position [m]", 1.0), "heading_rms_rad": ("heading [deg]", DEG)}


def print_held_out(diagnosis: Diagnosis) -> None:
    """Print the errors of free runs over the middle third."""
    off = rms_errors(diagnosis.findings.free_runs)
    rows, ratios = [], []
    for family, (what, factor) in QUANTITIES.items():
        nominal, before, after = scale_errors(off[family], factor)
        rows.append([what, *format_fixed(3, nominal, before, after), f"{after / before:.2f}"])
        ratios.append(float(rows[-1][-1]))
    header = ["rms of free runs, 10 s", "as written", *MODEL_COLUMNS]
    print_table("fitted on the first and last third, held out the middle third", header, rows)
    if max(ratios) > HINT_RATIO:
        print("  The patch hardly helps on held-out data: its effects are hints, not findings.")


def print_found(diagnosis: Diagnosis) -> None:
    """Print the identified effects, and upper limits of the others."""
    rows = []
    for e in effects_of(diagnosis):
        tied = ", ".join(e["tied_with"]) or "-"
        rows.append([e["name"], e["kind"], f"{e['gain_nats']:.1f}", tied])
    header = ["effect", "kind", "gain [nats]", "hardly distinguished from"]
    print_table("found", header, rows or [["nothing", "", "", ""]])
    limits = []
    for name, strengths in diagnosis.findings.answer["upper_limits"].items():
        limits += [[f"{name} {key}", f"{value:.3g}"] for key, value in strengths.items()]
    title = "not found; upper limits (95 %)"
    print_table(title, ["effect", "strength"], limits or [["nothing can be excluded", ""]])


def print_coefficients(diagnosis: Diagnosis) -> None:
    """Print the coefficients of the nominal model with their prior standard deviations."""
    best = diagnosis.ranking.recalibrated
    rows = []
    for f, x, sd in zip(best.free, best.theta, np.sqrt(np.diag(best.covariance)), strict=True):
        determined = "yes" if sd < DETERMINED * f.sd else "hardly"
        rows.append([f"{f.effect} {f.name}", f"{x:.2f} +- {sd:.2f}", f"{f.sd:.2f}", determined])
    header = ["coefficient", "factor", "prior sd", "determined by the data"]
    print_table("coefficients, as factors of the vessel file", header, rows)
    print(
        "\nThe data do not determine mass, yaw inertia and thrust (only their ratios), the response"
        "\nto a command while the controller reacts to the motion, and wind or current along the"
        "\nonly outward course of the path."
    )


def main() -> None:
    """Diagnose the only run."""
    diagnosis = pipeline.diagnose(list(runs_of(NAME).values()), vessel=VESSEL, horizon=HORIZON)
    write_report(diagnosis, NAME)
    print_held_out(diagnosis)
    print_found(diagnosis)
    print_coefficients(diagnosis)


if __name__ == "__main__":
    main()
