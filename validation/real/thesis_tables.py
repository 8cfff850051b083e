"""Effects missing from the thesis' model, by its tables: `python -m validation.real.thesis_tables`.

Source of the data: J. A. Bayless, Adaptive Control of Joystick Steering in Recreational Boats,
Marquette University, 2017. It prints no time series, only error norms of eight tests, so every
candidate is judged by simulating the tests: the scenarios joystick_boat/*_as_published (the thesis'
own program) in the compiled engine, in closed loop and with the camera.

These values of each test, which the scenario files have as `published`, are compared:
- sway 1 to 4 (Table 22): inf-norm, 2-norm and 1-norm of the smoothed yaw rate, heading change at
  0.9 m;
- yaw 1 to 4 (Table 23): inf-norm and rms of the light's distance from its circle (the rms of test 4
  exceeds its inf-norm and is not used), distance moved; time of a turn 44 s ("two turns in almost
  90 s", section V-E);
- text about the sway tests: they took 13 to 18 s (0.9 m at the number of frames that the norms
  need) and the boat stayed in its tank (section V-A), so that it went 0 to 0.15 m ahead (Table 26:
  the surge error is positive).
The 1-norm of the yaw tests is printed, not fitted: the number of frames it needs differs between
tests of one length.

A residual is a log ratio, for the heading the error over 10 deg, for the distance moved over 0.1 m;
outside the bounds of the text a log ratio, and for the surge the error over 0.15 m. Beyond 3 it
grows logarithmically. Its standard deviation is set to 0.3. The norms of one test are computed from
one curve: together they count as two numbers, each bound of the text as one.

The nominal is the physical part of the thesis' simulation: rigid body and added mass, ideal thrust
in both directions, no drag, no Coriolis force, no lags, no wind. Its own coefficients are the
thrust at PWM 150 in the sway and in the yaw program; refitted they give the baseline. Candidates
are added as in `boatsim diagnose`: by Laplace evidence, from 4 nats on. The search replays the
commands of the turns with one seed; the norms printed at the end are closed loop with six seeds.
"""

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from functools import partial
from math import asinh, log, sqrt
from operator import attrgetter
from typing import Any

import numpy as np

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.fit import ParameterSpace, log_prior
from boatsim.physics.base import Array
from validation.real.common import format_fixed, print_table, runs_named
from validation.real.thesis_runs import TESTS, WINDY, AdjustableStrength, ThesisTest
from validation.real.thesis_score import CLIP, residual, rms_distance

