"""Errors of `strip_wave_loads` against a boundary element method.

python -m benchmarks.strip_loads             added mass and damping of each wavelength
python -m benchmarks.strip_loads --fixed 4   those of waves of 4 m, twice the length, for all
python -m benchmarks.strip_loads --mesh      with the sections of meshes of the hulls

Hulls and reference are those of tests/data/strip_loads. The error of an amplitude is relative to the
largest one of its axis and heading over all wavelengths.
"""

import argparse
import csv
from dataclasses import replace
from functools import cache
from math import pi, radians, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from boatsim.physics.base import AXES, Array, make_motion
from boatsim.physics.effects.strip_wave_loads import GRAVITY, StripWaveLoads
from boatsim.physics.hull.mesh import ClosedMesh
from tests import hull_meshes

DATA = Path(__file__).parents[1] / "tests" / "data" / "strip_loads"
HEADINGS = (180.0, 135.0, 90.0)  # [deg] ahead, bow, abeam
LENGTH, SPACING = 2.0, 0.79  # [m] of all hulls, and between the hulls of the catamaran
PARTS = 24  # panels of a Wigley hull over half its length, and over its draught
WIGLEY = {
    "hull_beam": 0.25,
    "draught": 0.125,
    "block_coefficient": 4.0 / 9.0,
    "waterplane_coefficient": 2.0 / 3.0,
    "waterplane_gyradius": 0.5 * LENGTH * sqrt(0.2),
}
BOX = {"hull_beam": 0.5, "draught": 0.15}
HULLS: dict[str, dict[str, Any]] = {
    "box": {
        **BOX,
        "block_coefficient": 1.0,
        "waterplane_coefficient": 1.0,
        "waterplane_gyradius": LENGTH / sqrt(12.0),
    },
    "wigley": WIGLEY,
    "catamaran": WIGLEY | {"hull_spacing": SPACING},
}
PLACES = ("sway_mass_at", "sway_mass_below", "sway_damping_at")  # of added mass and damping: 0
SMALLEST = 0.02  # amplitudes below this share of the largest force are not compared


@cache
def table(name: str) -> list[dict[str, str]]:
    """Return the rows of a reference table."""
    with (DATA / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def coefficients(hull: str, wavelength: float) -> dict[str, float]:
    """Return added mass and damping of a hull at a wavelength, as parameters of the effect."""
    rows = [r for r in table("coefficients") if r["hull"] == hull]
    row = next(r for r in rows if float(r["wavelength_m"]) == wavelength)
    found = {}
    for i, axis in enumerate(AXES, 1):
        found[f"{axis}_mass"] = max(0.0, float(row[f"a{i}{i}"]))
        found[f"{axis}_damping"] = max(0.0, float(row[f"b{i}{i}"]))
    return found


def amplitudes(effect: StripWaveLoads) -> Array:
    """Return the amplitudes (6,) of forces [N] and moments [N m] of a regular wave."""
    quarter = 0.25 * effect.modal_period
    start, later = (np.array(effect.wrench(make_motion(t=t))) for t in (0.0, quarter))
    return np.hypot(start, later)


def hull_mesh(hull: str) -> ClosedMesh:
    """Return the mesh of a hull, twice as high as its draught in the case of the box.

    Args:
        hull: Name of the hull.
    """
    if hull == "box":
        return hull_meshes.box(LENGTH, BOX["hull_beam"], 2.0 * BOX["draught"])
    one = hull_meshes.wigley(LENGTH, WIGLEY["hull_beam"], WIGLEY["draught"], PARTS)
    if hull == "catamaran":
        return hull_meshes.catamaran(one, SPACING)
    return one


def geometry(hull: str, folder: Path | None) -> dict[str, Any]:
    """Return the geometry of a hull as settings of the effect.

    Args:
        hull: Name of the hull.
        folder: Folder to which its mesh is written; None for its particulars.
    """
    places = dict.fromkeys(PLACES, 0.0)
    if folder is None:
        return places | {"flotation": 0.0, "buoyancy": 0.0, "length": LENGTH} | HULLS[hull]
    path = folder / f"{hull}.obj"
    if not path.exists():
        hull_meshes.written(hull_mesh(hull), path)
    return places | {"mesh": str(path), "draught": HULLS[hull]["draught"]}


def errors(
    hull: str, heading: float, fixed: float = 0.0, folder: Path | None = None
) -> dict[str, dict[float, float]]:
    """Return the errors of the wave loads on a hull, by axis and wavelength [m].

    Args:
        hull: Name of the hull.
        heading: Direction of the waves, 180 from ahead [deg].
        fixed: Wavelength of the added mass and damping that are used for all [m]; 0: each its own.
        folder: Folder to which the mesh of the hull is written; None: the particulars of the hull
            instead of the sections of its mesh.
    """
    rows = [r for r in table("excitation") if r["hull"] == hull]
    rows = [r for r in rows if float(r["heading_deg"]) == heading]
    wavelengths = [float(r["wavelength_m"]) for r in rows]
    wanted = np.array([list(map(float, list(r.values())[3:])) for r in rows])
    given, found = geometry(hull, folder), []
    for wavelength in wavelengths:
        effect = StripWaveLoads(
            spectrum="regular",
            significant_height=2.0,
            modal_period=sqrt(2 * pi * wavelength / GRAVITY),
            toward=radians(heading),
            **given,
            **coefficients(hull, fixed or wavelength),
        )
        if effect.mesh:
            effect = replace(effect, **effect.sections().particulars())
        found.append(amplitudes(effect))
    largest = wanted.max(axis=0)
    relative = (np.array(found) - wanted) / largest
    compared = {}
    for i, axis in enumerate(AXES):
        if largest[i] > SMALLEST * largest.max():
            compared[axis] = dict(zip(wavelengths, relative[:, i].tolist(), strict=True))
    return compared


def print_errors(fixed: float, folder: Path | None) -> None:
    """Print the errors of all hulls in per cent.

    Args:
        fixed: Wavelength of the added mass and damping that are used for all [m]; 0: each its own.
        folder: Folder to which meshes of the hulls are written; None: particulars.
    """
    heads = False
    for hull in HULLS:
        for heading in HEADINGS:
            for axis, by_wavelength in errors(hull, heading, fixed, folder).items():
                if not heads:
                    ratios = "".join(f"{w / LENGTH:7g}" for w in by_wavelength)
                    print(f"{'error [%] at wavelength / length':<34}{ratios}")
                    heads = True
                cells = "".join(f"{100 * e:7.0f}" for e in by_wavelength.values())
                print(f"{hull:<11}{heading:4.0f} deg  {axis:<15}{cells}")


def main() -> None:
    """Print the errors of all hulls in per cent."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--fixed", type=float, default=0.0, metavar="WAVELENGTH", help="[m]")
    parser.add_argument("--mesh", action="store_true", help="sections of meshes")
    given = parser.parse_args()
    if not given.mesh:
        print_errors(given.fixed, None)
        return
    with TemporaryDirectory() as folder:
        print_errors(given.fixed, Path(folder))


if __name__ == "__main__":
    main()
