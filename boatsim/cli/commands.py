"""Typer definitions of all commands and their options.

Each command imports its implementation when it is called, so that `boatsim --help` answers quickly.
"""

import atexit
import functools
import os
import re
import shlex
import sys
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, Literal, NoReturn, ParamSpec

import typer
from typer.core import TyperGroup

from boatsim.cli.exits import (
    FAULTS,
    Exit,
    escape_unencodable,
    one_line,
    print_error,
    print_lines,
    print_warnings_as_notes,
)
from boatsim.cli.trust_prompt import trusted_content
from boatsim.errors import BadInput, nearest_hint
from boatsim.interruption import raise_on_signals, signal_received
from boatsim.quiet import exit_on_signals
from boatsim.recordings.run_folder import recording_file
from boatsim.version import version as installed

P = ParamSpec("P")
BASELINE_SEEDS = 5  # enough runs for a range of a metric, at five times the cost of one run
# Base class of all command-line errors; Typer exports only its subclass BadParameter.
UsageError: Any = typer.BadParameter.__base__
MOST_SPEED = 1e6  # times real time; a larger value is a mistake


# Headings of the help text with their commands; a test checks that none is missing
COMMAND_GROUPS = {
    "Start here": ("demo",),
    "Simulate": (
        "run",
        "drive",
        "sitl",
        "sweep",
        "test",
        "manoeuvre",
        "linearise",
        "margins",
        "robustness",
        "tune",
        "capability",
    ),
    "Look at results": ("open",),
    "Learn from recordings": ("import", "check", "diagnose", "replay", "compare", "export"),
    "Vessels and content": ("new", "hydrostatics", "hydrodynamics", "list", "show"),
}


class OneLineGroup(TyperGroup):
    """Group of boatsim's commands; reports usage errors in one line, prints help by default."""

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        *_: object,
        **__: object,
    ) -> NoReturn:
        """Run the command line of boatsim and exit with its exit code.

        Args:
            args: Command-line arguments; None for those of the process.
            prog_name: Name of the program in the help texts.
        """
        if args is None:
            args = sys.argv[1:]
        escape_unencodable()
        try:
            code = super().main(list(args) or ["--help"], prog_name, standalone_mode=False)
        except UsageError as error:
            command = "boatsim"
            if error.ctx:
                command = error.ctx.command_path
            message = " ".join(error.format_message().split()).rstrip(".")
            see = " See" if message.endswith("?") else "; see"
            print_error(f"{message}{see} {command} --help")
            code = Exit.BAD_INPUT
        sys.exit(code)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command by its name.

        Args:
            ctx: Context of the command line.
            cmd_name: Name of the command.

        Raises:
            UsageError: There is no such command.
        """
        found = super().get_command(ctx, cmd_name)
        if found is None:
            hint = nearest_hint(cmd_name, self.commands)
            raise UsageError(f"command {cmd_name!r} does not exist{hint}", ctx)
        return found

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands into the help text, by purpose, with the first sentence of each.

        Args:
            ctx: Context of the command line.
            formatter: Formatter of the help text.
        """
        for heading, names in COMMAND_GROUPS.items():
            rows = []
            for name in names:
                sentence, _, _ = (self.commands[name].help or "").partition("\n\n")
                rows.append((name, " ".join(sentence.split())))
            with formatter.section(heading):
                formatter.write_dl(rows)


app = typer.Typer(
    name="boatsim",
    cls=OneLineGroup,
    help="Simulate small boats on MuJoCo, test controllers, find the physics that a model lacks.",
    add_completion=False,
    suggest_commands=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

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


def _parse_folder(text: str | Path) -> Path:
    if not str(text) or "\0" in str(text):
        raise typer.BadParameter(f"{str(text)!r} is not the name of a folder")
    return Path(text)


def _parse_file(text: str | Path) -> Path:
    if not str(text) or "\0" in str(text):
        raise typer.BadParameter(f"{str(text)!r} is not the name of a file")
    return Path(text)


def _parse_speed(text: str | float) -> float:
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
OutFolder = Annotated[
    Path, typer.Option(metavar="DIR", parser=_parse_folder, help="Output folder.")
]
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


def exits_with_code(command: Callable[P, int | None]) -> Callable[P, None]:
    """Decorate a command so that it exits with the code it returns and prints errors in one line.

    Args:
        command: Function of a command; it returns its exit code, or None for 0.

    Returns:
        The function that Typer calls.
    """

    @functools.wraps(command)
    def wrapper(*args: P.args, **options: P.kwargs) -> None:
        raise typer.Exit(_exit_code(lambda: command(*args, **options) or 0))

    return wrapper


def _exit_code(command: Callable[[], int]) -> int:
    """Call a command; print its error, if any, and return the exit code."""
    try:
        return command()
    except FAULTS as error:
        print_error(one_line(error))
        return Exit.BAD_INPUT
    except KeyboardInterrupt:
        print_error("interrupted")
        return Exit.INTERRUPTED
    except MemoryError:
        print_error(
            "out of memory; use a shorter recording, a longer step or a longer interval `log`"
        )
        return Exit.BAD_INPUT
    except Exception as error:
        if (
            signal_received()
        ):  # The interruption came inside code that turns it into another error (numba).
            print_error("interrupted")
            return Exit.INTERRUPTED
        if not type(error).__module__.startswith("numba."):
            raise
        print_error(
            f"numba cannot compile an effect: {_numba_message(error)}; the function of an effect "
            "takes floats and allocates no memory"
        )
        return Exit.BAD_INPUT


def _numba_message(error: Exception) -> str:
    """The first source location in a numba error, and its first informative line."""
    message = type(error).__name__
    for line in str(error).splitlines():
        words = " ".join(line.split())
        if words and not words.startswith("Failed in"):
            message = words.rstrip(":")
            break
    location = re.search(r'File "([^"]+)", line (\d+)', str(error))
    if location:
        return f"{Path(location[1]).name}:{location[2]}: {message}"
    return message


def _print_version(requested: bool) -> None:
    if requested:
        print(f"boatsim {installed()}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version and exit."
        ),
    ] = False,
) -> None:
    """Options before the name of a command."""


