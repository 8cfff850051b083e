"""The commands and their options; what they do is imported when they are called, so that `--help` is quick."""

import functools
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, NoReturn, ParamSpec

import typer
from typer.core import TyperGroup

import boatsim
from boatsim.cli.exits import FAULTS, Exit, complain, words

P = ParamSpec("P")
UsageError: Any = typer.BadParameter.__base__  # of all mistakes on the command line typer gives a name to this one only


class OneLine(TyperGroup):
    """The program as a whole: a mistake on its command line is one line too, and no arguments ask for help."""

    def main(
        self, args: Sequence[str] | None = None, prog_name: str | None = None, *_: object, **__: object
    ) -> NoReturn:
        """Run the program and leave with its exit code."""
        given = list(sys.argv[1:] if args is None else args)
        try:
            code = super().main(given or ["--help"], prog_name, standalone_mode=False)
        except UsageError as error:
            asked = error.ctx.command_path if error.ctx else "boatsim"
            complain(f"{' '.join(error.format_message().split()).rstrip('.')}; see {asked} --help")
            code = Exit.BAD_INPUT
        sys.exit(code)


app = typer.Typer(
    name="boatsim",
    cls=OneLine,
    help="Small-boat motion and control on MuJoCo, and what a simulation of a real boat has left out.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

Runs = Annotated[list[Path], typer.Argument(metavar="RUN", help="Recordings: .csv, .parquet or our own .rrd.")]
OneRun = Annotated[Path, typer.Argument(metavar="RUN", help="A recording: .csv, .parquet or our own .rrd.")]
VesselName = Annotated[
    str | None,
    typer.Option("--vessel", metavar="NAME|FOLDER|FILE", help="Nominal vessel, instead of recording.toml's."),
]
Load = Annotated[
    list[str] | None, typer.Option("--load", metavar="L,L...", help="Load conditions, such as heavy,wide.")
]


def guarded(command: Callable[P, int | None]) -> Callable[P, None]:
    """The command with its result as exit code; what goes wrong is one line."""

    @functools.wraps(command)
    def guard(*args: P.args, **options: P.kwargs) -> None:
        raise typer.Exit(_code(lambda: command(*args, **options) or 0))

    return guard


def _code(command: Callable[[], int]) -> int:
    """Exit code of a command, its error printed."""
    try:
        return command()
    except FAULTS as error:
        complain(words(error))
        return Exit.BAD_INPUT
    except KeyboardInterrupt:
        complain("interrupted")
        return Exit.INTERRUPTED
    except Exception as error:
        if not type(error).__module__.startswith("numba."):
            raise
        complain(f"the law of an effect can not be compiled: {_said(error)}; a law takes floats and allocates nothing")
        return Exit.BAD_INPUT


def _said(error: Exception) -> str:
    """What numba says of a law: the first place that it names, and the first line that says something."""
    lines = [" ".join(line.split()) for line in str(error).splitlines()]
    said = next((line.rstrip(":") for line in lines if line and not line.startswith("Failed in")), type(error).__name__)
    place = re.search(r'File "([^"]+)", line (\d+)', str(error))
    return f"{Path(place[1]).name}:{place[2]}: {said}" if place else said


def _version(asked: bool) -> None:
    if asked:
        print(f"boatsim {boatsim.__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and leave.")
    ] = False,
) -> None:
    """Options of the program itself."""


@app.command()
@guarded
def run(
    scenarios: Annotated[list[str], typer.Argument(metavar="SCENARIO", help="Names, folders, patterns, files.")],
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Folder [default: out/VESSEL/SCENARIO].")] = None,
    jobs: Annotated[int, typer.Option(min=1, metavar="N", help="Scenarios run at the same time.")] = 1,
    seed: Annotated[int | None, typer.Option(min=0, metavar="N", help="Seed instead of the scenarios' own.")] = None,
    live: Annotated[bool, typer.Option("--live", help="Show the run in a rerun viewer while it runs.")] = False,
) -> int:
    """Run scenarios: recording.csv, norms.json, camera.csv, run.rrd, and a table of norms beside their bars."""
    from boatsim.cli.batch import run_all

    return run_all(scenarios, out, jobs, seed, live)


@app.command()
@guarded
def manoeuvre(
    name: Annotated[
        str,
        typer.Argument(metavar="MANOEUVRE", help="turning_circle, zigzag, pull_out, spiral, crash_stop or roll_decay."),
    ],
    vessel: Annotated[str, typer.Option("--vessel", metavar="NAME|FOLDER|FILE", help="What does it.")],
    load: Load = None,
    angle: Annotated[
        float | None, typer.Option(metavar="DEG", help="Helm angle, heel of a roll decay; negative to port.")
    ] = None,
    heading: Annotated[
        float | None,
        typer.Option(metavar="DEG", help="Zig-zag: heading that reverses the helm [default: angle]."),
    ] = None,
    speed: Annotated[float | None, typer.Option(min=1e-3, metavar="M/S", help="Where the approach begins.")] = None,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Folder for the files.")] = None,
) -> int:
    """Run a standard manoeuvre of a vessel: its figures beside the limits of the IMO, and the files of a run."""
    from boatsim.cli.batch import run_manoeuvre
    from boatsim.simulate.manoeuvre import scenario_of

    made = scenario_of(name, vessel, _loads(load), angle, speed, heading)
    return run_manoeuvre(made, out or Path("out") / f"{made.vessel.name}_{name}")


