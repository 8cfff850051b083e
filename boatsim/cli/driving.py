"""Implementation of `boatsim drive`: a run in real time, steered from a page in the browser."""

import time
import webbrowser
from contextlib import ExitStack, suppress
from pathlib import Path
from statistics import median_high

from boatsim.cli.exits import Exit, print_error, print_note
from boatsim.cli.metric_table import print_metrics
from boatsim.cli.run_many import ViewerOptions, open_viewer, report_saturation
from boatsim.drive.driver_input import DriverInput
from boatsim.drive.offline import write_offline_page
from boatsim.drive.server import Server
from boatsim.drive.session import NothingDriven, Session, output_folder_name
from boatsim.drive.task import FILE, DriveTask
from boatsim.simulate.evaluation import RunEntry
from boatsim.simulate.run_files import run_into_folder
from boatsim.view.run_observers import page_observer, rerun_observers
from boatsim.view.run_page import run_command
from boatsim.view.viewer import has_display
from boatsim.webassembly.compiler import find_compiler


def drive_vessel(
    task: DriveTask, out: Path | None, browser: bool | None, port: int, viewer: ViewerOptions | None
) -> int:
    """Let a user drive a vessel from a web page until the user stops; print metrics and timing.

    Args:
        task: Vessel, scenario and controller.
        out: Output folder; None for one named after the vessel and the time.
        browser: Whether to open the page in a browser; None to open it if there is a display.
        port: Port of the page; 0 for any free port.
        viewer: Viewer that also shows the run; None for none.

    Returns:
        Exit code.
    """
    folder = out or output_folder_name(task.vessel.name, time.time())
    missing = [parent for parent in folder.parents if not parent.exists()]
    try:
        content, session = _drive(task, folder, browser, port, viewer)
    except NothingDriven as reason:
        for parent in missing:  # the innermost first
            with suppress(OSError):
                parent.rmdir()
        print_error(str(reason))
        return Exit.INTERRUPTED
    return _print_result(content, folder, session)


def write_page(task: DriveTask, path: Path, browser: bool) -> int:
    """Write a page in which a vessel is driven without a server.

    Args:
        task: Vessel and scenario, for a page that simulates them.
        path: The HTML file.
        browser: Whether to open the page in a browser.

    Returns:
        Exit code.
    """
    size = write_offline_page(task, path, find_compiler())
    print(f"{path}: {size / 1000:.0f} kB; open it in a browser, it needs no server and no network")
    if browser:
        webbrowser.open(path.resolve().as_uri())
    return Exit.MET


def _drive(
    task: DriveTask, folder: Path, browser: bool | None, port: int, viewer: ViewerOptions | None
) -> tuple[RunEntry, Session]:
    """Let a user drive; return the content of norms.json, and the session."""
    with ExitStack() as stack:
        server = stack.enter_context(Server(DriverInput(), port))
        address = None
        if viewer:
            address = stack.enter_context(open_viewer(viewer.serve))
        session = Session(task, server, print_note, address is not None)
        session.show_preparation()
        print_note(f"drive in a browser on this machine: {server.address}")
        if browser or (browser is None and has_display()):
            webbrowser.open(server.address)
        scenario = task.scenario_with_address(folder)
        page = page_observer(scenario, run_command(str(folder / FILE)))
        observers = [*rerun_observers(address), page]
        done = run_into_folder(folder, scenario, observers=observers, steering=session)
        content = done.to_json()
        server.send_result({"folder": str(folder)})
    return content, session


def _print_result(content: RunEntry, folder: Path, session: Session) -> int:
    print_metrics(content, folder)
    report_saturation(content)
    clock = session.clock
    print(
        f"{clock.periods} control periods, {clock.late} of them late; "
        f"largest delay {1e3 * clock.worst:.1f} ms"
    )
    if session.latencies:
        middle = 1e3 * median_high(session.latencies)
        largest = 1e3 * max(session.latencies)
        print(
            f"delay from stick to log {middle:.0f} ms (median of {len(session.latencies)}), "
            f"at most {largest:.0f} ms"
        )
    if session.replayable:
        print(f"to repeat the run without sticks: boatsim run {folder / FILE}")
    else:
        print_error(
            f"{folder / FILE}: the goals of the run are too many for a scenario file; "
            "the file lacks them and cannot repeat the run"
        )
    if not content["complete"]:
        print_error("interrupted; what was logged is kept")
        return Exit.INTERRUPTED
    return Exit.MET
