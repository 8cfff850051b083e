"""Finite depth: added mass, damping and resistance in water of a known, constant depth."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Self

from boatsim.errors import BadInput
from boatsim.physics.base import UNSET, Boat, CoefficientChange, CoefficientRelease, param
from boatsim.physics.estimate.shallow_water import shallow_water_factor
from boatsim.physics.facts import DEPTH

# Numbers of a vessel of which the transverse flow below the keel is the cause
ACROSS = (
    "added_mass.sway",
    "added_mass.yaw",
    "linear_damping.sway",
    "linear_damping.yaw",
    "quadratic_damping.sway",
    "quadratic_damping.yaw",
    "cross_flow_drag.section_drag_coefficient",
    "cross_flow_drag.linear",
    "forward_speed_damping.sway",
    "forward_speed_damping.yaw",
    "mmg_hull.Y_v",
    "mmg_hull.N_r",
    "abkowitz_hull.Y_v",
    "abkowitz_hull.N_r",
)
# Its resistance in surge
ALONG = (
    "linear_damping.surge",
    "quadratic_damping.surge",
    "surge_drag.linear",
    "surge_drag.quadratic",
    "cross_flow_drag.surge_quadratic",
    "mmg_hull.R_0",
    "abkowitz_hull.X_u",
)
# Increase of the viscous resistance: coefficient and exponent of the ratio of draught to depth.
# They are not verified, since the text of Raven's report was not available. By the abstract of his
# paper of PRADS 2016 the method corrects each component of the resistance separately; this is the
# viscous one.
INCREASE, EXPONENT = 0.57, 1.79


def resistance_factor(draught: float, depth: float) -> float:
    """Return the viscous resistance in shallow water over that in deep water.

    It is 1 + 0.57 (T / h)^1.79, for depths above twice the draught and speeds at which the waves of
    the boat are those of deep water.

    Args:
        draught: Draught T [m].
        depth: Depth h of the water [m].
    """
    return float(1.0 + INCREASE * (draught / depth) ** EXPONENT)


@dataclass(frozen=True)
class FiniteDepth(CoefficientRelease):
    """Larger added mass, damping and resistance of the vessel in water of a known depth h.

    Numbers across the hull change by the factor 1 + share (k - 1) with k = -8 / pi^2 (h / T)^2 ln
    cos(pi T / (2 h)), the added mass of a plate across a channel; T is the draught. By slender-body
    theory the damping of sway and yaw is proportional to this added mass; that cross-flow drag
    grows alike is an assumption. Resistance in surge changes by 1 + share 0.57 (T / h)^1.79.
    `share` is 1 for theory, and 0 in deep water.

    The depth is constant, since a mass matrix is. Added mass in heave, the squat of the hull and
    the waves near the critical speed sqrt(g h) are not included. Of the hulls `mmg_hull` and
    `abkowitz_hull` only Y_v, N_r and the resistance change: their coupling derivatives N_v and Y_r,
    the added mass m_y of the MMG model and the masses of the Abkowitz model keep their values, so
    that the course stability of such a ship in shallow water is overestimated. A diagnosis tests
    it where the fact `water_depth_m` states the depth; where only the increase is known, use
    `shallow_water`.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} Y_i &= Y_i^0 \left(1 + s \, (k - 1)\right), \quad N_i = N_i^0 "
        r"\left(1 + s \, (k - 1)\right), \quad k = -\frac{8}{\pi^2} \frac{h^2}{T^2} \ln "
        r"\cos\frac{\pi T}{2 h} \\ X_i &= X_i^0 \left(1 + 0.57 \, s "
        r"\left(\frac{T}{h}\right)^{1.79}\right) \end{aligned}"
    )
    symbols: ClassVar = {"share": "s", "depth": "h"}
    needs: ClassVar = ("surge",)
    ruled_out_by: ClassVar = {"no_water": (True,)}
    of_surroundings: ClassVar[bool] = True
    words: ClassVar[str] = "the shallow water increases added mass, damping and resistance"
    shown_by: ClassVar[str] = "the same sway and turns in deep and in shallow water"
    source: ClassVar[str] = (
        "L. I. Sedov, Two-dimensional problems in hydrodynamics and aerodynamics, 1965: added "
        "mass; R. T. Jones, NACA report 835, 1946: damping by added mass; H. C. Raven, A "
        "correction method for shallow-water effects on ship speed trials, MARIN report "
        "98800-1-RD, 2022: resistance, its two numbers not verified against this text"
    )
    facts: ClassVar = {DEPTH: ("depth",)}

    share: float = param(
        1.0,
        low=0.0,
        high=20.0,
        unit="",
        words="share of the increase that theory gives for this depth",
        fit=True,
        spread=1.0,
        inactive_value=0.0,
        releases=(*ACROSS, *ALONG),
        how="shifts",
        in_per_cent="added mass and damping increase by {share} of what theory gives",
    )
    depth: float = param(
        UNSET, low=0.01, high=1e5, unit="m", words="depth of the water, more than the draught"
    )

    def changes(self, vessel: Boat) -> list[CoefficientChange]:
        """Return which numbers of the vessel depend on the depth, and their increase by theory.

        Args:
            vessel: Vessel on which the effect acts.
        """
        found = []
        factors = self._factors(vessel)
        for change in super().changes(vessel):
            owner = vessel.effect(change.owner)
            if owner is None or not owner.has_value(change.key) or not getattr(owner, change.key):
                continue
            number = f"{type(owner).type_name()}.{change.key}"
            increase = (factors[number] - 1.0) * getattr(owner, change.key)
            found.append(change._replace(weight=increase))
        return found

    def _factors(self, vessel: Boat) -> Mapping[str, float]:
        """Factors by theory on the numbers of a vessel; 1 while no depth is known."""
        across = along = 1.0
        if self.has_value("depth"):
            across = shallow_water_factor(vessel.draught, self.depth).value
            along = resistance_factor(vessel.draught, self.depth)
        return {**dict.fromkeys(ACROSS, across), **dict.fromkeys(ALONG, along)}

    def with_all_parameters(self, vessel: Boat) -> Self:
        """Return a copy in which every parameter has a value; check that the vessel is afloat.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The water is not deeper than the draught, its depth is not known, or the
                vessel has none of the numbers that depend on it.
        """
        if self.has_value("depth") and self.depth <= vessel.draught:
            raise BadInput(
                f"{vessel.name}: {self.name}.depth = {self.depth:g} m; allowed is more than the "
                f"draught of {vessel.draught:g} m"
            )
        return super().with_all_parameters(vessel)
