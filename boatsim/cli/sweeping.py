"""Implementation of `boatsim sweep` and `boatsim diagnose --each`: campaigns of many tasks."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice, starmap
from pathlib import Path

from boatsim.cli.exits import Exit, print_error, print_lines
from boatsim.cli.metric_table import print_text_table
from boatsim.cli.progress import show_task_progress
from boatsim.sweeps import diagnoses
from boatsim.sweeps.axes import parse_axis
from boatsim.sweeps.designs import Design
from boatsim.sweeps.execute import choose_backend, run_plan
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.plan import make_plan
from boatsim.sweeps.results import Results
from boatsim.sweeps.sampled_keys import parse_sampled_key
from boatsim.sweeps.text_tables import blank_repeats, result_tables

MOST_ROWS = 60  # of a table on a terminal; report.html has all rows
MOST_REASONS = 5  # of failed runs that are printed, the most frequent first


@dataclass(frozen=True)
class SweepOptions:
    """Command-line options of a sweep: varied and sampled quantities, design and seed.

    Attributes:
        vary: Axes of the grid, `KEY=VALUES`.
        draw: Sampled quantities, `KEY=DISTRIBUTION(...)`.
        runs: Samples at each grid point.
        design: Sampling design.
        seed: Random seed of samples and sensor noise.
    """

    vary: Sequence[str]
    draw: Sequence[str]
    runs: int
    design: Design
    seed: int


def run_sweep(
    scenarios: Sequence[str],
    options: SweepOptions,
    out: Path,
    jobs: int | None,
    ray: str | None,
    metrics: Sequence[str] = (),
) -> int:
    """Start or continue a sweep of runs and print the statistics of its metrics.

    Args:
        scenarios: Scenarios as the user wrote them.
        options: What varies.
        out: Output folder.
        jobs: Parallel processes; None for one per processor.
        ray: Address of a Ray cluster; None for this machine.
        metrics: Metrics to show; empty for all.

    Returns:
        Exit code.

    Raises:
        BadInput: An argument is wrong.
    """
    axes = list(map(parse_axis, options.vary))
    sampled = list(map(parse_sampled_key, options.draw))
    plan = make_plan(scenarios, axes, sampled, options.runs, options.seed, options.design)
    with show_task_progress() as report:
        results, complete = run_plan(plan, out, jobs, ray, metrics, report)
    _print_results(results, out)
    if complete:
        return Exit.MET
    done = len(results.run_numbers)
    print_error(f"interrupted after {done} of {plan.run_count} runs; the same command continues")
    return Exit.INTERRUPTED


def _print_results(results: Results, out: Path) -> None:
    for table in result_tables(results):
        print_text_table(table.title, table.head, blank_repeats(table)[:MOST_ROWS], table.left)
        if len(table.rows) > MOST_ROWS:
            print_lines([f"{len(table.rows) - MOST_ROWS} more rows are in report.html"])
    if failed := int(results.failed_mask.sum()):
        print_lines([f"{failed} of {len(results.run_numbers)} runs failed:"])
        for reason, count in islice(results.failure_counts.items(), MOST_REASONS):
            print_lines([f"  {count} times: {reason}"])
    print_lines([f"written to {out}: sweep.parquet, report.html"])


def diagnose_each(
    inputs: Sequence[Path],
    options: diagnoses.DiagnosisOptions,
    out: Path,
    jobs: int | None,
    ray: str | None,
) -> int:
    """Diagnose each of several recordings separately and print the result of each.

    Finished diagnoses of an interrupted call are kept.

    Args:
        inputs: Recordings, and folders of recordings.
        options: Options of each diagnosis.
        out: Output folder.
        jobs: Parallel processes; None for one per processor.
        ray: Address of a Ray cluster; None for this machine.

    Returns:
        Exit code.

    Raises:
        BadInput: An argument is wrong.
    """
    paths = diagnoses.find_recordings(inputs)
    with show_task_progress() as report:
        done = diagnoses.diagnose_all(paths, options, out, choose_backend(jobs, ray), report)
    rows = []
    for number, entry in done.entries.items():
        causes = entry["failure"]
        if causes is None:
            causes = _format_causes(entry)
        rows.append([str(paths[number]), entry.get("verdict", "failed"), causes])
    print_text_table("Separate diagnoses", ["recording", "verdict", "causes"], rows[:MOST_ROWS], 3)
    if len(rows) > MOST_ROWS:
        print_lines([f"{len(rows) - MOST_ROWS} more rows are in {diagnoses.NAME}"])
    verdicts = Counter(row[1] for row in rows)
    print_lines([", ".join(starmap("{} {}".format, verdicts.items()))])
    print_lines([f"written to {out}: {diagnoses.NAME}, and a folder for each recording"])
    if done.complete:
        return Exit.MET
    print_error(
        f"interrupted after {len(rows)} of {len(paths)} recordings; the same command continues"
    )
    return Exit.INTERRUPTED


def _format_causes(entry: Entry) -> str:
    """Identified effects with the values and standard deviations of their parameters."""
    values = entry["values"]
    parts = []
    for cause in entry["causes"]:
        numbers = []
        for key, (value, *_) in values.items():
            if key.startswith(f"{cause}.") and f"{key} sd" in values:
                name = key.removeprefix(f"{cause}.")
                numbers.append(f"{name} {value:.4g} ± {values[f'{key} sd'][0]:.2g}")
        parts.append(f"{cause}: {', '.join(numbers)}")
    return "; ".join(parts)
