"""Integration step of the free runs to which parameters are fitted."""

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


def zigzag(boat: Vessel) -> MappedRecording:
    """A minute of rudder orders to either side; the recorded poses play no role."""
    steer = TURN * np.sign(np.sin(np.pi * MINUTE / PERIOD + 0.1))
    signals = dict.fromkeys(("x_m", "y_m", "psi_rad"), np.zeros(len(MINUTE)))
    for name in boat.commands:
        signals[name] = steer if "rad" in name else np.full(len(MINUTE), 10.0)
    recording = Recording("zig-zag", MINUTE, signals, Notes(vessel=boat.name))
    return map_recording(recording, Program(boat))


def path(mapped: MappedRecording, speed: float, step: float | None) -> Array:
    """Simulated channels (M, 2 NQ) of the whole recording from a speed ahead [m/s]."""
    nq = mapped.program.module.NQ
    states = np.zeros((1, 2 * nq))
    states[0, nq] = speed
    ends = np.array([len(MINUTE) - 1])
    begin = FreeRunStarts(np.array([0]), ends, states, (), states[:0])
    on = mapped.program.effect_switches(())
    return mapped.simulate_from(mapped.values, on, begin, step)[0][1]


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
