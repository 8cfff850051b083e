"""Laws that the diagnosis writes down itself: their terms in closed form, and what it describes of
unknown causes."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import cos, exp, pi, sin, tanh
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import boats
import numpy as np
import pytest
from pushed_boat import BOAT, COMMANDS, Late, Missing, sail

from boatsim.diagnosis.answer.described_terms import described_entries
from boatsim.diagnosis.candidates import candidate_library, diagnosis_program
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.description import FittedTerm
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.output import patched_vessel
from boatsim.diagnosis.pipeline import Diagnosis, diagnose_loaded
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.symbolic import grammar
from boatsim.errors import BadInput
from boatsim.physics import content, terms, vessel
from boatsim.physics.base import Array, Motion, Wrench, make_motion
from boatsim.physics.described_laws import EVER
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.effects.described_thrust import DescribedThrust
from boatsim.physics.effects.thruster import Thruster
from boatsim.physics.program import Program
from boatsim.recordings.table import Notes, Recording

ACTS = np.array([0.8, -0.4, 0.3, 0.1, cos(0.3), sin(0.3), cos(0.1), sin(0.1)])  # of the trial boat
AT = make_motion(t=7.0, x=2.0, y=-3.0, phi=0.1, psi=0.7, u=1.5, v=-0.4, p=0.02, r=0.6)
CLOSED: Mapping[str, tuple[dict[str, Any], Callable[[Motion], float]]] = {
    "constant": ({"of": []}, lambda m: 1.0),
    "product": ({"of": ["surge_speed", "yaw_rate"]}, lambda m: m.ur * m.r),
    "square with its sign": ({"of": ["sway_speed", "abs_sway_speed"]}, lambda m: m.vr * abs(m.vr)),
    "cube": ({"of": ["yaw_rate"] * 3}, lambda m: m.r**3),
    "sense": ({"of": "sign_roll_rate", "little": 0.05}, lambda m: tanh(m.p / 0.05)),
    "command": ({"of": ["thrust_port_N"]}, lambda m: 0.8),
    "size of a command": ({"of": ["abs_thrust_starboard_N", "surge_speed"]}, lambda m: 0.4 * m.ur),
    "twice the heading": ({"of": ["sin_twice_heading"]}, lambda m: sin(2 * m.psi)),
    "ripple": (
        {"of": ["ripple_east"], "wavelength": 2.5, "crest": 0.4},
        lambda m: cos(2 * pi * (m.y - 0.4) / 2.5),
    ),
    "beyond": (
        {"of": ["beyond_yaw_rate", "surge_speed"], "beyond": 0.2},
        lambda m: (m.r - 0.2) * m.ur,
    ),
    "not yet beyond": ({"of": ["beyond_sway_speed"], "beyond": 0.9}, lambda m: 0.0),
    "roll angle": ({"of": ["roll_angle", "roll_angle"]}, lambda m: m.phi**2),
    "within": ({"acts": "within", "begin": 6.0, "end": 7.0}, lambda m: 0.0),
    "from then on": ({"acts": "within", "begin": 7.0}, lambda m: 1.0),
    "rising": ({"acts": "rising", "begin": 5.0, "end": 13.0}, lambda m: 0.25),
    "fading": ({"acts": "fading", "begin": 1.0, "end": 5.0}, lambda m: exp(-1.5)),
    "swinging": (
        {"of": ["north"], "acts": "swinging", "begin": 1.0, "end": 9.0},
        lambda m: m.x * sin(2 * pi * 0.75),
    ),
}


def force(effect: DescribedForce) -> Wrench:
    """At one motion, with the trial boat's actuators."""
    return effect.with_all_parameters(BOAT).wrench(AT, ACTS, 0, 0)


@pytest.mark.parametrize("name", CLOSED)
@pytest.mark.parametrize("axis", ["surge", "sway", "roll", "yaw"])
def test_a_term_is_the_product_that_its_words_say(name: str, axis: str) -> None:
    table, closed = CLOSED[name]
    found = force(DescribedForce.from_settings({"axis": axis, "coefficient": 2.5, **table}))
    component = dict(zip(terms.DIRECTIONS, Wrench._fields, strict=False))[axis]
    assert found == Wrench(**{component: pytest.approx(2.5 * closed(AT))})  # type: ignore[arg-type]


def test_a_force_towards_a_bearing_of_the_earth_turns_against_the_hull() -> None:
    north, east = (force(DescribedForce(axis=axis, coefficient=2.0)) for axis in ("north", "east"))
    assert (north.X, north.Y) == pytest.approx((2.0 * cos(0.7), -2.0 * sin(0.7)))
    assert (east.X, east.Y) == pytest.approx((2.0 * sin(0.7), 2.0 * cos(0.7)))
    assert north.N == east.N == 0.0


