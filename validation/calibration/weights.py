"""Weights of the signs: logistic regression of right and wrong names over a campaign's records.

The prior of each weight has its mean at the weight in use, which earlier campaigns gave. It is
narrow, except for signs that are new or defined anew: the law of a simulated cause has exactly the
form of a candidate, that of a real cause never, so that a campaign overstates what an inconsistent
size tells. With wide priors true effects of real recordings lose their names.
"""

from collections.abc import Collection, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, minimize_scalar
from scipy.special import expit

from boatsim.diagnosis.config import DEFAULT, DecideConfig
from boatsim.diagnosis.open_set.consistency import Consistency, Factor, Variation
from boatsim.diagnosis.open_set.log_signs import LogSigns
from boatsim.diagnosis.open_set.probability import logistic_features
from boatsim.diagnosis.search.pruning import IdentifiedEffect
from validation.calibration.table import right_names

Array = NDArray[np.float64]

# prior sd of the change of a weight, per standard deviation of its feature
WEIGHT_SD = 0.02
# of new signs. Cross-validated over two seeds, wider priors gain little more, and less on the seed
# that the signs were not chosen by
NEW_WEIGHT_SD = 0.1
LEAST_FACTOR_SD = 1e-4  # last printed digit of diagnosis.json
FOLDS = 10  # of the cross-validation, whole trials each

Record = dict[str, Any]


def examples(records: Sequence[Record]) -> tuple[list[str], Array, Array, Array]:
    """Return all identified effects of a campaign as examples.

    Where the true effect was removed from the candidates, every other name is a wrong one.

    Returns:
        Names of the features, features (N, F), whether the name or one of its look-alikes is right
        (N,), and the number of the trial (N,).
    """
    names: list[str] = []
    rows, right, trials = [], [], []
    numbers: dict[str, int] = {}  # both diagnoses of a trial fall into one fold
    for record in records:
        number = numbers.setdefault(record["trial"], len(numbers))
        truth = right_names(record)
        signs = record["signs"]
        log_signs = LogSigns(**signs["log"])
        for effect in signs["effects"]:
            if effect["refines"]:  # a better value of an estimated number, and no name
                continue
            found = recorded_features(effect, log_signs, DEFAULT.decide)
            names = list(found)
            rows.append(list(found.values()))
            right.append(bool(truth & {effect["name"], *effect["tied_with"]}))
            trials.append(number)
    return names, np.array(rows), np.array(right, dtype=float), np.array(trials)


def recorded_features(
    effect: dict[str, Any], log_signs: LogSigns, config: DecideConfig
) -> dict[str, float]:
    """Return the features of a recorded effect, by name.

    Args:
        effect: Its entry of the signs in diagnosis.json.
        log_signs: Signs of the log.
        config: Settings of the decision.
    """
    signs = consistency(effect["signs"])
    return logistic_features(identified(effect), effect["stochastic"], signs, log_signs, config)


def identified(entry: dict[str, Any]) -> IdentifiedEffect:
    """Return the effect of an entry of the signs in diagnosis.json, without its rivals."""
    gain, tied = entry["gain_nats"], tuple(entry["tied_with"])
    return IdentifiedEffect(entry["name"], gain, gain, entry["probability"], tied, {})


def consistency(entry: dict[str, Any]) -> Consistency:
    """Return the signs of an effect from their entry in diagnosis.json."""
    given = dict(entry)
    given["recordings"] = tuple(map(_factor, entry["recordings"]))
    given["held_out"] = _factor(entry["held_out"])
    given["axes"] = tuple(entry["axes"])
    for name in ("between_times", "between_ranges"):
        given[name] = Variation(**entry[name])
    return Consistency(**given)


def _factor(entry: dict[str, float]) -> Factor:
    """Factor of an entry, whose sd may be rounded to zero."""
    return Factor(entry["value"], max(entry["sd"], LEAST_FACTOR_SD))


class WeightPrior(NamedTuple):
    """Normal prior of a regression: means, and sds of the weights per sd of their features."""

    intercept: float
    mean: Array  # (F,) of the weights
    sd: Array  # (F,)


def weight_prior(names: Sequence[str], new: Collection[str]) -> WeightPrior:
    """Return the prior of the weights of features, with its mean at the weights in use.

    Args:
        names: Names of the features.
        new: Those that are new or defined anew.
    """
    mean = np.array([getattr(DEFAULT.decide, name) for name in names])
    sd = np.where(np.isin(names, list(new)), NEW_WEIGHT_SD, WEIGHT_SD)
    return WeightPrior(DEFAULT.decide.intercept, mean, sd)


