"""Shared supply: a drive gives less thrust while others load the same battery, engine or intake."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param
from boatsim.physics.drive_ranges import drive_ranges
from boatsim.physics.effects.thruster import thrust_wrench_at_mount

# A diagnosis tests the effect from this number of drives on. Two drives that load each other look
# like drives with another thrust curve wherever both are used alike, as on every straight run.
FEWEST_DRIVES = 3


@njit(inline="always")
def influence(q: Any, s: Any, t: Any, s2: Any, t2: Any) -> float:
    """Return the load of another drive on the supply, as a share of full load of all others.

    Args:
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster that loses thrust.
        t: Parameters of that thruster.
        s2: Signals of the other thruster.
        t2: Parameters of the other thruster.
    """
    return float(abs(t2.gain * s2.thrust) / q.full_others)


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any, total: float) -> Wrench:
    """Return the thrust that one thruster loses by the load of the others on their common supply.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.
        total: Load of the other thrusters, as a share of their full load.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    lost = min(q.loss * total, 1.0)
    return thrust_wrench_at_mount(-lost * t.gain * s.thrust, s, t)


@dataclass(frozen=True)
class SharedSupply(Force):
    """Loss of thrust in proportion to the thrust of the other drives on the same supply.

    T_i = T_i0 (1 - min(loss sum_j |T_j| / T_others, 1))

    The supply is a battery whose voltage falls with the total load, an engine, or an intake of
    fans. The sum is over the other drives only, because a thrust curve measured with one drive at a
    time contains its own share. T_others is the full thrust of all drives but an average one: a
    load in newtons then costs each drive the same share, and `loss` is reached when all others give
    full thrust. The proportionality is a simple assumption. `on` names the drives that share the
    supply; without it all do.
    """

    formula: ClassVar[str] = (
        r"\Delta T_i = -T_i \min\left(k \sum_{j \ne i} \frac{|T_j|}{T_o}, 1\right), \quad "
        r"T_o = \frac{n - 1}{n} "
        r"\sum_j T_{j,\mathrm{full}}"
    )
    symbols: ClassVar = {"loss": "k", "full_others": "T_o"}
    words: ClassVar[str] = "drives give less thrust while other drives load the same supply"
    shown_by: ClassVar[str] = "one drive alone at a constant command, then others added to it"
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law
    influence: ClassVar = influence

    loss: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        words="share of the thrust lost while all other drives give full thrust",
        fit=True,
        spread=0.2,
        in_per_cent="with all other drives at full thrust a drive loses {share} of its thrust",
    )
    full_others: float = param(
        UNSET,
        low=1e-6,
        high=1e9,
        unit="N",
        words="full thrust of the other drives together; from their largest commands if omitted",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the full thrust [N] of all drives on the supply but an average one.

        Args:
            vessel: Vessel on which the effect acts.
        """
        full = [drive.full for drive in drive_ranges(self, vessel)]
        others = sum(full) * (len(full) - 1) / max(len(full), 1)
        return {"full_others": others or 1.0}

    def missing_for_test(self, vessel: Boat) -> str:
        """Return that there are too few drives to tell their loads apart, if so; else "".

        Args:
            vessel: Vessel on which the effect acts.
        """
        if len(vessel.host_effects(self)) < FEWEST_DRIVES:
            return f"fewer than {FEWEST_DRIVES} drives that could share a supply"
        return ""
