"""What the thesis left out, from its tables alone: `python -m validation.real.thesis_tables`.

Source of the data: J. A. Bayless, Adaptive Control of Joystick Steering in Recreational Boats, Marquette University,
2017. There are no time series, only error norms of eight tests, so every candidate is judged by running the tests:
the scenarios joystick_boat/*_as_published (the thesis' own program) in the compiled twin, closed loop, camera and all.

Compared are, per test, with the values that stand as `published` in the scenario files:
- sway 1 to 4 (Table 22): inf-norm, 2-norm and 1-norm of the smoothed yaw rate, heading change at 0.9 m;
- yaw 1 to 4 (Table 23): inf-norm and rms of the light's distance from its circle (the rms of test 4 exceeds its
  inf-norm and is left out), distance moved; time of a turn 44 s ("two turns in almost 90 s", section V-E);
- what the text says of the sway tests: they took 13 to 18 s (0.9 m at the number of frames that the norms need) and
  the boat stayed in its tank (section V-A), so that it went 0 to 0.15 m ahead (Table 26: the surge error is positive).
The 1-norm of the yaw tests is printed, not fitted: the number of frames it needs differs between tests of one length.

A residual is a log ratio, for the heading the error over 10 deg, for the distance moved over 0.1 m; outside the bounds
of the text a log ratio, and over 0.15 m. Beyond 3 it grows as its logarithm; its stated spread is 0.3. The norms of
one test are readings of one curve: together they count as two numbers, each bound of the text as one.

The nominal is the thesis' simulation as far as it is physical: rigid body and added mass, ideal thrust either way, no
drag, no Coriolis force, no lags, no wind. Its own coefficients are the thrust at PWM 150 in the sway and in the yaw
program; refitted they give the baseline. Candidates are added as `boatsim diagnose` adds them: by Laplace evidence,
from 4 nats on. The search plays the turns' commands with one seed; the norms printed at the end are closed loop with
six seeds.
"""

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from math import asinh, log, sqrt
from typing import Any

import numpy as np

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.fit import ParameterSpace, log_prior
from boatsim.physics.base import Array
from validation.real.common import table
from validation.real.thesis_runs import TESTS, WINDY, Bench, Knob
from validation.real.thesis_score import CLIP, SCALE, J

ENOUGH = 4.0  # [nats] an effect must gain to be named
# of a residual: camera marks, rounding of the tables, and how far runs of one test differ
SPREAD = 0.3
INDEPENDENT = 2.0  # numbers that the norms of one test are worth
ROOM, TIMES = 0.15, (13.0, 18.0)  # [m] ahead of the bow in the tank; [s] of a sway test
STEP = 0.15  # of a finite difference, in prior sds: the loop's relays make the norms rough below it
MOST = 6  # effects in one answer
SEEDS, FINAL = (0,), (0, 1, 2, 3, 4, 5)  # of the search; of the norms that are printed
TOLD = 0.9  # a fitted sd above this share of the prior one means that the tables say nothing
SWAY, YAW = TESTS[:4], TESTS[4:]
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
OWN = (
    Knob(
        "pwm_thrust", "at_span", "N", 0.5, 0.3, 0.01, 3.0, tests=SWAY
    ),  # prior: 0.2 to 0.8 N (the thesis prints none)
    Knob("pwm_thrust", "at_span", "N", 0.5, 0.3, 0.01, 3.0, tests=YAW),
)
CANDIDATES: dict[str, tuple[Knob, ...]] = {
    "weak_reverse": (Knob("weak_reverse", "astern_factor", "", 1.0, 0.3, 0.3, 1.3),),
    "thrust_imbalance": (Knob("thrust_imbalance", "fraction", "", 0.0, 0.15, -0.6, 0.6),),
    "thrust_curve": (Knob("pwm_thrust", "exponent", "", 1.0, 0.5, 0.5, 3.0),),
    "cross_flow_drag": (
        Knob("cross_flow_drag", "section_drag_coefficient", "", 0.0, 1.2, 0.0, 5.0),
    ),
    "surge_drag": (Knob("surge_drag", "quadratic", "N s^2/m^2", 0.0, 4.0, 0.0, 40.0),),
    "added_mass_coriolis": (Knob("added_mass", "coriolis", "", 0.0, 0.5, 0.0, 1.0),),
    "added_mass": (Knob("added_mass", "sway", "kg", 1.0, 0.5, 0.3, 3.0, "times"),),
    "yaw_inertia": (Knob("body", "yaw_inertia", "", 1.0, 0.5, 0.4, 3.0, "times"),),
    "lateral_centre_shift": (Knob("cross_flow_drag", "centre", "m", 0.0, 0.1, -0.4, 0.4, "add"),),
    "shallow_water": (Knob("shallow_water", "factor", "", 1.0, 1.0, 1.0, 5.0),),
    "wind": (Knob("fan_wind", "speed", "m/s", 0.0, 0.4, 0.0, 2.0, tests=WINDY),),
    "prop_walk": (Knob("prop_walk", "side_force_per_thrust", "", 0.0, 0.1, -0.6, 0.6),),
    "steering_offset": (
        Knob("steering_offset", "port", "rad", 0.0, 0.12, -0.6, 0.6),
        Knob("steering_offset", "starboard", "rad", 0.0, 0.12, -0.6, 0.6),
    ),
    "thrust_lag": (Knob("thrust_lag", "time_constant", "s", 0.0, 0.6, 0.0, 3.0),),
    "steering_lag": (Knob("servo", "lag", "s", 0.0, 0.3, 0.0, 2.0),),
    "start_up_kick": (Knob("controller", "h0", "rad", 0.0, 0.2, 0.0, 1.0, tests=SWAY),),
    "light_offset": (Knob("camera", "led", "m", 0.183, 0.05, 0.0, 0.5, tests=YAW),),
}
KINDS = {"start_up_kick": "controller", "light_offset": "measurement"}  # all others are physics
Data = Mapping[str, Mapping[str, float]]  # test -> norm -> published value


