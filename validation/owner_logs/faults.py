"""Possible faults of a log, the formats in which they occur, and their accepted names."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from validation.owner_logs.boats import Boat, Rng
from validation.owner_logs.formats import earth
from validation.owner_logs.formats.tables import Columns
from validation.owner_logs.instruments import RecordedSignals, Series

PLAIN = ("plain.csv", "plain.parquet")
ROS = ("mcap", "ros1", "ros2")
MIRROR = (
    "mirrored",
    "thrusters_exchanged",
    "rudder_reversed",
    "rudder_sense",
)  # these cannot be distinguished on any boat


@dataclass(frozen=True)
class Fault:
    """One fault.

    It has hooks for the instruments' values, for a table in boatsim's own names, and for the way of
    driving.
    """

    named: tuple[str, ...]  # findings of `boatsim check`
    entries: tuple[str, ...] = ()  # equivalent effects of the library that are "not physics"
    seen: Callable[[RecordedSignals, Boat, Rng], RecordedSignals] | None = None
    columns: Callable[[Columns, Boat], Columns] | None = None
    formats: tuple[str, ...] = ()  # the only formats with this fault; empty: any
    without: tuple[str, ...] = ()  # manoeuvres that are omitted
    limit: float = 1.0
    ned: bool = False  # ROS messages in boatsim's axes
    mendable: bool = True  # whether a line of recording.toml can correct it
    blind: bool = False  # no cause can be identified with it
    fits: Callable[[Boat], bool] = lambda boat: True


def _has_two_drives(boat: Boat) -> bool:
    return len(boat.plant.propellers) == 2 and not boat.helm_most


def _exchange_commands(seen: RecordedSignals, boat: Boat, rng: Rng) -> RecordedSignals:
    v = seen.orders.values
    return replace(seen, orders=seen.orders.having(port=v["starboard"], starboard=v["port"]))


def _reverse_helm(seen: RecordedSignals, boat: Boat, rng: Rng) -> RecordedSignals:
    return replace(seen, orders=seen.orders.having(helm=-seen.orders.values["helm"]))


def _rotate_heading(seen: RecordedSignals, boat: Boat, rng: Rng) -> RecordedSignals:
    off = np.radians(rng.choice([90.0, -90.0, 180.0, 45.0, -35.0]))
    return replace(seen, compass=seen.compass.having(psi=seen.compass.values["psi"] + off))


def _hold_positions(seen: RecordedSignals, boat: Boat, rng: Rng) -> RecordedSignals:
    t = seen.fixes.t
    rows = np.searchsorted(t, np.floor(t + 1e-6) - 1e-6)
    return replace(seen, fixes=Series(t, {n: v[rows] for n, v in seen.fixes.values.items()}))


def _replace_positions(
    seen: RecordedSignals, north: np.ndarray, east: np.ndarray
) -> RecordedSignals:
    v = seen.fixes.values
    return replace(seen, fixes=seen.fixes.having(north=v["north"] + north, east=v["east"] + east))


def _positions_in_bursts(seen: RecordedSignals, boat: Boat, rng: Rng) -> RecordedSignals:
    t = seen.fixes.t
    off = np.zeros(len(t))
    for begin in rng.uniform(0.1, 0.9, 3) * t[-1]:
        off[(t >= begin) & (t < begin + rng.uniform(0.5, 1.5))] = (
            rng.uniform(1.0, 3.0) * boat.length
        )
    return _replace_positions(seen, off, -0.7 * off)


def _add_position_jump(seen: RecordedSignals, boat: Boat, rng: Rng) -> RecordedSignals:
    behind = (seen.fixes.t > rng.uniform(0.4, 0.7) * seen.fixes.t[-1]) * 1.0
    size = rng.uniform(1.5, 3.0) * boat.length
    return _replace_positions(seen, size * behind, 0.5 * size * behind)


def _column_fault(**made: Callable[[Columns], np.ndarray]) -> Callable[[Columns, Boat], Columns]:
    return lambda columns, boat: columns | {n: f(columns) for n, f in made.items()}


def _positions_in_degrees(columns: Columns, boat: Boat) -> Columns:
    lat, lon = earth.geodetic(columns["x_m"], columns["y_m"])
    return columns | {"x_m": np.round(lat, 8), "y_m": np.round(lon, 8)}


def _commands_in_percent(columns: Columns, boat: Boat) -> Columns:
    pairs = zip(boat.channels, boat.stated, strict=True)
    return columns | {c: np.round(100.0 * columns[c] / full, 1) for c, full in pairs}


def _interpolate_gaps(columns: Columns, boat: Boat) -> Columns:
    made, count = dict(columns), len(columns["t_s"])
    for name in ("x_m", "y_m", "psi_rad"):
        values = columns[name].copy()
        for share in (0.12, 0.3, 0.6, 0.85):
            begin = round(share * count)
            values[begin : begin + 15] = np.linspace(values[begin], values[begin + 14], 15)
        made[name] = values
    return made


def _repeat_times(columns: Columns, boat: Boat) -> Columns:
    t = columns["t_s"].copy()
    t[50::60] = t[49::60][: len(t[50::60])]
    return columns | {"t_s": t}


FAULTS: dict[str, Fault] = {
    "thrusters exchanged": Fault(MIRROR, seen=_exchange_commands, fits=_has_two_drives),
    "helm to the other side": Fault(MIRROR, seen=_reverse_helm, fits=lambda b: b.helm_most > 0.0),
    "heading turned": Fault(
        ("heading_turned", "heading_from_east"), ("heading_offset",), seen=_rotate_heading
    ),
    "position held": Fault(
        ("position_held",), ("late_fixes",), seen=_hold_positions, mendable=False
    ),
    "outliers in bursts": Fault(
        ("outliers", "position_leaps"), seen=_positions_in_bursts, mendable=False
    ),
    "position leaps": Fault(("position_leaps",), seen=_add_position_jump),
    "ROS in axes of NED": Fault(MIRROR, ned=True, formats=ROS),
    "y to port": Fault(
        ("y_to_port",), columns=_column_fault(y_m=lambda c: -c["y_m"]), formats=PLAIN
    ),
    "y and heading to port": Fault(
        MIRROR,
        columns=_column_fault(y_m=lambda c: -c["y_m"], psi_rad=lambda c: -c["psi_rad"]),
        formats=PLAIN,
    ),
    "ENU for NED": Fault(
        MIRROR,
        columns=_column_fault(
            x_m=lambda c: c["y_m"],
            y_m=lambda c: c["x_m"],
            psi_rad=lambda c: np.pi / 2 - c["psi_rad"],
        ),
        formats=PLAIN,
    ),
    "heading from east": Fault(
        ("heading_from_east",),
        columns=_column_fault(psi_rad=lambda c: np.pi / 2 - c["psi_rad"]),
        formats=PLAIN,
    ),
    "heading in degrees": Fault(
        ("heading_in_degrees",),
        columns=_column_fault(psi_rad=lambda c: np.round(np.degrees(c["psi_rad"]) % 360.0, 2)),
        formats=PLAIN,
    ),
    "latitude as metres": Fault(
        ("latitude_as_metres",), columns=_positions_in_degrees, formats=PLAIN
    ),
    "orders in per cent": Fault(("command_unit",), columns=_commands_in_percent, formats=PLAIN),
    "time in ms": Fault(
        ("time_unit",), columns=_column_fault(t_s=lambda c: 1000.0 * c["t_s"]), formats=PLAIN
    ),
    "gaps bridged": Fault(("bridged",), columns=_interpolate_gaps, formats=PLAIN, mendable=False),
    "clock stalls": Fault(
        ("clock_stalls",), columns=_repeat_times, formats=PLAIN, mendable=False, blind=True
    ),
    "never turned": Fault(
        ("never_turned",),
        without=("zigzag", "turn", "weave", "drift", "astern"),
        mendable=False,
        blind=True,
    ),
    "always flat out": Fault(
        ("saturated", "one_speed"),
        limit=9.0,
        without=("stop", "astern", "drift"),
        mendable=False,
        blind=True,
    ),
}
"""Every fault of the rehearsal, by what a person would call it."""
