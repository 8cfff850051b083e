"""The table [estimated] of a vessel file: which numbers are estimates, and how uncertain they are.

A key is a group of numbers ("damping") or one number ("thrust_lag.time_constant", "body.mass"). A
number of an effect that the vessel does not have is an estimate, too: its absence is a guess.
"""

from collections.abc import Iterable, Mapping

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.kinds.effect import REFINED_GROUPS, Effect
from boatsim.physics.kinds.release import CoefficientRelease
from boatsim.physics.vessel.bindings import ChannelBindings
from boatsim.physics.vessel.schema import Body


def check_estimated_table(estimated: Iterable[str], vessel: ChannelBindings, label: str) -> None:
    """Check the keys of the table [estimated] of a vessel file.

    Each key must be a group of numbers ("damping") or one number of the vessel.

    Args:
        estimated: The table: key -> relative standard deviation.
        vessel: The vessel with its effects.
        label: Name of the file in messages.

    Raises:
        BadInput: One line with the key and the nearest valid name.
    """
    for key in estimated:
        owner, _, number = key.partition(".")
        if key in REFINED_GROUPS or number in _numbers_of(owner, vessel):
            continue
        allowed = [*REFINED_GROUPS]
        owners = ["body", *(effect.name for effect in vessel.effects)]
        if owner in shipped_content_names("effect"):
            owners.append(owner)
        if not number:
            owners = []  # a group was meant
        for one in dict.fromkeys(owners):
            allowed += map(f"{one}.{{}}".format, _numbers_of(one, vessel))
        raise BadInput(unknown_name_message(f"{label}: key in [estimated]", key, allowed))


def _numbers_of(owner: str, vessel: ChannelBindings) -> list[str]:
    """Numbers of the body, of an effect of the vessel, or of a type of effects."""
    if owner == "body":
        return list(Body.model_fields)
    effect = vessel.effect(owner)
    kind: type[Effect] | None = None
    if effect is not None:
        kind = type(effect)
    elif owner in shipped_content_names("effect"):
        kind = load_class("effect", owner)
    if kind is None:
        return []
    return list(kind.params())


def sd_of_corrected_estimates(
    effect: Effect, vessel: ChannelBindings, estimated: Mapping[str, float]
) -> float | None:
    """Return the relative standard deviation of the estimated numbers that an effect corrects.

    Args:
        effect: An effect that a diagnosis identified.
        vessel: The vessel that lacks it.
        estimated: Its table [estimated].

    Returns:
        The standard deviation; None if the vessel file does not call these numbers estimates, so
        that the effect is missing physics.
    """
    if isinstance(effect, CoefficientRelease):
        numbers = [
            estimated_number_sd(c.owner, c.key, vessel, estimated) for c in effect.changes(vessel)
        ]
        known = [sd for sd in numbers if sd is not None]
        if known and len(known) == len(numbers):
            return max(known)
    else:
        for name, param in type(effect).params().items():
            sd = estimated.get(f"{type(effect).type_name()}.{name}")
            if param.fit and sd is not None:
                return sd
        for number in type(effect).adds_to.values():
            owner, key = number.split(".")
            sd = estimated_number_sd(owner, key, vessel, estimated)
            if sd is not None:
                return sd
    return estimated.get(type(effect).refines)


def estimated_number_sd(
    owner: str, key: str, vessel: ChannelBindings, estimated: Mapping[str, float]
) -> float | None:
    """Return the relative standard deviation of one number of a vessel that is only an estimate.

    Args:
        owner: Name or type of an effect of the vessel, or "body".
        key: Name of the number.
        vessel: The vessel.
        estimated: Its table [estimated].

    Returns:
        The standard deviation; None if the vessel file does not call the number an estimate.
    """
    owners, groups = [owner], [""]
    for effect in vessel.effects:
        if owner in (effect.name, type(effect).type_name()):
            owners += [effect.name, type(effect).type_name()]
            groups.append(type(effect).params()[key].calibrates)
    for one in owners:
        if f"{one}.{key}" in estimated:
            return estimated[f"{one}.{key}"]
    return estimated.get(groups[-1])