MIN_GAIN = 4.0  # [nats] an effect must gain to be identified
# of a residual: camera marks, rounding of the tables, and the differences of runs of one test
SPREAD = 0.3
INDEPENDENT = 2.0  # independent numbers to which the norms of one test are equivalent
# [m] ahead of the bow in the tank; [s] of a sway test
ROOM = 0.15
SHORTEST_TIME = 13.0
LONGEST_TIME = 18.0
STEP = 0.15  # of a finite difference, in prior sds: the loop's relays make the norms rough below it
MAX_EFFECTS = 6  # in one answer
SEEDS = (0,)  # of the search
FINAL_SEEDS = (0, 1, 2, 3, 4, 5)  # of the norms that are printed
DETERMINED = 0.9  # a fitted sd above this share of the prior sd: the tables do not determine it
CORRELATED = 0.7  # absolute correlation from which two strengths are printed
SWAY = TESTS[:4]
YAW = TESTS[4:]
NOMINAL: dict[str, dict[str, Any]] = {
    "cross_flow_drag": {"section_drag_coefficient": 0.0, "linear": 0.0},
    "surge_drag": {"linear": 0.0, "quadratic": 0.0},
    "added_mass": {"coriolis": 0.0},
    "thrust_lag": {"time_constant": 0.0},
    "servo": {"lag": 0.0, "rate": 1e3},
}
ADDED: list[dict[str, Any]] = [
    {"use": "weak_reverse", "astern_factor": 1.0},
    {"use": "thrust_imbalance", "fraction": 0.0},
    {"use": "steering_offset", "port": 0.0, "starboard": 0.0},
    {"use": "prop_walk", "side_force_per_thrust": 0.0},
    {"use": "shallow_water", "factor": 1.0},
    {"use": "fan_wind", "speed": 0.0},
]
# prior: 0.2 to 0.8 N (the thesis prints none)
OWN = (
    AdjustableStrength("pwm_thrust", "at_span", "N", 0.5, 0.3, 0.01, 3.0, tests=SWAY),
    AdjustableStrength("pwm_thrust", "at_span", "N", 0.5, 0.3, 0.01, 3.0, tests=YAW),
)
CANDIDATES: dict[str, tuple[AdjustableStrength, ...]] = {
    "weak_reverse": (AdjustableStrength("weak_reverse", "astern_factor", "", 1.0, 0.3, 0.3, 1.3),),
    "thrust_imbalance": (
        AdjustableStrength("thrust_imbalance", "fraction", "", 0.0, 0.15, -0.6, 0.6),
    ),
    "thrust_curve": (AdjustableStrength("pwm_thrust", "exponent", "", 1.0, 0.5, 0.5, 3.0),),
    "cross_flow_drag": (
        AdjustableStrength("cross_flow_drag", "section_drag_coefficient", "", 0.0, 1.2, 0.0, 5.0),
    ),
    "surge_drag": (
        AdjustableStrength("surge_drag", "quadratic", "N s^2/m^2", 0.0, 4.0, 0.0, 40.0),
    ),
    "added_mass_coriolis": (AdjustableStrength("added_mass", "coriolis", "", 0.0, 0.5, 0.0, 1.0),),
    "added_mass": (AdjustableStrength("added_mass", "sway", "kg", 1.0, 0.5, 0.3, 3.0, "times"),),
    "yaw_inertia": (AdjustableStrength("body", "yaw_inertia", "", 1.0, 0.5, 0.4, 3.0, "times"),),
    "lateral_centre_shift": (
        AdjustableStrength("cross_flow_drag", "centre", "m", 0.0, 0.1, -0.4, 0.4, "add"),
    ),
    "shallow_water": (AdjustableStrength("shallow_water", "factor", "", 1.0, 1.0, 1.0, 5.0),),
    "wind": (AdjustableStrength("fan_wind", "speed", "m/s", 0.0, 0.4, 0.0, 2.0, tests=WINDY),),
    "prop_walk": (
        AdjustableStrength("prop_walk", "side_force_per_thrust", "", 0.0, 0.1, -0.6, 0.6),
    ),
    "steering_offset": (
        AdjustableStrength("steering_offset", "port", "rad", 0.0, 0.12, -0.6, 0.6),
        AdjustableStrength("steering_offset", "starboard", "rad", 0.0, 0.12, -0.6, 0.6),
    ),
    "thrust_lag": (AdjustableStrength("thrust_lag", "time_constant", "s", 0.0, 0.6, 0.0, 3.0),),
    "steering_lag": (AdjustableStrength("servo", "lag", "s", 0.0, 0.3, 0.0, 2.0),),
    "start_up_kick": (
        AdjustableStrength("controller", "h0", "rad", 0.0, 0.2, 0.0, 1.0, tests=SWAY),
    ),
    "light_offset": (AdjustableStrength("camera", "led", "m", 0.183, 0.05, 0.0, 0.5, tests=YAW),),
}
KINDS = {"start_up_kick": "controller", "light_offset": "measurement"}  # all others are physics
Data = Mapping[str, Mapping[str, float]]  # test -> norm -> published value


@dataclass(frozen=True)
class Fit:
    """A set of candidates with fitted strengths."""

    names: tuple[str, ...]
    knobs: tuple[AdjustableStrength, ...]
    theta: Array  # (F,)
    covariance: Array  # (F, F)
    slopes: Array  # (R, F) of the residuals, in units of the prior sd
    evidence: float  # [nats]

    def value(self, knob: AdjustableStrength) -> tuple[float, float]:
        """Return a fitted strength and its standard deviation."""
        i = self.knobs.index(knob)
        return float(self.theta[i]), sqrt(self.covariance[i, i])


