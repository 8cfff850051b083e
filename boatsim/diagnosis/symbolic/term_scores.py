"""How much each term would gain beside a fit, by the force that the fit leaves over: quick, and good enough to choose.

A term's coefficient has a prior about nothing as wide as that of a steady force, over the rows in which it acts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import axes_of
from boatsim.diagnosis.locate.smoothing import LatentForce, separate_information
from boatsim.diagnosis.problem import froude_scale
from boatsim.diagnosis.symbolic.term_forces import Way
from boatsim.physics.base import AXES, Array
from boatsim.physics.described_laws import Described
from boatsim.physics.effects.described_thrust import DescribedThrust
from boatsim.physics.effects.push import SteadyForce
from boatsim.physics.terms import SPEEDS
from boatsim.physics.vessel import Vessel

STEADY = {
    axis: about.spread for axis, about in SteadyForce.params().items() if about.fit
}  # [N, N m] on a 1.2 m boat
FORCE = STEADY | {"heave": STEADY["sway"], "pitch": STEADY["yaw"]}
SHARE = DescribedThrust.params()["coefficient"].spread  # of the thrust
AT_ONCE = 200  # terms: more would not fit into a processor's cache


@dataclass(frozen=True)
class Weighed:
    """A term with what it promises."""

    term: Described
    gain: float  # [nats] that it would gain, the freedom of its coefficient paid for
    coefficient: float  # that it would have,
    spread: float  # and its prior sd


def weighed(ways: Sequence[Way], terms: Sequence[Described]) -> list[Weighed]:
    """Each term by itself on top of the fit, the best first; those that never act are left out."""
    found: list[Weighed] = []
    for first in range(0, len(terms), AT_ONCE):
        found += _batch(ways, terms[first : first + AT_ONCE])
    return sorted(found, key=lambda w: -w.gain)


def _batch(ways: Sequence[Way], terms: Sequence[Described]) -> list[Weighed]:
    known, score = np.zeros(len(terms)), np.zeros(len(terms))
    squares, rows = np.zeros(len(terms)), np.zeros(len(terms))
    for way in ways:
        with np.errstate(over="ignore"):
            shapes = np.stack([way.along(t) for t in terms], axis=2)
            sizes = np.stack(
                [
                    way.size(t) if t.run in ("", way.track.name) else 0.0 * way.track.times
                    for t in terms
                ]
            )
        squares += (sizes**2).sum(axis=1)
        rows += (sizes != 0.0).sum(axis=1)
        nq, levels, on = way.problem.program.module.NQ, way.found.levels, way.on
        latent = slice(2 * nq, 3 * nq)
        force = LatentForce(
            way.track.times,
            np.hstack([way.states, way.left]),
            *way.smoother,
            latent,
            *way.track.latent_force_rms(way.values, on, levels),
            levels.time_constant,
        )
        learnt, slope = separate_information(shapes, force)
        known, score = known + learnt, score + slope
    out, vessel = [], ways[0].problem.program.vessel
    numbers = np.column_stack([known, score, squares, rows]).tolist()
    for term, (i, s, square, n) in zip(terms, numbers, strict=True):
        if not (np.isfinite(i) and i > 0.0 and square > 0.0):
            continue
        spread = strength(vessel, term) / float(np.sqrt(square / n))
        whole = i + spread**-2
        gain = 0.5 * s**2 / whole - 0.5 * float(np.log(whole * spread**2))
        out.append(Weighed(term, gain, s / whole, spread))
    return out


def strength(vessel: Vessel, term: Described) -> float:
    """Prior sd of what a term amounts to where it acts: a force [N], a moment [N m], or a share of the thrust."""
    if isinstance(term, DescribedThrust):
        return SHARE
    axis = str(getattr(term, "axis", ""))
    turning = axis in ("roll", "pitch", "yaw")
    return FORCE.get(axis, FORCE["surge"]) * froude_scale("N m" if turning else "N", vessel)


def varying(ways: Sequence[Way]) -> tuple[dict[str, Array], list[str]]:
    """Speeds through the water that vary along the recordings, of all rows, and actuators: by the names of factors."""
    vessel = ways[0].problem.program.vessel
    fields = dict(zip(AXES, ("ur", "vr", "wr", "p", "q", "r"), strict=True))
    names = dict(zip(AXES, SPEEDS, strict=True))
    speeds = {
        names[a]: np.concatenate([getattr(w.motion, fields[a]) for w in ways])
        for a in axes_of(vessel)
    }
    held = np.concatenate([w.held for w in ways], axis=1)
    moves = {n: x for n, x in speeds.items() if np.ptp(x) > 0.0}
    given = (*vessel.actuators, *vessel.sums)
    return moves, [a for a in given if np.ptp(held[vessel.described_signals.index(a)]) > 0.0]
