"""Tables with a row for each value give the motion of the boat, each signal at its own times."""

import json
import tomllib
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.long_format import long_format
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.several_logs import open_logs
from boatsim.recordings.logs.table import read
from boatsim.recordings.table import Recording
from tests.recordings.importing.test_owners_tables import (
    COUNT,
    RUN,
    check_motion,
    columns_of_run,
)
from tests.recordings.importing.test_proposal_by_motion import DOF, DRIVES, SPEED_AT_80

CELLS = {name: cells for name, cells in columns_of_run().items() if name != "time"}
UNITS = {"lat": "deg", "lon": "deg", "heading_deg": "deg", "rpm_port": "rpm"}
Row = tuple[float, str, str]  # time [s], name, value


def rows_of_run(late: float = 0.001) -> list[Row]:
    """Time, name and value, each signal a little after the one before."""
    rows = []
    for i in range(COUNT):
        for k, (name, cells) in enumerate(CELLS.items()):
            rows.append((RUN["t"][i] + late * k, name, cells[i]))
    return rows


def imported(file: Path) -> tuple[Recording, str, str]:
    """The recording by the proposed map, its remarks, and the map."""
    log = open_logs([file])
    text = propose_map(log, None, DRIVES, DOF, None, lambda: SPEED_AT_80)
    found = convert_log(log, parse_map(tomllib.loads(text), "map.toml"), "map.toml")
    return found, "\n".join(found.remarks), text


def write(folder: Path, lines: list[str], name: str = "log.csv") -> Path:
    file = folder / name
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def table(folder: Path, rows: list[Row], header: str, separator: str = ",") -> Path:
    lines = [header] if header else []
    for t, name, value in rows:
        lines.append(separator.join((f"{t:.4f}", name, value)))
    return write(folder, lines)


@pytest.mark.parametrize(
    "header", ["time,topic,value", "t,name,val", "timestamp,signal,value", "stamp,tag,reading"]
)
def test_each_signal_becomes_a_column_and_one_line_says_so(tmp_path, header):
    found, remarks, _ = imported(table(tmp_path, rows_of_run(), header))
    check_motion(found)
    name = header.split(",")[1]
    assert f"has a row for each value: column {name} names 5 signals" in remarks
    assert remarks.count("has a row for each value") == 1


def test_a_german_table_with_units_and_decimal_commas_is_read(tmp_path):
    names = dict(
        zip(CELLS, ("Breite", "Länge", "Kurs", "Drehzahl Bb", "Drehzahl Stb"), strict=True)
    )
    lines = ["Zeit;Bezeichnung;Wert;Einheit"]
    for t, name, value in rows_of_run():
        unit = {"lat": "°", "lon": "°", "heading_deg": "Grad"}.get(name, "U/min")
        lines.append(f"{t:.4f};{names[name]};{value};{unit}".replace(".", ","))
    found, _, text = imported(write(tmp_path, lines))
    check_motion(found)
    assert 'n_port_radps = "Drehzahl Bb * rpm"' in text


@pytest.mark.parametrize("newest_first", [False, True])
def test_signals_may_stand_one_after_another(tmp_path, newest_first):
    rows = sorted(rows_of_run(), key=lambda row: (row[1], row[0]))
    if newest_first:
        rows.reverse()
    found, _, _ = imported(table(tmp_path, rows, "time,tag,value"))
    check_motion(found)


def test_a_table_of_a_time_series_database_is_read(tmp_path):
    lines = ["#group,false,false,true", "#datatype,string,long,dateTime:RFC3339"]
    lines += [",result,table,_start,_stop,_time,_value,_field,_measurement,host"]
    order = list(CELLS)
    for t, name, value in sorted(rows_of_run(), key=lambda row: (row[1], row[0])):
        when = datetime.fromtimestamp(round(t, 3), UTC).isoformat(timespec="milliseconds")
        ends = "2023-11-14T22:00:00Z,2023-11-14T23:00:00Z"
        lines.append(f",_result,{order.index(name)},{ends},{when},{value},{name},boat,pi")
    found, _, _ = imported(write(tmp_path, lines))
    check_motion(found)


