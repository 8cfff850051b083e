"""Arguments and options that several commands share."""

from pathlib import Path
from typing import Annotated

import typer

from boatsim.errors import BadInput

MOST_SPEED = 1e6  # times real time; a larger value is a mistake


Runs = Annotated[
    list[Path],
    typer.Argument(
        metavar="RUN",
        help="Recordings: .csv, .parquet, .rrd of boatsim, or a run's folder.",
    ),
]


OneRun = Annotated[
    Path,
    typer.Argument(
        metavar="RUN",
        help="A recording: .csv, .parquet, .rrd of boatsim, or a run's folder.",
    ),
]


VesselName = Annotated[
    str | None,
    typer.Option(
        "--vessel",
        metavar="NAME|FOLDER|FILE",
        help="Vessel to compare with [default: the one in recording.toml].",
    ),
]


def parse_folder(text: str | Path) -> Path:
    """Return the path of a folder.

    Args:
        text: Its name on the command line.

    Raises:
        BadParameter: It is no name of a folder.
    """
    if not str(text) or "\0" in str(text):
        raise typer.BadParameter(f"{str(text)!r} is not the name of a folder")
    return Path(text)


def parse_file(text: str | Path) -> Path:
    """Return the path of a file.

    Args:
        text: Its name on the command line.

    Raises:
        BadParameter: It is no name of a file.
    """
    if not str(text) or "\0" in str(text):
        raise typer.BadParameter(f"{str(text)!r} is not the name of a file")
    return Path(text)


def parse_speed(text: str | float) -> float:
    """Return a speed in times real time; 0 for as fast as possible.

    Args:
        text: A number, or "max".

    Raises:
        BadParameter: It is neither.
    """
    if text == "max":
        return 0.0
    try:
        speed = float(text)
    except ValueError:
        speed = -1.0
    if not 0.0 <= speed < MOST_SPEED:
        raise typer.BadParameter(f"{text!r} is neither a factor of real time (0 or more) nor max")
    return speed


Scenarios = Annotated[
    list[str],
    typer.Argument(metavar="SCENARIO", help="Names, folders, patterns or files of scenarios."),
]


OutFolder = Annotated[Path, typer.Option(metavar="DIR", parser=parse_folder, help="Output folder.")]


Load = Annotated[
    list[str] | None,
    typer.Option("--load", metavar="L,L...", help="Load conditions, such as heavy,wide."),
]


Content = Annotated[
    list[Path] | None,
    typer.Option(
        "--content",
        metavar="DIR",
        help="Folder of your own effects, vessels, ...; its Python files may run. Repeatable.",
    ),
]


Jobs = Annotated[
    int | None,
    typer.Option(min=1, metavar="N", help="Parallel processes [default: one per processor]."),
]


Ray = Annotated[
    str | None,
    typer.Option(
        "--ray", metavar="auto|ADDRESS", help="Use this Ray cluster instead; needs boatsim[ray]."
    ),
]


Trusted = Annotated[
    bool,
    typer.Option("--trust", help="Run Python files in the folders of the files given here."),
]


BoatCount = Annotated[
    int, typer.Option("--boats", min=1, metavar="N", help="Number of drawn boats.")
]


BoatSeed = Annotated[
    int, typer.Option("--seed", min=0, metavar="N", help="Random seed of draws and sensor noise.")
]


BoatDraws = Annotated[
    list[str] | None,
    typer.Option(
        "--draw",
        metavar="KEY=LAW(...)",
        help="Draw a number of the vessel differently, such as body.mass=uniform(4,6). Repeatable.",
    ),
]


BoatSpread = Annotated[
    float,
    typer.Option(
        "--spread",
        min=0.0,
        metavar="FACTOR",
        help="Factor of the usual spread of the boats; 0: all as in the vessel file.",
    ),
]


def split_setting(text: str) -> tuple[str, str]:
    """Return key and value of an option `--set`.

    Args:
        text: "key=value".

    Raises:
        BadInput: There is no equals sign.
    """
    key, equals, value = text.partition("=")
    if not equals:
        raise BadInput(f"--set {text}: write KEY=VALUE, such as select.odds=3")
    return key.strip(), value.strip()


def split_loads(options: list[str] | None) -> list[str]:
    """Return the load conditions of all `--load` options.

    Args:
        options: Lists of names separated by commas; None for no option.
    """
    names = ",".join(options or []).split(",")
    return list(filter(None, map(str.strip, names)))
