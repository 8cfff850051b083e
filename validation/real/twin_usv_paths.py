"""A small USV of unknown size follows a path: `python -m validation.real.twin_usv_paths`.

One closed-loop run, weakly excited, noisy, no mass, no dimensions: lumped coefficients per unit of mass and inertia.
The middle third is kept unseen. Prints what was found, how strong at most is what was not, and what can not be told.
"""

import numpy as np

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.evaluation import MODELS
from boatsim.diagnosis.free_runs import errors
from boatsim.diagnosis.pipeline import Diagnosis
from validation.real.common import report, runs_of, table

NAME, VESSEL = "twin_usv_paths", "twin_usv"
HORIZON = 10.0  # [s] of a free run
HELPS = 0.9  # ratio of errors on unseen data above which an effect found has not earned its place
TOLD = 0.5  # share of its prior sd below which the sd of a coefficient says that the data know it


def print_unseen(found: Diagnosis) -> None:
    """Free runs over the middle third."""
    off = errors(found.findings.free_runs)
    rows = []
    for family, what, factor in (
        ("position_rms_m", "position [m]", 1.0),
        ("heading_rms_rad", "heading [deg]", 57.29578),
    ):
        nominal, before, after = (off[family][m] * factor for m in MODELS)
        rows.append(
            [what, f"{nominal:.3f}", f"{before:.3f}", f"{after:.3f}", f"{after / before:.2f}"]
        )
    header = [
        "rms of free runs, 10 s",
        "as written",
        "recalibrated",
        "patched",
        "patched / recalibrated",
    ]
    table("fitted on the first and last third, unseen the middle third", header, rows)
    if any(float(row[-1]) > HELPS for row in rows):
        print(
            "  What was added hardly helps on unseen data: take what is named below for a hint, not for a finding."
        )


def print_found(found: Diagnosis) -> None:
    """Effects named, and upper limits of the others."""
    answer = found.findings.answer
    rows = [
        [e["name"], e["kind"], f"{e['gain_nats']:.1f}", ", ".join(e["tied_with"]) or "-"]
        for e in answer["effects"]
    ]
    table(
        "found",
        ["effect", "kind", "gain [nats]", "hardly to be told from"],
        rows or [["nothing", "", "", ""]],
    )
    limits = [
        [f"{n} {k}", f"{v:.3g}"]
        for n, each in answer["upper_limits"].items()
        for k, v in each.items()
    ]
    table(
        "not found; at most (95 %)",
        ["effect", "strength"],
        limits or [["nothing can be excluded", ""]],
    )


def print_untold(found: Diagnosis) -> None:
    """Coefficients of the nominal beside their priors."""
    best = found.ranking.recalibrated
    sd = np.sqrt(np.diag(best.covariance))
    rows = [
        [
            f"{f.effect} {f.name}",
            f"{x:.2f} +- {s:.2f}",
            f"{f.sd:.2f}",
            "yes" if s < TOLD * f.sd else "hardly",
        ]
        for f, x, s in zip(best.free, best.theta, sd, strict=True)
    ]
    table(
        "coefficients, as factors of the vessel file",
        ["coefficient", "factor", "prior sd", "told by the data"],
        rows,
    )
    print(
        "\nThe data can not tell: mass, yaw inertia and thrust (only their ratios), what answers a command when the"
        "\ncontroller answers the motion, and wind or current along the one way out that the path takes."
    )


def main() -> None:
    """Diagnose the one run there is."""
    found = pipeline.diagnose(list(runs_of(NAME).values()), vessel=VESSEL, horizon=HORIZON)
    report(found, NAME)
    print_unseen(found)
    print_found(found)
    print_untold(found)


if __name__ == "__main__":
    main()
