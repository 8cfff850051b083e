"""What a recording shows and the boat did not do: clocks, cameras, compasses, antennas; and forces
without a cause."""

from dataclasses import replace
from itertools import combinations
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long
from real_boat import FURTHER, Real, recorded, waves
from scipy import signal
from scipy.interpolate import CubicSpline

from boatsim.diagnosis import pipeline
from boatsim.physics.base import MeasuredMotion, make_motion
from boatsim.physics.effects.camera_scale import CameraScale
from boatsim.physics.effects.heading_deviation import HeadingDeviation, HeadingOffset
from boatsim.physics.effects.late_fixes import LateFixes
from boatsim.physics.effects.position_frame_error import PositionFrameError
from boatsim.physics.effects.wave_forcing import WaveForcing, law
from boatsim.recordings import table as recording

TRUE = MeasuredMotion(
    x=1.2, y=-0.7, z=0.0, phi=0.1, theta=0.0, psi=0.8, u=0.5, v=-0.2, w=0.0, p=0.0, q=0.0, r=0.3
)


def shown(effect: Any, m: MeasuredMotion) -> MeasuredMotion:
    return MeasuredMotion(*type(effect).apply_measurement_error(m, effect.values()))


def north_east(m: MeasuredMotion) -> tuple[float, float]:
    """Velocity over ground that the shown heading and body speeds stand for."""
    return m.u * cos(m.psi) - m.v * sin(m.psi), m.u * sin(m.psi) + m.v * cos(m.psi)


@pytest.mark.parametrize(
    "effect", [HeadingOffset(offset=0.2), HeadingDeviation(cos=0.1, sin=-0.2)], ids=str
)
def test_a_wrong_heading_leaves_the_velocity_over_ground_as_it_is(effect: Any) -> None:
    assert north_east(shown(effect, TRUE)) == pytest.approx(north_east(TRUE))


@pytest.mark.parametrize(
    "effect", [HeadingDeviation(cos=0.1, sin=-0.2), PositionFrameError(forward=0.3, starboard=0.1)]
)
def test_shown_rates_are_the_derivatives_of_the_shown_pose(effect: Any) -> None:
    def after(dt: float) -> MeasuredMotion:
        """The pose a moment later on a circle."""
        psi = TRUE.psi + TRUE.r * dt
        rate = north_east(TRUE._replace(psi=0.5 * (psi + TRUE.psi)))
        return shown(
            effect, TRUE._replace(x=TRUE.x + rate[0] * dt, y=TRUE.y + rate[1] * dt, psi=psi)
        )

    dt = 1e-4
    now, ahead, behind = shown(effect, TRUE), after(dt), after(-dt)
    assert (ahead.psi - behind.psi) / (2 * dt) == pytest.approx(now.r, rel=1e-6)
    assert ((ahead.x - behind.x) / (2 * dt), (ahead.y - behind.y) / (2 * dt)) == pytest.approx(
        north_east(now), rel=1e-6
    )


def test_camera_scale_stretches_about_the_origin_of_the_tank() -> None:
    seen = shown(CameraScale(x_fraction=0.1, y_fraction=-0.05), TRUE)
    assert (seen.x, seen.y) == pytest.approx((1.32, -0.665)) and seen[2:] == TRUE[2:]


def test_a_realisation_of_waves_has_the_rms_and_the_frequency_it_states_and_independent_axes() -> (
    None
):
    sea = WaveForcing(surge=0.2, sway=0.1, yaw=0.03, frequency=2.0, damping=0.05)
    t = np.arange(0.0, 4000.0, 0.2)
    force = np.array([law(make_motion(t=float(x)), sea.values()) for x in t])[:, [0, 1, 5]]
    assert force.std(axis=0) == pytest.approx([0.2, 0.1, 0.03], rel=0.05)
    for axis in force.T:
        power = np.abs(np.fft.rfft(axis)) ** 2
        omega = 2 * pi * np.fft.rfftfreq(len(t), 0.2)
        median = omega[np.searchsorted(np.cumsum(power), 0.5 * power.sum())]
        assert median == pytest.approx(2.0, rel=0.05)
    for one, other in combinations(force.T, 2):
        assert abs(np.corrcoef(one, other)[0, 1]) < 0.15  # 0.05 is the error over 4000 s
        frequency, coherence = signal.coherence(one, other, fs=5.0, nperseg=512)
        assert (
            coherence[abs(2 * pi * frequency - 2.0) < 0.3].mean() < 0.1
        )  # of 77 half-overlapping parts: 0.02
    assert not np.any(law(make_motion(t=3.0), sea.values()._replace(realisation=0.0)))


