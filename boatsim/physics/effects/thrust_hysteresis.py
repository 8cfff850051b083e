"""Thrust hysteresis: play between the command of a drive and what the drive follows."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.base import param, preset_effect
from boatsim.physics.effects.steering_backlash import SteeringBacklash


@dataclass(frozen=True)
class ThrustHysteresis(SteeringBacklash):
    """Play operator between the thrust command and the thrust that a drive aims at.

    y(t) = min(max(y(t-), x(t) - width / 2), x(t) + width / 2)

    The linkage of a throttle has play, and a motor controller that ignores small changes of its
    command acts alike. Rising commands give width / 2 less than specified, falling ones width / 2
    more, and a command that changes by less than the width may change nothing. `behind` sets the
    first thrust: 0 in the middle of the play, 1 as reached from zero.
    """

    ruled_out_by: ClassVar = {}
    words: ClassVar[str] = (
        "the thrust commands have play: rising commands give less thrust than falling ones"
    )
    shown_by: ClassVar[str] = "a staircase of thrust levels, up and down again"
    acts_on: ClassVar[str] = "thrust"
    either_side: ClassVar[bool] = False
    thresholds: ClassVar = {"width": (0.07, 0.3)}

    width: float = param(0.0, low=0.0, high=1e7, unit="N", words="total play", fit=True, spread=0.2)
    behind: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        fit=True,
        spread=0.5,
        words="position of the first thrust in the play: 0 middle, 1 as reached from zero",
    )


ShaftHysteresis = preset_effect(
    ThrustHysteresis,
    "ShaftHysteresis",
    words="the shaft commands have play: rising commands turn the shaft slower than falling ones",
    shown_by="a staircase of shaft rates, up and down again",
    acts_on="shaft",
    frees={
        "width": {
            "high": 1e4,
            "unit": "1/s",
            "words": "total play, in the unit of the command",
            "spread": 0.2,
        },
        "behind": {
            "spread": 0.5,
            "words": "position of the first shaft rate in the play: 0 middle, 1 as reached from "
            "zero",
        },
    },
)


DriveHysteresis = preset_effect(
    ThrustHysteresis,
    "DriveHysteresis",
    words="the commands of one drive have play: rising ones give less thrust than falling ones",
    shown_by="a staircase of thrust levels of this drive, up and down again",
    once_per="actuator",
    of_all=("thrust_hysteresis",),
    frees={
        "width": {"words": "total play of this drive", "spread": 0.2},
        "behind": {"spread": 0.5},
    },
)
