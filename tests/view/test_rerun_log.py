"""Logs of runs: read back they are the recording, however they ended, and they open laid out."""

import subprocess
from dataclasses import replace

import numpy as np
import pytest
from rerun.chunk import RrdReader

from boatsim.errors import BadInput
from boatsim.recordings.readers.rrd import last_time
from boatsim.recordings.table import Recording, read, write_csv
from boatsim.view import blueprint, rerun_log, rrd_index, water
from boatsim.view.rerun_command import rerun_command
from boatsim.view.rerun_log import RerunLog, metrics_table, write_diagnosis_log
from boatsim.view.rrd_index import add_index
from boatsim.view.scene import Thruster, plain_scene, scene_from_model

PORT = Thruster("port", -0.5, -0.19, "actual_thrust_port_N", "actual_steer_port_rad")
SCENE = replace(plain_scene(1.2, 0.3, (1.5, 3.0, 0.0, 0.0)), thrusters=(PORT,))


def circle(seconds: float = 10.0) -> Recording:
    """A turn to starboard with all kinds of columns a run has."""
    t = np.round(0.02 * np.arange(round(seconds / 0.02) + 1), 10)
    psi = 0.35 * t + 17.0
    pose = {"x_m": 0.5 * np.sin(0.35 * t), "y_m": 0.5 - 0.5 * np.cos(0.35 * t), "psi_rad": psi}
    rates = {
        "u_mps": 0.175 + 1e-7 * t,
        "v_mps": 0 * t,
        "r_radps": 0.35 + 0 * t,
        "reference_u_mps": 0.18 + 0 * t,
    }
    thrust = {
        "thrust_port_N": 1.0 / 3.0 + 0 * t,
        "actual_thrust_port_N": 0.3 + 0 * t,
        "actual_steer_port_rad": 0.2 + 0 * t,
    }
    seen = {f"camera_{n}": np.where(np.arange(len(t)) % 8 == 0, pose[n], np.nan) for n in pose}
    rest = {"sensed_u_mps": np.full(len(t), np.nan), "force_X_N": np.cos(t), "force_Y_N": np.sin(t)}
    bounds = {
        "estimate_d_N": np.sin(t),
        "estimate_d_N_low": -2.0 + 0 * t,
        "estimate_d_N_high": 2.0 + 0 * t,
    }
    return Recording("circle", t, {**pose, **rates, **thrust, **seen, **rest, **bounds})


def pieces(run: Recording, rows: int = 50) -> list[Recording]:
    return [
        Recording(
            run.name, run.t[i : i + rows], {n: v[i : i + rows] for n, v in run.signals.items()}
        )
        for i in range(0, len(run), rows)
    ]


def entities(path) -> dict[str, int]:
    """Entity -> rows logged in time; what is there all the time has none."""
    rows: dict[str, int] = {}
    for chunk in RrdReader(path).stream():
        name = chunk.entity_path.strip("/")
        rows[name] = rows.get(name, 0) + (0 if chunk.is_static else chunk.num_rows)
    return rows


@pytest.fixture
def logged(tmp_path):
    with RerunLog(tmp_path / "run.rrd", SCENE) as log:
        for piece in pieces(circle()):
            log.add_rows(piece)
        metric = {
            "value": 0.5,
            "unit": "m",
            "published": 0.4,
            "guard": [0.3, None],
            "ok": True,
        }
        log.finish({"norms": {"moved": metric}})
    return tmp_path / "run.rrd"


def test_what_is_read_back_is_the_recording_and_its_csv(logged, tmp_path):
    run = circle()
    write_csv(run, tmp_path / "recording.csv")
    for again in (read(logged), read(tmp_path / "recording.csv")):
        np.testing.assert_allclose(again.t, run.t, atol=1e-9, rtol=0)
        assert again.signals.keys() == run.signals.keys()
        for name, values in run.signals.items():
            np.testing.assert_allclose(
                again[name], values, atol=1e-9, rtol=0, equal_nan=True, err_msg=name
            )


def test_a_log_opens_laid_out_with_scene_plots_and_norms(logged):
    assert len(RrdReader(logged).blueprints()) == 1
    rows = entities(logged)
    assert rows["world/boat"] == rows["signals/x_m"] == len(circle())
    assert rows["world/camera"] == 63  # every eighth row
    assert {
        "world/boat/hull/hull",
        "world/boat/thrust_port",
        "world/boat/force",
        "world/tank/walls",
        "norms",
    } <= rows.keys()
    assert last_time(logged) == pytest.approx(10.0)


