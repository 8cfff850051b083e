"""`boatsim open`: the page of one result, or an index of many that strange files do not stop."""

import json
import os
import re
from html import unescape
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest
from typer.testing import CliRunner

from boatsim.cli import app

METRIC = {
    "value": 1.0,
    "unit": "m",
    "published": None,
    "tolerance": None,
    "guard": [0.0, 2.0],
    "ok": True,
    "at_reported": None,
    "noise_floor": None,
    "verdict": None,
    "lacking": None,
    "kind": "",
}


def boatsim(*arguments: object) -> Any:
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def run_of(folder: Path, scenario: str = "boat/case", **changes: Any) -> Path:
    """A folder of a run."""
    folder.mkdir(parents=True)
    content = {
        "scenario": scenario,
        "controller": "a",
        "seed": 0,
        "complete": True,
        "steps": 9,
        "saturated_steps": {},
        "norms": {"off": METRIC},
        **changes,
    }
    (folder / "norms.json").write_text(json.dumps(content))
    (folder / "report.html").write_text("the page")
    return folder


def diagnosis_of(folder: Path, *names: str, sentence: str = "Nothing is missing.") -> Path:
    folder.mkdir(parents=True)
    effects = [{"name": name, "kind": "physics"} for name in names]
    answer = {"verdict": "named", "sentence": sentence, "effects": effects}
    (folder / "diagnosis.json").write_text(json.dumps(answer))
    (folder / "report.html").write_text("the page")
    return folder


def sweep_of(folder: Path) -> Path:
    folder.mkdir(parents=True)
    about = {"scenarios": ["boat/case"], "vary": {"fan_wind.speed": [0, 1]}, "draw": {}}
    lines = [about, {"run": 0, "failure": None}, {"run": 1, "failure": "capsized"}]
    text = "\n".join(map(json.dumps, lines))
    (folder / "journal.jsonl").write_text(text + '\n{"run": 2, "fai')
    return folder


def written_at(folder: Path, seconds: float) -> None:
    for file in folder.iterdir():
        os.utime(file, (seconds, seconds))


def results_of(page: Path) -> list[tuple[str, str, str]]:
    """Link, name and result of each entry of an index page."""
    text = page.read_text("utf-8")
    found = re.findall(r'<a href="(.*?)">(.*?)</a>.*?<p>(.*?)</p>', text, re.DOTALL)
    return [(unescape(link), unescape(name), unescape(result)) for link, name, result in found]


def test_the_page_of_one_result_is_opened_itself(tmp_path: Path) -> None:
    folder = run_of(tmp_path / "run")
    done = boatsim("open", folder, "--no-open")
    assert done.exit_code == 0 and done.stdout.split() == [str(folder / "report.html")]
    assert not (folder / "index.html").exists()


