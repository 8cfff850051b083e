"""Excitation and drift of waves from a table: values between its points, and sums over waves."""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from boatsim.errors import BadInput
from boatsim.physics.base import Array, make_motion
from boatsim.physics.coefficients.excitation_grid import (
    excitation_force,
    excitation_grid,
    mean_drift_force,
)
from boatsim.physics.coefficients.files import (
    read_coefficients,
    read_wave_loads,
    write_coefficients,
)
from boatsim.physics.coefficients.table import WaveLoads
from boatsim.physics.coefficients.wave_grid import over_headings
from boatsim.physics.effects.panel_wave_loads import PanelWaveLoads
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hydrodynamics"


def complex_loads(frequency: float, toward: float) -> Array:
    """Complex amplitudes (6,) of the wrench of a wave of unit amplitude."""
    own = PanelWaveLoads(
        coefficients=str(OTTER),
        spectrum="regular",
        significant_height=2.0,
        modal_period=2.0 * pi / frequency,
        toward=toward,
        depth=0.0,
    )
    start = np.array(own.wrench(make_motion(t=0.0)))
    later = np.array(own.wrench(make_motion(t=0.5 * pi / frequency)))
    return np.asarray(start - 1j * later)


@pytest.mark.slow
def test_loads_between_the_points_of_the_table_are_those_of_a_spline() -> None:
    found = read_coefficients(OTTER)
    largest = np.abs(found.excitation).max(axis=(0, 1))
    spline = CubicSpline(found.frequency, found.excitation)
    for frequency in (1.9, 3.3, 5.05):
        for heading in (0.31, 1.0, 1.83, 2.7):
            exact = CubicSpline(found.heading, spline(frequency))(heading)
            error = np.abs(complex_loads(frequency, heading) - exact)
            assert np.all(error < 0.01 * largest)


def test_heave_force_of_long_waves_is_the_buoyancy_of_the_elevation() -> None:
    found = read_coefficients(OTTER)
    force = complex_loads(0.6 * found.frequency[0], 0.5 * pi)
    assert force[2].real == pytest.approx(-found.restoring[2, 2], rel=0.1)


def test_waves_shorter_than_those_of_the_table_exert_no_force() -> None:
    assert not complex_loads(12.0, 1.0).any()


def test_sea_of_another_depth_is_refused() -> None:
    table = {"use": "panel_wave_loads", "coefficients": str(OTTER), "depth": 5.0}
    with pytest.raises(BadInput, match="the coefficients hold for 0 m"):
        load_vessel("otter").with_effect(table)


def drift_alone(sea: PanelWaveLoads, t: float) -> Array:
    """Drift of a sea: its wrench (6,) less that without drift, at a place away from the origin."""
    m = make_motion(t=t, x=1.7, y=-0.6, psi=0.4)
    return np.array(replace(sea, drift=1.0).wrench(m)) - np.array(replace(sea, drift=0.0).wrench(m))


def test_drift_of_a_regular_wave_is_constant_and_that_of_the_table() -> None:
    found = read_coefficients(OTTER)
    assert found.drift is not None
    own = PanelWaveLoads(
        coefficients=str(OTTER),
        spectrum="regular",
        significant_height=0.6,
        modal_period=2.0 * pi / float(found.frequency[-1]),
        toward=float(found.heading[3]) + 0.4,
        depth=0.0,
    )
    expected = np.zeros(6)
    expected[[0, 1, 5]] = 0.3**2 * found.drift[-1, 3]
    size = np.abs(expected).max()
    for t in (0.0, 0.3, 5.1):
        assert drift_alone(own, t) == pytest.approx(expected, abs=1e-6 * size)


def sea_of_two_systems() -> PanelWaveLoads:
    """A short-crested sea of few waves."""
    return PanelWaveLoads(
        coefficients=str(OTTER),
        significant_height=0.3,
        modal_period=1.6,
        toward=1.1,
        spreading=2.0,
        components=12.0,
        depth=0.0,
    )


