"""The commands and their options; what they do is imported when they are called, so that `--help` is quick."""

import functools
import os
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, NoReturn, ParamSpec

import typer
from typer.core import TyperGroup

from boatsim.cli.exits import FAULTS, Exit, any_terminal, complain, say, words
from boatsim.cli.trust_prompt import asking
from boatsim.errors import BadInput
from boatsim.interruption import raise_on_signals, signal_received
from boatsim.quiet import exit_on_signals
from boatsim.version import version as installed

P = ParamSpec("P")
PINNED_SEEDS = 5
UsageError: Any = (
    typer.BadParameter.__base__
)  # of all mistakes on the command line typer gives a name to this one only


class OneLine(TyperGroup):
    """The program as a whole: a mistake on its command line is one line too, and no arguments ask for help."""

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        *_: object,
        **__: object,
    ) -> NoReturn:
        """Run the program and leave with its exit code."""
        given = list(sys.argv[1:] if args is None else args)
        any_terminal()
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

Runs = Annotated[
    list[Path], typer.Argument(metavar="RUN", help="Recordings: .csv, .parquet or our own .rrd.")
]
OneRun = Annotated[
    Path, typer.Argument(metavar="RUN", help="A recording: .csv, .parquet or our own .rrd.")
]
VesselName = Annotated[
    str | None,
    typer.Option(
        "--vessel", metavar="NAME|FOLDER|FILE", help="Nominal vessel, instead of recording.toml's."
    ),
]


def _folder(given: str | Path) -> Path:
    if not str(given) or "\0" in str(given):
        raise typer.BadParameter(f"{str(given)!r}; allowed is the name of a folder")
    return Path(given)


def _speed(given: str | float) -> float:
    try:
        speed = 0.0 if given == "max" else float(given)
    except ValueError:
        speed = -1.0
    if not 0.0 <= speed < 1e6:
        raise typer.BadParameter(f"{given!r}; allowed are 0 or more, times real time, and max")
    return speed


Load = Annotated[
    list[str] | None,
    typer.Option("--load", metavar="L,L...", help="Load conditions, such as heavy,wide."),
]

Content = Annotated[
    list[Path] | None,
    typer.Option(
        "--content",
        metavar="DIR",
        help="A folder of your own content, trusted to run; may be repeated.",
    ),
]
Jobs = Annotated[
    int | None,
    typer.Option(min=1, metavar="N", help="At the same time [default: one for each processor]."),
]
Ray = Annotated[
    str | None,
    typer.Option(
        "--ray", metavar="auto|ADDRESS", help="On this Ray cluster instead; needs boatsim[ray]."
    ),
]
Trusted = Annotated[
    bool,
    typer.Option("--trust", help="Let the Python files run that lie beside the files named here."),
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
    except MemoryError:
        complain(
            "this needs more memory than there is; a shorter recording, or a longer step or `log`, needs less"
        )
        return Exit.BAD_INPUT
    except Exception as error:
        if signal_received():  # in the middle of something that could not take it, such as numba
            complain("interrupted")
            return Exit.INTERRUPTED
        if not type(error).__module__.startswith("numba."):
            raise
        complain(
            f"the law of an effect can not be compiled: {_said(error)}; a law takes floats and allocates nothing"
        )
        return Exit.BAD_INPUT


def _said(error: Exception) -> str:
    """What numba says of a law: the first place that it names, and the first line that says something."""
    lines = [" ".join(line.split()) for line in str(error).splitlines()]
    said = next(
        (line.rstrip(":") for line in lines if line and not line.startswith("Failed in")),
        type(error).__name__,
    )
    place = re.search(r'File "([^"]+)", line (\d+)', str(error))
    return f"{Path(place[1]).name}:{place[2]}: {said}" if place else said


def _version(asked: bool) -> None:
    if asked:
        print(f"boatsim {installed()}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_version, is_eager=True, help="Print the version and leave."
        ),
    ] = False,
) -> None:
    """Options of the program itself."""


