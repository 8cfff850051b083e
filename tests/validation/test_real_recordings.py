"""The benchmarks on real data that need nothing outside the repository: acceptance figures and
machinery."""

import pytest
from runs import found

from boatsim.diagnosis.pipeline import Diagnosis
from validation.real import kvlcc2_roll_decay as roll
from validation.real import thesis_tables as thesis
from validation.real.thesis_runs import ThesisTest

TRUTH = {"thrust": 0.6, "astern": 0.7}  # [N], ratio


@pytest.fixture(scope="module")
def windows() -> Diagnosis:
    return roll.diagnose_windows(*roll.open_release(roll.AT_REST))


@pytest.mark.slow
def test_every_second_window_of_the_roll_decay_is_predicted_far_better_than_by_a_linear_boat(
    windows: Diagnosis,
) -> None:
    assert len(windows.findings.held_out) == 4 and not set(windows.findings.held_out) & set(
        windows.findings.runs
    )
    assert roll.error_ratio(windows) <= 0.3


@pytest.mark.slow
def test_the_middle_third_is_predicted_from_the_first_and_the_last() -> None:
    assert roll.error_ratio(roll.diagnose_thirds(*roll.open_release(roll.AT_REST))) <= 0.2


@pytest.mark.slow
def test_on_the_last_third_alone_a_constant_moment_alone_beats_the_linear_boat(
    windows: Diagnosis,
) -> None:
    _, ranking = roll.last_third_rows(windows, roll.open_release(roll.AT_REST)[0])
    assert {n.name for n in ranking.named} == {"steady_force"}
    alike = {"steady_force", "roll_offset"}  # so small a roll cannot tell them apart
    assert max(gain for name, gain in ranking.first.items() if name not in alike) < 4.0


def test_stiffening_explains_the_phase_and_damping_the_envelope(windows: Diagnosis) -> None:
    whole, _ = roll.open_release(roll.AT_REST)
    held_out = roll.map_all(windows, roll.windows_of(whole)[1::2])
    off = roll.envelope_and_phase_errors(
        windows.problem, roll.fit_one_effect_at_a_time(windows), held_out
    )
    envelope, phase = ({label: e[i] / off["linear"][i] for label, e in off.items()} for i in (0, 1))
    assert phase["+ righting_arm_stiffening"] < 0.4 < 0.9 < envelope["+ righting_arm_stiffening"]
    assert envelope["+ cubic_damping"] < 0.7 < 0.9 < phase["+ cubic_damping"]


@pytest.mark.parametrize("test", ["sway_1", "yaw_2"])
def test_fast_runs_of_the_thesis_tests_give_the_norms_of_the_engine(test: str) -> None:
    truth = {n: norm.value for n, norm in found(f"joystick_boat/{test}_as_published", 1)[0].items()}
    fast = ThesisTest(f"{test}_as_published").norms((), (), (1,))
    assert {n: fast[n] for n in truth} == pytest.approx(truth, rel=1e-3)


def test_commands_of_a_turn_can_be_played_to_another_boat() -> None:
    knobs, values = (thesis.OWN[1],), (0.2,)
    closed, played = (
        ThesisTest("yaw_1_as_published", replayed=p).norms(knobs, values, (0,))
        for p in (False, True)
    )
    fitted = ("moved", "position_inf", "position_rms", "turn_time")
    assert {n: played[n] for n in fitted} == pytest.approx({n: closed[n] for n in fitted}, rel=0.15)


@pytest.mark.slow
def test_an_effect_that_made_the_norms_is_found_in_them() -> None:
    tables = thesis.Tables(tests=("sway_1", "sway_3"))
    knobs = thesis.strengths_of(("weak_reverse",))
    made = {
        t: tables.norms(t, knobs, (TRUTH["thrust"], 0.5, TRUTH["astern"])) for t in tables.benches
    }
    tables.data = {t: {n: made[t][n] for n in tables.data[t]} for t in tables.benches}
    ranking = thesis.rank(tables, ("weak_reverse", "cross_flow_drag", "prop_walk"))
    assert ranking.best.names == ("weak_reverse",) and ranking.gains["weak_reverse"] > 4.0
    value, sd = ranking.best.value(thesis.CANDIDATES["weak_reverse"][0])
    assert value == pytest.approx(TRUTH["astern"], abs=max(2.0 * sd, 0.02))
    left = thesis.fit_without_test(tables, ranking.best, "sway_3")
    without = thesis.fit_without_test(tables, ranking.recalibrated, "sway_3")
    assert thesis.distance(tables, left, ["sway_3"]) < 0.5 * thesis.distance(
        tables, without, ["sway_3"]
    )


@pytest.mark.slow
def test_nothing_is_found_in_the_norms_of_the_nominal_itself() -> None:
    tables = thesis.Tables(tests=("sway_1",)).only(("sway_1",), facts=False)
    tables.data = {
        "sway_1": {
            n: tables.norms("sway_1", thesis.OWN, (0.4, 0.5))[n] for n in tables.data["sway_1"]
        }
    }
    assert thesis.rank(tables, ("weak_reverse", "cross_flow_drag", "prop_walk")).best.names == ()