def diagnosed(folder: Path, real: Real) -> dict[str, Any]:
    """Answer for three runs of a real boat, the third unseen."""
    files = []
    for seed in (1, 2, 3):
        files.append(folder / f"{seed}.csv")
        recording.write_csv(recorded(real, seed), files[-1])
    return pipeline.diagnose(files[:2], files[2:], "trial_boat", library=FURTHER).findings.answer


@pytest.mark.slow
@pytest.mark.parametrize(
    ("real", "wanted"),
    [
        (Real(scale=(1.06, 0.95)), {"camera_scale": {"x_fraction": 0.06, "y_fraction": -0.05}}),
        long(
            Real(compass=(0.0, 0.1, -0.08)),
            {"heading_deviation": {"cos_rad": 0.1, "sin_rad": -0.08}},
        ),
        (Real(clock=-0.3), {"clock_offset": {"pose_late_s": -0.3}}),
    ],
    ids=lambda case: "" if isinstance(case, Real) else "+".join(case),
)
def test_a_measurement_error_is_named_as_such_and_undone(
    tmp_path: Path, real: Real, wanted: dict[str, Any]
) -> None:
    answer = diagnosed(tmp_path, real)
    assert {e["name"] for e in answer["effects"]} == set(wanted)
    for effect in answer["effects"]:
        assert effect["kind"] == "measurement" and "not physics" in effect["words"]
        for key, true in wanted[effect["name"]].items():
            found = effect["parameters"][key]
            assert abs(found["value"] - true) < 3.5 * found["sd"] and found["sd"] < 0.3 * abs(
                true
            ), key
    rms = answer["fit"]["position_rms_m"]
    assert (
        rms["patched"] < 0.7 * rms["recalibrated"] and rms["patched"] < 0.02
    )  # replays show what the camera shows


@pytest.mark.slow
def test_an_antenna_off_the_mass_centre_and_a_turned_compass_are_told_apart(tmp_path: Path) -> None:
    real = Real(compass=(0.12, 0.0, 0.0), antenna=(0.25, 0.0))
    answer = diagnosed(tmp_path, real)
    found = {e["name"]: e["parameters"] for e in answer["effects"]}
    assert set(found) == {"heading_offset", "position_frame_error"}
    assert found["heading_offset"]["offset_rad"]["value"] == pytest.approx(0.12, abs=0.02)
    assert found["position_frame_error"]["forward_m"]["value"] == pytest.approx(0.25, abs=0.03)


@pytest.mark.slow
def test_fixes_older_than_their_headings_are_named_with_their_age(tmp_path: Path) -> None:
    """Positions of a receiver that takes 0.1 s, beside a compass that takes none."""
    (tmp_path / "recording.toml").write_text('[facts]\nposition_fix = "gnss"\n')
    files = []
    for seed in (1, 2, 3):
        run = recorded(Real(), seed)
        was = np.maximum(run.t - 0.1, run.t[0])
        signals = run.signals | {n: CubicSpline(run.t, run[n])(was) for n in ("x_m", "y_m")}
        files.append(tmp_path / f"{seed}.csv")
        recording.write_csv(replace(run, signals=signals), files[-1])
    answer = pipeline.diagnose(files[:2], files[2:], "trial_boat").findings.answer
    assert answer["verdict"] == "named", answer["sentence"]
    (effect,) = answer["effects"]
    found = effect["parameters"]["latency_s"]
    assert effect["name"] == "late_fixes" and abs(found["value"] - 0.1) < 3.5 * found["sd"] < 0.03


def test_fixes_of_a_steady_turn_are_shown_where_she_was() -> None:
    """On a circle of 2 m at 1 m/s, 0.4 s late: the chord for the arc is off by 1e-3 of it."""
    radius, speed, late = 2.0, 1.0, 0.4
    rate = speed / radius
    now = TRUE._replace(x=0.0, y=0.0, psi=0.3, u=speed, v=0.0, r=rate)
    was = [
        radius * (sin(0.3 - rate * late) - sin(0.3)),
        -radius * (cos(0.3 - rate * late) - cos(0.3)),
    ]
    seen = shown(LateFixes(latency=late), now)
    assert [seen.x, seen.y] == pytest.approx(was, abs=2e-3 * speed * late) and seen[2:] == now[2:]


@pytest.mark.slow
def test_irregular_waves_are_named_with_their_frequency(tmp_path: Path) -> None:
    answer = diagnosed(tmp_path, Real(sea=(0.15, 0.3, 0.05)))
    (effect,) = answer["effects"]
    assert effect["name"] == "wave_forcing" and effect["gain_nats"] > 50.0
    assert effect["parameters"]["frequency_radps"]["value"] == pytest.approx(2.4, abs=0.15)
    recorded_rms = 0.3 * np.std([waves(t)[1] for t in np.arange(0.0, 40.0, 0.1)])
    assert effect["parameters"]["sway_N"]["value"] == pytest.approx(recorded_rms, rel=0.25)
