"""ROS messages of a boat's nodes, in MCAP and in bags of both versions.

Axes: x east, y north, yaw counterclockwise.
"""

import shutil
from collections.abc import Callable, Iterator
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from validation.owner_logs.boats import Boat
from validation.owner_logs.formats import earth
from validation.owner_logs.formats.log import Scale, WrittenLog
from validation.owner_logs.instruments import RecordedSignals

Message = tuple[str, str, int, Any]  # topic, type, time [ns], message


class MessageBuilder:
    """Builder of messages of one set of types."""

    def __init__(self, store: Any) -> None:
        self.types = store.types

    def make(self, kind: str, **fields: object) -> Any:
        """Return a message of a type."""
        package, name = kind.split("/")
        return self.types[f"{package}/msg/{name}"](**fields)

    def header(self, ns: int, frame: str) -> Any:
        """Its stamp."""
        kind = self.types["std_msgs/msg/Header"]
        extra = {"seq": 0} if "seq" in kind.__dataclass_fields__ else {}
        stamp = self.make("builtin_interfaces/Time", sec=ns // 10**9, nanosec=ns % 10**9)
        return kind(stamp=stamp, frame_id=frame, **extra)

    def vector(self, x: float, y: float, z: float) -> Any:
        """Three numbers."""
        return self.make("geometry_msgs/Vector3", x=float(x), y=float(y), z=float(z))

    def turned(self, yaw: float) -> Any:
        """A quaternion."""
        w, x, y, z = earth.quaternion(yaw)
        return self.make("geometry_msgs/Quaternion", w=w, x=x, y=y, z=z)


def messages(
    seen: RecordedSignals, boat: Boat, store: Any, local: bool, ned: bool
) -> Iterator[Message]:
    """Return all messages of a voyage.

    With `local`, poses on a map replace satellite fixes; with `ned`, the axes are not those of ROS.
    """
    nodes, psi, fixes = MessageBuilder(store), seen.compass.values["psi"], seen.fixes.values
    lat, lon = earth.geodetic(fixes["north"], fixes["east"])
    shown = np.interp(seen.fixes.t, seen.compass.t, psi)
    none = np.zeros(9)
    gyro = np.interp(seen.compass.t, seen.gyro.t, seen.gyro.values["r"])
    for t, kind, i in earth.merge_streams(seen.compass.t, seen.fixes.t, seen.orders.t):
        ns = round((earth.EPOCH + t) * 1e9) + (0, 1_000_000, 400_000)[kind]
        if kind == 0:
            yaw, rate = (psi[i], gyro[i]) if ned else (pi / 2 - psi[i], -gyro[i])
            yield (
                "/imu/data",
                "sensor_msgs/msg/Imu",
                ns,
                nodes.make(
                    "sensor_msgs/Imu",
                    header=nodes.header(ns, "base_link"),
                    orientation=nodes.turned(yaw),
                    orientation_covariance=none,
                    angular_velocity=nodes.vector(0.0, 0.0, rate),
                    angular_velocity_covariance=none,
                    linear_acceleration=nodes.vector(0.0, 0.0, 9.81),
                    linear_acceleration_covariance=none,
                ),
            )
        elif kind == 1 and local:
            x, y = (
                (fixes["north"][i], fixes["east"][i])
                if ned
                else (fixes["east"][i], fixes["north"][i])
            )
            point = nodes.make("geometry_msgs/Point", x=float(x), y=float(y), z=0.0)
            yaw = shown[i] if ned else pi / 2 - shown[i]
            pose = nodes.make("geometry_msgs/Pose", position=point, orientation=nodes.turned(yaw))
            made = nodes.make(
                "geometry_msgs/PoseStamped", header=nodes.header(ns, "map"), pose=pose
            )
            yield "/boat/pose", "geometry_msgs/msg/PoseStamped", ns, made
        elif kind == 1:
            kind_of = store.types["sensor_msgs/msg/NavSatStatus"]
            made = nodes.make(
                "sensor_msgs/NavSatFix",
                header=nodes.header(ns, "gps"),
                status=kind_of(status=2, service=1),
                latitude=float(lat[i]),
                longitude=float(lon[i]),
                altitude=0.3,
                position_covariance=none,
                position_covariance_type=0,
            )
            yield "/gps/fix", "sensor_msgs/msg/NavSatFix", ns, made
        else:
            for name, share in seen.orders.values.items():
                value = float(share[i])
                yield (
                    topic_name(name, boat),
                    "std_msgs/msg/Float64",
                    ns,
                    nodes.make("std_msgs/Float64", data=value),
                )


def topic_name(name: str, boat: Boat) -> str:
    """Return the topic of an order."""
    if name == "helm":
        if boat.plant.rudder:
            return "/rudder/cmd"
        return "/steering/cmd"
    if name == "motor":
        return "/thruster/cmd"
    return f"/thrusters/{name}/cmd"


def order_scales(seen: RecordedSignals, boat: Boat) -> dict[str, Scale]:
    """Return the scales: throttles from -1 to 1, the helm in rad."""
    return {
        n: Scale(f"{topic_name(n, boat)}.data", -boat.helm_most, 0.0, boat.helm_most)
        if n == "helm"
        else Scale(f"{topic_name(n, boat)}.data", -1.0, 0.0, 1.0)
        for n in seen.orders.values
    }


def write_mcap(
    seen: RecordedSignals, boat: Boat, folder: Path, stem: str, local: bool, ned: bool
) -> WrittenLog:
    """Write ROS 2 messages in MCAP."""
    from mcap.writer import CompressionType, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    path = folder / f"{stem}.mcap"
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start(profile="ros2", library="owner_logs")
        channels: dict[str, int] = {}
        for name, kind, ns, message in messages(seen, boat, store, local, ned):
            if name not in channels:
                text = store.generate_msgdef(kind, ros_version=2)[0]
                schema = writer.register_schema(name=kind, encoding="ros2msg", data=text.encode())
                channels[name] = writer.register_channel(
                    topic=name, message_encoding="cdr", schema_id=schema
                )
            data = bytes(store.serialize_cdr(message, kind))
            writer.add_message(channels[name], log_time=ns, data=data, publish_time=ns)
        writer.finish()
    return WrittenLog(path, order_scales(seen, boat))


def write_ros1_bag(
    seen: RecordedSignals, boat: Boat, folder: Path, stem: str, local: bool, ned: bool
) -> WrittenLog:
    """Write a bag of ROS 1."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    path = folder / f"{stem}.bag"
    path.unlink(missing_ok=True)
    with Writer(path) as writer:
        _write_bag(writer, store, store.serialize_ros1, messages(seen, boat, store, local, ned))
    return WrittenLog(path, order_scales(seen, boat))


def write_ros2_bag(
    seen: RecordedSignals, boat: Boat, folder: Path, stem: str, local: bool, ned: bool
) -> WrittenLog:
    """Write the folder of a bag of ROS 2."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    path = folder / f"{stem}_bag"
    shutil.rmtree(path, ignore_errors=True)
    with Writer(path, version=8, storage_plugin=StoragePlugin.SQLITE3) as writer:
        _write_bag(writer, store, store.serialize_cdr, messages(seen, boat, store, local, ned))
    return WrittenLog(path, order_scales(seen, boat))


def _write_bag(
    writer: Any, store: Any, serialize: Callable[[Any, str], Any], content: Iterator[Message]
) -> None:
    known: dict[str, Any] = {}
    for name, kind, ns, message in content:
        if name not in known:
            known[name] = writer.add_connection(name, kind, typestore=store)
        writer.write(known[name], ns, serialize(message, kind))