class Tables:
    """Published norms, and the simulated tests that should reproduce them."""

    def __init__(self, tests: Sequence[str] = TESTS) -> None:
        """Load the tests.

        Args:
            tests: Names of the tests.
        """
        self.benches = {t: ThesisTest(f"{t}_as_published", ADDED, NOMINAL, t in YAW) for t in tests}
        self.data = dict(zip(tests, map(published_norms, self.benches.values()), strict=True))
        self.facts = True
        self.cache: dict[Any, dict[str, float]] = {}

    def only(self, tests: Sequence[str], facts: bool = True) -> "Tables":
        """Return some of the tests, with or without the bounds of the text; runs are shared."""
        found = copy(self)
        found.benches = dict(zip(tests, runs_named(self.benches, tests), strict=True))
        found.facts = facts
        return found

    def norms(
        self, test: str, knobs: Sequence[AdjustableStrength], theta: Sequence[float]
    ) -> dict[str, float]:
        """Return the norms of a test; each run is simulated once."""
        acting, values = [], []
        for knob, x in zip(knobs, theta, strict=True):
            if test in knob.tests:
                acting.append(knob)
                values.append(float(x))
        key = (test, tuple(acting), tuple(values))
        if key not in self.cache:
            self.cache[key] = self.benches[test].norms(acting, values, SEEDS)
        return self.cache[key]

    def residuals(self, knobs: Sequence[AdjustableStrength], theta: Sequence[float]) -> Array:
        """Return the weighted residuals (R,) of all tests."""
        of_test = partial(self.of_test, knobs=knobs, theta=theta)
        return np.concatenate(list(map(of_test, self.benches)))

    def of_test(
        self, test: str, knobs: Sequence[AdjustableStrength], theta: Sequence[float]
    ) -> Array:
        """Return the weighted residuals of one test: its norms, then the bounds of the text."""
        found, wanted = self.norms(test, knobs, theta), self.data[test]
        weight = sqrt(INDEPENDENT / len(wanted))
        residuals = []
        for name, x in wanted.items():
            off = 2.0 * CLIP  # for a run that ends before the norm is defined
            if name in found:
                off = residual(name, found[name], x)
            residuals.append(soft_clip(off) * weight)
        if test in SWAY and self.facts:
            residuals += map(soft_clip, residuals_outside_bounds(found))
        return np.array(residuals) / SPREAD

    def rows(self) -> dict[str, slice]:
        """Return the rows of the residuals of each test."""
        slices, begin = {}, 0
        for test in self.benches:
            end = begin + len(self.data[test])
            if test in SWAY and self.facts:
                end += 2
            slices[test] = slice(begin, end)
            begin = end
        return slices


def published_norms(bench: ThesisTest) -> dict[str, float]:
    """Return the published norms of a test that are fitted."""
    return {name: x for name, x in bench.published.items() if name != "position_l1"}


def residuals_outside_bounds(found: Mapping[str, float]) -> tuple[float, float]:
    """Return the residuals of surge offset and time of a sway test outside the text's bounds."""
    if not found:
        return 2.0 * CLIP, 2.0 * CLIP
    ahead, time = found["surge_offset"], found["time_to_end"]
    bounded = min(max(time, SHORTEST_TIME), LONGEST_TIME)
    return (ahead - min(max(ahead, 0.0), ROOM)) / ROOM, log(time / bounded)


def soft_clip(x: float) -> float:
    """Return a residual that grows logarithmically beyond `CLIP`, so that it keeps a slope."""
    return CLIP * asinh(x / CLIP)


# ---- fit


def strengths_of(names: Sequence[str]) -> tuple[AdjustableStrength, ...]:
    """Return the nominal's own coefficients and those of candidates."""
    knobs = list(OWN)
    for name in names:
        knobs += CANDIDATES[name]
    return tuple(knobs)


def log_posterior(
    tables: Tables, knobs: Sequence[AdjustableStrength], theta: Array
) -> tuple[float, Array]:
    """Return the log posterior up to a constant, and the residuals (R,)."""
    e = tables.residuals(knobs, theta.tolist())
    return log_prior(knobs, theta) - 0.5 * float(e @ e), e  # type: ignore[arg-type]