def wave_drifts(sea: PanelWaveLoads) -> Array:
    """Mean drift (N, 3) of each wave of a sea with unit amplitude, on a hull with yaw 0.4 rad."""
    field = sea.wave_field()
    assert field is not None
    table, rows = np.array([*sea.table(), 0.0]), []
    for w, direction in zip(field.frequency, field.direction, strict=True):
        own = direction - 0.4
        rows.append(mean_drift_force(w, np.cos(own), np.sin(own), table, np.int64(0)))
    return np.array(rows)


def test_drift_is_newmans_sum_over_pairs_of_waves() -> None:
    sea = sea_of_two_systems()
    field = sea.wave_field()
    assert field is not None
    single = wave_drifts(sea)
    for t in (0.0, 4.3):
        run = 1.7 * np.cos(field.direction) - 0.6 * np.sin(field.direction)
        theta = field.frequency * t - field.wave_number * run + field.phase
        expected = np.zeros(3)
        for i in range(len(field)):
            for k in range(len(field)):
                pair = 0.5 * (single[i] + single[k]) * np.cos(theta[i] - theta[k])
                expected += field.amplitude[i] * field.amplitude[k] * pair
        found = drift_alone(sea, t)
        assert found[[0, 1, 5]] == pytest.approx(expected, rel=1e-9)
        assert not found[2:5].any()


@pytest.mark.slow
def test_mean_of_the_drift_is_the_sum_of_the_mean_drifts_of_all_waves() -> None:
    sea = sea_of_two_systems()
    field = sea.wave_field()
    assert field is not None
    times = np.arange(0.0, 4000.0, 1.6)
    found = np.mean([drift_alone(sea, float(t))[[0, 1, 5]] for t in times], axis=0)
    expected = field.amplitude**2 @ wave_drifts(sea)
    assert found == pytest.approx(expected, rel=0.02)


def test_drift_agrees_in_mujoco_compiled_engine_and_batch() -> None:
    table = {
        "use": "panel_wave_loads",
        "coefficients": str(OTTER),
        "significant_height": 0.3,
        "modal_period": 1.6,
        "toward": 1.2,
        "components": 40.0,
        "drift": 1.0,
    }
    vessel = load_vessel("otter").with_effect(table)
    states = []
    for kind in (OpenWater, Engine):
        engine = kind(vessel, step=0.02)
        engine.advance(200)
        states.append(np.array(engine.state[1:]))
    assert states[1] == pytest.approx(states[0], rel=1e-9, abs=1e-12)
    batch = Batch(vessel, 2, step=0.02)
    batch.advance(steps=200)
    assert batch.states[1] == pytest.approx(states[0], rel=1e-9, abs=1e-12)
    calm = OpenWater(load_vessel("otter").with_effect(table | {"drift": 0.0}), step=0.02)
    calm.advance(200)
    assert abs(calm.state.y - states[0][1]) > 1e-3  # the drift moves the vessel


def test_drift_without_its_table_is_refused(tmp_path: Path) -> None:
    write_coefficients(tmp_path / "copy", replace(read_coefficients(OTTER), drift=None))
    table = {"use": "panel_wave_loads", "coefficients": str(tmp_path / "copy"), "drift": 1.0}
    with pytest.raises(BadInput, match="drift = 1; .* has no drift.csv"):
        load_vessel("otter").with_effect(table)
    load_vessel("otter").with_effect(table | {"drift": 0.0})


def table_of_long_hull(highest: float) -> WaveLoads:
    """Loads of waves on two ends 246 m apart, whose sum and difference vary fast with frequency."""
    frequency = np.append(np.linspace(0.05, 1.2, 50), np.arange(1.7, highest, 0.5))
    heading = np.linspace(0.0, pi, 19)
    return WaveLoads("two ends", 0.0, frequency, heading, load_of_ends(frequency, heading))


def load_of_ends(frequency: Array, heading: Array) -> Array:
    """Complex loads (N, H, 6): a force on each end, less in short waves."""
    number = frequency**2 / 9.80665
    size = np.exp(-10.0 * number)[:, None]
    turn = 123.0 * number[:, None] * np.cos(heading)
    loads = np.zeros((len(frequency), len(heading), 6), dtype=complex)
    loads[..., 2] = -size * np.cos(turn)
    loads[..., 4] = -1j * 123.0 * size * np.sin(turn)
    return loads


