"""Runs scenarios one after another or in parallel processes, with progress and one exit code."""

import os
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from ctypes import Array, c_double
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, starmap
from multiprocessing import get_context, parent_process
from multiprocessing.context import SpawnContext
from multiprocessing.synchronize import Event
from pathlib import Path
from threading import Lock, Thread
from typing import NamedTuple

from boatsim.cli import comparing, progress
from boatsim.cli.exits import FAULTS, Exit, one_line, print_error, print_lines, print_note
from boatsim.cli.fast_start import keep_arrow_from_importing_pandas
from boatsim.cli.metric_table import print_metrics
from boatsim.errors import BadInput
from boatsim.interruption import ignored_signals, signal_received
from boatsim.physics import trust
from boatsim.simulate.cases import find_scenarios
from boatsim.simulate.controllers import load_with_controller
from boatsim.simulate.evaluation import RunEntry
from boatsim.simulate.real_time_pace import Pace
from boatsim.simulate.run_options import LIVE_REFRESH, RunOptions
from boatsim.simulate.scenario import Scenario

POLL = 0.1  # [s] between two updates of the progress of parallel runs
SAVE_TIMEOUT = 60.0  # [s] for a worker to save its run after the parent process has ended


@dataclass(frozen=True)
class Task:
    """Task to run one scenario, with seed, controller and output folder.

    It holds plain values, so that it can be sent to a process.

    Attributes:
        address: Name or path of the scenario.
        name: Name of the scenario.
        duration: Largest simulated duration [s].
        folder: Output folder.
        seed: Random seed; None for the scenario's own.
        controller: Controller in place of the scenario's own, by name or path.
    """

    address: str
    name: str
    duration: float
    folder: Path
    seed: int | None
    controller: str | None = None


class PlannedRun(NamedTuple):
    """A task to run a scenario, with the scenario already loaded, for a run in this process."""

    task: Task
    scenario: Scenario


@dataclass(frozen=True)
class ViewerOptions:
    """Options of the live viewer: how a run is shown while it is simulated.

    Attributes:
        serve: Whether it is shown in a browser, not in a window.
        speed: Factor of real time; 0 for no limit.
    """

    serve: bool
    speed: float = 1.0


@dataclass(frozen=True)
class Outcome:
    """Result of a task to run one scenario: its metrics, or why it failed.

    Attributes:
        task: The task.
        content: Content of norms.json; None if the run has written no files.
        error: Why the run failed; None if it did not.
    """

    task: Task
    content: RunEntry | None = None
    error: str | None = None

    @property
    def exit_code(self) -> Exit:
        """Exit code of the command for this run."""
        if self.content is None:
            if self.error:
                return Exit.BAD_INPUT
            return Exit.INTERRUPTED
        if not self.content["complete"]:
            return Exit.INTERRUPTED
        missed = any(metric["ok"] is False for metric in self.content["norms"].values())
        if missed:
            return Exit.MISSED
        return Exit.MET


def run_all(
    names: Sequence[str],
    out: Path | None,
    jobs: int,
    seed: int | None,
    viewer: ViewerOptions | None = None,
    controllers: Sequence[str] = (),
    side_by_side: bool = False,
) -> int:
    """Run scenarios, each with all given controllers, and print the metrics of the runs.

    All scenarios are loaded before the first one runs.

    Args:
        names: Scenarios as the user wrote them.
        out: Output folder; None for one per scenario below out/.
        jobs: Number of parallel processes.
        seed: Random seed; None for those of the scenarios.
        viewer: Viewer that shows the runs; None for none.
        controllers: Controllers in place of the scenarios' own; may be empty.
        side_by_side: Whether to print one table of all runs and write compare.rrd.

    Returns:
        The highest exit code of the runs.

    Raises:
        BadInput: A scenario, a controller or a combination of options is wrong.
    """
    planned = plan_runs(names, out, seed, controllers)
    tasks = [task for task, _ in planned]
    jobs = min(jobs, len(tasks))
    if viewer and jobs > 1:
        raise BadInput("--live and --serve show one run at a time; omit --jobs")
    with ExitStack() as stack:
        address = None
        if viewer:
            address = stack.enter_context(open_viewer(viewer.serve))
        report = stack.enter_context(progress.report_runs([(t.name, t.duration) for t in tasks]))
        if jobs > 1:
            outcomes = _run_parallel(tasks, jobs, report)
        else:
            speed = 0.0
            if viewer and address:
                speed = viewer.speed
            outcomes = _run_sequentially(planned, report, address, speed)
    _print_outcomes(outcomes, side_by_side)
    return max(outcome.exit_code for outcome in outcomes)


