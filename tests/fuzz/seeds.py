"""Whole files that mutations begin from, and what stands whole beside a mutated one."""

import json
import os
import re
import shutil
import struct
import tempfile
import zlib
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pyarrow as pa
import rerun as rr
from pyarrow import parquet

from boatsim.physics.content import content_root
from boatsim.sweeps.axes import make_axis
from boatsim.sweeps.plan import Plan, make_plan
from boatsim.sweeps.sampled_keys import make_sampled_key

DATA = Path(__file__).parents[1] / "data"
LOGS = DATA / "logs"
ROWS = 30
SCENARIOS = (
    "martin_tank_model/release.toml",
    "mariner/turning_circle_35.toml",
    "mariner/pull_out_20.toml",
)
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
MAP = """
about = "Both drives and the fix of a table."
vessel = "otter"
rate = 10.0
use = [0.0, 60.0]
time = "Time [s]"
position = { latitude = "Latitude * deg", longitude = "Longitude * deg", origin = [58.0, 11.0] }
[columns]
psi_rad = "Heading * deg"
r_radps = "-Rate [deg/s] * deg + 0.01"
n_port_radps = "Port * 1.04"
n_starboard_radps = { signal = "Starboard", low = -100.0, neutral = 0.0, high = 100.0, least = -104.0, most = 104.0 }
"""
TABLE = "Time [s];Latitude;Longitude;Heading;Rate [deg/s];Port;Starboard\n"


@cache
def folder() -> Path:
    """Where mutated files lie, gone with the process; what stands beside them is whole."""
    place = Path(_kept().name)
    for name in ("noted", "boat", "hull", "map", "bag", "bag_about", "sweep", "drawn"):
        (place / name).mkdir()
    (place / "noted" / "run.csv").write_bytes(csv_file())
    (place / "drawn" / "hull.xml").write_text(DRAWN)
    (place / "drawn" / "mesh.obj").write_bytes(files("models/joystick_boat/fittings.obj")()[0])
    (place / "drawn" / "mesh.stl").write_bytes(stl_file())
    (place / "drawn" / "texture.png").write_bytes(png_file())
    os.mkfifo(place / "hull" / "pipe.stl")
    shutil.copy(content_root() / "models" / "trial_boat" / "vessel.toml", place / "drawn")
    boat = content_root() / "models" / "trial_boat"
    (place / "boat" / "hull.xml").write_bytes((boat / "hull.xml").read_bytes())
    shutil.copy(boat / "vessel.toml", place / "hull")
    (place / "map" / "log.csv").write_text(table())
    shutil.copy(LOGS / "ros2_bag" / "metadata.yaml", place / "bag")
    shutil.copy(LOGS / "ros2_bag" / "ros2_bag.db3", place / "bag_about")
    return place


@cache
def _kept() -> "tempfile.TemporaryDirectory[str]":
    return tempfile.TemporaryDirectory(prefix="fuzz-")


def files(*paths: str | Path) -> Callable[[], list[bytes]]:
    """Seeds that are files, those of the library by their path in it."""
    return lambda: [(content_root() / path).read_bytes() for path in paths]


def csv_file() -> bytes:
    """The begin of a real recording."""
    lines = (DATA / "trials" / "T002" / "run_1.csv").read_bytes().splitlines(keepends=True)
    return b"".join(lines[: ROWS + 1])


