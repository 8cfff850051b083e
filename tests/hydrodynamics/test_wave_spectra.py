"""`boatsim spectrum`: seas of scenarios as spectra, and formats of buoys and models."""

import importlib
from math import pi
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.errors import BadInput
from boatsim.hydrodynamics import wave_spectra
from boatsim.physics.effects.irregular_sea import IrregularSea
from boatsim.physics.waves.sea_spectrum import spectrum_of_seas, write_spectrum
from boatsim.physics.waves.spectra import jonswap
from boatsim.physics.waves.tabulated import TabulatedSpectrum, read_spectrum

SCENARIO = """
vessel = "otter"
duration = 1.0
[controller]
use = "open_loop"
[[effect]]
use = "irregular_sea"
significant_height = 0.3
modal_period = 2.5
toward = 1.0
spreading = 4.0
"""


def invoked(*words: str) -> tuple[int, str]:
    """Exit code and output of `boatsim spectrum`."""
    done = CliRunner().invoke(app, ["spectrum", *words], catch_exceptions=False)
    return done.exit_code, " ".join(done.output.split())


def mean_direction(found: TabulatedSpectrum) -> float:
    over = np.trapezoid(found.density, found.frequency, axis=0)
    return float(np.angle(np.sum(over * np.exp(1j * found.direction))))


def test_spectrum_of_a_sea_is_its_formula() -> None:
    sea = IrregularSea(
        spectrum="jonswap", significant_height=2.0, modal_period=8.0, toward=-1.0, spreading=4.0
    )
    found = spectrum_of_seas([sea])
    # the factor of DNV-RP-C205 is an approximation: its height at gamma = 3.3 is 0.12 % too large
    exact = jonswap(found.frequency, 2.0, 2.0 * pi / 8.0, 3.3) / 1.0012**2
    assert found.over_frequency == pytest.approx(exact, rel=1e-3, abs=1e-4 * exact.max())
    assert mean_direction(found) == pytest.approx(-1.0, abs=1e-6)


def test_two_seas_add_up(tmp_path: Path) -> None:
    wind = IrregularSea(significant_height=0.9, modal_period=4.0, toward=0.2)
    swell = IrregularSea(significant_height=1.2, modal_period=10.0, toward=2.0, spreading=6.0)
    both = spectrum_of_seas([wind, swell])
    assert both.significant_height == pytest.approx(1.5, rel=0.01)
    # as a tabulated sea, together with a third one
    write_spectrum(tmp_path / "both.csv", both)
    table = IrregularSea(spectrum="tabulated", spectrum_file=str(tmp_path / "both.csv"), toward=0.3)
    third = IrregularSea(significant_height=2.0, modal_period=8.0, toward=0.3)
    more = spectrum_of_seas([third, table])
    assert more.significant_height == pytest.approx(2.5, rel=0.01)
    alone = spectrum_of_seas([table])
    turned = mean_direction(alone) - mean_direction(both)
    assert turned == pytest.approx(0.3, abs=0.01)


def test_a_long_swell_is_as_fine_beside_a_chop_as_alone() -> None:
    swell = IrregularSea(
        spectrum="jonswap", gamma=7.0, significant_height=2.0, modal_period=15.0, cut=3.0
    )
    chop = IrregularSea(significant_height=0.1, modal_period=0.8, cut=70.0, toward=1.0)
    both = spectrum_of_seas([swell, chop])
    # energies add up: sqrt(2^2 + 0.1^2)
    assert both.significant_height == pytest.approx(2.0025, rel=1e-3)
    peak = 2.0 * pi / both.frequency[int(np.argmax(both.over_frequency))]
    assert peak == pytest.approx(15.0, rel=0.02)  # a step of the frequencies


def test_a_table_has_its_energy_at_any_direction_and_below_its_cut(tmp_path: Path) -> None:
    """A narrow sea that lies between two directions of the grid, beside another sea."""
    rows = ["frequency_radps,direction_deg,density_m2s_per_rad2"]
    for w in (0.5, 1.0, 1.5, 2.0):
        for degrees in (0, 46, 47, 48, 180, 270):
            rows.append(f"{w},{degrees},{float(degrees == 47) * (2.0 - w):g}")
    (tmp_path / "sea.csv").write_text("\n".join(rows))
    table = IrregularSea(spectrum="tabulated", spectrum_file=str(tmp_path / "sea.csv"), cut=1.8)
    alone = spectrum_of_seas([table])
    # of the density 2 - w between 0.5 and 2 the part above 1.8 is (0.2 / 1.5)^2
    share = 1.0 - (0.2 / 1.5) ** 2
    assert alone.significant_height == pytest.approx(table.significant_height * np.sqrt(share))
    assert np.degrees(mean_direction(alone)) == pytest.approx(47.0, abs=2.5)  # half a step
    other = IrregularSea(significant_height=3.0, modal_period=8.0, cut=20.0)
    energy = share * table.significant_height**2 + 9.0
    both = spectrum_of_seas([other, table])
    assert both.significant_height == pytest.approx(np.sqrt(energy), rel=1e-3)