@app.command()
@guarded
def run(
    scenarios: Annotated[
        list[str], typer.Argument(metavar="SCENARIO", help="Names, folders, patterns, files.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", parser=_folder, help="Folder [default: out/VESSEL/SCENARIO]."),
    ] = None,
    jobs: Annotated[
        int, typer.Option(min=1, metavar="N", help="Scenarios run at the same time.")
    ] = 1,
    seed: Annotated[
        int | None, typer.Option(min=0, metavar="N", help="Seed instead of the scenarios' own.")
    ] = None,
    live: Annotated[
        bool, typer.Option("--live", help="Show the run in a rerun viewer, in real time.")
    ] = False,
    serve: Annotated[
        bool, typer.Option("--serve", help="Show it in a browser: rerun's web viewer.")
    ] = False,
    speed: Annotated[
        float | None,
        typer.Option(
            metavar="X", parser=_speed, help="Times real time, with the two; 0 or max: no wait."
        ),
    ] = None,
    controller: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME|FILE", help="Steer with this one; of several each runs, side by side."
        ),
    ] = None,
    side_by_side: Annotated[
        bool, typer.Option("--side-by-side", help="One table and one compare.rrd of all runs.")
    ] = False,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Run scenarios: recording.csv, norms.json, camera.csv, run.rrd, and a table of norms beside their bars."""
    from boatsim.cli.run_many import Watched, run_all

    if speed is not None and not (live or serve):
        raise BadInput(
            f"--speed = {speed:g}: only a run that is shown is held back; give --live or --serve too"
        )
    watched = Watched(serve, 1.0 if speed is None else speed) if live or serve else None
    several = controller or []
    with asking(content, trust, [*scenarios, *several]):
        return run_all(
            scenarios, out, jobs, seed, watched, several, side_by_side or len(several) > 1
        )


@app.command()
@guarded
def drive(
    vessel: Annotated[str, typer.Argument(metavar="VESSEL", help="A name, a folder or a file.")],
    controller: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE",
            help="Between sticks and thrusters [default: the scenario's, or none].",
        ),
    ] = None,
    scenario: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE", help="Its water, wind, load and start [default: open water]."
        ),
    ] = None,
    load: Load = None,
    seconds: Annotated[
        float,
        typer.Option(min=0.1, max=86400.0, metavar="S", help="The run ends after so long [s]."),
    ] = 3600.0,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", parser=_folder, help="Folder [default: out/VESSEL/drive-TIME]."
        ),
    ] = None,
    open_: Annotated[
        bool | None,
        typer.Option(
            "--open/--no-open", help="Open the page in a browser [default: with a screen]."
        ),
    ] = None,
    port: Annotated[
        int, typer.Option(min=0, max=65535, metavar="N", help="Of the page; 0: any that is free.")
    ] = 0,
    live: Annotated[
        bool, typer.Option("--live", help="Show the run in a rerun viewer too.")
    ] = False,
    serve: Annotated[
        bool, typer.Option("--serve", help="Show it in rerun's web viewer too.")
    ] = False,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Drive a boat in real time, by gamepad, keyboard or mouse, on a page in the browser; recorded as any run."""
    from boatsim.cli.driving import drive as driven

    with asking(content, trust, [vessel, controller, scenario]):
        return driven(
            vessel,
            scenario,
            controller,
            _loads(load),
            seconds,
            out,
            open_,
            port,
            live or serve,
            serve,
        )


