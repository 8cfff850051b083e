"""Implementation of `boatsim demo`: simulates a boat with a hidden fault and diagnoses it."""

import sys
import webbrowser
from collections.abc import Sequence
from pathlib import Path

from pydantic import Field

from boatsim.cli.exits import Exit, print_lines, print_note
from boatsim.cli.programs import typed_program
from boatsim.cli.progress import report_stages
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.diagnosis.output.what_if import collect_what_if
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.pipeline import diagnose as analyse
from boatsim.diagnosis.report.brief import summary_lines
from boatsim.diagnosis.report.experiment_section import is_optional
from boatsim.files import Table, read_toml, validate_table
from boatsim.physics.base import Effect
from boatsim.physics.content import content_root
from boatsim.physics.vessel import Vessel
from boatsim.simulate import scenario as scenarios
from boatsim.simulate.run_files import CAMERA, run_into_folder
from boatsim.simulate.run_options import RunOptions
from boatsim.simulate.scenario import Scenario
from boatsim.view.formatting import join_words, sentence_in_per_cent
from boatsim.view.viewer import has_display
from boatsim.webassembly.compiler import find_compiler

FILE = "demo.toml"  # in the folder of the shipped scenarios
MANOEUVRE = "turning_circle"  # simulated with the corrected model in the command that is printed
RECORDINGS = "recordings"  # folder of the simulated recordings, in the output folder


class DemoFile(Table):
    """Content of demo.toml: which scenarios the demonstration simulates and diagnoses."""

    about: str
    fit: dict[str, str] = Field(min_length=1)  # scenario -> what the boat does in it
    hold_out: dict[str, str] = Field(min_length=1)
    seed: int = Field(default=0, ge=0)
    horizon: float | None = Field(default=None, gt=0)  # [s]


def run_demo(out: Path, browser: bool, what_if: bool = False) -> int:
    """Simulate recordings of a boat with a hidden fault, diagnose them and print the result.

    Args:
        out: Output folder of the report, with the recordings in a folder of their own.
        browser: Whether to open the report in a browser.
        what_if: Whether report.html repeats free runs while sliders move.

    Returns:
        Exit code.

    Raises:
        BadInput: demo.toml or a scenario cannot be used, or there is no compiler for sliders.
        OSError: A file cannot be written.
    """
    compiler = find_compiler() if what_if else None
    path = content_root() / "scenarios" / FILE
    demo = validate_table(DemoFile, read_toml(path), FILE)
    recorded = {**demo.fit, **demo.hold_out}
    _print_now(
        [
            f"The boat: {demo.about}.",
            f"1. Simulating {len(recorded)} recordings (the first time, the boat's program is "
            "compiled first):",
        ]
    )
    loaded = [scenarios.load(name) for name in recorded]
    recordings = list[Path]()
    for scenario, words in zip(loaded, recorded.values(), strict=True):
        recordings.append(_simulate(scenario, words, out, demo.seed))
    fitted = recordings[: len(demo.fit)]
    _print_now(
        [
            f"2. Comparing them with the boat's model: the first {len(fitted)} are fitted, the "
            f"other {len(demo.hold_out)} are held out to test the answer."
        ]
    )
    with report_stages() as report:
        found = analyse(fitted, recordings[len(fitted) :], horizon=demo.horizon, report=report)
    _print_now(["3. Writing the report."])
    section = collect_what_if(found, compiler) if compiler else None
    write_diagnosis(found, out, section)
    _print_now(["", *summary_lines(found.findings), *_truth_lines(loaded, found), ""])
    _print_now(_next_lines(out, found.findings))
    if browser:
        _open(out / "report.html")
    return Exit.MET


def _print_now(lines: Sequence[str]) -> None:
    """Print lines at once, also into a pipe: the stages between them take seconds."""
    print_lines(lines)
    sys.stdout.flush()


def _simulate(scenario: Scenario, words: str, out: Path, seed: int) -> Path:
    """Run a scenario and return the recording that an owner's camera would make."""
    folder = out / RECORDINGS / scenario.name.rpartition("/")[2]
    done = run_into_folder(folder, scenario, RunOptions(seed=seed))
    _print_now([f"   {words}: {done.run.recording.t[-1]:.1f} s long ({scenario.name})"])
    return folder / f"{CAMERA}.csv"


def _truth_lines(loaded: Sequence[Scenario], found: Diagnosis) -> list[str]:
    """Return the effects of the scenarios that the vessel file lacks, with the values found."""
    lines: list[str] = []
    for scenario in loaded:
        for effect in _hidden_effects(scenario, found.vessel):
            line = f"The truth, hidden in the scenarios: {_in_words(effect)}."
            if line not in lines:
                lines.append(line)
    return lines


def _hidden_effects(scenario: Scenario, vessel: Vessel) -> list[Effect]:
    """Return the effects of a scenario that the vessel alone does not have."""
    return [e for e in scenario.vessel.effects if vessel.effect(e.name) is None]


def _in_words(effect: Effect) -> str:
    """Return what an effect does, with those of its values that a diagnosis may fit."""
    ratios, values = list[str](), list[str]()
    for name, param in type(effect).params().items():
        value = getattr(effect, name)
        if param.in_per_cent:
            inactive = param.inactive_value
            ratios.append(sentence_in_per_cent(param.in_per_cent, value, 0.0, inactive))
        elif param.fit:
            values.append(f"{name} = {value:.4g} {param.unit}".rstrip())
    return join_words(ratios or [f"{type(effect).words} ({', '.join(values)})"])


def _next_lines(out: Path, findings: Findings) -> list[str]:
    """Return the files of the result, and the commands that follow."""
    boatsim, model = typed_program("boatsim"), out / "patched.toml"
    lines = [
        f"Report: {out / 'report.html'}",
        f"Corrected model: {model}",
        f"Simulate with it: {boatsim} manoeuvre {MANOEUVRE} --vessel {model}",
    ]
    if wanted := findings.answer["next_experiment"]:
        check = "Optional check" if is_optional(findings) else "To decide what is open"
        lines.append(f"{check}: record the manoeuvre of {out / wanted['scenario']}")
    return [
        *lines,
        f"In 3D (with the viewer rerun): {typed_program('rerun')} {out / 'diagnosis.rrd'}",
        f"Your own boat: {boatsim} new --help; then your own log: {boatsim} import LOG",
    ]


def _open(page: Path) -> None:
    """Open a page in a browser, if there is a display."""
    if has_display():
        webbrowser.open(page.resolve().as_uri())
    else:
        print_note(f"there is no display to open {page} on")
