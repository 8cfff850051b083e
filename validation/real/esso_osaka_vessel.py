"""The 3 m model of the Esso Osaka, written where it may lie: `python -m validation.real.esso_osaka_vessel`.

Its captive-test coefficients come under a non-commercial licence and are no part of this project: esso_osaka/ holds a
vessel.toml with blanks, filled from ../shared/recordings/esso_osaka/vessel.json into out/real/esso_osaka/vessel.
"""

import json
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from string import Template
from typing import Any

from validation.real.common import OUT, RECORDINGS

NAME = "esso_osaka"
BLANKS = Path(__file__).parent / NAME
SOURCE = RECORDINGS / NAME / "vessel.json"
# of I_zz + J_zz, about as of KVLCC2 (6075 of 16089 kg m^2); the sum alone moves the ship
WATERS_SHARE = 0.36


def written(folder: Path = OUT / NAME / "vessel" / NAME, wind_known: bool = False) -> Path:
    """Path of the vessel's file, made in `folder`, with an anemometer or without.

    Ends the program with one line where its numbers are not there.
    """
    if not SOURCE.is_file():
        print(f"{NAME}: skipped, there is no ../shared/recordings/{NAME}/vessel.json")
        raise SystemExit
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("hull.xml", "turn.toml"):
        shutil.copy(BLANKS / name, folder)
    parts = ("vessel.toml.in", "wind.toml.in") if wind_known else ("vessel.toml.in",)
    blanks = Template("".join((BLANKS / part).read_text(encoding="utf-8") for part in parts))
    numbers = filled(json.loads(SOURCE.read_text(encoding="utf-8")))
    file = folder / "vessel.toml"
    file.write_text(blanks.substitute(numbers), encoding="utf-8")
    return file


def filled(particulars: Mapping[str, Any]) -> dict[str, float]:
    """Every blank's number: those of the particulars by their own names, and what is made of them."""
    p = dict(_numbers(particulars))
    p |= {
        f"{short}_{i}": x
        for short, name in LISTS.items()
        for i, x in enumerate(particulars["mmg"]["propeller"][name])
    }
    p["D_m"] = particulars["propeller"]["D_m"]  # the side thrusters have one too
    unit = 0.5 * p["density_water_kgm3"] * p["Lpp_m"] ** 2 * p["draught_m"]  # [kg]
    turning = p["I_zz_plus_J_zz"] * unit * p["Lpp_m"] ** 2  # [kg m^2]
    wind, above = particulars["mmg"]["wind"], particulars["above_water"]
    front, side = -wind["X1"] * above["transverse_area_m2"], wind["Y1"] * above["lateral_area_m2"]
    return p | {
        "m_x": p["m_x"] * unit,
        "m_y": p["m_y"] * unit,
        "J_zz": WATERS_SHARE * turning,
        "yaw_inertia": (1.0 - WATERS_SHARE) * turning,
        "roll_inertia": p["mass_kg"] * (0.37 * p["beam_m"]) ** 2,
        "midship": 0.5 * p["Lpp_m"],
        "rudder_largest": p["largest_command_rad"],
        "slope": 6.13 * p["aspect_ratio"] / (p["aspect_ratio"] + 2.25),
        "end_on": front / side,
        "wind_front": front,
        "wind_side": side,
        "wind_arm": wind["N1"] / wind["Y1"] * p["Lpp_m"],
        "wind_swing": -2.0
        * wind["N2"]
        / wind["Y1"]
        * p["Lpp_m"],  # its angle is counted from the wind against it
    }


LISTS = {"astern": "astern_thrust_C", "side": "side_force_A", "moment": "yaw_moment_B"}


def _numbers(table: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Numbers of nested tables by their own names."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from _numbers(value)
        elif isinstance(value, int | float):
            yield name, float(value)


if __name__ == "__main__":
    print(written())
