"""Response operators: against a solution in the frequency domain, in the limit of long waves, and
their files."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.errors import BadInput
from boatsim.hydrodynamics.rao_csv import read_rao_csv
from boatsim.physics.base import AXES, Array
from boatsim.physics.effects.radiation_memory import RadiationMemory
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.wave_response import usual_periods, wave_response
from boatsim.view.response_plot import response_plot
from validation.waves.boats import linear_response
from validation.waves.response import SPRINGS, FloatingCatamaran

OTTER = {"use": "strip_wave_loads", "hull_spacing": 0.79, "hull_beam": 0.25}


def test_responses_are_those_of_the_frequency_domain(tmp_path: Path) -> None:
    catamaran = FloatingCatamaran()
    boat = catamaran.vessel(tmp_path / "catamaran", AXES).without_effect("ground_spring")
    stiffness = catamaran.stiffness.copy()
    for axis, spring in SPRINGS.items():  # those of the validation; here they are much softer
        stiffness[AXES.index(axis), AXES.index(axis)] -= spring
    periods, directions = [1.2, 2.0, 3.0], [0.5 * np.pi, 0.75 * np.pi]
    found = wave_response(boat, directions, periods, 0.002)
    assert found.steady.all() and found.dof == AXES
    frequency = 2.0 * np.pi / np.array(periods)
    expected = np.array(
        [
            linear_response(
                catamaran.coefficients, catamaran.body, stiffness, AXES, frequency, direction
            )
            for direction in directions
        ]
    )
    largest = np.abs(expected).max(axis=(0, 1))
    # the springs change surge, sway and yaw by 0.25 %
    errors = np.abs(found.operators - expected).max(axis=(0, 1)) / largest
    assert errors.max() < 0.01


def response_at_speed(
    catamaran: FloatingCatamaran, period: float, direction: float, speed: float, terms: bool
) -> Array:
    """Surge, heave and pitch (3,) in the frequency domain, in axes that move with the speed.

    Added mass and damping are those of strip theory at forward speed, or those of the equations in
    body axes, in which the Coriolis force of the added mass is that at infinite frequency. Both
    contain the Coriolis force of the added mass in surge, which strip theory leaves out.
    """
    own, axes = catamaran.coefficients, [0, 2, 4]
    block = np.ix_(axes, axes)
    w0 = 2.0 * np.pi / period
    w = w0 - w0**2 / GRAVITY * speed * np.cos(direction)
    impedance = CubicSpline(own.frequency, own.damping)(w)[block]
    impedance = impedance + 1j * w * CubicSpline(own.frequency, own.added_mass)(w)[block]
    added = own.infinite_added_mass[block]
    velocity = 1j * w * np.eye(3)  # in body axes, per motion
    velocity[1, 2] += speed
    radiated = impedance @ velocity
    momentum = added @ velocity
    if terms:  # with the momentum of the memory in heave
        momentum[1] = radiated[1] / (1j * w)
    # (X, Z, M) = (-P3 q, P1 q, P3 u - P1 w), linear about P = A (U, 0, 0)
    coriolis = np.zeros((3, 3), dtype=complex)
    coriolis[0] = -added[1, 0] * speed * velocity[2]
    coriolis[1] = added[0, 0] * speed * velocity[2]
    coriolis[2] = speed * momentum[1] + added[1, 0] * speed * velocity[0]
    coriolis[2] -= added[0, 0] * speed * velocity[1]
    stiffness = catamaran.stiffness[block] - np.diag([SPRINGS["surge"], 0.0, 0.0])
    dynamic = stiffness - w * w * catamaran.body[block] + radiated - coriolis
    table = CubicSpline(own.heading, own.excitation, axis=1)(direction)
    return np.linalg.solve(dynamic, CubicSpline(own.frequency, table)(w0)[axes])


@pytest.mark.parametrize("terms", [False, True])
def test_responses_at_speed_are_those_of_the_frequency_domain(terms: bool, tmp_path: Path) -> None:
    catamaran = FloatingCatamaran()
    dof = ("surge", "heave", "pitch")
    boat = catamaran.vessel(tmp_path / "catamaran", dof).without_effect("ground_spring")
    effects = []
    for effect in boat.effects:
        if isinstance(effect, RadiationMemory):
            effect = replace(effect, forward_speed=float(terms))
        effects.append(effect)
    boat, speed = replace(boat, effects=tuple(effects)), 1.1
    periods, directions = [1.5, 2.0, 2.6], [np.pi, 0.75 * np.pi]
    found = wave_response(boat, directions, periods, 0.002, speed=speed)
    assert found.steady.all() and found.speed == speed
    expected = []
    for direction in directions:
        row = [response_at_speed(catamaran, one, direction, speed, terms) for one in periods]
        expected.append(row)
    errors = np.abs(found.operators - np.array(expected))[..., 1:] / np.abs(expected)[..., 1:]
    assert errors.max() < 0.02  # of each heave and pitch, with their phases
    other = response_at_speed(catamaran, 2.0, np.pi, speed, not terms)
    assert abs(other[2] / found.operators[0, 1, 2] - 1.0) > 0.05  # which can tell both apart


def test_the_speed_through_the_water_counts_not_that_over_ground(tmp_path: Path) -> None:
    catamaran = FloatingCatamaran()
    dof = ("surge", "sway", "heave", "pitch")
    boat = catamaran.vessel(tmp_path / "catamaran", dof).without_effect("ground_spring")
    effects = []
    for effect in boat.effects:
        if isinstance(effect, RadiationMemory):
            effect = replace(effect, forward_speed=1.0)
        effects.append(effect)
    boat = replace(boat, effects=tuple(effects))
    against = boat.with_effect({"use": "current", "north": -0.4, "east": 0.0})
    still = wave_response(boat, [np.pi], [1.8], 0.002, speed=0.9)
    carried = wave_response(against, [np.pi], [1.8], 0.002, speed=0.5)
    assert still.steady.all() and carried.steady.all()
    assert carried.operators[0, 0, 2:] == pytest.approx(still.operators[0, 0, 2:], rel=0.01)
    slower = wave_response(boat, [np.pi], [1.8], 0.002, speed=0.5)
    assert abs(slower.operators[0, 0, 3] / still.operators[0, 0, 3] - 1.0) > 0.05


def test_without_speed_through_the_waves_there_is_no_response() -> None:
    """A boat as fast as the waves meets none of them."""
    boat = load_vessel("otter")
    period = 2.0
    speed = 9.81 * period / (2.0 * np.pi)  # of the waves
    found = wave_response(boat, [0.0], [period], 0.02, OTTER, speed=speed)
    assert not found.steady.any() and np.isnan(found.operators).all()


def test_a_boat_follows_the_surface_of_long_waves() -> None:
    boat, period = load_vessel("otter"), 12.0
    found = wave_response(boat, [0.0, 0.5 * np.pi], [period], 0.02, OTTER)
    number = (2.0 * np.pi / period) ** 2 / 9.81
    astern, port = np.abs(found.operators[:, 0])
    axis = AXES.index
    assert astern[axis("heave")] == pytest.approx(1.0, abs=0.01)
    assert astern[axis("pitch")] == pytest.approx(number, rel=0.03)  # the slope of the surface
    assert port[axis("roll")] == pytest.approx(number, rel=0.05)
    assert astern[axis("roll")] < 1e-6 > astern[axis("sway")]  # mirror image
    # a crest lifts the boat; z is down
    assert np.exp(1j * np.angle(found.operators[0, 0, axis("heave")])) == pytest.approx(
        -1.0, abs=0.02
    )


def test_usual_periods_belong_to_waves_of_half_to_ten_lengths() -> None:
    periods = usual_periods(2.0, 5)
    lengths = 9.81 * periods**2 / (2.0 * np.pi)
    assert lengths[[0, -1]] == pytest.approx([1.0, 20.0])
    assert np.ptp(lengths[1:] / lengths[:-1]) < 1e-12


def test_waves_that_exert_no_force_are_refused() -> None:
    with pytest.raises(BadInput, match="exert no force"):
        wave_response(load_vessel("otter"), [0.0], [2.0], 0.0, OTTER)


def invoked(*words: str) -> tuple[int, str]:
    """Exit code and output of `boatsim manoeuvre`."""
    done = CliRunner().invoke(app, ["manoeuvre", *words], catch_exceptions=False)
    return done.exit_code, " ".join(done.output.split())


def test_the_command_writes_a_table_and_a_figure(tmp_path: Path) -> None:
    words = ["response", "--vessel", "otter", "--directions", "0,90", "--periods", "2,3"]
    waves = ["--waves", "strip_wave_loads,hull_spacing=0.79,hull_beam=0.25"]
    code, printed = invoked(*words, *waves, "--out", str(tmp_path / "out"))
    assert code == 0 and "regular waves of 0.02 m" in printed
    rows = list(csv.DictReader((tmp_path / "out" / "response.csv").open()))
    assert len(rows) == 4 and {row["period_s"] for row in rows} == {"2", "3"}
    heave = [float(row["heave_m_per_m"]) for row in rows if row["direction_rad"] == "0"]
    assert 0.5 < heave[0] < heave[1] < 1.0
    one = [*words[:-1], "2", "--out", str(tmp_path / "one")]  # a single point
    assert invoked(*one, "--waves", "strip_wave_loads")[0] == 0
    figure = (tmp_path / "out" / "response.svg").read_text(encoding="utf-8")
    assert figure.startswith("<svg") and "pitch [rad/m]" in figure and "(from port)" in figure


@pytest.mark.slow
def test_a_table_at_speed_states_it_for_those_who_read_it(tmp_path: Path) -> None:
    words = ["response", "--vessel", "otter", "--speed", "0.5", "--periods", "2,2.5,3"]
    waves = ["--waves", "strip_wave_loads,hull_spacing=0.79,hull_beam=0.25"]
    code, printed = invoked(*words, *waves, "--out", str(tmp_path / "out"))
    assert code == 0 and "at 0.5 m/s, held by soft springs" in printed
    table = read_rao_csv(tmp_path / "out" / "response.csv", 0.0)
    assert table.speed == 0.5 and table.kind == "motion"
    figure = (tmp_path / "out" / "response.svg").read_text(encoding="utf-8")
    assert "at 0.5 m/s" in figure


def test_a_vessel_that_is_held_in_surge_has_no_speed(tmp_path: Path) -> None:
    boat = FloatingCatamaran().vessel(tmp_path / "catamaran", ("heave", "roll", "pitch"))
    with pytest.raises(BadInput, match="not free in surge; --speed is allowed for vessels that"):
        wave_response(boat, [np.pi], [2.0], 0.002, speed=1.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--periods", "2,x"], "--periods 2,x: allowed are numbers"),
        (["--periods=-1"], "allowed are numbers from 0.2 to 40 s"),
        (["--directions", "400"], "allowed are numbers from -360 to 360 deg"),
        (["--waves", "strip_wave_loads,toward=1"], "toward does not apply"),
        (
            ["--waves", "fan_wind"],
            "fan_wind is no effect of waves; allowed are drive_ventilation, hull",
        ),
        (["--waves", "strip_wave_loads,4"], "'4' is no parameter"),
        (["--waves", "strip_wave_lods"], "did you mean 'strip_wave_loads'"),
        (["--speed", "60"], "--speed 60: allowed is a number from 0 to 50 m/s"),
        (["--angle", "20"], "--angle does not apply to response"),
    ],
)
def test_bad_input_is_one_line(options: list[str], message: str, tmp_path: Path) -> None:
    out = ["--out", str(tmp_path / "out")]
    code, printed = invoked("response", "--vessel", "otter", *out, *options)
    assert code == 2 and message in printed and not (tmp_path / "out").exists()


def test_options_of_a_response_do_not_apply_to_other_manoeuvres() -> None:
    code, printed = invoked("zigzag", "--vessel", "otter", "--periods", "2")
    assert code == 2 and "--periods does not apply to zigzag" in printed


def test_a_figure_without_steady_responses_has_axes_only() -> None:
    sizes = np.full((1, 2, 1), np.nan)
    figure = response_plot("none", ["heave [m/m]"], "x", np.array([1.0, 2.0]), np.zeros(1), sizes)
    assert "<path" not in figure and "heave" in figure
