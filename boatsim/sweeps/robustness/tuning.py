"""Tuning of a controller on drawn boats: the gains with the smallest errors under disturbances.

The cost of a design is the mean, over the conditions, of the error that 95 % of the boats do not
exceed, in units of the largest error of a boat that survives. The conditions are one value of each
disturbance, and none. The first third of the designs is spread over the allowed ranges (a Sobol
sequence), the others follow from the best one by the method of Nelder and Mead (Computer Journal
7, 1965) in the logarithms of the gains. A design that does not meet the L1-norm condition at one of
the input gains of its controller, or is unstable there with ideal actuators, costs as much as one
under which all boats diverge. The result is judged on boats that the search has not seen.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, isnan, log

import numpy as np
from scipy.optimize import minimize
from scipy.stats import qmc

from boatsim.control.adaptive import l1_condition_value
from boatsim.control.base import Controller
from boatsim.control.margins import stability_margins
from boatsim.errors import BadInput, unknown_name_message
from boatsim.learn.distributions import SampledParameter
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, ignore_progress
from boatsim.simulate.vessel_model import introduce_vessel
from boatsim.sweeps.robustness.benchmark import (
    add_effects,
    check_boats,
    chosen_disturbances,
    with_effects_of,
)
from boatsim.sweeps.robustness.closed_loops import (
    ClosedLoop,
    check_controller,
    make_closed_loop,
    tracking_errors,
)
from boatsim.sweeps.robustness.disturbances import Disturbance
from boatsim.sweeps.robustness.drawn_boats import DrawnBoats, draw_boats
from boatsim.sweeps.robustness.manoeuvre import TrackedSignal, standard_manoeuvre
from boatsim.sweeps.robustness.survival import REQUIRED, judged_bars, surviving_boats

BOATS = 50  # the 95 % quantile is then that of the third worst boat
BUDGET = 60  # designs: about ten for each of three gains in both parts of the search
SPREAD_SHARE = 1 / 3  # of the designs that are spread over the ranges
RANGE = 4.0  # a gain is sought between a quarter and four times its value, within its bounds
RUNG = 2  # of a ladder, from 0: a disturbance that every usual design survives, and that costs
WORST = 10.0  # bars: a larger error, or a diverged motion, is no worse
OTHER_BOATS = 1_000_000  # added to the seed: boats that the search has not seen


@dataclass(frozen=True)
class Gain:
    """A gain that is tuned: its name and range."""

    name: str
    low: float
    high: float


@dataclass(frozen=True)
class Condition:
    """One value of a disturbance; None for calm water and whole actuators."""

    disturbance: Disturbance | None
    value: float

    @property
    def words(self) -> str:
        """The condition in words."""
        if self.disturbance is None:
            return "none"
        return f"{self.disturbance.name} {self.value:g} {self.disturbance.unit}".rstrip()


@dataclass(frozen=True)
class ConditionResult:
    """Errors of a design under one condition.

    Attributes:
        condition: The condition.
        errors: 95 % quantile of the rms error of each signal (signals,).
        bars: 95 % quantile over the boats of the largest error in units of its bar.
        survivors: Share of the boats whose errors are within the bars.
    """

    condition: Condition
    errors: Array
    bars: float
    survivors: float


@dataclass(frozen=True)
class Design:
    """Values of the tuned gains, with the results on some boats.

    Attributes:
        gains: Values by name.
        results: Result under each condition; none if the design does not meet the L1-norm
            condition.
    """

    gains: Mapping[str, float]
    results: tuple[ConditionResult, ...]

    @property
    def cost(self) -> float:
        """Mean over the conditions of the 95 % quantile of the error, in bars."""
        if not self.results:  # the design does not meet the L1-norm condition
            return WORST
        return float(np.mean([result.bars for result in self.results]))


@dataclass(frozen=True)
class Tuning:
    """Result of a search for gains.

    Attributes:
        vessel: The vessel.
        boats: Number of boats, of the search and of the judgement each.
        seed: Random seed.
        designs: Number of designs that were compared.
        signals: Signals with a set point.
        ranges: Ranges of the gains.
        start: The design before, on boats that the search has not seen.
        best: The tuned design on the same boats; it is the former one if none is better there.
        controller: The tuned controller.
    """

    vessel: Vessel
    boats: int
    seed: int
    designs: int
    signals: tuple[TrackedSignal, ...]
    ranges: tuple[Gain, ...]
    start: Design
    best: Design
    controller: Controller

    @property
    def is_better(self) -> bool:
        """Whether the tuned design is another one than the former."""
        return self.best is not self.start


def tune(
    name: str,
    controller: Controller,
    vessel: Vessel,
    gains: Sequence[tuple[str, float | None, float | None]] = (),
    conditions: Mapping[str, Sequence[float]] | None = None,
    count: int = BOATS,
    seed: int = 0,
    sampled: Sequence[SampledParameter] = (),
    spread: float = 1.0,
    budget: int = BUDGET,
    report: Report = ignore_progress,
) -> Tuning:
    """Search for the gains of a controller with the smallest errors on drawn boats.

    Args:
        name: Name of the controller.
        controller: The controller, whose gains are the start of the search.
        vessel: The vessel. One that a diagnosis has fitted is drawn from the uncertainty of the
            fit.
        gains: Name, lowest and highest value of each tuned gain; None for the usual range; empty
            for the gains that the controller names (`tuned`).
        conditions: Disturbances with their values; default: all that apply, one value each.
        count: Number of drawn boats.
        seed: Random seed of draws and sensor noise.
        sampled: Parameters with distributions of the user.
        spread: Factor of the standard deviations of the usual draws.
        budget: Number of designs to compare.
        report: Function to call with the progress.

    Raises:
        BadInput: The controller, a gain or a disturbance cannot be used.
    """
    check_boats(count, spread)
    if budget < 1:
        raise BadInput(f"budget = {budget}; allowed is 1 or more")
    check_controller(name, controller, vessel)
    ranges = gain_ranges(name, controller, gains)
    vessel = with_effects_of(sampled, vessel)
    search = _Search(name, controller, vessel, conditions)
    drawn = search.draw(count, seed, sampled, spread)
    search.judge_signals(drawn)
    former = {gain.name: float(getattr(controller, gain.name)) for gain in ranges}
    designs = [search.judged(former, drawn)]

    def cost(gains_by_name: Mapping[str, float]) -> float:
        for known in designs:
            if known.gains == gains_by_name:
                return known.cost
        if len(designs) >= budget:  # the first simplex may ask for more
            return WORST
        report("closed loops", len(designs) / (budget + 2), f"cost {_best(designs).cost:.3g}")
        designs.append(search.judged(gains_by_name, drawn))
        return designs[-1].cost

    for values in _spread_designs(ranges, int(SPREAD_SHARE * budget), seed):
        cost(values)
    _descend(ranges, _best(designs).gains, budget - len(designs), cost)
    report("closed loops", budget / (budget + 2), "boats that the search has not seen")
    others = search.draw(count, seed + OTHER_BOATS, sampled, spread)
    start, best = search.judged(former, others), search.judged(_best(designs).gains, others)
    if best.cost >= start.cost:
        best = start
    made = search.with_gains(best.gains)
    return Tuning(vessel, count, seed, len(designs), search.signals, ranges, start, best, made)


class _Search:
    """The closed loops and conditions under which designs are judged."""

    def __init__(
        self,
        name: str,
        controller: Controller,
        vessel: Vessel,
        conditions: Mapping[str, Sequence[float]] | None,
    ) -> None:
        chosen = chosen_disturbances(conditions, vessel)
        self.plain = vessel
        self.vessel, unavailable = add_effects(vessel, list(chosen))
        if conditions and unavailable:
            first, reason = next(iter(unavailable.items()))
            raise BadInput(f"disturbance {first} does not apply to {vessel.name}: {reason}")
        check_controller(name, controller, self.vessel)
        self.name, self.controller = name, controller
        self.manoeuvre = standard_manoeuvre(self.vessel, {name: controller})
        self.signals = self.manoeuvre.signals
        self.conditions = [Condition(None, 0.0)]
        for disturbance, values in chosen.items():
            if disturbance.name not in unavailable:
                own = conditions[disturbance.name] if conditions else ()
                used = values if own else values[RUNG : RUNG + 1]
                self.conditions += [Condition(disturbance, value) for value in used]
        self.bars = np.array([signal.bar for signal in self.signals])

    def draw(
        self, count: int, seed: int, sampled: Sequence[SampledParameter], spread: float
    ) -> DrawnBoats:
        """Boats of the vessel, with the effects of all disturbances."""
        return replace(draw_boats(self.plain, count, seed, sampled, spread), vessel=self.vessel)

    def judge_signals(self, boats: DrawnBoats) -> None:
        """Judge only those signals that the controller tracks without disturbance."""
        nominal = tracking_errors(self._loop(self.controller), boats, None, 0.0)
        self.bars = judged_bars([nominal], self.bars)

    def with_gains(self, gains: Mapping[str, float]) -> Controller:
        """The controller with some gains."""
        controller = replace(self.controller, **gains)
        introduce_vessel(controller, self.vessel)
        return controller

    def judged(self, gains: Mapping[str, float], boats: DrawnBoats) -> Design:
        """A design with its results on boats."""
        controller = self.with_gains(gains)
        if not meets_norm_condition(controller):
            return Design(dict(gains), ())
        results = []
        for one in self.conditions:
            errors = tracking_errors(self._loop(controller), boats, one.disturbance, one.value)
            judged = np.isfinite(self.bars)
            largest = np.max(errors[:, judged] / self.bars[judged], axis=1)
            bars = _quantile(np.minimum(np.nan_to_num(largest, nan=WORST), WORST))
            survivors = float(surviving_boats(errors, self.bars).mean())
            high = np.array([_quantile(column) for column in errors.T])
            results.append(ConditionResult(one, high, bars, survivors))
        return Design(dict(gains), tuple(results))

    def _loop(self, controller: Controller) -> ClosedLoop:
        return make_closed_loop(self.name, controller, self.vessel, self.manoeuvre)


def meets_norm_condition(controller: Controller) -> bool:
    """Return whether the loops of a controller are stable and meet the L1-norm condition.

    Only controllers that describe their `feedback_loops` are judged, each loop at every input gain
    that it names, with ideal actuators.

    Args:
        controller: The controller.
    """
    if not hasattr(controller, "feedback_loops"):
        return True
    for row in stability_margins(controller):
        if not row.stable:
            return False
        if row.norm is not None and row.needed is not None:
            if l1_condition_value(row.norm, row.needed) >= 1.0:
                return False
    return True


def gain_ranges(
    name: str, controller: Controller, gains: Sequence[tuple[str, float | None, float | None]]
) -> tuple[Gain, ...]:
    """Return the gains to tune with their ranges.

    Args:
        name: Name of the controller.
        controller: The controller.
        gains: Name, lowest and highest value of each gain; None for the usual range; empty for the
            gains that the controller names.

    Raises:
        BadInput: A gain does not exist, is not positive, or lies outside its range.
    """
    known = type(controller).params()
    numbers = [key for key in known if key != "period" and _is_positive(controller, key)]
    asked = list(gains) or [(key, None, None) for key in type(controller).tuned if key in numbers]
    if not asked:
        raise BadInput(
            f"controller {name} names no gains to tune; allowed is --gain NAME with one of "
            f"{', '.join(numbers)}"
        )
    found = []
    for key, low, high in asked:
        if key not in numbers:
            raise BadInput(unknown_name_message(f"controller {name}: gain", key, numbers))
        value, bounds = float(getattr(controller, key)), known[key]
        least = max(bounds.low, value / RANGE) if low is None else low
        most = min(bounds.high, value * RANGE) if high is None else high
        allowed = 0.0 < least <= value <= most and bounds.low <= least and most <= bounds.high
        if not allowed:
            raise BadInput(
                f"controller {name}: range {least:g}:{most:g} of {key}; allowed is a positive "
                f"range within {bounds.low:g}:{bounds.high:g} that contains {value:g}"
            )
        found.append(Gain(key, least, most))
    return tuple(found)


def _quantile(values: Array) -> float:
    return float(np.quantile(values, REQUIRED, method="inverted_cdf"))


def _best(designs: Sequence[Design]) -> Design:
    return min(designs, key=lambda one: one.cost)


def _is_positive(controller: Controller, key: str) -> bool:
    value = getattr(controller, key)
    is_number = isinstance(value, float | int) and not isinstance(value, bool)
    return is_number and not isnan(value) and value > 0.0


def _spread_designs(ranges: Sequence[Gain], count: int, seed: int) -> list[dict[str, float]]:
    """Designs of a Sobol sequence over the logarithms of the gains."""
    low = np.array([log(gain.low) for gain in ranges])
    high = np.array([log(gain.high) for gain in ranges])
    shares = qmc.Sobol(len(ranges), seed=seed).random_base2(count.bit_length())[:count]
    return [_gains(ranges, low + row * (high - low)) for row in shares]


def _gains(ranges: Sequence[Gain], logarithms: Array) -> dict[str, float]:
    """Gains with four digits, within their ranges."""
    found = {}
    for gain, x in zip(ranges, logarithms, strict=True):
        found[gain.name] = min(max(float(f"{exp(x):.4g}"), gain.low), gain.high)
    return found


def _descend(
    ranges: Sequence[Gain],
    start: Mapping[str, float],
    count: int,
    cost: Callable[[Mapping[str, float]], float],
) -> None:
    """Search from a design by the method of Nelder and Mead, at most so many designs."""
    if count < 1:
        return
    x = np.array([log(start[gain.name]) for gain in ranges])
    bounds = [(log(gain.low), log(gain.high)) for gain in ranges]
    minimize(
        lambda at: cost(_gains(ranges, at)),
        x,
        method="Nelder-Mead",
        bounds=bounds,
        # the first one is known
        options={"maxfev": count + 1, "xatol": 1e-3, "fatol": 1e-4},
    )