def test_the_path_has_no_gap_between_two_pieces(tmp_path):
    lines = []
    for size in (37, 10_000):
        with RerunLog(tmp_path / f"{size}.rrd", SCENE) as log:
            for piece in pieces(circle(60.0), size):
                log.add_rows(piece)
        lines.append(entities(tmp_path / f"{size}.rrd")["world/path"])
    assert lines[1] == 600  # one line for each 0.1 s
    assert lines[0] >= 600


@pytest.mark.slow
def test_an_interrupted_run_keeps_what_it_logged(tmp_path):
    with pytest.raises(KeyboardInterrupt), RerunLog(tmp_path / "run.rrd", SCENE) as log:
        for piece in pieces(circle())[:4]:
            log.add_rows(piece)
        raise KeyboardInterrupt
    again = read(tmp_path / "run.rrd")
    np.testing.assert_array_equal(again["y_m"], circle()["y_m"][:200])


def test_heading_is_clockwise_and_roll_is_starboard_down():
    """SNAME to z-up: (x, y) -> (x, -y), a turn to starboard lowers the picture's angle, roll lowers
    what is at -y."""
    quarter = np.array([np.pi / 2])
    x, y, z, w = rerun_log._attitude_quaternions(quarter, np.zeros(1))[0]
    assert (x, y, z, w) == pytest.approx((0, 0, -np.sqrt(0.5), np.sqrt(0.5)))
    x, y, z, w = rerun_log._attitude_quaternions(np.zeros(1), np.array([0.2]))[0]
    starboard = 2 * (y * z + w * x) * -1.0  # height of a point at (0, -1, 0)
    assert starboard == pytest.approx(-np.sin(0.2))
    np.testing.assert_array_equal(
        rerun_log._picture_points(np.ones(1), np.ones(1)), [[1.0, -1.0, 0.0]]
    )


@pytest.mark.parametrize("content", [b"", b"RRF2", b"no log of ours at all " * 20])
def test_a_file_that_is_no_log_gets_one_line(tmp_path, content):
    (tmp_path / "bad.rrd").write_bytes(content)
    with pytest.raises(BadInput, match=r"bad.rrd: cannot be read as .rrd") as caught:
        read(tmp_path / "bad.rrd")
    assert "\n" not in str(caught.value)


def test_the_log_of_a_diagnosis_has_all_boats_the_missing_force_and_what_was_flagged(tmp_path):
    run = circle()
    pose = Recording("x", run.t, {n: run[n] for n in ("x_m", "y_m", "psi_rad")})
    force = np.sin(run.t)
    missing = Recording(
        "m", run.t, {"force_X_N": force, "force_X_N_low": force - 1, "force_X_N_high": force + 1}
    )
    boats = dict.fromkeys(("recording", "before", "retuned", "corrected"), [pose])
    flagged = [{"run": "run", "from_s": 2.0, "to_s": 3.0, "axis": "surge"}]
    write_diagnosis_log(tmp_path / "diagnosis.rrd", boats, missing, flagged, SCENE)
    rows = entities(tmp_path / "diagnosis.rrd")
    assert {f"world/boats/{boat}" for boat in boats} | {
        f"world/paths/{boat}" for boat in boats
    } <= rows.keys()
    assert {
        "missing/force_X_N",
        "missing/force_X_N_low",
        "missing/force_X_N_flagged",
    } <= rows.keys()
    assert len(RrdReader(tmp_path / "diagnosis.rrd").blueprints()) == 1
    with pytest.raises(BadInput, match="is not the log of a boatsim run"):
        read(tmp_path / "diagnosis.rrd")


def test_between_two_free_runs_nothing_is_drawn(tmp_path):
    """The second starts where the recording is, at the time at which the first ends a metre beside
    it."""
    t = np.arange(0.0, 3.01, 0.1)
    first = Recording("patched", t, {"x_m": 0.1 * t, "y_m": t / 3.0})
    second = Recording("patched", t + 3.0, {"x_m": 0.1 * t + 0.3, "y_m": 0 * t})
    whole = Recording(
        "recording",
        np.append(t, t[1:] + 3.0),
        {n: np.zeros(2 * len(t) - 1) for n in ("x_m", "y_m")},
    )
    write_diagnosis_log(
        tmp_path / "d.rrd", {"recording": [whole], "corrected": [first, second]}, None, [], SCENE
    )
    lines, curve = [], {}
    for chunk in RrdReader(tmp_path / "d.rrd").stream():
        batch, name = chunk.to_record_batch(), chunk.entity_path.strip("/")
        if name == "world/paths/corrected" and not chunk.is_static:
            lines += [
                strip for row in batch.column("LineStrips3D:strips").to_pylist() for strip in row
            ]
        if name == "signals/corrected/y_m" and not chunk.is_static:
            times = batch.column("sim_time").cast("int64").to_pylist()
            curve |= dict(zip(times, batch.column("Scalars:scalars").to_pylist(), strict=True))
    assert len(lines) == 2 * (len(t) - 1)
    assert max(np.linalg.norm(np.subtract(b, a)) for a, b in lines) < 0.05
    values = np.array([curve[k][0] for k in sorted(curve)])
    assert len(values) == 2 * len(t) + 1 and np.flatnonzero(np.isnan(values)).tolist() == [len(t)]
    assert values[len(t) - 1] == pytest.approx(1.0) and values[len(t) + 1] == 0.0


