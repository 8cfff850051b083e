"""Tabulated seas: energy, directions and height of the file, and the same sea by formula."""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics.base import Array, make_motion
from boatsim.physics.effects.irregular_sea import IrregularSea
from boatsim.physics.effects.panel_wave_loads import PanelWaveLoads
from boatsim.physics.vessel import load_vessel
from boatsim.physics.waves.spectra import jonswap
from boatsim.physics.waves.spreading import cosine_power
from boatsim.physics.waves.tabulated import close_sector, read_spectrum
from boatsim.simulate.open_water import OpenWater

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hydrodynamics"
MODAL = 2.0 * pi / 6.0  # [rad/s]
FREQUENCIES = np.linspace(0.5 * MODAL, 4.0 * MODAL, 120)
HEIGHT = 1.5  # [m]
HEAD = "frequency_hz,density_m2_per_hz\n"
BOTH = "frequency_hz,direction_deg,density_m2_per_hz_deg\n"


def plain_file(path: Path, factor: float = 1.0) -> Path:
    """JONSWAP spectrum without directions, in Hz."""
    rows = [HEAD.strip()]
    for w in FREQUENCIES:
        density = factor * jonswap(w, HEIGHT, MODAL, 3.3) * 2.0 * pi
        rows.append(f"{w / (2.0 * pi):.9g},{density:.9g}")
    path.write_text("\n".join(rows))
    return path


def directional_file(path: Path, toward: float, exponent: float, head: str = "") -> Path:
    """The same spectrum with directions cos^n about a mean one, in degrees."""
    rows = [head + BOTH.strip()]
    for w in FREQUENCIES:
        for degrees in range(0, 360, 10):
            off = (np.radians(degrees) - toward + pi) % (2.0 * pi) - pi
            share = float(cosine_power(off, exponent))
            density = jonswap(w, HEIGHT, MODAL, 3.3) * share * 2.0 * pi * pi / 180.0
            rows.append(f"{w / (2.0 * pi):.9g},{degrees},{density:.9g}")
    path.write_text("\n".join(rows))
    return path


def sea_of(path: Path, **more: object) -> IrregularSea:
    return IrregularSea(spectrum="tabulated", spectrum_file=str(path), **more)  # type: ignore[arg-type]


def moments(sea: IrregularSea) -> tuple[Array, Array, Array]:
    """Energy, frequency and direction of all waves."""
    field = sea.wave_field()
    assert field is not None
    return 0.5 * field.amplitude**2, field.frequency, field.direction


def test_height_and_energy_are_those_of_the_file(tmp_path: Path) -> None:
    sea = sea_of(plain_file(tmp_path / "sea.csv"))
    found = read_spectrum(tmp_path / "sea.csv")
    exact = 4.0 * np.sqrt(np.trapezoid(jonswap(FREQUENCIES, HEIGHT, MODAL, 3.3), FREQUENCIES))
    assert found.significant_height == pytest.approx(exact, rel=1e-6)
    assert sea.significant_height == pytest.approx(exact, rel=1e-6)
    energy, frequency, _ = moments(sea)
    assert 4.0 * np.sqrt(energy.sum()) == pytest.approx(exact, rel=1e-6)
    for w in (0.9 * MODAL, MODAL, 1.5 * MODAL):  # the energy below a frequency
        below = FREQUENCIES[w >= FREQUENCIES]
        share = np.trapezoid(jonswap(below, HEIGHT, MODAL, 3.3), below)
        assert energy[frequency <= w].sum() == pytest.approx(share, abs=0.03 * energy.sum())
    assert sea_of(tmp_path / "sea.csv", significant_height=0.4).significant_height == 0.4


def test_density_per_radian_is_that_per_hertz(tmp_path: Path) -> None:
    first = read_spectrum(plain_file(tmp_path / "sea.csv"))
    rows = ["frequency_radps,density_m2s_per_rad"]
    rows += [f"{w:.9g},{jonswap(w, HEIGHT, MODAL, 3.3):.9g}" for w in FREQUENCIES]
    (tmp_path / "other.csv").write_text("\n".join(rows))
    second = read_spectrum(tmp_path / "other.csv")
    assert second.frequency == pytest.approx(first.frequency)
    assert second.density == pytest.approx(first.density)