@app.command()
@exits_with_code
def demo(
    out: OutFolder = Path("out/demo"),
    open_: Annotated[
        bool, typer.Option("--open", help="Open the report in a browser, if there is a display.")
    ] = False,
    what_if: Annotated[
        bool,
        typer.Option(
            "--what-if",
            help="Add sliders to report.html that repeat the free runs; needs boatsim[wasm].",
        ),
    ] = False,
) -> int:
    """Simulate a boat with a hidden fault, find the fault from its recordings, write the report.

    It takes some ten seconds, without a C compiler a minute the first time. scenarios/demo.toml
    lists the scenarios.
    """
    print_lines(
        ["A boat with a hidden fault is simulated, and the fault is found from recordings."]
    )
    sys.stdout.flush()  # the imports below take seconds
    from boatsim.cli.demo import run_demo

    return run_demo(out, open_, what_if)


@app.command()
@exits_with_code
def run(
    scenarios: Scenarios,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            parser=_parse_folder,
            help="Output folder [default: out/VESSEL/SCENARIO].",
        ),
    ] = None,
    jobs: Annotated[
        int, typer.Option(min=1, metavar="N", help="Number of scenarios to run in parallel.")
    ] = 1,
    seed: Annotated[
        int | None,
        typer.Option(min=0, metavar="N", help="Random seed [default: that of each scenario]."),
    ] = None,
    live: Annotated[
        bool, typer.Option("--live", help="Show the run in real time in the Rerun viewer.")
    ] = False,
    serve: Annotated[
        bool, typer.Option("--serve", help="Show the run in a browser (Rerun's web viewer).")
    ] = False,
    speed: Annotated[
        float | None,
        typer.Option(
            metavar="X",
            parser=_parse_speed,
            help="With --live or --serve: factor of real time; 0 or max for no limit.",
        ),
    ] = None,
    controller: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME|FILE", help="Use this controller; repeat to compare several."),
    ] = None,
    side_by_side: Annotated[
        bool,
        typer.Option("--side-by-side", help="Write one table and one compare.rrd of all runs."),
    ] = False,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Run scenarios; print metrics; write report.html, recording.csv, norms.json and run.rrd.

    Each run has a folder. Open its report.html in a browser, or list all runs by boatsim open out.
    """
    from boatsim.cli.run_many import ViewerOptions, run_all

    if speed is not None and not (live or serve):
        raise BadInput(f"--speed = {speed:g} applies only with --live or --serve")
    viewer = None
    if live or serve:
        if speed is None:
            speed = 1.0
        viewer = ViewerOptions(serve, speed)
    controllers = controller or []
    with trusted_content(content, trust, [*scenarios, *controllers]):
        side_by_side = side_by_side or len(controllers) > 1
        return run_all(scenarios, out, jobs, seed, viewer, controllers, side_by_side)


@app.command()
@exits_with_code
def drive(
    vessel: Annotated[
        str, typer.Argument(metavar="VESSEL", help="Name, folder or file of a vessel.")
    ],
    controller: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE",
            help="Controller that follows the sticks [default: the scenario's, or none].",
        ),
    ] = None,
    scenario: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE", help="Water, wind, load and start [default: open water]."
        ),
    ] = None,
    load: Load = None,
    seconds: Annotated[
        float,
        typer.Option(min=0.1, max=86400.0, metavar="S", help="Duration of the run [s]."),
    ] = 3600.0,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            parser=_parse_folder,
            help="Output folder [default: out/VESSEL/drive-TIME].",
        ),
    ] = None,
    open_: Annotated[
        bool | None,
        typer.Option(
            "--open/--no-open", help="Open the page in a browser [default: if there is a display]."
        ),
    ] = None,
    port: Annotated[
        int,
        typer.Option(min=0, max=65535, metavar="N", help="Port of the page; 0 for any free port."),
    ] = 0,
    live: Annotated[
        bool, typer.Option("--live", help="Also show the run in the Rerun viewer.")
    ] = False,
    serve: Annotated[
        bool, typer.Option("--serve", help="Also show the run in Rerun's web viewer.")
    ] = False,
    offline: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            parser=_parse_file,
            help="Write a page that simulates the boat without a server; needs boatsim[wasm].",
        ),
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Drive a boat in real time from a page in the browser (gamepad, keys, mouse); record it."""
    from boatsim.cli.driving import drive_vessel, write_page
    from boatsim.cli.run_many import ViewerOptions
    from boatsim.drive.task import DriveTask

    if offline:
        given = {"--out": out, "--port": port, "--live": live, "--serve": serve}
        if others := [name for name, value in given.items() if value]:
            raise BadInput(f"{others[0]} does not apply with --offline, which only writes a page")
    with trusted_content(content, trust, [vessel, controller, scenario]):
        if offline:
            loads = _split_loads(load)
            task = DriveTask(vessel, scenario, controller, loads, seconds, offline=True)
            return write_page(task, offline, bool(open_))
        task = DriveTask(vessel, scenario, controller, _split_loads(load), seconds)
        viewer = None
        if live or serve:
            viewer = ViewerOptions(serve)
        return drive_vessel(task, out, open_, port, viewer)