def test_plain_spectrum_keeps_its_form(tmp_path: Path) -> None:
    (tmp_path / "sea.csv").write_text("frequency_hz,density_m2_per_hz\n0.1,0\n0.2,2\n0.4,0\n")
    sea = IrregularSea(
        spectrum="tabulated", spectrum_file=str(tmp_path / "sea.csv"), significant_height=0.8
    )
    found = spectrum_of_seas([sea])
    assert len(found.direction) == 0 and found.significant_height == pytest.approx(0.8)
    write_spectrum(tmp_path / "other.csv", found)
    assert read_spectrum(tmp_path / "other.csv").density == pytest.approx(found.density, rel=1e-5)


def test_seas_without_a_spectrum_are_refused() -> None:
    with pytest.raises(BadInput, match="there is no sea with a spectrum"):
        spectrum_of_seas([])
    regular = IrregularSea(spectrum="regular", significant_height=1.0)
    with pytest.raises(BadInput, match="a regular wave has no spectrum"):
        spectrum_of_seas([regular])


def test_the_command_writes_the_sea_of_a_scenario(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(SCENARIO)
    out = str(tmp_path / "sea.csv")
    code, printed = invoked(str(tmp_path / "case.toml"), "--out", out)
    assert code == 0 and "significant height 0.29" in printed
    assert "waves run to 57.3 deg on average" in printed
    again = invoked(out)
    assert again[0] == 0 and "significant height 0.29" in again[1]
    sea = IrregularSea(spectrum="tabulated", spectrum_file=out)
    assert sea.significant_height == pytest.approx(0.3, rel=0.01)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["{case}", "--out", "sea.txt"], "allowed are names that end in .csv, .nc, .swn, .json"),
        (["{none}.csv"], "there is no such file"),
        (["no_such_scenario"], "no_such_scenario"),
        (["{calm}"], "there is no sea with a spectrum"),
    ],
)
def test_bad_input_is_one_line(tmp_path: Path, words: list[str], message: str) -> None:
    (tmp_path / "case.toml").write_text(SCENARIO)
    (tmp_path / "calm.toml").write_text(SCENARIO.split("[[effect]]")[0])
    names = {name: str(tmp_path / f"{name}.toml") for name in ("case", "calm", "none")}
    code, printed = invoked(*(word.format(**names) for word in words))
    assert code == 2 and message in printed


def test_missing_wavespectra_is_answered_by_the_command_that_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def nothing(_: str) -> None:
        return None

    monkeypatch.setattr(wave_spectra, "find_spec", nothing)
    with pytest.raises(BadInput, match=r'pip install "boatsim\[spectra\]"'):
        wave_spectra.read_file(tmp_path / "buoy.nc", "ndbc", 0, 0)
    with pytest.raises(BadInput, match=r'pip install "boatsim\[spectra\]"'):
        wave_spectra.write_file(tmp_path / "sea.nc", read_only_plain())


def read_only_plain() -> TabulatedSpectrum:
    return TabulatedSpectrum(np.array([1.0, 2.0, 3.0]), np.zeros(0), np.array([0.0, 1.0, 0.0]))


# With wavespectra
# ------------------------------------------------------------------------------------------------


def directional() -> TabulatedSpectrum:
    sea = IrregularSea(
        spectrum="jonswap", significant_height=2.0, modal_period=8.0, toward=-1.0, spreading=4.0
    )
    return spectrum_of_seas([sea])


@pytest.mark.parametrize(
    ("suffix", "kind"), [(".nc", "netcdf"), (".swn", "swan"), (".json", "json")]
)
def test_written_spectra_are_read_again(tmp_path: Path, suffix: str, kind: str) -> None:
    pytest.importorskip("wavespectra")
    found, path = directional(), tmp_path / f"sea{suffix}"
    wave_spectra.write_file(path, found)
    again = wave_spectra.read_file(path, kind, 0, 0)
    assert again.significant_height == pytest.approx(found.significant_height, rel=1e-3)
    assert mean_direction(again) == pytest.approx(mean_direction(found), abs=1e-3)
    assert again.frequency == pytest.approx(found.frequency, rel=1e-3)


