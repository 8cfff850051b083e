"""Blocks of steps of a run in open water: the controller acts in between, each step is recorded.

A compiled controller acts in compiled code too. The results are those of `ControlLoop`, which takes
one step after another, to the last bit: both call the same compiled functions.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.control.base import Controller, Sense
from boatsim.control.compiled import SENSE_FIELDS, CompiledController
from boatsim.errors import BoatsimError
from boatsim.physics.commands import SLACK
from boatsim.physics.native.calls import partial_call
from boatsim.physics.signals import Array
from boatsim.simulate.compiled_loop import History
from boatsim.simulate.compiled_periods import CompiledPeriods
from boatsim.simulate.control_columns import SENSED_PLACES
from boatsim.simulate.control_loop import ControlLoop
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run_end import TIME_TOLERANCE, RunEnd
from boatsim.simulate.step_block import (
    BlockPlan,
    ControlValues,
    StepBlock,
    control_numbers,
    joined_values,
)
from boatsim.simulate.step_record import make_step_record
from boatsim.simulate.stepper import State

# Steps of a block, after which a run can be interrupted: milliseconds, or half a second in waves of
# many components. Shorter blocks cost more time for each step, and so do longer ones: beyond some
# hundred kilobytes the operating system takes the memory of the arrays back after each block.
MOST_STEPS = 1500
MOST_STEPS_UNTIL = 1000  # the same where the motion may end the run, so that few are in vain


class Advanced(NamedTuple):
    """Result of the steps of a block.

    Attributes:
        steps: Number of steps that belong to the run.
        control: Values at the control steps.
        error: Why the run ends with an error after these steps.
    """

    steps: int
    control: ControlValues
    error: BoatsimError | None = None


class BlockStepper:
    """Advances the control loop of a run in open water by blocks of steps."""

    def __init__(self, loop: ControlLoop, engine: OpenWater) -> None:
        """Create the record of the steps; use `create_if_possible`, which checks the conditions.

        Args:
            loop: The control loop.
            engine: Its engine.
        """
        self._loop, self._engine = loop, engine
        self._record = make_step_record(engine.program, MOST_STEPS, MOST_STEPS)
        self._record_period: Callable[[], None] = partial_call(
            engine.code, "record_steps", engine.batch.fleet, engine.step, self._record
        )

    @classmethod
    def create_if_possible(cls, loop: ControlLoop) -> "BlockStepper | None":
        """Return an object that advances a control loop by blocks of steps, or None.

        It is possible in open water if the controller acts only once per period.

        Args:
            loop: The control loop.
        """
        acts_between = (
            type(loop.scenario.controller).time_to_extra_step is not Controller.time_to_extra_step
        )
        if acts_between or not isinstance(loop.engine, OpenWater):
            return None
        return cls(loop, loop.engine)

    @cached_property
    def _compiled(self) -> CompiledPeriods | None:
        loop = self._loop
        return CompiledPeriods.create_if_possible(
            loop.scenario, self._engine, loop.imu, self._record
        )

    def advance(self, end: RunEnd, rows_due: Callable[[Array], NDArray[np.bool_]]) -> StepBlock:
        """Advance the control loop by a block of steps.

        Args:
            end: Conditions that end the run.
            rows_due: Returns at which of several times [s] a row of the log is due.

        Returns:
            The steps.
        """
        plan, record = self._plan(end, rows_due), self._record
        steps = len(plan.times)
        record.done[:] = 0
        record.ends[: len(plan.period_ends)] = plan.period_ends
        record.logged[:steps] = plan.logged | plan.may_end_early
        done = self._advance_compiled(plan, end)
        if done is None and self._passes_goals_on:
            done = self._advance_with_goals(plan, end)
        if done is None:
            done = self._advance_with_calls(plan, end)
        logged = plan.logged[: done.steps].copy()
        if done.error is None and self._is_finished(done.steps, end):
            logged[-1] = True
        after = control_numbers(plan.stops, steps)[: done.steps]
        block = StepBlock(
            record=record,
            count=done.steps,
            step=self._engine.step,
            logged=logged,
            control=done.control,
            control_after=after,
            control_before=np.concatenate([[0], after])[:-1],
            error=done.error,
        )
        self._loop.steps += block.count
        self._loop.saturated.update(self._saturated_steps(block))
        return block

    def _saturated_steps(self, block: StepBlock) -> dict[str, int]:
        """Channel -> number of steps in which a command exceeded its range."""
        control, found = block.control, dict[str, int]()
        steps = np.bincount(block.control_before, minlength=len(control.sent))
        limits = self._loop.scenario.vessel.limits()
        for j, name in enumerate(self._loop.channels):
            low, high = limits[name]
            excess = np.abs(control.sent[:, j] - control.commands[:, j])
            if count := int(steps[excess > SLACK * (high - low)].sum()):
                found[name] = count
        return found

    def _plan(self, end: RunEnd, rows_due: Callable[[Array], NDArray[np.bool_]]) -> BlockPlan:
        """Plan the next steps: their times are sums, as in the compiled functions."""
        loop = self._loop
        steps = MOST_STEPS_UNTIL if end.depends_on_motion else MOST_STEPS
        lengths = np.full(steps + 1, self._engine.step)
        lengths[0] = loop.state.t
        times = np.add.accumulate(lengths)[1:]
        over = int(np.searchsorted(times, end.duration - TIME_TOLERANCE))
        times = times[: over + 1]
        stops, due, period = list[int](), loop.due, loop.scenario.controller.period
        for number, t in enumerate(times.tolist(), 1):
            if t >= due - TIME_TOLERANCE:
                stops.append(number)
                due += period
        logged = rows_due(times)
        logged[-1] |= end.is_over(times[-1])
        ends_by_itself = type(loop.scenario.controller).done is not Controller.done
        return BlockPlan(times, stops, due, logged, end.depends_on_motion or ends_by_itself)

    def _advance_compiled(self, plan: BlockPlan, end: RunEnd) -> Advanced | None:
        """Let a compiled controller act in compiled code; None if that is not possible."""
        loop = self._loop
        if self._compiled is None or not plan.stops:
            return None
        law = loop.scenario.controller
        assert isinstance(law, CompiledController)
        try:
            goals = self._goal_values(law, plan.times[np.array(plan.stops) - 1])
        except KeyError:  # The error is raised when the controller acts.
            return None
        first = self._present_values(bool(plan.needs_values()[0]))
        history = self._compiled.advance(goals)
        if plan.period_ends[-1] > plan.stops[-1]:
            self._record_period()
        loop.due = plan.due
        count, error = self._count_valid_steps(0, len(plan.times), end)
        if not np.isfinite(history.orders).all():
            count, error = self._first_bad_order(plan, history, count, error)
        orders = dict(zip(loop.channels, history.orders[-1].tolist(), strict=True))
        loop.follow_engine(self._state(max(count, 1)), Sense(*history.felt[-1].tolist()), orders)
        rest = self._values_of_history(history)
        return Advanced(count, joined_values([first, rest]), error)

    @cached_property
    def _passes_goals_on(self) -> bool:
        """Whether the goals are the commands and nothing else depends on the sensors."""
        scenario = self._loop.scenario
        kind = type(scenario.controller)
        if not kind.passes_on or scenario.additional_sensors or scenario.has_off_goal:
            return False
        return kind.done is Controller.done and kind.estimates is Controller.estimates

    def _advance_with_goals(self, plan: BlockPlan, end: RunEnd) -> Advanced:
        """Send the goals as commands; the sensors are read for the log only."""
        loop, engine = self._loop, self._engine
        first = self._present_values(False)
        periods = len(plan.stops)
        felt = np.empty((periods, len(SENSE_FIELDS)))
        commands, sent = np.empty((2, periods, len(loop.channels)))
        stop_times = plan.times[np.array(plan.stops, dtype=int) - 1]
        count, error = len(plan.times), None
        for span, goal in loop.goal_spans(stop_times):
            for number in range(span.start, span.stop):
                self._record_period()
                felt[number] = engine.true_readings()
                if number > span.start:
                    continue
                loop.state = self._state(plan.stops[number])
                try:
                    with loop.name_controller_in_errors() as controller:
                        loop.send_commands(controller.step(loop.sense, goal))
                except BoatsimError as raised:
                    lost, error = self._count_valid_steps(0, plan.stops[number] - 1, end)
                    return Advanced(lost, first, error or raised)
            commands[span] = loop.commands_in_force()
            sent[span] = [loop.sent[name] for name in loop.channels]
        if plan.period_ends[-1:] != plan.stops[-1:]:
            self._record_period()
        loop.due = plan.due
        count, error = self._count_valid_steps(0, len(plan.times), end)
        loop.state = self._state(max(count, 1))
        loop.scenario.sensors.add_errors(felt, loop.imu)
        if periods:
            loop.sense = Sense(*felt[-1].tolist())
        estimated = np.empty((periods, 0))
        rest = ControlValues(commands, sent, felt[:, SENSED_PLACES], estimated)
        return Advanced(count, joined_values([first, rest]), error)

    def _advance_with_calls(self, plan: BlockPlan, end: RunEnd) -> Advanced:
        """Let the controller act by calls from Python."""
        loop, needed = self._loop, plan.needs_values()
        values, begin = [self._present_lists(bool(needed[0]))], 0
        count, error = 0, None
        for number, stop in enumerate(plan.period_ends, 1):
            self._record_period()
            count, error = self._count_valid_steps(begin, stop, end)
            if error is not None:
                break
            loop.state = self._state(count)
            if count < stop:
                break
            if number <= len(plan.stops):
                try:
                    loop.control()
                    values.append(self._present_lists(bool(needed[number])))
                except BoatsimError as raised:
                    count, error = stop - 1, raised
                    break
            if self._is_finished(count, end):
                break
            begin = stop
        return Advanced(count, ControlValues(*map(np.array, zip(*values, strict=True))), error)

    def _goal_values(self, law: CompiledController, times: Array) -> Array:
        """Goals (periods, G) at several times [s]; raises KeyError if one is missing."""
        rows = np.empty((len(times), len(law.goals)))
        for span, goal in self._loop.goal_spans(times):
            rows[span] = law.goal_values(goal)
        return rows

    def _is_finished(self, count: int, end: RunEnd) -> bool:
        """Whether the run ends after some steps of the block."""
        return self._loop.scenario.controller.done or end.is_reached(self._state(count))

    def _count_valid_steps(
        self, begin: int, stop: int, end: RunEnd
    ) -> tuple[int, BoatsimError | None]:
        """Number of steps until the motion ends the run, and the error if it diverges before."""
        states = self._record.states[begin:stop]
        count = stop
        if end.depends_on_motion and (reached := end.first_reached(states)) is not None:
            count = begin + reached + 1
        sums = states[: count - begin].sum(axis=1)
        if np.isfinite(sums).all():
            return count, None
        lost = begin + int(np.argmin(np.isfinite(sums)))
        return lost, self._engine.diverged(float(self._record.states[lost, 0]))

    def _first_bad_order(
        self, plan: BlockPlan, history: History, count: int, error: BoatsimError | None
    ) -> tuple[int, BoatsimError | None]:
        """Number of steps and error, if a command that is not finite comes first."""
        number = int(np.argmin(np.isfinite(history.orders).all(axis=1)))
        stop = plan.stops[number]
        if stop > count:
            return count, error
        loop = self._loop
        loop.state = self._state(stop)
        orders = dict(zip(loop.channels, history.orders[number].tolist(), strict=True))
        try:
            with loop.name_controller_in_errors():
                self._engine.command(orders)
        except BoatsimError as raised:
            return stop - 1, raised
        return count, error

    def _state(self, count: int) -> State:
        """State after some steps of the block."""
        return State(*self._record.states[count - 1].tolist())

    def _present_values(self, with_estimates: bool) -> ControlValues:
        """Values of the last control step."""
        return ControlValues(
            *(np.array([values]) for values in self._present_lists(with_estimates))
        )

    def _present_lists(self, with_estimates: bool) -> tuple[list[float], ...]:
        """Values of the last control step, in the order of `ControlValues`."""
        loop, columns = self._loop, self._loop.columns
        estimated = columns.no_estimates()
        if with_estimates and columns.estimated:
            with loop.name_controller_in_errors() as controller:
                estimated = columns.estimated_values(controller.estimates())
        sent = [loop.sent[name] for name in loop.channels]
        return loop.commands_in_force(), sent, columns.sensed_values(loop.sense), estimated

    def _values_of_history(self, history: History) -> ControlValues:
        """Values of the control steps in compiled code."""
        loop, columns = self._loop, self._loop.columns
        law = loop.scenario.controller
        assert isinstance(law, CompiledController)
        with loop.name_controller_in_errors():
            found = law.estimates_from(history.memory.view(law.memory.dtype)[:, 0])
        estimated = columns.estimated_rows(found, len(history.felt))
        inputs: Sequence[str] = loop.scenario.vessel.inputs
        places = [inputs.index(name) for name in loop.channels]
        return ControlValues(
            history.commands[:, places],
            history.orders,
            history.felt[:, SENSED_PLACES],
            estimated,
        )