@app.command()
@exits_with_code
def sitl(
    autopilot: Annotated[
        Literal["ardupilot"], typer.Argument(help="Autopilot; its JSON interface is served.")
    ],
    vessel: Annotated[
        str, typer.Argument(metavar="VESSEL", help="Name, folder or file of a vessel.")
    ],
    scenario: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE",
            help="Water, wind, waves, current, load and start [default: open water].",
        ),
    ] = None,
    load: Load = None,
    wind: Annotated[
        str | None,
        typer.Option(metavar="SPEED,FROM", help="Wind in m/s and where it comes from in deg."),
    ] = None,
    waves: Annotated[
        str | None,
        typer.Option(
            metavar="HEIGHT,PERIOD,FROM",
            help="Significant height in m, peak period in s, where the waves come from in deg.",
        ),
    ] = None,
    current: Annotated[
        str | None,
        typer.Option(metavar="SPEED,TOWARD", help="Current in m/s and where it flows to in deg."),
    ] = None,
    servo: Annotated[
        list[str] | None,
        typer.Option(
            metavar="OUTPUT=CHANNEL",
            help="Servo output that sets a channel, with -CHANNEL reversed. Repeatable "
            "[default: the outputs of Rover's frames].",
        ),
    ] = None,
    servo_file: Annotated[
        Path | None,
        typer.Option(metavar="FILE.toml", help="Tables [[servo]] with pulses and commands."),
    ] = None,
    seconds: Annotated[
        float,
        typer.Option(min=0.1, max=86400.0, metavar="S", help="Longest simulated duration [s]."),
    ] = 3600.0,
    seed: Annotated[
        int | None,
        typer.Option(min=0, metavar="N", help="Random seed of waves [default: the scenario's]."),
    ] = None,
    instance: Annotated[
        int,
        typer.Option(min=0, max=5000, metavar="N", help="Number of ArduPilot's instance."),
    ] = 0,
    instances: Annotated[
        int,
        typer.Option(min=1, max=100, metavar="K", help="Number of vessels, one per autopilot."),
    ] = 1,
    address: Annotated[
        str,
        typer.Option(metavar="IP", help="Address of this machine on which to listen."),
    ] = "127.0.0.1",
    port: Annotated[
        int,
        typer.Option(
            min=0,
            max=65535,
            metavar="N",
            help="UDP port of instance 0; others are 10 apart. 0: any free port.",
        ),
    ] = 9002,
    wait: Annotated[
        float,
        typer.Option(
            min=0.1, max=86400.0, metavar="S", help="Longest time without servo outputs [s]."
        ),
    ] = 60.0,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            parser=_parse_folder,
            help="Output folder [default: out/VESSEL/sitl-TIME].",
        ),
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Let ArduPilot's software in the loop (SITL) control a vessel in lock step; record the run.

    ArduPilot runs in another process, such as sim_vehicle.py -v Rover --model JSON:127.0.0.1. With
    --instances K boats 0 to K-1 are simulated at the same time.
    """
    from boatsim.cli.sitl import SitlOptions, run_under_autopilots
    from boatsim.sitl.surroundings import Surroundings, parse_numbers

    surroundings = Surroundings(
        parse_numbers("--wind", wind, ("SPEED", "FROM")),
        parse_numbers("--waves", waves, ("HEIGHT", "PERIOD", "FROM")),
        parse_numbers("--current", current, ("SPEED", "TOWARD")),
    )
    with trusted_content(content, trust, [vessel, scenario]):
        options = SitlOptions(
            vessel=vessel,
            scenario=scenario,
            load=tuple(_split_loads(load)),
            surroundings=surroundings,
            servos=tuple(servo or ()),
            servo_file=servo_file,
            seconds=seconds,
            seed=seed,
            address=address,
            port=port,
            wait=wait,
            out=out,
        )
        return run_under_autopilots(options, instance, instances)


@app.command()
@exits_with_code
def sweep(
    scenarios: Scenarios,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=A:B:N|KEY=X,Y,...", help="Axis of the parameter grid. Repeatable."
        ),
    ] = None,
    draw: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=DISTRIBUTION(...)",
            help="Parameter sampled for each run, such as normal(mean,sd). Repeatable.",
        ),
    ] = None,
    runs: Annotated[
        int, typer.Option(min=1, metavar="N", help="Samples; the same at every grid point.")
    ] = 1,
    latin: Annotated[bool, typer.Option("--latin", help="Sample by Latin hypercube.")] = False,
    sobol: Annotated[
        bool,
        typer.Option(
            "--sobol",
            help="Sobol sensitivity indices by Saltelli's design: N (D + 2) runs per grid point.",
        ),
    ] = False,
    seed: Annotated[
        int,
        typer.Option(min=0, metavar="N", help="Random seed of parameter samples and sensor noise."),
    ] = 0,
    norm: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Show only this metric in the report. Repeatable."),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", parser=_parse_folder, help="Output folder of the sweep.")
    ] = Path("out/sweep"),
    jobs: Jobs = None,
    ray: Ray = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Run scenarios over a parameter grid and random samples; write sweep.parquet and report.html.

    An interrupted sweep continues when the same command is given again.
    """
    from boatsim.cli.sweeping import SweepOptions, run_sweep

    if latin and sobol:
        raise BadInput("--latin and --sobol exclude each other; choose one")
    design: Literal["random", "latin", "sobol"] = "random"
    if latin:
        design = "latin"
    if sobol:
        design = "sobol"
    options = SweepOptions(vary or [], draw or [], runs, design, seed)
    with trusted_content(content, trust, scenarios):
        return run_sweep(scenarios, options, out, jobs, ray, norm or [])


@app.command("open")
@exits_with_code
def open_(
    folders: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="FOLDER", help="Folder of a result, or folders of results [default: out]."
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Index page to write [default: index.html there]."),
    ] = None,
    browser: Annotated[
        bool | None,
        typer.Option(
            "--open/--no-open", help="Open the page in a browser [default: if there is a display]."
        ),
    ] = None,
) -> int:
    """Open the page of a run, diagnosis or sweep, or an index page of all results in a folder.

    The path of the page is printed. The index lists each result in one line, the newest first.
    """
    from boatsim.cli.opening import open_results

    return open_results(folders or [Path("out")], out, browser)


