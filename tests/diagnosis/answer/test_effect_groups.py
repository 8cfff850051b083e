"""Missing physics, refined numbers and effects of unknown size are separated in the answer."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import boats
import numpy as np
import pytest
from unmeasured import unmeasured

from boatsim.diagnosis.answer.effect_groups import EffectGroups, classify_effects
from boatsim.diagnosis.answer.parameters import parameter_key, reported_sd
from boatsim.diagnosis.answer.refined_numbers import main_refinement, refined_number_rows
from boatsim.diagnosis.answer.schema import EffectEntry
from boatsim.diagnosis.answer.verdict import verdict_sentences
from boatsim.diagnosis.candidates import diagnosis_program
from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.report.sections import report_sections
from boatsim.diagnosis.report.sentences import console_lines
from boatsim.physics import vessel
from boatsim.view.page_blocks import Table
from tests.diagnosis.report.test_page import planar

ESTIMATED = (
    "[estimated]\ndamping = 1.0\nthrust = 0.3\nadded_mass = 0.4\nlag = 1.0\nmass_centre = 1.0\n"
)
Fitted = Mapping[str, Mapping[str, tuple[float, float]]]
FITTED: Fitted = {  # value and standard deviation by effect and parameter
    "thrust_lag": {"time_constant": (0.31, 0.02)},
    "added_mass_error": {
        "surge_factor": (1.0, 0.3),
        "sway_factor": (1.5, 0.05),
        "yaw_factor": (0.8, 0.1),
    },
    "weak_reverse": {"astern_factor": (0.7, 0.01)},
    "sway_yaw_coupling": {"sway": (15.0, 154.0), "yaw": (0.2, 3.0)},
    "further_quadratic_damping": {"surge": (4.0, 0.5), "sway": (0.1, 9.0), "yaw": (0.0, 0.3)},
}


def groups_of(
    text: str,
    folder: Path,
    coefficients: Mapping[tuple[str, str], tuple[float, float]] | None = None,
    fitted: Fitted = FITTED,
) -> EffectGroups:
    """The effect groups of a fit that is made up: effects, and factors of coefficients."""
    boat = vessel.load_vessel(str(boats.written(folder, "test_boat", boats.PLANAR + text)))
    program, _ = diagnosis_program(boat)
    mapped = unmeasured(program)
    levels = NoiseLevels(np.ones(3), 1.0, {"heading_sd_rad": 0.01})
    problem = Problem([mapped], levels, {"damping": 1.0, "thrust": 0.3})
    free = problem.free_parameters(tuple(fitted))
    theta, sds = [], []
    for f in free:
        value = (coefficients or {}).get((f.effect, f.name), (1.0, 0.01))
        if not f.relative:
            value = fitted[f.effect][f.name]
        theta.append(value[0])
        sds.append(value[1])
    best = Fit(tuple(fitted), free, np.array(theta), np.diag(np.square(sds)), levels, -1.0)
    entries = {}
    for name, values in fitted.items():
        entries[name] = entry_of(problem, best, name, values)
    return classify_effects(problem, best, entries)


def entry_of(
    problem: Problem, best: Fit, name: str, values: Mapping[str, tuple[float, float]]
) -> EffectEntry:
    effect = problem.candidates[name]
    parameters = {}
    for key, (value, _) in values.items():
        unit = type(effect).params()[key].unit
        sd = reported_sd(best, effect, key, problem.config.answer)
        parameters[parameter_key(key, unit)] = {"value": value, "sd": sd, "unit": unit}
    return {
        "name": name.removeprefix("further_"), "kind": "physics", "probability": 1.0,
        "gain_nats": 20.0, "words": name, "tied_with": [], "parameters": parameters,
    }  # type: ignore[typeddict-item]  # fmt: skip


def test_without_estimates_every_effect_of_known_size_is_missing_physics(tmp_path: Path) -> None:
    groups = groups_of("", tmp_path, {("linear_damping", "surge"): (1.4, 0.02)})
    names = [e["name"] for e in groups.effects]
    assert names == ["thrust_lag", "added_mass_error", "weak_reverse", "quadratic_damping"]
    assert not groups.refined


def test_an_effect_smaller_than_its_spread_is_only_possible(tmp_path: Path) -> None:
    (possible,) = groups_of("", tmp_path).also_possible
    assert possible["name"] == "sway_yaw_coupling" and possible["gain_nats"] == 20.0
    assert "do not determine its size: sway 15 ± 154 kg and yaw" in possible["why"]


def test_better_values_of_estimates_are_refined_numbers(tmp_path: Path) -> None:
    coefficients = {
        ("linear_damping", "surge"): (1.4, 0.02),
        ("linear_damping", "sway"): (1.4, 0.3),
    }
    groups = groups_of(ESTIMATED, tmp_path, coefficients)
    assert [e["name"] for e in groups.effects] == ["weak_reverse"]
    refined = {e["number"]: e for e in groups.refined}
    # those that differ by less than their sd are left out; sway damping is within two
    assert list(refined) == [
        "thrust lag",
        "added mass in sway",
        "added mass in yaw",
        "quadratic damping in surge",
        "linear damping in surge",
    ]
    lag = refined["thrust lag"]
    assert (lag["before"], lag["after"], lag["off"], lag["unit"]) == (0.0, 0.31, None, "s")
    assert lag["gain_nats"] == 20.0 and "time_constant_s" in lag["parameters"]
    mass = refined["added mass in sway"]
    assert (mass["before"], mass["after"], mass["unit"]) == (3.0, pytest.approx(4.5), "kg")
    assert mass["off"] == pytest.approx(0.5) and mass["sd"] == pytest.approx(3.0 * 0.05, rel=0.3)
    more = refined["quadratic damping in surge"]
    assert (more["before"], more["after"]) == (8.0, pytest.approx(12.0))
    damping = refined["linear damping in surge"]
    assert (damping["before"], damping["after"]) == (3.0, pytest.approx(4.2))
    assert damping["name"] == "linear_damping.surge" and "parameters" not in damping


def test_a_number_alone_may_be_an_estimate(tmp_path: Path) -> None:
    groups = groups_of('[estimated]\n"thrust_lag.time_constant" = 1.0\n', tmp_path)
    assert [e["number"] for e in groups.refined] == ["thrust lag"]
    assert "added_mass_error" in [e["name"] for e in groups.effects]


WEIGHED, STATED = "", '[estimated]\n"body.mass" = 0.1\n'


@pytest.mark.parametrize(
    ("text", "spreads", "sd", "refined"),
    [
        pytest.param(STATED, 2.0, 0.01, True, id="within the spread of the owner's mass"),
        pytest.param(STATED, 4.0, 0.01, False, id="a load, for it is much larger"),
        pytest.param(STATED, 4.0, 0.2, True, id="not clearly larger"),
        pytest.param(WEIGHED, 2.0, 0.01, False, id="a load, for the boat was weighed"),
    ],
)
def test_a_load_is_missing_physics_beyond_the_uncertainty_of_the_mass(
    text: str, spreads: float, sd: float, refined: bool, tmp_path: Path
) -> None:
    mass = vessel.load_vessel(str(boats.written(tmp_path, "as_it_is", boats.PLANAR))).body.mass
    load = {"mass": (0.1 * spreads * mass, sd * mass), "x": (0.1, 0.01)}
    groups = groups_of(text, tmp_path, fitted={"extra_mass": load})
    if not refined:
        assert [e["name"] for e in groups.effects] == ["extra_mass"] and not groups.refined
        return
    (entry,) = groups.refined
    assert not groups.effects and (entry["number"], entry["unit"]) == ("mass", "kg")
    assert (entry["before"], entry["after"]) == (mass, pytest.approx(mass * (1.0 + 0.1 * spreads)))


def test_where_positions_are_recorded_is_a_refined_number_if_the_mass_centre_is_unknown(
    tmp_path: Path,
) -> None:
    fitted = {"position_frame_error": {"forward": (0.12, 0.01), "starboard": (0.0, 0.01)}}
    text = '[estimated]\n"position_frame_error.forward" = 1.0\n'
    (entry,) = groups_of(text, tmp_path, fitted=fitted).refined
    assert (entry["before"], entry["after"], entry["unit"]) == (0.0, 0.12, "m")
    assert entry["number"] == "distance of the recorded point ahead of the origin"
    assert [e["name"] for e in groups_of("", tmp_path, fitted=fitted).effects] == [
        "position_frame_error"
    ]


def test_the_verdict_and_the_report_have_the_refined_numbers_last(tmp_path: Path) -> None:
    findings = planar()
    refined = groups_of(ESTIMATED, tmp_path).refined
    possible = groups_of(ESTIMATED, tmp_path).also_possible
    answer = findings.answer | {"refined": refined, "also_possible": possible}
    sentence = verdict_sentences(answer)
    assert sentence.endswith("Four numbers of the rough model were refined.")
    assert sentence.startswith("The model leaves out one effect")
    answer |= {"effects": [], "verdict": "nothing_missing"}
    assert verdict_sentences(answer).startswith(
        "No missing effect was found: with four numbers of the rough model refined"
    )
    assert refined_number_rows(answer)[0][0] == "thrust lag"
    assert refined_number_rows(answer)[0][-1] == "not in the file"
    assert refined_number_rows(answer)[1][-1] == "+50 %"
    assert replace(findings, answer=answer).has_added_effects


def test_log_and_missing_physics_stand_before_the_refined_numbers(tmp_path: Path) -> None:
    findings = planar()
    groups = groups_of(ESTIMATED, tmp_path)
    error = findings.answer["effects"][0] | {"name": "clock_offset", "kind": "measurement"}
    answer = findings.answer | {
        "effects": [*findings.answer["effects"], error],
        "refined": groups.refined,
        "also_possible": groups.also_possible,
    }
    findings = replace(findings, answer=answer)
    titles = [line for line in console_lines(findings) if line.endswith(":")]
    assert titles[:4] == [
        "Errors of the recordings:",
        "Missing physics:",
        "Numbers refined:",
        "Also possible:",
    ]
    shown = [section.title for section in report_sections(findings) if section.blocks]
    assert shown[:4] == [
        "Problems of the recordings",
        "Missing physics",
        "Numbers refined",
        "Also possible",
    ]


def test_an_effect_that_is_only_possible_is_shown_with_its_values() -> None:
    findings = planar()
    effect = findings.answer["effects"][0]
    possible = {
        "name": effect["name"],
        "probability": 0.3,
        "gain_nats": 12.0,
        "words": effect["words"],
        "why": "its size differs between the recordings",
        "parameters": effect["parameters"],
    }
    answer = findings.answer | {"effects": [], "also_possible": [possible]}
    sections = report_sections(replace(findings, answer=answer))
    blocks = next(one.blocks for one in sections if one.title == "Also possible")
    (table,) = [block for block in blocks if isinstance(block, Table)]
    shown = [row[0].replace(" ", "_") for row in table.rows]
    assert len(shown) == len(effect["parameters"]) > 0
    assert all(key.startswith(name) for key, name in zip(effect["parameters"], shown, strict=True))


def test_the_verdict_states_the_surest_refined_number_with_the_most_evidence(
    tmp_path: Path,
) -> None:
    refined: Any = groups_of(ESTIMATED, tmp_path).refined
    assert main_refinement({"refined": refined}) == ""
    refined[0] |= {"confirmed": True, "probability": 0.9, "gain_nats": 20.0}
    refined[1] |= {"confirmed": True, "probability": 0.8, "gain_nats": 30.0}
    refined[2] |= {"confirmed": False, "probability": 0.9, "gain_nats": 40.0}
    refined[3] |= {"confirmed": True, "probability": 0.3, "gain_nats": 50.0}
    answer: Any = planar().answer | {"refined": refined}
    before, after = refined_number_rows(answer)[1][1:3]
    main = f"{refined[1]['number']} ({after} instead of {before})"
    ending = f"Four numbers of the rough model were refined, above all {main}."
    assert verdict_sentences(answer).endswith(ending)
    answer["refined"] = refined[:1]
    after = refined_number_rows(answer)[0][2]
    ending = f"One number of the rough model was refined: thrust lag ({after})."
    assert verdict_sentences(answer).endswith(ending)
