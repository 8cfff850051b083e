"""Winds of NMEA 0183: the reference of MWV tells apparent from true, and its unit letter the unit."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.log import open_log

pytest.importorskip("pynmea2")


def logged(folder: Path, *sentences: str) -> Path:
    """A log that repeats sentences once a second after the time of a fix."""
    lines = []
    for second in range(30):
        lines.append(f"$GPRMC,1200{second:02d}.00,A,5954.0,N,01042.0,E,3.0,90.0,010625,,,A")
        lines += sentences
    file = folder / "run.nmea"
    file.write_text("\n".join(lines))
    return file


@pytest.mark.parametrize(
    ("letter", "factor"), [("N", 1852.0 / 3600.0), ("K", 1.0 / 3.6), ("M", 1.0)]
)
def test_the_unit_and_the_reference_of_a_wind_are_read(
    tmp_path: Path, letter: str, factor: float
) -> None:
    log = open_log(
        logged(tmp_path, f"$WIMWV,214.8,R,10.0,{letter},A", f"$WIMWV,190.0,T,12.0,{letter},A")
    )
    read = {}
    for name, signal in log.signals.items():
        read[name] = signal.values[np.isfinite(signal.values)]
    assert log.signals["MWV.apparent_wind_speed"].unit == "m/s"
    assert read["MWV.apparent_wind_speed"] == pytest.approx(10.0 * factor)
    assert read["MWV.apparent_wind_angle"] == pytest.approx(214.8)
    assert read["MWV.true_wind_speed"] == pytest.approx(12.0 * factor)


def test_an_invalid_wind_is_left_out(tmp_path: Path) -> None:
    log = open_log(logged(tmp_path, "$WIMWV,214.8,R,10.0,N,V"))
    assert not any(name.startswith("MWV") for name in log.signals)


def test_a_true_wind_that_is_stated_in_knots_only_is_read(tmp_path: Path) -> None:
    log = open_log(logged(tmp_path, "$WIMWD,120.0,T,118.0,M,10.0,N,,"))
    speed = log.signals["MWD.true_wind_speed"].values
    assert speed[np.isfinite(speed)] == pytest.approx(10.0 * 1852.0 / 3600.0)
