"""The pages in docs/, judged without building the site: links, completeness, what can be pasted."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.physics.content import shipped_content_names
from boatsim.physics.facts import WORDS
from boatsim.physics.vessel import DiagnosisTable, ManoeuvringTable, VesselFile
from boatsim.recordings.notes import KEYS, NOISE
from boatsim.simulate.scenario import ScenarioFile
from tests.pages import ROOT, blocks, failures, first_difference, page_commands, reference

DOCS = ROOT / "docs"
REFERENCE = reference.pages()
TEXTS = {
    file: file.read_text(encoding="utf-8") for file in (ROOT / "README.md", *DOCS.glob("**/*.md"))
}
TEXTS |= {DOCS / "reference" / f"{name}.md": text for name, text in REFERENCE.items()}
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]*))?\)")
CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)


def links(text: str) -> Iterator[tuple[str, str]]:
    """Path and anchor of every link to another page, outside of code."""
    for found in LINK.finditer(CODE.sub("", text)):
        yield found[1], found[2] or ""


def anchors(text: str) -> set[str]:
    """Of the headings of a page, as GitHub and the site call them."""
    headings = re.findall(r"^#+ (.*)$", CODE.sub("", text), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", sorted(TEXTS), ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_leads_somewhere(page: Path) -> None:
    for path, anchor in links(TEXTS[page]):
        target = (page.parent / path).resolve() if path else page
        assert target in TEXTS or target.is_file(), f"{page.name} -> {path}"
        assert not anchor or anchor in anchors(TEXTS[target]), f"{page.name} -> {path}#{anchor}"


@pytest.mark.parametrize("kind", ["effect", "controller", "measure", "sensor", "vessel"])
def test_all_of_a_kind_have_a_page_with_words_and_something_to_paste(kind: str) -> None:
    for name in shipped_content_names(kind):
        page = REFERENCE[f"{kind}s/{name}"]
        assert page.startswith(f"# {name}\n\n"), name
        assert len(page.splitlines()[2]) > 10, name
        assert f"[{name}]({name}.md): " in REFERENCE[f"{kind}s/index"], name
        if kind != "vessel":
            assert tomllib.loads(page.split("```toml\n")[1].split("```")[0]), name


def test_the_page_of_an_effect_has_each_parameter_and_what_is_fitted_and_what_rules_it_out() -> (
    None
):
    page = REFERENCE["effects/tether"]
    assert "- **ruled out by**: moored = false" in page
    assert "| tension | 0 N | 0 to 1e+06 | yes | constant tension |" in page
    assert "as thrust" in REFERENCE["effects/rudder"]


def test_every_scenario_and_every_command_is_in_the_reference() -> None:
    for name in shipped_content_names("scenario"):
        assert f"`{name}`" in REFERENCE[f"scenarios/{name.partition('/')[0]}"]
    for command in (
        "run",
        "diagnose",
        "import",
        "check",
        "new",
        "show",
        "list",
        "replay",
        "manoeuvre",
    ):
        assert "--help" in REFERENCE[f"commands/{command}"]


def test_words_of_the_library_are_not_taken_for_markdown() -> None:
    for name, page in REFERENCE.items():
        rows = [line for line in page.splitlines() if line.startswith("| ")]
        assert len({len(re.findall(r"(?<!\\)\|", row)) for row in rows}) <= 1, name


def test_the_map_of_the_readme_and_that_of_the_site_lead_to_the_same_pages() -> None:
    maps = [
        {Path(path).stem for path, _ in links(TEXTS[ROOT / name])}
        for name in ("README.md", "docs/index.md")
    ]
    assert maps[0] - {"run", "CONTRIBUTING", "CITATION"} == maps[1] - {"run", "index"}
    assert {
        "first_steps",
        "your_boat",
        "logs",
        "formats",
        "diagnosis",
        "results",
        "extending",
        "papers",
    } <= maps[0]


def test_the_readme_is_one_screen_and_a_map() -> None:
    assert len(TEXTS[ROOT / "README.md"].splitlines()) <= 100


def test_every_key_of_a_file_is_on_the_page_of_formats() -> None:
    page = TEXTS[DOCS / "formats.md"]
    models = (VesselFile, DiagnosisTable, ManoeuvringTable, ScenarioFile)
    keys = (
        {key for model in models for key in model.model_fields}
        | set(KEYS)
        | set(NOISE)
        | set(WORDS)
    )
    told = set(re.findall(r"[a-zA-Z_]+", " ".join(re.findall(r"`([^`\n]*)`", page))))
    by_the_program = {"position_wander_sd_m", "position_wander_time_s", "track_m", "begin_s"}
    assert keys - told - by_the_program == set()


@pytest.mark.slow
def test_what_the_page_on_adding_shows_is_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its effect, its vessel and its scenario in files as it says, and the boat moves."""
    page = TEXTS[DOCS / "extending.md"]
    made = {
        kind: re.findall(rf"```{kind}\n(.*?)```", page, re.DOTALL) for kind in ("python", "toml")
    }
    hull = re.search(r"`(<mujoco>.*?</mujoco>)`", page, re.DOTALL)
    assert hull
    boat, [scenario] = made["toml"][0], made["toml"][1:]
    fog = '[[effect]]\nuse = "fog_drag.py"\nc = 2.0\n\n'
    folder = tmp_path / "my_boat"
    folder.mkdir()
    (folder / "fog_drag.py").write_text(made["python"][0])
    (folder / "hull.xml").write_text(hull[1])
    (folder / "vessel.toml").write_text(
        boat.replace("# All of this may", f"{fog}# All of this may")
    )
    ahead = '[controller]\nuse = "open_loop"\n[[goal]]\nport_N = 2.0\nstarboard_N = 2.0\n'
    (tmp_path / "straight.toml").write_text(f'vessel = "my_boat/"\nduration = 2.0\n{ahead}')
    (tmp_path / "turn.toml").write_text(scenario)
    monkeypatch.chdir(tmp_path)
    for words in (["run", "straight.toml", "--trust"], ["run", "turn.toml"]):
        done = CliRunner().invoke(app, words)
        assert done.exit_code in (0, 1), done.output
    assert "crossing" in scenario and "time" in done.output


