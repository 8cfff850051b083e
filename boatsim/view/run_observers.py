"""Observers of a run that display it: the file run.rrd, and a live viewer."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run_files import RunObserver, StartObserver
from boatsim.view.rerun_log import RerunLog
from boatsim.view.scene import scene_from

FILE = "run.rrd"


def rerun_observers(viewer: str | None = None) -> list[StartObserver]:
    """Return the observers of a run that write its 3D log to run.rrd and show it in a viewer.

    Args:
        viewer: Address of a rerun viewer that shows the run; None: only the file is written.
    """

    @contextmanager
    def write_file(folder: Path, engine: Engine | OpenWater) -> Iterator[RunObserver]:
        scene = scene_from(engine.model, engine.vessel, engine.tank)
        with RerunLog(folder / FILE, scene) as log:
            yield log

    @contextmanager
    def feed_viewer(folder: Path, engine: Engine | OpenWater) -> Iterator[RunObserver]:
        scene = scene_from(engine.model, engine.vessel, engine.tank)
        with RerunLog(None, scene, viewer) as log:
            yield log

    if viewer is None:
        return [write_file]
    return [write_file, feed_viewer]