@dataclass(frozen=True)
class Fit:
    """A set of candidates with their best strengths."""

    names: tuple[str, ...]
    knobs: tuple[Knob, ...]
    theta: Array  # (F,)
    covariance: Array  # (F, F)
    slopes: Array  # (R, F) of the residuals, in units of the prior sd
    evidence: float  # [nats]

    def value(self, knob: Knob) -> tuple[float, float]:
        """Fitted strength and one standard deviation."""
        i = self.knobs.index(knob)
        return float(self.theta[i]), sqrt(self.covariance[i, i])


class Tables:
    """Published norms, and the runs that are to give them."""

    def __init__(
        self, data: Data | None = None, tests: Sequence[str] = TESTS, seeds: Sequence[int] = SEEDS
    ) -> None:
        """`data` in place of the published norms."""
        self.benches = {t: Bench(f"{t}_as_published", ADDED, NOMINAL, t in YAW) for t in tests}
        self.data = data or {t: published(b) for t, b in self.benches.items()}
        self.facts, self.seeds = True, tuple(seeds)
        self.kept: dict[Any, dict[str, float]] = {}

    def only(self, tests: Sequence[str], facts: bool = True) -> "Tables":
        """Some of the tests, with or without the bounds of the text; runs are shared."""
        found = copy(self)
        found.benches, found.facts = {t: self.benches[t] for t in tests}, facts
        return found

    def norms(self, test: str, knobs: Sequence[Knob], theta: Sequence[float]) -> dict[str, float]:
        """Norms of a test, each run made once."""
        acting = [(k, float(x)) for k, x in zip(knobs, theta, strict=True) if test in k.tests]
        key = (test, *acting)
        if key not in self.kept:
            self.kept[key] = self.benches[test].norms(
                [k for k, _ in acting], [x for _, x in acting], self.seeds
            )
        return self.kept[key]

    def residuals(self, knobs: Sequence[Knob], theta: Sequence[float]) -> Array:
        """Weighted residuals of all tests, one after the other."""
        return np.concatenate([self.of_test(t, knobs, theta) for t in self.benches])

    def of_test(self, test: str, knobs: Sequence[Knob], theta: Sequence[float]) -> Array:
        """Weighted residuals of one test: its norms, then the bounds of the text."""
        found, wanted = self.norms(test, knobs, theta), self.data[test]
        norms = [
            soft(residual(n, found, x)) * sqrt(INDEPENDENT / len(wanted)) for n, x in wanted.items()
        ]
        facts = [soft(x) for x in beyond(found)] if test in SWAY and self.facts else []
        return np.array([*norms, *facts]) / SPREAD

    def rows(self) -> dict[str, slice]:
        """Where each test's residuals lie."""
        sizes = [len(self.data[t]) + (2 if t in SWAY and self.facts else 0) for t in self.benches]
        ends = np.cumsum(sizes).tolist()
        return {t: slice(e - n, e) for t, n, e in zip(self.benches, sizes, ends, strict=True)}