def jacobian(tables: Tables, knobs: Sequence[AdjustableStrength], theta: Array, e: Array) -> Array:
    """Return the derivatives (R, F) of the residuals by theta / sd, one-sided, into the bounds."""
    found = np.zeros((len(e), len(knobs)))
    for j, knob in enumerate(knobs):
        h = STEP if theta[j] + STEP * knob.sd <= knob.high else -STEP
        moved = theta.copy()
        moved[j] += h * knob.sd
        found[:, j] = (tables.residuals(knobs, moved.tolist()) - e) / h
    return found


def gauss_newton(tables: Tables, names: Sequence[str], theta: Array, most: int = 6) -> Fit:
    """Return a fit by damped Gauss-Newton steps, with its Laplace evidence.

    Args:
        tables: The data.
        names: Candidates that act.
        theta: (F,) start.
        most: Largest number of steps.
    """
    knobs = strengths_of(names)
    space = ParameterSpace(knobs)  # type: ignore[arg-type]
    theta, damping = space.clip(theta), 1e-3
    best, e = log_posterior(tables, knobs, theta)
    A = jacobian(tables, knobs, theta, e)
    for _ in range(most):
        g, gain = -(A.T @ e) - (theta - space.mean) / space.sd, 0.0
        for _ in range(4):
            trial = space.damped_step(theta, A.T @ A, g, damping)
            value, after = log_posterior(tables, knobs, trial)
            if value > best:
                theta, e, gain, best, damping = trial, after, value - best, value, damping / 10.0
                break
            damping = max(damping, 1e-2) * 10.0
        if gain > 0.0:
            A = jacobian(tables, knobs, theta, e)
        if gain < 0.2:
            break
    information = np.eye(len(knobs)) + A.T @ A
    evidence = best - 0.5 * float(np.linalg.slogdet(information)[1])
    return Fit(tuple(names), knobs, theta, space.covariance(information), A, evidence)


def fit_with_candidate(tables: Tables, base: Fit, name: str) -> Fit:
    """Return `base` refitted with one more candidate.

    The start is the best of a few strengths, with the thrusts of `base` and of the prior.
    """
    names = (*base.names, name)
    space = ParameterSpace(CANDIDATES[name])  # type: ignore[arg-type]
    knobs = strengths_of(names)
    port, starboard = OWN[0].mean, OWN[1].mean
    thrusts = (
        base.theta[:2],
        np.array([base.theta[0], starboard]),
        np.array([port, base.theta[1]]),
        np.array([port, starboard]),
    )
    starts = []
    for shift in (-1.0, -0.3, 0.3, 1.0):
        strengths = space.clip(space.mean + shift * space.sd)
        starts += [np.concatenate([thrust, base.theta[2:], strengths]) for thrust in thrusts]
    best = max(starts, key=lambda theta: log_posterior(tables, knobs, theta)[0])
    return gauss_newton(tables, names, best, 3)


def fit_without(tables: Tables, base: Fit, name: str) -> Fit:
    """Return `base` refitted without one of its candidates."""
    names = tuple(filter(name.__ne__, base.names))
    known = dict(zip(base.knobs, base.theta.tolist(), strict=True))
    return gauss_newton(tables, names, np.array(list(map(known.__getitem__, strengths_of(names)))))


@dataclass(frozen=True)
class Ranking:
    """Result of the selection of candidates."""

    nominal: Fit  # as written
    recalibrated: Fit
    best: Fit
    first: dict[str, float]  # gain of each candidate alone [nats]
    gains: dict[str, float]  # of each identified effect, in addition to the others
    rivals: dict[str, dict[str, Fit]]  # identified -> the best set with another one in its place
    last: dict[str, Fit]  # each other candidate in addition to the best set

    def gain(self, fit: Fit) -> float:
        """Return the evidence of a fit minus that of the best [nats]."""
        return fit.evidence - self.best.evidence