@app.command()
@exits_with_code
def test(
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="FOLDER", parser=_parse_folder, help="Folder of scenarios (*.toml)."
        ),
    ],
    pin: Annotated[
        bool,
        typer.Option("--pin", help="Write the present metrics as baselines to FOLDER/pins.toml."),
    ] = False,
    seeds: Annotated[
        int | None,
        typer.Option(
            min=1,
            metavar="N",
            help="With --pin: seeds whose range gives the tolerance [default: 5].",
        ),
    ] = None,
    junit: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Also write JUnit XML.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of the table.")] = False,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Run the scenarios of a folder and compare their metrics with the baselines in pins.toml.

    The exit code is 1 if a metric differs from its baseline or lies outside its regression band.
    """
    from boatsim.cli.testing import run_regression

    if seeds and not pin:
        raise BadInput("--seeds applies only with --pin")
    with trusted_content(content, trust, [folder]):
        return run_regression(folder, pin, seeds or BASELINE_SEEDS, junit, json)


@app.command()
@exits_with_code
def manoeuvre(
    name: Annotated[
        str,
        typer.Argument(
            metavar="MANOEUVRE",
            help="turning_circle, zigzag, pull_out, spiral, crash_stop, roll_decay or response.",
        ),
    ],
    vessel: Annotated[
        str, typer.Option("--vessel", metavar="NAME|FOLDER|FILE", help="Vessel that performs it.")
    ],
    load: Load = None,
    angle: Annotated[
        float | None,
        typer.Option(metavar="DEG", help="Helm angle, or heel of a roll decay; negative to port."),
    ] = None,
    heading: Annotated[
        float | None,
        typer.Option(
            metavar="DEG", help="Zig-zag: heading change that reverses the helm [default: angle]."
        ),
    ] = None,
    speed: Annotated[
        float | None, typer.Option(min=1e-3, metavar="M/S", help="Approach speed.")
    ] = None,
    directions: Annotated[
        str | None,
        typer.Option(metavar="DEG,DEG...", help="Response: waves relative to the bow, 0: astern."),
    ] = None,
    periods: Annotated[
        str | None, typer.Option(metavar="S,S...", help="Response: periods of the waves.")
    ] = None,
    height: Annotated[
        float | None,
        typer.Option(min=1e-6, metavar="M", help="Response: height of the waves."),
    ] = None,
    waves: Annotated[
        str | None,
        typer.Option(
            metavar="EFFECT[,KEY=V...]",
            help="Response: effect by which waves act [default: the vessel's; strip_wave_loads].",
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", parser=_parse_folder, help="Output folder.")
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Run a standard manoeuvre; compare its figures with the limits of IMO MSC.137(76).

    `response` simulates regular waves of several periods and directions, prints the largest
    response of each degree of freedom and writes response.csv and response.svg.
    """
    from boatsim.cli.responding import print_response
    from boatsim.cli.run_many import run_manoeuvre
    from boatsim.simulate.manoeuvre import manoeuvre_scenario

    sea = {"directions": directions, "periods": periods, "height": height, "waves": waves}
    helm = {"angle": angle, "heading": heading, "speed": speed}
    response = name == "response"
    for option, value in (helm if response else sea).items():
        if value is not None:
            raise BadInput(f"--{option} does not apply to {name}")
    with trusted_content(content, trust, [vessel]):
        if response:
            return print_response(
                vessel, _split_loads(load), directions, periods, height, waves, out
            )
        scenario = manoeuvre_scenario(name, vessel, _split_loads(load), angle, speed, heading)
        folder = out or Path("out") / f"{scenario.vessel.name}_{name}"
        settings = {"--angle": angle, "--heading": heading, "--speed": speed}
        words = ["boatsim", "manoeuvre", name, "--vessel", vessel]
        if load:
            words += ["--load", ",".join(load)]
        for option, value in settings.items():
            if value is not None:
                words += [option, f"{value:g}"]
        return run_manoeuvre(scenario, folder, shlex.join(words))


