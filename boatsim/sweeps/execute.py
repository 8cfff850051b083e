"""Executes the plan of a sweep: performs unfinished runs and writes the table and the report."""

import os
from collections.abc import Sequence
from pathlib import Path

from boatsim.errors import BadInput, unknown_name_message
from boatsim.progress import Report, ignore_progress
from boatsim.sweeps import page
from boatsim.sweeps.campaign import Campaign, run_campaign
from boatsim.sweeps.entries import RunEntry
from boatsim.sweeps.plan import Plan
from boatsim.sweeps.results import Results
from boatsim.sweeps.runs import perform_run
from boatsim.sweeps.workers.base import Backend
from boatsim.sweeps.workers.in_process import run_in_this_process
from boatsim.sweeps.workers.processes import Processes
from boatsim.sweeps.workers.ray_cluster import Cluster

LABEL = "runs"


def run_plan(
    plan: Plan,
    folder: Path,
    jobs: int | None = None,
    ray: str | None = None,
    metrics: Sequence[str] = (),
    report: Report = ignore_progress,
) -> tuple[Results, bool]:
    """Perform the runs of a sweep's plan; write sweep.parquet and report.html.

    Args:
        plan: The plan.
        folder: Output folder.
        jobs: Parallel processes; None for one per processor.
        ray: Address of a Ray cluster; None for this machine.
        metrics: Metrics to show in the report; empty for all.
        report: Function to call with the progress.

    Returns:
        Results of the finished runs, and whether all runs are finished.

    Raises:
        BadInput: A metric is unknown, a run cannot start, or the folder belongs to another sweep.
        OSError: A file cannot be written.
    """
    report(LABEL, 0.0, "starting")
    known = plan.smoke_test_corners()
    for name in metrics:
        if name not in known:
            raise BadInput(unknown_name_message("metric", name, known))
    about, tasks = plan.definition(), plan.tasks()
    campaign = Campaign(folder, about, plan.run_count, tasks, perform_run, LABEL, RunEntry)
    done = run_campaign(campaign, choose_backend(jobs, ray), report)
    results = Results(plan, done.entries, tuple(metrics))
    results.write(folder)
    page.write_report(results, folder)
    return results, done.complete


def choose_backend(jobs: int | None, ray: str | None) -> Backend:
    """Return the backend that performs the tasks of a campaign.

    It is a Ray cluster, several processes, or this process.

    Args:
        jobs: Parallel processes; None for one per processor.
        ray: Address of a Ray cluster; None for this machine.
    """
    if ray:
        return Cluster(ray)
    if jobs is None:
        jobs = len(os.sched_getaffinity(0))
    if jobs == 1:
        return run_in_this_process
    return Processes(jobs)