def published(bench: Bench) -> dict[str, float]:
    """What is fitted of a test's published norms."""
    return {n: x for n, x in bench.published.items() if n != "position_l1"}


def residual(name: str, found: Mapping[str, float], wanted: float) -> float:
    """As `thesis_score.J` has it, not clipped; a run that never got there is as far away as counts."""
    if name not in found:
        return 2.0 * CLIP
    return (found[name] - wanted) / SCALE[name] if name in SCALE else log(found[name] / wanted)


def beyond(found: Mapping[str, float]) -> tuple[float, float]:
    """How far surge offset and time of a sway test lie outside what the text allows."""
    if not found:
        return 2.0 * CLIP, 2.0 * CLIP
    ahead, time = found["surge_offset"], found["time_to_end"]
    return (
        (ahead - min(max(ahead, 0.0), ROOM)) / ROOM,
        log(time / min(max(time, TIMES[0]), TIMES[1])),
    )


def soft(x: float) -> float:
    """A residual itself while small, its logarithm beyond the clip of J: far away still shows the way."""
    return CLIP * asinh(x / CLIP)


# Fit
# --------------------------------------------------------------------------------------------------------------


def knobs_of(names: Sequence[str]) -> tuple[Knob, ...]:
    """The nominal's own coefficients and those of candidates."""
    return (*OWN, *(k for n in names for k in CANDIDATES[n]))


def score(tables: Tables, knobs: Sequence[Knob], theta: Array) -> tuple[float, Array]:
    """Log posterior up to a constant, and the residuals."""
    e = tables.residuals(knobs, theta.tolist())
    return log_prior(knobs, theta) - 0.5 * float(e @ e), e  # type: ignore[arg-type]


def slopes(tables: Tables, knobs: Sequence[Knob], theta: Array, e: Array) -> Array:
    """Derivatives of the residuals by theta / sd, one-sided, into the bounds."""
    found = np.zeros((len(e), len(knobs)))
    for j, knob in enumerate(knobs):
        h = STEP if theta[j] + STEP * knob.sd <= knob.high else -STEP
        moved = theta.copy()
        moved[j] += h * knob.sd
        found[:, j] = (tables.residuals(knobs, moved.tolist()) - e) / h
    return found


def gauss_newton(tables: Tables, names: Sequence[str], theta: Array, most: int = 6) -> Fit:
    """Damped Gauss-Newton from theta; Laplace evidence at the end."""
    knobs = knobs_of(names)
    space = ParameterSpace(knobs)  # type: ignore[arg-type]
    theta, damping = space.clipped(theta), 1e-3
    best, e = score(tables, knobs, theta)
    A = slopes(tables, knobs, theta, e)
    for _ in range(most):
        g, gain = -(A.T @ e) - (theta - space.mean) / space.sd, 0.0
        for _ in range(4):
            trial = space.damped_step(theta, A, g, damping)
            value, after = score(tables, knobs, trial)
            if value > best:
                theta, e, gain, best, damping = trial, after, value - best, value, damping / 10.0
                break
            damping = max(damping, 1e-2) * 10.0
        if gain > 0.0:
            A = slopes(tables, knobs, theta, e)
        if gain < 0.2:
            break
    information = np.eye(len(knobs)) + A.T @ A
    evidence = best - 0.5 * float(np.linalg.slogdet(information)[1])
    return Fit(tuple(names), knobs, theta, space.covariance(information), A, evidence)


def with_candidate(tables: Tables, base: Fit, name: str, most: int = 3) -> Fit:
    """`base` with one more candidate, begun at the best of a few strengths and of the thrusts fitted and expected."""
    knobs, names = CANDIDATES[name], (*base.names, name)

    def start(shift: float, thrust: Array) -> Array:
        moved = [min(max(k.mean + shift * k.sd, k.low), k.high) for k in knobs]
        return np.concatenate([thrust, base.theta[2:], moved])

    mean = np.array([k.mean for k in OWN])
    thrusts = (
        base.theta[:2],
        np.array([base.theta[0], mean[1]]),
        np.array([mean[0], base.theta[1]]),
        mean,
    )
    begun = [start(s, thrust) for s in (-1.0, -0.3, 0.3, 1.0) for thrust in thrusts]
    return gauss_newton(
        tables, names, max(begun, key=lambda x: score(tables, knobs_of(names), x)[0]), most
    )


