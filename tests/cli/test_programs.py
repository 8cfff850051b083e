"""A printed command can be typed as it is, whether or not its program is on PATH."""

import sys
from pathlib import Path

import pytest

from boatsim.cli.programs import typed_program


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An environment in the current folder, with a program that is not on PATH."""
    folder = tmp_path / "my env" / "bin"
    folder.mkdir(parents=True)
    program = folder / "boatsim"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(folder / "python"))
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.chdir(tmp_path)
    return folder


@pytest.mark.usefixtures("installed")
def test_a_program_outside_of_path_has_its_quoted_path_from_the_current_folder() -> None:
    assert typed_program("boatsim") == "'my env/bin/boatsim'"


def test_outside_of_the_folder_the_path_is_absolute(
    installed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    outside = installed / "elsewhere"
    outside.mkdir()
    monkeypatch.chdir(outside)
    assert typed_program("boatsim") == f"'{installed}/boatsim'"


def test_a_program_on_path_has_its_name_alone(
    installed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(installed))
    assert typed_program("boatsim") == "boatsim"


@pytest.mark.usefixtures("installed")
def test_a_program_that_is_not_installed_keeps_its_name() -> None:
    assert typed_program("rerun") == "rerun"
