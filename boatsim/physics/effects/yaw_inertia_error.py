"""Moment of inertia in yaw that differs from its specified value, of a craft without water."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.base import CoefficientRelease
from boatsim.physics.param import factor_parameter


@dataclass(frozen=True)
class YawInertiaError(CoefficientRelease):
    """Moment of inertia in yaw that differs by a factor from its specified value.

    In water the added inertia is uncertain in the same way, which `added_mass_error` describes.
    """

    formula: ClassVar[str] = r"I_z = k \, I_z^0"
    symbols: ClassVar = {"factor": "k"}
    needs: ClassVar = ("surge", "yaw")
    required_facts: ClassVar = {"no_water": True}
    words: ClassVar[str] = "the moment of inertia in yaw differs from the specified one"
    refines: ClassVar[str] = "inertia"
    shown_by: ClassVar[str] = "turning on the spot, started and stopped sharply"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 3.3"
    )

    factor: float = factor_parameter(
        "body.yaw_inertia",
        words="moment of inertia in yaw over the specified one",
        spread=0.3,
        low=0.2,
        high=5.0,
        in_per_cent="the moment of inertia in yaw is {share} of the specified one",
    )
