"""Hovercraft with six fans: `python -m validation.real.holohover`.

The craft has no water around it: it floats on an air table and its makers' model has no damping.
Six fixed fans push in one direction each, by a measured curve of their command. The vessel has the
makers' numbers; mass and moment of inertia of each craft are set by run. A craft is a group of
recordings. The protocol (docs/protocol.md) says which runs are fitted.
"""

import argparse
import csv
import json
from collections.abc import Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from math import atan2
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit

from boatsim.cli.importing import import_log
from boatsim.physics.vessel import Vessel
from validation.real.common import DEG, OUT, RECORDINGS, out_option, print_table, runs_of
from validation.real.figures import (
    DISTANCE,
    HEADER_WITH_HELD,
    Figures,
    diagnose_set,
    error_rows,
    held_out_errors,
    print_figures,
)

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
FORMS = ("runs_clean", "runs")
FITTED = ("old_oct", "blue", "blue_unshifted", "yellow_5")
BUILDS = {"old": ("control_M0",), "5 March": ("pink",)}  # build -> held-out runs
WINDOWS = (1.0, 0.2)  # [s]
UNITS = {
    "position_rms_m": ("distance, mm", 1000.0 * DISTANCE),
    "heading_rms_rad": ("heading, deg", DEG),
}
# columns of the clean files that follow from the commands by the curve and the places of the fans
DERIVED = ("thrust_", "steer_")
# raw logs of a run, commands and poses, each with stamps of one clock
RAW_LOGS = {
    "blue_unshifted": ("blue.commands.csv", "blue.pose.csv"),
    "control_M0": ("control_M0.drone_control.csv", "control_M0.optitrack_drone_pose.csv"),
}
# what the owner of the raw logs corrects in the proposed maps: axes of the camera, names of fans
AXES = {"x_m": "pose.position.x", "y_m": "-pose.position.y", "psi_rad": "-pose.orientation.yaw"}
COMMANDS = {f"fan_{fan}_share": f"motor_{fan[0]}_{fan[1]}" for fan in FANS}
# floats on an air table, recorded by motion capture; each craft was weighed
FACTS = {
    "no_water": True,
    "indoors": True,
    "moored": False,
    "weighed": True,
    "position_fix": "tracking",
}
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
        diagnosis={"facts": FACTS},
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


def write_notes(folder: Path) -> None:
    """Write the recording.toml of a folder of runs: vessel, noise, craft of each run.

    Args:
        folder: Folder of the recordings.
    """
    given = json.loads((SOURCE / "vessel.json").read_text(encoding="utf-8"))
    runs: dict[str, object] = {}
    for run, craft in CRAFT.items():
        body = body_of(given, craft)
        groups = [craft]
        if craft != "old":
            groups.append("5 March")
        if run in RAW_LOGS:
            groups.append("raw clock")  # the poses of the others were moved against the commands
        runs[run] = {"group": groups, "set": {"body": body}}
    table: dict[str, object] = {"vessel": "../vessel/holohover"}
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


def import_published(run: str, folder: Path, vessel: Path) -> Path:
    """Import a run as published by the map that `boatsim import --propose` writes.

    For the raw logs the owner corrects columns of the map. What the import says about times that
    do not agree, or about repairs, is printed.

    Args:
        run: Name of the run.
        folder: Folder of the recording.
        vessel: File of the vessel.

    Returns:
        The recording.
    """
    names = RAW_LOGS.get(run, (f"{run}.csv",))
    logs = [SOURCE / "runs" / name for name in names]
    map_file, out = folder / f"{run}.map.toml", folder / f"{run}.csv"
    notes = StringIO()
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        import_log(logs, None, None, map_file, str(vessel), ())
    text = tomlkit.parse(map_file.read_text(encoding="utf-8"))
    columns: dict[str, Any] = text.setdefault("columns", {})
    columns.update(AXES | COMMANDS if run in RAW_LOGS else {})
    map_file.write_text(tomlkit.dumps(text), encoding="utf-8")
    with redirect_stdout(StringIO()), redirect_stderr(notes):
        import_log(logs, out, map_file, None, str(vessel), ())
    for remark in notes.getvalue().split("note: ")[1:]:
        print(f"  {run}: {' '.join(remark.split())}")
    return out


def write_runs(kind: str, vessel: Path) -> dict[str, Path]:
    """Write the runs of one form into out/real/holohover, with their notes.

    Args:
        kind: "runs", as published in the axes of the camera, or "runs_clean".
        vessel: File of the vessel.

    Returns:
        Files by name of the run.
    """
    folder = OUT / NAME / kind
    folder.mkdir(parents=True, exist_ok=True)
    write_notes(folder)
    files = {}
    for run in CRAFT:
        if kind == "runs":
            files[run] = import_published(run, folder, vessel)
        else:
            files[run] = folder / f"{run}.csv"
            copy_columns(SOURCE / kind / f"{run}.csv", files[run])
    return files


def print_build(figures: Figures, build: str, names: Sequence[str]) -> None:
    """Print the errors of free runs on the held-out runs of one build.

    Args:
        figures: Figures of the set, with its diagnosis.
        build: Name of the build.
        names: Names of the held-out runs of the build.
    """
    own = [run for run in figures.held_out if run.name in names]
    rows = []
    for window in WINDOWS:
        families = held_out_errors(figures.diagnosis, own, window)
        rows += error_rows(f"{window:g} s", families, UNITS)
    print_table(f"{figures.title}, build {build}", HEADER_WITH_HELD, rows)


def main() -> None:
    """Print the figures of the set, by form of its files and by build."""
    parser = argparse.ArgumentParser(description="Figures of a hovercraft with six fans")
    parser.add_argument("forms", nargs="*", help=f"of {', '.join(FORMS)}; all without any")
    out_option(parser, NAME)
    given = parser.parse_args()
    runs_of(NAME)
    vessel = nominal_vessel().save(OUT / NAME / "vessel" / NAME).file
    for form in given.forms or FORMS:
        files = write_runs(form, vessel)
        held_out = [files[run] for runs in BUILDS.values() for run in runs]
        fitted = [files[run] for run in FITTED]
        title, report = f"{NAME}, {form}", given.out / f"{form}_report"
        figures = diagnose_set(title, fitted, held_out, str(vessel), WINDOWS, report)
        print_figures(figures, UNITS)
        for build, runs in BUILDS.items():
            print_build(figures, build, runs)


if __name__ == "__main__":
    main()