def _print_outcomes(outcomes: Sequence[Outcome], side_by_side: bool) -> None:
    finished = []
    for outcome in outcomes:
        task = outcome.task
        if outcome.error:
            print_error(outcome.error)
        elif outcome.content:
            if not side_by_side:
                print_metrics(outcome.content, task.folder)
            report_saturation(outcome.content)
        if outcome.content:
            run = comparing.FinishedRun(task.address, task.controller, task.folder, outcome.content)
            finished.append(run)
    if side_by_side:
        comparing.compare_runs(finished)
    if any(outcome.exit_code == Exit.INTERRUPTED for outcome in outcomes):
        if finished:
            print_error("interrupted; what was logged is kept")
        else:
            print_error("interrupted before anything was logged")


@contextmanager
def open_viewer(serve: bool) -> Iterator[str | None]:
    """Open a rerun viewer for the block; print an error if it cannot be shown.

    Args:
        serve: Whether to show it in a browser, not in a window.

    Yields:
        Address to which a run sends its data; None without a viewer.
    """
    from boatsim.view.viewer import HERE, PAGE, start_or_find_viewer

    with start_or_find_viewer(serve) as viewer:
        if viewer is None:
            print_error(
                "no viewer can be shown (check the display); the run continues without one. "
                f"With --serve in place of --live a browser shows it at http://{HERE}:{PAGE}"
            )
        elif viewer.page:
            print_note(f"watch in a browser on this machine: {viewer.page}")
        address = None
        if viewer:
            address = viewer.address
        yield address


def run_manoeuvre(scenario: Scenario, folder: Path, command: str) -> int:
    """Run a standard ship manoeuvre and print its metrics with the IMO limits and its approach.

    A missed limit does not change the exit code: the limits are for large ships.

    Args:
        scenario: Scenario of the manoeuvre.
        folder: Output folder.
        command: Command that repeats the run.

    Returns:
        Exit code.
    """
    from boatsim.simulate.manoeuvre import approach_summary
    from boatsim.simulate.run_files import run_into_folder

    keep_arrow_from_importing_pandas()
    from boatsim.view.run_observers import page_observer, rerun_observers

    tasks = [(scenario.name, scenario.file.duration)]
    with progress.report_runs(tasks, several=False) as report:
        options = RunOptions(progress=partial(report, 0))
        observers = [*rerun_observers(), page_observer(scenario, command)]
        result = run_into_folder(folder, scenario, options, observers)
    content = result.to_json()
    print_metrics(content, folder)
    if summary := approach_summary(scenario, result.run.recording):
        print_lines([summary])
    report_saturation(content)
    if content["complete"]:
        return Exit.MET
    return Exit.INTERRUPTED


def report_saturation(content: RunEntry) -> None:
    """Print a warning if commands of a run were limited to the range of their channels.

    Args:
        content: Content of norms.json.
    """
    if saturated := content["saturated_steps"]:
        steps = ", ".join(starmap("{} in {}".format, saturated.items()))
        print_error(
            f"{content['scenario']}: commands beyond the range of the vessel were limited: {steps} "
            f"of {content['steps']} steps (sent_... in recording.csv)"
        )


def plan_runs(
    names: Sequence[str], out: Path | None, seed: int | None, controllers: Sequence[str] = ()
) -> list[PlannedRun]:
    """Load scenarios and return the runs to perform, with their output folders.

    Args:
        names: Scenarios as the user wrote them.
        out: Output folder; None for one per scenario below out/.
        seed: Random seed; None for those of the scenarios.
        controllers: Controllers in place of the scenarios' own; may be empty.

    Raises:
        BadInput: A scenario or controller is wrong, or two runs would share an output folder.
    """
    if repeated := _first_duplicate([Path(controller).stem for controller in controllers]):
        raise BadInput(f"--controller {repeated} is given twice; both would write to one folder")
    addresses = list(chain.from_iterable(map(find_scenarios, names)))
    choices: Sequence[str | None] = controllers or [None]
    loaded: list[list[Scenario]] = []
    for address in addresses:
        loaded.append([load_with_controller(address, choice) for choice in choices])
    folders = _output_folders([variants[0].name for variants in loaded], out)
    planned = []
    for address, variants, folder in zip(addresses, loaded, folders, strict=True):
        for scenario, choice in zip(variants, choices, strict=True):
            own = folder
            if choice and len(controllers) > 1:
                own = folder / Path(choice).stem
            duration = scenario.file.duration
            task = Task(address, scenario.name, duration, own, seed, choice)
            planned.append(PlannedRun(task, scenario))
    return planned


def _first_duplicate(names: Sequence[str]) -> str | None:
    """The first name that occurs more than once."""
    for name, count in Counter(names).items():
        if count > 1:
            return name
    return None


def _output_folders(names: Sequence[str], out: Path | None) -> list[Path]:
    """DIR for one scenario, DIR/vessel/case for each of several; DIR is out/ by default."""
    if out and len(names) == 1:
        return [out]
    if repeated := _first_duplicate(names):
        raise BadInput(f"scenario {repeated!r} is named twice; both would write to one folder")
    parent = out or Path("out")
    return [parent / name for name in names]


