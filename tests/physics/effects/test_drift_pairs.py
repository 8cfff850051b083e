"""Slow drift by a table of pairs of waves: against the double sum and Newman's approximation."""

from collections.abc import Callable
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.hydrodynamics.wamit import OutputScale, read_wamit
from boatsim.physics.base import Array, make_motion
from boatsim.physics.coefficients.drift_pairs import pair_amplitudes, pair_table, pair_weight
from boatsim.physics.coefficients.files import (
    read_coefficients,
    read_wave_loads,
    write_coefficients,
    write_wave_loads,
)
from boatsim.physics.coefficients.table import DriftPairs, WaveLoads
from boatsim.physics.effects.panel_wave_loads import PanelWaveLoads
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from tests.physics.coefficients.test_output_files import DENSITY, LENGTH, SIGNS, write_wamit

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hydrodynamics"
EVEN = np.array([1.0, 0.0, 1.0, 0.0, 1.0, 0.0])  # axes whose drift has the sign of the mirror
Density = Callable[[Array, Array, Array], Array]


def smooth_drift(first: Array, second: Array, heading: Array) -> Array:
    """Any smooth drift (..., 6) of pairs of waves of one direction, of a symmetric hull.

    Its modulus falls with the difference of the frequencies, and its phase turns with it.
    """
    mean, apart = 0.5 * (first + second), first - second
    size = 30.0 * np.exp(-((apart / 1.5) ** 2)) / (1.0 + np.exp(-2.0 * (mean - 3.5)))
    turned = size * np.exp(0.6j * apart)
    along, across = np.cos(heading), np.sin(heading)
    shapes = (along, 2.0 * across, 0.3 + 0.2 * along, 0.4 * across, 0.1 * along, along * across)
    return np.stack([turned * shape for shape in shapes], axis=-1)


def grid_of(function: Density, frequency: Array, heading: Array) -> DriftPairs:
    """Table of a drift at frequencies and headings."""
    first, second, angle = np.meshgrid(frequency, frequency, heading, indexing="ij")
    return DriftPairs(frequency, heading, function(first, second, angle).astype(complex))


def sea_with(folder: Path, pairs: DriftPairs | None, **more: Any) -> PanelWaveLoads:
    """Effect of a sea whose hull has the drift of pairs, written to a folder and read again."""
    found = replace(read_coefficients(OTTER), drift_pairs=pairs)
    write_coefficients(folder, found)
    sea = {"significant_height": 0.3, "modal_period": 1.7, "toward": 1.1, "components": 24.0}
    return PanelWaveLoads(coefficients=str(folder), depth=0.0, **{**sea, **more})


def drift_alone(sea: PanelWaveLoads, t: float, psi: float) -> Array:
    """Drift of a sea: its wrench (6,) less that without drift, at a place away from the origin."""
    m = make_motion(t=t, x=1.7, y=-0.6, psi=psi)
    return np.array(replace(sea, drift=1.0).wrench(m)) - np.array(replace(sea, drift=0.0).wrench(m))


def phases(sea: PanelWaveLoads, t: float) -> tuple[Array, Array, Array, Array]:
    """Amplitudes, frequencies, directions and phases (N,) of the waves at the place."""
    field = sea.wave_field()
    assert field is not None
    run = 1.7 * np.cos(field.direction) - 0.6 * np.sin(field.direction)
    theta = field.frequency * t - field.wave_number * run + field.phase
    return field.amplitude, field.frequency, field.direction, theta


class TwoEnds:
    """Drift of a hull that reflects waves at its two ends.

    The phase between two waves differs from end to end by (k_1 - k_2) L cos(heading).
    """

    def __init__(self, length: float, peak: float, width: float) -> None:
        """Set the length [m], the frequency from which it reflects and the width of the ridge."""
        self.length, self.peak, self.width = length, peak, width

    def __call__(self, first: Array, second: Array, heading: Array) -> Array:
        """Complex drift (..., 6) of pairs of waves."""
        apart = (first**2 - second**2) / 9.80665  # of the wave numbers [1/m]
        size = np.exp(-(((first - second) / self.width) ** 2))
        for w in (first, second):
            size = size / np.sqrt(1.0 + np.exp(-6.0 * (w - self.peak) / self.peak))
        along, across = np.cos(heading), np.sin(heading)
        turn = 0.5j * self.length * apart * along
        bow, stern = size * np.exp(-turn), size * np.exp(turn)
        surge = 0.5 * (1.0 + along) * stern - 0.5 * (1.0 - along) * bow
        sway, lever = 0.5 * across * (bow + stern), 0.25 * self.length
        yaw = lever * across * (bow - stern + size * along)
        heave, pitch = 0.15 * (bow + stern), 0.05 * self.length * (bow - stern)
        return np.stack([surge, sway, heave, 0.1 * sway, pitch, yaw], axis=-1)


