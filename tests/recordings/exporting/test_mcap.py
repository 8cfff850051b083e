"""Recordings as MCAP: standard messages in the axes of ROS, which our own importer and another
program's reader read back to the same numbers."""

import subprocess
import sys
from collections import Counter

import numpy as np
import pytest
from mcap.reader import make_reader
from scipy.spatial.transform import Rotation

import boatsim
from boatsim.cli.exporting import export_recording
from boatsim.errors import BadInput
from boatsim.recordings.exporting.mcap import write_mcap
from boatsim.recordings.exporting.ros_axes import ros_orientation, ros_position, ros_vector
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import open_log
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.table import Notes, Recording, read, write_csv
from boatsim.view.rerun_command import rerun_command

# north, east, down -> east, north, up; forward, starboard, down <-> forward, port, up
ENU_FROM_NED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
BODY = np.diag([1.0, -1.0, -1.0])
# the map that reads an exported recording back, by the rules of docs/logs.md
MAP = {
    "x_m": "/pose.pose.position.y",
    "y_m": "/pose.pose.position.x",
    "z_m": "-/pose.pose.position.z",
    "phi_rad": "/pose.pose.orientation.roll",
    "theta_rad": "-/pose.pose.orientation.pitch",
    "psi_rad": "-/pose.pose.orientation.yaw + 90 * deg",
    "u_mps": "/twist.twist.linear.x",
    "v_mps": "-/twist.twist.linear.y",
    "w_mps": "-/twist.twist.linear.z",
    "p_radps": "/twist.twist.angular.x",
    "q_radps": "-/twist.twist.angular.y",
    "r_radps": "-/twist.twist.angular.z",
    "thrust_port_N": "/commands/thrust_port_N.data",
    "actual_thrust_port_N": "/signals/actual_thrust_port_N.data",
}


def weaving(seconds: float = 20.0) -> Recording:
    """A boat with six degrees of freedom that weaves, heaves, rolls and pitches."""
    t = np.round(0.05 * np.arange(round(seconds / 0.05) + 1), 6)
    signals = {
        "x_m": 1.2 * t,
        "y_m": 3.0 * np.sin(0.4 * t),
        "z_m": 0.1 * np.sin(2.0 * t),
        "phi_rad": 0.3 * np.sin(1.1 * t),
        "theta_rad": 0.2 * np.cos(0.9 * t),
        "psi_rad": 1.2 * np.sin(0.4 * t),
        "u_mps": 1.2 + 0.1 * np.sin(t),
        "v_mps": 0.2 * np.cos(t),
        "w_mps": 0.2 * np.cos(2.0 * t),
        "p_radps": 0.33 * np.cos(1.1 * t),
        "q_radps": -0.18 * np.sin(0.9 * t),
        "r_radps": 0.48 * np.cos(0.4 * t),
        "thrust_port_N": 20.0 + 5.0 * np.sin(0.3 * t),
        "actual_thrust_port_N": 19.0 + 5.0 * np.sin(0.3 * t),
    }
    return Recording("weaving", t, signals, Notes(vessel="otter"))


def messages(path) -> Counter:
    """Topic -> number of messages."""
    with path.open("rb") as file:
        return Counter(channel.topic for _, channel, _ in make_reader(file).iter_messages())


# Axes
# ------------------------------------------------------------------------------------------------


def test_an_orientation_is_the_rotation_from_the_hull_of_ros_to_its_world():
    phi, theta, psi = np.random.default_rng(5).uniform(-1.4, 1.4, (3, 50))
    ned = Rotation.from_euler("ZYX", np.column_stack([psi, theta, phi])).as_matrix()
    found = Rotation.from_quat(ros_orientation(phi, theta, psi)).as_matrix()
    np.testing.assert_allclose(found, ENU_FROM_NED @ ned @ BODY, atol=1e-12)


def test_positions_and_vectors_are_turned_by_the_same_matrices():
    x, y, z = np.random.default_rng(6).normal(size=(3, 20))
    np.testing.assert_array_equal(ros_position(x, y, z).T, ENU_FROM_NED @ [x, y, z])
    np.testing.assert_array_equal(ros_vector(x, y, z).T, BODY @ [x, y, z])