@app.command()
@exits_with_code
def hydrostatics(
    hull: Annotated[
        str,
        typer.Argument(
            metavar="HULL",
            help="Closed mesh (.stl, .obj; z up, x forward), or a vessel or scenario with the "
            "effect hull_buoyancy.",
        ),
    ],
    mass: Annotated[
        float | None,
        typer.Option(min=1e-6, max=1e12, metavar="KG", help="Mass [kg] [default: the vessel's]."),
    ] = None,
    draught: Annotated[
        float | None,
        typer.Option(
            min=1e-6, max=100.0, metavar="M", help="Draught of the level hull, instead of --mass."
        ),
    ] = None,
    centre_depth: Annotated[
        float | None,
        typer.Option(
            metavar="M", help="Depth of the mass centre below the waterline [m] [default: 0]."
        ),
    ] = None,
    centre_ahead: Annotated[
        float | None,
        typer.Option(
            metavar="X",
            help="Place of the mass centre along x of the mesh [m] [default: that of buoyancy].",
        ),
    ] = None,
    density: Annotated[
        float | None,
        typer.Option(
            min=100.0, max=5000.0, metavar="KG", help="Of the water [kg/m^3] [default: 1025]."
        ),
    ] = None,
    scale: Annotated[
        float | None,
        typer.Option(min=1e-6, max=1e6, metavar="M", help="Unit of the mesh [m] [default: 1]."),
    ] = None,
    heel: Annotated[
        str | None,
        typer.Option(
            metavar="DEG,...", help="Heel angles [default: 0 to 180 in steps of 10 degrees]."
        ),
    ] = None,
    load: Load = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            parser=_parse_folder,
            help="Output folder [default: out/HULL_hydrostatics].",
        ),
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Print displacement, centres, GM and the righting-arm curve of a hull from its mesh.

    Sinkage and trim are free at each heel. It writes righting_arm.csv and righting_arm.svg. A mesh
    needs --mass or --draught.
    """
    from boatsim.cli.hydrostatics import HEELS, HydrostaticsOptions, write_hydrostatics

    with trusted_content(content, trust, [hull]):
        options = HydrostaticsOptions(
            mass=mass,
            draught=draught,
            centre_depth=centre_depth,
            centre_ahead=centre_ahead,
            density=density,
            scale=scale,
            heels=heel or HEELS,
            loads=_split_loads(load),
            out=out or Path("out") / f"{Path(hull).stem}_hydrostatics",
        )
        return write_hydrostatics(hull, options)


@app.command()
@exits_with_code
def hydrodynamics(
    hull: Annotated[
        Path,
        typer.Argument(
            metavar="HULL",
            help="Mesh (.stl, .obj, .ply; z up, x forward), NAME.1 of WAMIT, or Nemoh's folder.",
        ),
    ],
    draught: Annotated[
        float,
        typer.Option(min=1e-3, max=100.0, metavar="M", help="Draught above the lowest point [m]."),
    ],
    density: Annotated[
        float, typer.Option(min=100.0, max=5000.0, metavar="KG", help="Of the water [kg/m^3].")
    ] = 1025.0,
    depth: Annotated[
        float, typer.Option(min=0.0, max=11000.0, metavar="M", help="Of the water; 0: deep [m].")
    ] = 0.0,
    origin: Annotated[
        float,
        typer.Option(metavar="X", help="Origin of motion of the vessel along x of the mesh [m]."),
    ] = 0.0,
    scale: Annotated[
        float,
        typer.Option(min=1e-6, max=1e6, metavar="M", help="Unit of the mesh, or WAMIT's ULEN [m]."),
    ] = 1.0,
    panel: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            max=100.0,
            metavar="M",
            help="Longest edge of a panel [m]; 0: those of the file [default: length / 16].",
        ),
    ] = None,
    frequencies: Annotated[
        int, typer.Option(min=8, max=300, metavar="N", help="Number of frequencies.")
    ] = 30,
    headings: Annotated[
        int, typer.Option(min=5, max=73, metavar="N", help="Number of headings from 0 to 180 deg.")
    ] = 13,
    lowest: Annotated[
        float | None,
        typer.Option(metavar="W", help="Frequency [rad/s] [default: waves of 20 lengths]."),
    ] = None,
    highest: Annotated[
        float | None,
        typer.Option(metavar="W", help="Frequency [rad/s] [default: waves of half the length]."),
    ] = None,
    centre_depth: Annotated[
        float,
        typer.Option(metavar="M", help="Depth of the mass centre below the waterline [m]."),
    ] = 0.0,
    roll_gyradius: Annotated[
        float | None,
        typer.Option(min=1e-3, metavar="M", help="Of roll [m] [default: 0.35 of the beam]."),
    ] = None,
    pitch_gyradius: Annotated[
        float | None,
        typer.Option(
            min=1e-3, metavar="M", help="Of pitch and yaw [m] [default: 0.25 of the length]."
        ),
    ] = None,
    roll_damping: Annotated[
        float,
        typer.Option(
            min=0.0, max=1.0, metavar="X", help="Of roll, added to that of waves; 1: critical."
        ),
    ] = 0.0,
    compare: Annotated[
        bool,
        typer.Option(
            "--compare/--no-compare", help="Compare with panels of half the size at 3 frequencies."
        ),
    ] = True,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            parser=_parse_folder,
            help="Folder to write [default: hydrodynamics next to HULL].",
        ),
    ] = None,
) -> int:
    """Compute hydrodynamic coefficients of a hull by Capytaine, or convert those of WAMIT or Nemoh.

    The effects radiation_memory and panel_wave_loads of a vessel read the folder. The mean drift is
    that of the freely floating hull, which depends on its mass centre and its gyradii. Needs
    boatsim[bem] for a mesh.
    """
    from boatsim.cli.hydrodynamics import HydrodynamicsOptions, write_hydrodynamics

    options = HydrodynamicsOptions(
        draught=draught,
        density=density,
        depth=depth,
        origin=origin,
        scale=scale,
        panel=panel,
        frequencies=frequencies,
        headings=headings,
        lowest=lowest,
        highest=highest,
        centre_depth=centre_depth,
        roll_gyradius=roll_gyradius,
        pitch_gyradius=pitch_gyradius,
        roll_damping=roll_damping,
        compare=compare,
        out=out,
    )
    return write_hydrodynamics(hull, options)


@app.command("list")
@exits_with_code
def list_(
    kind: Annotated[
        Literal["vessels", "controllers", "effects", "sensors", "measures", "scenarios"] | None,
        typer.Argument(help="Kind of content [default: all kinds]."),
    ] = None,
    like: Annotated[
        str | None,
        typer.Argument(
            metavar="LIKE", help="Only names that contain this text or match this pattern."
        ),
    ] = None,
    content: Content = None,
) -> None:
    """List the vessels, controllers, effects, sensors, measures and scenarios, one per line."""
    from boatsim.cli.catalogue import list_content

    with trusted_content(content):
        print_lines(list_content(kind, like))


@app.command()
@exits_with_code
def show(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME",
            help="Name or file of an effect, controller, measure, sensor, vessel or scenario.",
        ),
    ],
    content: Content = None,
    trust: Trusted = False,
) -> None:
    """Describe an effect, vessel, ...: parameters (unit, range, default), source, example."""
    from boatsim.cli.catalogue import item_descriptions

    with trusted_content(content, trust, [name]):
        print_lines(item_descriptions(name))


@app.command()
@exits_with_code
def margins(
    controller: Annotated[str, typer.Argument(help="Name of a controller, or its .py file.")],
    vessel: Annotated[
        str | None,
        typer.Option(
            "--vessel",
            metavar="NAME|FOLDER|FILE",
            help="Vessel with whose actuators, lags and delays the delay margins are computed.",
        ),
    ] = None,
    load: Load = None,
    content: Content = None,
    trust: Trusted = False,
) -> None:
    """Print L1 norm, crossover frequency, phase and delay margin of a controller.

    With a vessel, each delay margin follows from the linearised loop and from a simulation.
    """
    from boatsim.cli.margins import print_margins

    with trusted_content(content, trust, [vessel]):
        print_margins(controller, vessel, _split_loads(load))


@app.command("linearise")
@exits_with_code
def linearise_(
    vessel: Annotated[
        str, typer.Argument(metavar="VESSEL", help="Name, folder or file of a vessel.")
    ],
    speed: Annotated[
        float | None,
        typer.Option(
            metavar="U",
            help="Speed in surge [m/s] of a straight course; the commands follow from it.",
        ),
    ] = None,
    command: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="Command of the steady motion. Repeatable [default: neutral, or by --speed].",
        ),
    ] = None,
    load: Load = None,
    output: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="State that is an output. Repeatable [default: heading, attitude, velocities].",
        ),
    ] = None,
    position: Annotated[
        bool, typer.Option("--position", help="Add the position north and east as states.")
    ] = False,
    discrete: Annotated[
        float | None,
        typer.Option(metavar="DT", help="Sample time [s] of a discrete model with held inputs."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            parser=_parse_file,
            help="File to write, .json or .npz [default: none].",
        ),
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> None:
    """Linearise a vessel about a steady motion: state-space model, eigenvalues, time constants.

    The steady motion is that under the given commands, or a straight course at a speed.
    """
    from boatsim.cli.linearise import print_linear_model

    with trusted_content(content, trust, [vessel]):
        choice = (output or [], position, discrete)
        print_linear_model(vessel, _split_loads(load), speed, command or [], choice, out)


@app.command()
@exits_with_code
def robustness(
    controllers: Annotated[
        list[str],
        typer.Argument(
            metavar="CONTROLLER[,KEY=V,...]",
            help="Controllers by name or .py file, with changed parameters.",
        ),
    ],
    vessel: Annotated[
        str,
        typer.Option("--vessel", metavar="NAME|FOLDER|FILE", help="Vessel whose boats are drawn."),
    ],
    load: Load = None,
    boats: BoatCount = 200,
    seed: BoatSeed = 0,
    draw: BoatDraws = None,
    spread: BoatSpread = 1.0,
    disturbance: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[=V,V,...]",
            help="Only this disturbance, with these values, such as delay=0.1,0.2. Repeatable "
            "[default: all].",
        ),
    ] = None,
    out: OutFolder = Path("out/robustness"),
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Find the largest disturbances that 95 % of randomly drawn boats survive under controllers.

    Delay, lags, thrust, wind, waves, sensor noise and the loss of a motor grow step by step.
    """
    from boatsim.cli.robustness import measure_robustness

    with trusted_content(content, trust, [vessel]):
        return measure_robustness(
            controllers,
            vessel,
            _split_loads(load),
            boats,
            seed,
            draw or [],
            spread,
            disturbance or [],
            out,
        )


