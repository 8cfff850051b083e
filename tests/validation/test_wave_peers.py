"""The comparison of wave loads with other programs: reading of their tables, and what is compared."""

import json
from pathlib import Path

import numpy as np
import pytest

from boatsim.physics.coefficients.table import WaveLoads
from validation.waves.peers import mcsimpython, mss
from validation.waves.peers.comparison import (
    loads_at,
    relative_difference,
    sea_of_table,
    times_of_period,
    waves_of,
)

FREQUENCY = np.array([0.8, 1.0, 1.3, 1.7, 2.2, 2.8])  # [rad/s]
HEADING = np.radians(np.arange(0.0, 360.0, 10.0))


def write_drillship(path: Path) -> Path:
    """Vessel file with loads of a small body in phases that lead, with whole turns added."""
    along, across = np.cos(HEADING), np.sin(HEADING)
    k = (FREQUENCY**2 / 9.81)[:, None]
    loads = np.stack(
        [
            1j * k * along,
            1j * k * across,
            -1.0 + 0.0 * k * along,
            1j * k * across,
            -1j * k * along,
            0.1j * k * np.sin(2.0 * HEADING),
        ]
    )
    turns = 2.0 * np.pi * (np.arange(len(HEADING)) % 3)
    drift = np.zeros((6, len(FREQUENCY), len(HEADING)))
    drift[0], drift[1] = k * along, k * across
    drift[2] = 0.1 * k * np.sin(2.0 * HEADING)
    content = {
        "freqs": FREQUENCY.tolist(),
        "headings": HEADING.tolist(),
        "forceRAO": {
            "amp": np.abs(loads)[..., None].tolist(),
            "phase": (np.angle(loads) + turns)[..., None].tolist(),
        },
        "driftfrc": {"amp": drift[..., None].tolist()},
    }
    path.write_text(json.dumps(content))
    return path


def test_loads_of_a_vessel_file_lead_the_crest(tmp_path: Path) -> None:
    found = mcsimpython.read_vessel(write_drillship(tmp_path / "vessel.json"))
    assert found.frequency == pytest.approx(FREQUENCY)
    assert np.degrees(found.heading) == pytest.approx(np.arange(0.0, 181.0, 10.0))
    k = 1.3**2 / 9.81
    # waves from abeam: the force in sway precedes the crest, that in heave is up below it
    assert found.excitation[2, 9, 1] == pytest.approx(1j * k)
    assert found.excitation[2, 9, 2] == pytest.approx(-1.0)
    assert found.drift is not None
    assert found.drift[2, 9] == pytest.approx([0.0, k, 0.0], abs=1e-12)


@pytest.mark.parametrize("finer", [1, 4])
def test_consistent_file_lags_and_has_no_turns(tmp_path: Path, finer: int) -> None:
    path = write_drillship(tmp_path / "vessel.json")
    written = json.loads(
        mcsimpython.consistent_file(path, tmp_path / "copy.json", finer).read_text()
    )
    assert written["freqs"][::finer] == pytest.approx(FREQUENCY)
    phase = np.array(written["forceRAO"]["phase"])[..., 0]
    assert np.abs(np.diff(phase[2], axis=1)).max() < 1e-6
    own = mcsimpython.read_vessel(path)
    copied = mcsimpython.read_vessel(tmp_path / "copy.json")
    assert np.conj(copied.excitation[::finer]) == pytest.approx(own.excitation)


def test_loads_agree_with_mcsimpython_at_points_of_the_table(tmp_path: Path) -> None:
    pytest.importorskip("MCSimPython")
    path = write_drillship(tmp_path / "vessel.json")
    copy = mcsimpython.consistent_file(path, tmp_path / "copy.json")
    loads, place, psi = mcsimpython.read_vessel(path), (1.3, -0.7), np.radians(-40.0)
    own = sea_of_table(
        tmp_path / "loads",
        loads,
        spectrum="regular",
        significant_height=2.0,
        modal_period=2.0 * np.pi / 1.7,
    )
    t = times_of_period(1.7)
    peer = mcsimpython.wave_load(copy, waves_of(own))
    ours = loads_at(own, t, psi, place)[None]
    theirs = mcsimpython.first_order(peer, t, psi, place)[None]
    assert relative_difference(ours, theirs).max() < 0.01
    # with the phases as published the forces along the waves have the opposite sign
    peer = mcsimpython.wave_load(path, waves_of(own))
    theirs = mcsimpython.first_order(peer, t, psi, place)[None]
    assert relative_difference(ours, theirs)[0] == pytest.approx(2.0, rel=0.02)


def test_relative_difference_is_that_of_the_worst_heading() -> None:
    t = np.arange(64) / 64.0
    wave = np.stack([np.cos(2.0 * np.pi * t), np.zeros(64)], axis=1)
    own = np.stack([wave, 0.5 * wave])
    theirs = np.stack([wave, 0.7 * wave])
    assert relative_difference(own, theirs) == pytest.approx([0.2, 0.0])


def test_held_hull_has_the_loads_of_the_wave_at_its_place(tmp_path: Path) -> None:
    frequency, heading = np.array([0.5, 1.0, 2.0]), np.linspace(0.0, np.pi, 7)
    excitation = np.zeros((3, 7, 6), dtype=complex)
    excitation[..., 2] = -2.0
    sea = sea_of_table(
        tmp_path,
        WaveLoads("heave alone", 0.0, frequency, heading, excitation),
        significant_height=1.0,
        modal_period=8.0,
        toward=0.6,
    )
    t = np.linspace(0.0, 50.0, 26)
    found = loads_at(sea, t, 0.3, (3.0, -2.0))
    inside = waves_of(sea).frequency < 2.0
    field = waves_of(sea)
    x = field.frequency * t[:, None] + field.phase
    x -= field.wave_number * (3.0 * np.cos(0.6) - 2.0 * np.sin(0.6))
    expected = -2.0 * (field.amplitude * inside * np.cos(x)).sum(axis=1)
    assert found[:, 2] == pytest.approx(expected, abs=1e-6)


def test_missing_mss_is_named(tmp_path: Path) -> None:
    with pytest.raises(ImportError, match="--mss FOLDER"):
        mss.check_installed(None)
    with pytest.raises(ImportError, match="has no LIBRARY/environment/waveForceRAO.m"):
        mss.check_installed(tmp_path)