def test_payloads_of_messages_may_be_objects(tmp_path):
    lines = ["time,topic,payload,qos"]
    for i, t in enumerate(RUN["t"]):
        fix = {"lat": float(CELLS["lat"][i]), "lon": float(CELLS["lon"][i]), "mode": "AUTO"}
        for topic, content in (
            ("gps", fix),
            ("compass", {"heading_deg": float(CELLS["heading_deg"][i])}),
            ("esc", {"rpm_port": CELLS["rpm_port"][i], "rpm_starboard": RUN["starboard"][i]}),
        ):
            payload = json.dumps(content).replace('"', '""')
            lines.append(f'{t:.3f},boat/{topic},"{payload}",0')
    found, remarks, text = imported(write(tmp_path, lines))
    assert found["x_m"] == pytest.approx(RUN["north"] - RUN["north"][0], abs=0.05)
    assert 'latitude = "boat/gps.lat * deg"' in text
    assert "names 5 signals" in remarks


@pytest.mark.parametrize("separator", [",", ";", " "])
def test_a_table_without_a_header_loses_no_row(tmp_path, separator):
    found, remarks, _ = imported(table(tmp_path, rows_of_run(), "", separator))
    check_motion(found)
    assert "has no header" in remarks


def test_the_same_quantity_of_two_devices_is_two_signals(tmp_path):
    lines = ["time,device,quantity,value"]
    for t, name, value in rows_of_run():
        quantity, _, side = name.partition("_")
        device = f"motor_{side}" if quantity == "rpm" else "boat"
        lines.append(f"{t:.4f},{device},{quantity},{value}")
    log = read(write(tmp_path, lines))
    assert {"motor_port.rpm", "motor_starboard.rpm", "boat.lat"} <= log.signals.keys()
    found, _, _ = imported(tmp_path / "log.csv")
    check_motion(found)


def test_numbered_channels_are_signals(tmp_path):
    lines = ["time,channel,value"]
    for t, name, value in rows_of_run():
        lines.append(f"{t:.4f},{list(CELLS).index(name)},{value}")
    log = read(write(tmp_path, lines))
    assert list(log.signals) == [f"channel_{i}" for i in range(5)]
    assert log.signals["channel_2"].values == pytest.approx(np.degrees(RUN["psi"]) % 360.0)


def test_each_signal_keeps_its_own_times(tmp_path):
    rows = [row for i, row in enumerate(rows_of_run()) if i % 25 < 5 or "rpm" not in row[1]]
    turning = [(t + 0.043, "gyro_z", f"{r:.6f}") for t, r in zip(RUN["t"], RUN["r"], strict=True)]
    log = read(table(tmp_path, sorted(rows + turning), "time,name,value"))
    assert len(log.signals["heading_deg"].t) == COUNT
    assert len(log.signals["rpm_port"].t) == COUNT // 5
    assert log.signals["gyro_z"].t == pytest.approx(RUN["t"] + 0.043, abs=1e-3)
    assert log.signals["gyro_z"].values == pytest.approx(RUN["r"], abs=1e-6)


def test_two_messages_of_a_position_are_paired_and_lost_ones_are_empty(tmp_path):
    rng = np.random.default_rng(0)
    rows = []
    for i, (t, name, value) in enumerate(rows_of_run()):
        late = 0.03 * rng.random() if name == "lon" else 0.0
        if name != "lon" or i % 97:
            rows.append((t + late, name, value))
    log = read(table(tmp_path, rows, "time,name,value"))
    lat, lon = log.signals["lat"], log.signals["lon"]
    assert np.array_equal(lat.t, lon.t)
    known = np.isfinite(lon.values)
    assert 0 < (~known).sum() < 10
    assert lon.values[known] == pytest.approx(np.array(CELLS["lon"], float)[known])
    found, _, _ = imported(tmp_path / "log.csv")
    assert np.nanmax(np.abs(found["psi_rad"])) > 0.0 and len(found) > 0.95 * COUNT


