"""The table of published figures: up to date, honest about what is not reproduced, and clear about mistakes."""

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
    assert papers.OUT.read_text(encoding="utf-8") == papers.document()


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.stem)
def test_a_figure_called_reproduced_is_close_to_the_published_one(file: Path) -> None:
    for row in papers.rows(file):
        if row.verdict == "reproduced" and isinstance(row.published, int | float):
            assert not isinstance(row.ours, int | float) or abs(abs(row.ours) - abs(row.published)) <= 0.15 * abs(
                row.published
            ), row.what


def test_a_figure_far_off_is_not_called_reproduced(tmp_path: Path) -> None:
    row = '[[row]]\nwhat = "w"\nours = 1.0\ncommand = "c"\npublished = {}\nreason = "because"\n'
    assert [r.verdict for r in papers.rows(written(tmp_path, row.format(1.05)))] == ["reproduced"]
    assert [r.verdict for r in papers.rows(written(tmp_path, row.format(2.0)))] == ["can't be"]


@pytest.mark.parametrize(
    ("row", "line"),
    [
        ('ours = 1.0\ncommand = "c"\npublished = 2.0', "needs a reason"),
        ('norm = "speed"\npublished = 2.0', r"has \['norm'\]; allowed are"),
        ('scenario = "joystick_boat/sway_1"\nnorm = "speed"', "has no norm speed"),
        ('scenario = "joystick_boat/nowhere"\nnorm = "speed"', "no norms pinned"),
        ('ours = 1.0\ncommand = "c"\npublished = 1.0\nverdict = "fine"', "allowed are reproduced, corrected, can't be"),
    ],
)
def test_a_mistake_gets_one_line(tmp_path: Path, row: str, line: str) -> None:
    with pytest.raises(BadInput, match=line) as caught:
        list(papers.rows(written(tmp_path, f'[[row]]\nwhat = "w"\n{row}\n')))
    assert "\n" not in str(caught.value)
