"""The notebooks of examples/ run as they are, and are committed without their outputs."""

import ast
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "examples").glob("*.ipynb"))
REPLAYS = {  # shown by each
    "1_run_a_scenario": 1,
    "2_diagnose_a_recording": 2,
    "3_bring_your_own_log": 1,
    "4_compare_controllers": 0,
}
AS_TUTORIALS = {"1_run_a_scenario", "4_compare_controllers"}  # first_steps.md, comparing.md
MOST_SOURCE = 10_000  # bytes of a notebook without outputs
MOST_OUTPUT = 600_000  # bytes of one with its figures
LONGEST = 300  # [s] of a cell on a busy machine


def code_of(path: Path) -> list[str]:
    return [cell.source for cell in nbformat.read(path, 4).cells if cell.cell_type == "code"]


def test_these_are_the_notebooks():
    assert [path.stem for path in NOTEBOOKS] == list(REPLAYS)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_valid_and_small_because_it_has_no_outputs(path):
    book = nbformat.read(path, 4)
    nbformat.validate(book)
    for cell in book.cells:
        if cell.cell_type == "code":
            assert not cell.outputs and cell.execution_count is None
            ast.parse(cell.source)
    assert path.stat().st_size < MOST_SOURCE


def running(path: Path) -> Any:
    """A notebook, among the long tests if a tutorial of the site runs the same commands."""
    marks = [pytest.mark.long] if path.stem in AS_TUTORIALS else []
    return pytest.param(path, marks=marks, id=path.stem)


@pytest.mark.slow
@pytest.mark.parametrize("path", [running(path) for path in NOTEBOOKS])
def test_a_notebook_runs_from_its_first_to_its_last_cell(path, tmp_path):
    (tmp_path / "examples").mkdir()
    (tmp_path / "tests").symlink_to(ROOT / "tests")
    book = nbformat.read(path, 4)
    where = {"metadata": {"path": str(tmp_path / "examples")}}
    NotebookClient(book, timeout=LONGEST, resources=where).execute()  # raises if a cell fails
    shown = []
    for cell in book.cells:
        for output in cell.get("outputs", []):
            shown.append(output.get("data", {}))
    figures = sum("image/png" in data for data in shown)
    assert figures == sum(code.count("plot(") > 0 for code in code_of(path))
    replays = sum("<iframe" in data.get("text/html", "") for data in shown)
    assert replays == REPLAYS[path.stem]
    assert len(nbformat.writes(book)) < MOST_OUTPUT