def test_a_boat_that_heads_east_is_not_rotated_and_one_that_heads_north_is_by_90_degrees():
    zero = np.zeros(2)
    east, north = ros_orientation(zero, zero, np.array([np.pi / 2, 0.0]))
    np.testing.assert_allclose(east, [0.0, 0.0, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(north, [0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)], atol=1e-15)


# Files
# ------------------------------------------------------------------------------------------------


def test_our_importer_reads_the_same_numbers_back(tmp_path):
    run = weaving()
    write_mcap(run, tmp_path / "run.mcap")
    log = open_log(tmp_path / "run.mcap")
    again = convert_log(log, parse_map({"columns": MAP}, "map.toml"), "map.toml")
    np.testing.assert_allclose(again.t, run.t, atol=1e-6)
    assert again.signals.keys() == run.signals.keys()
    for name, values in run.signals.items():
        np.testing.assert_allclose(again[name], values, atol=1e-12, err_msg=name)


def test_another_program_finds_no_mistake_and_standard_messages(tmp_path):
    write_mcap(weaving(), tmp_path / "run.mcap")
    command = [*rerun_command(), "mcap", "check", str(tmp_path / "run.mcap")]
    checked = subprocess.run(command, capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout
    with (tmp_path / "run.mcap").open("rb") as file:
        reader = make_reader(file)
        summary = reader.get_summary()
        assert reader.get_header().profile == "ros2"
    kinds = {}
    for channel in summary.channels.values():
        assert channel.message_encoding == "cdr"
        assert summary.schemas[channel.schema_id].encoding == "ros2msg"
        kinds[channel.topic] = summary.schemas[channel.schema_id].name
    assert kinds == {
        "/pose": "geometry_msgs/msg/PoseStamped",
        "/twist": "geometry_msgs/msg/TwistStamped",
        "/tf": "tf2_msgs/msg/TFMessage",
        "/commands/thrust_port_N": "std_msgs/msg/Float64",
        "/signals/actual_thrust_port_N": "std_msgs/msg/Float64",
    }


def test_the_transform_is_the_pose(tmp_path):
    write_mcap(weaving(), tmp_path / "run.mcap")
    log = open_log(tmp_path / "run.mcap").signals
    for pose, place in (("position", "translation"), ("orientation", "rotation")):
        for axis in "xyz":
            np.testing.assert_array_equal(
                log[f"/pose.pose.{pose}.{axis}"].values,
                log[f"/tf.transforms[0].transform.{place}.{axis}"].values,
            )


def test_a_measurement_that_is_missing_in_a_row_is_no_message(tmp_path):
    run = weaving()
    fresh = np.arange(len(run)) % 10 == 0
    for name in ("x_m", "y_m", "psi_rad"):
        run.signals[f"camera_{name}"] = np.where(fresh, run[name], np.nan)
    run.signals["sensed_u_mps"] = np.where(fresh, run["u_mps"], np.nan)
    count = write_mcap(run, tmp_path / "run.mcap")
    found = messages(tmp_path / "run.mcap")
    assert found["/camera/pose"] == found["/signals/sensed_u_mps"] == fresh.sum()
    assert found["/pose"] == found["/twist"] == len(run) and found.total() == count


def test_a_boat_that_only_rolls_has_its_signals_as_numbers(tmp_path):
    run = weaving()
    roll = Recording("roll", run.t, {name: run[name] for name in ("phi_rad", "p_radps")})
    write_mcap(roll, tmp_path / "roll.mcap")
    assert set(messages(tmp_path / "roll.mcap")) == {"/signals/phi_rad", "/signals/p_radps"}
    again = open_log(tmp_path / "roll.mcap").signals["/signals/phi_rad.data"]
    np.testing.assert_array_equal(again.values, run["phi_rad"])


def test_time_stamps_are_those_of_the_recording_and_never_negative(tmp_path):
    run = weaving()
    write_mcap(run, tmp_path / "run.mcap")
    np.testing.assert_allclose(
        open_log(tmp_path / "run.mcap").signals["/pose.pose.position.x"].t, run.t, atol=1e-9
    )
    early = Recording("early", run.t - 3.0, run.signals)
    write_mcap(early, tmp_path / "early.mcap")
    np.testing.assert_allclose(
        open_log(tmp_path / "early.mcap").signals["/pose.pose.position.x"].t, run.t, atol=1e-9
    )


def test_the_command_writes_next_to_the_recording_or_to_the_file_that_is_asked_for(
    tmp_path, capsys
):
    write_csv(weaving(), tmp_path / "run.csv")
    assert export_recording(tmp_path / "run.csv", None, None, []) == 0
    assert export_recording(tmp_path / "run.csv", tmp_path / "a" / "b.mcap", None, []) == 0
    assert "401 rows in 2005 messages" in capsys.readouterr().out
    written = (tmp_path / "run.mcap").read_bytes()
    assert (tmp_path / "a" / "b.mcap").read_bytes() == written
    assert boatsim.export(read(tmp_path / "run.csv"), tmp_path / "c.mcap") == 2005
    assert (tmp_path / "c.mcap").read_bytes() == written


@pytest.mark.parametrize("out", ["run.csv", "run.bag", "run"])
def test_another_suffix_is_refused_before_anything_is_written(tmp_path, out):
    write_csv(weaving(), tmp_path / "run.csv")
    before = (tmp_path / "run.csv").read_bytes()
    with pytest.raises(BadInput, match=r"\.mcap|overwrite"):
        export_recording(tmp_path / "run.csv", tmp_path / out, None, [])
    assert (tmp_path / "run.csv").read_bytes() == before
    assert [f.name for f in tmp_path.iterdir()] == ["run.csv"]


def test_a_missing_library_is_named_with_the_line_that_installs_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rosbags.typesys", None)
    with pytest.raises(BadInput, match=r"pip install 'boatsim\[ros\]'"):
        write_mcap(weaving(), tmp_path / "run.mcap")
    assert not list(tmp_path.iterdir())
