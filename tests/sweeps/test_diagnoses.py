"""Many recordings, each diagnose_all by itself: none costs another, and what is done is not done
again."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from pyarrow import parquet

import boatsim
from boatsim.cli.sweeping import diagnose_each
from boatsim.errors import BadInput
from boatsim.sweeps.diagnoses import DiagnosisOptions, diagnose_all, find_recordings, output_folders
from boatsim.sweeps.workers.in_process import run_in_this_process
from boatsim.sweeps.workers.processes import Processes

WRONG = "t_s,x_m\n0,0\n1,nonsense\n"


def table(folder: Path) -> dict[str, list[Any]]:
    return parquet.read_table(folder / "diagnoses.parquet").to_pydict()


def test_a_folder_stands_for_the_recordings_in_it_and_runs_for_what_the_camera_saw(
    tmp_path: Path,
) -> None:
    for name in (
        "logs/b.csv",
        "logs/a.parquet",
        "logs/notes.txt",
        "runs/one/camera.csv",
        "runs/one/recording.csv",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    found = find_recordings([tmp_path / "logs", tmp_path / "runs"])
    assert [str(p.relative_to(tmp_path)) for p in found] == [
        "logs/a.parquet",
        "logs/b.csv",
        "runs/one/camera.csv",
    ]
    assert output_folders(found) == ["logs/a", "logs/b", "runs/one"]
    assert output_folders([tmp_path / "x.csv", tmp_path / "x.parquet"]) == ["x.csv", "x.parquet"]


@pytest.mark.parametrize("given", ["empty", "nowhere.csv"])
def test_what_holds_no_recording_is_one_line(tmp_path: Path, given: str) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(BadInput, match=given):
        find_recordings([tmp_path / given])


def test_recordings_that_can_not_be_read_are_told_and_end_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.csv").write_text(WRONG)
    out = tmp_path / "out"
    assert diagnose_each([tmp_path], DiagnosisOptions(vessel="joystick_boat"), out, 1, None) == 0
    found = table(out)
    assert found["recording"] == [str(tmp_path / "a.csv"), str(tmp_path / "b.csv")]
    assert all("a.csv" in why or "b.csv" in why for why in found["failure"])
    assert "failed 2" in capsys.readouterr().out


def test_what_is_done_is_not_done_again(tmp_path: Path) -> None:
    log, out = tmp_path / "a.csv", tmp_path / "out"
    log.write_text(WRONG)
    diagnose_all([log], DiagnosisOptions(vessel="joystick_boat"), out, run_in_this_process)
    before = (out / "diagnoses.parquet").read_bytes(), (out / "journal.jsonl").read_bytes()

    def nobody(*_: object) -> Any:
        raise AssertionError

    diagnose_all([log], DiagnosisOptions(vessel="joystick_boat"), out, nobody)
    assert (
        (out / "diagnoses.parquet").read_bytes(),
        (out / "journal.jsonl").read_bytes(),
    ) == before
    with pytest.raises(BadInput, match='asked vessel is "joystick_boat", not "otter"'):
        diagnose_all([log], DiagnosisOptions(vessel="otter"), out, nobody)


@pytest.mark.slow
def test_each_is_diagnosed_as_it_would_be_alone_and_cut_off_ends_with_the_same_bytes(
    tmp_path: Path,
) -> None:
    for name in ("sway_1", "sway_2"):
        boatsim.run(f"joystick_boat/{name}_as_published", out=tmp_path / "runs" / name)
    paths, out = find_recordings([tmp_path / "runs"]), tmp_path / "out"
    diagnose_all(paths, DiagnosisOptions(), out, Processes(2))
    found = table(out)
    assert found["verdict"] == ["named", "named"] and found["causes"] == ["weak_reverse"] * 2
    for value, sd in zip(
        found["weak_reverse.astern_factor"], found["weak_reverse.astern_factor sd"], strict=True
    ):
        assert abs(value - 0.694) < 3 * sd
    alone = boatsim.diagnose(paths[0])
    assert (
        alone.parameters["weak_reverse"]["astern_factor"].value
        == found["weak_reverse.astern_factor"][0]
    )
    told = json.loads((out / "sway_1" / "diagnosis.json").read_text())
    assert told["verdict"] == "named" and (out / "sway_2" / "report.html").is_file()
    cut = tmp_path / "cut"
    shutil.copytree(out, cut)
    lines = (out / "journal.jsonl").read_bytes().splitlines(keepends=True)
    (cut / "journal.jsonl").write_bytes(b"".join(lines[:2]))
    (cut / "diagnoses.parquet").unlink()
    diagnose_all(paths, DiagnosisOptions(), cut, run_in_this_process)
    assert (cut / "diagnoses.parquet").read_bytes() == (out / "diagnoses.parquet").read_bytes()
