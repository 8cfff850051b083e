"""The topics of a recording: standard messages of ROS 2 for pose, twist, commands and the rest."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.recordings.exporting.ros_axes import ros_orientation, ros_position, ros_vector
from boatsim.recordings.table import RUN_COLUMN, Recording, is_command

WORLD, HULL = "map", "base_link"  # names of frames, REP 105
PLANE = ("x_m", "y_m", "psi_rad")
RATES_IN_PLANE = ("u_mps", "v_mps", "r_radps")
OUT_OF_PLANE = ("z_m", "phi_rad", "theta_rad")  # zero where a vessel does not have them
RATES_OUT_OF_PLANE = ("w_mps", "p_radps", "q_radps")
CAMERA = "camera_"
FLOAT = "std_msgs/msg/Float64"

# row of the recording and its time stamp [ns] -> message
MakeMessage = Callable[[int, int], Any]


class Topic(NamedTuple):
    """A topic of a log.

    Attributes:
        name: Name of the topic.
        kind: Name of its messages, such as "geometry_msgs/msg/PoseStamped".
        rows: Whether each row of the recording (N,) has a message.
        make: Makes the message of a row.
    """

    name: str
    kind: str
    rows: NDArray[np.bool_]
    make: MakeMessage


def topics_of(recording: Recording, types: Mapping[str, Any]) -> list[Topic]:
    """Return the topics of a recording; every signal is in exactly one of them, and in /tf.

    Poses and twists are in the axes of ROS, the signals under /commands and /signals in those of
    the recording.

    Args:
        recording: The recording.
        types: Message classes of ROS 2 by name.
    """
    signals = dict(recording.signals)
    topics = []
    pose = _take(signals, PLANE, OUT_OF_PLANE)
    if pose:
        topics += [_pose_topic("/pose", pose, types), _transform_topic(pose, types)]
    twist = _take(signals, RATES_IN_PLANE, RATES_OUT_OF_PLANE)
    if twist:
        topics.append(_twist_topic(twist, types))
    seen = _take(signals, tuple(map(f"{CAMERA}{{}}".format, PLANE)), ())
    if seen:
        unprefixed = {name.removeprefix(CAMERA): values for name, values in seen.items()}
        topics.append(_pose_topic("/camera/pose", unprefixed, types))
    for name, values in signals.items():
        place = "signals"
        if is_command(name) and not RUN_COLUMN.match(name):
            place = "commands"
        topics.append(_number_topic(f"/{place}/{name}", values, types))
    return topics


def _take(
    signals: dict[str, Array], needed: tuple[str, ...], further: tuple[str, ...]
) -> dict[str, Array]:
    """Remove and return the signals of a message; none if one of the needed is missing."""
    if not set(needed) <= signals.keys():
        return {}
    taken = {}
    for name in (*needed, *further):
        if name in signals:
            taken[name] = signals.pop(name)
    return taken


def _complete_rows(signals: Mapping[str, Array]) -> NDArray[np.bool_]:
    complete = np.ones(len(next(iter(signals.values()))), dtype=np.bool_)
    for values in signals.values():
        complete &= np.isfinite(values)
    return complete


def _zeros_if_absent(signals: Mapping[str, Array], names: tuple[str, ...]) -> list[Array]:
    zeros = np.zeros(len(next(iter(signals.values()))))
    return [signals.get(name, zeros) for name in names]


def _positions_and_orientations(pose: Mapping[str, Array]) -> tuple[list[Any], list[Any]]:
    """Position (x, y, z) and quaternion (x, y, z, w) of each row, in the axes of ROS."""
    z, phi, theta = _zeros_if_absent(pose, OUT_OF_PLANE)
    position = ros_position(pose["x_m"], pose["y_m"], z)
    return position.tolist(), ros_orientation(phi, theta, pose["psi_rad"]).tolist()


def _header(types: Mapping[str, Any], stamp: int, frame: str) -> Any:
    time = types["builtin_interfaces/msg/Time"](*divmod(stamp, 1_000_000_000))
    return types["std_msgs/msg/Header"](time, frame)


def _pose_topic(name: str, pose: Mapping[str, Array], types: Mapping[str, Any]) -> Topic:
    kind = "geometry_msgs/msg/PoseStamped"
    stamped, body = types[kind], types["geometry_msgs/msg/Pose"]
    point, quaternion = types["geometry_msgs/msg/Point"], types["geometry_msgs/msg/Quaternion"]
    positions, orientations = _positions_and_orientations(pose)

    def make_pose_message(row: int, stamp: int) -> Any:
        place = body(point(*positions[row]), quaternion(*orientations[row]))
        return stamped(_header(types, stamp, WORLD), place)

    return Topic(name, kind, _complete_rows(pose), make_pose_message)


def _transform_topic(pose: Mapping[str, Array], types: Mapping[str, Any]) -> Topic:
    """The pose as the transform from the world to the hull, which moves the 3D view."""
    kind = "tf2_msgs/msg/TFMessage"
    several, stamped = types[kind], types["geometry_msgs/msg/TransformStamped"]
    transform, vector = types["geometry_msgs/msg/Transform"], types["geometry_msgs/msg/Vector3"]
    quaternion = types["geometry_msgs/msg/Quaternion"]
    positions, orientations = _positions_and_orientations(pose)

    def make_transform_message(row: int, stamp: int) -> Any:
        place = transform(vector(*positions[row]), quaternion(*orientations[row]))
        return several([stamped(_header(types, stamp, WORLD), HULL, place)])

    return Topic("/tf", kind, _complete_rows(pose), make_transform_message)


def _twist_topic(rates: Mapping[str, Array], types: Mapping[str, Any]) -> Topic:
    kind = "geometry_msgs/msg/TwistStamped"
    stamped, body = types[kind], types["geometry_msgs/msg/Twist"]
    vector = types["geometry_msgs/msg/Vector3"]
    w, p, q = _zeros_if_absent(rates, RATES_OUT_OF_PLANE)
    linear = ros_vector(rates["u_mps"], rates["v_mps"], w).tolist()
    angular = ros_vector(p, q, rates["r_radps"]).tolist()

    def make_twist_message(row: int, stamp: int) -> Any:
        motion = body(vector(*linear[row]), vector(*angular[row]))
        return stamped(_header(types, stamp, HULL), motion)

    return Topic("/twist", kind, _complete_rows(rates), make_twist_message)


def _number_topic(name: str, values: Array, types: Mapping[str, Any]) -> Topic:
    number = types[FLOAT]
    numbers = values.tolist()

    def make_number_message(row: int, stamp: int) -> Any:
        return number(numbers[row])

    return Topic(name, FLOAT, np.isfinite(values), make_number_message)
