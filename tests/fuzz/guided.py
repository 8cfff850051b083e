"""The same readers driven by coverage: `python -m tests.fuzz.guided READER FOLDER
[-max_total_time=28800]`.

Atheris (`pip install boatsim[fuzz]`) keeps in FOLDER every file that reaches new lines of the
reader, and begins from those of the last time. What ends in anything but a value or one clear line
stops it: the file is written as `crash-...` or `timeout-...`, and read again by naming it instead
of FOLDER. Options are those of libFuzzer.
"""

import sys
from pathlib import Path

import atheris

# the readers, and the libraries in Python that they hand a file to
WATCHED = [
    "boatsim.recordings",
    "boatsim.files",
    "boatsim.physics.vessel",
    "boatsim.physics.content",
]
WATCHED += [
    "boatsim.simulate.scenario",
    "boatsim.simulate.world",
    "boatsim.simulate.hull_xml_check",
]
WATCHED += ["boatsim.arguments", "boatsim.drive.messages", "boatsim.sweeps"]
WATCHED += ["mcap", "pymavlink.DFReader", "pynmea2", "pyulog", "rosbags"]
LONGEST = 1 << 18  # [bytes] of a file that is tried
MOST_MEMORY = 2048  # [MB]


def main() -> None:
    """Fuzz until something breaks or the time is up."""
    if len(sys.argv) < 3:
        sys.exit("\n".join(__doc__.splitlines()[:1]))
    name, place, *options = sys.argv[1:]
    with atheris.instrument_imports(include=WATCHED):
        from tests.fuzz.drive import PATIENCE
        from tests.fuzz.readers import READERS
    reader = READERS[name]
    for content in reader.seeds():  # and with that all is imported
        reader.outcome(content)
    if not Path(place).is_file():
        begin_in(Path(place), reader.seeds())
    limits = [f"-timeout={PATIENCE:.0f}", f"-max_len={LONGEST}", f"-rss_limit_mb={MOST_MEMORY}"]
    atheris.Setup([sys.argv[0], *limits, *options, place], reader.outcome)
    atheris.Fuzz()


def begin_in(folder: Path, seeds: list[bytes]) -> None:
    """Whole files, to begin from."""
    folder.mkdir(parents=True, exist_ok=True)
    for i, content in enumerate(seeds):
        (folder / f"seed_{i}").write_bytes(content)


if __name__ == "__main__":
    main()