def degrees(step: int) -> Array:
    """Headings from 0 to 180 degrees [rad]."""
    return np.radians(np.arange(0.0, 180.5, step))


SHORT_HULL = TwoEnds(1.2, 7.0, 2.0)
SHIP = TwoEnds(246.0, 0.5, 0.15)
SHIP_FAR_APART = TwoEnds(246.0, 0.5, 1.0)  # with drift of waves of quite different frequencies


@pytest.mark.parametrize("psi", [0.4, -2.9])
@pytest.mark.parametrize(
    ("drift", "frequency", "heading", "period"),
    [
        (smooth_drift, np.linspace(1.2, 8.0, 30), degrees(15), 1.7),
        (SHORT_HULL, np.linspace(2.0, 12.0, 40), degrees(10), 0.9),
        pytest.param(SHIP, np.linspace(0.05, 1.2, 60), degrees(10), 9.0, marks=pytest.mark.slow),
        pytest.param(
            SHIP_FAR_APART, np.linspace(0.05, 1.2, 60), degrees(5), 9.0, marks=pytest.mark.slow
        ),
    ],
)
def test_drift_is_the_double_sum_over_pairs_of_waves(
    tmp_path: Path, drift: Density, frequency: Array, heading: Array, period: float, psi: float
) -> None:
    """The heading to the waves, 0.7 or -2.28 rad, is between those of the table."""
    sea = sea_with(tmp_path / "hull", grid_of(drift, frequency, heading), modal_period=period)
    for t in (0.0, 3.7, 11.0):
        amplitude, w, direction, theta = phases(sea, t)
        inside = np.clip(w, frequency[0], frequency[-1])  # beyond the table its end is taken
        first, second = np.meshgrid(inside, inside, indexing="ij")
        values = drift(first, second, np.full_like(first, direction[0] - psi))
        pairs = np.outer(amplitude, amplitude) * np.exp(1j * (theta[:, None] - theta))
        expected = np.einsum("ik,ika->a", pairs, values).real
        largest = np.abs(drift(*np.meshgrid(frequency, frequency, heading))).max(axis=(0, 1, 2))
        size = largest * np.sum(amplitude**2)
        found = drift_alone(sea, t, psi)
        assert np.abs(expected / size).max() > 0.05
        assert np.all(np.abs(found - expected) < 0.01 * size)


def drift_of_table(pairs: DriftPairs, frequency: Array, heading: Array) -> Array:
    """Drift (F, F, H, 6) at frequencies and headings, as compiled laws take it from the table."""
    table = np.array(pair_table(pairs, "table"))
    total = np.zeros((len(frequency), len(frequency), len(heading), 6), dtype=complex)
    for group in range(int(table[0])):
        waves = np.zeros((len(frequency), len(heading), 16))
        for i, w in enumerate(frequency):
            for h, angle in enumerate(heading):
                place = (float(w), float(np.cos(angle)), float(np.sin(angle)))
                waves[i, h] = pair_amplitudes(*place, table, np.int64(0), group)
        first, second = waves[..., :8:2] + 1j * waves[..., 1:8:2], waves[..., 8::2]
        second = second + 1j * waves[..., 9::2]
        begin = int(pair_weight(table, np.int64(0), group))
        factors = table[begin : begin + 24].reshape(6, 4)
        total += np.einsum("ac,ihc,khc->ikha", factors, first, np.conj(second), optimize=True)
    exchanged = np.conj(total.transpose(1, 0, 2, 3))
    return np.asarray(0.5 * (total + exchanged))


