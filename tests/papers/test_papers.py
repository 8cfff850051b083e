"""The table of published figures: up to date, honest about what is not reproduced, and clear about
mistakes."""

from math import inf
from pathlib import Path

import pytest

from benchmarks import papers
from boatsim.errors import BadInput

FILES = sorted((papers.HOME / "docs" / "papers").glob("*.toml"))


def written(folder: Path, text: str) -> Path:
    file = folder / "paper.toml"
    file.write_text(f'title = "t"\nsource = "s"\n{text}')
    return file


def test_the_document_is_what_the_command_makes() -> None:
    assert papers.OUT.read_text(encoding="utf-8") == papers.page_text()


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.stem)
def test_a_verdict_follows_from_the_figures_their_signs_and_the_tolerance(file: Path) -> None:
    for row in papers.read_figures(file):
        if row.verdict == "for comparison":
            continue
        low, high = row.span or (-inf, inf)
        if row.span is None:
            if isinstance(row.published, str) or isinstance(row.ours, str):
                assert row.verdict == "in words", row.what
                continue
            if row.tolerance is None:
                assert row.verdict == "no tolerance stated", row.what
                continue
            slack = row.tolerance * (1.0 + 1e-9)
            low, high = row.published - slack, row.published + slack
        met = not isinstance(row.ours, str | None) and low <= row.ours <= high
        assert row.verdict == ("reproduced" if met else "not reproduced"), row.what


def test_every_published_number_that_we_try_to_reproduce_is_judged() -> None:
    for file in FILES:
        for row in papers.read_figures(file):
            assert row.verdict != "no tolerance stated", row.what


def test_results_of_another_law_are_for_comparison_only() -> None:
    (file,) = (f for f in FILES if f.stem == "bayless")
    for row in papers.read_figures(file):
        assert (row.verdict == "for comparison") == ("corrected controller" in row.what), row.what


@pytest.mark.parametrize(
    ("published", "ours", "text"),
    [
        ("2.0", "2.1", "+5.0 %"),
        ("-2.0", "-2.1", "-5.0 %"),
        ("0.0", "0.1", "-"),
        ('"w"', "0.1", "-"),
    ],
)
def test_deviation_is_in_per_cent_of_the_published_number(
    tmp_path: Path, published: str, ours: str, text: str
) -> None:
    row = f'[[row]]\nwhat = "w"\nours = {ours}\ncommand = "c"\npublished = {published}\n'
    (figure,) = papers.read_figures(written(tmp_path, row))
    assert figure.deviation_text() == text
    assert f"| {text} | {figure.verdict} |" in figure.line()


def test_page_counts_the_verdicts_of_each_paper() -> None:
    page = papers.page_text()
    for file in FILES:
        found = list(papers.read_figures(file))
        title = papers.read_toml(file)["title"]
        (line,) = (text for text in page.splitlines() if text.startswith(f"| {title} |"))
        counts = [int(cell) for cell in line.split("|")[2:-1]]
        assert sum(counts) == len(found)
        assert counts[0] == sum(row.verdict == "reproduced" for row in found)


def test_a_hundred_figures_and_more_are_judged() -> None:
    verdicts = [row.verdict for file in FILES for row in papers.read_figures(file)]
    assert sum(verdict in ("reproduced", "not reproduced") for verdict in verdicts) >= 100


@pytest.mark.parametrize(
    ("ours", "more", "verdict"),
    [
        ("1.05", "within = 0.1", "reproduced"),
        ("1.05", "tolerance = 0.04", "not reproduced"),
        ("-1.0", "within = 0.1", "not reproduced"),
        ("2.0", "within = 0.1", "not reproduced"),
        ("1.0", "", "no tolerance stated"),
        ("1.0", 'because = "corrected"', "no tolerance stated"),
        ("2.0", 'within = 0.1\nbecause = "diagnosed"', "not reproduced"),
        ("1.0", "comparison = true", "for comparison"),
    ],
)
def test_words_explain_a_verdict_and_do_not_make_it(
    tmp_path: Path, ours: str, more: str, verdict: str
) -> None:
    text = f'[[row]]\nwhat = "w"\nours = {ours}\ncommand = "c"\npublished = 1.0\nreason = "it is reproduced"\n{more}\n'
    assert [r.verdict for r in papers.read_figures(written(tmp_path, text))] == [verdict]


@pytest.mark.parametrize(
    ("published", "span", "verdict"),
    [
        ('"arrives"', "span = [0.0, 200.0]", "reproduced"),
        ('"arrives"', "span = [0.0, 0.5]", "not reproduced"),
        ('"well"', "", "in words"),
        ('"1.0"', "", "in words"),
    ],
)
def test_published_words_are_judged_by_what_they_stand_for(
    tmp_path: Path, published: str, span: str, verdict: str
) -> None:
    text = f'[[row]]\nwhat = "w"\nours = 1.0\ncommand = "c"\npublished = {published}\nreason = "r"\n{span}\n'
    assert [r.verdict for r in papers.read_figures(written(tmp_path, text))] == [verdict]


@pytest.mark.parametrize(
    ("row", "line"),
    [
        ('ours = 1.0\ncommand = "c"\npublished = 2.0\nwithin = 0.1', "needs a reason"),
        ('norm = "speed"\npublished = 2.0', r"has \['norm'\]; allowed are"),
        ('scenario = "joystick_boat/sway_1"\nnorm = "speed"', "has no metric speed"),
        ('scenario = "joystick_boat/nowhere"\nnorm = "speed"', "no stored metrics"),
        (
            'ours = 1.0\ncommand = "c"\npublished = 1.0\nverdict = "reproduced"',
            "'verdict'.*; allowed are",
        ),
        (
            'ours = 1.0\ncommand = "c"\npublished = 1.0\nbecause = "fine"',
            "allowed are corrected, can't be, diagnosed",
        ),
    ],
)
def test_a_mistake_gets_one_line(tmp_path: Path, row: str, line: str) -> None:
    with pytest.raises(BadInput, match=line) as caught:
        list(papers.read_figures(written(tmp_path, f'[[row]]\nwhat = "w"\n{row}\n')))
    assert "\n" not in str(caught.value)
