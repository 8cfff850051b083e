"""What all tests share: a property is judged by its examples, not by how long one of them took on a
busy machine."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from boatsim.physics.trust import trust_folders

settings.register_profile("boatsim", deadline=None, print_blob=True)
settings.load_profile("boatsim")


@pytest.fixture
def trusted(tmp_path: Path) -> Iterator[None]:
    """The Python files of the test's own folder may run, as with --trust."""
    with trust_folders(allowed=[tmp_path]):
        yield
