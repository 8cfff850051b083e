"""Candidates that are better values of numbers which the vessel file calls estimated."""

from collections.abc import Mapping, Sequence

from boatsim.physics.base import CoefficientRelease, Effect
from boatsim.physics.groups import without_group
from boatsim.physics.vessel import Vessel, sd_of_corrected_estimates

# Groups of numbers that an effect of the library has to supply. The other groups, such as damping,
# are coefficients of the vessel, which every fit refits: an effect changes the form of their law.
WITHOUT_COEFFICIENT = ("lag", "mass_centre")


def refining_candidates(
    vessel: Vessel, candidates: Sequence[str], effects: Mapping[str, Effect]
) -> frozenset[str]:
    """Return the candidates that only refine a number which the vessel file calls estimated.

    A load is none of them, because it refines the mass only up to a certain size, and an effect in
    one group of recordings is none, because a number of the vessel is the same in all of them.

    Args:
        vessel: The vessel with its table [estimated].
        candidates: Names of the candidates.
        effects: Effects by name, these candidates among them.
    """
    found = set()
    for name in candidates:
        effect = effects[name]
        refines = sd_of_corrected_estimates(effect, vessel, vessel.estimated) is not None
        if refines and not type(effect).adds_to and without_group(name) == name:
            found.add(name)
    return frozenset(found)


def candidates_for_absent_numbers(
    refining: frozenset[str], candidates: Sequence[str], effects: Mapping[str, Effect]
) -> tuple[str, ...]:
    """Return those refining candidates whose number the vessel model lacks, in their given order.

    Such numbers are lags, and the places of the mass centre and of the recorded positions.

    Args:
        refining: Candidates that refine an estimated number.
        candidates: Names of all candidates.
        effects: Effects by name, these candidates among them.
    """
    found = []
    for name in candidates:
        effect = effects[name]
        group = type(effect).refines
        absent = not group or group in WITHOUT_COEFFICIENT
        if name in refining and absent and not isinstance(effect, CoefficientRelease):
            found.append(name)
    return tuple(found)
