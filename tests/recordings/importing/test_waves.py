"""The wave at the hull from probes elsewhere: dispersion and separation of known waves."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.debugging import interpreted
from boatsim.physics.waves.dispersion import wave_number
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.several_logs import open_logs
from boatsim.recordings.importing.waves import WaveProbes, wave_at

T = np.arange(0.0, 80.0, 0.02)
PLACES = {"a": 4.95, "b": 5.2, "c": 5.5}
GRAVITY = 9.81  # [m/s^2]


VESSEL = """
about = "a box in a measured wave"
source = "none"
freedoms = ["sway", "roll"]
length = 0.6
beam = 0.4
draught = 0.2
body = { mass = 48.0, roll_inertia = 1.0, yaw_inertia = 1.4 }

[measured]
wave_in_m = { about = "wave at the hull" }
"""
HULL = """<mujoco model="box"><worldbody><body name="hull">
<geom type="box" size="0.3 0.2 0.13"/></body></worldbody></mujoco>"""


def group(x: float, travels: int, depth: float = 1.0, begin: float = 20.0) -> Array:
    """A group of waves of 0.6 to 1.2 Hz at a place, which passes x = 0 about `begin` + 10 s."""
    found = np.zeros_like(T)
    for f in np.arange(0.6, 1.2, 0.01):
        w = 2.0 * np.pi * f
        k = float(interpreted(wave_number)(w, depth))
        envelope = np.exp(-(((f - 0.9) / 0.15) ** 2))
        found += 5e-4 * envelope * np.cos(w * (T - begin - 10.0) - travels * k * x)
    return found


def test_one_probe_upstream_gives_the_wave_at_the_hull() -> None:
    given = WaveProbes(probes={"a": -2.0}, place=0.0, depth=1.0)
    found = wave_at(0.02, [group(-2.0, 1)], given)
    assert found == pytest.approx(group(0.0, 1), abs=2e-4)


def test_three_probes_separate_the_waves_of_both_directions() -> None:
    elevations = []
    for place in PLACES.values():
        elevations.append(group(place - 7.0, 1) + 0.5 * group(place - 7.0, -1, begin=24.0))
    size = np.std(group(0.0, 1))
    for travels, expected in ((1, group(0.0, 1)), (-1, 0.5 * group(0.0, -1, begin=24.0))):
        given = WaveProbes(probes=PLACES, place=7.0, depth=1.0, travels=travels, low=0.4, high=2.0)
        found = wave_at(0.02, elevations, given)
        assert np.std(found - expected) < 0.06 * size


def log_of_probes(folder: Path, times: Array) -> Log:
    """A log of a roll angle and three probes."""
    rows = ["t_s,roll,a,b,c"]
    columns = [0.1 * np.sin(times)]
    columns += [np.interp(times, T, group(place - 7.0, 1)) for place in PLACES.values()]
    for i, t in enumerate(times):
        rows.append(",".join(f"{x:.9g}" for x in (t, *(column[i] for column in columns))))
    file = folder / "flume.csv"
    file.write_text("\n".join(rows) + "\n")
    return open_logs([file])


MAP = {
    "columns": {"phi_rad": "roll"},
    "waves": {"wave_m": {"probes": PLACES, "place": 7.0, "depth": 1.0, "low": 0.4, "high": 2.0}},
}


def test_a_map_makes_the_wave_at_the_hull(tmp_path: Path) -> None:
    log = log_of_probes(tmp_path, T)
    recording = convert_log(log, parse_map(MAP, "map.toml"), "map.toml", {"wave_m": (-9.0, 9.0)})
    expected = np.interp(recording.t, T, group(0.0, 1))
    # three probes that agree on one direction still give the regularised amplitude
    assert recording["wave_m"] == pytest.approx(expected, abs=0.06 * np.abs(expected).max())


def test_probes_at_unequal_steps_are_refused(tmp_path: Path) -> None:
    log = log_of_probes(tmp_path, np.sort(np.append(T[::10], 3.3333)))
    with pytest.raises(BadInput, match=r"waves.wave_m.probes: allowed are at least"):
        convert_log(log, parse_map(MAP, "map.toml"), "map.toml")


def test_a_column_can_not_be_made_twice() -> None:
    table = {**MAP, "columns": {"phi_rad": "roll", "wave_m": "a"}}
    with pytest.raises(BadInput, match="wave_m is what waves makes"):
        parse_map(table, "map.toml")


def test_a_proposed_map_asks_for_the_measured_wave(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    lines = ["time [s],sway [m],roll [rad]"]
    for t in np.arange(0.0, 20.0, 0.1).tolist():
        lines.append(f"{t:.1f},{0.02 * np.sin(t)},{0.1 * np.sin(2.0 * t)}")
    Path("log.csv").write_text("\n".join(lines))
    Path("hull.xml").write_text(HULL)
    Path("vessel.toml").write_text(VESSEL)
    given = ["import", "log.csv", "--vessel", str(tmp_path), "--propose", "map.toml"]
    done = CliRunner().invoke(app, given)
    assert done.exit_code == 0, done.output
    text = Path("map.toml").read_text()
    assert '# wave_in_m = "..."  # CHECK: wave at the hull' in text
    assert {"y_m", "phi_rad"} <= parse_map(tomllib.loads(text), "map.toml").columns.keys()
    Path("log.csv").write_text("\n".join(lines).replace("roll [rad]", "wave_in_m"))
    assert CliRunner().invoke(app, given).exit_code == 0
    known = parse_map(tomllib.loads(Path("map.toml").read_text()), "map.toml")
    assert known.columns["wave_in_m"] == "wave_in_m"