@app.command("list")
@guarded
def list_(
    kind: Annotated[
        Literal["vessels", "controllers", "effects", "sensors", "measures", "scenarios"] | None,
        typer.Argument(help="Only these."),
    ] = None,
) -> None:
    """List vessels, controllers, effects, measures and scenarios, a line each."""
    from boatsim.cli.show import listing

    print("\n".join(listing(kind)))


@app.command()
@guarded
def margins(controller: Annotated[str, typer.Argument(help="Name of a controller, or its .py file.")]) -> None:
    """Print L1 norm, crossover, phase margin and delay margin of a controller's feedback channels."""
    from boatsim.control import margins as found
    from boatsim.physics import content

    print(found.text(found.table(content.load_class("controller", controller)())))


@app.command()
@guarded
def compare(
    run: OneRun,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for compare.csv and compare.rrd.")] = Path(
        "out/compare"
    ),
    vessel: VesselName = None,
    load: Load = None,
    scenario: Annotated[
        str | None, typer.Option(metavar="NAME|FILE", help="Simulate this, not the recorded commands.")
    ] = None,
) -> int:
    """Compare a recording with a simulation of its commands, or of a scenario."""
    from boatsim.cli import diagnosis as commands

    return commands.compare(run, vessel, _loads(load), scenario, out)


@app.command()
@guarded
def replay(
    run: OneRun,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for replay.csv.")] = Path("out/replay"),
    vessel: VesselName = None,
    load: Load = None,
    horizon: Annotated[float, typer.Option(min=0.1, metavar="S", help="Length of each free run [s].")] = 6.0,
) -> int:
    """Simulate a recording in free runs, each driven by the recorded commands alone."""
    from boatsim.cli import diagnosis as commands

    return commands.replay(run, vessel, _loads(load), horizon, out)


@app.command()
@guarded
def diagnose(
    runs: Runs,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for report.html and the other files.")] = Path(
        "out/diagnosis"
    ),
    hold_out: Annotated[
        list[Path] | None, typer.Option(metavar="RUN", help="Judge the result on this one, unseen; may be repeated.")
    ] = None,
    vessel: VesselName = None,
    load: Load = None,
    library: Annotated[
        list[str] | None, typer.Option(metavar="NAME|FILE", help="Try this effect too; may be repeated.")
    ] = None,
    without: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Do not try this effect; may be repeated.")
    ] = None,
    horizon: Annotated[
        float | None, typer.Option(min=0.1, metavar="S", help="Length of each free run [s], if not the usual one.")
    ] = None,
) -> int:
    """Say which physics a vessel's model leaves out of recordings of the real one."""
    from boatsim.cli import diagnosis as commands

    return commands.diagnose(runs, hold_out or [], vessel, _loads(load), out, library or [], without or [], horizon)


@app.command()
@guarded
def check(runs: Runs, vessel: VesselName = None, load: Load = None) -> int:
    """Say what is wrong with recordings before physics is suspected; leaves with 1 if anything is."""
    from boatsim.cli.checking import check_logs

    return check_logs(runs, vessel, _loads(load))


@app.command("import")
@guarded
def import_(
    log: Annotated[
        Path,
        typer.Argument(metavar="LOG", help="ArduPilot .BIN, ROS .mcap, .bag, .db3, PX4 .ulg, NMEA .nmea, .csv, ..."),
    ],
    out: Annotated[Path | None, typer.Option(metavar="RUN.csv", help="Recording to write; needs --map.")] = None,
    map: Annotated[Path | None, typer.Option(metavar="MAP.toml", help="Which signal is which column.")] = None,
    propose: Annotated[
        Path | None, typer.Option(metavar="MAP.toml", help="Write the proposed map to this file.")
    ] = None,
    vessel: VesselName = None,
    load: Load = None,
) -> int:
    """Turn a log into a recording by a map; without one, list its signals and propose a map."""
    from boatsim.cli.importing import import_log

    return import_log(log, out, map, propose, vessel, _loads(load))


def _loads(given: list[str] | None) -> list[str]:
    return [name.strip() for text in given or [] for name in text.split(",") if name.strip()]


def main() -> None:
    """Entry point of the program; leaves with its exit code."""
    app()