@pytest.mark.parametrize("toward", [0.0, 2.0, -1.2])
def test_directions_are_those_of_the_file(tmp_path: Path, toward: float) -> None:
    sea = sea_of(directional_file(tmp_path / "sea.csv", toward, 4.0), components=300.0)
    assert sea.significant_height == pytest.approx(HEIGHT, rel=0.01)
    parts = [moments(sea.with_seed(seed)) for seed in range(20)]
    energy = np.concatenate([part[0] for part in parts])
    direction = np.concatenate([part[2] for part in parts])
    mean = np.sum(energy * np.exp(1j * direction)) / energy.sum()
    assert np.angle(mean * np.exp(-1j * toward)) == pytest.approx(0.0, abs=0.05)
    off = (direction - toward + pi) % (2.0 * pi) - pi
    # of cos^n the mean square of the sine is 1 / (n + 2)
    assert np.sum(energy * np.sin(off) ** 2) / energy.sum() == pytest.approx(1.0 / 6.0, abs=0.02)


def test_directions_from_which_waves_come_are_turned(tmp_path: Path) -> None:
    to = sea_of(directional_file(tmp_path / "to.csv", 0.7, 4.0))
    coming = directional_file(tmp_path / "from.csv", 0.7 + pi, 4.0, "# direction = from\n")
    apart = moments(sea_of(coming))[2] - moments(to)[2]
    assert np.cos(apart) == pytest.approx(np.ones(len(apart)), abs=1e-4)
    turned = moments(replace(to, toward=0.3))[2] - moments(to)[2]
    assert turned == pytest.approx(0.3 * np.ones(len(turned)))


def test_a_direction_is_not_between_two_wave_systems(tmp_path: Path) -> None:
    rows = [BOTH.strip()]
    for f in (0.1, 0.15, 0.2):
        for degrees in range(0, 360, 10):
            rows.append(f"{f},{degrees},{float(degrees in (40, 50, 200, 210)):g}")
    (tmp_path / "sea.csv").write_text("\n".join(rows))
    _, _, direction = moments(sea_of(tmp_path / "sea.csv", components=500.0))
    degrees = np.degrees(direction) % 360.0
    first, second = np.abs(degrees - 45.0) <= 15.0, np.abs(degrees - 205.0) <= 15.0
    assert np.mean(first | second) > 0.95  # shares of the energy are 1 / 32
    assert np.mean(first) == pytest.approx(0.5, abs=0.07)


def test_a_direction_is_that_of_the_energy_of_the_whole_cell(tmp_path: Path) -> None:
    """A sea between two frequencies of 0 density that lie inside a single cell."""
    rows = [BOTH.strip()]
    for f, density in ((0.05, 0), (0.1, 0), (0.102, 5), (0.104, 0), (0.5, 0), (1.0, 0)):
        for degrees in range(0, 360, 30):
            rows.append(f"{f},{degrees},{density * float(degrees == 90):g}")
    (tmp_path / "sea.csv").write_text("\n".join(rows))
    for count in (160.0, 40.0, 20.0):
        energy, _, direction = moments(sea_of(tmp_path / "sea.csv", components=count))
        assert np.degrees(direction[energy > 0.0]) == pytest.approx(90.0, abs=30.0)


def test_a_sector_of_directions_has_no_waves_outside_it(tmp_path: Path) -> None:
    rows = [BOTH.strip()]
    for f in (0.1, 0.2, 0.3):
        rows += [f"{f},{degrees},0.01" for degrees in (330, 340, 350, 0, 10, 20, 30)]
    (tmp_path / "sea.csv").write_text("\n".join(rows))
    found = read_spectrum(tmp_path / "sea.csv")
    # seven directions, each with its step of 10 deg
    assert found.significant_height == pytest.approx(4.0 * np.sqrt(0.01 * 70.0 * 0.2))
    _, _, direction = moments(sea_of(tmp_path / "sea.csv", components=500.0))
    assert np.abs((np.degrees(direction) + 180.0) % 360.0 - 180.0).max() <= 40.0


