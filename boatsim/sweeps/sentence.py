"""The first words and the first picture of a sweep's page: what was varied, and what came out."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from boatsim.physics.signals import Array
from boatsim.sweeps.axes import Axis
from boatsim.sweeps.plots import (
    controller_legend,
    group_by_controller,
    metric_plots,
    rank_correlations,
)
from boatsim.sweeps.results import Results
from boatsim.sweeps.summary import CONTROLLER, Pair, compare_controllers
from boatsim.sweeps.text_tables import format_number, format_values
from boatsim.view.formatting import join_words, name_in_words

MOST_VALUES = 4  # of a list that the sentence names
NOTABLE = 0.2  # range of a metric by its largest size; a smaller change is of little interest
STRONG = 0.3  # size of a rank correlation from which the sentence names the sampled quantity


class Picture(NamedTuple):
    """The first figure of a sweep's page.

    Attributes:
        legend: Its legend as mark-up; "" if it needs none.
        figure: The figure as mark-up.
    """

    legend: str
    figure: str


def key_in_words(key: str) -> str:
    """Return a varied scenario key in words: "the controller" for `controller.use`.

    Args:
        key: Name of the key; an operation at its end is a factor (*) or an added value (+).
    """
    if key == CONTROLLER:
        return "the controller"
    words = name_in_words(key.rstrip("*+")).replace(".", " ")
    ending = {"*": " factor", "+": " offset"}.get(key[-1:], "")
    return f"{words}{ending}"


def varied_keys_sentence(results: Results) -> str:
    """Return a sentence on the runs of a sweep and on what was varied.

    Args:
        results: Results of a sweep.
    """
    plan, done = results.plan, len(results.run_numbers)
    names = [results.labels[name] for name in plan.scenarios]
    where = names[0]
    if len(names) > 1:
        where = f"{len(names)} scenarios"
    changed = []
    for axis in plan.axes:
        if len(axis.values) > 1:
            changed.append(f"{key_in_words(axis.target.name)} {_values(axis, results.labels)}")
    parts = []
    if changed:
        parts.append(f"with {join_words(changed)}")
    if plan.sampled:
        keys = join_words(key_in_words(one.target.name) for one in plan.sampled)
        parts.append(f"with {len(plan.samples)} random samples of {keys}")
    ending = "s" if done != 1 else ""
    counted = f"{done} run{ending} of {where}"
    if done < plan.run_count:
        counted = f"{done} of {plan.run_count} planned runs of {where}"
    sentence = " ".join([counted, " and ".join(parts)]).strip()
    if failed := int(results.failed_mask.sum()):
        sentence += f"; {failed} of them failed"
    return f"{sentence}."


def _values(axis: Axis, labels: Mapping[str, str]) -> str:
    """Return the values of an axis in words."""
    texts = format_values(axis.values, labels)
    if axis.is_numeric:
        return f"from {texts[0]} to {texts[-1]}"
    if len(texts) > MOST_VALUES:
        return f"in {len(texts)} variants"
    return join_words(texts, "or")


def result_sentence(results: Results) -> str:
    """Return a sentence on the result of a sweep, for one metric.

    It compares the controllers, or states how the metric depends on the first varied number, or how
    it spreads over the samples.

    Args:
        results: Results of a sweep.
    """
    pairs = compare_controllers(results)
    if pairs:
        return _controllers_compared(pairs, results.labels)
    metric = headline_metric(results)
    if metric is None:
        return "No run reached a metric." if not results.units else "All metrics are constant."
    for axis in results.plan.axes:
        if axis.is_numeric and len(axis.values) > 1:
            return _over_axis(results, metric, axis)
    for axis in results.plan.axes:
        if len(axis.values) > 1:
            return _over_list(results, metric, axis)
    return _over_samples(results, metric)


def headline_metric(results: Results) -> str | None:
    """Return the metric of a sweep that the report's first sentence and figure show.

    With controllers it is that of the clearest difference. Otherwise it is the one with the
    strongest rank correlation with a varied or sampled number, where a metric that changes by less
    than `NOTABLE` counts less, or the first one that is not constant.

    Args:
        results: Results of a sweep.
    """
    pairs = compare_controllers(results)
    if pairs:
        return _clearest(pairs).norm.strip("|")
    best, strongest = None, -1.0
    for name in results.displayed_metrics:
        values = results.metrics[name]
        finite = np.isfinite(values)
        if finite.sum() > 1 and np.ptp(values[finite]) > 0.0:
            change = float(np.ptp(values[finite]) / np.abs(values[finite]).max())
            strength = _strongest_correlation(results, values, finite) * min(1.0, change / NOTABLE)
            if strength > strongest + 1e-9:
                best, strongest = name, strength
    return best


def _strongest_correlation(results: Results, values: Array, finite: Array) -> float:
    """Return the largest size of a metric's rank correlations with varied and sampled numbers."""
    from scipy.stats import spearmanr

    sizes = [abs(one) for _, _, one in rank_correlations(results, values, finite)]
    for axis in results.plan.axes:
        if axis.is_numeric and len(axis.values) > 1 and finite.sum() > 2:
            x = np.array(results.column_values(axis.target.name), dtype=float)[finite]
            if np.ptp(x) > 0.0:
                sizes.append(abs(float(spearmanr(x, values[finite]).statistic)))
    return max(sizes, default=0.0)