@pytest.mark.parametrize(
    ("drift", "frequency", "step"),
    [
        (smooth_drift, np.linspace(1.2, 8.0, 30), 10),
        (SHORT_HULL, np.linspace(2.0, 12.0, 30), 10),
        (TwoEnds(100.0, 0.8, 0.3), np.linspace(0.2, 1.6, 30), 15),
        (SHIP, np.linspace(0.05, 1.2, 30), 10),
        (SHIP_FAR_APART, np.linspace(0.05, 1.2, 30), 10),
        (SHIP_FAR_APART, np.linspace(0.05, 1.2, 30), 5),
    ],
)
def test_drift_at_the_points_of_the_table_is_that_of_the_table(
    drift: Density, frequency: Array, step: int
) -> None:
    pairs = grid_of(drift, frequency, degrees(step))
    error = np.abs(drift_of_table(pairs, frequency, pairs.heading) - pairs.values)
    assert np.all(error <= 0.01 * np.abs(pairs.values).max(axis=(0, 1, 2)))


@pytest.mark.parametrize(
    ("drift", "frequency"),
    [(SHORT_HULL, np.linspace(2.0, 12.0, 8)), (SHIP, np.linspace(0.05, 1.2, 12))],
)
def test_mean_drift_between_few_frequencies_does_not_oscillate(
    tmp_path: Path, drift: Density, frequency: Array
) -> None:
    """The drift of pairs of waves changes faster than such a table shows, the mean drift not."""
    pairs = grid_of(drift, frequency, degrees(10))
    largest = np.abs(pairs.values).max(axis=(0, 1, 2))
    regular = {"spectrum": "regular", "significant_height": 2.0, "toward": 2.9}
    sea = sea_with(tmp_path / "hull", pairs, **regular)
    for w in np.linspace(frequency[0], frequency[-1], 19)[6:]:
        exact = drift(w, w, np.array(2.9)).real
        found = drift_alone(replace(sea, modal_period=2.0 * pi / w), 0.0, 0.0)
        assert np.all(np.abs(found - exact) <= 0.01 * largest)


def test_an_axis_of_rounding_needs_no_products() -> None:
    pairs = grid_of(smooth_drift, np.linspace(1.2, 8.0, 20), degrees(15))
    clean = grid_of(smooth_drift, np.linspace(1.2, 8.0, 20), degrees(15))
    clean.values[..., 2] = 0.0
    noise = np.random.default_rng(5).normal(size=pairs.values.shape[:3])
    pairs.values[..., 2] = 1e-6 * (noise + noise.transpose(1, 0, 2))
    noisy, quiet = pair_table(pairs, "noisy"), pair_table(clean, "quiet")
    assert noisy[1:5] == quiet[1:5]  # the grid
    assert noisy[0] <= quiet[0] + 1  # Newman's product of the axis may begin a group of four


def newmans_table(folder: Path) -> DriftPairs:
    """Table whose pairs have the mean of the mean drifts of both waves."""
    found = read_wave_loads(folder)
    assert found.drift is not None
    mean = np.zeros((len(found.frequency), len(found.heading), 6))
    mean[:, :, [0, 1, 5]] = found.drift
    values = 0.5 * (mean[:, None] + mean[None, :])
    return DriftPairs(found.frequency, found.heading, values.astype(complex))


@pytest.mark.parametrize("spreading", [0.0, 2.0])
def test_drift_is_newmans_if_the_table_is(tmp_path: Path, spreading: float) -> None:
    sea = sea_with(tmp_path / "full", newmans_table(OTTER), spreading=spreading)
    newman = sea_with(tmp_path / "mean", None, spreading=spreading)
    found = read_wave_loads(OTTER)
    assert found.drift is not None
    waves = newman.wave_field()
    assert waves is not None
    largest = np.abs(found.drift).max(axis=(0, 1)) * np.sum(waves.amplitude**2)
    for t in (0.0, 3.7, 11.0):
        error = drift_alone(sea, t, 0.4) - drift_alone(newman, t, 0.4)
        assert np.all(np.abs(error[[0, 1, 5]]) < 0.01 * largest)
        assert np.abs(error[2:5]).max() == 0.0