def test_a_boat_of_which_few_places_are_known_has_a_path_through_them(tmp_path):
    t = np.arange(0.0, 3.01, 0.1)
    seen = {
        n: np.where(np.arange(len(t)) % 10 == 0, t * k, np.nan)
        for n, k in (("x_m", 0.1), ("y_m", 1.0))
    }
    boats = {"recording": [Recording("recording", t, seen)], "corrected": [track_of(1.0)]}
    write_diagnosis_log(tmp_path / "d.rrd", boats, None, [], SCENE)
    rows = entities(tmp_path / "d.rrd")
    assert rows["world/paths/recording"] == 3 and rows["world/boats/recording"] == 4


def test_the_outline_is_that_of_the_hull_from_above():
    ring = SCENE.hull_outline()
    np.testing.assert_array_equal(ring[0], ring[-1])
    x, y = ring.T
    assert 0.5 * abs(np.dot(x[:-1], y[1:]) - np.dot(y[:-1], x[1:])) == pytest.approx(
        0.875 * 1.2 * 0.3
    )


def test_without_a_file_and_a_viewer_there_is_nothing_to_do():
    with RerunLog(None, SCENE) as log:
        log.add_rows(circle())
        log.finish({"norms": {}})
    assert not log.stream.has_receiver


def test_the_scene_of_a_vessel_has_its_hull_and_a_thruster_on_each_side():
    from boatsim.physics import vessel
    from boatsim.simulate import world
    from boatsim.simulate.tank import Tank

    boat, tank = vessel.load_vessel("trial_boat"), Tank(length=8.0, width=6.0)
    scene = scene_from_model(world.build_model(boat, tank), boat, tank)
    hull = np.concatenate([solid.vertices for solid in scene.solids if solid.part == "hull"])
    assert np.ptp(hull[:, 0]) == pytest.approx(boat.length, rel=0.1)
    assert {thruster.name: np.sign(thruster.y) for thruster in scene.thrusters} == {
        "port": -1,
        "starboard": 1,
    }
    assert all(solid.triangles.max() < len(solid.vertices) for solid in scene.solids)


