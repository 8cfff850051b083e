"""What the benchmarks on real recordings share: where recordings lie, where reports go, how a table is printed."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.cli import diagnosis as commands
from boatsim.diagnosis.pipeline import Diagnosis

RECORDINGS = Path(__file__).parents[3] / "shared" / "recordings"
OUT = Path("out/real")


def runs_of(name: str) -> dict[str, Path]:
    """Recordings of a set by run; ends the program with one line where the set is not there."""
    found = {p.stem: p for p in sorted((RECORDINGS / name / "runs").glob("*.csv"))}
    if not found:
        print(f"{name}: skipped, there are no recordings in ../shared/recordings/{name}/runs")
        raise SystemExit
    return found


def report(found: Diagnosis, name: str) -> None:
    """Write report.html and the other files of a diagnosis to out/real/<name>/ and print its sentence."""
    commands.write(found, OUT / name)
    print(found.findings.answer["sentence"])
    print(f"report: {OUT / name / 'report.html'}")


def table(title: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table, first column to the left, the others to the right."""
    widths = [max(len(r[i]) for r in (header, *rows)) for i in range(len(header))]
    print(f"\n{title}")
    for row in (header, *rows):
        cells = [
            c.ljust(w) if i == 0 else c.rjust(w)
            for i, (c, w) in enumerate(zip(row, widths, strict=True))
        ]
        print("  " + "  ".join(cells).rstrip())


def print_verdict(found: Diagnosis) -> None:
    """Physics and measurement apart, in order of gain, with parameters."""
    for kind, words in (
        ("physics", "left out of the boat"),
        ("measurement", "wrong with the instruments"),
    ):
        print(f"\n{words}:")
        effects = [e for e in found.findings.answer["effects"] if e["kind"] == kind]
        for e in sorted(effects, key=lambda e: -e["gain_nats"]):
            values = ", ".join(
                f"{k} {p['value']:.3g} +- {p['sd']:.2g}" for k, p in e["parameters"].items()
            )
            tied = f"; hardly to be told from {', '.join(e['tied_with'])}" if e["tied_with"] else ""
            print(f"  {e['name']} ({e['gain_nats']:.0f} nats): {values}{tied}")
        if not effects:
            print("  nothing found")
