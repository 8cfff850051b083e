"""Commands about controllers: linear models, margins, robustness, tuning, capability.

Each command imports its implementation when it is called, so that `boatsim --help` answers quickly.
"""

from pathlib import Path
from typing import Annotated

import typer

from boatsim.cli.application import app, exits_with_code
from boatsim.cli.options import (
    BoatCount,
    BoatDraws,
    BoatSeed,
    BoatSpread,
    Content,
    Load,
    OutFolder,
    Trusted,
    parse_file,
    parse_folder,
    split_loads,
)
from boatsim.cli.trust_prompt import trusted_content


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
            parser=parse_file,
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
        print_linear_model(vessel, split_loads(load), speed, command or [], choice, out)


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
        print_margins(controller, vessel, split_loads(load))


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
            split_loads(load),
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
            split_loads(load),
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
            parser=parse_folder,
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
        return print_capability(vessel, split_loads(load), areas, *given)
