"""The waves of a sea: height, directions, depth and currents, and the elevation that all of boatsim
shares."""

from dataclasses import replace
from math import cos, exp, log, pi, sin, sqrt
from pathlib import Path
from typing import Any

import boats
import numpy as np
import pytest
from alike import long
from scipy.integrate import quad

import boatsim
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import AXES, Array, make_motion
from boatsim.physics.effects.irregular_sea import IrregularSea
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.physics.vessel.wave_field import wave_field
from boatsim.physics.waves.field import WaveField
from boatsim.physics.waves.sea_state import FORMULAS, components
from boatsim.simulate.batch import Batch

G = 9.81
IRREGULAR = [name for name in FORMULAS if name != "regular"]
SWAY, ROLL = AXES.index("sway"), AXES.index("roll")
# of a hull by which effects without a vessel are completed
HULL = {"length": 1.2, "beam": 0.4, "draught": 0.1, "mass": 5.0, "stiffness": 20.0, "arm": 0.0}
HULL |= {"centre_depth": 0.04, "roll_depth": 0.1, "speed": 1.0}


def sea(**settings: Any) -> IrregularSea:
    return IrregularSea.from_settings({"significant_height": 0.5, **HULL, **settings})


def field(own: IrregularSea) -> WaveField:
    found = own.wave_field()
    assert found is not None
    return found


def beam_sea_boat(**settings: Any) -> Vessel:
    waves = {"use": "irregular_sea", "significant_height": 0.3, "toward": pi / 2, **settings}
    return vessel.load_vessel("trial_boat").with_effect(waves)


# ---- energy


@pytest.mark.parametrize("spectrum", IRREGULAR)
@pytest.mark.parametrize(("high", "period"), [(0.3, 2.0), (2.0, 5.0), (4.0, 12.0), (3.0, 16.0)])
def test_components_have_the_significant_height(spectrum: str, high: float, period: float) -> None:
    own = sea(spectrum=spectrum, significant_height=high, modal_period=period)
    assert field(own).significant_height == pytest.approx(high, rel=0.01)


@pytest.mark.parametrize("spectrum", IRREGULAR)
def test_a_sampled_field_has_the_rms_of_the_spectrum(spectrum: str) -> None:
    waves = field(sea(spectrum=spectrum, modal_period=3.0, components=200.0))
    t = np.arange(0.0, 12000.0, 0.25)
    assert waves.elevation(3.0, -2.0, t).std() == pytest.approx(0.5 / 4.0, rel=0.02)
    place = np.linspace(0.0, 20000.0, 40000)  # at one time, along the waves
    assert waves.elevation(place, 0.0, 77.0).std() == pytest.approx(0.5 / 4.0, rel=0.02)


def jonswap(w: float, high: float, modal: float, enhancement: float) -> float:
    width = 0.07 if w <= modal else 0.09
    peaked = enhancement ** exp(-0.5 * ((w / modal - 1) / width) ** 2)
    level = (1 - 0.287 * log(enhancement)) * 5 / 16 * high**2 * modal**4
    return level * w**-5 * exp(-1.25 * (modal / w) ** 4) * peaked


def test_energy_lies_at_the_frequencies_of_the_spectrum() -> None:
    modal = 2 * pi / 3.0
    waves = field(sea(spectrum="jonswap", modal_period=3.0, gamma=5.0, components=1000.0))
    for low, high in ((0.5, 0.9), (0.9, 1.1), (1.1, 1.5), (1.5, 3.0)):
        inside = (waves.frequency >= low * modal) & (waves.frequency < high * modal)
        wanted = quad(jonswap, low * modal, high * modal, args=(0.5, modal, 5.0), points=[modal])
        assert 0.5 * np.sum(waves.amplitude[inside] ** 2) == pytest.approx(wanted[0], rel=0.03)


def test_random_amplitudes_have_the_energy_in_the_mean_and_an_exponential_distribution() -> None:
    own = sea(random_amplitudes=1.0, components=2000.0)
    fixed, free = field(replace(own, random_amplitudes=0.0)), field(own)
    energy = (free.amplitude / fixed.amplitude) ** 2
    # standard errors of mean and mean square over 2,000 samples: 0.022 and 0.1
    assert energy.mean() == pytest.approx(1.0, abs=0.07)
    assert (energy**2).mean() == pytest.approx(2.0, abs=0.3)
    assert (free.frequency == fixed.frequency).all() and (free.phase == fixed.phase).all()