def without(tables: Tables, base: Fit, name: str) -> Fit:
    """`base` refitted without one of its candidates."""
    names = tuple(n for n in base.names if n != name)
    known = dict(zip(base.knobs, base.theta.tolist(), strict=True))
    return gauss_newton(tables, names, np.array([known[k] for k in knobs_of(names)]))


@dataclass(frozen=True)
class Ranking:
    """What selection over the candidates found."""

    nominal: Fit  # as written
    recalibrated: Fit
    best: Fit
    first: dict[str, float]  # gain of each candidate alone [nats]
    gains: dict[str, float]  # of each named on top of the others named
    rivals: dict[
        str, dict[str, Fit]
    ]  # named -> the best set with each other candidate in its place
    last: dict[str, Fit]  # each other candidate on top of the best set


def rank(
    tables: Tables, candidates: Sequence[str] = tuple(CANDIDATES), most: int = MOST
) -> Ranking:
    """Forward selection by evidence, then each member weighed on top of the others and against its rivals."""
    theta = np.array([k.mean for k in OWN])
    nominal = Fit((), OWN, theta, np.zeros((2, 2)), np.zeros((0, 2)), score(tables, OWN, theta)[0])
    base = best = gauss_newton(tables, (), theta)
    looks: dict[tuple[str, ...], dict[str, Fit]] = {}
    while len(best.names) < most:
        tried = {n: with_candidate(tables, best, n) for n in candidates if n not in best.names}
        looks[best.names] = tried
        front = max(tried.values(), key=lambda f: f.evidence)
        if front.evidence < best.evidence + ENOUGH:
            break
        best = pruned(tables, gauss_newton(tables, front.names, front.theta))
        if best.names in looks:
            break
    first = {n: f.evidence - base.evidence for n, f in looks[()].items()}
    gains: dict[str, float] = {}
    rivals: dict[str, dict[str, Fit]] = {}
    others = [n for n in candidates if n not in best.names]
    for name in best.names:
        fewer = without(tables, best, name)
        gains[name] = best.evidence - fewer.evidence
        rivals[name] = {n: with_candidate(tables, fewer, n) for n in others}
    last = looks.get(best.names) or {n: with_candidate(tables, best, n) for n in others}
    return Ranking(nominal, base, best, first, gains, rivals, last)


def pruned(tables: Tables, best: Fit) -> Fit:
    """Without the members that others have made needless."""
    while best.names:
        fewer = max((without(tables, best, n) for n in best.names), key=lambda f: f.evidence)
        if fewer.evidence < best.evidence - ENOUGH:
            break
        best = fewer
    return best


# What is printed
# --------------------------------------------------------------------------------------------------


def left_out(tables: Tables, fitted: Fit, test: str) -> Fit:
    """The same set refitted without one test, from where it was and from nearer to the prior."""
    rest = tables.only([t for t in tables.benches if t != test])
    mean = np.array([k.mean for k in fitted.knobs])
    starts = (fitted.theta, 0.7 * fitted.theta + 0.3 * mean)
    return max(
        (gauss_newton(rest, fitted.names, theta) for theta in starts), key=lambda f: f.evidence
    )


def distance(tables: Tables, fitted: Fit, tests: Sequence[str]) -> float:
    """J of some tests."""
    pairs = []
    for t in tests:
        found = tables.norms(t, fitted.knobs, fitted.theta.tolist())
        wanted = tables.data[t]
        pairs.append((found or {n: x * 1e9 for n, x in wanted.items()}, wanted))
    return J(pairs)


def print_ranking(found: Ranking) -> None:
    """Candidates in order of gain."""
    rows = []
    for name in sorted(
        found.first, key=lambda n: (n not in found.gains, -found.gains.get(n, 0.0), -found.first[n])
    ):
        fitted = found.best if name in found.gains else found.last[name]
        gain = found.gains[name] if name in found.gains else fitted.evidence - found.best.evidence
        values = ", ".join(strength(fitted, k) for k in CANDIDATES[name])
        verdict = "missing" if name in found.gains else "-"
        rows.append(
            [
                name,
                KINDS.get(name, "physics"),
                f"{found.first[name]:.1f}",
                f"{gain:.1f}",
                values,
                verdict,
            ]
        )
    header = [
        "candidate",
        "kind",
        "alone [nats]",
        "beside the others [nats]",
        "value +- sd",
        "verdict",
    ]
    table(
        "candidates: gain over the recalibrated nominal alone, and beside (or on top of) what is named",
        header,
        rows,
    )