@app.command()
@exits_with_code
def tune(
    controller: Annotated[
        str,
        typer.Argument(
            metavar="CONTROLLER[,KEY=V,...]",
            help="Controller by name or .py file, with changed parameters.",
        ),
    ],
    vessel: Annotated[
        str,
        typer.Option(
            "--vessel",
            metavar="NAME|FOLDER|FILE",
            help="Vessel whose boats are drawn; one that a diagnosis has fitted from its spread.",
        ),
    ],
    load: Load = None,
    gain: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[=LOW:HIGH]",
            help="Gain to tune, within a range. Repeatable [default: those the controller names].",
        ),
    ] = None,
    boats: BoatCount = 50,
    seed: BoatSeed = 0,
    draw: BoatDraws = None,
    spread: BoatSpread = 1.0,
    disturbance: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[=V,V,...]",
            help="Only under this disturbance, with these values, such as delay=0.2. Repeatable "
            "[default: all].",
        ),
    ] = None,
    budget: Annotated[
        int, typer.Option(min=1, metavar="N", help="Number of designs to compare.")
    ] = 60,
    out: OutFolder = Path("out/tune"),
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Find the gains of a controller with the smallest errors on randomly drawn boats.

    Prints the errors on boats that the search has not seen, and the stability margins.
    """
    from boatsim.cli.tuning import tune_controller

    with trusted_content(content, trust, [vessel]):
        return tune_controller(
            controller,
            vessel,
            _split_loads(load),
            gain or [],
            boats,
            seed,
            draw or [],
            spread,
            disturbance or [],
            budget,
            out,
        )


@app.command("capability")
@exits_with_code
def capability_(
    vessel: Annotated[
        str, typer.Argument(metavar="VESSEL", help="Name, folder or file of a vessel.")
    ],
    load: Load = None,
    current: Annotated[
        float,
        typer.Option(
            min=0.0, max=5.0, metavar="V", help="Current in the direction of the wind [m/s]."
        ),
    ] = 0.0,
    share: Annotated[
        float,
        typer.Option(min=0.01, max=1.0, metavar="S", help="Share of the thrust that may be used."),
    ] = 1.0,
    directions: Annotated[
        int, typer.Option(min=4, max=360, metavar="N", help="Number of directions of the wind.")
    ] = 36,
    lost: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Thruster that is lost in a further case. Repeatable [default: each in turn].",
        ),
    ] = None,
    front: Annotated[
        float | None,
        typer.Option(
            min=0.0, max=1e4, metavar="A", help="Frontal drag area [m^2] [default: the vessel's]."
        ),
    ] = None,
    side: Annotated[
        float | None,
        typer.Option(
            min=0.0, max=1e5, metavar="A", help="Lateral drag area [m^2] [default: the vessel's]."
        ),
    ] = None,
    arm: Annotated[
        float | None,
        typer.Option(
            min=-200.0,
            max=200.0,
            metavar="L",
            help="Lever of the side force of --side, ahead of the origin [m] [default: 0].",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            parser=_parse_folder,
            help="Output folder [default: out/VESSEL_capability].",
        ),
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Plot the largest wind that the thrusters of a vessel hold, by direction and lost thruster.

    It writes capability.svg, a polar plot, and capability.csv.
    """
    from boatsim.cli.capability import print_capability

    with trusted_content(content, trust, [vessel]):
        folder = out or Path("out") / f"{Path(vessel).stem}_capability"
        areas = (front, side, arm)
        given = (current, share, directions, lost, folder)
        return print_capability(vessel, _split_loads(load), areas, *given)


