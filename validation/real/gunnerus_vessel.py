"""Vessel file of R/V Gunnerus: `python -m validation.real.gunnerus_vessel`.

The makers' numbers come from a repository under the GPL and are not part of this project. The
folder gunnerus/ holds a template, vessel.toml.in, that is filled from
../shared/recordings/gunnerus_trials/vessel.json and written to out/real/gunnerus_trials/vessel.
"""

import json
import shutil
from collections.abc import Mapping
from math import pi
from pathlib import Path
from string import Template
from typing import Any

from validation.real.common import OUT, RECORDINGS

NAME = "gunnerus_trials"
TEMPLATES = Path(__file__).parent / "gunnerus"
SOURCE = RECORDINGS / NAME / "vessel.json"
RPM = 2.0 * pi / 60.0  # [rad/s per 1/min]


def write_vessel(folder: Path = OUT / NAME / "vessel" / "gunnerus") -> Path:
    """Write the vessel into a folder and return the path of its file.

    Args:
        folder: Folder of the vessel, created if needed.

    Raises:
        SystemExit: vessel.json is not on this machine; one line is printed.
    """
    if not SOURCE.is_file():
        print(f"{NAME}: skipped, there is no ../shared/recordings/{NAME}/vessel.json")
        raise SystemExit
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(TEMPLATES / "hull.xml", folder)
    numbers = placeholders(json.loads(SOURCE.read_text(encoding="utf-8")))
    text = (TEMPLATES / "vessel.toml.in").read_text(encoding="utf-8")
    file = folder / "vessel.toml"
    file.write_text(Template(text).substitute(numbers), encoding="utf-8")
    return file


def placeholders(particulars: Mapping[str, Any]) -> dict[str, float]:
    """Return the number of each placeholder of the template.

    Args:
        particulars: Content of vessel.json.
    """
    size, model, drive = (particulars[key] for key in ("particulars", "model_3dof", "thrusters"))
    added, linear = model["added"], model["damping_linear"]
    at = 0.5 * (added[1][2] + added[2][1]) / added[1][1]  # [m] centre of the added mass in sway
    lags = drive["lags"]
    return {
        **{key: size[key] for key in ("length_pp_m", "beam_m", "draught_m", "mass_kg")},
        "yaw_inertia": model["rigid"][2][2],
        "roll_inertia": particulars["model_4dof"]["rigid"][2][2],
        "A11": added[0][0],
        "A22": added[1][1],
        "A26_at": at,
        "A66_at": added[2][2] - added[1][1] * at**2,
        "B11": linear[0][0],
        "B22": linear[1][1],
        "B66": linear[2][2],
        "B26": linear[1][2],
        "B62": linear[2][1],
        "D11": model["damping_abs_u"][0][0],
        "D22": model["damping_abs_v"][1][1],
        "D66": model["damping_abs_r"][2][2],
        "thrust": drive["count"] * drive["Ct_N_per_rpm2"] / RPM**2,
        "thruster_x": drive["x_m"],
        "thruster_z": drive["z_m"],
        "foil_area": drive["count"] * drive["A_m2"],
        "foil_drag": drive["Cd0"],
        "foil_drag_slope": drive["Cda_per_rad"],
        "foil_lift": drive["Cl"],
        "azimuth_rate": drive["lags"]["azimuth_rate_degps"] * pi / 180.0,
        "azimuth_lag": lags["azimuth_s"],
        "shaft_lag": lags["revolutions_s"],
    }


if __name__ == "__main__":
    print(write_vessel())
