"""Release: the suspicion that stated numbers of a vessel are off."""

from dataclasses import dataclass
from typing import NamedTuple, Self

from boatsim.physics.kinds.effect import Boat, Effect


class Change(NamedTuple):
    """What a parameter of a release does to one number of a vessel."""

    parameter: str  # of the release
    owner: str  # the vessel's effect, or "body"
    key: str
    how: str  # "sets", "scales" or "shifts"
    weight: float  # of a shift

    def of(self, stated: float, value: float) -> float:
        """The number in place of the stated one where the parameter has this value."""
        if self.how == "scales":
            return stated * value
        return stated + self.weight * value if self.how == "shifts" else value


def _there(places: str, vessel: Boat) -> list[str]:
    """Of places that say the same of different hulls, `a.key|b.key`, the first that the vessel has."""
    owners = ((place, place.partition(".")[0]) for place in places.split("|"))
    return [place for place, owner in owners if owner == "body" or vessel.names_of(owner)][:1]


@dataclass(frozen=True)
class Release(Effect):
    """A suspicion that stated numbers of the vessel are off: no law of its own, the vessel's own effects feel it.

    Each parameter names the numbers it `releases`; those the vessel does not have are left out. In a vessel or scenario
    file it changes them at once, in a diagnosis they are fitted, in a patched file they are written.
    """

    def changes(self, vessel: Boat) -> list[Change]:
        """What it does to the numbers that the vessel has."""
        found, weights = [], self.weights(vessel)
        for name, about in type(self).params().items():
            for place in (p for places in about.releases for p in _there(places, vessel)):
                owner, _, key = place.partition(".")
                instances = ["body"] if owner == "body" else vessel.names_of(owner)
                found += [
                    Change(name, one, key, about.how, weights.get(place, 1.0)) for one in instances
                ]
        return found

    def weights(self, vessel: Boat) -> dict[str, float]:
        """What a number is shifted by per shift of the parameter; 1 where it is not said."""
        return {}

    def completed(self, vessel: Boat) -> Self:
        """Raises BadInput where the vessel has none of the numbers."""
        if not self.changes(vessel):
            places = (p for about in type(self).params().values() for p in about.releases)
            self.needed(
                vessel,
                " or ".join(dict.fromkeys(p.partition(".")[0] for p in next(places).split("|"))),
            )
        return super().completed(vessel)
