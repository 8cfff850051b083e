"""Recordings leave as Arrow tables and data frames with their units, and are shown as figures and
as replays that cannot harm the page around them."""

import re
import sys
from html import unescape

import numpy as np
import pyarrow as pa
import pytest
from chrome import PROGRAM, chromium

from boatsim.errors import BadInput
from boatsim.recordings.notebook.replay import MOST_FRAMES, Track, replay_frame, track_of
from boatsim.recordings.table import Notes, Recording, SignalMissing, read

NAUGHTY = "</script><script>alert('x')</script>\"><img src=x onerror=alert(1)>"


def circle(rows: int = 500) -> Recording:
    """A turn to starboard, with a camera that sees every eighth row."""
    t = np.linspace(0.0, 10.0, rows)
    psi = 0.35 * t
    pose = {"x_m": 5.0 * np.sin(psi), "y_m": 5.0 - 5.0 * np.cos(psi), "psi_rad": psi}
    seen = {"camera_x_m": np.where(np.arange(rows) % 8 == 0, pose["x_m"], np.nan)}
    more = {"r_radps": 0.35 + 0 * t, "thrust_N": 40.0 + 0 * t, "pwm": 120.0 + 0 * t}
    return Recording("circle", t, {**pose, **more, **seen}, Notes(vessel="otter", load=("light",)))


def page_of(frame: str) -> str:
    """The page within a frame."""
    found = re.search(r'srcdoc="([^"]*)"', frame)
    assert found
    return unescape(found[1])


# Arrow and pandas
# ------------------------------------------------------------------------------------------------


def test_a_reader_of_arrow_gets_the_columns_of_the_file_with_their_units():
    run = circle()
    table = pa.table(run)
    assert table.column_names == ["t_s", *run.signals]
    for name in table.column_names:
        ours = run.t if name == "t_s" else run[name]
        np.testing.assert_array_equal(table[name].to_numpy(), ours)
    units = {field.name: field.metadata[b"unit"].decode() for field in table.schema}
    assert units["t_s"] == "s" and units["psi_rad"] == "rad" and units["r_radps"] == "rad/s"
    assert units["thrust_N"] == "N" and units["pwm"] == ""
    assert table.schema.metadata == {b"name": b"circle", b"vessel": b"otter", b"load": b"light"}


def test_a_missing_measurement_is_null_so_that_a_mean_leaves_it_out():
    table = pa.table(circle(400))
    assert table["camera_x_m"].null_count == 350 and table["x_m"].null_count == 0


def test_a_stream_of_arrow_can_be_read_batch_by_batch():
    reader = pa.RecordBatchReader.from_stream(circle())
    assert sum(batch.num_rows for batch in reader) == 500


def test_a_table_of_arrow_written_as_parquet_is_a_recording_again(tmp_path):
    from pyarrow import parquet

    run = circle()
    parquet.write_table(pa.table(run), tmp_path / "run.parquet")
    again = read(tmp_path / "run.parquet")
    for name, values in run.signals.items():
        np.testing.assert_array_equal(again[name], values, err_msg=name)


def test_a_data_frame_has_the_columns_and_knows_their_units():
    run = circle()
    frame = run.to_pandas()
    assert list(frame.columns) == ["t_s", *run.signals] and len(frame) == len(run)
    np.testing.assert_array_equal(frame["camera_x_m"], run["camera_x_m"])
    assert frame.attrs["units"]["psi_rad"] == "rad" and "pwm" not in frame.attrs["units"]
    assert frame.attrs["vessel"] == "otter"


