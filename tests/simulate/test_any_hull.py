"""A hull that anyone draws will do: whatever its geoms are, it is shown, and a diagnosis ends with
all its files."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from boats import PLANAR
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.physics import vessel
from boatsim.recordings.table import Recording, write_csv
from boatsim.simulate import world
from boatsim.simulate.tank import Tank
from boatsim.view.scene import Scene, scene_from_model

HULLS = {  # geoms of the hull's body
    "box_of_the_default_group": '<geom type="box" size="0.5 0.2 0.1"/>',
    "capsule": '<geom type="capsule" fromto="-0.3 0 0 0.3 0 0" size="0.2"/>',
    "in_group_1": '<geom type="ellipsoid" size="0.5 0.2 0.1" group="1"/>',
    "only_a_touching_shape": '<geom type="box" size="0.5 0.2 0.1" group="3"/>',
    "no_geom_at_all": '<inertial pos="0 0 0" mass="6" diaginertia="0.1 0.5 0.5"/>',
}


def drawn(folder: Path, geoms: str) -> Path:
    """A vessel folder with a hull as plain as can be."""
    place = folder / "plain_boat"
    place.mkdir()
    (place / "hull.xml").write_text(
        f'<mujoco><worldbody><body name="hull">{geoms}</body></worldbody></mujoco>'
    )
    (place / "vessel.toml").write_text(PLANAR)
    return place


def scene(place: Path) -> Scene:
    boat, tank = vessel.load_vessel(str(place)), Tank(10.0, 10.0, 1.0, walls=False)
    return scene_from_model(world.build_model(boat, tank), boat, tank)


@pytest.mark.parametrize("geoms", HULLS.values(), ids=HULLS)
def test_every_hull_has_an_outline_of_its_size(geoms: str, tmp_path: Path) -> None:
    seen = scene(drawn(tmp_path, geoms))
    ring = seen.hull_outline()
    assert np.ptp(ring[:, 0]) == pytest.approx(1.0, abs=0.01) and np.ptp(
        ring[:, 1]
    ) == pytest.approx(0.4, abs=0.01)


def coasting(folder: Path) -> Path:
    """A recording of the boat as its file has it: 3 N s/m and 8 N s^2/m^2 on 6.6 kg in surge, from
    1 m/s."""
    t = np.arange(0.0, 20.0, 0.1)
    decay = np.exp(-3.0 * t / 6.6)
    speed = decay / (1.0 + 8.0 / 3.0 * (1.0 - decay))
    x = np.concatenate([[0.0], np.cumsum(0.05 * (speed[1:] + speed[:-1]))])
    noise = np.random.default_rng(0).normal(0.0, 1.0, (3, len(t)))
    still = {f"thrust_{side}_N": np.zeros(len(t)) for side in ("port", "starboard")}
    still |= {f"steer_{side}_rad": np.zeros(len(t)) for side in ("port", "starboard")}
    pose = {"x_m": x + 0.002 * noise[0], "y_m": 0.002 * noise[1], "psi_rad": 0.005 * noise[2]}
    write_csv(Recording("run", t, pose | still), folder / "run.csv")
    return folder / "run.csv"


def boatsim(*arguments: Any) -> Any:
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


@pytest.mark.slow
def test_a_diagnosis_of_a_boat_with_a_plain_hull_leaves_all_its_files(tmp_path: Path) -> None:
    place = drawn(tmp_path, HULLS["box_of_the_default_group"])
    run, out = coasting(tmp_path), tmp_path / "out"
    done = boatsim("diagnose", run, "--vessel", f"{place}", "--out", out)
    assert done.exit_code == 0, done.stderr
    answer = json.loads((out / "diagnosis.json").read_text())
    assert answer["candidates"] and answer["verdict"] == "nothing_missing"
    wanted = {"diagnosis.json", "diagnosis.rrd", "patched.toml", "report.html", "report.md"}
    assert wanted == {f.name for f in out.iterdir()}
