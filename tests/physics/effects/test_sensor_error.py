"""One mechanism for errors of single channels: its closed form, kinematics, and the effects with a
name of their own, which are its special cases."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from boatsim.errors import BadInput
from boatsim.physics import content, vessel
from boatsim.physics.base import MeasuredMotion
from boatsim.physics.effects.camera_scale import CameraScale
from boatsim.physics.effects.heading_deviation import HeadingOffset
from boatsim.physics.effects.late_fixes import LateFixes
from boatsim.physics.effects.roll_offset import RollOffset
from boatsim.physics.effects.sensor_error import SensorError, YawRateOffset
from boatsim.physics.recorded_channels import CHANNELS
from boatsim.physics.signals import POSE

TRUE = MeasuredMotion(
    x=1.2, y=-0.7, z=0.4, phi=0.1, theta=-0.2, psi=0.8, u=0.5, v=-0.2, w=0.1, p=0.3, q=0.15, r=0.25
)
BOAT = vessel.load_vessel("trial_boat")


def shown(effect: Any, m: MeasuredMotion, t: float = 0.0) -> MeasuredMotion:
    effect = effect.with_all_parameters(BOAT)
    time = (t,) if type(effect).uses_time else ()
    return MeasuredMotion(*type(effect).apply_measurement_error(m, *time, effect.values()))


@pytest.mark.parametrize("channel", CHANNELS)
def test_an_error_changes_its_channel_by_the_stated_formula_and_no_other(channel: str) -> None:
    effect = SensorError(channel=channel, gain_fraction=0.1, offset=0.03, drift=-0.002)
    seen, at = shown(effect, TRUE, t=20.0), CHANNELS.index(channel)
    assert seen[at] == pytest.approx(1.1 * TRUE[at] + 0.03 - 0.04, abs=1e-15)
    assert np.delete(seen, at).tolist() == np.delete(TRUE, at).tolist()


def test_named_effects_are_special_cases_number_for_number() -> None:
    along = shown(SensorError(channel="x_m", gain_fraction=0.07), TRUE)
    assert shown(SensorError(channel="y_m", gain_fraction=-0.03), along) == shown(
        CameraScale(x_fraction=0.07, y_fraction=-0.03), TRUE
    )
    assert shown(SensorError(channel="phi_rad", offset=0.04), TRUE) == shown(
        RollOffset(offset=0.04), TRUE
    )
    late = shown(SensorError(channel="x_m", delay=0.3), TRUE)
    assert shown(SensorError(channel="y_m", delay=0.3), late) == shown(LateFixes(latency=0.3), TRUE)
    turned = shown(HeadingOffset(offset=0.06), TRUE)
    assert shown(SensorError(channel="psi_rad", offset=0.06), TRUE).psi == turned.psi
    assert shown(SensorError(channel="r_radps", offset=0.02), TRUE) == shown(
        YawRateOffset(offset=0.02), TRUE
    )


def test_a_delayed_channel_has_the_value_of_a_moment_ago() -> None:
    """Rotation matrices carry the hull back by the delay; the error is of second order."""
    dt = 1e-5
    turn = Rotation.from_euler("ZYX", [TRUE.psi, TRUE.theta, TRUE.phi])
    before = turn * Rotation.from_rotvec(-dt * np.array([TRUE.p, TRUE.q, TRUE.r]))
    _, theta, phi = before.as_euler("ZYX")
    _, _, z = np.array(TRUE[:3]) - dt * turn.apply([TRUE.u, TRUE.v, TRUE.w])
    for channel, was in (("theta_rad", theta), ("phi_rad", phi), ("z_m", z)):
        at = CHANNELS.index(channel)
        seen = shown(SensorError(channel=channel, delay=dt), TRUE)[at]
        assert (TRUE[at] - seen) / dt == pytest.approx((TRUE[at] - was) / dt, rel=1e-4), channel
    level = TRUE._replace(phi=0.0, theta=0.0)
    x, y, _ = np.array(TRUE[:3]) - dt * Rotation.from_euler("z", TRUE.psi).apply(
        [TRUE.u, TRUE.v, 0.0]
    )
    for channel, was in (("x_m", x), ("y_m", y), ("psi_rad", TRUE.psi - dt * TRUE.r)):
        at = CHANNELS.index(channel)
        seen = shown(SensorError(channel=channel, delay=dt), level)[at]
        assert (level[at] - seen) / dt == pytest.approx((level[at] - was) / dt, rel=1e-4), channel


def test_a_channel_that_does_not_exist_and_a_delay_of_a_velocity_are_refused() -> None:
    with pytest.raises(BadInput, match="channel 'yaw_radps' does not exist"):
        SensorError(channel="yaw_radps")
    with pytest.raises(BadInput, match="channel 'u_mps' does not exist"):
        YawRateOffset(channel="u_mps")
    for channel in set(CHANNELS) - set(POSE):
        with pytest.raises(BadInput, match="delay = 0.1 s"):
            SensorError(channel=channel, delay=0.1)


def test_a_special_case_has_one_free_parameter_in_the_unit_of_its_channel() -> None:
    units = {"mps": "m/s", "radps": "rad/s", "rad": "rad", "m": "m"}
    found = 0
    for name in content.shipped_content_names("effect"):
        kind = content.load_class("effect", name)
        if not issubclass(kind, SensorError) or kind is SensorError:
            continue
        found += 1
        (key,) = [n for n, p in kind.params().items() if p.fit]
        unit = units[kind.column.rpartition("_")[2]]
        drift = f"{unit}^2" if unit.endswith("/s") else f"{unit}/s"
        wanted = {"gain_fraction": "", "offset": unit, "delay": "s", "drift": drift}
        assert kind.params()[key].unit == wanted[key] and kind().channel == kind.column, name
        assert name.endswith({"gain_fraction": "gain"}.get(key, key))
    assert found == 31