def test_whole_seconds_are_spread_over_the_values_of_each_signal(tmp_path):
    rows = [(np.floor(t + 1e-6), name, value) for t, name, value in rows_of_run(0.0)]
    found, _, _ = imported(table(tmp_path, rows, "time,name,value"))
    assert found.t == pytest.approx(RUN["t"] - RUN["t"][0], abs=1e-3)


@pytest.mark.parametrize("is_sorted", [False, True])
@pytest.mark.parametrize(("form", "minute"), [("%H:%M:%S.%f", 59), ("%H%M%S.%f", 58)])
def test_times_of_day_go_on_after_midnight(tmp_path, is_sorted, form, minute):
    begin = datetime(2026, 11, 29, 23, minute, 30, tzinfo=UTC).timestamp()
    rows = rows_of_run(0.0)
    if is_sorted:
        rows.sort(key=lambda row: (row[1], row[0]))
    lines = ["time,name,value"]
    for t, name, value in rows:
        when = datetime.fromtimestamp(round(begin + t - RUN["t"][0], 3), UTC)
        lines.append(f"{when.strftime(form)},{name},{value}")
    found, _, _ = imported(write(tmp_path, lines))
    assert found.t == pytest.approx(RUN["t"] - RUN["t"][0], abs=1e-3)


def test_milliseconds_that_are_called_time_only_are_recognised(tmp_path):
    lines = ["time,name,value"]
    for t, name, value in rows_of_run(0.0):
        lines.append(f"{1000.0 * (t - RUN['t'][0]) + 4321.0:.0f},{name},{value}")
    check_motion(imported(write(tmp_path, lines))[0])


def test_words_repeats_and_cut_rows_are_left_out(tmp_path):
    lines = ["time,name,value"]
    for i, (t, name, value) in enumerate(rows_of_run()):
        lines.append(f"{t:.4f},{name},{value}")
        if i % 50 == 0:
            lines += [f"{t:.4f},mode,AUTO", "time,name,value", lines[-1]]
    lines.append("17000")
    found, remarks, _ = imported(write(tmp_path, lines))
    check_motion(found)
    assert "names 5 signals" in remarks and "the header again" in remarks


def test_rows_without_a_value_are_no_samples(tmp_path):
    rows = []
    for i, (t, name, value) in enumerate(rows_of_run()):
        rows.append((t, name, "" if i % 3 else value))
    log = read(table(tmp_path, rows, "time,name,value"))
    assert np.array_equal(log.signals["lat"].t, log.signals["lon"].t)
    assert np.isfinite(log.signals["lon"].values).sum() == COUNT // 3
    found, _, _ = imported(tmp_path / "log.csv")
    assert np.ptp(found["x_m"][np.isfinite(found["x_m"])]) == pytest.approx(
        np.ptp(RUN["north"]), rel=0.02
    )


def test_a_long_table_without_times_gets_one_line(tmp_path):
    lines = ["name,value", *(f"{name},{value}" for _, name, value in rows_of_run())]
    with pytest.raises(BadInput) as caught:
        read(write(tmp_path, lines))
    assert str(caught.value) == (
        f"{tmp_path / 'log.csv'}: has a row for each value (column name names the signals), but "
        "no column holds their times; call it time"
    )


def test_wrong_times_and_a_name_without_letters_hurt_only_their_rows(tmp_path):
    lines = ["time,name,value"]
    for i, (t, name, value) in enumerate(rows_of_run()):
        lines.append(f"{'-inf' if i == 500 else f'{t:.4f}'},{name},{value}")
        if i % 20 == 0:
            lines.append(f"{t:.4f},??,1")
    log = read(write(tmp_path, lines))
    assert "??" in log.signals
    finite = np.isfinite(log.signals["heading_deg"].values)
    assert finite.sum() >= COUNT - 1
    check_motion_of_most(imported(tmp_path / "log.csv")[0])


def check_motion_of_most(found: Recording) -> None:
    assert len(found) >= COUNT - 1
    assert found.t[-1] == pytest.approx(RUN["t"][-1] - RUN["t"][0], abs=1e-3)


