"""`boatsim drive`: a run in real time whose sticks are a page in the browser."""

import time
import webbrowser
from contextlib import ExitStack
from pathlib import Path

from boatsim.cli import show
from boatsim.cli.exits import Exit, complain, remark
from boatsim.cli.run_many import warn_of_limits, watching
from boatsim.drive.driver_input import Hands
from boatsim.drive.server import Server
from boatsim.drive.session import Session, folder_name
from boatsim.drive.task import FILE, Task
from boatsim.simulate.evaluation import RunEntry
from boatsim.simulate.run_files import run_into_folder
from boatsim.view.run_observers import rerun_observers
from boatsim.view.viewer import display


def drive(
    vessel: str,
    scenario: str | None,
    controller: str | None,
    load: list[str],
    seconds: float,
    out: Path | None,
    browser: bool | None,
    port: int,
    watched: bool,
    served: bool,
) -> int:
    """Drive until somebody ends it, print the norms and how well it kept time, return the exit code."""
    task = Task(vessel, scenario, controller, load, seconds)
    folder = out or folder_name(task.vessel.name, time.time())
    with ExitStack() as until_done:
        server = until_done.enter_context(Server(Hands(), port))
        to = until_done.enter_context(watching(served)) if watched else None
        session = Session(task, server, remark, to is not None)
        remark(f"drive in a browser, on this machine: {server.address}")
        if display() if browser is None else browser:
            webbrowser.open(server.address)
        observers = rerun_observers(to)
        driven = task.in_folder(folder)
        content = run_into_folder(folder, driven, observers=observers, steering=session).to_json()
        server.farewell({"folder": str(folder)})
    return _told(content, folder, session)


def _told(content: RunEntry, folder: Path, session: Session) -> int:
    """The end of it, in words."""
    show.norms(content, folder)
    warn_of_limits(content)
    clock, latencies = session.clock, sorted(session.latencies)
    print(
        f"{clock.periods} control periods, {clock.late} begun late; the latest {1e3 * clock.worst:.1f} ms behind time"
    )
    if latencies:
        middle, last = (1e3 * latencies[i] for i in (len(latencies) // 2, -1))
        print(
            f"from stick to log {middle:.0f} ms (median of {len(latencies)}), at most {last:.0f} ms"
        )
    if session.again:
        print(f"again, without hands: boatsim run {folder / FILE}")
    else:
        complain(
            f"{folder / FILE}: so many goals fit no file of ours; it says all but them, and can not go again"
        )
    if not content["complete"]:
        complain("interrupted; what was logged is kept")
        return Exit.INTERRUPTED
    return Exit.MET