def test_every_closed_shape_has_its_outside_outside():
    """Volume by the divergence theorem: positive only if all triangles are wound outwards, and of
    the right size."""

    def volume(vertices, triangles):
        a, b, c = (vertices[triangles[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0

    from boatsim.view.scene import _surface_of_revolution

    brick = _surface_of_revolution(
        [(0.0, -1.0), (2**0.5, -1.0), (2**0.5, 1.0), (0.0, 1.0)], 4, np.pi / 4
    )
    assert volume(*brick) == pytest.approx(8.0)
    barrel = _surface_of_revolution([(0.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0)], 256)
    assert volume(*barrel) == pytest.approx(2 * np.pi, rel=1e-3)
    (hull,) = SCENE.solids
    assert volume(hull.vertices, hull.triangles) == pytest.approx(0.875 * 1.2 * 0.3 * 0.13 * 1.2)


def track_of(size: float, aside: float = 0.0) -> Recording:
    t = np.linspace(0.0, 10.0, 101)
    return Recording(
        "a", t, {"x_m": 0.1 * size * t, "y_m": 0.05 * size * t + aside, "psi_rad": 0 * t}
    )


@pytest.mark.parametrize("size", [0.3, 5.0, 400.0])
def test_boats_are_as_large_as_the_track_asks_for_and_all_of_it_lies_in_view_on_water(size):
    from boatsim.physics import vessel

    boat = vessel.load_vessel("trial_boat")
    boats = {
        "recording": [track_of(size)],
        "before": [track_of(1e4 * size)],
        "corrected": [track_of(size, 0.2 * size)],
    }
    scene = water.comparison_scene(boat, boats)
    hull = np.concatenate([s.vertices for s in scene.solids if s.part == "hull"])
    sea = np.concatenate([s.vertices for s in scene.solids if s.part == "tank"])
    assert (
        np.ptp(hull[:, 0]) == pytest.approx(scene.times * boat.length, rel=0.1)
        and scene.times >= 1.0
    )
    assert scene.length >= 0.99 * water.SMALLEST * size and scene.times == pytest.approx(
        max(1.0, 0.08 * size / boat.length)
    )
    length, width, x, y = scene.tank
    for run in (*boats["recording"], *boats["corrected"]):
        assert np.abs(run["x_m"] - x).max() + scene.length <= 0.501 * length + 0.5 * scene.length
        assert np.abs(run["y_m"] - y).max() + scene.length <= 0.501 * width + 0.5 * scene.length
    assert length < 3 * size + 5 * scene.length, "the nominal boat that runs away is not followed"
    assert (sea[:, 0].min(), sea[:, 0].max()) <= (x - length, x + length) and sea[
        :, 1
    ].max() >= -y + width


def test_a_boat_that_goes_nowhere_is_drawn_at_its_size():
    from boatsim.physics import vessel

    t = np.linspace(0.0, 5.0, 20)
    scene = water.comparison_scene(
        vessel.load_vessel("kvlcc2_roll"),
        {"recording": [Recording("a", t, {"phi_rad": 0.1 * np.sin(t)})]},
    )
    assert scene.times == 1.0 and scene.tank[2:] == (0.0, 0.0)


def test_norms_are_told_with_what_was_published_and_whether_the_bar_is_met():
    table = metrics_table(
        {
            "moved": {
                "value": 0.51234,
                "unit": "m",
                "published": 0.4,
                "verdict": "not reproduced",
                "guard": [0.3, None],
                "ok": True,
            },
            "rate": {
                "value": -2.0,
                "unit": "rad/s",
                "published": None,
                "verdict": None,
                "guard": [-1.0, 1.0],
                "ok": False,
            },
            "free": {
                "value": None,
                "unit": None,
                "kind": "largest",
                "lacking": "too short",
                "published": None,
                "guard": None,
                "ok": None,
            },
        }
    )
    assert "| moved |  | 0.5123 m | at least 0.3 | yes | 0.4 (differs) |" in table
    assert "| rate |  | -2 rad/s | -1 to 1 | **no** |  |" in table
    assert "| free | largest | too short |  |  |  |" in table and "no metrics" in metrics_table({})


def test_a_legend_says_the_unit():
    assert blueprint.legend_text("actual_thrust_port_N") == "actual thrust port [N]"
    assert blueprint.legend_text("estimate_d_N_low") == "estimate d low [N]"
    assert blueprint.legend_text("pwm_port") == "pwm port"


# The index at the end of a file, which rerun's own check asks for
# ------------------------------------------------------------------------------------------------


def verified(path) -> bool:
    """Whether `rerun rrd verify` accepts a file."""
    command = [*rerun_command(), "rrd", "verify", str(path)]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def test_rerun_accepts_the_log_of_a_run(logged):
    assert verified(logged)
    assert [f.name for f in logged.parent.iterdir()] == ["run.rrd"]


def test_rerun_accepts_the_log_of_an_interrupted_run(tmp_path):
    with pytest.raises(KeyboardInterrupt), RerunLog(tmp_path / "run.rrd", SCENE) as log:
        for piece in pieces(circle())[:4]:
            log.add_rows(piece)
        raise KeyboardInterrupt
    assert verified(tmp_path / "run.rrd")


def test_rerun_accepts_the_log_of_a_diagnosis(tmp_path):
    run = circle()
    write_diagnosis_log(tmp_path / "d.rrd", {"recording": [run], "before": [run]}, None, [], SCENE)
    assert verified(tmp_path / "d.rrd")


@pytest.mark.slow
def test_a_log_of_which_the_writer_was_killed_can_be_read_and_gets_its_index_from_rerun(tmp_path):
    log = RerunLog(tmp_path / "run.rrd", SCENE)
    for piece in pieces(circle()):
        log.add_rows(piece)
    log._write()  # and no more: the process is killed
    killed = tmp_path / "killed.rrd"
    killed.write_bytes((tmp_path / "run.rrd").read_bytes())
    assert not verified(killed)
    assert add_index(killed) and verified(killed)
    np.testing.assert_array_equal(read(killed)["y_m"], circle()["y_m"])
    log.close()


def test_a_file_that_rerun_can_not_index_stays_as_it_was(tmp_path, monkeypatch):
    broken = tmp_path / "broken.rrd"
    broken.write_bytes(b"no log of ours at all")
    assert not add_index(broken)
    monkeypatch.setattr(rrd_index, "MAX_BYTES", 10)
    assert not add_index(broken)
    assert broken.read_bytes() == b"no log of ours at all"
    assert [f.name for f in tmp_path.iterdir()] == ["broken.rrd"]
