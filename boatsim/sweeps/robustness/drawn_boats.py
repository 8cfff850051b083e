"""Boats of a robustness benchmark: a vessel whose coefficients are drawn at random.

Each uncertain coefficient is multiplied by a lognormal factor of median 1. Its relative standard
deviation is that of the vessel file (table [estimated]), or else one of SPREADS. A vessel that a
diagnosis has fitted is sampled from the joint uncertainty of the fit instead (table [spread]).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import log1p, sqrt

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.learn.distributions import SampledParameter
from boatsim.physics.content import load_class
from boatsim.physics.param import Param
from boatsim.physics.signals import Array
from boatsim.physics.spread import FittedUncertainty
from boatsim.physics.vessel import Vessel, estimated_number_sd
from boatsim.simulate.batch import BODY, Batch

# Relative standard deviation of a coefficient by its kind, for a boat of which only the main
# particulars are known: what is usual between rules of thumb, regressions and measurements.
SPREADS = {"damping": 0.4, "added_mass": 0.4, "thrust": 0.3}
BODY_SPREADS = {"body.mass": 0.1, "body.yaw_inertia": 0.3}  # load not weighed; radius of gyration
DRIVE_SPREAD = 0.05  # between equal drives of one boat: tolerance of propellers and motors


@dataclass(frozen=True)
class DrawnBoats:
    """Random boats of one vessel and the random numbers of their disturbances.

    Attributes:
        vessel: The vessel, with the effects by which disturbances act.
        coefficients: Values (n,) of the drawn coefficients by "effect.parameter".
        directions: Directions (n,) to which wind and waves run [rad].
        wind_levers: Levers (n,) of the wind's side force ahead of the origin, in lengths.
        lost_drives: Shares (n,) from 0 to 1 that choose the drive which a boat loses.
        seed: Random seed of the draws and of the sensor noise.
    """

    vessel: Vessel
    coefficients: Mapping[str, Array]
    directions: Array
    wind_levers: Array
    lost_drives: Array
    seed: int

    def __len__(self) -> int:
        return len(self.directions)

    def value(self, key: str) -> Array:
        """Return the values (n,) of a parameter before any disturbance.

        Args:
            key: "effect.parameter".
        """
        if key in self.coefficients:
            return self.coefficients[key]
        return np.full(len(self), specified_value(self.vessel, key))

    def assign_to(self, batch: Batch) -> None:
        """Set the drawn coefficients of all boats of a batch.

        Args:
            batch: Batch of as many boats.
        """
        for key, values in self.coefficients.items():
            batch.set(key, values)


WIND_LEVER = 0.1  # [L] largest lever of the wind's side force (Fossen 2021, section 10.1)


def draw_boats(
    vessel: Vessel,
    count: int,
    seed: int,
    sampled: Sequence[SampledParameter] = (),
    spread: float = 1.0,
) -> DrawnBoats:
    """Draw the boats of a robustness benchmark.

    Args:
        vessel: The vessel.
        count: Number of boats.
        seed: Random seed.
        sampled: Parameters with distributions of the user, which replace the usual draws.
        spread: Factor of the standard deviations of the usual draws; 0 for the numbers of the
            vessel file.

    Returns:
        The boats. The first boats are the same for every number of boats and disturbances.

    Raises:
        BadInput: A parameter of the user does not exist.
    """
    random = [np.random.default_rng([seed, boat]) for boat in range(count)]
    around = np.array([generator.uniform(size=3) for generator in random])
    coefficients: dict[str, Array] = {}
    if vessel.spread is not None and spread > 0.0:
        width = len(vessel.spread.sd)
        shares = np.array([generator.uniform(size=width) for generator in random])
        coefficients = _fitted_coefficients(vessel, vessel.spread.with_scaled_sd(spread), shares)
    elif spread > 0.0:
        coefficients = _unknown_coefficients(vessel, random, spread)
    shares = np.array([generator.uniform(size=len(sampled)) for generator in random])
    for column, one in enumerate(sampled):
        definition = parameter_definition(vessel, one.key)
        values = one.quantiles(shares[:, column])
        coefficients[one.key] = np.clip(values, definition.low, definition.high)
    return DrawnBoats(
        vessel,
        coefficients,
        2.0 * np.pi * around[:, 0] - np.pi,
        WIND_LEVER * (2.0 * around[:, 1] - 1.0),
        around[:, 2],
        seed,
    )


def drive_gains(vessel: Vessel) -> list[str]:
    """Return the parameters that scale the thrust of each drive, as "effect.parameter".

    Args:
        vessel: The vessel.
    """
    release = load_class("effect", "thrust_gain_error")()
    return [f"{change.owner}.{change.key}" for change in release.changes(vessel)]


def parameter_definition(vessel: Vessel, key: str) -> Param:
    """Return unit and bounds of a parameter of a vessel.

    Args:
        vessel: The vessel.
        key: "effect.parameter", or "body.mass".

    Raises:
        BadInput: The vessel has no such parameter.
    """
    if key in BODY:
        return BODY[key][1]
    owner, _, name = key.partition(".")
    effect = vessel.effect(owner)
    if effect is None or name not in type(effect).params():
        known = []
        for one in vessel.effects:
            for parameter in type(one).params():
                known.append(f"{one.name}.{parameter}")
        raise BadInput(unknown_name_message(f"{vessel.name}: parameter", key, [*known, *BODY]))
    return type(effect).params()[name]


def specified_value(vessel: Vessel, key: str) -> float:
    """Return the value of a parameter in the vessel file.

    Args:
        vessel: The vessel.
        key: "effect.parameter", or "body.mass".
    """
    owner, _, name = key.partition(".")
    if owner == "body":
        return float(getattr(vessel.body, name))
    effect = vessel.effect(owner)
    assert effect is not None
    return float(getattr(effect, name))


def describe_draws(boats: DrawnBoats) -> list[tuple[str, str]]:
    """Return each drawn coefficient with its 5 to 95 % range over the boats, for a report.

    Args:
        boats: The boats.
    """
    lines = []
    for key, values in boats.coefficients.items():
        low, high = np.quantile(values, (0.05, 0.95))
        unit = parameter_definition(boats.vessel, key).unit
        lines.append((key, f"{low:.3g} to {high:.3g} {unit}".rstrip()))
    return lines


def _fitted_coefficients(
    vessel: Vessel, uncertainty: FittedUncertainty, shares: Array
) -> dict[str, Array]:
    """Coefficients drawn from the joint uncertainty of a diagnosis."""
    found: dict[str, Array] = {}
    for key, change in uncertainty.sample_changes(shares).items():
        definition = parameter_definition(vessel, key)
        values = specified_value(vessel, key) * change.factor + change.shift
        found[key] = np.clip(values, definition.low, definition.high)
    return found


def _unknown_coefficients(
    vessel: Vessel, random: Sequence[np.random.Generator], spread: float
) -> dict[str, Array]:
    """Coefficients of boats of which only the main particulars are known."""
    spreads = dict(_spreads(vessel))
    gains = drive_gains(vessel)
    common = "every drive"
    if gains:
        spreads[common] = _thrust_spread(vessel, gains)
    normal = np.array([generator.standard_normal(len(spreads)) for generator in random])
    factors: dict[str, Array] = {}
    for column, (key, sd) in enumerate(spreads.items()):
        factors[key] = _lognormal_factors(normal[:, column], spread * sd)
    if gains:
        strength = factors.pop(common)
        for key in gains:
            factors[key] = factors[key] * strength
    found = {}
    for key, factor in factors.items():
        definition = parameter_definition(vessel, key)
        values = specified_value(vessel, key) * factor
        found[key] = np.clip(values, definition.low, definition.high)
    return found


def _lognormal_factors(normal: Array, sd: float) -> Array:
    """Lognormal factors of median 1 from standard normal numbers, for a relative sd."""
    return np.asarray(np.exp(sqrt(log1p(sd * sd)) * normal))


def _spreads(vessel: Vessel) -> Iterable[tuple[str, float]]:
    """Each uncertain number of a vessel that is not zero, with its relative sd."""
    gains = drive_gains(vessel)
    for key, sd in BODY_SPREADS.items():
        if key != "body.yaw_inertia" or "yaw" in vessel.dof:
            yield key, _specified_spread(vessel, key, sd)
    for effect in vessel.effects:
        for name, definition in type(effect).params().items():
            key = f"{effect.name}.{name}"
            if key in gains:
                yield key, DRIVE_SPREAD
            elif definition.calibrates in SPREADS and specified_value(vessel, key) != 0.0:
                yield key, _specified_spread(vessel, key, SPREADS[definition.calibrates])


def _thrust_spread(vessel: Vessel, gains: Sequence[str]) -> float:
    return _specified_spread(vessel, gains[0], SPREADS["thrust"])


def _specified_spread(vessel: Vessel, key: str, otherwise: float) -> float:
    """Relative sd of a number in the table [estimated] of the vessel file, or another one."""
    owner, _, name = key.partition(".")
    sd = estimated_number_sd(owner, name, vessel, vessel.estimated)
    if sd is None:
        return otherwise
    return sd
