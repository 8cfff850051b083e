"""Variation between episodes: loads, parameters of effects, and the uncertainty of a diagnosis."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.learn.backends import Boats, World
from boatsim.learn.distributions import SampledParameter, make_sampled_parameter
from boatsim.physics import vessel as vessels
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.param import Param
from boatsim.physics.signals import Array
from boatsim.physics.spread import FittedUncertainty
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import BODY

Vary = Mapping[str, str | float | Sequence[str]]
LOAD = "load"


class Variation:
    """Random variation between episodes: vessels in all loads, and the sampled parameters."""

    def __init__(
        self,
        boats: Sequence[Vessel],
        sampled: Sequence[SampledParameter],
        spread: FittedUncertainty | None,
    ) -> None:
        """Create a variation.

        Args:
            boats: The vessel under each load.
            sampled: Parameters with their distributions.
            spread: Uncertainty that a diagnosis found; None for none.
        """
        self.boats = list(boats)
        self.sampled = list(sampled)
        self.spread = spread
        self._definitions: dict[str, Param] = {}
        for parameter in self.sampled:
            self._definitions[parameter.key] = _parameter_definition(self.boats[0], parameter.key)

    @property
    def random_number_count(self) -> int:
        """Number of uniform random numbers that determine the variation of one episode."""
        count = 1 + len(self.sampled)
        if self.spread:
            count += len(self.spread.sd)
        return count

    def sample_and_assign(self, world: World, uniforms: Array, boats: Boats) -> Array:
        """Sample vessels and effect parameters for new episodes and assign them to boats.

        Args:
            world: Simulator of the boats.
            uniforms: Uniform random numbers (k, `random_number_count`) between 0 and 1.
            boats: Numbers (k,) of the boats.

        Returns:
            Numbers (k,) of the assigned vessels.
        """
        last = len(self.boats) - 1
        which = np.minimum((uniforms[:, 0] * len(self.boats)).astype(np.int64), last)
        world.assign(which, boats)
        if self.spread is not None:
            changes = self.spread.sample_changes(uniforms[:, 1 + len(self.sampled) :])
            for name, change in changes.items():
                param = _parameter_definition(self.boats[0], name)
                value = world.get(name)[boats] * change.factor + change.shift
                world.set(name, np.clip(value, param.low, param.high), boats)
        for column, sampled in enumerate(self.sampled, 1):
            param = self._definitions[sampled.key]
            value = sampled.quantiles(uniforms[:, column])
            world.set(sampled.key, np.clip(value, param.low, param.high), boats)
        return which


def make_variation(
    vessel: str,
    load: Sequence[str] = (),
    effects: Sequence[Mapping[str, object]] = (),
    vary: Vary | None = None,
    settings: Mapping[str, Mapping[str, object]] | None = None,
) -> Variation:
    """Define what varies between episodes of a vessel: loads and effect parameters.

    The uncertainty that a diagnosis found (`[spread]` of a patched.toml) is sampled too, unless
    `vary` has `"spread" = 0`.

    Args:
        vessel: Name or path of the vessel.
        load: Load conditions.
        effects: Effects in addition to the vessel's, as `[[effect]]` tables.
        vary: "effect.parameter" with a distribution or a fixed value; "load" with a list, or with
            lists by the name of the vessel; "spread" with a factor. An effect that the vessel lacks
            is added with its defaults.
        settings: Values that replace those of the vessel file, per effect.

    Raises:
        BadInput: A name, distribution or value is wrong.
    """
    varied = dict(vary or {})
    loads = varied.pop(LOAD, None)
    if isinstance(loads, Mapping):  # load conditions belong to their own vessel
        loads = loads.get(vessel)
    factor = varied.pop("spread", 1.0)
    if isinstance(loads, str) or (loads is not None and not isinstance(loads, Sequence)):
        raise BadInput(
            f'vary load = {loads!r}; allowed is a list such as ["light, narrow", "heavy, wide"]'
        )
    if not isinstance(factor, int | float) or factor < 0.0:
        raise BadInput(
            f"vary spread = {factor!r}; allowed is a factor of the diagnosis' spread, 0 for none"
        )
    extra = [*effects]
    for name in _missing_effects(vessel, load, effects, varied):
        extra.append({"use": name})
    fixed = {key: float(x) for key, x in varied.items() if isinstance(x, int | float)}
    boats = []
    for conditions in loads or [", ".join(load)]:
        boat = vessels.load_vessel(vessel, _split_load(conditions), settings, extra)
        boats.append(_replace_parameters(boat, fixed))
    sampled = []
    for key, text in varied.items():
        if key not in fixed:
            sampled.append(make_sampled_parameter(key, str(text)))
    spread = boats[0].spread
    if spread is not None:
        spread = spread.with_scaled_sd(factor) if factor > 0.0 else None
    return Variation(boats, sampled, spread)


def _split_load(conditions: str) -> list[str]:
    return list(filter(None, map(str.strip, conditions.split(","))))


def _missing_effects(
    vessel: str,
    load: Sequence[str],
    effects: Sequence[Mapping[str, object]],
    varied: Mapping[str, object],
) -> list[str]:
    """Effects that vary and that the vessel lacks."""
    own = vessels.load_vessel(vessel, list(load), extra=list(effects))
    missing: dict[str, None] = {}
    for key in varied:
        name = key.partition(".")[0]
        if key not in BODY and own.effect(name) is None:
            missing[name] = None
    return list(missing)


def _replace_parameters(boat: Vessel, values: Mapping[str, float]) -> Vessel:
    """The vessel with other parameter values."""
    for key, value in values.items():
        if key in BODY:
            param = BODY[key][1]
            if not param.low <= value <= param.high:
                allowed = f"{param.low:g} to {param.high:g} {param.unit}"
                raise BadInput(f"vary {key} = {value:g}; allowed {allowed}")
            body = boat.body.model_copy(update={key.partition(".")[2]: value})
            boat = replace(boat, body=body)
            continue
        owner, name = _effect_and_parameter(boat, key)
        effects = list(boat.effects)
        for index, effect in enumerate(effects):
            if effect is owner:
                effects[index] = effect.with_values({name: value})
        boat = replace(boat, effects=tuple(effects))
    return boat


def _effect_and_parameter(boat: Vessel, key: str) -> tuple[Effect, str]:
    """The effect of "effect.parameter" and the name of the parameter."""
    owner, _, name = key.partition(".")
    effect = boat.effect(owner)
    if effect is None:
        names = [effect.name for effect in boat.effects]
        raise BadInput(unknown_name_message(f"vary: {boat.name}: effect", owner, names))
    params = type(effect).params()
    if name not in params:
        raise BadInput(unknown_name_message(f"vary: {owner}: number", name, params))
    return effect, name


def _parameter_definition(boat: Vessel, key: str) -> Param:
    """Unit and bounds of a parameter."""
    if key in BODY:
        return BODY[key][1]
    effect, name = _effect_and_parameter(boat, key)
    return type(effect).params()[name]
