"""Reader of MCAP files of ROS 2 and Foxglove; a cut file is read up to its end."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from boatsim.errors import BadInput
from boatsim.recordings.importing.log import (
    MAX_SIGNALS,
    Log,
    MemoryBudget,
    damaged_log_error,
    missing_library_error,
)
from boatsim.recordings.importing.ros import MAX_NESTING, MAX_SIZE, Decoder, Topic, log_from_topics

SUFFIXES = (".mcap",)
MAX_CHUNK = 256_000_000  # [bytes] of a chunk when it is unpacked


def read(path: Path) -> Log:
    """Return all numbers of all topics in ROS messages or JSON: `/odom.pose.pose.position.x`.

    Raises BadInput.
    """
    try:
        import lz4.frame  # noqa: F401  # a dependency of mcap
        import mcap.stream_reader  # noqa: F401
        import zstandard  # noqa: F401
    except ImportError as error:
        raise missing_library_error(path, "mcap", "ros") from error
    topics: dict[str, Topic] = {}
    remarks: list[str] = []
    try:
        _read_topics(path, topics, remarks)
    except BadInput:
        raise
    except Exception as error:  # the library raises any exception on a damaged file
        if not any(len(topic.logged) for topic in topics.values()):
            raise damaged_log_error(path, "MCAP", error) from error
        remarks.append(f"{path}: ends early or is damaged; the part before is used")
    return log_from_topics(path, topics, remarks)


def _read_topics(path: Path, topics: dict[str, Topic], remarks: list[str]) -> None:
    from mcap.records import Channel, Message, Schema

    schemas, names, room = {}, dict[int, str](), MemoryBudget(path)
    for record in _records(path):
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel) and record.id not in names:
            decode = _decoder(record, schemas.get(record.schema_id), remarks, path)
            if decode is not None:
                names[record.id] = record.topic
                topics.setdefault(record.topic, Topic(decode))
        elif (
            isinstance(record, Message)
            and record.channel_id in names
            and len(record.data) <= MAX_SIZE
        ):
            name = names[record.channel_id]
            try:
                topics[name].add_message(record.log_time * 1e-9, record.data, room)
            except ValueError as error:
                remarks.append(
                    f"{path}: messages of {name} that cannot be read are left out ({error})"
                )


def _records(path: Path) -> "Iterator[Any]":
    """All records; chunks are unpacked up to a limit of their size."""
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader, breakup_chunk

    with path.open("rb") as file:
        for record in StreamReader(file, emit_chunks=True, record_size_limit=MAX_CHUNK).records:
            if isinstance(record, Chunk):
                record.data, record.compression = _decompress(record.compression, record.data), ""
                yield from breakup_chunk(record)
            else:
                yield record


def _decompress(compression: str, data: bytes) -> bytes:
    if compression == "zstd":
        import zstandard

        if zstandard.get_frame_parameters(data).content_size > MAX_CHUNK:
            raise ValueError("a chunk too large to unpack")
        return bytes(zstandard.ZstdDecompressor().decompress(data, max_output_size=MAX_CHUNK))
    if compression == "lz4":
        from lz4.frame import LZ4FrameDecompressor

        return bytes(LZ4FrameDecompressor().decompress(data, max_length=MAX_CHUNK))
    return data


def _decoder(
    channel: Any, schema: Any, remarks: list[str], path: Path
) -> "Callable[[bytes], dict[str, float]] | None":
    """The decoder of the messages of a channel; None, with a remark, for an unknown encoding."""
    encoding = (channel.message_encoding, "")
    if schema:
        encoding = (channel.message_encoding, schema.encoding)
    try:
        if encoding in (("cdr", "ros2msg"), ("ros1", "ros1msg")):
            return Decoder(
                schema.data.decode("utf-8", "replace"), schema.name, encoding[0] == "cdr"
            )
    except (ValueError, RecursionError) as error:
        remarks.append(f"{path}: {channel.topic} is not read ({error})")
        return None
    if channel.message_encoding == "json":
        return _numbers_of_json
    remarks.append(
        f"{path}: {channel.topic} is not read: its messages are "
        f"{' '.join(encoding).strip() or 'unknown'}"
    )
    return None


def _numbers_of_json(data: bytes) -> dict[str, float]:
    found: dict[str, float] = {}
    try:
        _flatten(json.loads(data), "", found, 0)
    except (UnicodeDecodeError, RecursionError) as error:
        raise ValueError(str(error)) from error
    return found


def _flatten(value: object, name: str, found: dict[str, float], depth: int) -> None:
    if isinstance(value, int | float) and abs(value) < 1e300 and len(found) < MAX_SIGNALS:
        found[name or "value"] = float(value)
    elif isinstance(value, dict) and depth < MAX_NESTING:
        prefix = ""
        if name:
            prefix = f"{name}."
        for key, inner in value.items():
            _flatten(inner, f"{prefix}{key}", found, depth + 1)
