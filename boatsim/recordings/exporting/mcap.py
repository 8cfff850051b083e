"""Writer of MCAP files with standard messages of ROS 2, which Foxglove and PlotJuggler open.

Messages are in CDR with their definitions in the file (profile ros2, schema encoding ros2msg), so
that a reader needs nothing else.
"""

from pathlib import Path
from typing import Any

import numpy as np

from boatsim.errors import BadInput
from boatsim.files import replace_file
from boatsim.recordings.exporting.ros_topics import topics_of
from boatsim.recordings.table import Recording
from boatsim.version import version

SUFFIX = ".mcap"
NEEDED = "writing .mcap needs mcap and rosbags: pip install 'boatsim[ros]'"
AXES = (
    "/pose, /camera/pose, /twist and /tf: REP 103 (x east, y north, z up; hull x forward, y port). "
    "/commands and /signals: as in the recording, SI and radians, SNAME (x north, y east, z down)."
)


def write_mcap(recording: Recording, path: Path) -> int:
    """Write a recording to an MCAP file.

    The time stamps are `t_s`; those of a recording that begins before 0 begin at 0.

    Args:
        recording: The recording.
        path: The file; its folder is created if needed.

    Returns:
        Number of messages.

    Raises:
        BadInput: If the name does not end in .mcap, or a library is not installed.
        OSError: If the file cannot be written; then no part of it is left.
    """
    if path.suffix.lower() != SUFFIX:
        raise BadInput(
            f"{path}: recordings are exported as {SUFFIX}; use a name ending in {SUFFIX}"
        )
    try:
        from mcap.writer import Writer
        from rosbags.typesys import Stores, get_typestore
    except ImportError as error:
        raise BadInput(f"{path}: {NEEDED}") from error
    store = get_typestore(Stores.ROS2_HUMBLE)
    topics = topics_of(recording, store.types)
    t = recording.t - min(float(recording.t[0]), 0.0)
    stamps = np.round(t * 1e9).astype(np.int64).tolist()
    count = 0
    with replace_file(path) as temporary, temporary.open("wb") as file:
        writer: Any = Writer(file)
        writer.start(profile="ros2", library=f"boatsim {version()}")
        schemas: dict[str, int] = {}
        channels = []
        for topic in topics:
            if topic.kind not in schemas:
                text, _ = store.generate_msgdef(topic.kind, ros_version=2)
                schemas[topic.kind] = writer.register_schema(topic.kind, "ros2msg", text.encode())
            channels.append(writer.register_channel(topic.name, "cdr", schemas[topic.kind]))
        for row, stamp in enumerate(stamps):
            for topic, channel in zip(topics, channels, strict=True):
                if topic.rows[row]:
                    message = store.serialize_cdr(topic.make(row, stamp), topic.kind)
                    writer.add_message(channel, stamp, bytes(message), stamp)
                    count += 1
        writer.add_metadata("boatsim", _about(recording))
        writer.finish()
    return count


def _about(recording: Recording) -> dict[str, str]:
    """Metadata of the file: recording, vessel and axes."""
    notes = recording.notes
    return {
        "recording": recording.name,
        "vessel": notes.vessel or "",
        "load": ", ".join(notes.load),
        "axes": AXES,
    }