def test_a_regular_wave_has_the_mean_drift_of_the_diagonal(tmp_path: Path) -> None:
    frequency, heading = np.linspace(1.2, 8.0, 30), np.linspace(0.0, pi, 13)
    sea = sea_with(
        tmp_path / "hull",
        grid_of(smooth_drift, frequency, heading),
        spectrum="regular",
        significant_height=0.6,
        modal_period=2.0 * pi / 4.0,
    )
    w, angle = np.array(4.0), np.array(1.1 - 0.4)
    for t in (0.0, 2.2):
        expected = 0.3**2 * smooth_drift(w, w, angle).real
        assert drift_alone(sea, t, 0.4) == pytest.approx(expected, abs=0.02)


def test_mirror_image_of_the_waves_has_the_mirror_image_of_the_drift(tmp_path: Path) -> None:
    frequency, heading = np.linspace(1.2, 8.0, 30), np.linspace(0.0, pi, 13)
    sea = sea_with(tmp_path / "hull", grid_of(smooth_drift, frequency, heading))
    other = replace(sea, toward=-1.1)
    m = make_motion(t=2.0)
    here = np.array(replace(sea, drift=1.0).wrench(m)) - np.array(sea.wrench(m))
    there = np.array(replace(other, drift=1.0).wrench(m)) - np.array(other.wrench(m))
    size = np.abs(here).max()
    assert there == pytest.approx(here * (2.0 * EVEN - 1.0), abs=1e-9 * size)


@pytest.mark.slow
def test_engines_and_batch_have_the_same_drift(tmp_path: Path) -> None:
    frequency, heading = np.linspace(1.2, 8.0, 12), np.linspace(0.0, pi, 7)
    sea_with(tmp_path / "hull", grid_of(smooth_drift, frequency, heading))
    table = {"use": "panel_wave_loads", "coefficients": str(tmp_path / "hull"), "drift": 1.0}
    waves = {"significant_height": 0.2, "modal_period": 1.7, "toward": 1.0, "components": 12.0}
    vessel = load_vessel("otter").with_effect({**table, **waves})
    states = []
    for kind in (OpenWater, Engine):
        engine = kind(vessel, step=0.02)
        engine.advance(200)
        states.append(np.array(engine.state[1:]))
    assert states[1] == pytest.approx(states[0], rel=1e-9, abs=1e-12)
    batch = Batch(vessel, 2, step=0.02)
    batch.advance(steps=200)
    assert batch.states[1] == pytest.approx(states[0], rel=1e-9, abs=1e-12)
    calm = OpenWater(load_vessel("otter").with_effect({**table, **waves, "drift": 0.0}), step=0.02)
    calm.advance(200)
    assert np.abs(np.array(calm.state[1:]) - states[0]).max() > 1e-4  # the drift moves the vessel


# Files
# ------------------------------------------------------------------------------------------------


def test_written_pairs_are_read_again(tmp_path: Path) -> None:
    pairs = grid_of(smooth_drift, np.linspace(1.0, 3.0, 4), np.linspace(0.0, pi, 5))
    own = read_wave_loads(OTTER)
    loads = WaveLoads("x", 0.0, own.frequency, own.heading, own.excitation, None, pairs)
    write_wave_loads(tmp_path / "a", loads)
    again = read_wave_loads(tmp_path / "a").drift_pairs
    assert again is not None
    assert again.values == pytest.approx(pairs.values, rel=1e-8, abs=1e-8)
    write_wave_loads(tmp_path / "a", replace(loads, drift_pairs=None))
    assert read_wave_loads(tmp_path / "a").drift_pairs is None


