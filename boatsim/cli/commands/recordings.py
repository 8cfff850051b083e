"""Commands that read recordings and logs: import, check, diagnose, replay, compare, export, open.

Each command imports its implementation when it is called, so that `boatsim --help` answers quickly.
"""

from pathlib import Path
from typing import Annotated, Any, Literal

import typer
from typer.core import TyperGroup

from boatsim.cli.application import app, exits_with_code
from boatsim.cli.options import (
    Content,
    Jobs,
    Load,
    OneRun,
    OutFolder,
    Ray,
    Runs,
    Trusted,
    VesselName,
    split_loads,
    split_setting,
)
from boatsim.cli.trust_prompt import trusted_content
from boatsim.errors import BadInput
from boatsim.recordings.run_folder import recording_file


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
        return commands.compare(recording_file(run), vessel, split_loads(load), scenario, out)


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
        return commands.replay(recording_file(run), vessel, split_loads(load), horizon, out)


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

    Settings of the method are changed with --set; boatsim/diagnosis/config/ lists them with unit,
    default and reason, and diagnosis.json holds the values used.
    """
    from boatsim.cli import diagnosis as commands
    from boatsim.diagnosis.config import from_settings
    from boatsim.sweeps.diagnoses import DiagnosisOptions

    held_out = hold_out or []
    changed = dict(map(split_setting, settings or []))
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
        load=tuple(split_loads(load)),
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
        return print_checks([recording_file(run) for run in runs], vessel, split_loads(load))


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
        return import_log(log, out, map, propose, vessel, split_loads(load))


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
        return export_recording(recording_file(run), out, vessel, split_loads(load))


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
    sensors: Annotated[
        str | None,
        typer.Option(
            metavar="SCENARIO",
            help="Scenario whose sensors the unit has, with their errors; default: none.",
        ),
    ] = None,
    load: Load = None,
    content: Content = None,
    trust: Trusted = False,
) -> int:
    """Write a vessel as a functional mock-up unit (FMU), for other simulators."""
    from boatsim.cli.exporting import export_vessel

    named = [vessel, *([sensors] if sensors else [])]
    with trusted_content(content, trust, named):
        return export_vessel(vessel, out, fmi, step, split_loads(load), sensors)
