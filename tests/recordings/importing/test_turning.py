"""Turning rates from headings whose times nearly repeat."""

import warnings
from pathlib import Path

from boatsim.recordings.importing.log import open_log
from boatsim.recordings.importing.mapping_proposal import propose_map


def test_a_time_that_nearly_repeats_another_causes_no_infinite_turning_rate(tmp_path: Path) -> None:
    rows = [f"{0.1 * i},{i % 5},{i % 7},{3 * i % 360}" for i in range(60)]
    rows[1] = "1e-308,1,1,3"
    (tmp_path / "log.csv").write_text("Time [s],x [m],y [m],Heading [deg]\n" + "\n".join(rows))
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        assert "psi_rad" in propose_map(open_log(tmp_path / "log.csv"))
