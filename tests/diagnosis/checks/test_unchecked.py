"""A check of recordings that cannot be computed is reported as a remark, not as a good result."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pushed_boat import BOAT, sail
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.diagnosis.checks import hypothesis_test, late_sensors, per_cent_commands
from boatsim.diagnosis.checks.finding import has_result
from boatsim.diagnosis.log_check import check_files
from boatsim.physics.base import Array
from boatsim.recordings.table import write_csv


def nothing(t: float, y: Array, command: Array) -> Array:
    return np.zeros(3)


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("log") / "run.csv"
    write_csv(sail("run", 3, nothing)[0], path)
    return path


def fail(*_: object) -> None:
    raise np.linalg.LinAlgError("Singular matrix")


def remarks(path: Path) -> list[Mapping[str, Any]]:
    found, refused = check_files([path], BOAT.name)
    assert not refused
    return [entry for entry in found[path] if entry["kind"] == "unchecked"]


def test_late_sensors_that_can_not_be_compared_are_a_remark_of_the_check(
    log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not remarks(log)
    monkeypatch.setattr(late_sensors, "_likeliest_delays", fail)
    [entry] = remarks(log)
    words = "whether positions or headings are late could not be computed (Singular matrix)"
    assert entry["evidence"] == words and entry["words"] == "not checked"
    result = CliRunner().invoke(app, ["check", str(log), "--vessel", BOAT.name])
    assert result.exit_code == 0  # a remark is no fault
    assert f"  not checked: {words}: the other checks are not affected" in result.output


def test_per_cent_that_can_not_be_compared_are_a_remark_beside_that_of_later_checks(
    log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(per_cent_commands, "_look_like_per_cent", lambda *_: True)
    monkeypatch.setattr(per_cent_commands, "_has_other_scale", lambda *_: True)
    monkeypatch.setattr(per_cent_commands, "fit_without_effects", fail)
    monkeypatch.setattr(late_sensors, "_likeliest_delays", fail)
    assert [entry["evidence"].split(" could")[0] for entry in remarks(log)] == [
        "whether the thrusts are in per cent",
        "whether positions or headings are late",
    ]


def test_another_meaning_of_the_columns_that_can_not_be_fitted_is_a_remark(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recording = sail("run", 3, nothing)[0]
    reversed_heading = {**recording.signals, "psi_rad": -recording["psi_rad"]}
    path = tmp_path / "run.csv"
    write_csv(replace(recording, signals=reversed_heading), path)
    assert not remarks(path)
    monkeypatch.setattr(hypothesis_test, "fit_baseline", fail)
    evidence = [entry["evidence"] for entry in remarks(path)]
    reason = "could not be computed (Singular matrix)"
    assert f"whether the heading is counted to port {reason}" in evidence
    assert f"whether the columns have another meaning than the recorded one {reason}" in evidence


def test_a_remark_is_no_result() -> None:
    remark = late_sensors.unchecked_finding("whether it is late", FloatingPointError())
    assert "(FloatingPointError)" in remark.evidence
    assert not has_result([remark])
    assert has_result([remark, replace(remark, kind="limit")])