def test_drift_of_pairs_suffices(tmp_path: Path) -> None:
    own = read_wave_loads(OTTER)
    loads = WaveLoads("x", 0.0, own.frequency, own.heading, own.excitation)
    write_wave_loads(tmp_path / "a", loads)
    table = {"use": "panel_wave_loads", "coefficients": str(tmp_path / "a"), "drift": 1.0}
    with pytest.raises(BadInput, match=r"has no drift.csv, .* and no drift_pairs.csv"):
        load_vessel("otter").with_effect(table)
    pairs = grid_of(smooth_drift, np.linspace(1.0, 3.0, 4), np.linspace(0.0, pi, 5))
    write_wave_loads(tmp_path / "a", replace(loads, drift_pairs=pairs))
    load_vessel("otter").with_effect(table)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("omega1", "w1", "the first line must be omega1_radps"),
        ("1.5,1,0,", "1.5,1,0,0,", "16 columns; 15 are required"),
        ("1.5,1,0,", "1.5,x,0,", "drift_pairs.csv:7: a cell is not a number"),
        ("1.5,1,0,", "1.5,nan,0,", "drift_pairs.csv:7: a number is not finite"),
        ("2,1,0,", "2,1.5,0,", "the pair of 1 and 2 rad/s at 0 rad is missing"),
        ("omega1", "omega1", "must be real"),
    ],
)
def test_a_table_of_another_form_is_refused(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    pairs = grid_of(smooth_drift, np.linspace(1.0, 2.0, 3), np.linspace(0.0, pi, 5))
    if message == "must be real":
        pairs.values[1, 1] *= 1j
    own = read_wave_loads(OTTER)
    loads = WaveLoads("x", 0.0, own.frequency, own.heading, own.excitation, None, pairs)
    write_wave_loads(tmp_path / "a", loads)
    path = tmp_path / "a" / "drift_pairs.csv"
    text = path.read_text()
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(BadInput) as caught:
        read_wave_loads(tmp_path / "a")
    assert message in str(caught.value)


def test_headings_on_one_side_only_are_refused(tmp_path: Path) -> None:
    pairs = grid_of(smooth_drift, np.linspace(1.0, 3.0, 4), np.linspace(0.0, 2.0, 5))
    with pytest.raises(BadInput, match="headings of the pairs of waves extend from 0 to 2 rad"):
        sea_with(tmp_path / "hull", pairs).table()


def write_pairs(path: Path, pairs: DriftPairs) -> None:
    """File of WAMIT with the pairs, in axes with z up, one half of the pairs only."""
    lines = [" PER PER BETA BETA I MOD PHS REAL IMAG"]
    for k, first in enumerate(pairs.frequency):
        for m, second in enumerate(pairs.frequency[: k + 1]):
            for h, heading in enumerate(pairs.heading):
                angle = f"{-np.degrees(heading):.7f}"
                for i in range(6):
                    size = DENSITY * 9.81 * LENGTH ** (1 + (i > 2))
                    x = pairs.values[k, m, h, i] * SIGNS[i] / size
                    polar = f"{abs(x):.9e} {np.degrees(np.angle(x)):.5f}"
                    both = f"{2 * pi / first:.10e} {2 * pi / second:.10e}"
                    lines.append(
                        f"{both} {angle} {angle} {i + 1} {polar} {x.real:.9e} {x.imag:.9e}"
                    )
                    lines.append(f"{both} {angle} 77.0 {i + 1} 1.0 0.0 1.0 0.0")
    path.write_text("\n".join(lines))


@pytest.mark.parametrize("suffix", [".12d", ".11d"])
def test_pairs_of_wamit_are_converted(tmp_path: Path, suffix: str) -> None:
    path = write_wamit(tmp_path)
    pairs = grid_of(smooth_drift, np.linspace(2.0, 5.0, 5), np.linspace(0.0, pi, 7))
    write_pairs(path.with_suffix(suffix), pairs)
    found = read_wamit(path, OutputScale(LENGTH, DENSITY, 0.0, 0.134)).drift_pairs
    assert found is not None
    assert found.frequency == pytest.approx(pairs.frequency)
    assert found.heading == pytest.approx(pairs.heading, abs=1e-6)
    size = np.abs(pairs.values).max()
    assert np.abs(found.values - pairs.values).max() < 1e-7 * size


def test_pairs_of_wamit_of_another_form_are_refused(tmp_path: Path) -> None:
    path = write_wamit(tmp_path)
    scale = OutputScale(LENGTH, DENSITY, 0.0, 0.134)
    for text, message in (
        ("5.0 5.0 0.0 0.0 1 1.0 0.0 1.0\n", "a row has 8 columns; 9 are required"),
        ("5.0 5.0 0.0 9.0 1 1.0 0.0 1.0 0.0\n", "no pair of waves of one direction"),
        ("5.0 5.0 0.0 0.0 7 1.0 0.0 1.0 0.0\n", "motion 7; only one body of six"),
    ):
        path.with_suffix(".12d").write_text(text)
        with pytest.raises(BadInput, match=message):
            read_wamit(path, scale)
