"""Mutated files for every reader, a few of each; `python -m tests.fuzz --count N` drives more of
them."""

from pathlib import Path

import pytest

from tests.fuzz import seeds
from tests.fuzz.drive import drive
from tests.fuzz.readers import READERS

COUNT = 40
TOLERANT = ("mesh.obj", "mesh.stl")  # MuJoCo reads most numbers as a mesh


@pytest.mark.parametrize("name", READERS)
def test_a_mutated_file_ends_in_a_value_or_one_clear_line(name: str) -> None:
    count = round(COUNT * READERS[name].share)
    found = drive(READERS[name], count)
    assert not found.broken, f"{found.broken[0].content!r}: {found.broken[0].error!r}"
    assert found.refused or name in TOLERANT
    assert found.files >= count // 2  # hypothesis leaves out what it has had


@pytest.mark.parametrize("name", READERS)
def test_a_whole_file_is_read(name: str) -> None:
    place = Path(READERS[name].file).parent
    for other in READERS.values():  # a test before this one may have left mutated files beside it
        if Path(other.file).parent == place and place.name == "drawn":
            (seeds.folder() / other.file).write_bytes(other.seeds()[0])
    assert all(READERS[name].outcome(content) for content in READERS[name].seeds())
