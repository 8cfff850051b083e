"""Hovercraft with six fans: `python -m validation.real.holohover`.

The craft has no water around it: it floats on an air table and its makers' model has no damping.
Six fixed fans push in one direction each, by a measured curve of their command. The vessel has the
makers' numbers; mass and moment of inertia of each craft are set by run. A craft is a group of
recordings. The protocol (docs/protocol.md) says which runs are fitted.
"""

import csv
import json
from collections.abc import Mapping, Sequence
from math import atan2
from pathlib import Path

import numpy as np
import tomlkit

from boatsim.physics.vessel import Vessel
from validation.real.common import DEG, OUT, RECORDINGS, runs_of, write_report
from validation.real.figures import Figures, diagnose_set, print_figures

NAME = "holohover"
SOURCE = RECORDINGS / NAME
FANS = ("a1", "a2", "b1", "b2", "c1", "c2")
# craft of each run, its name in vessel.json, and the runs that are fitted
CRAFT = {
    "old_oct": "old",
    "control_M0": "old",
    "blue": "blue",
    "blue_unshifted": "blue",
    "pink": "pink",
    "yellow_5": "yellow",
}
FITTED = ("old_oct", "blue", "blue_unshifted", "yellow_5")
BUILDS = {"old": ("control_M0",), "5 March": ("pink",)}  # build -> held-out runs
WINDOWS = (1.0, 0.2)  # [s]
UNITS = {"position": ("position, mm", 1000.0), "heading": ("heading, deg", DEG)}
# columns of the clean files that follow from the commands by the curve and the places of the fans
DERIVED = ("thrust_", "steer_")
POINTS = 8  # of the thrust curve, which is a cubic polynomial
DIAMETER = 0.12  # [m] of the craft
ROLL_INERTIA = 0.0003  # [kg m^2] not used by a craft that does not roll


def thrust_points(polynomial: Sequence[float]) -> list[list[float]]:
    """Return points (command, thrust [N]) of the makers' thrust curve.

    Args:
        polynomial: Coefficients of command, command^2 and command^3.
    """
    points = []
    for command in np.linspace(0.0, 1.0, POINTS).tolist():
        thrust = sum(c * command**power for power, c in enumerate(polynomial, 1))
        points.append([round(command, 6), round(thrust, 6)])
    return points


def nominal_vessel() -> Vessel:
    """Return the craft with the numbers of its makers, as far as effects express them."""
    given = json.loads((SOURCE / "vessel.json").read_text(encoding="utf-8"))
    fans = given["fans"]
    points = thrust_points([0.0268284226, 1.0508429477, -0.4337188642])
    effects: list[dict[str, object]] = []
    channels: dict[str, object] = {}
    for fan in FANS:
        ahead, left = fans["place_m_x_ahead_y_left"][fan]
        push_ahead, push_left = fans["push_x_ahead_y_left"][fan]
        angle = atan2(-push_left, push_ahead)
        on = {"thrust": f"thrust_{fan}_N", "angle": round(angle, 6)}
        channels[f"fan_{fan}_share"] = {"low": 0.0, "high": 1.0}
        channels[f"thrust_{fan}_N"] = {"low": 0.0, "high": 1.0}
        effects.append({"use": "thruster", "name": fan, "on": on, "x": ahead, "y": -left})
    effects.append(
        {
            "use": "thrust_curve",
            "on": [f"thrust_{fan}_N" for fan in FANS],
            "fed_by": [f"fan_{fan}_share" for fan in FANS],
            "points": points,
        }
    )
    effects.append({"use": "thrust_lag", "time_constant": fans["first_order_s"]})
    return Vessel.from_effects(
        name=NAME,
        dof=("surge", "sway", "yaw"),
        length=DIAMETER,
        beam=DIAMETER,
        draught=0.1 * DIAMETER,
        body=body_of(given, "blue"),
        effects=effects,
        channels=channels,
        source=given["source"],
        diagnosis={"facts": {"no_water": True, "indoors": True, "moored": False}},
    )


def body_of(given: Mapping[str, object], craft: str) -> dict[str, float]:
    """Return mass [kg] and moments of inertia [kg m^2] of one craft.

    Args:
        given: Content of vessel.json.
        craft: "old", "blue", "red", "pink" or "yellow".
    """
    masses, inertias = given["mass_kg"], given["inertia_kgm2"]
    assert isinstance(masses, dict) and isinstance(inertias, dict)
    mass = next(m for name, m in masses.items() if name.split()[0] == craft)
    inertia = inertias.get(craft, inertias["all others"])
    return {"mass": mass, "roll_inertia": ROLL_INERTIA, "yaw_inertia": inertia}


def write_notes(folder: Path, columns: Mapping[str, str]) -> None:
    """Write the recording.toml of a folder of runs: vessel, noise, craft of each run.

    Args:
        folder: Folder of the recordings.
        columns: Column of boatsim -> expression of the columns of the files.
    """
    given = json.loads((SOURCE / "vessel.json").read_text(encoding="utf-8"))
    runs: dict[str, object] = {}
    for run, craft in CRAFT.items():
        body = body_of(given, craft)
        runs[run] = {"group": craft, "set": {"body": body}}
    table: dict[str, object] = {"vessel": "../vessel/holohover"}
    if columns:
        table["columns"] = dict(columns)
    table["noise"] = {"position_sd_m": 0.0003, "heading_sd_rad": 0.002}
    table["runs"] = runs
    (folder / "recording.toml").write_text(tomlkit.dumps(table), encoding="utf-8")


def copy_columns(source: Path, target: Path) -> None:
    """Copy a table without the columns that follow from the commands.

    Args:
        source: File of the set.
        target: File to write.
    """
    with source.open(newline="", encoding="utf-8") as table:
        rows = list(csv.reader(table))
    kept = [i for i, name in enumerate(rows[0]) if not name.startswith(DERIVED)]
    with target.open("w", newline="", encoding="utf-8") as copy:
        csv.writer(copy).writerows([row[i] for i in kept] for row in rows)


def write_runs(kind: str) -> dict[str, Path]:
    """Copy the runs of one form into out/real/holohover and write their notes.

    Args:
        kind: "runs", as published in the axes of the camera, or "runs_clean".

    Returns:
        Files by name of the run.
    """
    folder = OUT / NAME / kind
    folder.mkdir(parents=True, exist_ok=True)
    files = {}
    for run in CRAFT:
        source = SOURCE / kind / f"{run}.csv"
        if source.is_file():
            files[run] = folder / source.name
            copy_columns(source, files[run])
    columns = {}
    if kind == "runs":
        columns = {"y_m": "-y_left_m", "psi_rad": "-yaw_ccw_rad"}
        columns |= {f"fan_{fan}_share": f"fan_{fan}" for fan in FANS}
    write_notes(folder, columns)
    return files


def figures_of(kind: str) -> list[Figures]:
    """Diagnose the fitted runs of one form of the files, and judge the held-out runs by build."""
    files = write_runs(kind)
    vessel = nominal_vessel().save(OUT / NAME / "vessel" / NAME)
    fitted = [files[run] for run in FITTED if run in files]
    held_out = [files[run] for runs in BUILDS.values() for run in runs if run in files]
    return [diagnose_set(f"{NAME}, {kind}", fitted, held_out, str(vessel.file), WINDOWS)]


def main() -> None:
    """Print the figures of the set for both forms of its files."""
    runs_of(NAME)
    for kind in ("runs_clean",):
        for figures in figures_of(kind):
            print_figures(figures, UNITS)
            write_report(figures.diagnosis, f"{NAME}_{kind}")


if __name__ == "__main__":
    main()