def rank(
    tables: Tables, candidates: Sequence[str] = tuple(CANDIDATES), most: int = MAX_EFFECTS
) -> Ranking:
    """Select candidates one by one by evidence, and compare each with the others in its place."""
    theta = np.array([OWN[0].mean, OWN[1].mean])
    nominal = Fit(
        (), OWN, theta, np.zeros((2, 2)), np.zeros((0, 2)), log_posterior(tables, OWN, theta)[0]
    )
    base = best = gauss_newton(tables, (), theta)
    tested: dict[tuple[str, ...], dict[str, Fit]] = {}

    def with_each(fit: Fit) -> dict[str, Fit]:
        return {n: fit_with_candidate(tables, fit, n) for n in candidates if n not in best.names}

    while len(best.names) < most:
        tested[best.names] = with_each(best)
        front = max(tested[best.names].values(), key=attrgetter("evidence"))
        if front.evidence < best.evidence + MIN_GAIN:
            break
        best = prune(tables, gauss_newton(tables, front.names, front.theta))
        if best.names in tested:
            break
    first = {name: fit.evidence - base.evidence for name, fit in tested[()].items()}
    gains: dict[str, float] = {}
    rivals: dict[str, dict[str, Fit]] = {}
    for name in best.names:
        fewer = fit_without(tables, best, name)
        gains[name] = best.evidence - fewer.evidence
        rivals[name] = with_each(fewer)
    last = tested.get(best.names) or with_each(best)
    return Ranking(nominal, base, best, first, gains, rivals, last)


def prune(tables: Tables, best: Fit) -> Fit:
    """Return the set without members that others have made unnecessary."""
    while best.names:
        fewer = max(map(partial(fit_without, tables, best), best.names), key=attrgetter("evidence"))
        if fewer.evidence < best.evidence - MIN_GAIN:
            break
        best = fewer
    return best


# ---- printed tables


def fit_without_test(tables: Tables, fitted: Fit, test: str) -> Fit:
    """Return the same set refitted without one test, the better of two starts.

    The starts are the old strengths, and strengths nearer to the prior.
    """
    rest = tables.only(list(filter(test.__ne__, tables.benches)))
    mean = ParameterSpace(fitted.knobs).mean  # type: ignore[arg-type]
    near = gauss_newton(rest, fitted.names, fitted.theta)
    far = gauss_newton(rest, fitted.names, 0.7 * fitted.theta + 0.3 * mean)
    return max(near, far, key=attrgetter("evidence"))


def distance(tables: Tables, fitted: Fit, tests: Sequence[str]) -> float:
    """Return J of some tests."""
    pairs = []
    for test in tests:
        wanted = tables.data[test]
        found = tables.norms(test, fitted.knobs, fitted.theta.tolist())
        if not found:
            found = {name: x * 1e9 for name, x in wanted.items()}
        pairs.append((found, wanted))
    return rms_distance(pairs)


def print_ranking(ranking: Ranking) -> None:
    """Print the candidates in order of gain."""
    gains = ranking.gains
    alone = sorted(ranking.first.items(), key=lambda item: -item[1])
    rows = []
    for name, first in sorted(alone, key=lambda item: -gains.get(item[0], -np.inf)):
        fitted, verdict = ranking.best, "missing"
        if name not in gains:
            fitted, verdict = ranking.last[name], "-"
        gain = gains.get(name, ranking.gain(fitted))
        kind = KINDS.get(name, "physics")
        rows.append([name, kind, *format_fixed(1, first, gain), values_text(fitted, name), verdict])
    header = ["candidate", "kind", "alone [nats]", "with the others [nats]", "value +- sd"]
    title = "candidates: gain over the retuned vessel alone, and with the identified effects"
    print_table(title, [*header, "verdict"], rows)


def values_text(fitted: Fit, name: str) -> str:
    """Return the fitted values of a candidate as text."""
    return ", ".join(map(partial(value_text, fitted), CANDIDATES[name]))


def value_text(fitted: Fit, knob: AdjustableStrength) -> str:
    """Return a fitted value as text; "(prior)" if the tables do not determine it."""
    value, sd = fitted.value(knob)
    text = f"{knob.name} {value:.3g} +- {sd:.2g} {knob.unit}".rstrip()
    if sd > DETERMINED * knob.sd:
        text += " (prior)"
    return text


