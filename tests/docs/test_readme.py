"""The figures of the README and of the pages in docs/ are those that their commands print today,
figure by figure.

Commands with an output below them run as they are printed; the pages that are run when the site is
built, from their first command to their last. Tables of benchmarks are compared with what the
benchmark prints; those that need recordings beside the repository are skipped without them, those
of many minutes run only with BOATSIM_README_LONG=1 in the environment.
"""

import contextlib
import importlib
import io
import os
import re
import shlex
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest
from typer.testing import CliRunner

from boatsim.cli import app
from tests.fork_server import forked_commands
from tests.pages import (
    MARK,
    ROOT,
    blocks,
    environment_of_new_user,
    failures,
    figures,
    figures_agree,
    first_difference,
)
from validation import trials
from validation.practice import __main__ as practice
from validation.real import common

pytestmark = pytest.mark.slow

LONG = os.environ.get("BOATSIM_README_LONG") == "1"
RESULTS = (ROOT / "docs" / "results.md").read_text(encoding="utf-8")
PAGES = {
    file.name: file.read_text(encoding="utf-8")
    for file in (ROOT / "README.md", *(ROOT / "docs").glob("*.md"))
}
TUTORIALS = sorted(name for name, page in PAGES.items() if MARK in page)


def compare(row: str, shown: Sequence[str], printed: Sequence[str]) -> None:
    """Fails with the row and the figures in it that differ."""
    assert len(shown) == len(printed), f"{row}: the page has {shown}, printed is {printed}"
    wrong = [f"{a} is {b}" for a, b in zip(shown, printed, strict=True) if not figures_agree(a, b)]
    assert not wrong, f"{row}: {'; '.join(wrong)}"


# ---- commands with their output below them


def sessions() -> dict[str, tuple[list[list[str]], tuple[str, ...]]]:
    """Commands of the tool in a block, and the lines that the page shows below it, by page and
    line."""
    found = {}
    for name, page in PAGES.items():
        for block in blocks(page) if name not in TUTORIALS else ():
            commands = [
                c.split("boatsim ", 1)[1] for c in block.commands.split("&&") if "boatsim " in c
            ]
            if block.shown and commands and "benchmarks." not in block.commands:
                words = [[w for x in shlex.split(c) for w in braces(x)] for c in commands]
                found[f"{name}:{block.line}"] = words, block.shown
    return found


def braces(word: str) -> list[str]:
    """A word as the shell expands its first braces."""
    inner = re.search(r"\{(.*?)\}", word)
    return [word.replace(inner[0], part) for part in inner[1].split(",")] if inner else [word]


