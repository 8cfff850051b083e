"""Whether what a fit leaves over has structure: a force that goes with a speed, a command, a place, a stretch of time.

A cause that the library has not may be weak beside the tolerated force and yet always the same. Each feature of the
motion is tried as a force along each axis; the p-value is corrected for how many were tried (Bonferroni).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy.special import chdtrc

from boatsim.diagnosis.filter import MappedRecording, axes_of
from boatsim.diagnosis.locate.smoothing import information_alone
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array

LIKELY = 0.01  # corrected p-value from which a force is said to go with something
FACTOR = 1.5  # of the tolerated force: what is left over is judged against this much
STRETCHES = 8  # parts of a run in which a force may act
SMALL = 1e-9  # of the largest information on an axis, below which a feature says nothing
CONSTANT, SINCE, WITHIN = (
    "nothing, it is constant",
    "the time since the beginning",
    "time: it acts in",
)
TURNING = ("roll", "pitch", "yaw")
PLACES = {
    "surge": "how far north or south she is",
    "sway": "how far east or west she is",
    "heave": "how deep she floats",
    "roll": "the roll angle",
    "pitch": "the trim",
}


@dataclass(frozen=True)
class Structure:
    """The feature that goes best with the force left over."""

    axis: str
    goes_with: str  # in words
    gain: float  # [nats] that a force along with it gains at most
    p_value: float  # corrected for all that were tried
    tried: int

    @property
    def a_law(self) -> bool:
        """Whether it goes with motion, commands or heading: not with a place or a time, nor with nothing at all."""
        return not self.goes_with.startswith((CONSTANT, SINCE, WITHIN, *PLACES.values()))

    @property
    def likely(self) -> bool:
        """Whether it is hardly there by chance."""
        return self.p_value < LIKELY


def structure(problem: Problem, found: Fit) -> Structure:
    """What the force that a fit leaves over goes with best, at no more than the tolerated force."""
    nq = problem.program.module.NQ
    levels = replace(
        found.levels, force=np.minimum(found.levels.force, FACTOR * problem.ambient.force)
    )
    on, latent = problem.program.switches(found.effects), slice(2 * nq, 3 * nq)
    known, score = dict[tuple[str, str], float](), dict[tuple[str, str], float]()
    axes = axes_of(problem.program.vessel)
    for track in problem.recordings:
        values = problem.values(track, found.free, found.theta)
        z, covariances, gains = track.smooth(values, on, levels)
        named = dict(features(track, np.ascontiguousarray(z[:, : 2 * nq]), levels.time_constant))
        shapes = np.einsum("na,kb->nkba", np.column_stack(list(named.values())), np.eye(nq))
        learnt, slope = information_alone(
            shapes.reshape(len(z), nq, -1),
            z[:, latent],
            track.times,
            covariances,
            gains,
            latent,
            *track.latent_force_rms(values, on, levels),
            levels.time_constant,
        )
        for key, i, s in zip(
            ((a, n) for a in axes for n in named), learnt.tolist(), slope.tolist(), strict=True
        ):
            known[key] = known.get(key, 0.0) + i
            score[key] = score.get(key, 0.0) + s
    largest = {a: max(i for (axis, _), i in known.items() if axis == a) for a in axes}
    gain = {k: 0.5 * score[k] ** 2 / i for k, i in known.items() if i > SMALL * largest[k[0]]}
    if not gain:
        return Structure(axes[0], CONSTANT, 0.0, 1.0, 0)
    axis, name = max(gain, key=lambda k: gain[k])
    best = gain[axis, name]
    return Structure(
        axis, name, best, min(1.0, len(gain) * float(chdtrc(1, 2.0 * best))), len(gain)
    )


def features(track: MappedRecording, states: Array, lasting: float) -> Iterator[tuple[str, Array]]:
    """What a force may go with: (words, (N,) values of size one); `states` (N, 2 NQ), `lasting` [s] of the water."""
    for name, values in _features(track, states, lasting):
        size = float(np.sqrt(np.mean(values**2)))
        if size > 0.0:
            yield name, values / size


def _features(track: MappedRecording, states: Array, lasting: float) -> Iterator[tuple[str, Array]]:
    axes, t = axes_of(track.program.vessel), track.times
    speeds = {
        f"{a} {'rate' if a in TURNING else 'speed'}": w
        for a, w in zip(axes, track.program.body_rates(states)[:, len(axes) :].T, strict=True)
    }
    yield CONSTANT, np.ones(len(t))
    for name, w in speeds.items():
        yield name, w
        yield f"the size of {name}", np.abs(w)
        yield f"the square of {name}", w * np.abs(w)
        yield f"the cube of {name}", w**3
    for (one, a), (other, b) in combinations(speeds.items(), 2):
        yield f"{one} times {other}", a * b
    for name, c in zip(track.program.vessel.commands, track.commands.T, strict=False):
        if np.ptp(c) > 0.0:
            yield name, c
            yield f"the size of {name}", np.abs(c)
            yield f"{name} as it was a while ago", _late(c, t, lasting)
            if "surge speed" in speeds:
                yield f"{name} times surge speed", c * speeds["surge speed"]
    if "yaw" in axes:
        psi = states[:, axes.index("yaw")]
        for what, angle in (("heading", psi), ("twice the heading", 2.0 * psi)):
            yield f"the cosine of {what}", np.cos(angle)
            yield f"the sine of {what}", np.sin(angle)
    for axis, place in PLACES.items():
        if axis in axes:
            off = states[:, axes.index(axis)] - states[:, axes.index(axis)].mean()
            yield place, off
            if axis in TURNING:  # a lopsided hull's arm is even in heel: no other feature here is
                yield f"{place} squared", off**2
                yield f"{place} cubed", off**3
    since = (t - t[0]) / (t[-1] - t[0])
    for run in (track.name, ""):
        of = f" of {run}" if run else ""
        yield f"{SINCE}{of}", since - 0.5
        for k in range(STRETCHES):
            within = (since >= k / STRETCHES) & (since < (k + 1) / STRETCHES)
            begin, end = t[0] + (t[-1] - t[0]) * np.array([k, k + 1]) / STRETCHES
            span = f"{begin:.3g} to {end:.3g} s" if run else f"part {k + 1} of {STRETCHES}"
            yield f"{WITHIN} {span}{of or ' of every run'}", within.astype(float)


def _late(c: Array, t: Array, lasting: float) -> Array:
    """(N,) a command as a lag of that time constant [s] would have it."""
    out = c.copy()
    for i, share in enumerate(1.0 - np.exp(-np.diff(t) / lasting), 1):
        out[i] = out[i - 1] + share * (c[i] - out[i - 1])
    return out
