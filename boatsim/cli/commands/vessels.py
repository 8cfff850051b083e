"""Commands that make, compute and list vessels and other content.

Each command imports its implementation when it is called, so that `boatsim --help` answers quickly.
"""

from pathlib import Path
from typing import Annotated, Literal

import typer

from boatsim.cli.application import app, exits_with_code
from boatsim.cli.exits import print_lines
from boatsim.cli.options import Content, Load, Trusted, parse_file, parse_folder, split_loads
from boatsim.cli.trust_prompt import trusted_content


@app.command()
@exits_with_code
def new(
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="FOLDER",
            parser=parse_folder,
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
            help="Largest angle and rate of the rudder or of thrusters that turn, 360 for azimuth "
            "drives [default: 40].",
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
            min=100.0,
            max=5000.0,
            metavar="KG",
            help="Density of the water [kg/m^3] [default: 1025].",
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
            parser=parse_folder,
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
            loads=split_loads(load),
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
            help="Mesh (.stl, .obj, .ply; z up, x forward), NAME.1 of WAMIT, Nemoh's folder, or "
            "response amplitude operators: .2, .3, .4 of WAMIT, .re1, .re8, .mat, .csv.",
        ),
    ],
    draught: Annotated[
        float | None,
        typer.Option(
            min=1e-3,
            max=100.0,
            metavar="M",
            help="Draught above the lowest point [m]; not for response amplitude operators.",
        ),
    ] = None,
    density: Annotated[
        float,
        typer.Option(min=100.0, max=5000.0, metavar="KG", help="Density of the water [kg/m^3]."),
    ] = 1025.0,
    depth: Annotated[
        float,
        typer.Option(min=0.0, max=11000.0, metavar="M", help="Depth of the water; 0: deep [m]."),
    ] = 0.0,
    origin: Annotated[
        float,
        typer.Option(
            metavar="X", help="Origin of motion of the vessel along x of the mesh or of WAMIT [m]."
        ),
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
        typer.Option(
            min=1e-3,
            metavar="M",
            help="Radius of gyration in roll [m] [default: 0.35 of the beam].",
        ),
    ] = None,
    pitch_gyradius: Annotated[
        float | None,
        typer.Option(
            min=1e-3,
            metavar="M",
            help="Radius of gyration in pitch and yaw [m] [default: 0.25 of the length].",
        ),
    ] = None,
    roll_damping: Annotated[
        float,
        typer.Option(
            min=0.0,
            max=1.0,
            metavar="X",
            help="Damping of roll, added to that of waves; 1: critical.",
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
            parser=parse_folder,
            help="Folder to write [default: hydrodynamics next to HULL].",
        ),
    ] = None,
    vessel: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FOLDER|FILE", help="Vessel that moves as a table of motions states."
        ),
    ] = None,
    load: Load = None,
    speed: Annotated[
        float,
        typer.Option(
            min=0.0,
            max=100.0,
            metavar="U",
            help="Forward speed of the excitation of a mesh, or of a table of operators [m/s].",
        ),
    ] = 0.0,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Compute hydrodynamic coefficients of a hull by Capytaine, or convert those of WAMIT or Nemoh.

    The effects radiation_memory and panel_wave_loads of a vessel read the folder. The mean drift is
    that of the freely floating hull, which depends on its mass centre and its gyradii. Needs
    boatsim[bem] for a mesh. Response amplitude operators of motions become the loads that cause the
    motions of --vessel; those of loads are kept.
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
        vessel=vessel,
        loads=split_loads(load),
        speed=speed,
    )
    names = [] if vessel is None else [vessel]
    with trusted_content(content, trust, names):
        return write_hydrodynamics(hull, options)


@app.command()
@exits_with_code
def spectrum(
    source: Annotated[
        str,
        typer.Argument(
            metavar="SOURCE",
            help="A table (.csv), a file of a buoy or wave model with --format, or a scenario.",
        ),
    ],
    format_: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="Format of the file: ndbc, ndbc_ascii, swan, ncswan, ww3, ...",
        ),
    ] = None,
    time: Annotated[
        int, typer.Option(metavar="N", help="Number of the time in the file, from 0; -1: last.")
    ] = 0,
    site: Annotated[
        int, typer.Option(metavar="N", help="Number of the site in the file, from 0.")
    ] = 0,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            parser=parse_file,
            help="File to write: .csv, or .nc, .swn (SWAN), .json of wavespectra.",
        ),
    ] = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Read a wave spectrum of a buoy, model or scenario, and write it to another file.

    A sea with spectrum = "tabulated" and spectrum_file reads the .csv file. Formats of buoys and
    models need boatsim[spectra].
    """
    from boatsim.cli.spectrum import convert_spectrum

    with trusted_content(content, trust, [source]):
        return convert_spectrum(source, format_, time, site, out)


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
