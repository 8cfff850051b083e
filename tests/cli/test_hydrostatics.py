"""The command `boatsim hydrostatics`: what it prints and writes, and wrong options."""

import csv
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.physics.vessel import load_vessel
from tests.pages import ROOT

HULL = ROOT / "models" / "otter" / "hull.obj"
OPEN = ROOT / "models" / "joystick_boat" / "shell.obj"  # without a deck
SVG = "{http://www.w3.org/2000/svg}"


def printed(*words: str) -> str:
    """Output of the command, which succeeds."""
    done = CliRunner().invoke(app, ["hydrostatics", *words], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.stdout


def rows_of(folder: Path) -> list[dict[str, float]]:
    """Rows of the written table."""
    with (folder / "righting_arm.csv").open(encoding="utf-8") as file:
        return [{key: float(x) for key, x in row.items()} for row in csv.DictReader(file)]


def test_scenario_with_a_mesh(tmp_path: Path) -> None:
    text = printed("otter/released_60", "--heel", "0,30,60,90", "--out", str(tmp_path / "out"))
    assert "displacement 55 kg" in text
    assert "angle of vanishing stability 65.7 deg" in text
    rows = rows_of(tmp_path / "out")
    assert [row["heel_rad"] for row in rows] == pytest.approx(np.radians([0, 30, 60, 90]))
    assert rows[1]["righting_arm_m"] > rows[2]["righting_arm_m"] > 0.0 > rows[3]["righting_arm_m"]
    root = ElementTree.parse(tmp_path / "out" / "righting_arm.svg").getroot()
    assert len(root.findall(f"{SVG}circle")) == 4


def test_mass_and_draught_of_a_mesh_are_two_ways_to_state_one_load(tmp_path: Path) -> None:
    out = str(tmp_path / "out")
    by_mass = printed(str(HULL), "--mass", "50", "--heel", "0,10", "--out", out)
    draught = rows_of(tmp_path / "out")[0]["draught_m"]
    by_draught = printed(str(HULL), "--draught", f"{draught:.12g}", "--heel", "0,10", "--out", out)
    assert by_mass == by_draught
    assert "no angle of vanishing stability from 0 to 10 deg" in by_mass


def test_longer_unit_and_deeper_mass_centre(tmp_path: Path) -> None:
    out = str(tmp_path / "out")
    base = [str(HULL), "--heel", "10", "--out", out]
    printed(*base, "--mass", "50")
    arm = rows_of(tmp_path / "out")[0]["righting_arm_m"]
    printed(*base, "--mass", "50", "--centre-depth", "0.1")
    deeper = rows_of(tmp_path / "out")[0]["righting_arm_m"]
    assert deeper - arm == pytest.approx(0.1 * np.sin(np.radians(10.0)), abs=1e-6)
    printed(*base, "--mass", "50000", "--scale", "10")
    assert rows_of(tmp_path / "out")[0]["righting_arm_m"] == pytest.approx(10.0 * arm, rel=1e-6)
    assert not (tmp_path / "out" / "righting_arm.svg").exists()  # one heel is no curve


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["otter"], "the vessel has no hull_buoyancy"),
        ([str(HULL)], "a mesh needs either --mass or --draught"),
        ([str(HULL), "--mass", "1", "--draught", "0.1"], "either --mass or --draught"),
        ([str(HULL), "--mass", "400"], "the hull encloses 0.149759 m^3"),
        ([str(HULL), "--draught", "3"], "allowed is less than the height of the mesh"),
        ([str(HULL), "--mass", "50", "--heel", "a"], "allowed are angles in degrees"),
        ([str(HULL), "--mass", "50", "--heel", "10,0"], "the angles must increase"),
        ([str(HULL), "--mass", "50", "--heel", "200"], "allowed are -180 to 180 degrees"),
        ([str(HULL), "--mass", "50", "--load", "x"], "--load belongs to a vessel"),
        (["otter/released_60", "--scale", "2"], "--scale belongs to a mesh"),
        (["none.stl", "--mass", "2"], "none.stl: there is no such file"),
        ([str(OPEN), "--mass", "4"], "the mesh is open"),
    ],
)
def test_mistakes_are_named_in_one_line(words: list[str], message: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["hydrostatics", *words, "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_shipped_mesh_is_that_of_the_vessel() -> None:
    boat = load_vessel("otter")
    assert (boat.path / "hull.obj").samefile(HULL)
