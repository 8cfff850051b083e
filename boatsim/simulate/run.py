"""Runs a scenario: the control loop, the log, the camera and the listeners of one run."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import monotonic
from warnings import catch_warnings, simplefilter

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.signals import Array
from boatsim.recordings.table import Notes, Recording, SignalMissing
from boatsim.simulate.block_stepper import BlockStepper
from boatsim.simulate.camera_log import CameraLog
from boatsim.simulate.control_loop import ControlLoop
from boatsim.simulate.engine import Engine
from boatsim.simulate.growing_table import FileTable, GrowingTable
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run_end import RunEnd
from boatsim.simulate.run_log import RunLog
from boatsim.simulate.run_options import RunOptions
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.tank import Tank

CHUNK = 500  # [rows] that are delivered to a listener at once, before `RunOptions.refresh` is over
PROGRESS = 100  # [steps] between two reports of progress
STILL = 50  # [rows] of the log of a vessel at rest on which a metric set is tested before the run


@dataclass(frozen=True)
class Run:
    """Result of a run of a scenario: recordings of the true motion and of the camera.

    Attributes:
        scenario: The scenario.
        seed: Seed of parameters and sensor noise.
        recording: The log of the true motion.
        camera: The measurements of the camera.
        complete: Whether the run reached its end; an interrupted one did not.
        steps: Number of physics steps.
        saturated: Channel -> steps in which a command exceeded its range.
    """

    scenario: Scenario
    seed: int
    recording: Recording
    camera: Recording
    complete: bool
    steps: int = 0
    saturated: Mapping[str, int] = field(default_factory=dict)


class Simulation:
    """One run of a scenario in progress: closed loop, log and camera.

    Attributes:
        engine: The engine that integrates the vessel's motion.
    """

    def __init__(
        self,
        scenario: Scenario,
        options: RunOptions | None = None,
        engine: Engine | OpenWater | None = None,
    ) -> None:
        """Put the vessel at its start and log the first row.

        Args:
            scenario: The scenario.
            options: How it is run.
            engine: Result of `build_engine` with the same scenario and seed; default: a new one.

        Raises:
            BadInput: If the controller fails or the log lacks a signal that will be evaluated.
            BadPhysics: If the engine cannot be built.
        """
        self._scenario = scenario
        self._options = options or RunOptions()
        self._seed = seed_or_default(scenario, self._options.seed)
        self.engine = engine or build_engine(scenario, self._seed)
        seeds = np.random.SeedSequence(self._seed).spawn(2 + len(scenario.additional_sensors))
        imu, marking, *others = map(np.random.default_rng, seeds)
        channels = list(scenario.controller.channels() or scenario.vessel.commands)
        self._camera = CameraLog(scenario, channels, marking, self._make_table)
        goal_at = self._options.goal_source or scenario.goal_at
        self._loop = ControlLoop(
            scenario, self.engine, goal_at, (imu, *others), self._camera.record_command_duration
        )
        self._log = RunLog(self._loop, self._make_table)
        state = self._loop.state
        self._end = RunEnd(scenario.file)
        # since the last row of the log
        self._frames = self._camera.take_frames(state, state, self._loop.commands_in_force())
        self._delivered = 0  # rows of the log that the listener has
        self._frames_delivered = 0
        self._last_delivery = monotonic()
        self._write_row()
        self._check_signals()

    @property
    def time(self) -> float:
        """Simulated time that the run has reached [s]."""
        return self._loop.state.t

    def run(self) -> Run:
        """Simulate the scenario to its end or to an interruption, which keeps what was logged.

        Returns:
            The run.

        Raises:
            BadInput: If the controller fails.
            BadPhysics: If the motion diverges.
            OSError: If the disk is full.
        """
        options, complete, reported = self._options, False, 0
        try:
            self._deliver_rows()
            while not (complete := self._is_finished()) and not options.stop():
                if options.pace:
                    # before the step, so that sensors and goals at its end are those of that time
                    options.pace.wait_until(self.time + self.engine.step, options.stop)
                if self._blocks is None:
                    self._advance()
                else:
                    self._advance_block(self._blocks)
                if options.progress and self._loop.steps >= reported + PROGRESS:
                    options.progress(self.time)
                    reported = self._loop.steps
        except KeyboardInterrupt:
            pass
        self._deliver_rows(over=True)
        return self.partial_result(complete)

    def partial_result(self, complete: bool = False) -> Run:
        """Return the result of the run up to the present; a listener may call this.

        Args:
            complete: Whether the run has reached its end.
        """
        notes = recording_notes(self._scenario)
        return Run(
            self._scenario,
            self._seed,
            self._log.recording(notes),
            self._camera.recording(notes),
            complete,
            self._loop.steps,
            dict(self._loop.saturated),
        )

    def _make_table(self, names: list[str], rows: float) -> GrowingTable:
        if self._options.folder:
            return FileTable(names, self._options.folder)
        return GrowingTable(names, round(rows) + 3)

    def _advance(self) -> None:
        """One step of physics, then control at its end, and a row if one is due."""
        before = self._loop.state
        self._loop.advance(self._write_row)
        commands = self._loop.commands_in_force()
        self._add_frames(self._camera.take_frames(before, self._loop.state, commands))
        held = self._loop.sent
        self._loop.control_if_due()
        changed = self._options.log_changes and self._loop.sent != held
        if changed or self._log.is_due() or self._is_finished():
            self._write_row()
        self._deliver_rows()

    @cached_property
    def _blocks(self) -> BlockStepper | None:
        """Advances the run by blocks of steps, if nothing has to be done after each of them."""
        options = self._options
        if options.pace is not None or options.finish is not bool or options.log_changes:
            return None
        return BlockStepper.create_if_possible(self._loop)

    def _advance_block(self, blocks: BlockStepper) -> None:
        """Advance by a block of steps, with their camera frames and rows."""
        before = self._loop.state
        block = blocks.advance(self._end, self._log.rows_due)
        if block.count:
            frames, steps = self._camera.take_frames_of_block(before, block)
            waiting = np.full(len(self._frames), -1)
            self._log.add_rows(
                block, np.concatenate([self._frames, frames]), np.concatenate([waiting, steps])
            )
            last = np.flatnonzero(block.logged)[-1:]
            if len(last):
                self._frames = frames[steps > last[0]]
            else:
                self._add_frames(frames)
        if block.error is not None:
            raise block.error
        self._deliver_rows()

    def _add_frames(self, frames: Array) -> None:
        """Keep the frames since the last row of the log, which shows the last of them."""
        if len(frames):
            self._frames = frames[-1:]

    def _write_row(self) -> None:
        frame = self._frames[-1] if len(self._frames) else None
        self._frames = self._frames[:0]
        self._log.add_row(frame)

    def _deliver_rows(self, over: bool = False) -> None:
        """Hand new rows to the listeners, if there are enough of them or enough time has passed."""
        options, rows, now = self._options, self._log.table.count, monotonic()
        waited = now - self._last_delivery >= options.refresh
        if not over and rows - self._delivered < CHUNK and not waited:
            return
        self._last_delivery = now
        if options.listener and rows > self._delivered:
            options.listener(self._log.recording(Notes(), self._delivered))
        # the commands of the last frame are known once the next one is taken
        frames = self._camera.table.count
        if not over:
            frames = max(frames - 1, 0)
        if options.camera_listener and (
            frames > self._frames_delivered or not self._frames_delivered
        ):
            new = self._camera.recording(Notes(), self._frames_delivered, frames)
            options.camera_listener(new)
        self._delivered, self._frames_delivered = rows, frames

    def _is_finished(self) -> bool:
        if self._scenario.controller.done or self._options.finish():
            return True
        return self._end.is_reached(self._loop.state)

    def _check_signals(self) -> None:
        """Check before the run that the log has every signal that will be evaluated.

        The metric set is tested on the log of a vessel at rest. Only a missing signal counts there:
        a metric that fails for other reasons may well have a value after the run.
        """
        first = self._log.table.recording(self._scenario.name, Notes())
        for check in self._scenario.file.check:
            if check.signal not in first.signals:
                raise BadInput(
                    unknown_name_message("[[check]] signal", check.signal, first.signals)
                )
        if self._scenario.measure is None:
            return
        t = np.linspace(first.t[0], first.t[0] + self._scenario.file.duration, STILL)
        signals = {name: np.full(STILL, x[0]) for name, x in first.signals.items()}
        try:
            with np.errstate(all="ignore"), catch_warnings():
                simplefilter("ignore")
                self._scenario.measure.values(Recording(first.name, t, signals))
        except SignalMissing:
            raise
        except Exception:
            return


def seed_or_default(scenario: Scenario, seed: int | None) -> int:
    """Return the given random seed, or the scenario's seed if it is None."""
    return scenario.file.seed if seed is None else seed