@app.command()
@guarded
def sweep(
    scenarios: Annotated[
        list[str], typer.Argument(metavar="SCENARIO", help="Names, folders, patterns, files.")
    ],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=A:B:N|KEY=X,Y,...", help="A direction of the grid; may be repeated."
        ),
    ] = None,
    draw: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=LAW(...)",
            help="Drawn anew for each run: normal(mean,sd), ...; may be repeated.",
        ),
    ] = None,
    runs: Annotated[
        int, typer.Option(min=1, metavar="N", help="Draws, the same at every point of the grid.")
    ] = 1,
    latin: Annotated[bool, typer.Option("--latin", help="Draws as a Latin hypercube.")] = False,
    sobol: Annotated[
        bool,
        typer.Option(
            "--sobol", help="Saltelli's design and Sobol indices: N (D + 2) runs a point."
        ),
    ] = False,
    seed: Annotated[
        int, typer.Option(min=0, metavar="N", help="Of all that is drawn, noise too.")
    ] = 0,
    norm: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Print and draw this one, not all; may be repeated."),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", parser=_folder, help="Folder of the sweep.")
    ] = Path("out/sweep"),
    jobs: Jobs = None,
    ray: Ray = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Run scenarios over a grid and over draws: sweep.parquet, report.html; the same command goes on where it ended."""
    from boatsim.cli.sweeping import sweep as carry_out

    if latin and sobol:
        raise BadInput("--latin and --sobol are two designs; choose one")
    with asking(content, trust, scenarios):
        kind: Literal["random", "latin", "sobol"] = (
            "sobol" if sobol else "latin" if latin else "random"
        )
        return carry_out(
            scenarios, vary or [], draw or [], runs, kind, seed, out, jobs, ray, norm or []
        )


@app.command()
@guarded
def test(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", parser=_folder, help="With scenarios in it.")
    ],
    pin: Annotated[
        bool, typer.Option("--pin", help="Write FOLDER/pins.toml: the norms as they are now.")
    ] = False,
    seeds: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="N", help="Seeds whose range is a pin's tolerance [default: 5]."
        ),
    ] = None,
    junit: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write JUnit XML, for CI.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of the table.")] = False,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Run a folder's scenarios and compare their norms with their pins; leaves with 1 if anything differs."""
    from boatsim.cli.testing import regress

    if seeds and not pin:
        raise BadInput("--seeds says over how many seeds pins are drawn; it needs --pin")
    with asking(content, trust, [folder]):
        return regress(folder, pin, seeds or PINNED_SEEDS, junit, json)