def test_directions_of_the_whole_circle_are_closed() -> None:
    for degrees in ([0, 90, 180, 270], [0, 10, 20, 30, 90, 180, 270], [5, 100, 190, 275]):
        direction = np.radians(degrees)
        density = np.ones((3, len(degrees)))
        assert close_sector(direction, density)[0] is direction
    # one direction of the circle is missing
    most, _ = close_sector(np.radians(np.arange(0.0, 330.0, 30.0)), np.ones((3, 11)))
    assert np.degrees(most) == pytest.approx(np.arange(0.0, 360.0, 30.0))


def test_a_height_of_zero_is_a_calm_sea(tmp_path: Path) -> None:
    sea = sea_of(plain_file(tmp_path / "sea.csv"), significant_height=0.0)
    assert sea.significant_height == 0.0 and sea.wave_field() is None
    whole = sea_of(tmp_path / "sea.csv")
    assert whole.wave_field() is not None
    assert replace(whole, significant_height=0.0).wave_field() is None
    assert IrregularSea().significant_height == 0.0


def test_a_frequency_of_zero_without_waves_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "sea.csv").write_text(HEAD + "0,0\n" + ROWS)
    assert read_spectrum(tmp_path / "sea.csv").frequency[0] == pytest.approx(0.2 * pi)


@pytest.mark.slow
def test_a_table_and_a_formula_are_the_same_sea(tmp_path: Path) -> None:
    """The rms force on a hull over realisations."""
    boat = {"coefficients": str(OTTER), "depth": 0.0, "toward": 1.0, "components": 60.0}
    table = PanelWaveLoads(
        spectrum="tabulated",
        spectrum_file=str(plain_file(tmp_path / "sea.csv", 0.01)),
        **boat,  # type: ignore[arg-type]
    )
    formula = PanelWaveLoads(
        spectrum="jonswap",
        significant_height=0.1 * HEIGHT,
        modal_period=6.0,
        **boat,  # type: ignore[arg-type]
    )
    m = make_motion(t=0.0)
    rms = []
    for sea in (table, formula):
        loads = np.array([sea.with_seed(seed).wrench(m) for seed in range(400)])
        rms.append(loads.std(axis=0))
    assert rms[0] == pytest.approx(rms[1], rel=0.15)


@pytest.mark.parametrize(
    "effect",
    [
        pytest.param({"use": "irregular_sea"}, marks=pytest.mark.slow),
        pytest.param(
            {"use": "strip_wave_loads", "hull_spacing": 0.79, "hull_beam": 0.25},
            marks=pytest.mark.slow,
        ),
        {"use": "panel_wave_loads", "coefficients": str(OTTER), "drift": 1.0},
    ],
)
def test_the_force_is_the_sum_over_the_waves_of_the_field(
    tmp_path: Path, effect: dict[str, object]
) -> None:
    """Each wave alone, as a regular one, has a part of the force of the tabulated sea.

    The sum of the excitation over the waves of the field is taken at one time and place.
    """
    path = directional_file(tmp_path / "sea.csv", 0.5, 4.0)
    table = {**effect, "spectrum": "tabulated", "spectrum_file": str(path), "components": 5.0}
    table |= {"significant_height": 0.02, "drift": 0.0}
    if "coefficients" not in table:
        del table["drift"]
    boat = load_vessel("otter")
    sea = boat.with_effect(table).effect(str(effect["use"]))
    field = sea.wave_field()  # type: ignore[union-attr]
    assert field is not None
    total = np.zeros(6)
    for k in range(len(field)):
        w, number = field.frequency[k], field.wave_number[k]
        direction = float((field.direction[k] + pi) % (2.0 * pi) - pi)
        alone = {
            **table,
            "spectrum": "regular",
            "spectrum_file": "",
            "significant_height": 2.0 * field.amplitude[k],
            "modal_period": 2.0 * pi / w,
            "toward": direction,
        }
        # the regular wave has its crest at the origin at t = 0: shift the time
        late = (w * 1.3 - number * 2.0 * np.cos(direction) + field.phase[k]) / w
        m = make_motion(t=float(late))
        one = boat.with_effect(alone).effect(str(effect["use"]))
        total += np.array(one.wrench(m))  # type: ignore[union-attr]
    found = np.array(sea.wrench(make_motion(t=1.3, x=2.0)))  # type: ignore[union-attr]
    assert found == pytest.approx(total, rel=1e-6, abs=1e-6 * np.abs(total).max())


