"""Variation between episodes: loads, parameters of effects, and the uncertainty of a diagnosis."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.learn.backends import Boats, World
from boatsim.learn.distributions import Draw, draw
from boatsim.physics import vessel as vessels
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.param import Param
from boatsim.physics.signals import Array
from boatsim.physics.spread import Spread
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import BODY

Vary = Mapping[str, str | float | Sequence[str]]
LOAD = "load"


class Variation:
    """Vessels of all loads, and the parameters that are sampled when an episode starts."""

    def __init__(
        self, boats: Sequence[Vessel], draws: Sequence[Draw], spread: Spread | None
    ) -> None:
        self.boats, self.draws, self.spread = list(boats), list(draws), spread
        self._about = {d.key: _about(self.boats[0], d.key) for d in self.draws}

    @property
    def shares(self) -> int:
        """Number of random numbers that an episode needs."""
        return 1 + len(self.draws) + (len(self.spread.sd) if self.spread else 0)

    def begin(self, world: World, lots: Array, some: Boats) -> Array:
        """Make boats `some` (k,) of a world anew from numbers drawn by lot (k, `shares`); which of `boats` each is."""
        which = np.minimum((lots[:, 0] * len(self.boats)).astype(np.int64), len(self.boats) - 1)
        world.assign(which, some)
        if self.spread is not None:
            for name, change in self.spread.sample(lots[:, 1 + len(self.draws) :]).items():
                about = _about(self.boats[0], name)
                value = world.get(name)[some] * change.factor + change.shift
                world.set(name, np.clip(value, about.low, about.high), some)
        for k, one in enumerate(self.draws, 1):
            about = self._about[one.key]
            world.set(one.key, np.clip(one.at(lots[:, k]), about.low, about.high), some)
        return which


def variation(
    vessel: str,
    load: Sequence[str] = (),
    effects: Sequence[Mapping[str, object]] = (),
    vary: Vary | None = None,
    settings: Mapping[str, Mapping[str, object]] | None = None,
) -> Variation:
    """Variation of a vessel. `vary` says of "effect.number" a distribution, or the number that it is; of "load" a list.

    An effect that the vessel lacks is added with its defaults. What a diagnosis found of the vessel (`[spread]` of a
    patched.toml) is drawn too, unless `vary` has `"spread" = 0`. Raises BadInput.
    """
    said = dict(vary or {})
    loads = said.pop(LOAD, None)
    wide = said.pop("spread", 1.0)
    if isinstance(loads, str) or (loads is not None and not isinstance(loads, Sequence)):
        raise BadInput(
            f'vary load = {loads!r}; allowed is a list such as ["light, narrow", "heavy, wide"]'
        )
    if not isinstance(wide, int | float) or wide < 0.0:
        raise BadInput(
            f"vary spread = {wide!r}; allowed is a factor of the diagnosis' spread, 0 for none"
        )
    extra = [*effects, *({"use": name} for name in _lacking(vessel, load, effects, said))]
    boats = [
        vessels.load(vessel, _parted(one), settings, extra) for one in loads or [", ".join(load)]
    ]
    held = {key: float(x) for key, x in said.items() if isinstance(x, int | float)}
    boats = [_having(boat, held) for boat in boats]
    draws = [draw(key, str(law)) for key, law in said.items() if key not in held]
    spread = boats[0].spread
    return Variation(
        boats, draws, spread.scaled(wide) if spread is not None and wide > 0.0 else None
    )


def _parted(loads: str) -> list[str]:
    return [one.strip() for one in loads.split(",") if one.strip()]


def _lacking(
    vessel: str,
    load: Sequence[str],
    effects: Sequence[Mapping[str, object]],
    said: Mapping[str, object],
) -> list[str]:
    """Effects that vary and that the vessel lacks."""
    own = vessels.load(vessel, list(load), extra=list(effects))
    ideas = dict.fromkeys(key.partition(".")[0] for key in said if key not in BODY)
    return [idea for idea in ideas if own.effect(idea) is None]


def _having(boat: Vessel, held: Mapping[str, float]) -> Vessel:
    """The vessel with other parameter values."""
    for key, x in held.items():
        if key in BODY:
            about = BODY[key][1]
            if not about.low <= x <= about.high:
                raise BadInput(
                    f"vary {key} = {x:g}; allowed {about.low:g} to {about.high:g} {about.unit}"
                )
            boat = replace(boat, body=boat.body.model_copy(update={key.partition(".")[2]: x}))
            continue
        owner, name = _owner(boat, key)
        effects = [e.having({name: x}) if e is owner else e for e in boat.effects]
        boat = replace(boat, effects=tuple(effects))
    return boat


def _owner(boat: Vessel, key: str) -> tuple[Effect, str]:
    """The effect of "effect.number". Raises BadInput."""
    idea, _, name = key.partition(".")
    effect = boat.effect(idea)
    if effect is None:
        raise BadInput(
            unknown_name(f"vary: {boat.name}: effect", idea, [e.name for e in boat.effects])
        )
    if name not in type(effect).params():
        raise BadInput(unknown_name(f"vary: {idea}: number", name, type(effect).params()))
    return effect, name


def _about(boat: Vessel, key: str) -> Param:
    if key in BODY:
        return BODY[key][1]
    effect, name = _owner(boat, key)
    return type(effect).params()[name]
