"""Implementation of `boatsim sitl`: vessels that autopilots control in lock step."""

import os
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing import get_context, parent_process
from multiprocessing.connection import wait
from pathlib import Path
from threading import Thread

from boatsim.cli.exits import FAULTS, Exit, one_line, print_error, print_lines, print_note
from boatsim.cli.metric_table import print_metrics
from boatsim.errors import BadInput
from boatsim.interruption import deferred_signals, ignored_signals, raise_on_signals
from boatsim.physics import trust
from boatsim.simulate.run import build_engine
from boatsim.simulate.run_files import run_into_folder
from boatsim.simulate.run_options import RunOptions
from boatsim.simulate.vessel_scenario import REPEATED
from boatsim.sitl.link import AutopilotLink, ReceivedFrame
from boatsim.sitl.servo_map import (
    ServoMap,
    default_servo_map,
    servo_map_of_file,
    servo_map_of_options,
)
from boatsim.sitl.session import AutopilotCommands, AutopilotSession
from boatsim.sitl.surroundings import Surroundings
from boatsim.sitl.task import SitlTask
from boatsim.view.run_observers import page_observer, rerun_observers
from boatsim.view.run_page import run_command

PORT = 9002  # to which ArduPilot's first instance sends its servo outputs
PORTS_APART = 10  # between the ports of two instances of ArduPilot
LARGEST_PORT = 65535
POLL = 1.0  # [s] between two questions which instances are still running
SAVE_TIMEOUT = 60.0  # [s] for an instance to save its run after an interruption


@dataclass(frozen=True)
class SitlOptions:
    """Options of `boatsim sitl`; plain values, so that they can be sent to a process.

    Attributes:
        vessel: Name, folder or file of the vessel.
        scenario: Scenario that sets water and start; None for open water.
        load: Load conditions.
        surroundings: Wind, waves and current.
        servos: Options `--servo`.
        servo_file: File that maps servo outputs; None for none.
        seconds: Largest duration of a run [s].
        seed: Random seed; None for that of the scenario.
        address: Address on which servo outputs are received.
        port: Port of instance 0; 0 for free ports.
        wait: Longest time without servo outputs [s].
        out: Output folder; None for one named after the vessel and the time.
    """

    vessel: str
    scenario: str | None = None
    load: tuple[str, ...] = ()
    surroundings: Surroundings = field(default_factory=Surroundings)
    servos: tuple[str, ...] = ()
    servo_file: Path | None = None
    seconds: float = 3600.0
    seed: int | None = None
    address: str = "127.0.0.1"
    port: int = PORT
    wait: float = 60.0
    out: Path | None = None

    def port_of(self, instance: int) -> int:
        """Return the port of an instance; 0 for any free one.

        Args:
            instance: Number of the instance, as of ArduPilot.

        Raises:
            BadInput: The number is beyond the range of ports.
        """
        if self.port == 0:
            return 0
        port = self.port + PORTS_APART * instance
        if port > LARGEST_PORT:
            raise BadInput(f"instance {instance} has port {port}; allowed up to {LARGEST_PORT}")
        return port


def run_under_autopilots(options: SitlOptions, first: int, instances: int) -> int:
    """Simulate vessels, one for each autopilot, until all autopilots are silent.

    Args:
        options: Vessel, surroundings and addresses.
        first: Number of the first instance.
        instances: Number of vessels, each in a process of its own if there are several.

    Returns:
        The highest exit code of the instances.

    Raises:
        BadInput: An option is wrong.
        BoatsimError: A run fails.
    """
    task, servos = load_task(options)  # mistakes are reported once, before any process starts
    folder = options.out or default_folder(task.scenario.vessel.name)
    options.port_of(first + instances - 1)
    if instances == 1:
        return serve_autopilot(options, task, servos, first, folder)
    print_lines(servos.describe())
    return _run_processes(options, range(first, first + instances), folder)


def load_task(options: SitlOptions) -> tuple[SitlTask, ServoMap]:
    """Return the vessel in its surroundings, and the mapping of the servo outputs.

    Args:
        options: The options.

    Raises:
        BadInput: An option is wrong.
    """
    task = SitlTask(
        options.vessel, options.scenario, options.load, options.seconds, options.surroundings
    )
    vessel = task.scenario.vessel
    if options.servos and options.servo_file:
        raise BadInput("--servo and --servo-file exclude each other; choose one")
    if options.servo_file:
        return task, servo_map_of_file(vessel, options.servo_file)
    if options.servos:
        return task, servo_map_of_options(vessel, options.servos)
    return task, default_servo_map(vessel)


def default_folder(vessel: str) -> Path:
    """Return the output folder of a run under an autopilot, named after the local time.

    Args:
        vessel: Name of the vessel.
    """
    return Path("out") / vessel / time.strftime("sitl-%Y%m%d-%H%M%S")