def strength(fitted: Fit, knob: Knob) -> str:
    """A fitted value with its spread; whether the tables say anything of it."""
    value, sd = fitted.value(knob)
    return f"{knob.name} {value:.3g} +- {sd:.2g} {knob.unit}".rstrip() + (
        " (prior)" if sd > TOLD * knob.sd else ""
    )


def print_sources(tables: Tables, found: Ranking) -> None:
    """What part of the data calls for each effect."""
    parts = {
        "all": tables,
        "norms only": tables.only(TESTS, facts=False),
        "sway norms": tables.only(SWAY, facts=False),
        "sway, with the text": tables.only(SWAY),
        "yaw norms": tables.only(YAW),
    }
    rows = [
        [name, *(f"{gain_in(part, found.best, name):.1f}" for part in parts.values())]
        for name in found.best.names
    ]
    table(
        "gain of each effect by part of the data, all else refitted to that part [nats]",
        ["effect", *parts],
        rows,
    )
    shares = []
    for j, knob in enumerate(found.best.knobs):
        each = {
            t: float((found.best.slopes[rows_, j] ** 2).sum()) for t, rows_ in tables.rows().items()
        }
        total = max(sum(each.values()), 1e-12)
        shares.append([knob.label, *(f"{100 * x / total:.0f}" for x in each.values())])
    table("information on each strength by test [%]", ["strength", *tables.benches], shares)


def gain_in(part: Tables, best: Fit, name: str) -> float:
    """Evidence for one effect in a part of the data."""
    return gauss_newton(part, best.names, best.theta).evidence - without(part, best, name).evidence


def print_left_out(tables: Tables, found: Ranking) -> None:
    """Leave one test out."""
    rows, ahead = [], 0
    sums = np.zeros(2)
    for test in tables.benches:
        fits = (found.recalibrated, found.best)
        again = [left_out(tables, f, test) for f in fits]
        (a, la), (b, lb) = (
            [distance(tables, x, [test]) for x in pair] for pair in zip(fits, again, strict=True)
        )
        sums += np.array([la, lb]) ** 2
        ahead += lb < la
        rows.append(
            [
                test,
                f"{a:.2f}",
                f"{b:.2f}",
                f"{la:.2f}",
                f"{lb:.2f}",
                f"{lb / la:.2f}",
                f"{balance(again[1]):.3f}",
            ]
        )
    rms = np.sqrt(sums / len(rows))
    whole = [distance(tables, f, list(tables.benches)) for f in (found.recalibrated, found.best)]
    rows.append(
        [
            "all",
            *(f"{x:.2f}" for x in whole),
            *(f"{x:.2f}" for x in rms),
            f"{rms[1] / rms[0]:.2f}",
            f"{balance(found.best):.3f}",
        ]
    )
    header = [
        "test",
        "fitted: recalibrated",
        "with effects",
        "left out: recalibrated",
        "with effects",
        "ratio",
        "thrust ahead / astern",
    ]
    table("J, the rms residual of a test's norms (log ratios; 10 deg; 0.1 m)", header, rows)
    print(f"with effects nearer to the test left out in {ahead} of {len(tables.benches)}")


def print_norms(found: Ranking) -> None:
    """Published norms and those of the boats, closed loop, and the corrected controller on the boat found."""
    rows, pairs = [], []
    for test in TESTS:
        bench = Bench(f"{test}_as_published", ADDED, NOMINAL)
        ours = Bench(test, ADDED, NOMINAL)
        columns = [run(bench, f) for f in (found.nominal, found.recalibrated, found.best)] + [
            run(ours, found.best)
        ]
        pairs.append((columns[2], published(bench)))
        names = [*bench.published, *(["surge_offset", "time_to_end"] if test in SWAY else [])]
        for name in names:
            wanted = f"{bench.published[name]:g}" if name in bench.published else SAID[name]
            rows.append(
                [f"{test} {name}", wanted, *(f"{c[name]:.3g}" if c else "-" for c in columns)]
            )
    header = [
        "test, norm",
        "published",
        "as published model",
        "recalibrated",
        "with effects",
        "corrected controller",
    ]
    table(
        "norms of the thesis' program, mean of six seeds; last column: our controller on the same boat",
        header,
        rows,
    )
    print(f"J of the boat with effects in these closed-loop runs: {J(pairs):.2f}")
    print("- : the test does not end as it should (too short for the norms, or no full turn)")


