"""Files of coefficients, and the output of WAMIT and Nemoh, against the coefficients they hold."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.hydrodynamics.nemoh import read_nemoh
from boatsim.hydrodynamics.wamit import OutputScale, read_wamit
from boatsim.physics.coefficients.files import (
    read_coefficients,
    read_wave_loads,
    write_coefficients,
    write_wave_loads,
)
from boatsim.physics.coefficients.table import Coefficients, WaveLoads

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hydrodynamics"
SIGNS = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])  # of z-up axes
LENGTH, DENSITY = 2.0, 1025.0


def own() -> Coefficients:
    return read_coefficients(OTTER)


def write_wamit(folder: Path) -> Path:
    """Files of WAMIT with the coefficients, written by its manual: nondimensional, exp(i w t)."""
    found, lines, waves = own(), [], []
    power = np.array([3, 3, 3, 4, 4, 4])
    for i in range(6):
        for j in range(6):
            size = DENSITY * LENGTH ** (power[i] + power[j] - 3) * SIGNS[i] * SIGNS[j]
            lines.append(f" 0.0 {i + 1} {j + 1} {found.infinite_added_mass[i, j] / size:.9e}")
            for k, w in enumerate(found.frequency):
                a, b = found.added_mass[k, i, j] / size, found.damping[k, i, j] / size / w
                lines.append(f" {2 * np.pi / w:.9e} {i + 1} {j + 1} {a:.9e} {b:.9e}")
    for k, w in enumerate(found.frequency):
        for h, heading in enumerate(found.heading):
            for i in range(6):
                x = (
                    found.excitation[k, h, i]
                    * SIGNS[i]
                    / (DENSITY * 9.81 * LENGTH ** (2 + (i > 2)))
                )
                polar = f"{abs(x):.9e} {np.degrees(np.angle(x)):.5f} {x.real:.9e} {x.imag:.9e}"
                waves.append(f" {2 * np.pi / w:.9e} {-np.degrees(heading):.9f} {i + 1} {polar}")
    assert found.drift is not None
    drifts = []
    for k, w in enumerate(found.frequency):
        for h, heading in enumerate(found.heading):
            direction = f"{-np.degrees(heading):.9f}"
            for place, i in enumerate((0, 1, 5)):
                x = found.drift[k, h, place] * SIGNS[i] / (DENSITY * 9.81 * LENGTH ** (1 + (i > 2)))
                parts = f"{abs(x):.9e} 0.0 {x:.9e} 0.0"
                drifts.append(f" {2 * np.pi / w:.9e} {direction} {direction} {i + 1} {parts}")
            drifts.append(f" {2 * np.pi / w:.9e} {direction} {direction} -6 7.0 0.0 7.0 0.0")
            drifts.append(f" {2 * np.pi / w:.9e} {direction} 77.0 1 7.0 0.0 7.0 0.0")
    (folder / "hull.8").write_text("\n".join(drifts))
    (folder / "hull.1").write_text("\n".join(lines))
    (folder / "hull.3").write_text("\n".join(waves))
    return folder / "hull.1"


def test_written_coefficients_are_read_again(tmp_path: Path) -> None:
    found = own()
    write_coefficients(tmp_path / "copy", found)
    again = read_coefficients(tmp_path / "copy")
    assert again.excitation == pytest.approx(found.excitation, rel=1e-8)
    assert again.damping == pytest.approx(found.damping, rel=1e-8)
    assert again.drift is not None and found.drift is not None
    assert again.drift == pytest.approx(found.drift, rel=1e-8)
    assert again.drift_of == found.drift_of
    assert again.memory is not None and found.memory is not None
    assert again.memory.sections[0] == pytest.approx(found.memory.sections[0], rel=1e-12)


def test_speed_of_the_excitation_is_written_and_read_again(tmp_path: Path) -> None:
    write_coefficients(tmp_path / "rest", own())
    write_coefficients(tmp_path / "moving", replace(own(), speed=2.5))
    header = tmp_path / "moving" / "coefficients.toml"
    assert "speed" not in (tmp_path / "rest" / "coefficients.toml").read_text()
    assert "speed = 2.5  # [m/s]" in header.read_text()
    assert read_coefficients(tmp_path / "rest").speed == 0.0
    assert read_wave_loads(tmp_path / "rest").speed == 0.0
    assert read_coefficients(tmp_path / "moving").speed == 2.5
    assert read_wave_loads(tmp_path / "moving").speed == 2.5
    loads = WaveLoads("x", 0.0, own().frequency, own().heading, own().excitation, speed=1.5)
    write_wave_loads(tmp_path / "loads", loads)
    assert read_wave_loads(tmp_path / "loads").speed == 1.5
    text = header.read_text()
    for value, message in (("-1.0", "allowed is 0 or more"), ("'fast'", "a number is required")):
        header.write_text(text.replace("speed = 2.5", f"speed = {value}"))
        with pytest.raises(BadInput, match=message):
            read_wave_loads(tmp_path / "moving")


def test_output_of_wamit_is_converted(tmp_path: Path) -> None:
    found, exact = (
        read_wamit(write_wamit(tmp_path), OutputScale(LENGTH, DENSITY, 0.0, 0.134)),
        own(),
    )
    assert found.frequency == pytest.approx(exact.frequency, rel=1e-7)
    for name in ("added_mass", "damping", "infinite_added_mass"):
        size = np.abs(getattr(exact, name)).max()
        assert getattr(found, name) == pytest.approx(getattr(exact, name), abs=1e-7 * size)
    assert found.heading == pytest.approx(exact.heading, abs=1e-6)
    size = np.abs(exact.excitation).max()
    assert np.abs(found.excitation - exact.excitation).max() < 1e-6 * size
    assert found.drift is not None and exact.drift is not None
    assert found.drift == pytest.approx(exact.drift, abs=1e-6 * np.abs(exact.drift).max())
    assert found.drift_of == "motions of hull.8"


def test_drift_by_the_pressure_is_read_if_there_is_none_by_the_momentum(tmp_path: Path) -> None:
    path = write_wamit(tmp_path)
    (tmp_path / "hull.8").rename(tmp_path / "hull.9")
    scale = OutputScale(LENGTH, DENSITY, 0.0, 0.134)
    assert read_wamit(path, scale).drift_of == "motions of hull.9"
    (tmp_path / "hull.9").unlink()
    assert read_wamit(path, scale).drift is None


def test_incomplete_drift_of_wamit_is_refused(tmp_path: Path) -> None:
    path = write_wamit(tmp_path)
    lines = (tmp_path / "hull.8").read_text().splitlines()
    (tmp_path / "hull.8").write_text("\n".join(lines[1:]))
    scale = OutputScale(LENGTH, DENSITY, 0.0, 0.134)
    with pytest.raises(BadInput, match="of every period and direction are required"):
        read_wamit(path, scale)
    (tmp_path / "hull.8").write_text(lines[0])
    with pytest.raises(BadInput, match="the directions differ from those of the excitation"):
        read_wamit(path, scale)


def test_coefficients_without_drift_leave_none_of_earlier_ones(tmp_path: Path) -> None:
    assert write_coefficients(tmp_path / "copy", own()) == []
    before = (tmp_path / "copy" / "drift.csv").read_text()
    (tmp_path / "copy" / "drift_pairs.csv").write_text("of another program")
    renamed = write_coefficients(tmp_path / "copy", replace(own(), drift=None))
    assert renamed == ["drift.csv", "drift_pairs.csv"]
    again = read_coefficients(tmp_path / "copy")
    assert again.drift is None and again.drift_pairs is None
    assert (tmp_path / "copy" / "drift.csv.old").read_text() == before
    assert (tmp_path / "copy" / "drift_pairs.csv.old").read_text() == "of another program"


def test_drift_of_other_waves_than_the_excitation_is_refused(tmp_path: Path) -> None:
    write_coefficients(tmp_path / "copy", own())
    path = tmp_path / "copy" / "drift.csv"
    path.write_text("".join(path.read_text().splitlines(keepends=True)[:-1]))
    with pytest.raises(BadInput, match="must be those of excitation.csv"):
        read_coefficients(tmp_path / "copy")


def test_excitation_at_one_frequency_is_refused(tmp_path: Path) -> None:
    write_coefficients(tmp_path / "copy", replace(own(), drift=None))
    path = tmp_path / "copy" / "excitation.csv"
    lines = path.read_text().splitlines()
    path.write_text("\n".join(lines[: 1 + len(own().heading)]))
    with pytest.raises(BadInput, match="excitation.csv: there is one frequency; at least two"):
        read_wave_loads(tmp_path / "copy")


@pytest.mark.parametrize("degrees", [False, True])
def test_output_of_nemoh_is_converted(tmp_path: Path, degrees: bool) -> None:
    exact, radiation, waves = own(), [], []
    for i in range(6):
        radiation.append(f'Zone t="Motion of body 1 in DoF {i + 1}",I= 30,F=POINT')
        for k, w in enumerate(exact.frequency):
            pairs = []
            for j in range(6):
                sign = SIGNS[i] * SIGNS[j]
                pairs.append(f"{sign * exact.added_mass[k, i, j]:.9e}")
                pairs.append(f"{sign * exact.damping[k, i, j]:.9e}")
            radiation.append(f"{w:.9e} {' '.join(pairs)}")
    for h, heading in enumerate(exact.heading):
        waves.append(f'Zone t="Diffraction force - beta = {-np.degrees(heading):.4f} deg",I= 30')
        for k, w in enumerate(exact.frequency):
            pairs = []
            for j in range(6):
                x = np.conj(exact.excitation[k, h, j] * SIGNS[j])  # exp(-i w t)
                angle = np.degrees(np.angle(x)) if degrees else np.angle(x)
                pairs.append(f"{abs(x):.9e} {angle:.9e}")
            waves.append(f"{w:.9e} {' '.join(pairs)}")
    (tmp_path / "RadiationCoefficients.tec").write_text("\n".join(radiation))
    (tmp_path / "ExcitationForce.tec").write_text("\n".join(waves))
    found = read_nemoh(tmp_path, OutputScale(1.0, DENSITY, 0.0, 0.134))
    size = np.abs(exact.added_mass).max()
    assert found.added_mass == pytest.approx(exact.added_mass, abs=1e-7 * size)
    size = np.abs(exact.excitation).max()
    assert np.abs(found.excitation - exact.excitation).max() < 1e-5 * size


@pytest.mark.parametrize(
    ("suffix", "new", "message"),
    [
        (".1", "1.0 1 1", r"hull.1:1: a row has 3 columns; 4 are required"),
        (".1", "1.0 1 nan 0.1 0.1", r"hull.1:1: .* a value is no number"),
        (".1", "1.0 1 7 0.1 0.1", "motion 7; only one body of six is read"),
        (".3", "1.0 0.0 1 ****** 0.1 ****** 0.2", r"hull.3:1: .* a value is no number"),
        (".3", "1.0 0.0 9 0.1 0.1 0.1 0.1", "motion 9; only one body of six is read"),
        (".3", "a remark", "surge has no finite value at .* rad/s and 0 deg"),
        (".8", "1.0 0.0 0.0 nan 0.1 0.0 0.1 0.0", r"hull.8:1: .* a value is no number"),
        (".hst", "1 inf 2.0", r"hull.hst:1: .* a value is no number"),
        (".hst", "1 7 2.0", "motion 7; only one body of six is read"),
        (".12d", "1.0 1.0 0.0 0.0 nan 1.0 0.0 1.0 0.0", r"hull.12d:1: .* a value is no number"),
        (".12d", "1.0 1.0 0.0 0.0 1.5 1.0 0.0 1.0 0.0", "motion 1.5; only one body of six"),
    ],
)
def test_damaged_output_of_wamit_is_refused(
    tmp_path: Path, suffix: str, new: str, message: str
) -> None:
    path = write_wamit(tmp_path)
    file = path.with_suffix(suffix)
    rest = []
    if file.is_file():
        rest = file.read_text().splitlines()[1:]
    file.write_text("\n".join([new, *rest]))
    with pytest.raises(BadInput, match=message) as caught:
        read_wamit(path, OutputScale(LENGTH, DENSITY, 0.0, 0.134))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["excitation.csv", "drift.csv", "drift_pairs.csv"])
@pytest.mark.parametrize("content", [b"\xff\xfe\x00", b"1" * 1_100_000])
def test_files_that_are_no_table_are_refused(tmp_path: Path, name: str, content: bytes) -> None:
    write_coefficients(tmp_path / "copy", own())
    (tmp_path / "copy" / name).write_bytes(content)
    with pytest.raises(BadInput, match=f"{name}: no CSV file in UTF-8") as caught:
        read_coefficients(tmp_path / "copy")
    assert "\n" not in str(caught.value)


def test_missing_output_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="no such file"):
        read_wamit(tmp_path / "hull.1", OutputScale(1.0, DENSITY, 0.0, 0.1))
    with pytest.raises(BadInput, match="no such file"):
        read_nemoh(tmp_path, OutputScale(1.0, DENSITY, 0.0, 0.1))


def test_header_of_another_form_is_refused(tmp_path: Path) -> None:
    write_coefficients(tmp_path / "copy", replace(own(), memory=None))
    path = tmp_path / "copy" / "coefficients.toml"
    path.write_text(path.read_text().replace("density = 1025.0", 'density = "salt"'))
    with pytest.raises(BadInput, match="density = 'salt'; a number is required"):
        read_coefficients(tmp_path / "copy")
