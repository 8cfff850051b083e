"""Observers of a run that display it: run.rrd, a live viewer, and the page report.html."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from boatsim.physics.vessel.wave_field import wave_field
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run_files import RunObserver, StartObserver
from boatsim.simulate.scenario import Scenario
from boatsim.view.rerun_log import RerunLog
from boatsim.view.run_page import RunPage
from boatsim.view.scene import scene_from_model

FILE = "run.rrd"


def rerun_observers(viewer: str | None = None) -> list[StartObserver]:
    """Return the observers of a run that write its 3D log to run.rrd and show it in a viewer.

    Args:
        viewer: Address of a rerun viewer that shows the run; None: only the file is written.
    """

    @contextmanager
    def rerun_file_observer(folder: Path, engine: Engine | OpenWater) -> Iterator[RunObserver]:
        scene = scene_from_model(engine.model, engine.vessel, engine.tank)
        waves = wave_field(engine.vessel.effects)
        with RerunLog(folder / FILE, scene, waves=waves) as log:
            yield log

    @contextmanager
    def rerun_viewer_observer(folder: Path, engine: Engine | OpenWater) -> Iterator[RunObserver]:
        scene = scene_from_model(engine.model, engine.vessel, engine.tank)
        with RerunLog(None, scene, viewer, wave_field(engine.vessel.effects)) as log:
            yield log

    if viewer is None:
        return [rerun_file_observer]
    return [rerun_file_observer, rerun_viewer_observer]


def page_observer(scenario: Scenario, command: str = "") -> StartObserver:
    """Return the observer of a run that writes its page report.html.

    Args:
        scenario: The scenario.
        command: Command that repeats the run, which the page states; "" if there is none.
    """

    @contextmanager
    def run_page_observer(folder: Path, engine: Engine | OpenWater) -> Iterator[RunObserver]:
        scene = scene_from_model(engine.model, engine.vessel, engine.tank)
        yield RunPage(folder, scene, scenario, command)

    return run_page_observer