@app.command()
@exits_with_code
def compare(
    run: OneRun,
    out: OutFolder = Path("out/compare"),
    vessel: VesselName = None,
    load: Load = None,
    scenario: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE",
            help="Compare with a run of this scenario, not with the recorded commands.",
        ),
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Compare a recording with a simulation of its commands, or with a run of a scenario.

    The simulation includes the effects of the scenario that the recording names.
    """
    from boatsim.cli import diagnosis as commands

    with trusted_content(content, trust, [run, vessel, scenario]):
        return commands.compare(recording_file(run), vessel, _split_loads(load), scenario, out)


@app.command()
@exits_with_code
def replay(
    run: OneRun,
    out: OutFolder = Path("out/replay"),
    vessel: VesselName = None,
    load: Load = None,
    horizon: Annotated[
        float, typer.Option(min=0.1, metavar="S", help="Length of each free run [s].")
    ] = 6.0,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Simulate a recording in free runs driven by the recorded commands; print the rms errors."""
    from boatsim.cli import diagnosis as commands

    with trusted_content(content, trust, [run, vessel]):
        return commands.replay(recording_file(run), vessel, _split_loads(load), horizon, out)


@app.command()
@exits_with_code
def diagnose(
    runs: Runs,
    out: OutFolder = Path("out/diagnosis"),
    hold_out: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="RUN",
            help="Recording used only to validate the result. Repeatable.",
        ),
    ] = None,
    vessel: VesselName = None,
    load: Load = None,
    library: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME|FILE", help="Also test this effect as a candidate. Repeatable."),
    ] = None,
    without: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Do not test this effect. Repeatable."),
    ] = None,
    horizon: Annotated[
        float | None,
        typer.Option(
            min=0.1,
            metavar="S",
            help="Length of each free run [s] [default: from the vessel's size].",
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Change a setting of the diagnosis, such as select.odds=3. Repeatable.",
        ),
    ] = None,
    what_if: Annotated[
        bool,
        typer.Option(
            "--what-if",
            help="Add sliders to report.html that repeat the free runs; needs boatsim[wasm].",
        ),
    ] = False,
    each: Annotated[
        bool,
        typer.Option(
            "--each",
            help="Diagnose each recording (or all in a folder) separately: diagnoses.parquet.",
        ),
    ] = False,
    jobs: Jobs = None,
    ray: Ray = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Identify the physical effects that the model of a vessel lacks, from recordings.

    Settings of the method are changed with --set; boatsim/diagnosis/config.py lists them with unit,
    default and reason, and diagnosis.json holds the values used.
    """
    from boatsim.cli import diagnosis as commands
    from boatsim.diagnosis.config import from_settings
    from boatsim.sweeps.diagnoses import DiagnosisOptions

    held_out = hold_out or []
    changed = dict(map(_split_setting, settings or []))
    from_settings(changed)  # Report a mistake in a setting before reading any recording.
    if not each and (jobs is not None or ray is not None):
        raise BadInput(
            "--jobs and --ray apply only with --each, which diagnoses recordings separately"
        )
    if each and what_if:
        raise BadInput(
            "--what-if does not apply with --each, which writes one table of all results"
        )
    options = DiagnosisOptions(
        hold_out=tuple(map(str, held_out)),
        vessel=vessel,
        load=tuple(_split_loads(load)),
        library=tuple(library or ()),
        without=tuple(without or ()),
        horizon=horizon,
        settings=tuple(changed.items()),
    )
    with trusted_content(content, trust, [*runs, *held_out, vessel]):
        if each:
            from boatsim.cli.sweeping import diagnose_each

            return diagnose_each(runs, options, out, jobs, ray)
        return commands.diagnose([recording_file(run) for run in runs], options, out, what_if)


@app.command()
@exits_with_code
def check(
    runs: Runs,
    vessel: VesselName = None,
    load: Load = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Check the quality of recordings before a diagnosis; exit with 1 if a check fails."""
    from boatsim.cli.checking import print_checks

    with trusted_content(content, trust, [*runs, vessel]):
        return print_checks([recording_file(run) for run in runs], vessel, _split_loads(load))


