"""Reader of PX4's ULog: self-describing topics, times in us since the autopilot's start."""

import re
from pathlib import Path
from typing import IO, Any

import numpy as np

from boatsim.errors import BadInput
from boatsim.recordings.importing.frames import with_euler_angles
from boatsim.recordings.importing.log import (
    Log,
    MemoryBudget,
    Signal,
    damaged_log_error,
    missing_library_error,
    names_of_streams,
    stream_signals,
    suppress_output,
)

SUFFIXES = (".ulg", ".ulog")
# Fields of integers with a factor (msg/SensorGps.msg, msg/VehicleGpsPosition.msg)
SCALED = {
    ("vehicle_gps_position", "lat"): (1e-7, "deg"),
    ("vehicle_gps_position", "lon"): (1e-7, "deg"),
    ("sensor_gps", "lat"): (1e-7, "deg"),
    ("sensor_gps", "lon"): (1e-7, "deg"),
}
UNITS = {  # of PX4's messages (msg/*.msg), by topic and field
    "latitude_deg": "deg",
    "longitude_deg": "deg",
    "heading": "rad",
    "roll": "rad",
    "pitch": "rad",
    "yaw": "rad",
}
LOCAL = {"x": "m", "y": "m", "z": "m", "vx": "m/s", "vy": "m/s", "vz": "m/s"}
TOPICS = {
    "vehicle_local_position": LOCAL,
    "vehicle_visual_odometry": LOCAL,
    "vehicle_angular_velocity": {"xyz[0]": "rad/s", "xyz[1]": "rad/s", "xyz[2]": "rad/s"},
    "vehicle_global_position": {"lat": "deg", "lon": "deg"},
}
# Reads without progress; a search byte by byte needs two for each of the 2^16 bytes of a message
MAX_READS_WITHOUT_PROGRESS = 500_000
PULSES = re.compile(r"actuator_outputs|input_rc")  # topics with pulses [us]


class _ProgressingFile:
    """A file that raises EOFError without progress, for the library loops at a damaged end."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file, self._furthest, self._without_progress = file, 0, 0

    def read(self, size: int) -> bytes:
        found = self._file.read(size)
        at = self._file.tell()
        self._without_progress += 1
        if at > self._furthest:
            self._without_progress = 0
            self._furthest = at
        if self._without_progress > MAX_READS_WITHOUT_PROGRESS:
            raise EOFError("its end is damaged")
        return found

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)


def read(path: Path) -> Log:
    """Return all numbers of all topics: `vehicle_local_position.x`, `actuator_outputs.output[0]`.

    Raises BadInput.
    """
    try:
        from pyulog import ULog
    except ImportError as error:
        raise missing_library_error(path, "pyulog", "px4") from error
    try:
        with suppress_output(), path.open("rb") as file:
            found = ULog(_ProgressingFile(file))
        return _log(path, found.data_list, found.file_corruption)
    except BadInput:
        raise
    except Exception as error:  # the library raises any exception on a damaged file
        raise damaged_log_error(path, "a ULog", error) from error


def _log(path: Path, topics: list, corrupt: bool) -> Log:  # type: ignore[type-arg]
    room, signals = MemoryBudget(path), dict[str, Signal]()
    stream_names = names_of_streams([(topic.name, int(topic.multi_id)) for topic in topics])
    for topic in topics:
        t = topic.data.get("timestamp")
        if t is None or not len(t):
            continue
        fields = {}
        for name, values in topic.data.items():
            if "timestamp" not in name and "_padding" not in name:
                fields[name] = values
        room.count_values(len(t) * len(fields), len(signals) + len(fields))
        known = UNITS | TOPICS.get(topic.name, {})
        units: dict[str, str] = {}
        for name in fields:
            units[name] = known.get(name, "")
            if PULSES.match(topic.name) and "[" in name:
                units[name] = "us"
            if (topic.name, name) in SCALED:
                factor, units[name] = SCALED[topic.name, name]
                fields[name] = fields[name] * factor
        stream = stream_names[topic.name, int(topic.multi_id)]
        signals |= stream_signals(stream, np.asarray(t, dtype=float) * 1e-6, fields, units)
    remarks = []
    if corrupt:
        remarks.append(f"{path}: is damaged in places; the readable part is used")
    return Log(path, with_euler_angles(signals), "NED", tuple(remarks))