def serve_autopilot(
    options: SitlOptions,
    task: SitlTask,
    servos: ServoMap,
    instance: int,
    folder: Path,
    on_port: Callable[[int], None] | None = None,
) -> int:
    """Simulate one vessel under one autopilot; each start of the autopilot is a run of its own.

    Args:
        options: The options.
        task: Vessel and surroundings.
        servos: Mapping of the servo outputs.
        instance: Number of the instance.
        folder: Output folder of the first run; those of further runs end in -2, -3, ...
        on_port: Receives the port on which servo outputs are received.

    Returns:
        Exit code.

    Raises:
        BadInput: The port cannot be used.
        BoatsimError: No autopilot is there, or a run fails.
    """
    build_engine(task.scenario, options.seed)  # compiles the vessel before the autopilot waits
    with AutopilotLink(options.address, options.port_of(instance), options.wait) as link:
        if on_port:
            on_port(link.port)
        for line in (servos.steering, *servos.describe()):
            print_note(line)
        print_note(
            f"instance {instance} waits for ArduPilot on {link.address}, UDP port {link.port}"
        )
        received = link.next_frame()
        if received is None:
            raise BadInput(
                f"no servo outputs arrived on {link.address}, UDP port {link.port} in "
                f"{options.wait:g} s; {link.malformed} other packets. "
                f"Start ArduPilot with --model JSON:{link.address}"
            )
        code, number = Exit.MET, 1
        while received is not None and code == Exit.MET:
            own = folder
            if number > 1:
                own = folder.with_name(f"{folder.name}-{number}")
            code, received = _one_run(options, task, servos, link, received, own)
            number += 1
        return code


def _one_run(
    options: SitlOptions,
    task: SitlTask,
    servos: ServoMap,
    link: AutopilotLink,
    first: ReceivedFrame,
    folder: Path,
) -> tuple[Exit, ReceivedFrame | None]:
    """Simulate one run; return its exit code, and the first frame of the next run, if any."""
    host, port = link.peer
    print_note(f"connected to {host}, UDP port {port}; {first.frame.rate} frames per second")
    session = AutopilotSession(task, servos, link, first)
    scenario = task.run_scenario(AutopilotCommands(next_commands=session.next_commands), folder)
    repeat = run_command(str(folder / REPEATED), None, options.seed)
    observers = [*rerun_observers(), page_observer(scenario, repeat)]
    run_options = RunOptions(seed=options.seed, log_changes=True)
    done = run_into_folder(folder, scenario, run_options, observers, session)
    content = done.to_json()
    print_metrics(content, folder)
    print_lines([_count_sentence(session.recording_facts())])
    if not content["complete"]:
        print_error("interrupted; what was logged is kept")
        return Exit.INTERRUPTED, None
    if session.silent:
        print_note(f"no servo outputs for {options.wait:g} s; the run has ended")
    if session.restart:
        print_note("the autopilot was restarted; the vessel is back at its start, in a new run")
    return Exit.MET, session.restart


def _count_sentence(facts: object) -> str:
    """Numbers of frames and packets of a run in one line."""
    assert isinstance(facts, dict)
    parts = [f"{facts['frames']} frames"]
    for name in ("missed_frames", "repeated_frames", "malformed_packets", "foreign_packets"):
        if facts[name]:
            kind, _, what = name.partition("_")
            parts.append(f"{facts[name]} {kind} {what}")
    return ", ".join(parts)


def _run_processes(options: SitlOptions, instances: range, folder: Path) -> int:
    """Simulate each instance in a process of its own; return the highest exit code."""
    # A forked process would inherit locks of the threads of MuJoCo and Rerun.
    context = get_context("spawn")
    trusted = trust.trusted_folder_list()
    workers = []
    try:
        for instance in instances:
            given = (options, instance, folder / f"instance_{instance}", trusted)
            worker = context.Process(target=_serve_in_process, args=given)
            with ignored_signals():  # only this process reacts to Ctrl-C, and ends the others
                worker.start()
            workers.append(worker)
        while any(worker.is_alive() for worker in workers):
            wait([worker.sentinel for worker in workers if worker.is_alive()], POLL)
    except KeyboardInterrupt:
        with deferred_signals():
            for worker in workers:
                worker.terminate()
            for worker in workers:
                worker.join(SAVE_TIMEOUT)
    codes = []
    for worker in workers:
        worker.join()
        codes.append(worker.exitcode)
    return max(_exit_code(code) for code in codes)


def _exit_code(code: int | None) -> int:
    """Exit code of the command for that of a process, which is negative after a signal."""
    if code is None or code < 0:
        return Exit.INTERRUPTED
    return code


def _serve_in_process(
    options: SitlOptions, instance: int, folder: Path, trusted: trust.TrustedFolders
) -> None:
    """Serve one autopilot in a process of its own, and end the process with the exit code."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    raise_on_signals()
    Thread(target=_end_with_parent, daemon=True).start()
    trust.adopt_trust(trusted)
    try:
        task, servos = load_task(options)
        code = serve_autopilot(options, task, servos, instance, folder)
    except FAULTS as error:
        print_error(f"instance {instance}: {one_line(error)}")
        code = Exit.BAD_INPUT
    except KeyboardInterrupt:
        code = Exit.INTERRUPTED
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit(code)


def _end_with_parent() -> None:
    """Interrupt this process when its parent has ended, so that no instance is left alone."""
    if parent := parent_process():
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)
