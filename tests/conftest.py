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

# Beginnings of the names of the longest tests, of 7 to 60 s of CPU time. They start first: one that
# started last would keep a single processor busy while the others have no tests left.
LONGEST = (
    "test_the_examples_of_all_effects_print_what_their_pages_show",
    "test_a_tutorial_prints_what_it_shows_in_an_empty_home",
    "test_with_the_wind_known_nothing_is_missing",
    "test_a_mirrored_log_is_the_first_thing_that_a_diagnosis_says",
    "test_a_notebook_runs_from_its_first_to_its_last_cell",
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the longest tests first, the others in the order of their files."""
    items.sort(key=lambda item: not item.name.startswith(LONGEST))


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