def test_a_regular_wave_has_its_height_period_and_a_crest_at_the_origin() -> None:
    waves = field(sea(spectrum="regular", modal_period=2.5, toward=0.7, components=50.0))
    assert len(waves) == 1
    t = np.linspace(0.0, 10.0, 41)
    assert waves.elevation(0.0, 0.0, t) == pytest.approx(0.25 * np.cos(2 * pi * t / 2.5))
    length = G * 2.5**2 / (2 * pi)
    ahead = (0.5 * length * cos(0.7), 0.5 * length * sin(0.7))
    assert waves.elevation(*ahead, 0.0) == pytest.approx(-0.25)


# ---- seeds


@pytest.mark.parametrize("spectrum", IRREGULAR)
def test_a_seed_gives_one_sea_and_another_seed_another_one(spectrum: str) -> None:
    own = sea(spectrum=spectrum, spreading=3.0, random_amplitudes=1.0)
    first, again, other = (field(own.with_seed(seed)) for seed in (4, 4, 5))
    place = (np.linspace(0.0, 50.0, 11), 3.0, 8.0)
    assert (first.elevation(*place) == again.elevation(*place)).all()
    assert np.abs(first.elevation(*place) - other.elevation(*place)).max() > 0.05


# ---- directions, depth and currents


def test_directions_of_the_waves_have_the_spread_of_the_law() -> None:
    angles = field(sea(spreading=4.0, toward=1.0, components=2000.0)).direction - 1.0
    assert np.abs(angles).max() <= pi / 2
    # mean of sin^2 under cos^4: 1 / 6; its standard error is 0.005
    assert np.mean(np.sin(angles) ** 2) == pytest.approx(1 / 6, abs=0.015)
    assert np.mean(np.sin(angles)) == pytest.approx(0.0, abs=0.03)


def test_the_force_of_spread_waves_is_the_sum_of_those_of_each_direction() -> None:
    own = sea(spreading=2.0, toward=0.4, components=5.0, flat=1.0)
    m = make_motion(t=3.0, x=2.0, y=-1.0, psi=0.3)
    total = 0.0
    for w, a, phase, direction in components(own.values()):
        k = w * w / G
        theta = w * 3.0 - k * (2.0 * cos(direction) - sin(direction)) + phase
        total += sin(direction - 0.3) * a * k * sin(theta)
    assert own.wrench(m).Y == pytest.approx(5.0 * G * total, rel=1e-9)


@pytest.mark.parametrize("depth", [0.0, 0.6])
@pytest.mark.parametrize("spreading", [0.0, 3.0])
def test_long_waves_push_the_hull_down_the_slope_of_the_elevation(
    depth: float, spreading: float
) -> None:
    own = sea(flat=1.0, toward=1.2, depth=depth, spreading=spreading, spectrum="jonswap")
    waves, d = field(own), 1e-4
    for t, x, y, psi in ((0.0, 0.0, 0.0, 0.0), (41.0, 3.0, -7.0, 2.0)):
        north = (waves.elevation(x + d, y, t) - waves.elevation(x - d, y, t)) / (2 * d)
        east = (waves.elevation(x, y + d, t) - waves.elevation(x, y - d, t)) / (2 * d)
        to_starboard = east * cos(psi) - north * sin(psi)
        found = own.wrench(make_motion(t=t, x=x, y=y, psi=psi))
        assert found.Y == pytest.approx(-5.0 * G * to_starboard, rel=1e-6)
        assert found.K == pytest.approx(-20.0 * to_starboard, rel=1e-6)  # towards the low side


def test_a_regular_wave_in_shallow_water_has_the_length_and_pressure_of_linear_theory() -> None:
    own = sea(spectrum="regular", modal_period=4.0, depth=0.5, toward=pi / 2, taper=0.0, beam=0.0)
    k = float(field(own).wave_number[0])
    w = 2 * pi / 4.0
    assert G * k * np.tanh(0.5 * k) == pytest.approx(w**2, rel=1e-12)
    assert k == pytest.approx(w / sqrt(G * 0.5), rel=0.03)  # long waves travel with sqrt(g h)
    m = make_motion(t=0.6)
    slope = 0.25 * k * sin(w * 0.6 + pi)
    volume = 0.25 * pi * 0.1**2 * 1.2 * 2.0  # between x = -1 and 1 half lengths
    pressure = np.cosh(k * (0.5 - 0.04)) / np.cosh(k * 0.5)
    assert own.wrench(m).Y == pytest.approx(own.density * G * volume * pressure * slope, rel=1e-9)


