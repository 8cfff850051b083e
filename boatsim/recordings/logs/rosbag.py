"""Reader of bags of ROS 1 (`.bag`) and ROS 2 (a folder, or the `.db3` in it)."""

from bz2 import BZ2Decompressor
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from boatsim.errors import BadInput
from boatsim.recordings.importing.log import (
    BAG,
    MAX_BYTES,
    Log,
    MemoryBudget,
    damaged_log_error,
    missing_library_error,
)
from boatsim.recordings.importing.ros import MAX_SIZE, Decoder, Topic, log_from_topics
from boatsim.recordings.raw_table import file_error

SUFFIXES = (".bag", ".db3", "/")
MAX_CHUNK = 256_000_000  # [bytes] of a chunk when it is unpacked
MAX_METADATA = 500_000  # [bytes]; the library needs 10 s for this size


def read(path: Path) -> Log:
    """Return all numbers of all topics: `/imu.angular_velocity.z`. Raises BadInput."""
    try:
        from rosbags.rosbag1 import Reader as Bag1
        from rosbags.rosbag2 import Reader as Bag2
    except ImportError as error:
        raise missing_library_error(path, "rosbags", "ros") from error
    topics: dict[str, Topic] = {}
    remarks: list[str] = []
    try:
        if path.suffix.lower() == ".bag":
            opened: Any = Bag1(path)
        else:
            folder = path
            if not path.is_dir():
                folder = path.parent
            _check_folder(path, folder)
            opened = Bag2(folder)
        with opened as bag:
            _limit_chunk_size(bag)
            _read_topics(path, bag, topics, remarks)
    except BadInput:
        raise
    except Exception as error:  # the library raises any exception on a damaged file
        if not any(len(topic.logged) for topic in topics.values()):
            raise damaged_log_error(path, "a bag of ROS", error) from error
        remarks.append(f"{path}: ends early or is damaged; the part before is used")
    return log_from_topics(path, topics, remarks)


def _check_folder(path: Path, folder: Path) -> None:
    """Refuse bags that the library would unpack without limit or into a file. Raises BadInput."""
    from ruamel.yaml import YAML  # a dependency of rosbags

    about = folder / BAG
    if not about.is_file():
        raise file_error(path, f"a ROS 2 bag needs its {BAG} in the same folder")
    if about.stat().st_size > MAX_METADATA:
        raise file_error(about, "is too large for the metadata of a bag")
    metadata = YAML(typ="safe").load(about.read_text(encoding="utf-8", errors="replace"))[
        "rosbag2_bagfile_information"
    ]
    if str(metadata.get("compression_mode") or "none").lower() != "none":
        raise file_error(
            path, "is compressed; unpack it first: ros2 bag convert, with compression_mode none"
        )
    if str(metadata.get("storage_identifier")) == "mcap":
        raise file_error(path, "is a folder of MCAP files; give the .mcap in it")
    if sum(file.stat().st_size for file in folder.iterdir() if file.is_file()) > MAX_BYTES:
        raise file_error(path, f"has more than {MAX_BYTES:,} bytes; cut the log")


def _limit_chunk_size(bag: Any) -> None:
    """Limit the size of unpacked chunks of a bag of ROS 1."""
    for position, chunk in getattr(bag, "chunks", {}).items():
        bag.chunks[position] = chunk._replace(decompressor=partial(_decompress, chunk.decompressor))


def _decompress(usual: "Callable[[bytes], bytes]", data: bytes) -> bytes:
    from lz4.frame import LZ4FrameDecompressor

    library = str(usual.__module__).partition(".")[0]
    if library not in ("bz2", "_bz2", "lz4"):  # not compressed at all
        return usual(data)
    machine: Any = BZ2Decompressor()
    if library == "lz4":
        machine = LZ4FrameDecompressor()
    found = bytes(machine.decompress(data, max_length=MAX_CHUNK))
    if not machine.eof:
        raise ValueError("a chunk that is cut, or too large to unpack")
    return found


def _read_topics(path: Path, bag: Any, topics: dict[str, Topic], remarks: list[str]) -> None:
    room, read = MemoryBudget(path), []
    for connection in bag.connections:
        try:
            text = connection.msgdef.data or _standard_definition(connection.msgtype)
            cdr = hasattr(connection.ext, "serialization_format")
            topics.setdefault(connection.topic, Topic(Decoder(text, connection.msgtype, cdr)))
            read.append(connection)
        except (ValueError, RecursionError) as error:
            remarks.append(f"{path}: {connection.topic} is not read ({error})")
    if not read:  # without connections the library returns the messages of all
        return
    for connection, when, data in bag.messages(connections=read):
        if len(data) <= MAX_SIZE:
            try:
                topics[connection.topic].add_message(when * 1e-9, bytes(data), room)
            except ValueError as error:
                remarks.append(
                    f"{path}: messages of {connection.topic} that cannot be read are left out "
                    f"({error})"
                )


def _standard_definition(name: str) -> str:
    """Definition of a message of ROS 2 itself, for bags without definitions. Raises ValueError."""
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    if name not in store.fielddefs:
        raise ValueError(f"the bag does not define {name}, and ROS 2 has none of this name")
    return str(store.generate_msgdef(name, ros_version=2)[0])
