"""Writes tests/data/logs: one simulated run of the Otter as the logs of several programs; run
again, the same bytes.

python tests/make_logs.py

The boat is simulated (boatsim.simulate.batch, without noise); the logs are written by the library
of each format where it has a writer (MCAP, bags, Parquet), else byte by byte as its documents say.
Latitudes and longitudes come from the exact tangent plane by way of earth-centred coordinates, not
from the formula that the readers use.
"""

import math
import shutil
import struct
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent / "data" / "logs"
STEP, DURATION = 0.02, 30.0  # [s]
ORIGIN = (math.radians(63.44), math.radians(10.35))  # [rad] latitude, longitude
EPOCH = 1_750_000_000.0  # [s] since 1970 when the run begins
BOOT = 12.345  # [s] since the autopilot started
FULL = 104.0  # [rad/s] of the Otter's propellers
A, F = 6378137.0, 1.0 / 298.257223563


def simulated() -> dict[str, np.ndarray]:
    """Columns of the run at every step, commands in force from their row on."""
    from boatsim.physics.vessel import load_vessel
    from boatsim.simulate.batch import Batch

    t = STEP * np.arange(round(DURATION / STEP) + 1)
    turn = np.where(np.floor(t / 5.0) % 2 == 0, 1.0, -1.0) * np.where(t < 2.0, 0.0, 1.0)
    port, starboard = 62.4 + 20.8 * turn, 62.4 - 20.8 * turn
    boat = Batch(load_vessel("otter"), step=STEP)
    assert list(boat.vessels[0].commands) == ["n_port_radps", "n_starboard_radps"]
    start = [0.0] * 12
    start[5] = math.radians(350.0)
    states = boat.rollout(start, np.column_stack([port, starboard])[:-1], STEP)
    named = dict(
        zip(
            [
                "x_m",
                "y_m",
                "z_m",
                "phi_rad",
                "theta_rad",
                "psi_rad",
                "u_mps",
                "v_mps",
                "w_mps",
                "p_radps",
                "q_radps",
                "r_radps",
            ],
            states.T,
            strict=True,
        )
    )  # noqa: E501
    keep = ("x_m", "y_m", "phi_rad", "theta_rad", "psi_rad", "r_radps")
    return {
        "t_s": t,
        **{n: named[n] for n in keep},
        "n_port_radps": port,
        "n_starboard_radps": starboard,
    }


def geodetic(north: float, east: float) -> tuple[float, float]:
    """Latitude, longitude [deg] of a place on the tangent plane at ORIGIN, by earth-centred
    coordinates."""
    lat0, lon0 = ORIGIN
    e2 = F * (2.0 - F)
    n = A / math.sqrt(1.0 - e2 * math.sin(lat0) ** 2)
    x0, y0, z0 = (
        n * math.cos(lat0) * math.cos(lon0),
        n * math.cos(lat0) * math.sin(lon0),
        n * (1 - e2) * math.sin(lat0),
    )
    x = x0 - math.sin(lat0) * math.cos(lon0) * north - math.sin(lon0) * east
    y = y0 - math.sin(lat0) * math.sin(lon0) * north + math.cos(lon0) * east
    z = z0 + math.cos(lat0) * north
    flat, lat = math.hypot(x, y), lat0
    for _ in range(8):
        n = A / math.sqrt(1.0 - e2 * math.sin(lat) ** 2)
        lat = math.atan2(z + e2 * n * math.sin(lat), flat)
    return math.degrees(lat), math.degrees(math.atan2(y, x))


def pulse(command: float) -> int:
    """Microseconds of an output for a propeller's speed [rad/s]: 1100 to 1900 about 1500."""
    return round(1500 + 400 * command / FULL)


def every(run: dict[str, np.ndarray], rate: float) -> list[dict[str, float]]:
    """Rows of the run at a lower rate [Hz]."""
    n = round(1.0 / rate / STEP)
    return [{k: float(v[i]) for k, v in run.items()} for i in range(0, len(run["t_s"]), n)]