@pytest.mark.parametrize(
    ("library", "call"), [("pandas", "to_pandas"), ("matplotlib", "plot")], ids=str
)
def test_a_missing_library_is_named_with_the_line_that_installs_it(library, call, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(
        BadInput, match=rf'^\w+ needs {library}: pip install "boatsim\[notebook\]"$'
    ):
        getattr(circle(), call)()


# Figures
# ------------------------------------------------------------------------------------------------


def test_a_figure_shows_the_track_from_above_and_angles_in_degrees():
    run = circle()
    track, *panels = run.plot().axes
    (line,) = track.lines
    np.testing.assert_array_equal(line.get_xdata(), run["y_m"])
    np.testing.assert_array_equal(line.get_ydata(), run["x_m"])
    assert track.get_xlabel() == "y, east or starboard [m]" and track.get_aspect() == 1.0
    shown = {axes.get_ylabel(): axes.lines[0].get_ydata() for axes in panels}
    np.testing.assert_allclose(shown["heading psi [deg]"], np.degrees(run["psi_rad"]))
    np.testing.assert_allclose(shown["yaw rate r [deg/s]"], np.degrees(run["r_radps"]))
    assert panels[-1].get_xlabel() == "time [s]"
    assert not any("camera" in label for label in shown)


def test_selected_signals_are_drawn_and_a_wrong_name_is_answered_with_the_nearest():
    run = circle()
    _, panel = run.plot(["camera_x_m"]).axes
    assert panel.get_ylabel() == "camera x [m]"
    assert run.plot("camera_x_m").axes[1].get_ylabel() == "camera x [m]"
    with pytest.raises(SignalMissing, match="did you mean 'psi_rad'"):
        run.plot(["psi_radd"])


def test_a_figure_is_not_shown_a_second_time_by_the_notebook():
    from matplotlib import pyplot

    before = pyplot.get_fignums()
    circle().plot()
    assert pyplot.get_fignums() == before


# The replay
# ------------------------------------------------------------------------------------------------


def test_a_recording_without_a_position_is_a_table_only():
    run = circle()
    shown = Recording("roll", run.t, {"phi_rad": run["psi_rad"]})._repr_html_()
    assert "<iframe" not in shown and "phi_rad" in shown


def test_the_names_in_a_recording_can_not_become_markup():
    run = circle()
    naughty = Recording(NAUGHTY, run.t, {**run.signals, NAUGHTY: run.t}, Notes(vessel=NAUGHTY))
    shown = naughty._repr_html_()
    outside = re.sub(r'srcdoc="[^"]*"', "", shown)
    for text in (outside, page_of(shown)):
        assert "<img" not in text and "</script><script>" not in text
    assert outside.count("<script") == 0 and page_of(shown).count("<script") == 1


def test_a_replay_is_isolated_small_and_loads_nothing():
    t = np.linspace(0.0, 3600.0, 180_000)
    x, y = 1e3 * np.sin(1e-2 * t), 1e3 * np.cos(1e-3 * t)
    tracks = [Track(f"boat {i}", "#123456", t, x + i, y, 0.01 * t).thinned() for i in range(4)]
    frame = replay_frame("four boats", tracks)
    assert 'sandbox="allow-scripts"' in frame and len(frame) < 60_000
    addresses = set(re.findall(r"https?://[^\"' <]*", page_of(frame)))
    assert not addresses and "src=" not in page_of(frame) and "@import" not in page_of(frame)


def test_a_thinned_track_keeps_both_ends_and_every_place_at_which_it_begins_again():
    t = np.concatenate([np.linspace(5 * i, 5 * i + 5, 2000) for i in range(3)])
    x = np.concatenate([np.linspace(i, i + 3, 2000) for i in range(3)])
    track = Track("a", "#123456", t, x, 0 * t, None).thinned()
    assert MOST_FRAMES <= len(track.t) < MOST_FRAMES + 5
    assert track.x[0] == x[0] and track.x[-1] == x[-1]
    (path,) = re.findall(r'class="track"[^>]* d="([^"]*)"', page_of(replay_frame("a", [track])))
    assert path.count("M") == 3


def test_rows_without_a_position_are_left_out_of_a_track():
    run = circle()
    gaps = {"x_m": run["camera_x_m"], "y_m": run["y_m"], "psi_rad": run["psi_rad"]}
    track = track_of("camera", "#123456", run.t, gaps)
    assert track is not None and len(track.t) == 63 and np.isfinite(track.x).all()
    nowhere = dict.fromkeys(("x_m", "y_m"), np.full(len(run), np.nan))
    assert track_of("camera", "#123456", run.t, nowhere) is None


@pytest.mark.skipif(PROGRAM is None, reason="no browser")
def test_the_boat_of_a_replay_follows_its_track_and_turns_clockwise(tmp_path):
    """A quarter turn to starboard: at its end the bow points to the right, to the east."""
    t = np.linspace(0.0, 10.0, 101)
    psi = np.pi / 2 * t / 10.0
    signals = {"x_m": 5.0 * np.sin(psi), "y_m": 5.0 - 5.0 * np.cos(psi), "psi_rad": psi}
    run = Recording("quarter", t, signals)
    (tmp_path / "replay.html").write_text(page_of(run._repr_html_()), encoding="utf-8")
    corners = (
        "document.querySelector('.hull').getAttribute('d').slice(1, -1).split('L')"
        ".map(corner => corner.split(' ').map(Number))"
    )
    with chromium() as opened:
        page = opened((tmp_path / "replay.html").as_uri())
        begin = np.array(page.run(corners))
        page.run(
            "slider.value = slider.max; slider.dispatchEvent(new Event('input')); output.textContent"
        )
        end = np.array(page.run(corners))
        words = page.run("output.textContent")
    bow, middle = begin[0], begin.mean(axis=0)
    assert abs(bow[0] - middle[0]) < 1.0 and bow[1] < middle[1]  # up
    bow, middle = end[0], end.mean(axis=0)
    assert bow[0] > middle[0] and abs(bow[1] - middle[1]) < 1.0  # right
    moved = end.mean(axis=0) - begin.mean(axis=0)
    assert moved[0] > 0.0 > moved[1]  # east and north
    assert words == "10.0 s, heading 90.0 deg"