@pytest.mark.parametrize("place", sessions())
def test_a_command_prints_what_is_shown_below_it(
    place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    commands, shown = sessions()[place]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tests").symlink_to(ROOT / "tests")
    programs = tmp_path / ".venv" / "bin"  # as of a reader who has not activated the environment
    programs.parent.symlink_to(sys.prefix)
    others = [p for p in os.environ["PATH"].split(os.pathsep) if not (Path(p) / "boatsim").exists()]
    monkeypatch.setenv("PATH", os.pathsep.join(others))
    monkeypatch.setattr(sys, "executable", str(programs / Path(sys.executable).name))
    printed: list[str] = []
    for words in commands:
        done = CliRunner().invoke(app, words)
        assert done.exit_code in (0, 1), done.output  # 1: a bar is missed
        printed += done.output.splitlines()
    assert not first_difference(shown, printed)


def test_the_commands_of_the_front_page_are_looked_at() -> None:
    front = [
        [words[0] for words in commands]
        for place, (commands, _) in sessions().items()
        if "README" in place
    ]
    assert front == [["demo"]]


@pytest.mark.parametrize("name", TUTORIALS)
def test_a_tutorial_prints_what_it_shows_in_an_empty_home(name: str, tmp_path: Path) -> None:
    with forked_commands(environment_of_new_user(tmp_path)) as programs:
        assert not list(failures(PAGES[name], tmp_path, programs))


def test_tutorials_go_from_a_log_to_a_diagnosis() -> None:
    assert set(TUTORIALS) >= {"first_steps.md", "your_boat.md"}
    commands = " ".join(block.commands for block in blocks(PAGES["your_boat.md"]))
    for verb in ("import day_1.BIN", "import day_2.csv", "check", "--from-log", "diagnose"):
        assert verb in commands


# ---- tables of benchmarks


@dataclass(frozen=True)
class Row:
    """Where a benchmark prints a row of the page: the table's title, its row, and the columns of
    the figures."""

    benchmark: str
    judged_on: str  # as the page's second column begins
    title: str
    label: str
    columns: tuple[int, ...]  # among the row's figures: recalibrated, patched, ratio
    long: bool = False
    recordings: tuple[
        str, ...
    ] = ()  # folders beside the repository that it reads, where they are called otherwise


ROLL, HSVA, MARIN, LAKE, THESIS, SILVERBOX = (
    "kvlcc2_roll_decay",
    "kvlcc2_hsva_zigzag",
    "kvlcc2_marin_free",
    "blueboat_lake",
    "thesis_tables",
    "silverbox",
)
POND, MMG, TANKS = "esso_osaka_pond", "kvlcc2_mmg", (HSVA, MARIN)
REAL = (
    Row(ROLL, "every second 20 s window", "split", "windows", (1, 2, 3)),
    Row(ROLL, "middle third", "split", "middle third", (1, 2, 3)),
    Row(
        HSVA,
        "held-out 15/5 and 20/5",
        "fitted on eight runs",
        "heading [deg]",
        (1, 2, 3),
        long=True,
    ),
    Row(HSVA, "position", "fitted on eight runs", "position [m]", (1, 2, 3), long=True),
    Row(MARIN, "35 deg turning circle", "fitted on", "yaw rate [deg/s]", (1, 2, 3), long=True),
    Row(MARIN, "speed", "fitted on", "speed [m/s]", (1, 2, 3), long=True),
    Row(LAKE, "each of 12 runs", "each run held out", "all", (0, 1, 2), long=True),
    Row(LAKE, "dead reckoning", "each run held out", "all", (3, 4, 5), long=True),
    Row(
        POND,
        "turns and berthing",
        "fitted on random",
        "all, position [m]",
        (2, 3, 6),
        True,
        ("esso_osaka",),
    ),
    Row(
        POND,
        "the same by its captive",
        "fitted on random",
        "all, position [m]",
        (1, 3, 4),
        True,
        ("esso_osaka",),
    ),
    Row(
        MMG,
        "the standard MMG model",
        "fitted on eight runs",
        "heading [deg]",
        (1, 2, 3),
        True,
        TANKS,
    ),
    Row(MMG, "position", "fitted on eight runs", "position [m]", (1, 2, 3), True, TANKS),
    Row(
        MMG,
        "on MARIN's turning circle",
        "fitted on zz_10",
        "yaw rate [deg/s]",
        (1, 2, 3),
        True,
        TANKS,
    ),
    Row(MMG, "speed", "fitted on zz_10", "speed [m/s]", (1, 2, 3), True, TANKS),
    Row(SILVERBOX, "one free run over", "Rms error [mV], one free run", "arrow", (1, 2, 3)),
    Row(THESIS, "published norms", "J, the rms", "all", (2, 3, 4), long=True),
)


def table_below(heading: str) -> Iterator[list[str]]:
    """Cells of the rows of the first table below a heading of the results."""
    lines = RESULTS.split(heading, 1)[1].splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith("| --- |"))
    for line in lines[begin + 1 :]:
        if not line.startswith("|"):
            return
        yield [cell.strip() for cell in line.strip("|").split(" | ")]


@cache
def printed_by(benchmark: str) -> list[str]:
    """Lines that a benchmark's command prints."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        importlib.import_module(f"validation.real.{benchmark}").main()
    return said.getvalue().splitlines()


def in_table(lines: Sequence[str], title: str, label: str) -> list[str]:
    """Figures of a printed table's row."""
    begin = next(i for i, line in enumerate(lines) if line.startswith(title))
    row = next(line for line in lines[begin:] if line.strip().startswith(label + "  "))
    return figures(row.replace(label, "", 1))