def parquet_file() -> bytes:
    """A recording with integers and a text."""
    path, t = folder() / "seed.parquet", np.arange(float(ROWS))
    columns = {
        "t_s": t,
        "x_m": t,
        "psi_rad": 0.01 * t,
        "n": np.arange(ROWS),
        "note": ["a", "b"] * (ROWS // 2),
    }
    parquet.write_table(pa.table(columns), path)
    return path.read_bytes()


def rrd_file() -> bytes:
    """The signals of a run."""
    path, t = folder() / "seed.rrd", np.arange(float(ROWS))
    with rr.RecordingStream("boatsim", send_properties=False) as stream:
        stream.save(path)
        for name in ("x_m", "psi_rad"):
            columns = rr.Scalars.columns(scalars=0.01 * t)
            stream.send_columns(f"signals/{name}", [rr.TimeColumn("sim_time", duration=t)], columns)
        stream.flush()
        stream.disconnect()
    return path.read_bytes()


DRAWN = """<mujoco><asset>
<mesh name="m" file="mesh.obj"/><mesh name="s" file="mesh.stl"/>
<texture name="t" type="2d" file="texture.png"/><material name="t" texture="t"/>
</asset><worldbody><body name="hull">
<geom type="mesh" mesh="m" material="t"/><geom type="mesh" mesh="s"/>
</body></worldbody></mujoco>"""


def stl_file() -> bytes:
    """A tetrahedron."""
    corners = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
    triangles = b""
    for left_out in range(4):
        chosen = [corner for i, corner in enumerate(corners) if i != left_out]
        numbers = [0.0, 0.0, 0.0]
        for corner in chosen:
            numbers += corner
        triangles += struct.pack("<12fH", *numbers, 0)
    return bytes(80) + struct.pack("<I", 4) + triangles


def png_file() -> bytes:
    """An image of 4 by 4 pixels."""
    rows = zlib.compress((b"\0" + 12 * b"\x7f") * 4)
    file = b"\x89PNG\r\n\x1a\n"
    for kind, data in (
        (b"IHDR", struct.pack(">IIBBBBB", 4, 4, 8, 2, 0, 0, 0)),
        (b"IDAT", rows),
        (b"IEND", b""),
    ):
        file += struct.pack(">I", len(data)) + kind + data
        file += struct.pack(">I", zlib.crc32(kind + data))
    return file


def notes() -> list[bytes]:
    """recording.toml of our own and of data."""
    return [
        NOTES.encode(),
        *files(DATA / "trials" / "recording.toml", DATA / "kvlcc2_roll_decay" / "recording.toml")(),
    ]


def scenarios() -> list[bytes]:
    """Scenarios, one with all that one may have."""
    return [SCENARIO.encode(), *files(*(f"scenarios/{path}" for path in SCENARIOS))()]


DESCRIBED = """
[[effect]]
use = "described_force"
name = "swirl"
axis = "yaw"
of = ["surge_speed", "abs_yaw_rate"]
acts = "within"
coefficient = 0.3
begin = 1.0
end = 9.0
[[effect]]
use = "servo"
name = "slow"
on = ["steer_port_rad"]
[[effect]]
use = "command_delay"
on = ["thrust_port_N", "thrust_starboard_N"]
delay = 0.1
"""


def vessels() -> list[bytes]:
    """Vessels, with effects of many kinds."""
    names = ("trial_boat", "joystick_boat", "kvlcc2_mmg", "mariner", "otter")
    whole = files(*(f"models/{name}/vessel.toml" for name in names))()
    return [*whole, whole[0] + DESCRIBED.encode()]


OF_EXPRESSIONS = "joystick_boat/berth"
EXPRESSIONS = (
    "vary fan_wind.speed=0:0.5:3",
    "vary controller.use=l1_joystick,pid_autopilot",
    "vary body.mass*=0.9:1.1:5:log",
    "vary goal.1.sway_mps+=0.01,0.02",
    "vary load=heavy,light",
    "vary start.x,start.y=0.1,-0.1",
    "draw linear_damping.surge*=normal(1.0, 0.1)",
    "draw seed=choice(1, 2, 3)",
    "draw body.mass=truncated(5, 1, 4, 6)",
    "draw current.north=lognormal(0.1, 0.3)",
    "draw sensors.speed_sd=loguniform(0.001, 0.1)",
    "draw start.psi=triangular(-1, 0, 1)",
    "column -Heading * deg + 90 * deg",
    "column Port / 60 * rpm - 0.5",
)


def expressions() -> list[bytes]:
    """Texts of a command line."""
    return [text.encode() for text in EXPRESSIONS]


ABOUT = {"boatsim": "1", "scenarios": ["a"], "vary": {"body.mass": [5.0, 6.0]}, "seed": 0}
NORMS = {"yaw_rate_rms": [0.2, "deg/s"], "heading_at_end": [None, "deg"]}


@cache
def plan() -> Plan:
    """The sweep of the journals."""
    sampled = make_sampled_key("start.psi", "normal(0, 0.1)")
    return make_plan([OF_EXPRESSIONS], [make_axis("body.mass", [5.0, 6.0])], [sampled], 4, 0)


def journals() -> list[bytes]:
    """A sweep that has begun, with and without a failure."""
    lines: list[object] = [ABOUT]
    for run in range(4):
        lines.append({"run": run, "failure": None, "met": True, "norms": NORMS})
    failed = [*lines, {"run": 5, "failure": "diverged"}]
    return ["".join(f"{json.dumps(one)}\n" for one in some).encode() for some in (lines, failed)]


def messages() -> list[bytes]:
    """What a page sends."""
    return [
        b'{"sticks": [0, 0, 0], "moved": 1.7e9}\n{"sticks": [0.5, -1, 1], "moved": 1732000000.123}',
        b'{"hidden": true}',
        b'{"end": true}',
    ]


def table() -> str:
    """The table of MAP."""
    rows = [
        (
            0.1 * i,
            58.0 + 1e-5 * i,
            11.0 + 2e-5 * i,
            3.0 * i % 360,
            0.1 * i % 5,
            i % 90.0,
            90.0 - i % 90,
        )
        for i in range(2 * ROWS)
    ]
    return TABLE + "".join(";".join(f"{x:.7g}" for x in row) + "\n" for row in rows)


def tables() -> list[bytes]:
    """Tables of several makes."""
    begin = b"".join((LOGS / "table.csv").read_bytes().splitlines(keepends=True)[: 8 * ROWS])
    dated = "date_time,x_m,mode\n" + "".join(
        f"2024-05-01T10:00:{i:02d}Z,{i},AUTO\n" for i in range(ROWS)
    )
    return [table().encode(), begin, dated.encode(), long_table().encode()]


def long_table() -> str:
    """A table with a row for each value, of which one is an object of JSON."""
    lines = ["time,topic,value,unit"]
    for i in range(2 * ROWS):
        t = 0.1 * i
        lines.append(f"{t:.3f},lat,{58.0 + 1e-5 * i:.7f},deg")
        lines.append(f"{t + 0.002:.3f},lon,{11.0 + 2e-5 * i:.7f},deg")
        lines.append(f"{t + 0.004:.3f},Kurs,{3.0 * i % 360:.2f},°")
        lines.append(f'{t + 0.006:.3f},esc,"{{""m1"": {i % 90.0}, ""m2"": {90.0 - i % 90}}}",')
    return "\n".join(lines) + "\n"


def sentences() -> list[bytes]:
    """NMEA 0183 with and without sums: with them hardly a change gets past the first look."""
    whole = b"\n".join((LOGS / "instruments.nmea").read_bytes().splitlines()[: 4 * ROWS])
    return [whole, re.sub(rb"\*[0-9A-F]{2}", b"", whole)]