def headline_figure(results: Results) -> Picture | None:
    """Return the figure of the headline metric against the first quantity that varied.

    Args:
        results: Results of a sweep.

    Returns:
        The figure; None where nothing can be drawn.
    """
    metric = headline_metric(results)
    if metric is None:
        return None
    scenario = results.plan.scenarios[0]
    names = np.array([results.plan.points[number].scenario for number in results.point_numbers])
    rows = names == scenario
    plots = metric_plots(results, metric, rows)
    if not plots:
        return None
    return Picture(controller_legend(group_by_controller(results, rows)), plots[0])


def _clearest(pairs: Sequence[Pair]) -> Pair:
    """Return the comparison whose difference is the largest by its 95 % interval.

    Without intervals, as for single runs, it is the first one.
    """
    best, most = pairs[0], -1.0
    for pair in pairs:
        if pair.sure > 0.0 and abs(pair.difference) / pair.sure > most:
            best, most = pair, abs(pair.difference) / pair.sure
    return best


def _controllers_compared(pairs: Sequence[Pair], labels: Mapping[str, str]) -> str:
    pair = _clearest(pairs)
    first, second = labels.get(pair.first, pair.first), labels.get(pair.second, pair.second)
    metric = name_in_words(pair.norm)
    unit = f" {pair.unit}".rstrip()
    means = f"{_number(pair.of_second)} and {_number(pair.of_first)}{unit}"
    if not pair.sure > 0.0:
        return f"The mean {metric} is {means} with {second} and {first}."
    size = f"{_number(abs(pair.difference))} ± {pair.sure:.2g}{unit}"
    if abs(pair.difference) <= pair.sure:
        return f"The mean {metric} of {second} and {first} does not differ clearly: {size}."
    lower, share = second, pair.second_lower
    other = first
    if pair.difference > 0.0:
        lower, other, share = first, second, pair.first_lower
    return (
        f"The mean {metric} is lower with {lower} than with {other}, by {size}, "
        f"and lower in {100 * share:.0f} % of {pair.pairs} pairs."
    )


def _over_axis(results: Results, metric: str, axis: Axis) -> str:
    """Return how the median of a metric changes over a varied number."""
    x = np.array(results.column_values(axis.target.name), dtype=float)
    medians = []
    places = sorted(map(float, axis.values))
    for place in places:
        medians.append(_median(results.metrics[metric][x == place]))
    found = np.array(medians)
    if not np.isfinite(found).any():
        return f"{name_in_words(metric)} has no value."
    key, unit = key_in_words(axis.target.name), f" {results.units[metric]}".rstrip()
    low, high = int(np.nanargmin(found)), int(np.nanargmax(found))
    median = "The median of " if len(results.plan.samples) > 1 else ""
    subject = f"{median}{name_in_words(metric)}"
    return (
        f"{subject[0].upper()}{subject[1:]} is lowest at {key} = {places[low]:.4g} "
        f"({_number(found[low])}{unit}) and highest at {places[high]:.4g} "
        f"({_number(found[high])}{unit})."
    )


def _over_list(results: Results, metric: str, axis: Axis) -> str:
    """Return the median of a metric for the best and the worst entry of a list."""
    used = np.array(list(map(str, results.column_values(axis.target.name))))
    found = {}
    for text in map(str, axis.values):
        found[text] = _median(results.metrics[metric][used == text])
    finite = {text: value for text, value in found.items() if np.isfinite(value)}
    if not finite:
        return f"{name_in_words(metric)} has no value."
    low, high = min(finite, key=finite.__getitem__), max(finite, key=finite.__getitem__)
    unit = f" {results.units[metric]}".rstrip()
    return (
        f"The median of {name_in_words(metric)} is lowest with {results.labels.get(low, low)} "
        f"({_number(finite[low])}{unit}) and highest with {results.labels.get(high, high)} "
        f"({_number(finite[high])}{unit})."
    )


def _over_samples(results: Results, metric: str) -> str:
    """Return the spread of a metric over the samples, and what it depends on most."""
    values = results.metrics[metric]
    finite = np.isfinite(values)
    low, middle, high = np.quantile(values[finite], (0.05, 0.5, 0.95)).tolist()
    unit = f" {results.units[metric]}".rstrip()
    sentence = (
        f"{name_in_words(metric)} has a median of {_number(middle)}{unit}; 90 % of the runs "
        f"lie between {_number(low)} and {_number(high)}{unit}"
    )
    for key, _, correlation in rank_correlations(results, values, finite)[:1]:
        if abs(correlation) >= STRONG:
            verb = "rises" if correlation > 0.0 else "falls"
            sentence += f"; it {verb} with {key_in_words(key)} (rank correlation {correlation:.2f})"
    return f"{sentence[0].upper()}{sentence[1:]}."


def _number(value: float) -> str:
    return format_number(value).replace("-", "−")


def _median(values: Array) -> float:
    values = values[np.isfinite(values)]
    if not len(values):
        return float("nan")
    return float(np.median(values))
