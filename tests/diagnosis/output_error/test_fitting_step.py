"""Integration step of the free runs to which parameters are fitted."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import laid, sail

from boatsim.diagnosis.filter import FreeRunStarts, MappedRecording
from boatsim.diagnosis.output_error.errors import output_errors
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.work import CALL
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Notes, Recording

MINUTE = np.arange(0.0, 60.0, 0.7)  # s, rows that are no multiple of a step
TURN = 0.3  # rad, rudder of a zig-zag
PERIOD = 20.0  # s, between two orders


def zigzag(boat: Vessel, phase: float = 0.1) -> MappedRecording:
    """A minute of rudder orders to either side; the recorded poses play no role."""
    steer = TURN * np.sign(np.sin(np.pi * MINUTE / PERIOD + phase))
    signals = dict.fromkeys(("x_m", "y_m", "psi_rad"), np.zeros(len(MINUTE)))
    for name in boat.commands:
        signals[name] = steer if "rad" in name else np.full(len(MINUTE), 10.0)
    recording = Recording("zig-zag", MINUTE, signals, Notes(vessel=boat.name))
    return map_recording(recording, Program(boat))


def runs(
    mapped: MappedRecording, rows: Sequence[tuple[int, int]], speed: float, step: float | None
) -> list[Array]:
    """Simulated channels (M, 2 NQ) between first and last rows, from a speed ahead [m/s]."""
    nq = mapped.program.module.NQ
    states = np.zeros((len(rows), 2 * nq))
    states[:, nq] = speed
    first, last = np.array(rows).T.copy()
    begin = FreeRunStarts(first, last, states, (), states[:0])
    on = mapped.program.effect_switches(())
    return [channels for _, channels in mapped.simulate_from(mapped.values, on, begin, step)]


def path(mapped: MappedRecording, speed: float, step: float | None) -> Array:
    """Simulated channels (M, 2 NQ) of the whole recording from a speed ahead [m/s]."""
    return runs(mapped, [(0, len(MINUTE) - 1)], speed, step)[0]


@pytest.mark.parametrize("name", ["kvlcc2", "mariner"])
def test_the_step_grows_with_the_square_root_of_the_length_of_a_long_hull(name: str) -> None:
    mapped = zigzag(load_vessel(name))
    usual = mapped.config.free_run_step
    by_froude = usual * np.sqrt(mapped.program.vessel.length / 1.2)
    assert mapped.fitting_step == pytest.approx(min(by_froude, mapped.largest_step))
    assert mapped.fitting_step > 2.0 * usual


def test_a_hull_of_the_reference_length_keeps_the_step_of_a_simulation() -> None:
    (mapped,) = laid(sail("fitted", 1, lambda t, y, command: np.zeros(3))[0])[0].recordings
    assert mapped.program.vessel.length == 1.2
    assert mapped.fitting_step == mapped.config.free_run_step


@pytest.mark.parametrize(("name", "speed"), [("kvlcc2", 1.18), ("mariner", 7.7)])
def test_a_long_hull_follows_the_same_path_with_the_longer_step(name: str, speed: float) -> None:
    mapped = zigzag(load_vessel(name))
    exact = path(mapped, speed, 1e-3)
    found = path(mapped, speed, mapped.fitting_step)
    # positions in lengths, headings in rad; a fit distinguishes errors of about 0.01
    scale = np.array([mapped.program.vessel.length, mapped.program.vessel.length, 1.0])
    assert np.ptp(exact[:, 2]) > 0.1  # it turns
    assert np.abs((found - exact)[:, :3] / scale).max() < 1e-5


@pytest.mark.parametrize(
    "rows",
    [
        [(0, 20), (20, 41), (41, 80)],  # one after another
        [(3, 20), (31, 50)],  # with a gap
        [(5, 40), (10, 45), (20, 60)],  # overlapping
        [(50, 70), (0, 30), (30, 40)],  # in another order
    ],
)
def test_each_of_several_runs_is_the_one_that_is_simulated_alone(
    rows: list[tuple[int, int]],
) -> None:
    # the rudder follows its orders slowly, and with play; the first order is amidships
    mapped = zigzag(
        load_vessel("mariner").with_effect({"use": "steering_backlash", "width": 0.1}), 0.0
    )
    for one, channels in zip(rows, runs(mapped, rows, 7.7, None), strict=True):
        (alone,) = runs(mapped, [one], 7.7, None)
        assert len(alone) == one[1] - one[0] + 1 and (channels == alone).all()


def test_runs_one_after_another_cost_as_much_work_as_one() -> None:
    mapped = zigzag(load_vessel("mariner"))

    def work(rows: list[tuple[int, int]]) -> int:
        before = mapped.filtered.work
        runs(mapped, rows, 7.7, None)
        return mapped.filtered.work - before

    whole = work([(0, 80)])
    assert work([(0, 20), (20, 41), (41, 80)]) == whole
    # before a run that begins later, its actuators are simulated from the first row on
    assert work([(41, 80)]) == whole


def test_the_work_of_a_fit_falls_with_its_step() -> None:
    problem, retuned = laid(sail("fitted", 1, lambda t, y, command: np.zeros(3))[0])
    errors = output_errors(problem, retuned, problem.recordings, problem.horizon)
    starts = errors.starts(retuned)

    def work_of_a_pass() -> int:
        before = problem.work_count.work
        errors.residuals(retuned, starts)
        return problem.work_count.work - before

    fine = work_of_a_pass()
    config = replace(problem.config.filter, free_run_step=0.04)
    coarse = [replace(mapped, config=config) for mapped in problem.recordings]
    errors = replace(errors, recordings=coarse)
    # rows follow every 1/6 s: nine steps of 0.02 s become five of 0.04 s
    assert work_of_a_pass() - CALL == pytest.approx((fine - CALL) * 5.0 / 9.0, abs=1.0)
