"""What is to be fitted: recordings on one program, the coefficients and suspects that are free, and a fit of them."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from difflib import get_close_matches
from typing import NamedTuple

import numpy as np

from boatsim.diagnosis import priors
from boatsim.diagnosis.command_range import excursion
from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.filter import BODY, MappedRecording, NoiseLevels
from boatsim.errors import BadInput
from boatsim.physics.base import Array, Channel, Effect, Param, Release, Wandering
from boatsim.physics.vessel import Vessel


@dataclass(frozen=True)
class FreeParameter:
    """A parameter to fit, and what it does to which numbers of a boat.

    A nuisance scales the run's own value: `relative` is true and its mean is 1. A release scales, shifts or sets
    several.
    """

    effect: str
    name: str
    at: tuple[int, ...]  # positions in a track's values
    mean: float
    sd: float
    low: float
    high: float
    relative: bool = False
    # moves the spectrum of a random force, not the expected motion: no gradient there
    searched: bool = False
    how: str = "sets"  # or "scales" or "shifts"
    weights: tuple[float, ...] = (1.0,)  # of a shift, one for each position

    def act(self, p: Array, x: float) -> None:
        """Put its value into a boat's numbers."""
        for at, weight in zip(self.at, self.weights, strict=True):
            p[at] = (
                p[at] * x
                if self.how == "scales"
                else p[at] + weight * x
                if self.how == "shifts"
                else x
            )


@dataclass(frozen=True)
class Fit:
    """A converged hypothesis."""

    effects: tuple[str, ...]  # candidates that act, in the order in which they were added
    free: tuple[FreeParameter, ...]
    theta: Array  # (F,) fitted values
    covariance: Array  # (F, F)
    levels: NoiseLevels
    evidence: float  # log of the Laplace evidence [nats]

    def value(self, effect: str, name: str) -> tuple[float, float]:
        """Fitted value and standard deviation of one parameter."""
        i = next(
            i
            for i, f in enumerate(self.free)
            if f.effect == effect and f.name == name and not f.relative
        )
        return float(self.theta[i]), float(np.sqrt(self.covariance[i, i]))


SIDES = {
    "port": -1,
    "middle": 0,
    "starboard": 1,
}  # parameters of a channel effect that belong to one side
MASS, LENGTH = 4.6, 1.2  # [kg], [m] the boat for which the effects state their priors
SYMBOLS = {
    "N": (1, 1, -2),
    "kg": (1, 0, 0),
    "m": (0, 1, 0),
    "s": (0, 0, 1),
    "rad": (0, 0, 0),
    "1": (0, 0, 0),
    "": (0, 0, 0),
}


def scale_of(unit: str, vessel: Vessel) -> float:
    """How much larger a quantity of this unit is on a vessel than on the reference boat, by Froude's law."""
    above, _, below = unit.partition("/")
    powers = np.zeros(3)
    for part, sign in ((above, 1), (below, -1)):
        for factor in part.split():
            symbol, _, power = factor.partition("^")
            powers += sign * int(power or 1) * np.array(SYMBOLS[symbol])
    length = vessel.length / LENGTH
    return float((vessel.body.mass / MASS) ** powers[0] * length ** (powers[1] + 0.5 * powers[2]))


def check_taken_up(vessel: Vessel, stated: Mapping[str, float], where: str) -> None:
    """Every stated uncertainty is one of coefficients that the vessel has. Raises BadInput."""
    params = [
        p for e in vessel.effects for p in type(e).params().values() if p.axis in ("", *vessel.dof)
    ]
    kinds = sorted({p.calibrates for p in params} - {""})
    for kind, sd in stated.items():
        if kind not in kinds:
            near = get_close_matches(kind, kinds, n=1, cutoff=0.5)
            raise BadInput(
                f"{where}: coefficient_uncertainty.{kind} = {sd:g}, but {vessel.name} has no coefficient of {kind}"
                f"{f'; did you mean {near[0]!r}' if near else ''}; allowed are {', '.join(kinds) or 'none'}"
            )