def print_sources(tables: Tables, ranking: Ranking) -> None:
    """Print the gain of each effect by part of the data, and the information of each test."""
    parts = {
        "all": tables,
        "norms only": tables.only(TESTS, facts=False),
        "sway norms": tables.only(SWAY, facts=False),
        "sway, with the text": tables.only(SWAY),
        "yaw norms": tables.only(YAW),
    }
    best = ranking.best
    rows = []
    for name in best.names:
        gain = partial(gain_in_part, best, name)
        rows.append([name, *format_fixed(1, *map(gain, parts.values()))])
    title = "gain of each effect by part of the data, all else refitted to that part [nats]"
    print_table(title, ["effect", *parts], rows)
    shares = []
    for j, knob in enumerate(best.knobs):
        information = []
        for part in tables.rows().values():
            information.append(float((best.slopes[part, j] ** 2).sum()))
        total = max(sum(information), 1e-12)
        shares.append([knob.label, *format_fixed(0, *(100 * np.array(information) / total))])
    title = "information on each strength by test [%]"
    print_table(title, ["strength", *tables.benches], shares)


def gain_in_part(best: Fit, name: str, part: Tables) -> float:
    """Return the evidence of one effect in a part of the data [nats]."""
    return (
        gauss_newton(part, best.names, best.theta).evidence - fit_without(part, best, name).evidence
    )


def print_leave_one_out(tables: Tables, ranking: Ranking) -> None:
    """Print J of each test, fitted and held out."""
    base, best = ranking.recalibrated, ranking.best
    rows = []
    better = 0
    sums = np.zeros(2)
    for test in tables.benches:
        base_without = fit_without_test(tables, base, test)
        best_without = fit_without_test(tables, best, test)
        before = distance(tables, base_without, [test])
        after = distance(tables, best_without, [test])
        sums += np.array([before, after]) ** 2
        better += after < before
        fitted = distance(tables, base, [test]), distance(tables, best, [test])
        row = [test, *format_fixed(2, *fitted, before, after, after / before)]
        rows.append([*row, f"{thrust_ratio(best_without):.3f}"])
    rms = np.sqrt(sums / len(rows))
    tests = list(tables.benches)
    whole = distance(tables, base, tests), distance(tables, best, tests)
    row = ["all", *format_fixed(2, *whole, *rms, rms[1] / rms[0])]
    rows.append([*row, f"{thrust_ratio(best):.3f}"])
    header = ["test", "fitted: retuned", "with effects", "held out: retuned"]
    header += ["with effects", "ratio", "thrust ahead / astern"]
    print_table("J, the rms residual of a test's norms (log ratios; 10 deg; 0.1 m)", header, rows)
    print(f"held-out test predicted better with effects in {better} of {len(tests)}")


def print_norms(ranking: Ranking) -> None:
    """Print published norms and those of the boats in closed loop.

    The last column has the corrected controller on the boat with the identified effects.
    """
    rows, pairs = [], []
    for test in TESTS:
        bench = ThesisTest(f"{test}_as_published", ADDED, NOMINAL)
        best = simulate_norms(bench, ranking.best)
        columns = [
            simulate_norms(bench, ranking.nominal),
            simulate_norms(bench, ranking.recalibrated),
            best,
        ]
        columns.append(simulate_norms(ThesisTest(test, ADDED, NOMINAL), ranking.best))
        pairs.append((best, published_norms(bench)))
        wanted = {name: f"{x:g}" for name, x in bench.published.items()}
        if test in SWAY:
            wanted |= TEXT_BOUNDS
        for name, text in wanted.items():
            row = [f"{test} {name}", text]
            for found in columns:
                row.append(f"{found[name]:.3g}" if found else "-")
            rows.append(row)
    header = ["test, norm", "published", "as published model", "retuned", "with effects"]
    header.append("corrected controller")
    title = "norms of the thesis' program, mean of six seeds; last column: our controller"
    print_table(title, header, rows)
    print(f"J of the boat with effects in these closed-loop runs: {rms_distance(pairs):.2f}")
    print("- : the test does not end as it should (too short for the norms, or no full turn)")


TEXT_BOUNDS = {"surge_offset": "0 to 0.15", "time_to_end": "13 to 18"}


