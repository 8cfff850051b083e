"""The first command: it finds the fault that its scenarios hide, says so in few lines, and the
picture of the README shows what it found."""

import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.diagnosis.model_names import MODELS
from boatsim.simulate import scenario as scenarios
from boatsim.view.formatting import format_in_one_unit
from tests.pages import ROOT, figures, figures_agree
from tools.animate_diagnosis import animated_picture

SVG = "{http://www.w3.org/2000/svg}"
PICTURE = ROOT / "docs" / "diagnosis.svg"
MOST_LINES = 15  # of the result
MOST_BYTES = 300_000  # of a picture in a README


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Output folder of the demonstration, and what it printed."""
    out = tmp_path_factory.mktemp("demo") / "new" / "demo"
    done = CliRunner().invoke(app, ["demo", "--out", str(out)], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return out, done.stdout


@pytest.fixture(scope="module")
def picture(demo: tuple[Path, str]) -> str:
    return animated_picture(demo[0])


@pytest.mark.slow
def test_the_hidden_fault_is_found_within_two_standard_deviations(demo: tuple[Path, str]) -> None:
    answer = json.loads((demo[0] / "diagnosis.json").read_text())
    effect = scenarios.load("joystick_boat/sway_1_as_published").vessel.effect("weak_reverse")
    [found] = answer["effects"]
    value = found["parameters"]["astern_factor"]
    assert found["name"] == "weak_reverse"
    assert abs(value["value"] - effect.astern_factor) < 2.0 * value["sd"] < 0.1
    assert (
        answer["fit"]["position_rms_m"]["patched"] * 10
        < (answer["fit"]["position_rms_m"]["recalibrated"])
    )


def test_the_result_is_a_few_lines_with_the_truth_and_the_errors(demo: tuple[Path, str]) -> None:
    out, printed = demo
    stages, _, result = printed.partition("\n\n")
    assert len(result.splitlines()) <= MOST_LINES
    assert [line[:2] for line in stages.splitlines() if line[:1].isdigit()] == ["1.", "2.", "3."]
    assert "The truth, hidden in the scenarios: astern thrust is 69.4 % of" in result
    rms = json.loads((out / "diagnosis.json").read_text())["fit"]["position_rms_m"]
    before, retuned, corrected = format_in_one_unit([rms[m] for m in MODELS], "m")
    assert f"position: {before} before, {retuned} retuned, {corrected} corrected" in result


def test_the_result_names_the_report_and_the_next_command(demo: tuple[Path, str]) -> None:
    out, printed = demo
    assert f"Report: {out / 'report.html'}" in printed
    assert f"rerun {out / 'diagnosis.rrd'}" in printed
    assert (out / "report.html").is_file() and (out / "diagnosis.rrd").is_file()
    assert "boatsim import LOG" in printed


def test_the_picture_is_valid_and_has_three_paths_and_boats(picture: str) -> None:
    root = ElementTree.fromstring(picture)
    paths = [p for p in root.iter(f"{SVG}path") if "mask" in p.attrib]
    looks = [p.attrib["class"] for p in paths]
    assert looks == ["path recorded", "path recalibrated", "path patched"]
    assert len(list(root.iter(f"{SVG}g"))) == 3
    assert len(picture.encode()) < MOST_BYTES
    assert not re.search(r"<script|https?://(?!www\.w3\.org/2000/svg)", picture)


def test_the_picture_states_the_errors_and_the_sentence_of_the_answer(
    demo: tuple[Path, str], picture: str
) -> None:
    answer = json.loads((demo[0] / "diagnosis.json").read_text())
    words = [text.text or "" for text in ElementTree.fromstring(picture).iter(f"{SVG}text")]
    rms = answer["fit"]["position_rms_m"]
    _, retuned, corrected = format_in_one_unit([rms[m] for m in MODELS], "m")
    assert f"retuned: {retuned} position error" in words
    assert f"corrected: {corrected} position error" in words
    assert answer["sentence"] in " ".join(words)


def test_every_part_of_the_picture_moves_in_one_loop_and_ends_where_it_is_drawn(
    picture: str,
) -> None:
    assert re.findall(r"animation: \S+ (\S+) linear infinite", picture) == ["6s"] * 6
    for boat in ("recorded", "recalibrated", "patched"):
        [frames] = re.findall(rf"@keyframes {boat}-boat {{(.*?)}} }}", picture)
        _, _, last = frames.rpartition("{")
        [drawn] = re.findall(rf'id="{boat}-boat" transform="([^"]*)"', picture)
        assert figures(last.replace("px", "").replace("deg", "")) == figures(drawn)


def test_the_picture_of_the_readme_is_that_of_the_demonstration(picture: str) -> None:
    """The words are equal, and the figures agree to one unit of the last digit."""
    for shown, drawn in zip(
        ElementTree.fromstring(PICTURE.read_text("utf-8")).iter(f"{SVG}text"),
        ElementTree.fromstring(picture).iter(f"{SVG}text"),
        strict=True,
    ):
        pairs = zip(figures(shown.text or ""), figures(drawn.text or ""), strict=True)
        assert all(figures_agree(*pair) for pair in pairs), (shown.text, drawn.text)
