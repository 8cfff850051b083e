"""A recording that several tests of a diagnosis share."""

import pytest
from pushed_boat import BOAT, FEW_ROWS, sail, weak_astern

from boatsim.diagnosis import loading
from boatsim.diagnosis.loading import LoadedRecordings, Request
from boatsim.recordings.table import write_csv


@pytest.fixture(scope="session")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> LoadedRecordings:
    """A recording of a boat that is weak astern, read from its file."""
    path = tmp_path_factory.mktemp("weak_astern") / "run.csv"
    write_csv(sail("run", 7, weak_astern)[0], path)
    return loading.load_recordings(Request([path], vessel=BOAT.name), config=FEW_ROWS)