def zero_crossing_frequency(t: Array, x: Array) -> float:
    up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    times = t[up] - x[up] * (t[1] - t[0]) / (x[up + 1] - x[up])
    return float(2 * pi * (len(up) - 1) / (times[-1] - times[0]))


@pytest.mark.parametrize("depth", [0.0, 0.8])
def test_a_boat_meets_the_waves_at_the_frequency_of_encounter(depth: float) -> None:
    own = sea(spectrum="regular", modal_period=2.0, toward=2.4, depth=depth)
    waves, t = field(own), np.arange(0.0, 400.0, 0.02)
    w, k = float(waves.frequency[0]), float(waves.wave_number[0])
    north, east = 0.4, -0.2  # [m/s] over the ground, in still water
    met = w - k * (north * cos(2.4) + east * sin(2.4))
    assert zero_crossing_frequency(t, waves.elevation(north * t, east * t, t)) == pytest.approx(
        met, rel=1e-4
    )
    force = [own.wrench(make_motion(t=s, x=north * s, y=east * s)).Y for s in t[:4000:4].tolist()]
    assert zero_crossing_frequency(t[:4000:4], np.array(force)) == pytest.approx(met, rel=1e-3)


def test_a_boat_that_drifts_with_a_current_meets_the_waves_at_their_own_frequency() -> None:
    boat = beam_sea_boat(spectrum="regular", modal_period=2.0)
    boat = boat.with_effect({"use": "current", "north": 0.3, "east": 0.6})
    waves, t = wave_field(boat.effects), np.arange(0.0, 200.0, 0.02)
    drifting = waves.elevation(0.3 * t, 0.6 * t, t)
    moored = waves.elevation(0.0, 0.0, t)
    assert zero_crossing_frequency(t, drifting) == pytest.approx(pi, rel=1e-4)
    assert zero_crossing_frequency(t, moored) == pytest.approx(pi + pi**2 / G * 0.6, rel=1e-4)


def test_a_ship_that_keeps_her_course_meets_the_elevation_of_the_field() -> None:
    world = sea(toward=0.5, spectrum="jonswap")
    kept = field(replace(world, course_kept=1.0, speed=1.5))
    for t in (0.0, 9.0, 70.0):
        met = field(world).elevation(1.5 * t, 0.0, t)
        assert kept.elevation(33.0, -8.0, t) == pytest.approx(met, abs=1e-12)


def test_two_seas_of_a_vessel_add_up() -> None:
    boat = beam_sea_boat(name="wind_sea")
    both = boat.with_effect(
        {"use": "irregular_sea", "name": "swell", "significant_height": 0.4, "toward": 0.0}
    )
    waves = wave_field(both.effects)
    assert waves.significant_height == pytest.approx(0.5, rel=0.01)
    assert len(wave_field(vessel.load_vessel("trial_boat").effects)) == 0
    assert WaveField.calm().elevation(1.0, 2.0, 3.0) == 0.0


# ---- the compiled program, runs and logs


@pytest.mark.parametrize("spectrum", FORMULAS)
def test_the_c_library_gives_the_forces_of_the_law(spectrum: str) -> None:
    boat = beam_sea_boat(spectrum=spectrum, spreading=3.0, depth=2.0, random_amplitudes=1.0)
    own = boat.effect("irregular_sea")
    assert isinstance(own, IrregularSea)
    program = Program(boat)
    calm = replace(own, significant_height=0.0)
    still = Program(replace_effect(boat, calm))
    state = np.array([1.0, -2.0, 0.3, 0.0, 0.0, 0.0])
    act, at = np.zeros(program.actuator_signal_size), np.int64(0)
    on = program.effect_switches()
    found = []
    for one in (program, still):
        code = one.simulation_functions
        found.append(code.total_body_force(4.0, state, act, at, one.values(), on))
    waves = np.subtract(found[0], found[1])
    law = own.wrench(make_motion(t=4.0, x=1.0, y=-2.0, psi=0.3))
    assert waves == pytest.approx([law.X, law.Y, law.N], rel=1e-9, abs=1e-12)
    assert abs(law.Y) > 1e-4


def replace_effect(boat: Vessel, effect: IrregularSea) -> Vessel:
    effects = tuple(effect if e.name == effect.name else e for e in boat.effects)
    return replace(boat, effects=effects)


