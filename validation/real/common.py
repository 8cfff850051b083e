"""Helpers of the benchmarks on real recordings: folders, reports and printed tables."""

from argparse import ArgumentParser
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from boatsim.diagnosis.answer.schema import EffectEntry
from boatsim.diagnosis.model_names import MODELS as MODELS
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.diagnosis.pipeline import Diagnosis

RECORDINGS = Path(__file__).parents[3] / "shared" / "recordings"
OUT = Path("out/real")
T = TypeVar("T")
DEG = 57.29578  # [deg/rad]
MODEL_COLUMNS = ("retuned", "corrected", "corrected / retuned")
KINDS = {
    "physics": "missing from the model of the boat",
    "measurement": "wrong with the instruments",
}


def runs_of(name: str) -> dict[str, Path]:
    """Return the files of a set of recordings by run.

    Raises:
        SystemExit: The set is not on this machine; one line is printed.
    """
    files = sorted((RECORDINGS / name / "runs").glob("*.csv"))
    if not files:
        print(f"{name}: skipped, there are no recordings in ../shared/recordings/{name}/runs")
        raise SystemExit
    return {file.stem: file for file in files}


def out_option(parser: ArgumentParser, name: str) -> None:
    """Add the option --out, folder of the reports, whose default is out/real/<name>."""
    parser.add_argument(
        "--out", type=Path, default=OUT / name, help="folder of the reports (default: %(default)s)"
    )


def runs_except(runs: Mapping[str, T], names: Iterable[str]) -> list[T]:
    """Return the values of all runs except the named ones."""
    return [run for name, run in runs.items() if name not in names]


def write_report(diagnosis: Diagnosis, name: str) -> None:
    """Write the files of a diagnosis to out/real/<name>/ and print its summary."""
    write_diagnosis(diagnosis, OUT / name)
    print(diagnosis.findings.answer["sentence"])
    print(f"report: {OUT / name / 'report.html'}")


def runs_named(runs: Mapping[str, T], names: Iterable[str]) -> list[T]:
    """Return the values of the named runs."""
    return list(map(runs.__getitem__, names))


def names_of(items: Iterable[Any]) -> list[str]:
    """Return the names of effects, recordings or cases."""
    return [item.name for item in items]


def by_name(items: Sequence[T]) -> dict[str, T]:
    """Return effects, recordings or cases by name; the last one of each name."""
    return dict(zip(names_of(items), items, strict=True))


def format_fixed(digits: int, *values: float) -> list[str]:
    """Format values with a fixed number of decimals."""
    return [f"{value:.{digits}f}" for value in values]


def scale_errors(
    errors: Mapping[str, float], factor: float, models: Sequence[str] = MODELS
) -> list[float]:
    """Return the errors of some models times a factor."""
    return [errors[model] * factor for model in models]


def print_table(title: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table, its first column aligned to the left, the others to the right."""
    lines = [header, *rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    print(f"\n{title}")
    for first, *others in lines:
        cells = [first.ljust(widths[0]), *map(str.rjust, others, widths[1:])]
        print("  " + "  ".join(cells).rstrip())


def effects_of(diagnosis: Diagnosis) -> list[EffectEntry]:
    """Return the identified effects of an answer."""
    return diagnosis.findings.answer["effects"]


def values_of(effect: EffectEntry) -> dict[str, float]:
    """Return the values of an identified effect by parameter with unit."""
    return {name: parameter["value"] for name, parameter in effect["parameters"].items()}


def parameter_text(effect: EffectEntry, sign: str = "+-") -> str:
    """Return the parameters of an identified effect with their standard deviations."""
    values = effect["parameters"].items()
    return ", ".join(f"{name} {p['value']:.3g} {sign} {p['sd']:.2g}" for name, p in values)


def print_verdict(diagnosis: Diagnosis) -> None:
    """Print the identified effects with their parameters, by kind and in order of gain."""
    effects = sorted(effects_of(diagnosis), key=lambda effect: -effect["gain_nats"])
    for kind, title in KINDS.items():
        print(f"\n{title}:")
        some = [effect for effect in effects if effect["kind"] == kind]
        if not some:
            print("  nothing found")
        for effect in some:
            line = f"  {effect['name']} ({effect['gain_nats']:.0f} nats): {parameter_text(effect)}"
            if effect["tied_with"]:
                line += f"; hardly distinguished from {', '.join(effect['tied_with'])}"
            print(line)
