"""Laws that look back at what an actuator did of late: exact, alike in every engine, and described
where they act."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import boats
import numpy as np
import pytest
from alike import long
from pushed_boat import BOAT, Late, laid, sail
from scipy.integrate import solve_ivp

from boatsim.diagnosis.answer.described_terms import (
    abscissa_label,
    coefficient_unit,
    factors_in_words,
)
from boatsim.diagnosis.candidates import diagnosis_program
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.locate.nominal_forces import actuator_states
from boatsim.diagnosis.symbolic.grammar import term_variants
from boatsim.diagnosis.symbolic.placeholders import set_placeholder_term
from boatsim.diagnosis.symbolic.term_forces import fitted_recordings
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.kernel.records import Inputs, VesselNumbers
from boatsim.physics.program import Program
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine
from tests.diagnosis.symbolic.test_grammar import diagnosed, halved, nothing, replays

MEMORY = 0.7  # [s]
# factor -> of which signal of the commands (port, starboard, steer port, steer starboard), and what
# of it
SIGNALS = {
    "recent_thrust_port_N": (lambda c: c[0], False),
    "recent_abs_thrust_starboard_N": (lambda c: abs(c[1]), False),
    "recent_thrust": (lambda c: c[0] + c[1], False),
    "recent_sin_steer_port_rad": (lambda c: np.sin(c[2]), False),
    "changed_thrust_port_N": (lambda c: c[0], True),
}
LAWS: list[dict[str, Any]] = [
    {
        "use": "described_force",
        "name": "described_1",
        "axis": "sway",
        "of": ["recent_thrust", "surge_speed"],
        "memory": 1.3,
        "coefficient": 0.9,
    },
    {
        "use": "described_force",
        "name": "described_2",
        "axis": "yaw",
        "of": ["changed_steer_port_rad"],
        "memory": 0.6,
        "coefficient": 0.2,
    },
    {
        "use": "described_thrust",
        "name": "described_thrust_1",
        "side": "port",
        "of": ["recent_abs_thrust_port_N"],
        "memory": 2.0,
        "coefficient": -0.4,
    },
    {"use": "thrust_lag", "time_constant": 0.3},
]


def commanded(rows: int, seed: int = 5) -> Array:
    """(rows, 4) steps drawn by lot."""
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (rows, 4)) * [0.9, 0.9, 0.6, 0.6]


@pytest.mark.parametrize("factor", SIGNALS)
def test_what_is_recalled_is_a_first_order_lag_to_the_last_digits(factor: str) -> None:
    law = {"use": "described_force", "of": [factor], "memory": MEMORY, "coefficient": 1.0}
    program, (of, beyond) = Program(vessel.load_vessel("trial_boat", extra=[law])), SIGNALS[factor]
    on, p, own = (
        program.effect_switches(),
        program.values(),
        program.composition.history_index(len(BOAT.effects)),
    )
    memory, act = np.zeros(program.memory_size), np.zeros(program.actuator_signal_size)
    commands, steps = commanded(9), [0.02, 0.5, 3.0, 0.02, 0.17, 1.0, 0.3, 0.04, 0.6]
    program.estimation_functions.settle_actuators(commands[0], memory, p, on, act)
    y = of(commands[0])
    for command, dt in zip(commands, steps, strict=True):
        program.estimation_functions.advance_actuators(command, memory, dt, p, on, act)
        begin, middle, end = act.reshape(3, -1)[:, own]
        x = of(command)
        path = solve_ivp(
            lambda t, z, x=x: [(x - z[0]) / MEMORY, z[0]], (0, dt), [y, 0], rtol=1e-11, atol=1e-13
        )
        late, mean = path.y[0, -1], path.y[1, -1] / dt
        expected = [x - v if beyond else v for v in (y, late, mean)]
        assert [begin, end, (begin + 4 * middle + end) / 6] == pytest.approx(expected, abs=1e-8)
        y = late


@pytest.mark.slow
def test_a_law_that_looks_back_keeps_the_fourth_order() -> None:
    compiled, found = Batch(vessel.load_vessel("trial_boat", extra=LAWS)), {}
    for step in (0.04, 0.02, 0.0025):
        compiled.step = step
        found[step] = compiled.rollout(np.zeros(6), commanded(20), 0.4)
    coarse, fine = (np.abs(found[step] - found[0.0025]).max() for step in (0.04, 0.02))
    assert fine < 1e-6 and coarse / fine > 12.0


def test_engine_twin_and_filter_agree_on_laws_that_look_back() -> None:
    boat = vessel.load_vessel("trial_boat", extra=LAWS)
    commands, row = np.repeat(commanded(13), 5, axis=0)[:61], 0.1  # 6 s
    compiled = Batch(boat, step=DEFAULT.filter.free_run_step).rollout(
        np.zeros(6), commands[:-1], row
    )
    engine, seen = Engine(boat, step=DEFAULT.filter.free_run_step), []
    engine.reset(commands=dict(zip(boat.commands, commands[0].tolist(), strict=True)))
    for sent in commands:
        seen.append((engine.state.x, engine.state.y, engine.state.psi))
        engine.command(dict(zip(boat.commands, sent.tolist(), strict=True)))
        engine.advance(round(row / DEFAULT.filter.free_run_step))
    program, on = diagnosis_program(
        replace(boat, found=tuple(law.get("name", law["use"]) for law in LAWS))
    )
    times, out = row * np.arange(61), np.full((1, 61, 6), np.nan)
    program.estimation_functions.simulate_intervals(
        Inputs(times, times, commands),
        DEFAULT.filter.free_run_step,
        VesselNumbers(program.body, program.values(), program.effect_switches(on)),
        np.array([0]),
        np.array([60]),
        np.zeros((1, 6)),
        out,
    )
    np.testing.assert_allclose(compiled[:, :3], seen, atol=1e-9)
    np.testing.assert_allclose(out[0, :, :3], seen, atol=1e-6)
    without = Batch(
        vessel.load_vessel("trial_boat", extra=LAWS[-1:]), step=DEFAULT.filter.free_run_step
    ).rollout(np.zeros(6), commands[:-1], row)
    assert np.abs(without - compiled)[:, :3].max() > 0.02


def test_a_vessel_whose_laws_do_not_look_back_remembers_nothing_more(tmp_path: Path) -> None:
    law = '[[effect]]\nuse = "described_force"\nof = ["surge_speed"]\ncoefficient = -0.4\n'
    plain, also = (
        boats.PLANAR + law,
        (boats.PLANAR + law).replace("surge_speed", "recent_thrust_port_N"),
    )
    short, long = (
        Program(vessel.load_vessel(str(boats.written(tmp_path, name, text + more)))).composition
        for name, text, more in (("short", plain, ""), ("long", also, "memory = 2.0\n"))
    )
    assert (short.memory_size, long.memory_size) == (0, 1) and len(long.law_signals) == len(
        short.law_signals
    ) + 1
    assert "update_signal_history" not in short.source_text()
    assert not set(Program(vessel.load_vessel("trial_boat")).composition.law_signals) - set(
        BOAT.law_signals
    )


@pytest.mark.parametrize(
    ("table", "line"),
    [
        ({"of": "recent_thrust_prt_N", "memory": 2.0}, "did you mean 'recent_thrust_port_N'"),
        ({"of": "recent_thrust"}, "memory is missing: the time constant"),
        (
            {"of": ["recent_thrust", "recent_thrust_port_N"], "memory": 2.0},
            "allowed is the history of one signal",
        ),
        (
            {"of": ["recent_thrust", "changed_thrust"], "memory": 2.0},
            "allowed is the history of one signal",
        ),
        ({"of": "recent_thrust", "memory": 0.0}, "memory = 0 s; allowed 0.01 to 3600 s"),
    ],
)
def test_words_of_the_past_that_do_not_exist_are_named(table: dict[str, Any], line: str) -> None:
    with pytest.raises(BadInput, match=line):
        DescribedForce.from_settings(table).with_all_parameters(BOAT)


def test_a_law_stands_behind_the_drives_by_which_signals_have_their_places(tmp_path: Path) -> None:
    law = '[[effect]]\nuse = "described_force"\nof = ["steer_port_rad"]\ncoefficient = 1.0\n\n'
    last = boats.PLANAR.rindex("[[effect]]")  # the other thruster
    with pytest.raises(
        BadInput, match="described_force stands before an effect by which a channel acts"
    ):
        vessel.load_vessel(
            str(boats.written(tmp_path, "early", boats.PLANAR[:last] + law + boats.PLANAR[last:]))
        )


def test_a_term_that_looks_back_is_said_in_words_with_its_unit() -> None:
    def said(axis: str, *of: str) -> tuple[str, str]:
        term = DescribedForce(axis=axis, of=of, memory=5.0)
        return factors_in_words(term), coefficient_unit(term, BOAT)

    assert said("sway", "recent_thrust_port_N") == (
        "the average over the last 5.00 s of thrust port",
        "",
    )
    assert said("yaw", "recent_thrust", "surge_speed") == (
        "the average over the last 5.00 s of thrust times surge speed",
        "s",
    )
    assert said("yaw", "changed_steer_port_rad") == (
        "the deviation of steer port from its average over the last 5.00 s",
        "N m",
    )
    assert said("sway", "recent_abs_thrust_port_N") == (
        "the average over the last 5.00 s of the size of thrust port",
        "",
    )
    assert (
        abscissa_label("recent_abs_thrust_port_N")
        == "the recent average of the size of thrust port"
    )


def test_the_quick_weighing_recalls_what_the_filter_does() -> None:
    problem, fit = laid(sail("run", 1, nothing)[0])
    (way,), program = fitted_recordings(problem, fit), problem.program
    term = DescribedForce(axis="sway", of=("recent_abs_thrust_port_N",), memory=1.7)
    set_placeholder_term(problem, "described_1", term, problem.recordings)
    number = next(i for i, e in enumerate(program.effects) if e.name == "described_1")
    acting = actuator_states(problem.recordings[0], ("described_1",), problem.recordings[0].values)
    np.testing.assert_allclose(
        way.term_value(term), acting[:, program.composition.history_index(number)], atol=1e-9
    )
    assert {
        t.memory for t in term_variants(term, problem.recordings, 0.5, problem.config.describe)
    } == {1.7 * 1.5, 1.7 / 1.5}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("factor", "late"),
    [
        ("recent_thrust_port_N", (5.0, lambda c: float(c[0]))),
        long("recent_thrust", (3.0, lambda c: float(c[0] + c[1]))),
    ],
)
def test_a_side_force_with_the_thrust_of_the_last_seconds_is_described(
    factor: str, late: Late, tmp_path: Path
) -> None:
    def wake(t: float, y: Array, command: Array) -> Array:
        return np.array([0.0, 0.6 * y[6], 0.0])

    found = diagnosed(wake, wake, wake, late=late)
    assert found.findings.answer["verdict"] == "described"
    (written,) = found.findings.described
    term = written.term
    assert isinstance(term, DescribedForce) and term.axis == "sway" and term.of == (factor,)
    assert term.memory == pytest.approx(late[0], rel=0.3) and term.coefficient == pytest.approx(
        0.6, rel=0.1
    )
    assert f"over the last {term.memory:.3g}" in found.findings.answer["sentence"]
    assert written.carries and written.curve is not None and halved(found, "position_rms_m")
    replays(found, sail("run_3", 42, wake, late=late)[0], tmp_path)