class _Acts(NamedTuple):
    at: tuple[int, ...]
    weights: tuple[float, ...]


class Problem:
    """Recordings, a program with all suspects compiled in, and what may be fitted."""

    def __init__(
        self,
        tracks: Sequence[MappedRecording],
        ambient: NoiseLevels,
        uncertainty: dict[str, float],
        horizon: float | None = None,
        config: DiagnosisConfig = DEFAULT,
    ) -> None:
        """`uncertainty` is the relative sd of coefficients by kind ("damping", "thrust", ...).

        `horizon` is the length [s] of the free runs by which it is judged, if not the usual one.
        """
        self.recordings, self.ambient, self.uncertainty = list(tracks), ambient, uncertainty
        self.program = tracks[0].program
        self.config = config
        self.horizon = horizon or priors.horizon(self.program.vessel)
        self.nuisances = self._nuisances()
        self.links = self._links()
        self.spreads: dict[
            str, float
        ] = {}  # prior sd of the coefficient of each law that the diagnosis describes

    def on(self, tracks: Sequence[MappedRecording]) -> "Problem":
        """The same question to other recordings."""
        other = copy(self)
        other.recordings = list(tracks)
        return other

    def parameters(self, effects: Sequence[str]) -> tuple[FreeParameter, ...]:
        """Coefficients of the nominal, then everything that the suspects let be fitted, in their order."""
        free = list(self.nuisances)
        candidates = {e.name: e for e in self.program.candidates}
        for effect in (candidates[n] for n in effects):
            for name, about in type(effect).params().items():
                axis_is_free = not about.axis or about.axis in self.program.vessel.dof
                if (
                    about.fit
                    and axis_is_free
                    and self._on_board(effect, name)
                    and (acts := self._acts(effect, name))
                ):
                    sd = self.spreads.get(effect.name, about.spread * self.scale(effect, name))
                    low, high = self._bounds(about)
                    free.append(
                        FreeParameter(
                            effect.name,
                            name,
                            acts.at,
                            about.absent,
                            sd,
                            low,
                            high,
                            False,
                            type(effect).random,
                            about.how,
                            acts.weights,
                        )
                    )
        return tuple(free)

    def values(self, track: MappedRecording, free: Sequence[FreeParameter], theta: Array) -> Array:
        """A run's numbers with the free ones put in."""
        p = track.values.copy()
        for f, x in zip(free, theta, strict=True):
            f.act(p, float(x))
        for to, source in self.links:
            p[to] = p[source]
        return p

    def _acts(self, effect: Effect, name: str) -> _Acts | None:
        """Where a parameter of a suspect acts: its own place, or the numbers of the vessel that it releases."""
        if not isinstance(effect, Release):
            return _Acts((self.program.index(effect.name, name),), (1.0,))
        changes = [c for c in effect.changes(self.program.vessel) if c.parameter == name]
        at = tuple(self.place(c.owner, c.key) for c in changes)
        return _Acts(at, tuple(c.weight for c in changes)) if at else None

    def place(self, owner: str, key: str) -> int:
        """Position in a track's values of an effect's parameter, or of a number of the "body"."""
        if owner == "body":
            return len(self.program.values()) + BODY.index(key)
        return self.program.index(owner, key)

    def likelihood(
        self,
        free: Sequence[FreeParameter],
        theta: Array,
        on: Array,
        levels: NoiseLevels,
        fresh: bool = True,
    ) -> float:
        """Log likelihood of all runs; not `fresh`: linearised where the last fresh one was, for other levels."""
        return sum(
            t.likelihood(self.values(t, free, theta), on, levels, fresh) for t in self.recordings
        )

    def whitened(
        self, free: Sequence[FreeParameter], theta: Array, on: Array, levels: NoiseLevels
    ) -> Array:
        """Whitened prediction errors of all runs with the gains of the last `likelihood`."""
        return np.concatenate(
            [t.whitened(self.values(t, free, theta), on, levels) for t in self.recordings]
        )

    def scale(self, effect: Effect, name: str) -> float:
        """How much larger a parameter may be than on the boat for which effects state their priors, by its unit.

        A threshold of thrust goes with the largest command given: that boat's full thrust is 1 N. What an instrument
        wanders by goes with its noise.
        """
        unit = type(effect).params()[name].unit
        if isinstance(effect, Wandering):
            noise = {"m": "position_sd_m", "rad": "heading_sd_rad"}
            return self.ambient.sensors[noise[unit]] if unit in noise else 1.0
        if (
            name in type(effect).thresholds
            and unit != "rad"
            and (largest := excursion(self.recordings, effect))
        ):
            return largest
        return scale_of(unit, self.program.vessel)

    def _bounds(self, about: Param) -> tuple[float, float]:
        """Between which values a parameter is sought: what a file may say, and what can be on a boat of this size."""
        low, high = (end * scale_of(about.unit, self.program.vessel) for end in about.within)
        return max(low, about.low), min(high, about.high)

    def _on_board(self, effect: Effect, parameter: str) -> bool:
        """Whether there is an actuator on the side to which a channel effect's parameter belongs, if it is of one."""
        if not isinstance(effect, Channel) or parameter not in SIDES:
            return True
        vessel = self.program.vessel
        return SIDES[parameter] in {vessel.side(name) for name in vessel.targets(effect)}

    @property
    def stiff(self) -> bool:
        """Whether the hull's quickest motion dies out within a sample of any run."""
        return any(t.stiff for t in self.recordings)

    def white(self) -> Array:
        """Whitened prediction errors of all runs, of the last pass."""
        return np.concatenate([t.white for t in self.recordings])

    def nominal(self) -> Fit:
        """Nothing fitted: the vessel as it is written."""
        free = self.nuisances
        return Fit(
            (), free, np.ones(len(free)), np.zeros((len(free), len(free))), self.ambient, -np.inf
        )

    def _nuisances(self) -> tuple[FreeParameter, ...]:
        """Coefficients of the vessel's own that are never known exactly; what several instances share is one."""
        vessel, shared = (
            self.program.vessel,
            defaultdict[tuple[str, str, float], list[tuple[str, int]]](list),
        )
        for effect in vessel.effects:
            for name, about in type(effect).params().items():
                sd = self.uncertainty.get(about.calibrates, 0.0)
                at = self.program.index(effect.name, name)
                used = self.recordings[0].values[at] != 0.0 and (
                    not about.axis or about.axis in vessel.dof
                )
                if about.calibrates and sd > 0 and used:
                    shared[type(effect).idea(), name, sd].append((effect.name, at))
        found = []
        for (idea, name, sd), places in shared.items():
            called, all_of = (
                idea if len(places) > 1 else places[0][0],
                tuple(at for _, at in places),
            )
            found.append(
                FreeParameter(
                    called,
                    name,
                    all_of,
                    1.0,
                    sd,
                    0.05,
                    20.0,
                    True,
                    False,
                    "scales",
                    (1.0,) * len(all_of),
                )
            )
        return tuple(found)

    def _links(self) -> list[tuple[int, int]]:
        """(to, from) in a track's values: what nobody stated follows the vessel's number, recalibrated or not."""
        links, on_board = [], {e.name for e in self.program.effects}
        for effect in self.program.effects:
            for name in sorted(effect.filled):
                source = (
                    type(effect).params()[name].follows.removesuffix("?").removeprefix("vessel.")
                )
                owner, _, key = source.partition(".")
                if owner in on_board or owner == "body":
                    links.append((self.program.index(effect.name, name), self.place(owner, key)))
        return links
