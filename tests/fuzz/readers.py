"""The readers, each with whole files to begin from, and how a mutated file is read."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from boatsim.cli.exits import FAULTS, one_line
from boatsim.diagnosis.loading import vessel_for
from boatsim.physics import vessel
from boatsim.recordings import table
from boatsim.recordings.importing.convert import convert
from boatsim.recordings.importing.log import Log, open_log
from boatsim.recordings.importing.mapping import read_map
from boatsim.recordings.importing.mapping_proposal import propose_map, signal_table
from boatsim.simulate import scenario, world
from tests.fuzz import seeds
from tests.fuzz.seeds import LOGS, files

TEXT, XML = b" ,;=\n[]{}", b" ,;=\n[]{}<>\"'/"  # what stands between words


@dataclass(frozen=True)
class Reader:
    """Files that it reads whole, the name that a mutated one has, and what reads it."""

    file: str
    seeds: Callable[[], list[bytes]]
    read: Callable[[Path], object]
    between: bytes = TEXT  # words, which are changed whole; empty: bytes alone are changed
    share: float = 1.0  # of the files that others get: one that starts a process for each is slow

    def outcome(self, content: bytes) -> bool:
        """Whether a file can be used; False where one clear line says why not.

        Raises whatever else comes.
        """
        path = seeds.folder() / self.file
        path.write_bytes(content)
        try:
            self.read(path)
        except FAULTS as error:
            assert one_line(error).strip()
            return False
        return True


def _notes(path: Path) -> object:
    run = path.parent / "run.csv"
    return vessel_for(run, None, []), table.read(run)


def _hull(path: Path) -> object:
    return world.build_model(vessel.load_vessel(f"{path.parent}/"))


def _log(path: Path) -> object:
    """What `boatsim import` does: the list, the proposal, and by that the recording."""
    log = open_log(path)
    text = propose_map(log, "otter", [], ("surge", "sway", "yaw"), None)
    signal_table(log)
    file = path.with_name("proposed.toml")
    file.write_text(text, encoding="utf-8")
    return convert(log, read_map(file), "map.toml")


def _bag(path: Path) -> object:
    return _log(path.parent)


def _map(path: Path) -> object:
    return convert(_whole_log(), read_map(path), str(path), {"n_port_radps": (-104.0, 104.0)})


@cache
def _whole_log() -> Log:
    return open_log(seeds.folder() / "map" / "log.csv")


def _binary(file: str, *whole: str) -> Reader:
    return Reader(file, files(*(LOGS / name for name in whole)), _log, b"")


BOATS = ("trial_boat", "joystick_boat", "kvlcc2_mmg")
READERS = {
    "csv": Reader("run.csv", lambda: [seeds.csv_file()], table.read),
    "parquet": Reader("run.parquet", lambda: [seeds.parquet_file()], table.read, b""),
    "rrd": Reader("run.rrd", lambda: [seeds.rrd_file()], table.read, b"", share=0.02),
    "recording.toml": Reader("noted/recording.toml", seeds.notes, _notes),
    "vessel.toml": Reader(
        "boat/vessel.toml",
        files(*(f"models/{n}/vessel.toml" for n in BOATS)),
        lambda path: vessel.load_vessel(str(path)),
    ),
    "hull.xml": Reader("hull/hull.xml", files("models/trial_boat/hull.xml"), _hull, XML),
    "scenario.toml": Reader(
        "scenario.toml", seeds.scenarios, lambda path: scenario.load(str(path))
    ),
    "map.toml": Reader("map/map.toml", lambda: [seeds.MAP.encode()], _map),
    "table.csv": Reader("table.csv", seeds.tables, _log),
    "table.parquet": _binary("table.parquet", "stacked.parquet"),
    "ardupilot": _binary("log.BIN", "rover.BIN"),
    "ulog": _binary("log.ulg", "px4.ulg"),
    "nmea": Reader("log.nmea", seeds.sentences, _log),
    "mcap": _binary("log.mcap", "ros2.mcap"),
    "bag": _binary("log.bag", "ros1.bag"),
    "db3": Reader("bag/ros2_bag.db3", files(LOGS / "ros2_bag" / "ros2_bag.db3"), _bag, b""),
    "metadata.yaml": Reader(
        "bag_about/metadata.yaml", files(LOGS / "ros2_bag" / "metadata.yaml"), _bag, XML
    ),
}