@app.command("import")
@exits_with_code
def import_(
    log: Annotated[
        list[Path],
        typer.Argument(
            metavar="LOG...",
            help="Log: ArduPilot .BIN, ROS .mcap, .bag, .db3, PX4 .ulg, NMEA .nmea, .csv, ... "
            "Several logs of one run become one recording.",
        ),
    ],
    out: Annotated[
        Path | None, typer.Option(metavar="RUN.csv", help="Recording to write; needs --map.")
    ] = None,
    map: Annotated[
        Path | None,
        typer.Option(
            metavar="MAP.toml", help="Map from signals of the log to columns of a recording."
        ),
    ] = None,
    propose: Annotated[
        Path | None, typer.Option(metavar="MAP.toml", help="Write a proposed map to this file.")
    ] = None,
    vessel: VesselName = None,
    load: Load = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Convert a log to a recording with a map; without a map, list its signals and propose one."""
    from boatsim.cli.importing import import_log

    with trusted_content(content, trust, [vessel]):
        return import_log(log, out, map, propose, vessel, _split_loads(load))


class ExportGroup(TyperGroup):
    """Group `boatsim export`; without the name of a format a recording is written as MCAP."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Return the remaining arguments, which begin with the name of a format.

        Args:
            ctx: Context of the command line.
            args: Arguments after `boatsim export`.
        """
        if not args or args[0] not in (*self.commands, "--help"):
            args = ["mcap", *args]
        return super().parse_args(ctx, args)


exporting = typer.Typer(
    name="export",
    cls=ExportGroup,
    help="Write a recording as MCAP or a vessel as an FMU, for other programs.\n\n"
    "boatsim export RUN is short for boatsim export mcap RUN.",
    rich_markup_mode=None,
)
app.add_typer(exporting)


@exporting.command("mcap")
@exits_with_code
def export_mcap(
    run: OneRun,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE.mcap", help="File to write; by default next to the recording."),
    ] = None,
    vessel: VesselName = None,
    load: Load = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Write a recording as MCAP with standard messages, for Foxglove, PlotJuggler and ROS 2."""
    from boatsim.cli.exporting import export_recording

    with trusted_content(content, trust, [run, vessel]):
        return export_recording(recording_file(run), out, vessel, _split_loads(load))


@exporting.command("fmu")
@exits_with_code
def export_fmu(
    vessel: Annotated[
        str, typer.Argument(metavar="VESSEL", help="Name, folder or file of a vessel.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE.fmu", help="File to write [default: out/VESSEL.fmu]."),
    ] = None,
    fmi: Annotated[
        Literal["3", "2"],
        typer.Option(
            help="3: FMI 3.0, co-simulation and model exchange; 2: FMI 2.0, co-simulation."
        ),
    ] = "3",
    step: Annotated[
        float, typer.Option(metavar="S", help="Integration step [s]; that of a scenario is 0.02.")
    ] = 0.02,
    load: Load = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Write a vessel as a functional mock-up unit (FMU), for other simulators."""
    from boatsim.cli.exporting import export_vessel

    with trusted_content(content, trust, [vessel]):
        return export_vessel(vessel, out, fmi, step, _split_loads(load))


@app.command()
@exits_with_code
def new(
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="FOLDER",
            parser=_parse_folder,
            help="New folder; its name is the name of the boat.",
        ),
    ],
    length: Annotated[float, typer.Option(metavar="M", help="Waterline length [m].")],
    beam: Annotated[float, typer.Option(metavar="M", help="Overall beam [m].")],
    mass: Annotated[float, typer.Option(metavar="KG", help="Mass including payload [kg].")],
    mass_uncertainty: Annotated[
        float | None,
        typer.Option(
            metavar="SHARE",
            help="Relative standard deviation of the mass, 0 for a weighed boat [default: 0.1].",
        ),
    ] = None,
    thruster: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y[,MAX_N[,ASTERN_N]]",
            help="Fixed thruster: position forward and to starboard of the CG [m]. Repeatable.",
        ),
    ] = None,
    steered: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y[,MAX_N[,ASTERN_N]]",
            help="Steerable thruster, such as an outboard. Repeatable.",
        ),
    ] = None,
    rudder: Annotated[
        str | None,
        typer.Option(
            metavar="X[,AREA]", help="Rudder: position forward of the CG [m], area [m^2]."
        ),
    ] = None,
    tunnel: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,MAX_N",
            help="Tunnel thruster, positive to starboard: position forward of the CG [m], full "
            "thrust [N]. Repeatable.",
        ),
    ] = None,
    helm: Annotated[
        str | None,
        typer.Option(
            metavar="DEG[,DEG_PER_S]",
            help="Largest angle and rate of the rudder or of steerable thrusters [default: 40].",
        ),
    ] = None,
    draught: Annotated[
        float | None,
        typer.Option(metavar="M", help="Draught [m] [default: from the displacement]."),
    ] = None,
    hulls: Annotated[
        int, typer.Option(min=1, max=2, help="Number of hulls; 2 for a catamaran.")
    ] = 1,
    hull_beam: Annotated[
        float | None,
        typer.Option(
            metavar="M", help="Beam of one of two hulls [m] [default: a quarter of the beam]."
        ),
    ] = None,
    balance: Annotated[
        float | None,
        typer.Option(
            metavar="M", help="Balance point (CG) forward of the transom [m] [default: L/2]."
        ),
    ] = None,
    depth: Annotated[
        float | None, typer.Option(metavar="M", help="Depth of the water [m] [default: deep].")
    ] = None,
    speed: Annotated[
        float | None, typer.Option(metavar="M/S", help="Top speed at full thrust [m/s].")
    ] = None,
    thrust: Annotated[
        float | None,
        typer.Option(metavar="N", help="Full thrust of each thruster without MAX_N [N]."),
    ] = None,
    rpm: Annotated[
        float | None,
        typer.Option(
            metavar="RPM",
            help="Full revolutions: thrusters are commanded by their shaft rate, thrust grows "
            "with its square.",
        ),
    ] = None,
    curve: Annotated[
        str | None,
        typer.Option(
            metavar="COMMAND:N,...",
            help="Measured thrust of each raw command, such as --curve=-100:-20,0:0,100:60.",
        ),
    ] = None,
    from_log: Annotated[
        list[Path] | None,
        typer.Option(
            "--from-log",
            metavar="RUN",
            help="Fit the coefficients to this recording. Repeatable.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing folder.")] = False,
) -> int:
    """Create a vessel from its main particulars.

    The folder gets vessel.toml with the rule behind every number, a hull drawing and a scenario.
    """
    from boatsim.cli.newboat import create_boat
    from boatsim.newboat.particulars import Options, parse_particulars

    options = Options(
        thrusters=thruster or [],
        steered=steered or [],
        tunnels=tunnel or [],
        rudder=rudder,
        draught=draught,
        hulls=hulls,
        hull_beam=hull_beam,
        speed=speed,
        thrust=thrust,
        rpm=rpm,
        curve=curve,
        helm=helm,
        balance=balance,
        depth=depth,
        mass_uncertainty=mass_uncertainty,
    )
    main_particulars = parse_particulars(folder.resolve().name, length, beam, mass, options)
    return create_boat(folder, main_particulars, from_log or [], force)


def _split_setting(text: str) -> tuple[str, str]:
    """Split "key=value"; raises BadInput."""
    key, equals, value = text.partition("=")
    if not equals:
        raise BadInput(f"--set {text}: write KEY=VALUE, such as select.odds=3")
    return key.strip(), value.strip()


def _split_loads(options: list[str] | None) -> list[str]:
    """Load conditions of all --load options, each a list separated by commas."""
    names = ",".join(options or []).split(",")
    return list(filter(None, map(str.strip, names)))


def main() -> None:
    """Run the command line of boatsim and exit with its exit code.

    SIGTERM and SIGHUP end it in the same way as Ctrl-C.
    """
    raise_on_signals()
    print_warnings_as_notes()
    try:
        app()
    except SystemExit as error:
        exit_on_signals()
        _leave(int(error.code or 0))


def _leave(code: int) -> NoReturn:
    """End the process with an exit code after all clean-up that Python code has registered.

    The interpreter itself is not ended in its usual way: the threads of Arrow's pools are still
    alive then, which sometimes aborts the process ("terminate called without an active exception"),
    and after an interruption that Python code has handled it would exit with the code of an
    unhandled Ctrl-C.
    """
    # the steps of the interpreter itself when it ends: thread pools, then registered functions
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):  # a reader that has gone, a stream that is closed
            stream.flush()
    os._exit(code)
