"""What all tests share: a property is judged by its examples, not by how long one of them took on a
busy machine."""

import os
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


@pytest.fixture(scope="session", autouse=True)
def _runs_shared_by_all_processes(tmp_path_factory: pytest.TempPathFactory) -> None:
    """What one process found of a shipped scenario, the others read."""
    root = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        root = root.parent
    folder = root / "runs"
    folder.mkdir(exist_ok=True)
    os.environ["BOATSIM_TEST_RUNS"] = str(folder)  # read by runs.py, whose imports take a second