def test_a_block_of_commands_is_read_with_its_exit_code_and_what_is_shown_below_it() -> None:
    page = "# P\n\n```sh\nfirst\n```\n\nwords\n\n<!-- exit 1 -->\n\n```sh\nsecond\n```\n\n```\n a 0.25 m\n```\n"
    first, second = blocks(page)
    assert (first.line, first.commands, first.code, first.shown) == (4, "first", 0, ())
    assert (second.commands, second.code, second.shown) == ("second", 1, (" a 0.25 m",))


@pytest.mark.parametrize("printed", [["a 0.27 m"], ["a 0.25 N"], ["b", "c"]])
def test_other_words_or_other_figures_are_a_difference(printed: list[str]) -> None:
    assert first_difference(["b 1", "a 0.25 m"], ["b 1", *printed])
    assert not first_difference(["a 0.25 m"], ["b 1", "  a  0.2512   m", "c"])


def test_a_slow_block_of_commands_is_a_warning_with_its_time_and_no_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(page_commands, "SLOW", 0.0)
    with pytest.warns(UserWarning, match="line 2 took 0 s, more than 0 s: echo a"):
        assert not list(failures("```sh\necho a\n```\n\n```\na\n```\n", tmp_path))


def test_every_page_is_in_one_group_of_the_side_bar() -> None:
    groups = re.findall(r":caption: (\w+)\n\n(.*?)```", TEXTS[DOCS / "index.md"], re.DOTALL)
    assert [name for name, _ in groups] == [
        "Start",
        "Guides",
        "Concepts",
        "Reference",
        "Results",
        "Contributing",
    ]
    listed = [page for _, pages in groups for page in pages.split()]
    pages = {file.stem for file in DOCS.glob("*.md")} - {"index"} | {"reference/index"}
    assert sorted(listed) == sorted(pages)