def test_one_time_of_another_epoch_takes_no_memory(tmp_path):
    """A row of the year 1970 in a log of 2023 makes it 53 years long."""
    turning = [(t, "gyro_z", f"{r:.6f}") for t, r in zip(RUN["t"], RUN["r"], strict=True)]
    rows = sorted(rows_of_run(0.0) + turning)
    rows[0] = (0.0, *rows[0][1:])
    log = read(table(tmp_path, rows, "time,name,value"))
    assert "psi_rad" in propose_map(log, None, DRIVES, DOF, None, lambda: SPEED_AT_80)


def test_a_signal_in_two_units_has_none(tmp_path):
    lines = ["time,name,value,unit"]
    for i, (t, name, value) in enumerate(rows_of_run()):
        unit = "rad" if i % 2 else "deg"
        lines.append(f"{t:.4f},{name},{value},{unit if name == 'heading_deg' else ''}")
    log = read(write(tmp_path, lines))
    assert any("heading_deg has values in deg and rad" in text for text in log.remarks)
    assert log.signals["heading_deg"].unit == "deg"  # by its name


@pytest.mark.parametrize("suffix", ["parquet", "pq"])
def test_a_file_of_columns_may_be_long_too(tmp_path, suffix):
    import pyarrow as pa
    from pyarrow import parquet

    rows = rows_of_run()
    columns = {
        "time": pa.array([int(1e6 * t) for t, _, _ in rows], pa.timestamp("us", "UTC")),
        "name": pa.array([name for _, name, _ in rows]).dictionary_encode(),
        "value": [float(value) for _, _, value in rows],
    }
    file = tmp_path / f"log.{suffix}"
    parquet.write_table(pa.table(columns), file)
    check_motion(imported(file)[0])


def test_one_file_for_each_sensor_has_the_name_of_its_rows(tmp_path):
    for name in CELLS:
        lines = ["time,sensor,value"]
        for t, own, value in rows_of_run(0.0):
            if own == name:
                lines.append(f"{t:.4f},{name},{value}")
        write(tmp_path, lines, f"file_{list(CELLS).index(name)}.csv")
    log = open_logs([tmp_path])
    assert set(CELLS) <= log.signals.keys()


WIDE = {
    "a state of the vessel": ("time,mode,heading", "0,AUTO,1 1,AUTO,2 2,MAN,3 3,MAN,4"),
    "vessels of a traffic report": ("time,name,lat,lon", "0,a,1,2 0,b,3,4 1,a,1,2 1,b,3,4"),
    "a value beside others": ("time,fix,x,y", "0,3D,1,2 1,3D,2,3 2,2D,3,4 3,3D,4,5"),
    "texts that hardly repeat": ("time,message,value", "0,a1b,1 1,c2d,2 2,e3f,3 3,g4h,4"),
    "numbers alone": ("time,value,state", "0,1,1 1,2,1 2,3,0 3,4,0"),
}


@pytest.mark.parametrize("name", WIDE)
def test_a_table_with_a_row_for_each_time_stays_one(name):
    header, rows = WIDE[name]
    cells = [row.split(",") for row in rows.split()]
    columns = dict(zip(header.split(","), map(list, zip(*cells, strict=True)), strict=True))
    if name != "texts that hardly repeat":
        columns = {key: values * 20 for key, values in columns.items()}
        columns["time"] = list(map(str, range(80)))
    assert long_format(columns, ",") is None


def test_names_that_no_header_calls_so_need_to_change_from_row_to_row(tmp_path):
    rows = rows_of_run()
    columns = {
        "t": [f"{t:.4f}" for t, _, _ in rows],
        "was": [name for _, name, _ in rows],
        "x1": [value for _, _, value in rows],
    }
    assert long_format(columns, ",").names == ("was",)
    columns["was"] = ["AUTO"] * (len(rows) // 2) + ["MANUAL"] * (len(rows) - len(rows) // 2)
    assert long_format(columns, ",") is None