def build_engine(scenario: Scenario, seed: int | None = None) -> Engine | OpenWater:
    """Build the simulation engine that a scenario specifies, MuJoCo or compiled.

    Random parameters of the vessel's effects are sampled by the seed.

    Args:
        scenario: The scenario.
        seed: Seed of the effects with random parameters; default: the scenario's.

    Returns:
        The engine.

    Raises:
        BadInput: If the hull cannot be read.
        BadPhysics: If the model cannot be stepped.
    """
    file, number = scenario.file, seed_or_default(scenario, seed)
    effects = tuple(effect.with_seed(number) for effect in scenario.vessel.effects)
    vessel = replace(scenario.vessel, effects=effects)
    if file.is_compiled:
        return OpenWater(vessel, file.step)
    tank = Tank(**file.tank.model_dump()) if file.tank else None
    return Engine(vessel, tank, file.step)


def recording_notes(scenario: Scenario) -> Notes:
    """Return the notes of a simulated recording: all that a later diagnosis may know of the run.

    They are vessel, load conditions, settings and noise of the camera.
    """
    file = scenario.file
    return Notes(
        vessel=file.vessel,
        load=tuple(file.load),
        settings=dict(file.set),
        noise=scenario.camera.pose_noise(),
    )


def run(
    scenario: Scenario,
    seed: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Run:
    """Run a scenario without writing files; equal scenario and seed give equal numbers.

    Args:
        scenario: The scenario.
        seed: Seed of parameters and sensor noise; default: the scenario's.
        progress: Receives the simulated time [s] now and then.

    Returns:
        The run.

    Raises:
        BadInput: If the controller fails or a signal is missing.
        BadPhysics: If the motion diverges.
    """
    return Simulation(scenario, RunOptions(seed=seed, progress=progress)).run()
