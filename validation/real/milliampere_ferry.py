"""milliAmpere ferry in a harbour basin: `python -m validation.real.milliampere_ferry [FORM...]`.

NTNU drove a ferry of 5 m with four azimuth thrusters for 13 minutes on 11 April 2025. The last
third of each run is held out (docs/protocol.md). Each form is one diagnosis and one table:

- `orders`: the ordered revolutions and the ordered angles;
- `reported`: the angles that the drives report. The thrust follows from the ordered revolutions
  here too, because `boatsim check` shows that the reported ones are stale.

The vessel, ferry/vessel.toml, has the published mass and damping without the cubic terms, which are
below 1 N at these speeds, and without the coupling of sway and yaw. The map from revolutions to
thrust is the makers', up to the revolutions at which it ends.
"""

import argparse
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording, read, write_csv
from validation.real.common import DEG, OUT, RECORDINGS, out_option
from validation.real.figures import DISTANCE, diagnose_set, print_figures

NAME = "milliampere_ferry"
RUNS = ("maneuvering1_a", "nlp1_a", "qp1_a")
FORMS = ("orders", "reported")
VESSEL = Path(__file__).parent / "ferry" / "vessel.toml"
WINDOWS = (20.0, 60.0)  # [s] of free runs
FITTED_SHARE = 2.0 / 3.0  # of the time of each run, by the protocol
UNITS = {"position_rms_m": ("distance [m]", DISTANCE), "heading_rms_rad": ("heading [deg]", DEG)}
DRIVES = {1: "port_bow", 2: "starboard_bow", 3: "starboard_stern", 4: "port_stern"}
POSE = ("x_m", "y_m", "psi_rad")
RPM = 9.549297  # [rpm / (rad/s)]
# The makers' map, ahead and astern: revolutions [rpm] = square F^2 + linear F, F in N
AHEAD = (-0.005392628724401, 4.355160257309755)
ASTERN = (0.009497954053629, 5.891321999522722)
LEAST_RPM, MOST_RPM = -600.0, 750.0  # ends of the map
NOTES = """vessel = {vessel!r}

[noise]                         # the owner's, of the receiver with RTK
position_sd_m = 0.003
heading_sd_rad = 0.0005
"""


def thrust(n: Array) -> Array:
    """Return the thrust [N] of shaft rates (N,) [rad/s] by the makers' map."""
    rpm = np.clip(n * RPM, LEAST_RPM, MOST_RPM)
    force = np.zeros(len(rpm))
    for (square, linear), side in ((AHEAD, rpm >= 0.0), (ASTERN, rpm < 0.0)):
        root = np.sqrt(linear**2 + 4.0 * square * rpm[side])
        force[side] = (root - linear) / (2.0 * square)
    return force


def mapped(file: Path, form: str) -> Recording:
    """Return a recording of the set with the channels of the vessel.

    Args:
        file: A file of runs_clean.
        form: `orders` or `reported`.
    """
    table = read(file)
    signals = {name: table[name] for name in POSE}
    angle = "azimuth" if form == "orders" else "actual_azimuth"
    for k, drive in DRIVES.items():
        signals[f"{drive}_N"] = thrust(table[f"n_{k}_radps"])
        signals[f"{drive}_rad"] = table[f"{angle}_{k}_rad"]
    return Recording(file.stem, table.t, signals)


def write_parts(form: str) -> tuple[list[Path], list[Path]]:
    """Write the fitted and the held-out part of each run, and return their files.

    Args:
        form: `orders` or `reported`.
    """
    parts: tuple[list[Path], list[Path]] = ([], [])
    for run in RUNS:
        whole = mapped(RECORDINGS / NAME / "runs_clean" / f"{run}.csv", form)
        border = whole.t[0] + FITTED_SHARE * (whole.t[-1] - whole.t[0])
        spans = ((whole.t[0], border), (border, whole.t[-1]))
        for files, folder, span in zip(parts, ("fitted", "held_out"), spans, strict=True):
            file = OUT / NAME / form / folder / f"{run}.csv"
            file.parent.mkdir(parents=True, exist_ok=True)
            notes = NOTES.format(vessel=str(VESSEL))
            file.with_name("recording.toml").write_text(notes, encoding="utf-8")
            write_csv(whole.between(*span), file)
            files.append(file)
    return parts


def main() -> None:
    """Print the figures of the set for each form of its inputs."""
    parser = argparse.ArgumentParser(description="Figures of the milliAmpere ferry")
    parser.add_argument("forms", nargs="*", help=f"of {', '.join(FORMS)}; all without any")
    out_option(parser, NAME)
    given = parser.parse_args()
    if not (RECORDINGS / NAME / "runs_clean").is_dir():
        print(f"{NAME}: skipped, there are no recordings in ../shared/recordings/{NAME}")
        return
    for form in given.forms or FORMS:
        fitted, held_out = write_parts(form)
        title, out = f"{NAME}, {form}", given.out / f"{form}_report"
        print_figures(diagnose_set(title, fitted, held_out, str(VESSEL), WINDOWS, out), UNITS)


if __name__ == "__main__":
    main()
