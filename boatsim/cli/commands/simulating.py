"""Commands that simulate scenarios and manoeuvres, or drive a boat.

Each command imports its implementation when it is called, so that `boatsim --help` answers quickly.
"""

import shlex
import sys
from pathlib import Path
from typing import Annotated, Literal

import typer

from boatsim.cli.application import app, exits_with_code
from boatsim.cli.exits import print_lines
from boatsim.cli.fast_start import collect_garbage_rarely
from boatsim.cli.options import (
    Content,
    Jobs,
    Load,
    OutFolder,
    Ray,
    Scenarios,
    Trusted,
    parse_file,
    parse_folder,
    parse_speed,
    split_loads,
)
from boatsim.cli.trust_prompt import trusted_content
from boatsim.errors import BadInput

BASELINE_SEEDS = 5  # enough runs for a range of a metric, at five times the cost of one run


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
            parser=parse_folder,
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
            parser=parse_speed,
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
    collect_garbage_rarely()
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
            parser=parse_folder,
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
            parser=parse_file,
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
            loads = split_loads(load)
            task = DriveTask(vessel, scenario, controller, loads, seconds, offline=True)
            return write_page(task, offline, bool(open_))
        task = DriveTask(vessel, scenario, controller, split_loads(load), seconds)
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
            parser=parse_folder,
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
            load=tuple(split_loads(load)),
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
        Path, typer.Option(metavar="DIR", parser=parse_folder, help="Output folder of the sweep.")
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


@app.command()
@exits_with_code
def test(
    folder: Annotated[
        Path,
        typer.Argument(metavar="FOLDER", parser=parse_folder, help="Folder of scenarios (*.toml)."),
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
        float | None,
        typer.Option(min=1e-3, metavar="M/S", help="Approach speed, or forward speed in waves."),
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
        Path | None, typer.Option(metavar="DIR", parser=parse_folder, help="Output folder.")
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
    helm = {"angle": angle, "heading": heading}
    response = name == "response"
    for option, value in (helm if response else sea).items():
        if value is not None:
            raise BadInput(f"--{option} does not apply to {name}")
    with trusted_content(content, trust, [vessel]):
        if response:
            return print_response(
                vessel, split_loads(load), directions, periods, height, waves, out, speed or 0.0
            )
        scenario = manoeuvre_scenario(name, vessel, split_loads(load), angle, speed, heading)
        folder = out or Path("out") / f"{scenario.vessel.name}_{name}"
        settings = {"--angle": angle, "--heading": heading, "--speed": speed}
        words = ["boatsim", "manoeuvre", name, "--vessel", vessel]
        if load:
            words += ["--load", ",".join(load)]
        for option, value in settings.items():
            if value is not None:
                words += [option, f"{value:g}"]
        return run_manoeuvre(scenario, folder, shlex.join(words))
