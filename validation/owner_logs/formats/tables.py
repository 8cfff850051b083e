"""CSV and Parquet tables of a script, in boatsim's own names and units or in instrument units."""

from pathlib import Path

import numpy as np

from validation.owner_logs.boats import Boat
from validation.owner_logs.formats import earth
from validation.owner_logs.formats.log import Scale, WrittenLog
from validation.owner_logs.instruments import RecordedSignals, drive_names
from validation.owner_logs.sail import Array

Columns = dict[str, Array]


def recording_columns(seen: RecordedSignals, boat: Boat) -> Columns:
    """Return rows at the rate of the fixes, in the names and units of a recording."""
    t = seen.fixes.t
    orders = {n: earth.last_values(seen.orders.t, v, t) for n, v in seen.orders.values.items()}
    thrusts = {}
    drives = zip(drive_names(boat), boat.channels, boat.stated, boat.plant.propellers, strict=True)
    for name, channel, full, propeller in drives:
        back = full * propeller.astern
        thrusts[channel] = np.round(np.where(orders[name] > 0.0, full, back) * orders[name], 2)
    helms = {c: np.round(boat.helm_sign * orders["helm"], 4) for c in boat.helms}
    return {
        "t_s": np.round(t, 3),
        "x_m": np.round(seen.fixes.values["north"], 3),
        "y_m": np.round(seen.fixes.values["east"], 3),
        "psi_rad": np.round(np.interp(t, seen.compass.t, seen.compass.values["psi"]), 4),
        **thrusts,
        **helms,
    }


def instrument_columns(seen: RecordedSignals, boat: Boat) -> tuple[Columns, dict[str, Scale]]:
    """Return rows at 10 Hz: degrees, per cent, knots, each fix held until the next."""
    t = seen.compass.t
    lat, lon = earth.geodetic(seen.fixes.values["north"], seen.fixes.values["east"])
    columns: Columns = {
        "timestamp_s": np.round(earth.EPOCH + t, 3),
        "gps_lat_deg": np.round(earth.last_values(seen.fixes.t, lat, t), 8),
        "gps_lon_deg": np.round(earth.last_values(seen.fixes.t, lon, t), 8),
        "gps_speed_kn": np.round(
            earth.last_values(seen.fixes.t, seen.fixes.values["speed"], t) / 0.514444, 2
        ),
        "heading_deg": np.round(earth.compass_degrees(seen.compass.values["psi"]), 2),
        "yaw_rate_deg_s": np.round(np.degrees(np.interp(t, seen.gyro.t, seen.gyro.values["r"])), 2),
    }
    scales = {}
    for name, share in seen.orders.values.items():
        values = earth.last_values(seen.orders.t, share, t)
        if name == "helm":
            column = "rudder_deg" if boat.plant.rudder else "steering_deg"
            most = np.degrees(boat.helm_most)
            columns[column] = np.round(np.degrees(values), 2)
            scales[name] = Scale(column, -most, 0.0, most)
        else:
            column = f"throttle_{name}_pct" if name != "motor" else "throttle_pct"
            columns[column] = np.round(100.0 * values, 1)
            scales[name] = Scale(column, -100.0, 0.0, 100.0)
    return columns, scales


def write_csv(columns: Columns, path: Path) -> None:
    """As text."""
    rows = zip(*columns.values(), strict=True)
    lines = [
        ",".join(columns),
        *(",".join("" if v != v else f"{v:.12g}" for v in row) for row in rows),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_parquet(columns: Columns, path: Path) -> None:
    """As columns."""
    import pyarrow as pa
    from pyarrow import parquet as pq

    pq.write_table(
        pa.table({n: pa.array(v, type=pa.float64(), from_pandas=True) for n, v in columns.items()}),
        path,
    )


def write(columns: Columns, scales: dict[str, Scale], path: Path) -> WrittenLog:
    """Write the table in the format of its suffix."""
    (write_csv if path.suffix == ".csv" else write_parquet)(columns, path)
    return WrittenLog(path, scales)