@pytest.mark.parametrize("row", REAL, ids=lambda row: f"{row.benchmark}-{row.judged_on}")
def test_a_row_about_real_recordings_is_what_its_benchmark_prints(
    row: Row, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if row.long and not LONG:
        pytest.skip("takes many minutes; BOATSIM_README_LONG=1 asks for it")
    folders = [common.RECORDINGS / name for name in row.recordings or (row.benchmark,)]
    if row.benchmark not in (ROLL, THESIS) and not all(f.is_dir() for f in folders):
        pytest.skip("needs recordings beside the repository")
    (cells,) = (
        c
        for c in with_names("## Real recordings")
        if c[0] == row.benchmark and row.judged_on in c[1]
    )
    monkeypatch.chdir(tmp_path)
    found = in_table(printed_by(row.benchmark), row.title, row.label)
    shown = [figures(cell)[0] for cell in cells[2:5]]
    compare(f"{row.benchmark}, {cells[1]}", shown, [found[i] for i in row.columns])


def with_names(heading: str) -> Iterator[list[str]]:
    """Rows of a table in which an empty first cell means the one above."""
    name = ""
    for cells in table_below(heading):
        if found := re.search(r"`(\w+)`", cells[0]):
            name = found[1]
        yield [name, *cells[1:]]


def test_every_row_about_real_recordings_is_compared() -> None:
    rows = list(with_names("## Real recordings"))
    assert len(rows) == len(REAL)
    for cells in rows:
        assert any(
            cells[0] == row.benchmark and cells[1].startswith(row.judged_on) for row in REAL
        ), cells


TRIALS = {  # as a row of the page begins -> rows of the benchmark that give its figures
    "false alarms": ["false alarms"],
    "visible single effects": ["visible single effects"],
    "of these concealed": ["of these concealed"],
    "exactly named": ["exactly named"],
    "visible pairs": ["visible pairs"],
    "wrong names": ["wrong names"],
    "visible unknown causes flagged": ["visible unknown cause flagged, pilot"],
    "visible unknown causes described": [
        "visible unknown cause described",
        "with a term of its kind",
    ],
    "their error on held-out": ["described: error ratio"],
    "skill with these": ["skill, truth removed", "of these by a description"],
    "unknown causes flagged": [
        "visible unknown cause flagged, pilot",
        "visible unknown cause flagged, concealed",
    ],
    "known cause": ["known cause"],
    "skill on held-out runs": ["held-out skill"],
    "true parameters": ["true parameters", "median error"],
    "unknowns made": ["flagged, pilot", "flagged, concealed"],
}


@pytest.mark.skipif(
    not LONG or not trials.SHARED.is_dir(),
    reason="many minutes; needs trials beside the repository",
)
def test_the_table_of_the_trials_is_what_the_benchmark_prints(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        sys, "argv", ["trials", "--unknowns", "--jobs", "1", "--out", str(tmp_path)]
    )
    compare_trials("## Trial boat with concealed effects")


@pytest.mark.skipif(not LONG, reason="many minutes")
def test_the_table_of_five_other_vessels_is_what_the_benchmarks_print(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = str(tmp_path / "made")
    monkeypatch.setattr(sys, "argv", ["practice", "--out", made])
    practice.main()
    monkeypatch.setattr(
        sys, "argv", ["trials", made, "--jobs", "1", "--out", str(tmp_path / "out")]
    )
    compare_trials("## Five other vessels")


def compare_trials(heading: str) -> None:
    """A table of trials with what the benchmark prints for them all, which is before what it prints
    by vessel."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        trials.main()
    lines = [line.strip() for line in said.getvalue().splitlines()]
    for cells in table_below(heading):
        (labels,) = (found for begin, found in TRIALS.items() if cells[0].startswith(begin))
        printed = []
        for label in labels:
            line = next(line for line in lines if line.startswith(label))
            printed += figures(re.sub(r"\(.*?\)| of \d+|2 sd|^.*?  +", "", line).replace("/", " "))
        compare(cells[0], figures(cells[1]), printed)
