"""Robustness benchmark: controllers on drawn boats under growing disturbances."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.control.base import Controller
from boatsim.errors import BadInput, unknown_name_message
from boatsim.learn.distributions import SampledParameter
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, ignore_progress
from boatsim.sweeps.robustness.closed_loops import (
    ClosedLoop,
    check_controller,
    make_closed_loop,
    tracking_errors,
)
from boatsim.sweeps.robustness.disturbances import DISTURBANCES, Disturbance
from boatsim.sweeps.robustness.drawn_boats import DrawnBoats, draw_boats
from boatsim.sweeps.robustness.manoeuvre import TrackedSignal, standard_manoeuvre
from boatsim.sweeps.robustness.survival import (
    REQUIRED,
    Ladder,
    LadderPoint,
    judged_bars,
    surviving_boats,
)

BOATS = 200  # with 95 % survivors the Wilson interval is 91 to 97 %
MOST_SPREAD = 10.0  # a factor e^4 and more on damping says nothing about a boat
MOST_BOATS = 100_000  # a log of all states needs 5 GB


@dataclass(frozen=True)
class Robustness:
    """Result of a robustness benchmark.

    Attributes:
        vessel: The vessel.
        boats: The drawn boats.
        signals: Signals with a set point.
        bars: Largest rms error (signals,) of a boat that survives; infinite if not judged.
        ladders: Result of each controller under each disturbance.
        unavailable: Reason why a disturbance does not apply to the vessel, by its name.
    """

    vessel: Vessel
    boats: DrawnBoats
    signals: tuple[TrackedSignal, ...]
    bars: Array
    ladders: tuple[Ladder, ...]
    unavailable: Mapping[str, str]

    @property
    def controllers(self) -> list[str]:
        """Names of the controllers."""
        return list(dict.fromkeys(ladder.controller for ladder in self.ladders))

    @property
    def disturbances(self) -> list[str]:
        """Names of the disturbances that apply to the vessel."""
        return list(dict.fromkeys(ladder.disturbance for ladder in self.ladders))

    def ladder(self, controller: str, disturbance: str) -> Ladder:
        """Return the result of a controller under a disturbance."""
        for ladder in self.ladders:
            if (ladder.controller, ladder.disturbance) == (controller, disturbance):
                return ladder
        raise KeyError(f"{controller}, {disturbance}")


def run_benchmark(
    controllers: Mapping[str, Controller],
    vessel: Vessel,
    count: int = BOATS,
    seed: int = 0,
    sampled: Sequence[SampledParameter] = (),
    spread: float = 1.0,
    ladders: Mapping[str, Sequence[float]] | None = None,
    report: Report = ignore_progress,
) -> Robustness:
    """Measure which disturbances each controller survives on randomly drawn boats.

    All controllers steer the same boats with the same sensor noise. On the ladder of a disturbance
    no larger values are tried once fewer than half of the required share of the boats survive.

    Args:
        controllers: Controllers by name.
        vessel: The vessel.
        count: Number of drawn boats.
        seed: Random seed of draws and sensor noise.
        sampled: Parameters with distributions of the user.
        spread: Factor of the standard deviations of the usual draws.
        ladders: Names of the disturbances with their values, which may be empty for the usual
            ones; default: all disturbances.
        report: Function to call with the progress.

    Raises:
        BadInput: A controller or disturbance cannot be used.
    """
    check_boats(count, spread)
    vessel = with_effects_of(sampled, vessel)
    chosen = chosen_disturbances(ladders, vessel)
    prepared, unavailable = add_effects(vessel, list(chosen))
    boats = replace(draw_boats(vessel, count, seed, sampled, spread), vessel=prepared)
    for name, controller in controllers.items():
        check_controller(name, controller, prepared)
    manoeuvre = standard_manoeuvre(prepared, controllers)
    loops = []
    for name, controller in controllers.items():
        loops.append(make_closed_loop(name, controller, prepared, manoeuvre))
    signals = manoeuvre.signals
    for name in unavailable:
        chosen.pop(_disturbance(name))
    if not chosen:
        name, reason = next(iter(unavailable.items()))
        raise BadInput(f"disturbance {name} does not apply to {vessel.name}: {reason}")
    total = len(loops) * (1 + len(chosen))
    nominal: dict[str, Array] = {}
    for number, loop in enumerate(loops):
        report("closed loops", number / total, f"no disturbance, {loop.name}")
        nominal[loop.name] = tracking_errors(loop, boats, None, 0.0)
    bars = judged_bars(list(nominal.values()), np.array([signal.bar for signal in signals]))
    found: list[Ladder] = []
    for disturbance, values in chosen.items():
        for loop in loops:
            share = (len(loops) + len(found)) / total
            report("closed loops", share, f"{disturbance.name}, {loop.name}")
            points = _climb(loop, boats, disturbance, values, nominal[loop.name], bars)
            found.append(Ladder(loop.name, disturbance.name, disturbance.unit, points))
    return Robustness(vessel, boats, signals, bars, tuple(found), unavailable)


def check_boats(count: int, spread: float) -> None:
    """Check the number of drawn boats and the factor of their spread.

    Args:
        count: Number of drawn boats.
        spread: Factor of the standard deviations of the usual draws.

    Raises:
        BadInput: One of them is not allowed.
    """
    if not 0.0 <= spread <= MOST_SPREAD:
        raise BadInput(f"spread = {spread:g}; allowed 0 to {MOST_SPREAD:g}")
    if not 1 <= count <= MOST_BOATS:
        raise BadInput(f"boats = {count}; allowed 1 to {MOST_BOATS}")


def with_effects_of(sampled: Sequence[SampledParameter], vessel: Vessel) -> Vessel:
    """Return a vessel with the effects whose parameters are sampled.

    Args:
        sampled: Parameters with distributions of the user.
        vessel: The vessel, which need not have these effects.

    Raises:
        BadInput: An effect does not exist.
    """
    for one in sampled:
        owner = one.key.partition(".")[0]
        if owner != "body" and vessel.effect(owner) is None:
            vessel = vessel.with_effect({"use": owner})
    return vessel


def _climb(
    loop: ClosedLoop,
    boats: DrawnBoats,
    disturbance: Disturbance,
    values: Sequence[float],
    nominal: Array,
    bars: Array,
) -> tuple[LadderPoint, ...]:
    """Points of a ladder, from the neutral value to one that far too few boats survive."""
    points = [LadderPoint(disturbance.neutral, nominal, surviving_boats(nominal, bars))]
    for value in values:
        if points[-1].share < 0.5 * REQUIRED:
            break
        if value == disturbance.neutral:
            continue
        errors = tracking_errors(loop, boats, disturbance, value)
        points.append(LadderPoint(value, errors, surviving_boats(errors, bars)))
    return tuple(points)


def chosen_disturbances(
    ladders: Mapping[str, Sequence[float]] | None, vessel: Vessel
) -> dict[Disturbance, Sequence[float]]:
    """Return disturbances with their values in ascending order.

    Args:
        ladders: Names of disturbances with their values, which may be empty for the usual ones;
            empty or None for all disturbances.
        vessel: The vessel, whose length scales the usual values.

    Raises:
        BadInput: A name or a value is not allowed.
    """
    if not ladders:
        return {one: one.scaled_ladder(vessel.length) for one in DISTURBANCES}
    found: dict[Disturbance, Sequence[float]] = {}
    for name, values in ladders.items():
        disturbance = _disturbance(name)
        for value in values:
            if not disturbance.neutral <= value <= disturbance.largest:
                allowed = f"{disturbance.neutral:g} to {disturbance.largest:g} {disturbance.unit}"
                raise BadInput(f"{name} = {value:g}; allowed {allowed.rstrip()}")
        found[disturbance] = sorted(values) or disturbance.scaled_ladder(vessel.length)
    return found


def _disturbance(name: str) -> Disturbance:
    """The disturbance of a name. Raises BadInput."""
    for one in DISTURBANCES:
        if one.name == name:
            return one
    names = [one.name for one in DISTURBANCES]
    raise BadInput(unknown_name_message("disturbance", name, names))


def add_effects(
    vessel: Vessel, disturbances: Sequence[Disturbance]
) -> tuple[Vessel, dict[str, str]]:
    """Return the vessel with the effects of all disturbances, and why some do not apply.

    Args:
        vessel: The vessel.
        disturbances: The disturbances.

    Returns:
        The vessel, and the reason by name of a disturbance that does not apply.
    """
    unavailable = {}
    for disturbance in disturbances:
        try:
            vessel = disturbance.add_effects(vessel)
        except BadInput as error:
            unavailable[disturbance.name] = str(error)
    return vessel, unavailable