def fit_weights(X: Array, right: Array, prior: WeightPrior) -> tuple[float, Array]:
    """Return the intercept and the weights (F,) of the most probable logistic regression.

    Args:
        X: Features (N, F).
        right: Outcomes (N,), 0 or 1.
        prior: Prior of the weights; that of the intercept has the sd of weights in use.
    """
    sd = X.std(axis=0)
    sd[sd == 0.0] = 1.0
    centre = np.append(prior.intercept, prior.mean * sd)
    spread = np.append(WEIGHT_SD, prior.sd)
    Z = np.column_stack([np.ones(len(X)), X / sd])

    def loss(w: Array) -> tuple[float, Array]:
        odds = Z @ w
        change = (w - centre) / spread
        value = np.sum(np.logaddexp(0.0, odds) - right * odds) + 0.5 * np.sum(change**2)
        return float(value), Z.T @ (expit(odds) - right) + change / spread

    w = minimize(loss, centre, jac=True, method="L-BFGS-B", options={"maxiter": 10_000}).x
    return float(w[0]), w[1:] / sd


def fit_intercept(odds: Array, right: Array) -> float:
    """Return the most probable intercept of a logistic regression with given weights.

    Args:
        odds: Weighted sums of the features (N,).
        right: Outcomes (N,), 0 or 1.
    """

    def loss(intercept: float) -> float:
        return float(np.sum(np.logaddexp(0.0, odds + intercept) - right * (odds + intercept)))

    return float(minimize_scalar(loss).x)


class LogOddsScale(NamedTuple):
    """Regression of right names on their log odds in use: 1, 0 and 0 if these are calibrated."""

    slope: float
    intercept: float
    beside_unknown: float  # further log odds of names beside an unknown cause


def fit_scale(odds: Array, beside: Array, right: Array) -> LogOddsScale:
    """Return the most probable scale of log odds.

    Args:
        odds: Log odds in use (N,).
        beside: Whether there is an unknown cause beside the effect (N,), 0 or 1.
        right: Outcomes (N,), 0 or 1.
    """
    Z = np.column_stack([odds, np.ones(len(odds)), beside])
    sign = np.where(right > 0.0, -1.0, 1.0)

    def loss(w: Array) -> float:
        return float(np.sum(np.logaddexp(0.0, sign * (Z @ w))))

    return LogOddsScale(*map(float, minimize(loss, np.array([1.0, 0.0, 0.0])).x))


def beside_unknown_causes(records: Sequence[Record]) -> Array:
    """Return whether each example has an unknown cause beside it (N,), 0 or 1.

    Args:
        records: Records of the campaign, in the order of the examples.
    """
    found = []
    for record in records:
        beside = record["unknown"]["flag"] and not record["signs"]["log"].get("estimated")
        for effect in record["signs"]["effects"]:
            if not effect["refines"]:
                found.append(float(beside))
    return np.array(found)


def cross_validated(X: Array, right: Array, trials: Array, prior: WeightPrior) -> Array:
    """Return probabilities (N,), each from weights that were fitted to other trials."""
    found = np.zeros(len(X))
    for fold in range(FOLDS):
        inside = trials % FOLDS == fold
        intercept, weights = fit_weights(X[~inside], right[~inside], prior)
        found[inside] = expit(intercept + X[inside] @ weights)
    return found


def print_weights(records: Sequence[Record], new: Collection[str] = ()) -> None:
    """Print the settings of the decide stage, and their cross-validated likelihood.

    Args:
        records: Records of the campaign.
        new: Names of features that are new or defined anew.
    """
    names, X, right, trials = examples(records)
    prior = weight_prior(names, new)
    intercept, weights = fit_weights(X, right, prior)
    print(f"{len(right)} identified effects, {right.mean():.3f} right")
    print(f"intercept with the weights in use {fit_intercept(X @ prior.mean, right):.3g}")
    # owners' records do not state whether a cause was unknown
    known = [record for record in records if "unknown" in record]
    _, own, outcomes, _ = examples(known)
    beside = beside_unknown_causes(known)
    odds = prior.intercept + own @ prior.mean + DEFAULT.decide.odds_beside_unknown * beside
    scale = fit_scale(odds, beside, outcomes)
    print(
        f"scale of the log odds in use: slope {scale.slope:.2f}, intercept {scale.intercept:.2f}, "
        f"beside an unknown cause {scale.beside_unknown:.2f}"
    )
    probabilities = np.clip(cross_validated(X, right, trials, prior), 1e-9, 1.0 - 1e-9)
    log_loss = -np.mean(np.log(np.where(right > 0, probabilities, 1.0 - probabilities)))
    print(f"cross-validated log loss {log_loss:.3f}")
    print(f"intercept {intercept:.3g}")
    for name, weight in zip(names, weights, strict=True):
        print(f"{name} {weight:.3g}")
