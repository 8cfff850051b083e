"""Turning by headings whose times nearly repeat, that were interpolated or that arrived late."""

import re
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log, Signal, open_log
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.table import read, write_csv
from tests.recordings.importing.test_proposal_by_motion import DOF, DRIVES, RPM, log_of, simulated

RUN = simulated()
DIRECTION = np.degrees(RUN["psi"] - RUN["psi"].mean())  # [deg] to both sides of north
HEADING = DIRECTION % 360.0


def test_a_time_that_nearly_repeats_another_causes_no_infinite_turning_rate(tmp_path: Path) -> None:
    rows = [f"{0.1 * i},{i % 5},{i % 7},{3 * i % 360}" for i in range(60)]
    rows[1] = "1e-308,1,1,3"
    (tmp_path / "log.csv").write_text("Time [s],x [m],y [m],Heading [deg]\n" + "\n".join(rows))
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        assert "psi_rad" in propose_map(open_log(tmp_path / "log.csv"))


def written(psi: np.ndarray, t: np.ndarray) -> Log:
    """A log of a boat whose heading [deg] was written so, at these times."""
    columns = log_of(RUN, n1=RUN["port"] / RPM, n2=RUN["starboard"] / RPM).signals
    used = {name: columns[name].values for name in ("lat", "lon", "n1", "n2")} | {"yaw": psi}
    return Log(Path("log.csv"), {name: Signal(t, values) for name, values in used.items()})


def correlation(log: Log) -> float:
    """The correlation of the drives with the turning, by which their sides are proposed."""
    text = propose_map(log, None, DRIVES, DOF)
    assert tomllib.loads(text)["columns"]["n_port_radps"].startswith("n1")
    found = re.findall(r"side by the turning of the boat \(correlation ([\d.]+)\)", text)
    assert len(found) == 2
    return float(found[0])


def test_headings_interpolated_across_a_full_turn_do_not_hide_the_sides() -> None:
    rows = np.arange(0, len(RUN["t"]), 5)
    psi = np.interp(RUN["t"], RUN["t"][rows], HEADING[rows])  # 2 Hz, in rows of 10 Hz
    assert np.any((psi > 60.0) & (psi < 300.0) & (np.abs(DIRECTION) < 30.0))
    expected = correlation(written(HEADING, RUN["t"]))
    assert correlation(written(psi, RUN["t"])) == pytest.approx(expected, abs=0.05)


def test_messages_that_arrive_at_once_do_not_hide_the_sides() -> None:
    t = RUN["t"] - RUN["t"][0]
    late = (t > 20.0) & (t < 28.0)
    arrived = np.where(late, 28.0 + 0.001 * np.cumsum(late) - 0.0005, t)
    expected = correlation(written(HEADING, RUN["t"]))
    assert correlation(written(HEADING, RUN["t"][0] + arrived)) == pytest.approx(expected, abs=0.05)


def test_an_import_empties_headings_interpolated_across_a_turn(tmp_path: Path) -> None:
    rows = np.arange(0, len(RUN["t"]), 5)
    psi = np.interp(RUN["t"], RUN["t"][rows], HEADING[rows])
    log = written(psi, RUN["t"])
    found = convert_log(log, parse_map(tomllib.loads(propose_map(log)), "m.toml"), "m.toml")
    assert len(found.t) == len(psi) and np.isfinite(found["x_m"]).all()
    true = RUN["psi"] - RUN["psi"].mean()
    assert np.nanmax(np.abs(np.angle(np.exp(1j * (found["psi_rad"] - true))))) < 0.2
    write_csv(found, tmp_path / "run.csv")
    again = read(tmp_path / "run.csv")
    assert np.array_equal(np.isnan(again["psi_rad"]), np.isnan(found["psi_rad"]))
    wrong = np.abs(np.angle(np.exp(1j * (np.radians(psi) - RUN["psi"] + RUN["psi"].mean())))) > 0.2
    (remark,) = [text for text in found.remarks if "interpolated across a full turn" in text]
    assert np.isnan(found["psi_rad"][wrong]).all()
    assert int(re.findall(r"(\d+) of", remark)[0]) >= wrong.sum() > 0
    first = float(re.findall(r"([\d.]+) s after the beginning", remark)[0])
    assert first == pytest.approx(0.1 * np.flatnonzero(wrong)[0], abs=0.5)