def run_task(
    task: Task,
    report: Callable[[float], None],
    scenario: Scenario | None = None,
    viewer: str | None = None,
    speed: float = 0.0,
) -> Outcome:
    """Run the scenario of one task and write the files of the run.

    Args:
        task: The task.
        report: Function to call with the simulated time [s].
        scenario: Its scenario; None to load it.
        viewer: Address of a viewer; None for none.
        speed: Factor of real time; 0 for no limit.

    Returns:
        The outcome, also of a run that failed or was interrupted.
    """
    try:
        keep_arrow_from_importing_pandas()
        from boatsim.simulate.run_files import run_into_folder
        from boatsim.view.run_observers import page_observer, rerun_observers
        from boatsim.view.run_page import run_command

        options = RunOptions(seed=task.seed, progress=report)
        if speed > 0.0:
            options = replace(options, pace=Pace(speed), refresh=LIVE_REFRESH)
        scenario = scenario or load_with_controller(task.address, task.controller)
        command = run_command(task.address, task.controller, task.seed)
        observers = [*rerun_observers(viewer), page_observer(scenario, command)]
        done = run_into_folder(task.folder, scenario, options, observers)
        return Outcome(task, done.to_json())
    except FAULTS as error:
        return Outcome(task, error=f"{task.name}: {one_line(error)}")
    except KeyboardInterrupt:
        return Outcome(task)


def _run_sequentially(
    planned: Sequence[PlannedRun], report: progress.RunReport, viewer: str | None, speed: float
) -> list[Outcome]:
    outcomes: list[Outcome] = []
    for index, (task, scenario) in enumerate(planned):
        if (
            signal_received()
        ):  # The interruption came while the files of the previous run were written.
            outcomes.append(Outcome(task))
            break
        outcomes.append(run_task(task, partial(report, index), scenario, viewer, speed))
        report(index, task.duration)
        if outcomes[-1].exit_code == Exit.INTERRUPTED:
            break
    return outcomes


# Parallel runs. Only the parent process handles signals. It asks the workers to stop, and they end
# when it ends.


def _run_parallel(tasks: Sequence[Task], jobs: int, report: progress.RunReport) -> list[Outcome]:
    # A forked process would inherit locks of the threads of MuJoCo and Rerun.
    context = get_context("spawn")
    with ignored_signals():  # Child processes inherit ignored signals.
        stop = context.Event()
        reached = shared_times(context, len(tasks))
    arguments = (stop, reached, trust.trusted_folder_list())
    with ProcessPoolExecutor(jobs, context, _start_worker, arguments) as pool:
        with ignored_signals():
            futures = [pool.submit(_run_in_worker, i, task) for i, task in enumerate(tasks)]
        while True:
            try:
                _wait_for_runs(futures, tasks, reached, report)
                return list(map(_outcome_of_future, tasks, futures))
            except KeyboardInterrupt:
                stop.set()


def shared_times(context: SpawnContext, count: int) -> "Array[c_double]":
    """Return the times (count,) [s] that runs have reached, shared by all processes.

    They have no lock, because each has one writer: an interruption of a process that reads them
    could leave a lock taken, for which the others would wait for ever.

    Args:
        context: Context in which the processes are started.
        count: Number of runs.
    """
    times: Array[c_double] = context.Array("d", count, lock=False)
    return times


def _wait_for_runs(
    futures: Sequence[Future[Outcome]],
    tasks: Sequence[Task],
    reached: "Array[c_double]",
    report: progress.RunReport,
) -> None:
    """Report progress until all runs are finished."""
    waiting = True
    while waiting:
        waiting = bool(wait(futures, timeout=POLL).not_done)
        for index, (task, future) in enumerate(zip(tasks, futures, strict=True)):
            t = task.duration if future.done() else reached[index]
            report(index, t)


def _outcome_of_future(task: Task, future: Future[Outcome]) -> Outcome:
    try:
        return future.result()
    except BrokenProcessPool:
        return Outcome(task, error=f"{task.name}: its process was killed (out of memory?)")


def _start_worker(stop: Event, reached: "Array[c_double]", trusted: trust.TrustedFolders) -> None:
    """Set up a worker process with the shared state and the trusted folders of its parent."""
    global _stop, _reached
    trust.adopt_trust(trusted)
    _stop, _reached = stop, reached
    Thread(target=_exit_with_parent, daemon=True).start()


def _exit_with_parent() -> None:
    """End this process when its parent has ended, after the present run has been saved."""
    if parent := parent_process():
        parent.join()
        _stop.set()
        _at_work.acquire(timeout=SAVE_TIMEOUT)
        os._exit(Exit.INTERRUPTED)


def _run_in_worker(index: int, task: Task) -> Outcome:
    def store_time_reached(t: float) -> None:
        _reached[index] = t
        if _stop.is_set():
            raise KeyboardInterrupt

    with _at_work:
        if _stop.is_set():
            return Outcome(task)
        return run_task(task, store_time_reached)


_stop: Event
_reached: "Array[c_double]"
_at_work = Lock()
