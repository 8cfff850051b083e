"""Several controllers side by side: a folder each, one table, one log with all boats; what does not
fit is said."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rerun.chunk import RrdReader
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.recordings.table import read

SCENARIO = """
vessel = "joystick_boat"
load = ["light", "narrow"]
duration = 2.0
[controller]
use = "l1_joystick"
pole = 0.7
[[goal]]
sway_mps = 0.07
"""
BLIND = """
from dataclasses import dataclass
from boatsim.control.base import Controller

@dataclass
class Blind(Controller):
    goals = ("sway_mps", "course_rad")

    def step(self, sense, goal):
        return {"steer_port_rad": goal["course_rad"]}
"""
PAIR = ("--controller", "pid_autopilot", "--controller", "l1_joystick")


def boatsim(*arguments: object) -> Any:
    """The command run in this process: exit_code, stdout, stderr."""
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Any]:
    home = tmp_path_factory.mktemp("pair")
    (home / "own.toml").write_text(SCENARIO)
    return home / "out", boatsim("run", home / "own.toml", *PAIR, "--out", home / "out")


def norms(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "norms.json").read_text())
    return found


def test_each_controller_has_a_folder_and_the_log_of_all_lies_beside_them(
    both: tuple[Path, Any],
) -> None:
    out, result = both
    assert result.exit_code == 0, result.output
    assert {f.name for f in out.iterdir()} == {"pid_autopilot", "l1_joystick", "compare.rrd"}
    assert [norms(out / c)["controller"] for c in ("pid_autopilot", "l1_joystick")] == [
        "pid_autopilot",
        "l1_joystick",
    ]


def test_the_table_has_every_norm_of_every_run_and_marks_the_lowest(both: tuple[Path, Any]) -> None:
    out, result = both
    found = [norms(out / c)["norms"] for c in ("pid_autopilot", "l1_joystick")]
    for name, first in found[0].items():
        row = next(
            line for line in result.stdout.splitlines() if f"{name} [{first['unit']}]" in line
        )
        cells = [cell.strip() for cell in row.strip("│").split("│")]
        assert cells[1] == first["kind"]
        values = [f"{one[name]['value']:.4g}" for one in found]
        lowest = min(values, key=float)
        assert cells[2:] == [
            f"{v} *" if v == lowest and len(set(values)) > 1 else v for v in values
        ]


def test_the_scenarios_own_controller_keeps_its_settings(
    both: tuple[Path, Any], tmp_path: Path
) -> None:
    out, _ = both
    (tmp_path / "own.toml").write_text(SCENARIO)
    assert boatsim("run", tmp_path / "own.toml", "--out", tmp_path / "alone").exit_code == 0
    assert (tmp_path / "alone" / "recording.csv").read_bytes() == (
        out / "l1_joystick" / "recording.csv"
    ).read_bytes()


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_the_log_holds_what_each_run_recorded_under_its_name_and_the_shared_goal_once(
    both: tuple[Path, Any],
) -> None:
    out, _ = both
    logged: dict[str, list[float]] = {}
    for chunk in RrdReader(out / "compare.rrd").stream().to_chunks():
        name = chunk.entity_path.removeprefix("/")
        table = chunk.to_record_batch()
        if name.startswith("signals/") and "Scalars:scalars" in table.schema.names:
            logged.setdefault(name, []).extend(
                v[0] for v in table.column("Scalars:scalars").to_pylist() if v
            )
    for boat in ("pid_autopilot", "l1_joystick"):
        recorded = read(out / boat / "recording.csv")
        assert np.allclose(logged[f"signals/{boat}/v_mps"], recorded["v_mps"], atol=1e-9)
    assert [n for n in logged if n.endswith("goal_sway_mps")] == [
        "signals/pid_autopilot/goal_sway_mps"
    ]


@pytest.mark.parametrize(
    ("controller", "said"),
    [
        (
            "pd_heading",
            r"controller pd_heading does not fit own: own.toml: \[\[goal\]\] key 'sway_mps' does not exist",
        ),
        ("l1_heading_discrete", r"controller l1_heading_discrete does not fit own: "),
        (
            "blind.py",
            r"controller .*blind.py does not fit own: no \[\[goal\]\] in force gives course_rad",
        ),
        ("pid_autopilo", r"controller 'pid_autopilo' does not exist; did you mean 'pid_autopilot'"),
    ],
)
def test_a_controller_that_does_not_fit_is_one_line_and_nothing_runs(
    controller: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("own.toml").write_text(SCENARIO)
    Path("blind.py").write_text(BLIND)
    result = boatsim("run", "own.toml", "--controller", "pid_autopilot", "--controller", controller)
    assert result.exit_code == 2 and not Path("out").exists()
    (line,) = result.stderr.splitlines()
    assert re.match(f"boatsim: {said}", line), line


def test_one_controller_alone_changes_no_folder(tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text(SCENARIO)
    result = boatsim(
        "run", tmp_path / "own.toml", "--controller", "pid_autopilot", "--out", tmp_path / "o"
    )
    assert result.exit_code == 0 and norms(tmp_path / "o")["controller"] == "pid_autopilot"
    assert (
        not (tmp_path / "o" / "compare.rrd").exists() and "pid_autopilot, seed 0" in result.stdout
    )


def test_two_scenarios_side_by_side_differ_in_their_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, pole in (("slow", "0.5"), ("quick", "2.0")):
        Path(f"{name}.toml").write_text(SCENARIO.replace("0.7", pole))
    result = boatsim("run", "slow.toml", "quick.toml", "--side-by-side")
    assert result.exit_code == 0 and (Path("out") / "compare.rrd").is_file()
    assert re.search(r"metric\s*┃\s*kind\s*┃\s*slow\s*┃\s*quick", result.stdout)
    assert boatsim("run", "slow.toml", *PAIR[:2], *PAIR[:2]).exit_code == 2


def test_a_norm_that_has_another_unit_in_another_scenario_has_a_row_for_each(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, signal in (("drift", "v_mps"), ("turn", "r_radps")):
        Path(f"{name}.toml").write_text(
            f'measure = {{ use = "tracking", signal = "{signal}" }}\n' + SCENARIO
        )
    result = boatsim("run", "drift.toml", "turn.toml", "--side-by-side")
    assert result.exit_code == 0, result.output
    rows = [
        [c.strip() for c in line.strip("│").split("│")]
        for line in result.stdout.splitlines()
        if "│" in line
    ]
    cells = {name: values for name, _, *values in rows}
    drift, turn = (
        f"{norms(Path('out') / name)['norms']['rms']['value']:.4g}" for name in ("drift", "turn")
    )
    assert cells["rms [m/s]"] == [drift, ""] and cells["rms [deg/s]"] == ["", turn]
    assert all(cells["sway_error_rms [m/s]"])


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_no_boat_is_lost_from_the_log_where_names_differ_by_a_mark_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    own = ("a-b.toml", "a_b.toml", "a b.toml")
    for name in own:
        Path(name).write_text(SCENARIO)
    result = boatsim("run", *own, "--side-by-side")
    assert result.exit_code == 0, result.output
    logged = {
        chunk.entity_path for chunk in RrdReader(Path("out") / "compare.rrd").stream().to_chunks()
    }
    assert {n for n in logged if n.endswith("/v_mps")} == {
        f"/signals/{n}/v_mps" for n in ("a_b", "a_b_2", "a_b_3")
    }
