"""The result of a run in one sentence, as its page and the index of a folder print it."""

from collections.abc import Mapping

from boatsim.simulate.evaluation import MISSED, MetricEntry, RunEntry
from boatsim.view.formatting import join_words, name_in_words

MOST_NAMED = 3  # metrics outside their bands that the sentence names


def run_verdict(result: RunEntry) -> str:
    """Return the result of a run in two or three words.

    Args:
        result: Content of norms.json.
    """
    if not result["complete"]:
        return "Interrupted"
    met = [entry["ok"] for entry in result["norms"].values() if entry["ok"] is not None]
    if not met:
        return "Finished"
    if all(met):
        return "All bands met"
    return "Outside a band"


def run_sentence(result: RunEntry) -> str:
    """Return the result of a run in one sentence: how many metrics lie within their bands.

    Args:
        result: Content of norms.json.
    """
    metrics = result["norms"]
    banded = {name: entry for name, entry in metrics.items() if entry["ok"] is not None}
    missed = [name for name, entry in banded.items() if not entry["ok"]]
    if not banded:
        sentence = _listed(metrics)
    elif not missed:
        sentence = f"All {len(banded)} metrics lie within their regression bands"
        if len(banded) == 1:
            sentence = "The only metric with a regression band lies within it"
    else:
        kept = len(banded) - len(missed)
        named = [_outside(name, metrics[name]) for name in missed[:MOST_NAMED]]
        if len(missed) > MOST_NAMED:
            named.append(f"{len(missed) - MOST_NAMED} more")
        sentence = f"{kept} of {len(banded)} metrics lie within their regression bands"
        sentence += f"; outside: {join_words(named)}"
    differs = _differing(metrics)
    if differs:
        sentence += f"; {differs}"
    if not result["complete"]:
        sentence = sentence.removeprefix("Finished; ")
        sentence = f"Interrupted before its end; {sentence[0].lower()}{sentence[1:]}"
    return f"{sentence}."


def _listed(metrics: Mapping[str, MetricEntry]) -> str:
    """Return the first metrics of a scenario without regression bands."""
    if not metrics:
        return "Finished; this scenario has no metrics"
    named = []
    for name in list(metrics)[:MOST_NAMED]:
        named.append(f"{name_in_words(name)} {_value(metrics[name])}")
    if len(metrics) > MOST_NAMED:
        named.append(f"{len(metrics) - MOST_NAMED} more")
    return f"No metric has a regression band: {join_words(named)}"


def _outside(name: str, entry: MetricEntry) -> str:
    """Return a metric outside its band with its value."""
    return f"{name_in_words(name)} ({_value(entry)})"


def _value(entry: MetricEntry) -> str:
    if entry["value"] is None:
        return "without a value"
    unit = entry["unit"].replace("deg", "°")
    space = "" if unit.startswith("°") else " "
    number = f"{entry['value']:.3g}".replace("-", "−")
    return f"{number}{space}{unit}".rstrip()


def _differing(metrics: Mapping[str, MetricEntry]) -> str:
    """Return how many metrics differ from their published values by more than the tolerance."""
    number = sum(entry["verdict"] == MISSED for entry in metrics.values())
    if not number:
        return ""
    verb = "differs" if number == 1 else "differ"
    return f"{number} {verb} from the published value by more than its tolerance"


def explain_name_endings(metrics: Mapping[str, MetricEntry]) -> list[str]:
    """Return a line that explains endings of metric names, such as "_inf", that need explanation.

    Args:
        metrics: Entries of norms.json by name.

    Returns:
        One line, or none.
    """
    kinds: dict[str, str] = {}
    for name, metric in metrics.items():
        ending = name.rpartition("_")[2]
        if metric["kind"] not in ("", ending):
            kinds.setdefault(metric["kind"], ending)
    if not kinds:
        return []
    return ["; ".join(f"{ending}: {kind}" for kind, ending in kinds.items())]