@pytest.mark.slow
def test_a_boat_meets_the_elevation_of_the_file(tmp_path: Path) -> None:
    path = directional_file(tmp_path / "sea.csv", 0.5, 4.0)
    table = {"use": "irregular_sea", "spectrum": "tabulated", "spectrum_file": str(path)}
    boat = OpenWater(load_vessel("otter").with_effect(table), step=0.02)
    boat.reset()
    boat.advance(200)
    assert np.isfinite(boat.state.phi) and boat.state.phi != 0.0


def test_a_relative_path_begins_at_the_file_of_the_vessel(tmp_path: Path) -> None:
    plain_file(tmp_path / "sea.csv")
    table = {"use": "irregular_sea", "spectrum": "tabulated", "spectrum_file": "sea.csv"}
    from boatsim.physics.vessel.effect_tables import effect_from_table

    found = effect_from_table(table, "vessel.toml", tmp_path)
    assert isinstance(found, IrregularSea) and found.wave_field() is not None


ROWS = "0.1,1\n0.2,2\n0.3,1\n"
CIRCLE = "".join(f"{f},{d},1\n" for f in (0.1, 0.2, 0.3) for d in (0, 90, 180, 270, 360))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "there are no rows"),
        ("# direction = north\n" + HEAD + ROWS, "allowed are to, from"),
        ("f,density_m2_per_hz\n" + ROWS, "a column frequency_hz or frequency_radps is required"),
        ("frequency_hz,density\n" + ROWS, "density_m2_per_hz or density_m2s_per_rad is required"),
        (HEAD + ROWS.replace("2\n", "-2\n"), "a density is negative"),
        (HEAD + "0.1,1\n0.2,1\n", "at least three frequencies"),
        (HEAD + ROWS + "0.3,1\n", "a frequency stands twice"),
        (HEAD + "0.1,0\n0.2,0\n0.3,0\n", "the spectrum has no waves"),
        (HEAD + "0,5\n" + ROWS, "the density at the frequency 0 is not 0"),
        (HEAD + "0,0\n0.1,1\n0.2,1\n", "at least three frequencies above 0"),
        (BOTH + CIRCLE + "0.1,90,2\n", "0.6283 rad/s and 90 deg stand twice"),
        (BOTH + "0.1,0,1\n0.2,0,1\n0.3,0,1\n", "1 directions; at least four are required"),
        (
            BOTH
            + "".join(f"{f},{d},1\n" for f in (0.1, 0.2, 0.3) for d in (0, 90, 180, 270))[:-10],
            "1.885 rad/s lacks 270 deg",
        ),
    ],
)
def test_a_file_of_another_form_is_refused(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "sea.csv").write_text(text)
    with pytest.raises(BadInput) as caught:
        read_spectrum(tmp_path / "sea.csv")
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_parameters_that_do_not_apply_are_refused(tmp_path: Path) -> None:
    path = directional_file(tmp_path / "sea.csv", 0.5, 4.0)
    with pytest.raises(BadInput, match='spectrum = "tabulated" needs spectrum_file'):
        IrregularSea(spectrum="tabulated")
    with pytest.raises(BadInput, match='applies to spectrum = "tabulated"; here it is "jonswap"'):
        IrregularSea(spectrum="jonswap", spectrum_file=str(path))
    with pytest.raises(BadInput, match=r"spreading = 2; .*sea.csv has directions"):
        sea_of(path, spreading=2.0)
    with pytest.raises(BadInput, match=r"cut = 1 rad/s omits .* % of the energy"):
        sea_of(path, cut=1.0)
    with pytest.raises(BadInput, match="there is no such file"):
        sea_of(tmp_path / "none.csv")