@pytest.mark.parametrize(
    ("table", "share"),
    [
        ({}, 0.2),
        ({"side": "port"}, 0.2),
        ({"side": "starboard"}, 0.0),
        ({"sense": "astern"}, 0.0),
        ({"sense": "ahead"}, 0.2),
        ({"of": ["abs_sway_speed"]}, 0.08),
    ],
)
def test_a_change_of_thrust_is_a_share_of_what_the_drive_gives(
    table: dict[str, Any], share: float
) -> None:
    law = DescribedThrust.from_settings({"coefficient": 0.2, **table}).with_all_parameters(BOAT)
    drive = Thruster(x=-0.6, y=-0.19, gain=1.1)
    on, found = Thruster.signals(thrust=0.8, angle=0.3), drive.wrench(AT, thrust=0.8, angle=0.3)
    more = law.wrench(AT, on, drive.values(), ACTS, 0, 0)
    assert more == pytest.approx(tuple(share * x for x in found))


@pytest.mark.parametrize(
    ("table", "line"),
    [
        ({"of": ["surge_sped"]}, "of 'surge_sped' does not exist; did you mean 'surge_speed'"),
        ({"axis": "swey"}, "axis 'swey' does not exist; did you mean 'sway'"),
        ({"acts": "sometimes"}, "acts 'sometimes' does not exist"),
        ({"of": ["north"] * 4}, "allowed are at most 3 factors"),
        ({"acts": "within", "begin": 3.0, "end": 2.0}, "allowed is an end after the begin"),
        ({"first": 3.0}, "setting 'first' does not exist"),
    ],
)
def test_words_that_do_not_exist_are_named(table: dict[str, Any], line: str) -> None:
    with pytest.raises(BadInput, match=line):
        DescribedForce.from_settings(table).with_all_parameters(BOAT)


def test_a_described_law_in_a_vessel_file_acts_on_engine_and_twin_alike(tmp_path: Path) -> None:
    law = '[[effect]]\nuse = "described_force"\naxis = "yaw"\nof = ["surge_speed", "abs_yaw_rate"]\ncoefficient = -0.4\n'
    boat = vessel.load_vessel(str(boats.written(tmp_path, "odd", boats.PLANAR + law)))
    (own,) = (e for e in boat.effects if isinstance(e, DescribedForce))
    assert own.fixed_settings() == {
        "axis": "yaw",
        "of": ["surge_speed", "abs_yaw_rate"],
        "acts": "always",
    }
    assert own.wrench(make_motion(u=2.0, r=-0.5), np.zeros(9), 0, 0).N == pytest.approx(-0.4)


def test_the_library_has_no_entry_of_its_own_for_what_is_described() -> None:
    library = candidate_library(BOAT)
    assert not [n for n in library.tested_names if n.startswith("described")]
    assert {e.name for e in library.compiled_effects} - {e.name for e in library.entries} == {
        e.name for e in library.placeholders
    }
    assert not any(
        content.load_class("effect", n).confounded_with
        for n in ("described_force", "described_thrust")
    )


# ---- unknown causes, on recordings of an integrator that shares no code with the tool


def test_no_pattern_fixed_to_the_earth_is_longer_than_the_longest_track() -> None:
    """Tracks far from each other: such a pattern would be a constant of each recording."""
    program = Program(BOAT, candidate_library(BOAT).compiled_effects)
    t, recordings = np.arange(30.0), []
    for name, start, extent in (("near", 0.0, 60.0), ("far", 9000.0, 90.0)):
        signals = {"x_m": start + extent * t / 29.0, "y_m": 0.0 * t, "psi_rad": 0.0 * t}
        commands = dict.fromkeys(COMMANDS, 0.0 * t)
        recording = Recording(name, t, signals | commands, Notes(vessel="trial_boat"))
        recordings.append(map_recording(recording, program))
    wavelengths = []
    for term in grammar.candidate_terms(BOAT, recordings, {}, (), DEFAULT.describe):
        if term.of == ("ripple_north",):
            wavelengths.append(term.wavelength)
        assert term.of != ("ripple_east",)
    assert max(wavelengths) == pytest.approx(90.0)


def swinging(t: float, y: Array, command: Array) -> Array:
    return np.array([0.0, 0.0, 0.14 * sin(2 * pi * t / 6.5)])


def even_in_yaw(t: float, y: Array, command: Array) -> Array:
    return np.array([0.0, 1.2 * y[5] ** 2, 0.0])


def of_one_run(t: float, y: Array, command: Array) -> Array:
    return np.array([0.0, 0.45 if 14.0 < t < 25.0 else 0.0, 0.0])


def nothing(t: float, y: Array, command: Array) -> Array:
    return np.zeros(3)


def diagnosed(*causes: Missing, late: Late | None = None) -> Diagnosis:
    """Of recordings under these causes, the last one held out."""
    runs = [sail(f"run_{i + 1}", 40 + i, cause, late=late)[0] for i, cause in enumerate(causes)]
    return diagnose_loaded(LoadedRecordings(runs[:-1], runs[-1:], {None: BOAT}, "the last"))


def halved(found: Diagnosis, signal: str) -> bool:
    """Whether the patched boat errs half as much as the recalibrated one on held-out data."""
    rms = found.findings.answer["fit"][signal]  # type: ignore[literal-required]
    return bool(rms["patched"] < 0.5 * rms["recalibrated"])


