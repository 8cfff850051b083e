"""Runs scenarios one after another or in processes of their own, with a progress bar and one exit code for all."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing import get_context, parent_process
from multiprocessing.sharedctypes import SynchronizedArray
from multiprocessing.synchronize import Event
from pathlib import Path
from threading import Lock, Thread
from typing import NamedTuple

from boatsim.cli import comparing, progress, show
from boatsim.cli.exits import FAULTS, Exit, complain, remark, words
from boatsim.errors import BadInput
from boatsim.interruption import ignored_signals, signal_received
from boatsim.physics import trust
from boatsim.simulate.cases import meant
from boatsim.simulate.controllers import steered
from boatsim.simulate.evaluation import RunEntry
from boatsim.simulate.real_time_pace import Pace
from boatsim.simulate.run_options import LIVE_REFRESH, RunOptions
from boatsim.simulate.scenario import Scenario

POLL = 0.1  # [s] between two looks at the processes
PATIENCE = 60.0  # [s] for a run to be written whose watcher is gone


@dataclass(frozen=True)
class Task:
    """One scenario to run; plain values, so that it can be sent to a process."""

    given: str  # name or path as the user wrote it
    name: str
    duration: float  # [s] at most
    folder: Path
    seed: int | None
    controller: str | None = None  # in place of the scenario's own, by name or path


class Planned(NamedTuple):
    """A task and its scenario, which a run in this process need not load again."""

    task: Task
    scenario: Scenario


@dataclass(frozen=True)
class Watched:
    """That somebody watches the runs."""

    serve: bool  # in a browser, not in a window
    speed: float  # times real time; 0: as fast as can be


@dataclass(frozen=True)
class Outcome:
    """What became of a task."""

    task: Task
    content: RunEntry | None = None  # of norms.json; None: there are no files
    error: str | None = None

    @property
    def code(self) -> Exit:
        """How this one ended."""
        if self.content is None:
            return Exit.BAD_INPUT if self.error else Exit.INTERRUPTED
        if not self.content["complete"]:
            return Exit.INTERRUPTED
        missed = any(norm["ok"] is False for norm in self.content["norms"].values())
        return Exit.MISSED if missed else Exit.MET


def run_all(
    names: Sequence[str],
    out: Path | None,
    jobs: int,
    seed: int | None,
    watched: Watched | None = None,
    controllers: Sequence[str] = (),
    side_by_side: bool = False,
) -> int:
    """Run scenarios, each with each of the controllers if there are any, print their norms, return the exit code.

    `side_by_side` is one table of all of them, and one log. All are checked before any runs; raises BadInput.
    """
    planned = plan(names, out, seed, controllers)
    tasks = [task for task, _ in planned]
    jobs = min(jobs, len(tasks))
    if watched and jobs > 1:
        raise BadInput("--live and --serve show one run at a time; leave --jobs away")
    with ExitStack() as until_done:
        to = until_done.enter_context(watching(watched.serve)) if watched else None
        report = until_done.enter_context(progress.running([(t.name, t.duration) for t in tasks]))
        speed = watched.speed if watched and to else 0.0
        outcomes = (
            _in_processes(tasks, jobs, report) if jobs > 1 else _in_turn(planned, report, to, speed)
        )
    for outcome in outcomes:
        if outcome.error:
            complain(outcome.error)
        elif outcome.content:
            if not side_by_side:
                show.norms(outcome.content, outcome.task.folder)
            warn_of_limits(outcome.content)
    if side_by_side:
        done = [
            (o.task.given, o.task.controller, o.task.folder, o.content)
            for o in outcomes
            if o.content
        ]
        comparing.compare([comparing.Done(*one) for one in done])
    if any(outcome.code == Exit.INTERRUPTED for outcome in outcomes):
        kept = any(outcome.content for outcome in outcomes)
        complain(
            "interrupted; what was logged is kept"
            if kept
            else "interrupted before anything was logged"
        )
    return max(outcome.code for outcome in outcomes)


@contextmanager
def watching(serve: bool) -> Iterator[str | None]:
    """Address of a viewer for the block; where there is none it is said at once, and what there is instead."""
    from boatsim.view.viewer import HERE, PAGE, shown

    with shown(serve) as viewer:
        if viewer is None:
            complain(
                "no viewer can be shown (is there a display?), and the run goes on unseen; with --serve, not --live, "
                f"a browser shows it at http://{HERE}:{PAGE}"
            )
        elif viewer.page:
            remark(f"watch in a browser, on this machine: {viewer.page}")
        yield viewer.to if viewer else None


def run_manoeuvre(scenario: Scenario, folder: Path) -> int:
    """Run a standard manoeuvre and print its figures; the limits beside them are a yardstick, not a test."""
    from boatsim.simulate.run_files import run_into_folder
    from boatsim.view.run_observers import rerun_observers

    with progress.running([(scenario.name, scenario.file.duration)], several=False) as report:
        options = RunOptions(progress=lambda t: report(0, t))
        content = run_into_folder(folder, scenario, options, rerun_observers()).to_json()
    show.norms(content, folder)
    warn_of_limits(content)
    return Exit.MET if content["complete"] else Exit.INTERRUPTED


def warn_of_limits(content: RunEntry) -> None:
    """One line if a channel was sent more than it takes."""
    if found := content["saturated_steps"]:
        where = ", ".join(f"{name} in {count}" for name, count in found.items())
        complain(
            f"{content['scenario']}: more was sent than the vessel takes, and limited: {where} of "
            f"{content['steps']} steps (sent_... in recording.csv)"
        )


def plan(
    names: Sequence[str], out: Path | None, seed: int | None, controllers: Sequence[str] = ()
) -> list[Planned]:
    """What to run and where its files go, from names that may be wrong."""
    stems = [Path(c).stem for c in controllers]
    if twice := next((c for c in stems if stems.count(c) > 1), None):
        raise BadInput(f"--controller {twice} is given twice; both would write to the same folder")
    several = len(controllers) > 1
    names = [one for given in names for one in meant(given)]
    steering: Sequence[str | None] = controllers or [None]
    loaded = [[steered(name, c) for c in steering] for name in names]
    folders = _folders([s[0].name for s in loaded], out)
    return [
        Planned(
            Task(
                given,
                s.name,
                s.file.duration,
                folder / Path(c).stem if several and c else folder,
                seed,
                c,
            ),
            s,
        )
        for given, many, folder in zip(names, loaded, folders, strict=True)
        for s, c in zip(many, steering, strict=True)
    ]


def _folders(names: Sequence[str], out: Path | None) -> list[Path]:
    """DIR for one scenario, DIR/vessel/case for each of several; out/vessel/case without a DIR."""
    if out and len(names) == 1:
        return [out]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise BadInput(f"scenario {twice!r} is named twice; both would write to the same folder")
    return [(out or Path("out")) / name for name in names]


def carry_out(
    task: Task,
    told: Callable[[float], None],
    scenario: Scenario | None = None,
    viewer: str | None = None,
    speed: float = 0.0,
) -> Outcome:
    """Run one task and return its outcome, which may be an error.

    Args:
        task: The task.
        told: Receives the simulated time [s].
        scenario: The task's scenario, where it is loaded already.
        viewer: Address of a viewer that shows the run.
        speed: Simulated time by real time; 0: as fast as possible.
    """
    try:
        from boatsim.simulate.run_files import run_into_folder
        from boatsim.view.run_observers import rerun_observers

        options = RunOptions(seed=task.seed, progress=told)
        if speed > 0.0:
            options = replace(options, pace=Pace(speed), refresh=LIVE_REFRESH)
        found = scenario or steered(task.given, task.controller)
        done = run_into_folder(task.folder, found, options, rerun_observers(viewer))
        return Outcome(task, done.to_json())
    except FAULTS as error:
        return Outcome(task, error=f"{task.name}: {words(error)}")
    except KeyboardInterrupt:
        return Outcome(task)


def _in_turn(
    planned: Sequence[Planned], report: progress.Reached, viewer: str | None, speed: float
) -> list[Outcome]:
    outcomes: list[Outcome] = []
    for number, (task, scenario) in enumerate(planned):
        if signal_received():  # while the files of the one before were written
            outcomes.append(Outcome(task))
            break
        outcomes.append(carry_out(task, partial(report, number), scenario, viewer, speed))
        report(number, task.duration)
        if outcomes[-1].code == Exit.INTERRUPTED:
            break
    return outcomes


# Several processes: a signal is heeded by this one only, which asks the others to stop; they end
# with it -------------


def _in_processes(tasks: Sequence[Task], jobs: int, report: progress.Reached) -> list[Outcome]:
    context = get_context("spawn")  # a fork would copy MuJoCo's and rerun's threads half alive
    with ignored_signals():  # processes inherit it, the one that looks after shared memory too
        stop, reached = context.Event(), context.Array("d", len(tasks))
    with ProcessPoolExecutor(jobs, context, _begin, (stop, reached, trust.now())) as pool:
        with ignored_signals():
            futures = [pool.submit(_work, number, task) for number, task in enumerate(tasks)]
        while True:
            try:
                _watch(futures, tasks, reached, report)
                return [_result(task, future) for task, future in zip(tasks, futures, strict=True)]
            except KeyboardInterrupt:
                stop.set()


def _watch(
    futures: Sequence[Future[Outcome]],
    tasks: Sequence[Task],
    reached: "SynchronizedArray[float]",
    report: progress.Reached,
) -> None:
    """Report until all are done."""
    waiting = True
    while waiting:
        waiting = bool(wait(futures, timeout=POLL).not_done)
        for number, (task, future) in enumerate(zip(tasks, futures, strict=True)):
            report(number, task.duration if future.done() else reached[number])


def _result(task: Task, future: Future[Outcome]) -> Outcome:
    try:
        return future.result()
    except BrokenProcessPool:
        return Outcome(task, error=f"{task.name}: its process was killed (out of memory?)")


def _begin(stop: Event, reached: "SynchronizedArray[float]", trusted: trust.Trust) -> None:
    """First thing in a new process: what it shares with the one that watches, and may run what that one may."""
    global _stop, _reached
    trust.adopt(trusted)
    _stop, _reached = stop, reached
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Once the process that watches is gone, killed perhaps: what runs here is kept as far as it is, and that is it."""
    if watcher := parent_process():
        watcher.join()
        _stop.set()
        _at_work.acquire(timeout=PATIENCE)
        os._exit(Exit.INTERRUPTED)


def _work(number: int, task: Task) -> Outcome:
    """One task in a process of its own."""

    def told(t: float) -> None:
        _reached[number] = t
        if _stop.is_set():
            raise KeyboardInterrupt

    with _at_work:
        return Outcome(task) if _stop.is_set() else carry_out(task, told)


_stop: Event
_reached: "SynchronizedArray[float]"
_at_work = Lock()
