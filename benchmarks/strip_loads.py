"""Errors of `strip_wave_loads` against a boundary element method.

python -m benchmarks.strip_loads             added mass and damping of each wavelength
python -m benchmarks.strip_loads --fixed 4   those of waves of 4 m, twice the length, for all

Hulls and reference are those of tests/data/strip_loads. The error of an amplitude is relative to the
largest one of its axis and heading over all wavelengths.
"""

import argparse
import csv
from functools import cache
from math import pi, radians, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.physics.base import AXES, Array, make_motion
from boatsim.physics.effects.strip_wave_loads import GRAVITY, StripWaveLoads

DATA = Path(__file__).parents[1] / "tests" / "data" / "strip_loads"
HEADINGS = (180.0, 135.0, 90.0)  # [deg] ahead, bow, abeam
LENGTH = 2.0  # [m] of all hulls
WIGLEY = {
    "hull_beam": 0.25,
    "draught": 0.125,
    "block_coefficient": 4.0 / 9.0,
    "waterplane_coefficient": 2.0 / 3.0,
    "waterplane_gyradius": 0.5 * LENGTH * sqrt(0.2),
}
HULLS: dict[str, dict[str, Any]] = {
    "box": {
        "hull_beam": 0.5,
        "draught": 0.15,
        "block_coefficient": 1.0,
        "waterplane_coefficient": 1.0,
        "waterplane_gyradius": LENGTH / sqrt(12.0),
    },
    "wigley": WIGLEY,
    "catamaran": WIGLEY | {"hull_spacing": 0.79},
}
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


def errors(hull: str, heading: float, fixed: float = 0.0) -> dict[str, dict[float, float]]:
    """Return the errors of the wave loads on a hull, by axis and wavelength [m].

    Args:
        hull: Name of the hull.
        heading: Direction of the waves, 180 from ahead [deg].
        fixed: Wavelength of the added mass and damping that are used for all [m]; 0: each its own.
    """
    places = ("flotation", "buoyancy", "sway_mass_at", "sway_mass_below", "sway_damping_at")
    rows = [r for r in table("excitation") if r["hull"] == hull]
    rows = [r for r in rows if float(r["heading_deg"]) == heading]
    wavelengths = [float(r["wavelength_m"]) for r in rows]
    wanted = np.array([list(map(float, list(r.values())[3:])) for r in rows])
    found = []
    for wavelength in wavelengths:
        effect = StripWaveLoads(
            spectrum="regular",
            significant_height=2.0,
            modal_period=sqrt(2 * pi * wavelength / GRAVITY),
            toward=radians(heading),
            length=LENGTH,
            **dict.fromkeys(places, 0.0),
            **HULLS[hull],
            **coefficients(hull, fixed or wavelength),
        )
        found.append(amplitudes(effect))
    largest = wanted.max(axis=0)
    relative = (np.array(found) - wanted) / largest
    compared = {}
    for i, axis in enumerate(AXES):
        if largest[i] > SMALLEST * largest.max():
            compared[axis] = dict(zip(wavelengths, relative[:, i].tolist(), strict=True))
    return compared


def main() -> None:
    """Print the errors of all hulls in per cent."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--fixed", type=float, default=0.0, metavar="WAVELENGTH", help="[m]")
    fixed = parser.parse_args().fixed
    heads = False
    for hull in HULLS:
        for heading in HEADINGS:
            for axis, by_wavelength in errors(hull, heading, fixed).items():
                if not heads:
                    ratios = "".join(f"{w / LENGTH:7g}" for w in by_wavelength)
                    print(f"{'error [%] at wavelength / length':<34}{ratios}")
                    heads = True
                cells = "".join(f"{100 * e:7.0f}" for e in by_wavelength.values())
                print(f"{hull:<11}{heading:4.0f} deg  {axis:<15}{cells}")


if __name__ == "__main__":
    main()
