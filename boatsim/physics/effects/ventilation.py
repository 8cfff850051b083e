"""Ventilation: loss of thrust of a propeller that comes near the surface of the water."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics.base import UNSET, Array, Boat, Force, Wrench, param, preset_effect
from boatsim.physics.effects.thruster import thrust_wrench_at_mount
from boatsim.physics.waves.elevation import elevation_at_hull
from boatsim.physics.waves.field import WaveField
from boatsim.physics.waves.sea_parameters import SeaParameters

# Fit of the thrust diminution factor beta = 1 - LOSS (1 - SLOPE h / R)^POWER. The three numbers are
# not verified: the texts of the works in `source` were not available. They agree with the limit of
# h / R = 1.3, where beta becomes 1, since 1.3 SLOPE = 1.
LOSS = 0.675  # loss of thrust of a propeller whose shaft lies at the surface
SLOPE = 0.769  # from an immersion of R / SLOPE = 1.3 R on no thrust is lost
POWER = 1.258


@njit(inline="always")
def thrust_diminution(immersion: float) -> float:
    """Return the thrust of a propeller near the surface over that of a deep one.

    Args:
        immersion: Depth of the shaft below the surface over the radius of the propeller, h / R.

    Returns:
        The factor beta: 1 from 1.3 on, 0 below -0.48.
    """
    above = 1.0 - SLOPE * immersion
    if above <= 0.0:
        return 1.0
    return max(1.0 - LOSS * above**POWER, 0.0)


@njit
def law(m: Any, q: Any, s: Any, t: Any, p: Array, first: Any) -> Wrench:
    """Return the thrust that one propeller lacks because it is near the surface.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    below = q.shaft_depth if q.shaft_depth > 0.0 else t.z
    upright = sin(m.phi) * t.y + cos(m.phi) * below
    immersion = m.z - sin(m.theta) * t.x + cos(m.theta) * upright
    immersion += elevation_at_hull(t.x, t.y, m, q, p, first)
    lost = min(q.loss * (1.0 - thrust_diminution(immersion / q.radius)), 1.0)
    return thrust_wrench_at_mount(-lost * t.gain * s.thrust, s, t)


@dataclass(frozen=True)
class Ventilation(SeaParameters, Force):
    """Loss of thrust of a propeller that heave, pitch, roll or a wave bring near the surface.

    dT = -min(loss (1 - beta), 1) T
    beta = 1 - 0.675 (1 - 0.769 h / R)^1.258  for h < 1.3 R, else 1

    beta is at least 0. The immersion h of the shaft at the mount (x, y) is z + z_s in upright
    attitude, with the heave z and the depth z_s of the shaft at rest, plus the elevation of the
    sea there. The factor contains the lost area of the disc and the loss of lift near the surface;
    a heavily loaded propeller draws air and loses more, `loss` > 1. The radius R of the
    propeller is rarely known: by default it is the largest that has full thrust at rest.

    The sea is that of `irregular_sea`: `spectrum`, `significant_height`, `modal_period`, `toward`
    and the other parameters have the same meaning. It must be that of the effect whose waves move
    the vessel. Without it, as in a diagnosis, the immersion is that below the still water.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} \Delta T &= -\min\left(s \left(1 - \beta\right), 1\right) g \, T, "
        r"\quad \beta = \begin{cases} 1 & h \ge 1.3 \, R \\ \max\left(1 - 0.675 \left(1 - 0.769 \, "
        r"\frac{h}{R}\right)^{1.258}, 0\right) & h < 1.3 \, R \end{cases} \\ h &= z - x \sin\theta "
        r"+ \left(y \sin\phi + z_s \cos\phi\right) \cos\theta + \eta(x, y, t) \end{aligned}"
    )
    symbols: ClassVar = {"loss": "s", "radius": "R", "shaft_depth": "z_s"}
    needs_one_of: ClassVar = ("heave", "pitch")
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "the propellers lose thrust when they come near the surface"
    shown_by: ClassVar[str] = "constant thrust while the boat pitches and heaves on still water"
    source: ClassVar[str] = (
        "K. Minsaas, O. M. Faltinsen, B. Persson, On the importance of added resistance, propeller "
        "immersion and propeller ventilation for large ships in a seaway, PRADS 1983; O. N. "
        "Smogeli, Control of Marine Propellers, PhD, NTNU 2006; the three numbers of the fit are "
        "not verified against these texts"
    )
    per_instance_of: ClassVar[str] = "thruster"
    sees_table: ClassVar[bool] = True
    law: ClassVar = law

    loss: float = param(
        0.0,
        low=0.0,
        high=5.0,
        unit="",
        words="loss of thrust over the published one",
        fit=True,
        spread=1.0,
        in_per_cent="the loss of thrust near the surface is {share} of the published one",
    )
    radius: float = param(
        UNSET,
        low=1e-4,
        high=20.0,
        unit="m",
        words="radius of the propellers; default: the largest with full thrust at rest, 0.769 "
        "times the depth of the shallowest shaft",
    )
    shaft_depth: float = param(
        UNSET,
        low=0.0,
        high=100.0,
        unit="m",
        words="depth of the shafts below the water at rest; 0: the mount of each thruster below "
        "the origin; default: 0, or the draught of the vessel if no mount is below the origin",
    )

    def table(self) -> tuple[float, ...]:
        """Return the table of a tabulated sea."""
        return self.sea_table()

    def wave_field(self) -> WaveField | None:
        """Return None: the waves belong to the effect that moves the vessel."""
        return None

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the depth of the shafts of a vessel, and the radius of its propellers.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: Some mounts are below the origin, others are not.
        """
        mounts = []
        for thruster in vessel.effects_of_type(type(self).per_instance_of):
            if not self.on or thruster.name in self.on:
                mounts.append(float(getattr(thruster, "z", 0.0)))
        depth = self.shaft_depth if self.has_value("shaft_depth") else 0.0
        if not self.has_value("shaft_depth") and max(mounts, default=0.0) <= 0.0:
            depth = vessel.draught
        least = depth or min(mounts, default=0.0)
        if not least > 0.0:
            raise BadInput(
                f"{vessel.name}: {self.name}: a mount at z = {least:g} m is not below the water; "
                "allowed are mounts with z > 0, or a shaft_depth"
            )
        return {"shaft_depth": depth, "radius": SLOPE * least}


DriveVentilation = preset_effect(
    Ventilation,
    "DriveVentilation",
    words="one propeller alone loses thrust when it comes near the surface",
    shown_by="constant thrust of this drive alone while the boat pitches and heaves on still water",
    once_per="thruster",
    tried_last=True,
    of_all=("ventilation",),
    frees={
        "loss": {
            "words": "loss of thrust of this propeller over the published one",
        },
    },
)