def replays(found: Diagnosis, held_out: Recording, folder: Path) -> None:
    """Whether the patched vessel does on a held-out recording what the fitted one does."""
    patched_vessel.write_patched_vessel(
        found.problem,
        found.vessel,
        found.ranking.best,
        folder / "patched.toml",
        found.ranking.described_terms,
    )
    program, on = diagnosis_program(vessel.load_vessel(str(folder / "patched.toml")))
    fit, levels = found.ranking.best, found.ranking.best.levels
    laid = map_recording(held_out, found.problem.program)
    for slot, term in found.ranking.described_terms.items():
        for key, x in term.with_all_parameters(BOAT).law_parameters().items():
            laid.values[found.problem.program.parameter_index(slot, key)] = x
    here = found.problem.parameter_vector(laid, fit.free, fit.theta)
    again = map_recording(held_out, program)
    ours = laid.free_runs(
        here,
        found.problem.program.effect_switches(tuple(found.ranking.described_terms)),
        levels,
        6.0,
    )
    theirs = again.free_runs(again.values, program.effect_switches(on), levels, 6.0)
    for (a, path), (b, other) in zip(ours, theirs, strict=True):
        assert a == b
        np.testing.assert_allclose(
            other, path, atol=2e-3
        )  # started at each program's own smoothed state


@pytest.mark.slow
def test_a_moment_that_swings_is_described_with_its_period_and_carries_over(tmp_path: Path) -> None:
    found = diagnosed(swinging, swinging, swinging)
    answer = found.findings.answer
    assert answer["verdict"] == "described" and answer["unknown"]["flag"]
    law = answer["described"][0]
    assert (
        law["axis"] == "yaw"
        and law["carries_over"]
        and "oscillating with a period" in law["statement"]
    )
    assert law["statement"] in answer["sentence"][:1].lower() + answer["sentence"][1:]
    assert halved(found, "heading_rms_rad")
    best = next(w for w in found.findings.described if w.term.name in found.ranking.described_terms)
    assert abs(best.term.coefficient) == pytest.approx(0.14, abs=3 * best.sd)
    assert best.term.end - best.term.begin == pytest.approx(6.5, rel=0.01)
    replays(found, sail("run_3", 42, swinging)[0], tmp_path)


@pytest.mark.slow
@pytest.mark.long
def test_a_side_force_with_the_square_of_the_yaw_rate_is_described_as_one() -> None:
    found = diagnosed(even_in_yaw, even_in_yaw, even_in_yaw)
    answer = found.findings.answer
    assert answer["verdict"] == "described"
    law = answer["described"][0]
    assert law["axis"] == "sway" and law["carries_over"]
    (term,) = law["terms"]
    assert term["of"] == "yaw rate squared" and term["unit"] == "N s^2"
    assert term["value"] == pytest.approx(1.2, abs=3 * term["sd"]) and term["sd"] < 0.1
    assert found.findings.described[0].curve is not None


@pytest.mark.slow
def test_what_acts_in_one_run_alone_is_an_event_and_no_part_of_the_patched_vessel() -> None:
    found = diagnosed(of_one_run, nothing, nothing)
    answer = found.findings.answer
    assert answer["verdict"] == "described"
    (law,) = answer["described"]
    (term,) = law["terms"]
    assert (
        law["axis"] in ("sway", "north", "east")
        and not law["carries_over"]
        and term["run"] == "run_1"
    )
    assert "of run_1" in law["statement"]
    assert "confirm" not in law["statement"]
    assert not found.ranking.described_terms
    text = patched_vessel.patched_vessel_text(
        found.problem,
        found.vessel,
        found.ranking.best,
        Path("patched.toml"),
        found.ranking.described_terms,
    )
    assert "described" not in text


@pytest.mark.slow
@pytest.mark.long
def test_times_are_those_at_which_it_acts() -> None:
    found = diagnosed(of_one_run, nothing, nothing)
    (event,) = found.findings.described
    assert event.term.acts == "within"
    assert event.term.begin == pytest.approx(14.0, abs=1.0)
    assert min(event.term.end, 40.0) == pytest.approx(25.0, abs=1.0) and event.term.end < EVER
    assert replace(event.term, run="").run == ""


def test_a_formula_of_several_terms_is_written_as_a_sum_with_its_signs() -> None:
    written = []
    for coefficient, of in ((-3.0, "yaw_rate"), (2.0, "surge_speed"), (-1.0, "sway_speed")):
        term = DescribedForce.from_settings({"coefficient": coefficient, "of": [of], "axis": "yaw"})
        written.append(FittedTerm(term, 0.1, 10.0, carries=True))
    description: Any = SimpleNamespace(terms=written)
    (formula,) = described_entries(description, BOAT)
    assert formula["statement"].split(": ")[1] == (
        "−3.00 ± 0.10 N m s times yaw rate, plus 2.00 ± 0.10 N s times surge speed, "
        "minus 1.00 ± 0.10 N s times sway speed"
    )