def quaternion(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """W, x, y, z of yaw, then pitch, then roll."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a / 2), math.sin(a / 2)) for a in (roll, pitch, yaw))
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )  # noqa: E501


def streams(
    run: dict[str, np.ndarray], rates: Sequence[float]
) -> list[tuple[float, int, dict[str, float]]]:
    """(time, number of the stream, row) in the order of time."""
    return sorted(
        ((row["t_s"], k, row) for k, rate in enumerate(rates) for row in every(run, rate)),
        key=lambda r: r[:2],
    )


# ArduPilot
# -----------------------------------------------------------------------------------------------------------

MESSAGES = {  # name -> number, format, columns, units, multipliers
    "FMT": (128, "BBnNZ", "Type,Length,Name,Format,Columns", "-b---", "-----"),
    "UNIT": (129, "QbZ", "TimeUS,Id,Label", "s--", "F--"),
    "MULT": (130, "Qbd", "TimeUS,Id,Mult", "s--", "F--"),
    "FMTU": (131, "QBNN", "TimeUS,FmtType,UnitIds,MultIds", "s---", "F---"),
    "PARM": (132, "QNff", "TimeUS,Name,Value,Default", "s---", "F---"),
    "ATT": (133, "Qffff", "TimeUS,Roll,Pitch,Yaw,DesYaw", "sddhh", "F0000"),
    "IMU": (134, "QBfff", "TimeUS,I,GyrX,GyrY,GyrZ", "s#EEE", "F-000"),
    "GPS": (135, "QBBLL", "TimeUS,I,Status,Lat,Lng", "s#-DU", "F--GG"),
    "RCIN": (136, "QHHH", "TimeUS,C1,C2,C3", "sYYY", "F000"),
    "RCOU": (137, "QHHHH", "TimeUS,C1,C2,C3,C4", "sYYYY", "F0000"),
}
SIZES = {
    "b": "b",
    "B": "B",
    "H": "H",
    "f": "f",
    "d": "d",
    "L": "i",
    "Q": "Q",
    "n": "4s",
    "N": "16s",
    "Z": "64s",
}


def packed(name: str, *values: object) -> bytes:
    number, format, *_ = MESSAGES[name]
    cells = [v.encode() if isinstance(v, str) else v for v in values]
    return (
        b"\xa3\x95" + bytes([number]) + struct.pack("<" + "".join(SIZES[c] for c in format), *cells)
    )


def ardupilot(run: dict[str, np.ndarray], path: Path) -> None:
    us = round(BOOT * 1e6)
    out = []
    for name, (number, format, columns, _, _) in MESSAGES.items():
        length = 3 + struct.calcsize("<" + "".join(SIZES[c] for c in format))
        out.append(packed("FMT", number, length, name, format, columns))
    units = {
        "s": "s",
        "d": "deg",
        "h": "degheading",
        "E": "rad/s",
        "D": "deglatitude",
        "U": "deglongitude",
        "Y": "us",
        "#": "instance",
        "-": "",
        "b": "B",
    }  # noqa: E501
    out += [packed("UNIT", us, ord(k), v) for k, v in units.items()]
    out += [
        packed("MULT", us, ord(k), v) for k, v in {"F": 1e-6, "G": 1e-7, "0": 1.0, "-": 0.0}.items()
    ]
    out += [packed("FMTU", us, number, u, m) for number, _, _, u, m in MESSAGES.values()]
    servos = {1: 73, 3: 74}  # left and right throttle
    for output, function in servos.items():
        ends = {"MIN": 1100, "TRIM": 1500, "MAX": 1900, "REVERSED": 0, "FUNCTION": function}
        out += [packed("PARM", us, f"SERVO{output}_{k}", float(v), 0.0) for k, v in ends.items()]
    out += [packed("GPS", us - 400_000, 0, 1, 0, 0)]  # before satellites are found
    for t, kind, row in streams(run, (10.0, 25.0, 5.0, 10.0)):
        at = us + round(t * 1e6) + (0, 1300, 2100, 0)[kind]
        if kind == 0:
            yaw = math.degrees(row["psi_rad"]) % 360.0
            roll, pitch = math.degrees(row["phi_rad"]), math.degrees(row["theta_rad"])
            out.append(packed("ATT", at, roll, pitch, yaw, 350.0))
        elif kind == 1:
            out.append(packed("IMU", at, 0, 0.0, 0.0, row["r_radps"]))
            out.append(packed("IMU", at, 1, 0.0, 0.0, row["r_radps"] + 0.001))
        elif kind == 2:
            lat, lon = geodetic(row["x_m"], row["y_m"])
            out.append(packed("GPS", at, 0, 3, round(lat * 1e7), round(lon * 1e7)))
        else:
            port, starboard = pulse(row["n_port_radps"]), pulse(row["n_starboard_radps"])
            out.append(
                packed("RCIN", at, 1500 + (port - starboard) // 4, 1500, (port + starboard) // 2)
            )
            out.append(packed("RCOU", at, port, 1500, starboard, 0))
    path.write_bytes(b"".join(out))


# PX4
# -----------------------------------------------------------------------------------------------------------------

TOPICS = {
    "vehicle_attitude": ("uint64_t timestamp;float[4] q;", "<Q4f"),
    "vehicle_angular_velocity": ("uint64_t timestamp;float[3] xyz;", "<Q3f"),
    "vehicle_local_position": ("uint64_t timestamp;float x;float y;float z;", "<Q3f"),
    "actuator_outputs": (
        "uint64_t timestamp;uint32_t noutputs;float[4] output;uint8_t[4] _padding0;",
        "<QI4f",
    ),
}


def ulog(run: dict[str, np.ndarray], path: Path) -> None:
    def message(kind: str, body: bytes) -> bytes:
        return struct.pack("<HB", len(body), ord(kind)) + body

    us = round(BOOT * 1e6)
    out = [b"\x55\x4c\x6f\x67\x01\x12\x35\x01" + struct.pack("<Q", us), message("B", bytes(40))]
    out += [message("F", f"{name}:{fields}".encode()) for name, (fields, _) in TOPICS.items()]
    out += [message("A", struct.pack("<BH", 0, k) + name.encode()) for k, name in enumerate(TOPICS)]
    for t, kind, row in streams(run, (25.0, 25.0, 10.0, 10.0)):
        at = us + round(t * 1e6) + (0, 0, 1100, 0)[kind]
        values: Sequence[float]
        if kind == 0:
            values = quaternion(row["phi_rad"], row["theta_rad"], row["psi_rad"])
        elif kind == 1:
            values = (0.0, 0.0, row["r_radps"])
        elif kind == 2:
            values = (row["x_m"], row["y_m"], 0.0)
        else:
            values = (2, pulse(row["n_port_radps"]), pulse(row["n_starboard_radps"]), 0.0, 0.0)
        out.append(
            message(
                "D",
                struct.pack("<H", kind) + struct.pack(list(TOPICS.values())[kind][1], at, *values),
            )
        )
    path.write_bytes(b"".join(out))


# ROS: x east, y north, z up; hull x forward, y port, z up
# ------------------------------------------------------------


def messages(run: dict[str, np.ndarray], store: object) -> list[tuple[str, str, int, object]]:
    """Topic, type, time [ns], message."""
    types = store.types  # type: ignore[attr-defined]
    stamp, header, vector = (
        types["builtin_interfaces/msg/Time"],
        types["std_msgs/msg/Header"],
        types["geometry_msgs/msg/Vector3"],
    )  # noqa: E501
    found = []
    for t, kind, row in streams(run, (10.0, 10.0, 10.0)):
        ns = round((EPOCH + t) * 1e9)
        extra = {"seq": 0} if "seq" in header.__dataclass_fields__ else {}
        head = header(stamp=stamp(sec=ns // 10**9, nanosec=ns % 10**9), frame_id="map", **extra)
        w, x, y, z = quaternion(row["phi_rad"], -row["theta_rad"], math.pi / 2 - row["psi_rad"])
        turned = types["geometry_msgs/msg/Quaternion"](x=x, y=y, z=z, w=w)
        if kind == 0:
            point = types["geometry_msgs/msg/Point"](x=row["y_m"], y=row["x_m"], z=0.0)
            pose = types["geometry_msgs/msg/Pose"](position=point, orientation=turned)
            found.append(
                (
                    "/boat/pose",
                    "geometry_msgs/msg/PoseStamped",
                    ns,
                    types["geometry_msgs/msg/PoseStamped"](header=head, pose=pose),
                )
            )  # noqa: E501
        elif kind == 1:
            none, zero = np.zeros(9), vector(x=0.0, y=0.0, z=0.0)
            imu = types["sensor_msgs/msg/Imu"](
                header=head,
                orientation=turned,
                orientation_covariance=none,
                angular_velocity=vector(x=0.0, y=0.0, z=-row["r_radps"]),
                angular_velocity_covariance=none,
                linear_acceleration=zero,
                linear_acceleration_covariance=none,
            )
            found.append(("/boat/imu", "sensor_msgs/msg/Imu", ns, imu))
        else:
            for side in ("port", "starboard"):
                value = types["std_msgs/msg/Float64"](data=row[f"n_{side}_radps"] / FULL)
                found.append(
                    (f"/thrusters/{side}/cmd", "std_msgs/msg/Float64", ns + 400_000, value)
                )
    return found


def mcap(run: dict[str, np.ndarray], path: Path) -> None:
    from mcap.writer import CompressionType, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start(profile="ros2", library="tests")
        channels: dict[str, int] = {}
        for topic, kind, ns, message in messages(run, store):
            if topic not in channels:
                text = store.generate_msgdef(kind, ros_version=2)[0]
                schema = writer.register_schema(name=kind, encoding="ros2msg", data=text.encode())
                channels[topic] = writer.register_channel(
                    topic=topic, message_encoding="cdr", schema_id=schema
                )
            data = bytes(store.serialize_cdr(message, kind))
            writer.add_message(channels[topic], log_time=ns, data=data, publish_time=ns)
        writer.finish()


def bag1(run: dict[str, np.ndarray], path: Path) -> None:
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    path.unlink(missing_ok=True)
    writer = Writer(path)
    writer.set_compression(Writer.CompressionFormat.LZ4)
    with writer:
        known: dict[str, object] = {}
        for topic, kind, ns, message in messages(run, store):
            if topic not in known:
                known[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(known[topic], ns, store.serialize_ros1(message, kind))  # type: ignore[arg-type]


def bag2(run: dict[str, np.ndarray], path: Path) -> None:
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    shutil.rmtree(path, ignore_errors=True)
    with Writer(path, version=8, storage_plugin=StoragePlugin.SQLITE3) as writer:
        known: dict[str, object] = {}
        for topic, kind, ns, message in messages(run, store):
            if topic == "/boat/imu":
                continue  # of a size beyond what a test needs
            if topic not in known:
                known[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(known[topic], ns, store.serialize_cdr(message, kind))  # type: ignore[arg-type]


# NMEA 0183
# -----------------------------------------------------------------------------------------------------------


def sentence(body: str) -> str:
    total = 0
    for character in body:
        total ^= ord(character)
    return f"${body}*{total:02X}\r\n"


def angle(value: float, digits: int, ends: str) -> str:
    whole, minutes = divmod(abs(value) * 60.0, 60.0)
    return f"{int(whole):0{digits}d}{minutes:010.7f},{ends[value < 0]}"


def nmea(run: dict[str, np.ndarray], path: Path) -> None:
    from datetime import UTC, datetime

    out = []
    for row in every(run, 5.0):
        when = datetime.fromtimestamp(EPOCH + row["t_s"], UTC)
        lat, lon = geodetic(row["x_m"], row["y_m"])
        clock = f"{when:%H%M%S}.{when.microsecond // 10_000:02d}"
        out.append(
            sentence(
                f"GPRMC,{clock},A,{angle(lat, 2, 'NS')},{angle(lon, 3, 'EW')},1.94,350.0,{when:%d%m%y},,,A"
            )
        )
        out.append(sentence(f"HEHDT,{math.degrees(row['psi_rad']) % 360.0:.3f},T"))
        out.append(sentence(f"TIROT,{math.degrees(row['r_radps']) * 60.0:.2f},A"))
        for number, side in enumerate(("port", "starboard"), 1):
            out.append(
                sentence(f"ERRPM,S,{number},{row[f'n_{side}_radps'] * 30.0 / math.pi:.2f},,A")
            )
    path.write_bytes("".join(out).encode("ascii"))


# tables
# --------------------------------------------------------------------------------------------------------------


def table(run: dict[str, np.ndarray], path: Path) -> None:
    """Semicolons and decimal commas, times since 1970 in ms, degrees, per cent, fixes at 2 Hz
    repeated between."""
    out = [
        "Zeit [ms];Breite;GPS Lat [deg];GPS Lon [deg];Heading [deg];Yaw rate [deg/s];Motor left [%];Motor right [%]"
    ]
    fix = ("", "")
    for k, row in enumerate(every(run, 10.0)):
        if k % 5 == 0:
            lat, lon = geodetic(row["x_m"], row["y_m"])
            fix = (f"{lat:.9f}", f"{lon:.9f}")
        cells = [
            f"{(EPOCH + row['t_s']) * 1e3:.0f}",
            "1.08",
            *fix,
            f"{math.degrees(row['psi_rad']) % 360.0:.3f}",
            f"{math.degrees(row['r_radps']):.4f}",
            f"{row['n_port_radps'] / FULL * 100.0:.2f}",
            f"{row['n_starboard_radps'] / FULL * 100.0:.2f}",
        ]
        out.append(";".join(cells).replace(".", ","))
    path.write_text("\n".join(out).replace("Zeit", "Time") + "\n", encoding="utf-8")


def parquet(run: dict[str, np.ndarray], path: Path) -> None:
    """Times as dates, poses and commands in rows of their own: a table that two others were stacked
    into."""
    import pyarrow as pa
    from pyarrow import parquet as pq

    poses, orders = every(run, 10.0), every(run, 5.0)
    t = np.array([r["t_s"] for r in poses] + [r["t_s"] + 0.003 for r in orders])
    order = np.argsort(t, kind="stable")
    gap, other = [None] * len(orders), [None] * len(poses)

    def column(cells: list[float | None]) -> pa.Array:
        return pa.array([cells[i] for i in order], type=pa.float64())

    stamps = pa.array([round((EPOCH + t[i]) * 1e6) for i in order], type=pa.timestamp("us", "UTC"))
    pq.write_table(
        pa.table(
            {
                "timestamp": stamps,
                "north": column([r["x_m"] for r in poses] + gap),
                "east": column([r["y_m"] for r in poses] + gap),
                "heading_deg": column([math.degrees(r["psi_rad"]) for r in poses] + gap),
                "motor_port_rpm": column(
                    other + [r["n_port_radps"] * 30.0 / math.pi for r in orders]
                ),
                "motor_starboard_rpm": column(
                    other + [r["n_starboard_radps"] * 30.0 / math.pi for r in orders]
                ),
            }
        ),
        path,
    )


LOGS: dict[str, Callable[[dict[str, np.ndarray], Path], None]] = {
    "rover.BIN": ardupilot,
    "px4.ulg": ulog,
    "ros2.mcap": mcap,
    "ros1.bag": bag1,
    "ros2_bag": bag2,
    "instruments.nmea": nmea,
    "table.csv": table,
    "stacked.parquet": parquet,
}


def main() -> None:
    HERE.mkdir(parents=True, exist_ok=True)
    run = simulated()
    lines = [",".join(run)] + [
        ",".join(f"{v:.9g}" for v in row) for row in zip(*run.values(), strict=True)
    ]
    (HERE / "truth.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    for name, write in LOGS.items():
        write(run, HERE / name)
        print(
            f"{name}: {sum(f.stat().st_size for f in [HERE / name, *(HERE / name).glob('*')] if f.is_file())} bytes"
        )


if __name__ == "__main__":
    main()
