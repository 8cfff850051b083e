"""Slow drift by a table of pairs of waves: against the double sum and Newman's approximation."""

from collections.abc import Callable
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.hydrodynamics.wamit import OutputScale, read_wamit
from boatsim.physics.base import Array, make_motion
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


def sea_with(folder: Path, pairs: DriftPairs | None, **more: float) -> PanelWaveLoads:
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


@pytest.mark.parametrize("psi", [0.4, -2.9])
def test_drift_is_the_double_sum_over_pairs_of_waves(tmp_path: Path, psi: float) -> None:
    """The heading to the waves, 0.7 or -2.28 rad, is between those of the table."""
    frequency, heading = np.linspace(1.2, 8.0, 30), np.linspace(0.0, pi, 13)
    sea = sea_with(tmp_path / "hull", grid_of(smooth_drift, frequency, heading))
    for t in (0.0, 3.7, 11.0):
        amplitude, w, direction, theta = phases(sea, t)
        inside = np.minimum(w, frequency[-1])  # beyond the table its end is taken
        first, second = np.meshgrid(inside, inside, indexing="ij")
        values = smooth_drift(first, second, np.full_like(first, direction[0] - psi))
        pairs = np.outer(amplitude, amplitude) * np.exp(1j * (theta[:, None] - theta))
        expected = np.einsum("ik,ika->a", pairs, values).real
        size = 30.0 * np.sum(amplitude**2)
        found = drift_alone(sea, t, psi)
        assert np.abs(expected).max() > 0.05 * size
        assert np.abs(found - expected).max() < 0.005 * size


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
        # both interpolate the table between its frequencies, by different splines
        assert np.all(np.abs(error[[0, 1, 5]]) < 0.02 * largest)
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
