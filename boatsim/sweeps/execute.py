"""Carries out a plan: runs that are not done yet, the table of all, the report."""

import os
from collections.abc import Sequence
from pathlib import Path

from boatsim.errors import BadInput, unknown_name
from boatsim.progress import Report, silent
from boatsim.sweeps import page
from boatsim.sweeps.campaign import carry_out
from boatsim.sweeps.plan import Plan
from boatsim.sweeps.results import Results
from boatsim.sweeps.runs import carried_out
from boatsim.sweeps.workers.base import Backend
from boatsim.sweeps.workers.in_process import here
from boatsim.sweeps.workers.processes import Processes
from boatsim.sweeps.workers.ray_cluster import Cluster

RUNS = "runs"


def swept(
    plan: Plan,
    folder: Path,
    jobs: int | None = None,
    ray: str | None = None,
    norms: Sequence[str] = (),
    report: Report = silent,
) -> tuple[Results, bool]:
    """The runs of a plan, and whether all are done; writes sweep.parquet and report.html into the folder.

    `jobs` is how many run at the same time, None: one for each processor; `norms` are those told and drawn. Raises
    BadInput and OSError.
    """
    report(RUNS, 0.0, "beginning")
    there = plan.rehearse()
    if unknown := next((name for name in norms if name not in there), None):
        raise BadInput(unknown_name("norm", unknown, there))
    done = carry_out(
        folder,
        plan.about(),
        plan.count,
        plan.tasks(),
        carried_out,
        backend(jobs, ray),
        RUNS,
        report,
    )
    found = Results(plan, done.entries, tuple(norms))
    found.write(folder)
    page.write(found, folder)
    return found, done.whole


def backend(jobs: int | None, ray: str | None) -> Backend:
    """Who carries out: a cluster where one is named, processes of this machine, or this one alone."""
    if ray:
        return Cluster(ray)
    jobs = len(os.sched_getaffinity(0)) if jobs is None else jobs
    return here if jobs == 1 else Processes(jobs)
