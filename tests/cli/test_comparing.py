"""A run compared with what it is of: the effects of its scenario act, and where they cannot, it is
said."""

import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.recordings.notes import notes_for

SCENARIO = """
vessel = "joystick_boat"
load = ["light", "narrow"]
duration = 8.0
[controller]
use = "l1_joystick"
[[goal]]
yaw_radps = 0.14
[[effect]]
use = "weak_reverse"
astern_factor = 0.5
[[effect]]
use = "fan_wind"
speed = 1.0
"""


def boatsim(*arguments: object) -> Any:
    """The command run in this process: exit_code, stdout, stderr."""
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def heading_error(*arguments: object) -> tuple[float, str]:
    """Rms [rad], and what was remarked."""
    result = boatsim("compare", *arguments)
    assert result.exit_code == 0, result.output
    found = re.search(r"^psi_rad +(\S+)", result.stdout, re.M)
    assert found
    return float(found[1]), result.stderr


@pytest.fixture
def run(tmp_path: Path) -> Path:
    (tmp_path / "own.toml").write_text(SCENARIO)
    assert boatsim("run", tmp_path / "own.toml", "--out", tmp_path / "run").exit_code == 0
    return tmp_path / "run" / "recording.csv"


@pytest.mark.slow
def test_a_run_knows_its_scenario_and_is_compared_with_all_that_acted_in_it(
    run: Path, tmp_path: Path
) -> None:
    assert notes_for(run).notes.facts["scenario"] == str(tmp_path / "own.toml")
    own, said = heading_error(run, "--out", tmp_path / "c")
    bare, _ = heading_error(run, "--vessel", "joystick_boat", "--out", tmp_path / "c")
    assert own < 1e-6 < 0.01 < bare
    assert "adds weak_reverse, fan_wind" in said


@pytest.mark.slow
def test_a_scenario_that_is_gone_or_of_another_boat_is_said_and_the_vessel_acts_alone(
    run: Path, tmp_path: Path
) -> None:
    bare, _ = heading_error(run, "--vessel", "joystick_boat", "--out", tmp_path / "c")
    (tmp_path / "own.toml").rename(tmp_path / "gone.toml")
    found, said = heading_error(run, "--out", tmp_path / "c")
    assert found == bare and "compared with the vessel alone" in said and "no such file" in said
    notes = run.parent / "recording.toml"
    notes.write_text(
        notes.read_text().replace(str(tmp_path / "own.toml"), "kvlcc2_mmg/turning_circle")
    )
    found, said = heading_error(run, "--out", tmp_path / "c")
    assert found == bare and "compared with the vessel alone" in said
