"""Summary of a run for a notebook: what was run, and its metrics with their regression bands."""

from collections.abc import Mapping

from boatsim.recordings.notebook.html_table import html_facts_table, html_table
from boatsim.simulate.evaluation import Metric

IN_BAND = {None: "", True: "yes", False: "no"}


def run_html(scenario: str, seed: int, complete: bool, metrics: Mapping[str, Metric]) -> str:
    """Return the summary of a run as HTML.

    Args:
        scenario: Name of the scenario.
        seed: Seed of the run.
        complete: Whether the run reached its end.
        metrics: Metrics by name.
    """
    facts = [("seed", str(seed))]
    if not complete:
        facts.append(("interrupted", "the run did not reach its end"))
    rows = []
    for name, metric in metrics.items():
        value = metric.lacking or "no value"
        if metric.value is not None:
            value = f"{metric.value:.4g} {metric.unit}".strip()
        rows.append([name, value, IN_BAND[metric.ok]])
    head = ["metric", "value", "within its regression band"]
    return html_facts_table(f"Run of {scenario}", facts) + html_table(head, rows)