@pytest.mark.slow
@pytest.mark.parametrize("spectrum", [long("bretschneider"), "jonswap"])
def test_rms_of_the_roll_in_a_sea_is_that_of_linear_theory(tmp_path: Path, spectrum: str) -> None:
    """A box that only rolls: |H|^2 S integrated over the frequencies."""
    text = boats.ROLL + (
        '[[effect]]\nuse = "irregular_sea"\nsignificant_height = 0.1\nmodal_period = 4.0\n'
        f'toward = {pi / 2}\ncomponents = 160\nspectrum = "{spectrum}"\n[[effect]]\nuse = "linear_damping"\nroll = 0.2\n'
    )
    boat = vessel.load_vessel(str(boats.written(tmp_path, f"roller_{spectrum}", text)))
    own, spring = boat.effect("irregular_sea"), boat.effect("righting_arm")
    drag = boat.effect("linear_damping")
    assert isinstance(own, IrregularSea)
    inertia, stiffness = boat.body.roll_inertia, spring.stiffness  # type: ignore[union-attr]
    damping = drag.roll if drag else 0.0  # type: ignore[union-attr]
    modal = 2 * pi / 4.0

    def density(w: float) -> float:
        k, half = w * w / G, 0.5 * w * w / G * own.beam
        sides = 3 * (sin(half) - half * cos(half)) / half**3
        moment = own.stiffness * k * exp(-k * own.roll_depth) * sides
        response = moment**2 / ((stiffness - inertia * w**2) ** 2 + (damping * w) ** 2)
        return response * jonswap(w, 0.1, modal, 3.3 if spectrum == "jonswap" else 1.0)

    natural = sqrt(stiffness / inertia)
    wanted = sqrt(quad(density, 0.45 * modal, 4 * modal, points=[modal, natural], limit=400)[0])
    fleet = Batch(boat, 6, 0.1, threads=1, seeds=range(6))
    rolls = []
    fleet.advance(steps=500)
    for _ in range(3000):
        fleet.advance(steps=4)
        rolls.append(fleet.states[:, 0].copy())
    assert np.std(rolls) == pytest.approx(wanted, rel=0.02)


def test_the_elevation_in_the_log_is_that_of_the_field_at_the_boat() -> None:
    scenario = boatsim.load_scenario("eastward_ho/seas_30", duration=20.0)
    log = boatsim.run(scenario, seed=3).recording
    waves = boatsim.wave_field(scenario, seed=3)
    found = waves.elevation(log["x_m"], log["y_m"], log.t)
    assert log["wave_elevation_m"] == pytest.approx(found, abs=1e-12)
    assert np.ptp(found) > 0.5
    other = boatsim.wave_field(scenario, seed=4).elevation(log["x_m"], log["y_m"], log.t)
    assert np.abs(other - found).max() > 0.5
    assert log.unit("wave_elevation_m") == "m"


def test_a_log_in_calm_water_has_no_elevation() -> None:
    log = boatsim.run(boatsim.load_scenario("joystick_boat/sway_1", duration=0.2)).recording
    assert "wave_elevation_m" not in log.signals


# ---- refusals and files


def test_a_spectrum_that_does_not_exist_is_refused_with_the_nearest_one() -> None:
    with pytest.raises(BadInput, match="irregular_sea: spectrum 'jonswop' does not exist; did you"):
        sea(spectrum="jonswop")


@pytest.mark.parametrize("spectrum", ["jonswap", "torsethaugen", "pierson_moskowitz"])
def test_a_cut_that_loses_energy_of_any_spectrum_is_refused(spectrum: str) -> None:
    settings = {"spectrum": spectrum, "modal_period": 4.0, "significant_height": 2.0}
    with pytest.raises(BadInput, match=r"cut = 2 rad/s omits \d+ % of the energy") as refusal:
        sea(cut=2.0, **settings)
    allowed = float(str(refusal.value).partition("at least ")[2].partition(" ")[0])
    own = sea(cut=1.001 * allowed, **settings)
    assert field(own).significant_height == pytest.approx(2.0 * sqrt(0.98), rel=0.01)


def test_a_spectrum_is_kept_when_a_vessel_is_saved_and_changed(tmp_path: Path) -> None:
    boat = beam_sea_boat(spectrum="jonswap", gamma=2.0)
    again = vessel.load_vessel(str(boat.save(tmp_path / "saved").file))
    own = again.effect("irregular_sea")
    assert isinstance(own, IrregularSea)
    assert (own.spectrum, own.gamma, own.spectrum_code) == ("jonswap", 2.0, 2.0)
    changed = own.with_values({"spectrum": "torsethaugen"})
    assert changed.spectrum_code == 3.0
