"""Release effects: numbers of a vessel that may differ from their specified values."""

from dataclasses import dataclass
from typing import NamedTuple, Self

from boatsim.physics.kinds.effect import Boat, Effect


class CoefficientChange(NamedTuple):
    """Change of one number of a vessel (such as its mass) by a parameter of another effect.

    The parameter, of a `CoefficientRelease`, replaces the number, multiplies it or is added to it.
    """

    parameter: str  # parameter of the release
    owner: str  # effect of the vessel, or "body"
    key: str
    how: str  # "sets", "scales" or "shifts"
    weight: float  # factor of a shift

    def changed_value(self, stated: float, value: float) -> float:
        """Return the changed value of a vessel's number: replaced, scaled or shifted.

        Args:
            stated: Value of the number as specified in the vessel file.
            value: Value of the parameter that changes it.
        """
        if self.how == "scales":
            return stated * value
        if self.how == "shifts":
            return stated + self.weight * value
        return value


def _existing_places(places: str, vessel: Boat) -> list[str]:
    """Return the first of the equivalent places `a.key|b.key` that the vessel has."""
    for place in places.split("|"):
        owner = place.partition(".")[0]
        if owner == "body" or vessel.names_of(owner):
            return [place]
    return []


@dataclass(frozen=True)
class CoefficientRelease(Effect):
    """Hypothesis that numbers of the vessel, such as its damping, differ from specified values.

    It has no law; the vessel's own effects use the changed numbers. Each parameter lists in
    `releases` the numbers that it changes; those that the vessel does not have are omitted. In a
    vessel or scenario file a release changes them directly, in a diagnosis they are fitted, and a
    patched file contains the changed values.
    """

    def changes(self, vessel: Boat) -> list[CoefficientChange]:
        """Return which numbers of the vessel each parameter of this hypothesis changes, and how.

        Numbers that the vessel does not have are omitted.

        Args:
            vessel: Vessel on which the effect acts.
        """
        found, weights = [], self.changes_per_unit(vessel)
        for name, about in type(self).params().items():
            for place in (p for places in about.releases for p in _existing_places(places, vessel)):
                owner, _, key = place.partition(".")
                instances = ["body"] if owner == "body" else vessel.names_of(owner)
                found += [
                    CoefficientChange(name, one, key, about.how, weights.get(place, 1.0))
                    for one in instances
                ]
        return found

    def changes_per_unit(self, vessel: Boat) -> dict[str, float]:
        """Return by how much each number of the vessel changes per unit of an additive parameter.

        Numbers that are not listed change by the parameter itself (weight 1). Empty unless a
        subclass defines other weights.

        Args:
            vessel: Vessel on which the effect acts.
        """
        return {}

    def with_all_parameters(self, vessel: Boat) -> Self:
        """Return a copy in which every parameter has a value; check that it applies to the vessel.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The vessel has none of the numbers that this hypothesis changes.
        """
        if not self.changes(vessel):
            places = (p for about in type(self).params().values() for p in about.releases)
            self.required_effect(
                vessel,
                " or ".join(dict.fromkeys(p.partition(".")[0] for p in next(places).split("|"))),
            )
        return super().with_all_parameters(vessel)
