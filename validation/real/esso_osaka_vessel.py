"""Vessel file of the 3 m model of the Esso Osaka: `python -m validation.real.esso_osaka_vessel`.

Its captive-test coefficients come under a non-commercial licence and are not part of this project.
The folder esso_osaka/ holds a template, vessel.toml.in, that is filled from
../shared/recordings/esso_osaka/vessel.json and written to out/real/esso_osaka/vessel.
"""

import json
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from string import Template
from typing import Any

from validation.real.common import OUT, RECORDINGS

NAME = "esso_osaka"
TEMPLATES = Path(__file__).parent / NAME
SOURCE = RECORDINGS / NAME / "vessel.json"
# of I_zz + J_zz, about as of KVLCC2 (6075 of 16089 kg m^2); only the sum affects the motion
ADDED_INERTIA_SHARE = 0.36
# lists of propeller coefficients: name of their placeholders -> key in vessel.json
LISTS = {"astern": "astern_thrust_C", "side": "side_force_A", "moment": "yaw_moment_B"}


def write_vessel(folder: Path = OUT / NAME / "vessel" / NAME, wind_known: bool = False) -> Path:
    """Write the vessel into a folder and return the path of its file.

    Args:
        folder: Folder of the vessel, created if needed.
        wind_known: Whether the vessel has an anemometer.

    Raises:
        SystemExit: vessel.json is not on this machine; one line is printed.
    """
    if not SOURCE.is_file():
        print(f"{NAME}: skipped, there is no ../shared/recordings/{NAME}/vessel.json")
        raise SystemExit
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("hull.xml", "turn.toml"):
        shutil.copy(TEMPLATES / name, folder)
    text = (TEMPLATES / "vessel.toml.in").read_text(encoding="utf-8")
    if wind_known:
        text += (TEMPLATES / "wind.toml.in").read_text(encoding="utf-8")
    numbers = placeholders(json.loads(SOURCE.read_text(encoding="utf-8")))
    file = folder / "vessel.toml"
    file.write_text(Template(text).substitute(numbers), encoding="utf-8")
    return file


def placeholders(particulars: Mapping[str, Any]) -> dict[str, float]:
    """Return the number of each placeholder: all particulars by name, and derived values.

    Args:
        particulars: Content of vessel.json.
    """
    p = dict(_numbers(particulars))
    for short, name in LISTS.items():
        for i, x in enumerate(particulars["mmg"]["propeller"][name]):
            p[f"{short}_{i}"] = x
    p["D_m"] = particulars["propeller"]["D_m"]  # the side thrusters have a diameter too
    unit = 0.5 * p["density_water_kgm3"] * p["Lpp_m"] ** 2 * p["draught_m"]  # [kg]
    inertia = p["I_zz_plus_J_zz"] * unit * p["Lpp_m"] ** 2  # [kg m^2]
    wind, above = particulars["mmg"]["wind"], particulars["above_water"]
    front = -wind["X1"] * above["transverse_area_m2"]
    side = wind["Y1"] * above["lateral_area_m2"]
    return p | {
        "m_x": p["m_x"] * unit,
        "m_y": p["m_y"] * unit,
        "J_zz": ADDED_INERTIA_SHARE * inertia,
        "yaw_inertia": (1.0 - ADDED_INERTIA_SHARE) * inertia,
        "roll_inertia": p["mass_kg"] * (0.37 * p["beam_m"]) ** 2,
        "midship": 0.5 * p["Lpp_m"],
        "rudder_largest": p["largest_command_rad"],
        "slope": 6.13 * p["aspect_ratio"] / (p["aspect_ratio"] + 2.25),
        "end_on": front / side,
        "wind_front": front,
        "wind_side": side,
        "wind_arm": wind["N1"] / wind["Y1"] * p["Lpp_m"],
        # the source counts the wind's angle in the opposite direction
        "wind_swing": -2.0 * wind["N2"] / wind["Y1"] * p["Lpp_m"],
    }


def _numbers(table: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Yield the numbers of nested tables by their own names."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from _numbers(value)
        elif isinstance(value, int | float):
            yield name, float(value)


if __name__ == "__main__":
    print(write_vessel())