def test_a_browser_opens_the_page_on_request(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    folder = run_of(tmp_path / "run")
    boatsim("open", folder, "--open")
    assert opened == [(folder / "report.html").resolve().as_uri()]


def test_runs_diagnoses_and_sweeps_are_listed_with_their_results_the_newest_first(
    tmp_path: Path,
) -> None:
    written_at(run_of(tmp_path / "a"), 1000.0)
    written_at(diagnosis_of(tmp_path / "b" / "c", "weak_reverse", "prop_walk"), 3000.0)
    written_at(sweep_of(tmp_path / "s"), 2000.0)
    written_at(run_of(tmp_path / "z", "boat/stopped", complete=False), 4000.0)
    done = boatsim("open", tmp_path, "--no-open")
    assert done.exit_code == 0 and done.stdout.splitlines()[-1] == str(tmp_path / "index.html")
    assert results_of(tmp_path / "index.html") == [
        (
            "z/report.html",
            "boat/stopped",
            "Interrupted before its end; the only metric with a regression band lies within it.",
        ),
        ("b/c/report.html", "c", "2 effects missing: weak reverse and prop walk."),
        ("s/", "boat/case", "2 runs, 1 failed; varied: fan wind speed."),
        ("a/report.html", "boat/case", "The only metric with a regression band lies within it."),
    ]


def test_a_diagnosis_without_effects_is_listed_with_its_sentence(tmp_path: Path) -> None:
    diagnosis_of(tmp_path / "d", sentence="Nothing is missing. More words follow.")
    boatsim("open", tmp_path, "--no-open")
    assert results_of(tmp_path / "index.html") == [("d/report.html", "d", "Nothing is missing.")]


def test_the_same_index_again_replaces_the_former_one_and_another_page_is_kept(
    tmp_path: Path,
) -> None:
    run_of(tmp_path / "a")
    boatsim("open", tmp_path, "--no-open")
    run_of(tmp_path / "b")
    boatsim("open", tmp_path, "--no-open")
    assert len(results_of(tmp_path / "index.html")) == 2
    (tmp_path / "index.html").write_text("a page of mine")
    done = boatsim("open", tmp_path, "--no-open")
    assert done.exit_code == 2 and done.stderr.count("\n") == 1 and "--out" in done.stderr
    assert (tmp_path / "index.html").read_text() == "a page of mine"
    other = tmp_path / "x" / "list.html"
    other.parent.mkdir()
    assert boatsim("open", tmp_path, "--no-open", "--out", other).exit_code == 0
    for link, _, _ in results_of(other):
        assert (other.parent / link).is_file()


def test_several_folders_have_one_index_in_the_folder_that_holds_them(tmp_path: Path) -> None:
    for name in ("a", "b", "c"):
        run_of(tmp_path / name / "run", f"boat/{name}")
    boatsim("open", tmp_path / "a", tmp_path / "c", "--no-open")
    found = results_of(tmp_path / "index.html")
    assert {link for link, _, _ in found} == {"a/run/report.html", "c/run/report.html"}


def test_text_and_names_of_files_are_escaped_and_links_still_lead_there(tmp_path: Path) -> None:
    strange = 'a "<b>&?#%'
    run_of(tmp_path / strange, "<script>alert(1)</script>")
    boatsim("open", tmp_path, "--no-open")
    text = (tmp_path / "index.html").read_text("utf-8")
    assert "<script>alert" not in text and "<b>" not in text
    [(link, name, _)] = results_of(tmp_path / "index.html")
    assert name == "<script>alert(1)</script>"
    assert (tmp_path / unquote(link)).is_file()


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("norms.json", "[1, 2"),
        ("norms.json", "[]"),
        ("norms.json", '{"norms": {"a": 3}, "complete": true}'),
        ("diagnosis.json", '{"effects": 1}'),
        ("journal.jsonl", ""),
        ("journal.jsonl", '{"scenarios": []}'),
        ("norms.json", "[" * 100_000),
        ("norms.json", "\udcff"),
    ],
)
def test_a_strange_file_is_an_entry_and_does_not_hide_the_others(
    tmp_path: Path, file: str, text: str
) -> None:
    run_of(tmp_path / "good")
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / file).write_bytes(text.encode("utf-8", "surrogateescape"))
    assert boatsim("open", tmp_path, "--no-open").exit_code == 0
    found = {name: result for _, name, result in results_of(tmp_path / "index.html")}
    assert found["bad"] == f"{file} cannot be read" and "boat/case" in found


def test_links_out_of_the_folder_are_not_followed(tmp_path: Path) -> None:
    run_of(tmp_path / "elsewhere" / "run", "boat/elsewhere")
    inside = tmp_path / "inside"
    run_of(inside / "run", "boat/inside")
    (inside / "link").symlink_to(tmp_path / "elsewhere")
    (inside / "round").symlink_to(inside)
    (inside / "file").mkdir()
    (inside / "file" / "norms.json").symlink_to(tmp_path / "elsewhere" / "run" / "norms.json")
    (inside / ".hidden").mkdir()
    run_of(inside / ".hidden" / "run", "boat/hidden")
    boatsim("open", inside, "--no-open")
    assert [name for _, name, _ in results_of(inside / "index.html")] == ["boat/inside"]


def test_a_run_that_was_killed_is_listed_as_such(tmp_path: Path) -> None:
    part = tmp_path / "sway.part-x1"
    part.mkdir()
    (part / "recording.csv").write_text("t_s\n")
    boatsim("open", tmp_path, "--no-open")
    [(_, _, result)] = results_of(tmp_path / "index.html")
    assert result.startswith("Killed while it ran")


@pytest.mark.parametrize("kind", ["missing", "file"])
def test_what_is_no_folder_is_refused_in_one_line(tmp_path: Path, kind: str) -> None:
    place = tmp_path / "place"
    if kind == "file":
        place.write_text("x")
    done = boatsim("open", place, "--no-open")
    assert done.exit_code == 2 and done.stderr.count("\n") == 1 and str(place) in done.stderr


def test_an_empty_folder_has_an_index_that_says_so(tmp_path: Path) -> None:
    assert boatsim("open", tmp_path, "--no-open").exit_code == 0
    assert "There are no runs" in (tmp_path / "index.html").read_text("utf-8")