@app.command()
@guarded
def manoeuvre(
    name: Annotated[
        str,
        typer.Argument(
            metavar="MANOEUVRE",
            help="turning_circle, zigzag, pull_out, spiral, crash_stop or roll_decay.",
        ),
    ],
    vessel: Annotated[
        str, typer.Option("--vessel", metavar="NAME|FOLDER|FILE", help="What does it.")
    ],
    load: Load = None,
    angle: Annotated[
        float | None,
        typer.Option(metavar="DEG", help="Helm angle, heel of a roll decay; negative to port."),
    ] = None,
    heading: Annotated[
        float | None,
        typer.Option(
            metavar="DEG", help="Zig-zag: heading that reverses the helm [default: angle]."
        ),
    ] = None,
    speed: Annotated[
        float | None, typer.Option(min=1e-3, metavar="M/S", help="Where the approach begins.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", parser=_folder, help="Folder for the files.")
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Run a standard manoeuvre of a vessel: its figures beside the limits of the IMO, and the files of a run."""
    from boatsim.cli.run_many import run_manoeuvre
    from boatsim.simulate.manoeuvre import scenario_of

    with asking(content, trust, [vessel]):
        made = scenario_of(name, vessel, _loads(load), angle, speed, heading)
        return run_manoeuvre(made, out or Path("out") / f"{made.vessel.name}_{name}")


@app.command("list")
@guarded
def list_(
    kind: Annotated[
        Literal["vessels", "controllers", "effects", "sensors", "measures", "scenarios"] | None,
        typer.Argument(help="Only these."),
    ] = None,
    like: Annotated[
        str | None,
        typer.Argument(metavar="LIKE", help="Only names with this in them, or a pattern."),
    ] = None,
    content: Content = None,
) -> None:
    """List vessels, controllers, effects, measures and scenarios, a line each."""
    from boatsim.cli.show import listing

    with asking(content):
        say(listing(kind, like))


@app.command()
@guarded
def show(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME",
            help="An effect, controller, vessel, measure, sensor or scenario; a folder.",
        ),
    ],
    content: Content = None,
    trust: Trusted = False,
) -> None:
    """Say what something is: its parameters with unit, bounds, default and source, and an example to paste."""
    from boatsim.cli.about import about

    with asking(content, trust, [name]):
        say(about(name))


@app.command()
@guarded
def margins(
    controller: Annotated[str, typer.Argument(help="Name of a controller, or its .py file.")],
    content: Content = None,
) -> None:
    """Print L1 norm, crossover, phase margin and delay margin of a controller's feedback channels."""
    from boatsim.control import margins as found
    from boatsim.physics.content import load_class

    with asking(content):
        print(found.text(found.table(load_class("controller", controller, named=True)())))


@app.command()
@guarded
def compare(
    run: OneRun,
    out: Annotated[
        Path,
        typer.Option(metavar="DIR", parser=_folder, help="Folder for compare.csv and compare.rrd."),
    ] = Path("out/compare"),
    vessel: VesselName = None,
    load: Load = None,
    scenario: Annotated[
        str | None,
        typer.Option(metavar="NAME|FILE", help="Simulate this, not the recorded commands."),
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Compare a recording with a simulation of its commands, under the effects of its scenario, or of a scenario."""
    from boatsim.cli import diagnosis as commands

    with asking(content, trust, [run, vessel, scenario]):
        return commands.compare(run, vessel, _loads(load), scenario, out)


@app.command()
@guarded
def replay(
    run: OneRun,
    out: Annotated[
        Path, typer.Option(metavar="DIR", parser=_folder, help="Folder for replay.csv.")
    ] = Path("out/replay"),
    vessel: VesselName = None,
    load: Load = None,
    horizon: Annotated[
        float, typer.Option(min=0.1, metavar="S", help="Length of each free run [s].")
    ] = 6.0,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Simulate a recording in free runs, each driven by the recorded commands alone."""
    from boatsim.cli import diagnosis as commands

    with asking(content, trust, [run, vessel]):
        return commands.replay(run, vessel, _loads(load), horizon, out)


@app.command()
@guarded
def diagnose(
    runs: Runs,
    out: Annotated[
        Path,
        typer.Option(
            metavar="DIR", parser=_folder, help="Folder for report.html and the other files."
        ),
    ] = Path("out/diagnosis"),
    hold_out: Annotated[
        list[Path] | None,
        typer.Option(metavar="RUN", help="Judge the result on this one, unseen; may be repeated."),
    ] = None,
    vessel: VesselName = None,
    load: Load = None,
    library: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME|FILE", help="Try this effect too; may be repeated."),
    ] = None,
    without: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Do not try this effect; may be repeated."),
    ] = None,
    horizon: Annotated[
        float | None,
        typer.Option(
            min=0.1, metavar="S", help="Length of each free run [s], if not the usual one."
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Change a setting of the diagnosis, such as select.odds=3; may be repeated.",
        ),
    ] = None,
    each: Annotated[
        bool,
        typer.Option(
            "--each", help="Each recording by itself, folders for those in them: diagnoses.parquet."
        ),
    ] = False,
    jobs: Jobs = None,
    ray: Ray = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Say which physics a vessel's model leaves out of recordings of the real one."""
    from boatsim.cli import diagnosis as commands
    from boatsim.diagnosis.config import from_settings

    held, own, left_out = hold_out or [], library or [], without or []
    changed = dict(map(_assignment, settings or []))
    from_settings(changed)  # a mistake in a setting ends the command before anything is read
    if not each and (jobs is not None or ray is not None):
        raise BadInput(
            "--jobs and --ray are for many recordings, each diagnosed by itself; give --each too"
        )
    with asking(content, trust, [*runs, *held, vessel]):
        if each:
            from boatsim.cli.sweeping import diagnose_each
            from boatsim.sweeps.diagnoses import Asked

            names = tuple(map(str, held)), vessel, tuple(_loads(load)), tuple(own), tuple(left_out)
            return diagnose_each(
                runs, Asked(*names, horizon, tuple(changed.items())), out, jobs, ray
            )
        return commands.diagnose(
            runs, held, vessel, _loads(load), out, own, left_out, horizon, changed
        )


@app.command()
@guarded
def check(
    runs: Runs,
    vessel: VesselName = None,
    load: Load = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Say what is wrong with recordings before physics is suspected; leaves with 1 if anything is."""
    from boatsim.cli.checking import check_logs

    with asking(content, trust, [*runs, vessel]):
        return check_logs(runs, vessel, _loads(load))


@app.command("import")
@guarded
def import_(
    log: Annotated[
        Path,
        typer.Argument(
            metavar="LOG",
            help="ArduPilot .BIN, ROS .mcap, .bag, .db3, PX4 .ulg, NMEA .nmea, .csv, ...",
        ),
    ],
    out: Annotated[
        Path | None, typer.Option(metavar="RUN.csv", help="Recording to write; needs --map.")
    ] = None,
    map: Annotated[
        Path | None, typer.Option(metavar="MAP.toml", help="Which signal is which column.")
    ] = None,
    propose: Annotated[
        Path | None, typer.Option(metavar="MAP.toml", help="Write the proposed map to this file.")
    ] = None,
    vessel: VesselName = None,
    load: Load = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Turn a log into a recording by a map; without one, list its signals and propose a map."""
    from boatsim.cli.importing import import_log

    with asking(content, trust, [vessel]):
        return import_log(log, out, map, propose, vessel, _loads(load))


@app.command()
@guarded
def new(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", parser=_folder, help="Of the new boat, called so.")
    ],
    length: Annotated[float, typer.Option(metavar="M", help="Length of the waterline [m].")],
    beam: Annotated[float, typer.Option(metavar="M", help="Beam overall [m].")],
    mass: Annotated[float, typer.Option(metavar="KG", help="Mass with all on board [kg].")],
    thruster: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y[,MAX_N[,ASTERN_N]]",
            help="A fixed thruster, ahead and to starboard of the mass centre [m]; may be repeated.",
        ),
    ] = None,
    steered: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y[,MAX_N[,ASTERN_N]]",
            help="A thruster that turns, an outboard; may be repeated.",
        ),
    ] = None,
    rudder: Annotated[
        str | None,
        typer.Option(
            metavar="X[,AREA]", help="A rudder, ahead of the mass centre [m], its area [m^2]."
        ),
    ] = None,
    draught: Annotated[
        float | None, typer.Option(metavar="M", help="[m] [default: what carries the mass].")
    ] = None,
    hulls: Annotated[int, typer.Option(min=1, max=2, help="2 for a catamaran.")] = 1,
    speed: Annotated[
        float | None, typer.Option(metavar="M/S", help="Reached at full thrust [m/s].")
    ] = None,
    thrust: Annotated[
        float | None,
        typer.Option(metavar="N", help="Full thrust of each thruster that states none [N]."),
    ] = None,
    from_log: Annotated[
        list[Path] | None,
        typer.Option(
            "--from-log",
            metavar="RUN",
            help="Fit the coefficients to this recording; may be repeated.",
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Write over a folder that is there.")
    ] = False,
) -> int:
    """Make a boat from its particulars: a vessel file with every number's rule, a drawing, a first scenario."""
    from boatsim.cli.newboat import new_boat
    from boatsim.newboat.particulars import particulars

    name, driven, turned = folder.resolve().name, thruster or [], steered or []
    boat = particulars(
        name, length, beam, mass, driven, turned, rudder, draught, hulls, speed, thrust
    )
    return new_boat(folder, boat, from_log or [], force)


def _assignment(text: str) -> tuple[str, str]:
    """Split "key=value". Raises BadInput."""
    key, equals, value = text.partition("=")
    if not equals:
        raise BadInput(f"--set {text}: write KEY=VALUE, such as select.odds=3")
    return key.strip(), value.strip()


def _loads(given: list[str] | None) -> list[str]:
    return [name.strip() for text in given or [] for name in text.split(",") if name.strip()]


def main() -> None:
    """The program from here on; leaves with its exit code. A kill and a terminal that closes are as Ctrl-C is."""
    raise_on_signals()
    try:
        app()
    except SystemExit as leaving:
        exit_on_signals()
        if not signal_received():
            raise
        # Python takes a Ctrl-C that passed through code of its own making for one that nobody
        # handled
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        os._exit(int(leaving.code or 0))