def test_height_and_direction_are_those_of_wavespectra(tmp_path: Path) -> None:
    package = pytest.importorskip("wavespectra")
    found = directional()
    wave_spectra.write_file(tmp_path / "sea.nc", found)
    data = package.read_netcdf(str(tmp_path / "sea.nc"))
    assert float(data.spec.hs(tail=False).squeeze()) == pytest.approx(
        found.significant_height, rel=1e-3
    )
    # waves that run to -1 rad come from the opposite direction
    coming = float(data.spec.dm().squeeze())
    assert coming == pytest.approx(np.degrees(pi - 1.0), abs=0.1)


def test_directions_of_a_sector_have_no_waves_outside_it(tmp_path: Path) -> None:
    pytest.importorskip("wavespectra")
    xarray = importlib.import_module("xarray")
    coming = np.arange(200.0, 281.0, 10.0)
    density = np.full((3, len(coming)), 0.01)  # [m^2/Hz/deg]
    axes = {"freq": [0.1, 0.2, 0.3], "dir": coming}
    data = xarray.DataArray(density, dims=("freq", "dir"), coords=axes)
    found = wave_spectra.spectrum_of(data, tmp_path / "sea.nc")
    # nine directions, each with its step of 10 deg
    assert found.significant_height == pytest.approx(4.0 * np.sqrt(0.01 * 90.0 * 0.2))
    assert np.degrees(mean_direction(found)) == pytest.approx(60.0)
    with pytest.raises(BadInput, match="3 directions; at least four are required"):
        wave_spectra.spectrum_of(data.isel(dir=[0, 1, 2]), tmp_path / "sea.nc")


def test_a_buoy_of_ndbc_is_read(tmp_path: Path) -> None:
    """A netCDF file of a buoy without directions, with two times."""
    pytest.importorskip("wavespectra")
    xarray = importlib.import_module("xarray")
    frequency = np.linspace(0.05, 0.4, 36)
    density = np.stack([jonswap(2 * pi * frequency, h, 2 * pi / 8, 3.3) * 2 * pi for h in (1, 2)])
    data = xarray.Dataset(
        {"spectral_wave_density": (("time", "frequency"), density)},
        coords={
            "time": np.array(["2020-01-01", "2020-01-02"], dtype="datetime64[ns]"),
            "frequency": frequency,
        },
    )
    data.to_netcdf(tmp_path / "buoy.nc")
    first = wave_spectra.read_file(tmp_path / "buoy.nc", "ndbc", 0, 0)
    last = wave_spectra.read_file(tmp_path / "buoy.nc", "ndbc", -1, 0)
    assert len(first.direction) == 0
    assert first.significant_height == pytest.approx(1.0, rel=0.02)
    assert last.significant_height == pytest.approx(2.0, rel=0.02)
    with pytest.raises(BadInput, match="--time = 2; the file has 2, from 0 on"):
        wave_spectra.read_file(tmp_path / "buoy.nc", "ndbc", 2, 0)
    out = str(tmp_path / "sea.csv")
    code, printed = invoked(str(tmp_path / "buoy.nc"), "--format", "ndbc", "--out", out)
    assert code == 0 and "36 frequencies from 0.05 to 0.4 Hz, 0 directions" in printed
    sea = IrregularSea(spectrum="tabulated", spectrum_file=out, toward=1.0)
    assert sea.significant_height == pytest.approx(1.0, rel=0.02)


def test_files_that_wavespectra_cannot_read_are_refused(tmp_path: Path) -> None:
    pytest.importorskip("wavespectra")
    (tmp_path / "sea.spec").write_text("nothing\n")
    with pytest.raises(BadInput, match="did you mean 'swan'"):
        wave_spectra.read_file(tmp_path / "sea.spec", "swann", 0, 0)
    with pytest.raises(BadInput, match="there is no such file"):
        wave_spectra.read_file(tmp_path / "none.spec", "swan", 0, 0)
    with pytest.raises(BadInput, match="wavespectra cannot read it as swan") as caught:
        wave_spectra.read_file(tmp_path / "sea.spec", "swan", 0, 0)
    assert "\n" not in str(caught.value)
    with pytest.raises(BadInput, match="without directions is written as .csv only"):
        wave_spectra.write_file(tmp_path / "sea.nc", read_only_plain())