SAID = {"surge_offset": "0 to 0.15", "time_to_end": "13 to 18"}  # what the text says


def run(bench: Bench, fitted: Fit) -> dict[str, float]:
    """Norms of a test with a boat's strengths; strengths of the thesis' controller are left to it."""
    told = [
        (k, x)
        for k, x in zip(fitted.knobs, fitted.theta.tolist(), strict=True)
        if bench.name.removesuffix("_as_published") in k.tests
        and (k.effect != "controller" or bench.name.endswith("_as_published"))
    ]
    return bench.norms([k for k, _ in told], [x for _, x in told], FINAL)


def alike(found: Ranking, name: str) -> dict[str, tuple[float, Fit]]:
    """Look-alikes of a named effect: what they gain over it in its place, and the fit, best first."""
    gains = {n: (f.evidence - found.best.evidence, f) for n, f in found.rivals[name].items()}
    return {
        n: x
        for n, x in sorted(gains.items(), key=lambda item: -item[1][0])
        if x[0] > -DEFAULT.select.alike
    }


def balance(fitted: Fit) -> float:
    """Thrust of the port motor, ahead at 0.70 of the PWM, over that of the starboard motor astern (Appendix H)."""
    x = {
        k.effect + "." + k.name: v for k, v in zip(fitted.knobs, fitted.theta.tolist(), strict=True)
    }
    f, curve = x.get("thrust_imbalance.fraction", 0.0), x.get("pwm_thrust.exponent", 1.0)
    return float(0.70**curve * (1.0 + f) / (1.0 - f) / x.get("weak_reverse.astern_factor", 1.0))


def print_untold(found: Ranking) -> None:
    """What the tables can not tell."""
    print("\nwhat the tables can not tell")
    for name in found.rivals:
        for rival, (gain, fitted) in alike(found, name).items():
            values = ", ".join(strength(fitted, k) for k in CANDIDATES[rival])
            print(f"  {name} or, in its place, {rival} ({gain:+.1f} nats): {values}")
            print(
                f"    thrust ahead over thrust astern: {balance(found.best):.3f} with the one, "
                f"{balance(fitted):.3f} with the other; this ratio is what the tables tell"
            )
    idle = [n for n, f in found.last.items() if f.evidence - found.best.evidence < ENOUGH]
    print(
        f"  whether there is also any of: {', '.join(idle) or 'none of the candidates'} (each gains less than 4 nats)"
    )
    mute = [
        k.label for n, f in found.last.items() for k in CANDIDATES[n] if f.value(k)[1] > TOLD * k.sd
    ]
    print(f"  the strength of: {', '.join(mute) or 'none'} (the spread stays that of the prior)")
    sd = np.sqrt(np.diag(found.best.covariance))
    corr = found.best.covariance / np.outer(sd, sd)
    for i, a in enumerate(found.best.knobs):
        for j, b in enumerate(found.best.knobs[:i]):
            if abs(corr[i, j]) > 0.7:
                print(f"  {b.label} and {a.label} apart: correlation {corr[i, j]:+.2f}")


def main() -> None:
    """Fit, rank, and say what carries it."""
    tables = Tables()
    found = rank(tables)
    named = [" or ".join([n, *alike(found, n)]) for n in found.best.names]
    print(f"missing from the thesis' model, by its tables alone: {', '.join(named) or 'nothing'}")
    print(
        f"baseline: the thesis' model with its thrusts refitted ({', '.join(own(found.recalibrated))})"
    )
    print(f"with effects: {', '.join(own(found.best))}")
    print_ranking(found)
    print_sources(tables, found)
    print_left_out(tables, found)
    print_norms(found)
    print_untold(found)


def own(fitted: Fit) -> list[str]:
    """The nominal's own coefficients."""
    return [f"{k.label} {x:.3g} +- {s:.2g} {k.unit}" for k in OWN for x, s in [fitted.value(k)]]


if __name__ == "__main__":
    main()
