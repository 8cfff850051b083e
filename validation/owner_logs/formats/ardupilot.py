"""ArduPilot dataflash log of a boat, written byte by byte."""

import struct
from pathlib import Path

import numpy as np

from validation.owner_logs.boats import Boat
from validation.owner_logs.formats import earth
from validation.owner_logs.formats.log import Scale, WrittenLog
from validation.owner_logs.instruments import RecordedSignals

MESSAGES = {  # name -> number, format, columns, units, multipliers
    "FMT": (128, "BBnNZ", "Type,Length,Name,Format,Columns", "-b---", "-----"),
    "UNIT": (129, "QbZ", "TimeUS,Id,Label", "s--", "F--"),
    "MULT": (130, "Qbd", "TimeUS,Id,Mult", "s--", "F--"),
    "FMTU": (131, "QBNN", "TimeUS,FmtType,UnitIds,MultIds", "s---", "F---"),
    "PARM": (132, "QNff", "TimeUS,Name,Value,Default", "s---", "F---"),
    "ATT": (133, "Qffff", "TimeUS,Roll,Pitch,Yaw,DesYaw", "sddhh", "F0000"),
    "IMU": (134, "QBfff", "TimeUS,I,GyrX,GyrY,GyrZ", "s#EEE", "F-000"),
    "GPS": (135, "QBBBLLff", "TimeUS,I,Status,NSats,Lat,Lng,Spd,GCrs", "s#--DUnh", "F---GG00"),
    "RCIN": (136, "QHHHH", "TimeUS,C1,C2,C3,C4", "sYYYY", "F0000"),
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
UNITS = {
    "s": "s",
    "d": "deg",
    "h": "degheading",
    "E": "rad/s",
    "D": "deglatitude",
    "U": "deglongitude",
    "Y": "us",
    "n": "m/s",
    "#": "instance",
    "-": "",
    "b": "B",
}
MULTIPLIERS = {"F": 1e-6, "G": 1e-7, "0": 1.0, "-": 0.0}
FUNCTIONS = {"port": 73, "starboard": 74, "motor": 70, "helm": 26}  # SERVOn_FUNCTION
ENDS = (1100.0, 1500.0, 1900.0)  # [us]


def _pack_message(name: str, *values: object) -> bytes:
    number, layout, *_ = MESSAGES[name]
    cells = [v.encode() if isinstance(v, str) else v for v in values]
    return (
        b"\xa3\x95" + bytes([number]) + struct.pack("<" + "".join(SIZES[c] for c in layout), *cells)
    )


def _format_messages(outputs: list[str], us: int) -> list[bytes]:
    out = []
    for name, (number, layout, columns, _, _) in MESSAGES.items():
        length = 3 + struct.calcsize("<" + "".join(SIZES[c] for c in layout))
        out.append(_pack_message("FMT", number, length, name, layout, columns))
    out += [_pack_message("UNIT", us, ord(k), v) for k, v in UNITS.items()]
    out += [_pack_message("MULT", us, ord(k), v) for k, v in MULTIPLIERS.items()]
    out += [_pack_message("FMTU", us, number, u, m) for number, _, _, u, m in MESSAGES.values()]
    for i, output in enumerate(outputs, 1):
        ends = dict(zip(("MIN", "TRIM", "MAX"), ENDS, strict=True)) | {
            "REVERSED": 0.0,
            "FUNCTION": FUNCTIONS[output],
        }
        out += [_pack_message("PARM", us, f"SERVO{i}_{k}", float(v), 0.0) for k, v in ends.items()]
    return out


def write(seen: RecordedSignals, boat: Boat, folder: Path, stem: str) -> WrittenLog:
    """Write ATT at 10 Hz, IMU at 25 Hz, GPS and RCOU at their own rates."""
    outputs = [n for n in ("helm", "motor", "port", "starboard") if n in seen.orders.values]
    us = round(earth.BOOT * 1e6)
    out = [
        *_format_messages(outputs, us),
        _pack_message("GPS", us - 400_000, 0, 1, 0, 0, 0, 0.0, 0.0),
    ]
    lat, lon = earth.geodetic(seen.fixes.values["north"], seen.fixes.values["east"])
    yaw = earth.compass_degrees(seen.compass.values["psi"])
    pulses = {}
    for n, v in seen.orders.values.items():
        pulses[n] = np.round(1500.0 + 400.0 * v / (boat.helm_most if n == "helm" else 1.0)).astype(
            int
        )
    for t, kind, i in earth.merge_streams(seen.compass.t, seen.gyro.t, seen.fixes.t, seen.orders.t):
        at = us + round(t * 1e6) + (0, 1300, 2100, 400)[kind]
        if kind == 0:
            out.append(_pack_message("ATT", at, 0.3, -0.8, yaw[i], 0.0))
        elif kind == 1:
            out.append(_pack_message("IMU", at, 0, 0.0, 0.0, seen.gyro.values["r"][i]))
        elif kind == 2:
            speed, course = (
                seen.fixes.values["speed"][i],
                np.degrees(seen.fixes.values["course"][i]) % 360.0,
            )
            out.append(
                _pack_message(
                    "GPS", at, 0, 3, 14, round(lat[i] * 1e7), round(lon[i] * 1e7), speed, course
                )
            )
        else:
            cells = [int(pulses[n][i]) for n in outputs] + [0] * (4 - len(outputs))
            out.append(_pack_message("RCIN", at, 1500, 1500, 1500, 1500))
            out.append(_pack_message("RCOU", at, *cells))
    path = folder / f"{stem}.BIN"
    path.write_bytes(b"".join(out))
    return WrittenLog(path, {n: Scale(f"RCOU.C{i}", *ENDS) for i, n in enumerate(outputs, 1)})