@pytest.mark.parametrize("highest", [1.25, 6.0])
def test_a_table_down_to_short_waves_is_as_fine_as_one_of_long_waves(highest: float) -> None:
    found = table_of_long_hull(highest)
    exact = CubicSpline(found.frequency, found.excitation)
    table = np.array([*excitation_grid(found, "two ends"), 0.0])
    largest = np.abs(found.excitation).max(axis=(0, 1))
    for w in np.linspace(0.2, 1.1, 37):
        for h in (0, 9, 18):
            ahead, across = np.cos(found.heading[h]), np.sin(found.heading[h])
            place = (w, ahead, across)
            real = np.array(excitation_force(*place, 1.0, 0.0, table, np.int64(0)))
            imaginary = np.array(excitation_force(*place, 0.0, -1.0, table, np.int64(0)))
            error = np.abs(real + 1j * imaginary - exact(w)[h])
            assert np.all(error <= 0.01 * largest)


def test_loads_at_headings_of_the_table_are_those_of_the_table() -> None:
    # headings every 10 degrees, of which every second is no multiple of a 24th of pi
    found = table_of_long_hull(1.25)
    table = np.array([*excitation_grid(found, "two ends"), 0.0])
    largest = np.abs(found.excitation).max(axis=(0, 1))
    for k in (20, 40, 49):
        for h, heading in enumerate(found.heading):
            place = (found.frequency[k], np.cos(heading), np.sin(heading))
            real = np.array(excitation_force(*place, 1.0, 0.0, table, np.int64(0)))
            imaginary = np.array(excitation_force(*place, 0.0, -1.0, table, np.int64(0)))
            error = np.abs(real + 1j * imaginary - found.excitation[k, h])
            assert np.all(error <= 0.01 * largest)


def test_loads_of_the_otter_between_its_headings_are_those_of_a_spline() -> None:
    found = read_wave_loads(OTTER)
    grid = np.array([*excitation_grid(found, "otter"), 0.0])
    largest = np.abs(found.excitation).max(axis=(0, 1))
    mirror = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    spline = over_headings(found.heading, found.excitation, mirror)
    for heading in np.radians(np.arange(1.25, 180.0, 2.5)):
        exact = spline(heading)
        for k in range(0, len(found.frequency), 4):
            place = (found.frequency[k], np.cos(heading), np.sin(heading))
            real = np.array(excitation_force(*place, 1.0, 0.0, grid, np.int64(0)))
            imaginary = np.array(excitation_force(*place, 0.0, -1.0, grid, np.int64(0)))
            assert np.all(np.abs(real + 1j * imaginary - exact[k]) <= 0.01 * largest)


def test_a_table_of_a_small_hull_keeps_a_small_grid() -> None:
    count, headings = excitation_grid(read_wave_loads(OTTER), "otter")[2:4]
    assert count == 96.0 and headings <= 37.0


def test_a_narrow_peak_of_the_mean_drift_is_on_the_grid() -> None:
    # a resonance between two frequencies of the coarsest grid and next to none halfway
    found = table_of_long_hull(1.25)
    coarse = np.linspace(found.frequency[0], found.frequency[-1], 96)
    peak = coarse[40] + 0.25 * (coarse[41] - coarse[40])
    width = 0.2 * (coarse[41] - coarse[40])
    frequency = np.sort(np.append(found.frequency, peak + width * np.array([-1.0, 0.0, 1.0])))
    drift = np.full((len(frequency), len(found.heading), 3), 0.1)
    drift[frequency == peak] = 1.0
    loads = load_of_ends(frequency, found.heading)
    resonant = replace(found, frequency=frequency, excitation=loads, drift=drift)
    table = np.array([*excitation_grid(resonant, "resonant"), 0.0])
    assert mean_drift_force(peak, 1.0, 0.0, table, np.int64(0))[0] > 0.7


def test_an_axis_of_rounding_does_not_enlarge_the_grid() -> None:
    found = read_wave_loads(OTTER)
    noise = np.random.default_rng(3).normal(size=found.excitation.shape[:2])
    loads = found.excitation.copy()
    loads[..., 1] = 1e-6 * noise * np.abs(loads[..., 0]).max()
    noisy = replace(found, excitation=loads)
    assert excitation_grid(noisy, "noisy")[2:4] <= (96.0, 37.0)
