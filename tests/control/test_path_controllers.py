"""Controllers that follow a path: settings, and closed loops on the linear vessel model."""

from math import cos, inf, nan, pi, sin

import numpy as np
import pytest

from boatsim.control.base import Sense
from boatsim.control.vessel_model import ModelBasedController, VesselModel
from boatsim.errors import BadInput
from boatsim.metrics.docking import Docking
from boatsim.metrics.path_following import PathFollowing
from boatsim.physics.content import load_class
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording
from boatsim.simulate.vessel_model import vessel_model

OTTER = vessel_model(load_vessel("otter"))
OSV = vessel_model(load_vessel("osv"))


def controller(name: str, model: VesselModel, **settings: object) -> ModelBasedController:
    """A controller for a vessel."""
    made: ModelBasedController = load_class("controller", name).from_settings(settings)
    made.use_vessel_model(model)
    return made


def sail(
    made: ModelBasedController,
    model: VesselModel,
    seconds: float,
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    outage: tuple[float, float] = (inf, inf),
) -> np.ndarray:
    """Rows of pose and velocity (n, 6) of the linear vessel model under a controller."""
    place, velocity, rows = np.array(start), np.zeros(3), []
    inverse = np.linalg.inv(model.mass)
    for k in range(round(seconds / made.period)):
        u, v, r = velocity
        t = k * made.period
        fix = [nan, nan] if outage[0] <= t < outage[1] else place[:2]
        sense = Sense(t, place[2], r, 0, 0, u, v, fix[0], fix[1])
        sent = made.step(sense, {})
        force = np.zeros(3)
        for one, drive in zip(model.thrusters, model.drives, strict=True):
            command = sent[drive.thrust]
            thrust = command
            if drive.ahead > 0.0:
                share = drive.ahead if command > 0.0 else drive.astern
                thrust = share * command * abs(command)
            force += drive.gain * thrust * np.array(one.effect(sent.get(drive.angle, 0.0)))
        for _ in range(5):
            h = 0.2 * made.period
            velocity = velocity + h * inverse @ (force - model.damping @ velocity)
            c, s = cos(place[2]), sin(place[2])
            turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
            place = place + h * turn @ velocity
        rows.append([*place, *velocity])
        if made.done:
            break
    return np.array(rows)


def test_los_follows_a_straight_path_at_its_speed_and_ends_the_run() -> None:
    made = controller("los", OTTER, waypoints=[[0.0, 0.0], [60.0, 0.0]], speed=1.0)
    rows = sail(made, OTTER, 200.0, (0.0, 4.0, 0.0))
    assert abs(rows[-1, 1]) < 0.1 and rows[-1, 3] == pytest.approx(1.0, abs=0.02)
    assert made.done and rows[-1, 0] >= 60.0


def test_los_stops_at_the_end_of_its_path_with_its_course() -> None:
    made = controller(
        "los", OTTER, waypoints=[[0.0, 0.0], [40.0, 10.0, 0.5]], path="spline", end="stop"
    )
    rows = sail(made, OTTER, 160.0)
    assert rows[-1, :2] == pytest.approx([40.0, 10.0], abs=0.3)
    assert rows[-1, 2] == pytest.approx(0.5, abs=0.03)
    assert np.abs(rows[-1, 3:]).max() < 0.02 and not made.done


def test_los_goes_on_in_an_outage_of_the_position() -> None:
    made = controller("los", OTTER, waypoints=[[0.0, 0.0], [60.0, 0.0]], speed=1.0)
    rows = sail(made, OTTER, 50.0, (0.0, 1.0, 0.0), outage=(30.0, 40.0))
    assert np.abs(rows[300:, 1]).max() < 0.5 and rows[-1, 3] == pytest.approx(1.0, abs=0.1)


def test_los_needs_no_velocity_sensor() -> None:
    made = controller("los", OTTER, waypoints=[[0.0, 0.0], [60.0, 0.0]], speed=1.0)
    sent = made.step(Sense(0.0, 0, nan, nan, nan, nan, nan, 0.0, 1.0), {})
    assert all(np.isfinite(list(sent.values())))
    sent = made.step(Sense(0.1, 0, nan, nan, nan, nan, nan, 0.0, 1.0), {"speed_mps": 0.5})
    assert sent["n_port_radps"] < sent["n_starboard_radps"]  # it turns to port, towards the path


def test_dock_arrives_with_the_heading_of_the_berth() -> None:
    made = controller(
        "dock", OSV, waypoints=[[60.0, 20.0], [90.0, 60.0]], berth_heading=0.3, align=40.0,
        period=1.0, wave_frequency=0.785, speed=0.8,
    )  # fmt: skip
    rows = sail(made, OSV, 500.0)
    assert rows[-1, :2] == pytest.approx([90.0, 60.0], abs=0.5)
    assert rows[-1, 2] == pytest.approx(0.3, abs=0.02)
    assert {"reference_course_rad", "along_track_m"} <= set(made.estimates())


@pytest.mark.parametrize(
    ("name", "settings", "message"),
    [
        ("los", {"waypoints": [[0.0, 0.0]]}, "at least 2"),
        ("los", {"waypoints": [[0.0, 0.0], [0.0, 0.0]]}, "equal"),
        ("los", {"waypoints": [[0.0, 0.0], [1.0]]}, "waypoint 2 has 1 number"),
        ("los", {"waypoints": [0.0, 1.0]}, "list of points"),
        ("los", {"waypoints": [["a", 1.0]]}, "list of points"),
        ("los", {"path": "splin"}, "did you mean 'spline'"),
        ("los", {"law": "integra"}, "did you mean 'integral'"),
        ("los", {"end": "stopp"}, "did you mean 'stop'"),
        ("los", {"lookahead": 0.0}, "look-ahead"),
    ],
)
def test_wrong_settings_are_refused(name: str, settings: dict[str, object], message: str) -> None:
    with pytest.raises(BadInput, match=message):
        controller(name, OTTER, **settings)


def test_a_path_without_waypoints_or_position_is_refused() -> None:
    with pytest.raises(BadInput, match="at least 1"):
        sail(controller("dock", OSV), OSV, 2.0)
    made = controller("los", OTTER, waypoints=[[0.0, 0.0], [9.0, 0.0]])
    with pytest.raises(BadInput, match="position_sd"):
        made.step(Sense(0.0, 0, 0, 0, 0, 0, 0, nan, nan), {})


def test_cross_track_metrics_are_those_of_the_true_position() -> None:
    t = np.arange(5.0)
    signals = {
        "x_m": np.zeros(5), "y_m": np.array([0.0, 1.0, 2.0, 2.0, 1.0]), "psi_rad": np.full(5, 0.1),
        "u_mps": np.ones(5), "v_mps": np.zeros(5), "reference_x_m": np.zeros(5),
        "reference_y_m": np.zeros(5), "reference_course_rad": np.full(5, pi),
    }  # fmt: skip
    log = Recording("log", t, signals)
    found = PathFollowing(since=1.0).values(log)
    assert found["cross_track_max"] == pytest.approx(2.0)
    assert found["cross_track_end"] == pytest.approx(-1.0)  # east is to port of a southward path
    assert found["cross_track_rms"] == pytest.approx((10.0 / 4.0) ** 0.5)
    berth = Docking(y=2.0, psi=0.0).values(log)
    assert berth["berth_distance"] == pytest.approx(1.0)
    assert berth["berth_heading"] == pytest.approx(np.degrees(0.1))
    del signals["reference_x_m"]
    with pytest.raises(BadInput, match="reference_x_m"):
        PathFollowing().values(Recording("log", t, signals))
