"""The errors of a vessel that keeps its velocities, by which sets of recordings are compared."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from boatsim.diagnosis.free_runs import FreeRun
from validation.real import torque_pendulum
from validation.real.figures import error_rows, velocities_held


def recording(signals: dict[str, int], coordinates: int) -> Any:
    return SimpleNamespace(
        signals=tuple(signals),
        codes=np.array(list(signals.values())),
        program=SimpleNamespace(module=SimpleNamespace(NQ=coordinates)),
    )


def test_constant_speed_and_yaw_rate_make_a_circle() -> None:
    """A vessel of 2 m/s that turns at 0.1 rad/s keeps 20 m from the centre to starboard."""
    mapped = recording({"x_m": 0, "y_m": 1, "psi_rad": 2, "r_radps": 5}, 3)
    psi, t = 0.5, 7.0 + np.linspace(0.0, 60.0, 61)
    state = np.array([3.0, -4.0, psi, 2.0, 0.0, 0.1])
    held = velocities_held(mapped, state, t)
    assert held.keys() == {"x_m", "y_m", "psi_rad"}
    centre = np.array([3.0 - 20.0 * np.sin(psi), -4.0 + 20.0 * np.cos(psi)])
    off = np.hypot(held["x_m"] - centre[0], held["y_m"] - centre[1])
    assert off == pytest.approx(np.full(len(t), 20.0), rel=1e-12)
    along = np.hypot(np.diff(held["x_m"]), np.diff(held["y_m"]))
    assert along == pytest.approx(np.full(60, 40.0 * np.sin(0.05)), rel=1e-9)
    assert held["psi_rad"] == pytest.approx(psi + 0.1 * (t - 7.0), rel=1e-12)


def test_other_coordinates_keep_their_rates() -> None:
    mapped = recording({"phi_rad": 0}, 1)
    held = velocities_held(mapped, np.array([0.2, -0.3]), np.array([1.0, 3.0]))
    assert held["phi_rad"] == pytest.approx([0.2, -0.4])


def test_medians_over_windows_make_a_row_with_velocities_held(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Windows in which nothing moves do not count; the median of the others is printed."""
    t = np.linspace(0.0, 1.0, 11)

    def window(moved: float, off: float) -> FreeRun:
        recorded = {"phi_rad": moved * t}
        channels = {"recorded": recorded}
        for k, model in enumerate(torque_pendulum.COMPARED):
            channels[model] = {"phi_rad": recorded["phi_rad"] + (k + 1) * off}
        return FreeRun("run", 0.0, t, channels)

    windows = [window(1.0, 0.1), window(2.0, 0.3), window(3.0, 0.2), window(0.0, 9.0)]
    monkeypatch.setattr(torque_pendulum, "compared_free_runs", lambda *_: windows)
    none: Any = None
    medians = torque_pendulum.median_errors(none, [], 1.0)
    assert list(medians.values()) == pytest.approx([0.2, 0.4, 0.6, 0.8])
    rows = error_rows("1 s", {"roll": medians}, {"roll": ("roll [rad]", 1.0)})
    assert rows == [["roll [rad], 1 s", "0.20", "0.40", "0.60", "0.80", "1.33"]]