def simulate_norms(bench: ThesisTest, fitted: Fit) -> dict[str, float]:
    """Return the norms of a test with a boat's strengths.

    Strengths of the thesis' controller are used only in tests with that controller.
    """
    as_published = bench.name.endswith("_as_published")
    knobs, values = [], []
    for knob, x in zip(fitted.knobs, fitted.theta.tolist(), strict=True):
        used = knob.effect != "controller" or as_published
        if used and bench.name.removesuffix("_as_published") in knob.tests:
            knobs.append(knob)
            values.append(x)
    return bench.norms(knobs, values, FINAL_SEEDS)


def fit_look_alikes(ranking: Ranking, name: str) -> dict[str, Fit]:
    """Return fits with another effect in the place of an identified one, the best first.

    Only those that the data do not exclude are returned.
    """
    rivals = sorted(ranking.rivals[name].items(), key=lambda item: -item[1].evidence)
    return {rival: fit for rival, fit in rivals if ranking.gain(fit) > -DEFAULT.select.alike}


def thrust_ratio(fitted: Fit) -> float:
    """Return the thrust of the port motor ahead at 0.70 of the PWM over that of starboard astern.

    The thesis calibrates its motors by this ratio (Appendix H).
    """
    x = {}
    for knob, value in zip(fitted.knobs, fitted.theta.tolist(), strict=True):
        x[f"{knob.effect}.{knob.name}"] = value
    f, curve = x.get("thrust_imbalance.fraction", 0.0), x.get("pwm_thrust.exponent", 1.0)
    return float(0.70**curve * (1.0 + f) / (1.0 - f) / x.get("weak_reverse.astern_factor", 1.0))


def print_undetermined(ranking: Ranking) -> None:
    """Print what the tables do not determine."""
    print("\nnot determined by the tables")
    for name in ranking.rivals:
        for rival, fitted in fit_look_alikes(ranking, name).items():
            print(
                f"  {name} or, in its place, {rival} ({ranking.gain(fitted):+.1f} nats): "
                f"{values_text(fitted, rival)}"
            )
            print(
                f"    thrust ahead over thrust astern: {thrust_ratio(ranking.best):.3f} with the "
                f"first, {thrust_ratio(fitted):.3f} with the second (determined by the tables)"
            )
    idle, vague = [], []
    for name, fitted in ranking.last.items():
        if ranking.gain(fitted) < MIN_GAIN:
            idle.append(name)
        for knob in CANDIDATES[name]:
            if fitted.value(knob)[1] > DETERMINED * knob.sd:
                vague.append(knob.label)
    names = ", ".join(idle) or "none of the candidates"
    print(f"  presence of any of: {names} (each gains less than {MIN_GAIN:g} nats)")
    labels = ", ".join(vague) or "none"
    print(f"  the strength of: {labels} (the standard deviation remains that of the prior)")
    sd = np.sqrt(np.diag(ranking.best.covariance))
    correlation = ranking.best.covariance / np.outer(sd, sd)
    for i, a in enumerate(ranking.best.knobs):
        for j, b in enumerate(ranking.best.knobs[:i]):
            if abs(correlation[i, j]) > CORRELATED:
                print(f"  {b.label} and {a.label} apart: correlation {correlation[i, j]:+.2f}")


def main() -> None:
    """Fit, rank, and print the evidence."""
    tables = Tables()
    ranking = rank(tables)
    identified = []
    for name in ranking.best.names:
        identified.append(" or ".join([name, *fit_look_alikes(ranking, name)]))
    missing = ", ".join(identified) or "nothing"
    print(f"missing from the thesis' model, by its tables alone: {missing}")
    print(
        f"baseline: the thesis' model with its thrusts refitted "
        f"({own_coefficients_text(ranking.recalibrated)})"
    )
    print(f"with effects: {own_coefficients_text(ranking.best)}")
    print_ranking(ranking)
    print_sources(tables, ranking)
    print_leave_one_out(tables, ranking)
    print_norms(ranking)
    print_undetermined(ranking)


def own_coefficients_text(fitted: Fit) -> str:
    """Return the nominal's own coefficients as text."""
    texts = []
    for knob in OWN:
        x, sd = fitted.value(knob)
        texts.append(f"{knob.label} {x:.3g} +- {sd:.2g} {knob.unit}")
    return ", ".join(texts)


if __name__ == "__main__":
    main()
