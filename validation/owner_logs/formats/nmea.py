"""NMEA 0183 of a boat's network: RMC, VTG, HDT, ROT, RPM of each engine, RSA."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from validation.owner_logs.boats import Boat
from validation.owner_logs.formats import earth
from validation.owner_logs.formats.log import Scale, WrittenLog
from validation.owner_logs.instruments import RecordedSignals


def _sentence(body: str) -> str:
    total = 0
    for character in body:
        total ^= ord(character)
    return f"${body}*{total:02X}\r\n"


def _angle(value: float, digits: int, ends: str) -> str:
    whole, minutes = divmod(abs(value) * 60.0, 60.0)
    return f"{int(whole):0{digits}d}{minutes:09.6f},{ends[int(value < 0)]}"


def write(seen: RecordedSignals, boat: Boat, folder: Path, stem: str) -> WrittenLog:
    """Write a burst of sentences with each fix."""
    out, t = [], seen.fixes.t
    lat, lon = earth.geodetic(seen.fixes.values["north"], seen.fixes.values["east"])
    psi = earth.compass_degrees(np.interp(t, seen.compass.t, seen.compass.values["psi"]))
    r = np.degrees(np.interp(t, seen.gyro.t, seen.gyro.values["r"])) * 60.0
    orders = {n: earth.last_values(seen.orders.t, v, t) for n, v in seen.orders.values.items()}
    knots = seen.fixes.values["speed"] / 0.514444
    course = np.degrees(seen.fixes.values["course"]) % 360.0
    engines = [n for n in ("motor", "port", "starboard") if n in orders]
    for i, at in enumerate(t):
        when = datetime.fromtimestamp(earth.EPOCH + at, UTC)
        clock = f"{when:%H%M%S}.{when.microsecond // 10_000:02d}"
        place = f"{_angle(lat[i], 2, 'NS')},{_angle(lon[i], 3, 'EW')}"
        out.append(
            _sentence(f"GPRMC,{clock},A,{place},{knots[i]:.2f},{course[i]:.1f},{when:%d%m%y},,,A")
        )
        out.append(_sentence(f"HEHDT,{psi[i]:.2f},T"))
        out.append(_sentence(f"TIROT,{r[i]:.1f},A"))
        for number, name in enumerate(engines, 1):
            share = orders[name][i]
            revs = np.copysign(abs(share) ** boat.curve, share) * boat.top_rpm
            out.append(_sentence(f"ERRPM,E,{number},{revs:.1f},,A"))
        if "helm" in orders:
            out.append(_sentence(f"IIRSA,{np.degrees(orders['helm'][i]):.1f},A,,V"))
    path = folder / f"{stem}.nmea"
    path.write_text("".join(out), encoding="ascii", newline="")
    scales = {}
    for k, n in enumerate(engines, 1):
        scales[n] = Scale(f"RPM[{k}].shaft", -boat.top_rpm, 0.0, boat.top_rpm)
    most = float(np.degrees(boat.helm_most))
    return WrittenLog(
        path,
        scales
        | ({"helm": Scale("RSA.rudder_starboard", -most, 0.0, most)} if "helm" in orders else {}),
    )
