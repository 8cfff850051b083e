"""PX4 ULog of a boat, written byte by byte."""

import struct
from pathlib import Path

import numpy as np

from validation.owner_logs.boats import Boat
from validation.owner_logs.formats import earth
from validation.owner_logs.formats.log import Scale, WrittenLog
from validation.owner_logs.instruments import RecordedSignals

TOPICS = {
    "vehicle_attitude": ("uint64_t timestamp;float[4] q;", "<Q4f"),
    "vehicle_angular_velocity": ("uint64_t timestamp;float[3] xyz;", "<Q3f"),
    "vehicle_local_position": (
        "uint64_t timestamp;float x;float y;float z;float vx;float vy;float heading;",
        "<Q6f",
    ),
    "actuator_outputs": (
        "uint64_t timestamp;uint32_t noutputs;float[4] output;uint8_t[4] _padding0;",
        "<QI4f",
    ),
}


def _message(kind: str, body: bytes) -> bytes:
    return struct.pack("<HB", len(body), ord(kind)) + body


def write(seen: RecordedSignals, boat: Boat, folder: Path, stem: str) -> WrittenLog:
    """Write attitude as quaternions, local position north and east, outputs as pulses."""
    us = round(earth.BOOT * 1e6)
    out = [b"\x55\x4c\x6f\x67\x01\x12\x35\x01" + struct.pack("<Q", us), _message("B", bytes(40))]
    out += [_message("F", f"{name}:{fields}".encode()) for name, (fields, _) in TOPICS.items()]
    out += [
        _message("A", struct.pack("<BH", 0, k) + name.encode()) for k, name in enumerate(TOPICS)
    ]
    outputs = [n for n in ("helm", "motor", "port", "starboard") if n in seen.orders.values]
    shares = [seen.orders.values[n] / (boat.helm_most if n == "helm" else 1.0) for n in outputs]
    psi, fixes = seen.compass.values["psi"], seen.fixes.values
    shown = np.interp(seen.fixes.t, seen.compass.t, psi)
    for t, kind, i in earth.merge_streams(seen.compass.t, seen.gyro.t, seen.fixes.t, seen.orders.t):
        at = us + round(t * 1e6) + (0, 0, 1100, 200)[kind]
        values: tuple[float, ...]
        if kind == 0:
            values = earth.quaternion(psi[i])
        elif kind == 1:
            values = (0.0, 0.0, seen.gyro.values["r"][i])
        elif kind == 2:
            vx, vy = (fixes["speed"][i] * f(fixes["course"][i]) for f in (np.cos, np.sin))
            heading = float(np.remainder(shown[i] + np.pi, 2.0 * np.pi) - np.pi)
            values = (fixes["north"][i], fixes["east"][i], 0.0, vx, vy, heading)
        else:
            cells = [1500.0 + 400.0 * s[i] for s in shares]
            values = (len(cells), *cells, *[0.0] * (4 - len(cells)))
        layout = list(TOPICS.values())[kind][1]
        packed = (int(values[0]), *values[1:]) if kind == 3 else values
        out.append(_message("D", struct.pack("<H", kind) + struct.pack(layout, at, *packed)))
    path = folder / f"{stem}.ulg"
    path.write_bytes(b"".join(out))
    return WrittenLog(
        path,
        {
            n: Scale(f"actuator_outputs.output[{i}]", 1100.0, 1500.0, 1900.0)
            for i, n in enumerate(outputs)
        },
    )
