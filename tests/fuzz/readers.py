"""The readers, each with whole files to begin from, and how a mutated file is read."""

import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

from boatsim.cli.exits import FAULTS, one_line
from boatsim.diagnosis.loading import vessel_of_recording_file
from boatsim.drive.driver_input import DriverInput
from boatsim.drive.messages import Movement, parse_message
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.recordings import expression, table
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log, open_log
from boatsim.recordings.importing.mapping import read_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.signal_listing import signal_table
from boatsim.simulate import scenario, world
from boatsim.simulate.cases import read_scenario
from boatsim.sweeps.axes import parse_axis
from boatsim.sweeps.entries import RunEntry
from boatsim.sweeps.journal import Journal
from boatsim.sweeps.keys import Target, Value, find_target_values, set_values
from boatsim.sweeps.results import Results
from boatsim.sweeps.sampled_keys import parse_sampled_key
from boatsim.sweeps.summary import metric_statistics
from boatsim.sweeps.text_tables import result_tables
from tests.fuzz import calls, seeds
from tests.fuzz.mutate import edits
from tests.fuzz.seeds import LOGS, files
from tests.fuzz.tables import call_edits, lines_edits, toml_edits

TEXT, XML = b" ,;=\n[]{}", b" ,;=\n[]{}<>\"'/"  # what stands between words


@dataclass(frozen=True)
class Reader:
    """Files that it reads whole, the name that a mutated one has, and what reads it."""

    file: str
    seeds: Callable[[], list[bytes]]
    read: Callable[[Path], object]
    between: bytes = TEXT  # words, which are changed whole; empty: bytes alone are changed
    share: float = 1.0  # of the files that others get: one that starts a process for each is slow
    # changes of a whole file, each with a method `of`; default: those of bytes and words
    changes: Callable[[], st.SearchStrategy[list[Any]]] | None = None

    @property
    def edits(self) -> "st.SearchStrategy[list[Any]]":
        """A few changes of a whole file."""
        if self.changes is not None:
            return self.changes()
        return edits(self.between)

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
    return vessel_of_recording_file(run, None, []), table.read(run)


def _vessel(path: Path) -> object:
    """A vessel, saved and loaded again, in each of its loads."""
    boat = vessel.load_vessel(str(path))
    for load in boat.loads:
        vessel.load_vessel(str(path), [load])
    return boat.save(path.parents[1] / "saved")


def _hull(path: Path) -> object:
    return world.build_model(vessel.load_vessel(f"{path.parent}/"))


def _drawn(path: Path) -> object:
    """A hull with a mesh and a texture of which one is changed."""
    return world.build_model(vessel.load_vessel(f"{path.parent}/"))


def _log(path: Path) -> object:
    """What `boatsim import` does: the list, the proposal, and by that the recording."""
    log = open_log(path)
    text = propose_map(log, "otter", [], ("surge", "sway", "yaw"), None)
    signal_table(log)
    file = path.with_name("proposed.toml")
    file.write_text(text, encoding="utf-8")
    return convert_log(log, read_map(file), "map.toml")


def _bag(path: Path) -> object:
    return _log(path.parent)


def _map(path: Path) -> object:
    return convert_log(_whole_log(), read_map(path), str(path), {"n_port_radps": (-104.0, 104.0)})


@cache
def _whole_log() -> Log:
    return open_log(seeds.folder() / "map" / "log.csv")


def _binary(file: str, *whole: str) -> Reader:
    return Reader(file, files(*(LOGS / name for name in whole)), _log, b"")


def _expression(path: Path) -> object:
    """What a sweep or an import reads from a text: `vary`, `draw` or `column`, then the text."""
    kind, _, text = path.read_text("utf-8", "surrogateescape").partition(" ")
    if kind == "vary":
        axis = parse_axis(text)
        return [
            _with_value(axis.target, value)
            for value in axis.values[:: max(1, len(axis.values) - 1)]
        ]
    if kind == "draw":
        sampled = parse_sampled_key(text)
        return _with_value(sampled.target, sampled.quantiles(np.array([0.5]))[0])
    return expression.parse(text, ("Heading", "Port"))


def _with_value(target: Target, value: Value) -> object:
    """The scenario of an expression with another value."""
    table, place = read_scenario(seeds.OF_EXPRESSIONS)
    table, slots = find_target_values(table, place, target)
    return scenario.from_table(set_values(table, place, slots, target.operation, value), place)


def _journal(path: Path) -> object:
    """What a sweep does with the runs that its folder holds."""
    plan = seeds.plan()
    with Journal(path.parent, seeds.ABOUT, RunEntry, plan.run_count) as journal:
        entries = dict(sorted(journal.done.items()))
    results = Results(plan, entries)
    results.write(path.parent)
    return results.columns(), results.metrics, metric_statistics(results), result_tables(results)


def _message(path: Path) -> object:
    """What the server of `boatsim drive` does with the messages of a page, one a line."""
    hands = DriverInput()
    for line in path.read_bytes().splitlines():
        message = parse_message(line)
        if message is None:
            raise BadInput("another message closes the connection")
        if isinstance(message, Movement):
            hands.store_sticks(message.sticks, message.moved)
            assert all(abs(x) <= 1.0 for x in hands.sticks() or ())
            json.dumps([time.time() - message.moved], allow_nan=False)
    return hands


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
    "vessel tables": Reader("boat/vessel.toml", seeds.vessels, _vessel, changes=toml_edits),
    "scenario tables": Reader(
        "scenario.toml",
        seeds.scenarios,
        lambda path: scenario.load(str(path)),
        changes=toml_edits,
    ),
    "recording tables": Reader("noted/recording.toml", seeds.notes, _notes, changes=toml_edits),
    "map tables": Reader("map/map.toml", lambda: [seeds.MAP.encode()], _map, changes=toml_edits),
    "expressions": Reader("expression.txt", seeds.expressions, _expression, b" ,;=:()+*.\n"),
    "journal.jsonl": Reader("sweep/journal.jsonl", seeds.journals, _journal, b' ,:[]{}"\n'),
    "journal entries": Reader("sweep/journal.jsonl", seeds.journals, _journal, changes=lines_edits),
    "calls": Reader("call.json", calls.calls, calls.call, changes=call_edits),
    "messages": Reader("message.json", seeds.messages, _message, b' ,:[]{}"\n'),
    "message values": Reader("message.json", seeds.messages, _message, changes=lines_edits),
    "hull.xml": Reader("hull/hull.xml", files("models/trial_boat/hull.xml"), _hull, XML),
    "mesh.obj": Reader("drawn/mesh.obj", files("models/joystick_boat/fittings.obj"), _drawn),
    "mesh.stl": Reader("drawn/mesh.stl", lambda: [seeds.stl_file()], _drawn, b""),
    "texture.png": Reader("drawn/texture.png", lambda: [seeds.png_file()], _drawn, b""),
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
