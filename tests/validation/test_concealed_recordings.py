"""Alterations of real recordings: each is the inverse of its fault in closed form, and leaves all
else as it was."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from boatsim.diagnosis.answer.schema import EffectEntry
from boatsim.physics.effects import thrust_deadband, weak_reverse
from boatsim.recordings.table import Recording
from validation.real.concealed import alterations as a
from validation.real.concealed.base import PatchedVesselStudy
from validation.real.concealed.cases import STUDIES, delay_cause, motor_cause
from validation.real.concealed.judging import (
    ALONE,
    FAINT,
    MISSED,
    RIGHT,
    WRONG,
    Cause,
    Size,
    Verdict,
    goal_rows,
    size_is_right,
)

PORT, STARBOARD = "thrust_port_N", "thrust_starboard_N"
NORTH, EAST = 0.2, -0.1  # [m/s]


@pytest.fixture
def run() -> Recording:
    """A boat that turns and slips while its speed changes; velocities are those of its
    positions."""
    t = np.arange(0.0, 40.0, 0.1) + 7.0
    psi = 0.3 + 0.8 * np.sin(0.2 * t)
    north, east = 1.2 * np.cos(0.1 * t), 0.5 + 0.3 * np.sin(0.15 * t)
    x, y = 12.0 * np.sin(0.1 * t), 0.5 * t - 2.0 * np.cos(0.15 * t)
    signals = {
        "x_m": x,
        "y_m": y,
        "psi_rad": psi,
        "r_radps": 0.16 * np.cos(0.2 * t),
        "u_mps": np.cos(psi) * north + np.sin(psi) * east,
        "v_mps": np.cos(psi) * east - np.sin(psi) * north,
        "phi_rad": 0.1 * np.sin(t),
        PORT: 20.0 * np.sin(0.3 * t),
        STARBOARD: 15.0 * np.cos(0.5 * t),
    }
    return Recording("made", t, signals)


def over_ground(recording: Recording) -> np.ndarray:
    """Velocities in the axes of the world (2, N), by heading and body velocities."""
    c, s = np.cos(recording["psi_rad"]), np.sin(recording["psi_rad"])
    u, v = recording["u_mps"], recording["v_mps"]
    return np.stack([c * u - s * v, s * u + c * v])


def test_a_motor_that_gives_less_of_what_is_written_gives_what_was_given(run: Recording) -> None:
    altered = a.weaken_motors((STARBOARD,), 0.8)(run)
    assert 0.8 * altered[STARBOARD] == pytest.approx(run[STARBOARD])
    assert (altered[PORT] == run[PORT]).all()


def test_a_weaker_starboard_motor_is_an_imbalance_beside_less_of_both() -> None:
    f = motor_cause(0.8, "starboard").values["fraction"]
    assert (1.0 - f) / (1.0 + f) == pytest.approx(0.8)
    assert motor_cause(0.8, "port").values["fraction"] == -f


def test_weak_reverse_and_dead_band_give_what_was_given_by_the_librarys_own_laws(
    run: Recording,
) -> None:
    weak, dead = SimpleNamespace(astern_factor=0.7), SimpleNamespace(width=3.0)
    reverse = a.weaken_motors_astern((PORT,), 0.7)(run)[PORT]
    band = a.add_dead_band((PORT,), 3.0)(run)[PORT]
    assert [weak_reverse.scale_astern_thrust.py_func(x, weak) for x in reverse] == pytest.approx(
        run[PORT].tolist()
    )
    assert [thrust_deadband.apply_deadband.py_func(x, dead) for x in band] == pytest.approx(
        run[PORT].tolist()
    )


def test_a_command_of_nothing_stays_nothing_in_a_dead_band() -> None:
    still = Recording("still", np.arange(3.0), {PORT: np.zeros(3)})
    assert (a.add_dead_band((PORT,), 3.0)(still)[PORT] == 0.0).all()


def test_a_rudder_that_is_off_or_steers_harder_gives_what_was_given(run: Recording) -> None:
    off, harder = (
        a.offset_commands((PORT,), 0.3)(run)[PORT],
        a.steer_harder_to_one_side((PORT,), 0.25)(run)[PORT],
    )
    assert off + 0.3 == pytest.approx(run[PORT])
    assert harder + 0.25 * np.abs(harder) == pytest.approx(run[PORT])


@pytest.mark.parametrize("seconds", [0.4, -0.4])
def test_commands_written_so_much_earlier_arrive_when_they_were_given(
    run: Recording, seconds: float
) -> None:
    altered = a.delay_commands((PORT, STARBOARD), seconds)(run)
    given = np.interp(altered.t + seconds, run.t, run[PORT])
    assert altered[PORT] == pytest.approx(given)
    assert altered["x_m"] == pytest.approx(np.interp(altered.t, run.t, run["x_m"]))
    assert len(altered) == len(run) - 4


def test_late_commands_are_a_late_clock_and_early_ones_nothing_else() -> None:
    assert {c.name for c in delay_cause(0.4).either} == {"command_delay", "clock_offset"}
    assert {c.name for c in delay_cause(-0.4).either} == {"clock_offset"}


def test_galilei_keeps_speeds_through_the_water_and_moves_positions_as_speeds_over_ground(
    run: Recording,
) -> None:
    altered = a.add_current(NORTH, EAST)(run)
    water = np.array([[NORTH], [EAST]])
    assert over_ground(altered) - water == pytest.approx(over_ground(run))
    rate = np.gradient(np.stack([altered["x_m"], altered["y_m"]]), altered.t, axis=1)
    assert rate[:, 1:-1] == pytest.approx(over_ground(altered)[:, 1:-1], abs=1e-3)
    assert a.add_current(-NORTH, -EAST)(altered)["x_m"] == pytest.approx(run["x_m"])


def test_a_compass_that_is_off_leaves_positions_and_speeds_over_ground(run: Recording) -> None:
    altered = a.add_compass_error(0.1, 0.2, -0.15)(run)
    off = altered["psi_rad"] - run["psi_rad"]
    assert off == pytest.approx(0.1 + 0.2 * np.cos(run["psi_rad"]) - 0.15 * np.sin(run["psi_rad"]))
    assert over_ground(altered) == pytest.approx(
        over_ground(run)
    )  # it resolves them along what it shows
    assert altered["r_radps"][1:-1] == pytest.approx(
        np.gradient(altered["psi_rad"], run.t)[1:-1], abs=1e-3
    )
    assert (altered["x_m"] == run["x_m"]).all()


def test_another_point_of_the_hull_keeps_its_distance_and_moves_as_its_positions(
    run: Recording,
) -> None:
    altered = a.move_antenna(0.4, -0.3)(run)
    arm = np.stack([altered[n] - run[n] for n in ("x_m", "y_m")])
    assert np.hypot(*arm) == pytest.approx(0.5)
    rate = np.gradient(np.stack([altered["x_m"], altered["y_m"]]), run.t, axis=1)
    assert rate[:, 1:-1] == pytest.approx(over_ground(altered)[:, 1:-1], abs=1e-3)


def test_late_fixes_are_positions_of_before(run: Recording) -> None:
    altered = a.delay_positions(0.3)(run)
    assert altered["x_m"] == pytest.approx(np.interp(altered.t - 0.3, run.t, run["x_m"]))
    assert altered["psi_rad"] == pytest.approx(np.interp(altered.t, run.t, run["psi_rad"]))


def test_positions_stretched_and_shrunk_again_are_the_same(run: Recording) -> None:
    altered = a.stretch_positions(1 / 1.25 - 1.0, 1.0)(a.stretch_positions(0.25, -0.5)(run))
    assert altered["x_m"] == pytest.approx(run["x_m"]) and altered["y_m"] == pytest.approx(
        run["y_m"]
    )


def test_a_roll_shown_more_is_the_restoring_stiffness_times_it_in_a_linear_law(
    run: Recording,
) -> None:
    stiffness, offset = 822.3, 0.012
    shown = a.alter_roll(offset)(run)["phi_rad"]
    assert -stiffness * shown + stiffness * offset == pytest.approx(-stiffness * run["phi_rad"])


def test_a_slow_clock_and_a_scaled_roll_divide_an_oscillators_laws_as_said() -> None:
    t, (omega, damping) = np.linspace(0.0, 20.0, 4001), (2.5, 0.1)
    phi = 0.2 * np.exp(-damping * t) * np.cos(omega * t)
    altered = a.alter_roll(0.0, 0.5)(a.scale_clock(1.5)(Recording("decay", t, {"phi_rad": phi})))
    rate = np.gradient(altered["phi_rad"], altered.t)
    k, d = (omega**2 + damping**2) / 1.5**2, 2.0 * damping / 1.5
    left = np.gradient(rate, altered.t) + d * rate + k * altered["phi_rad"]
    assert np.abs(left[5:-5]).max() < 1e-3 * k * 0.1


def test_another_frame_is_the_same_motion(run: Recording) -> None:
    altered = a.chain(a.rotate_axes(0.7), a.shift_origin(3.0, -4.0), a.shift_clock(50.0))(run)
    steps = [np.hypot(np.diff(r["x_m"]), np.diff(r["y_m"])) for r in (run, altered)]
    assert steps[0] == pytest.approx(steps[1])
    assert altered["u_mps"] == pytest.approx(run["u_mps"])
    assert altered.t - 50.0 == pytest.approx(run.t)


def test_nothing_is_changed_in_place(run: Recording) -> None:
    before = {n: x.copy() for n, x in run.signals.items()}
    for alter in (
        a.add_current(1.0, 1.0),
        a.add_dead_band((PORT,), 1.0),
        a.add_compass_error(0.1),
        a.alter_roll(0.1),
        a.delay_positions(0.5),
    ):
        alter(run)
    assert all((run[n] == x).all() for n, x in before.items())


def entry(name: str, value: float, sd: float, tied: tuple[str, ...] = ()) -> EffectEntry:
    parameters = {"width_N": {"value": value, "sd": sd, "unit": "N"}}
    return {"name": name, "parameters": parameters, "tied_with": list(tied)}  # type: ignore[typeddict-item]


def test_a_size_is_right_within_two_sds_or_fifteen_percent() -> None:
    cause = Cause("thrust_deadband", {"width_N": 4.0})
    assert size_is_right(entry("thrust_deadband", 4.5, 0.01), cause)
    assert size_is_right(entry("thrust_deadband", 6.0, 1.1), cause)
    assert not size_is_right(entry("thrust_deadband", 6.0, 0.5), cause)


def test_a_size_may_be_that_of_the_alteration_and_what_the_boat_has_itself() -> None:
    band = Cause("thrust_deadband", {"width_N": 4.0})
    assert size_is_right(entry("thrust_deadband", 7.0, 0.1), band, {"width_N": Size(2.9, 0.2)})
    assert not size_is_right(entry("thrust_deadband", 5.2, 0.1), band, {"width_N": Size(2.9, 0.2)})
    assert Size(0.65, 0.0).with_own(Size(0.8, 0.1, absent=1.0)) == Size(0.65 * 0.8, 0.65 * 0.1, 1.0)


def test_shares_count_visible_causes_apart_from_those_that_can_not_be_told() -> None:
    some = [(RIGHT, 20.0), (MISSED, 9.0), (WRONG, 2.0), (ALONE, None), (FAINT, 5.0)]
    named, wrong, alone = (
        cells[1] for cells in goal_rows([Verdict(o, "", gain) for o, gain in some])
    )
    assert named.startswith("1 of 2") and wrong.startswith("1 of 5") and alone.startswith("2 of 3")


@pytest.mark.slow
@pytest.mark.long
def test_what_is_concealed_in_a_release_is_named_with_its_size(tmp_path: Path) -> None:
    study = next(s for s in STUDIES if s.name == "roll_at_rest")
    patched = PatchedVesselStudy(study, tmp_path)
    some = [
        c
        for c in patched.cases()
        if c.name.startswith(("roll reading 0.012 rad more", "clock 500", "cubic_damping"))
    ]
    verdicts = [patched.verdict(c) for c in some]
    assert [v.outcome for v in verdicts] == [RIGHT, RIGHT, ALONE, RIGHT], [
        v.answer for v in verdicts
    ]
