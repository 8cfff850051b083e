"""The readers, each with whole files to begin from, and how a mutated file is read."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pyarrow as pa
import rerun as rr
from pyarrow import parquet

from boatsim.diagnose.analysis import vessel_for
from boatsim.errors import BoatsimError
from boatsim.physics import vessel
from boatsim.physics.content import root
from boatsim.recordings import table
from boatsim.simulate import scenario

DATA = Path(__file__).parents[1] / "data"
ROWS = 30
SCENARIOS = ("martin_tank_model/release.toml", "mariner/turning_circle_35.toml", "mariner/pull_out_20.toml")
SCENARIO = """
vessel = "joystick_boat"
load = ["heavy", "wide"]
duration = 30.0
measure = { use = "crossing", signal = "psi_rad", level = 1.0, since = 15.0 }
tank = { length = 4.0, width = 3.0 }
camera = { rate = 30.0 }
sensor = [{ use = "inclinometer" }]
[controller]
use = "l1_joystick"
[sensors]
speed_sd = 0.01
[[goal]]
sway_mps = 0.07
[[goal]]
from = 15.0
yaw_radps = { mean = 0.1, slope = 0.01 }
[[effect]]
use = "fan_wind"
speed = 0.5
[norms.time]
published = 10.0
tolerance = 0.5
guard = [9.0, 12.0]
[[check]]
signal = "v_mps"
norm = "inf"
below = 1.0
"""
NOTES = """
vessel = "trial_boat"
scale = 1.0
use = [0.0, 100.0]
columns = { psi_rad = "-psi_rad" }
noise = { position_sd_m = 0.01, heading_sd_rad = 0.002 }
ambient = { axes = ["surge", "sway"], force_rms = [0.1, 0.1], time_constant_s = 1.0 }
coefficient_uncertainty = { damping = 0.3 }
facts = { walls_m = [-4.0, 4.0, -3.0, 3.0], indoors = true, position_fix = "camera" }
[runs.run]
forward_speed_mps = 1.0
"""


@dataclass(frozen=True)
class Reader:
    """Files that it reads whole, the name that a mutated one has, and what reads it."""

    file: str
    seeds: Callable[[], list[bytes]]
    read: Callable[[Path], object]
    text: bool = True  # tokens of the format are put in too, not bytes alone
    share: float = 1.0  # of the files that others get: one that starts a process for each is slow

    def outcome(self, content: bytes) -> bool:
        """Whether a file can be used; False where one clear line says why not. Raises whatever else comes."""
        path = _folder() / self.file
        path.write_bytes(content)
        try:
            self.read(path)
        except BoatsimError as error:
            assert str(error).strip()
            return False
        return True


@cache
def _folder() -> Path:
    """Where mutated files lie; what stands beside them is whole."""
    folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
    (folder / "noted").mkdir()
    (folder / "noted" / "run.csv").write_bytes(_csv())
    (folder / "boat").mkdir()
    (folder / "boat" / "hull.xml").write_bytes((root() / "models" / "trial_boat" / "hull.xml").read_bytes())
    return folder


def _csv() -> bytes:
    lines = (DATA / "trials" / "T002" / "run_1.csv").read_bytes().splitlines(keepends=True)
    return b"".join(lines[: ROWS + 1])


def _parquet() -> bytes:
    path, t = _folder() / "seed.parquet", np.arange(float(ROWS))
    columns = {"t_s": t, "x_m": t, "psi_rad": 0.01 * t, "n": np.arange(ROWS), "note": ["a", "b"] * (ROWS // 2)}
    parquet.write_table(pa.table(columns), path)
    return path.read_bytes()


def _rrd() -> bytes:
    path, t = _folder() / "seed.rrd", np.arange(float(ROWS))
    with rr.RecordingStream("boatsim", send_properties=False) as stream:
        stream.save(path)
        for name in ("x_m", "psi_rad"):
            columns = rr.Scalars.columns(scalars=0.01 * t)
            stream.send_columns(f"signals/{name}", [rr.TimeColumn("sim_time", duration=t)], columns)
        stream.flush()
        stream.disconnect()
    return path.read_bytes()


def _notes(path: Path) -> object:
    run = path.parent / "run.csv"
    return vessel_for(run, None, []), table.read(run)


def _files(*paths: str) -> Callable[[], list[bytes]]:
    return lambda: [(root() / path).read_bytes() for path in paths]


READERS = {
    "csv": Reader("run.csv", lambda: [_csv()], table.read),
    "parquet": Reader("run.parquet", lambda: [_parquet()], table.read, text=False),
    "rrd": Reader("run.rrd", lambda: [_rrd()], table.read, text=False, share=0.1),
    "recording.toml": Reader(
        "noted/recording.toml",
        lambda: [
            NOTES.encode(),
            (DATA / "trials" / "recording.toml").read_bytes(),
            (DATA / "kvlcc2_roll_decay" / "recording.toml").read_bytes(),
        ],
        _notes,
    ),
    "vessel.toml": Reader(
        "boat/vessel.toml",
        _files("models/trial_boat/vessel.toml", "models/joystick_boat/vessel.toml", "models/kvlcc2_mmg/vessel.toml"),
        lambda path: vessel.load(str(path)),
    ),
    "scenario.toml": Reader(
        "scenario.toml",
        lambda: [(root() / "scenarios" / p).read_bytes() for p in SCENARIOS] + [SCENARIO.encode()],
        lambda path: scenario.load(str(path)),
    ),
}
