"""Approximate evidence of each term in addition to a fit, computed from the residual force.

It is fast and accurate enough to choose the terms that are fitted with the filter. The prior of a
coefficient has mean zero; its standard deviation gives the force of a steady force where the term
acts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import dof_in_state_order
from boatsim.diagnosis.locate.smoothing import LatentForce, separate_information
from boatsim.diagnosis.problem import froude_scale
from boatsim.diagnosis.symbolic.term_forces import FittedRecording
from boatsim.physics.base import AXES, Array
from boatsim.physics.described_laws import SymbolicTerm
from boatsim.physics.effects.described_thrust import DescribedThrust
from boatsim.physics.effects.push import SteadyForce
from boatsim.physics.signals import ROTATIONS
from boatsim.physics.terms import SPEEDS
from boatsim.physics.vessel import Vessel

# prior sd of a steady force [N, N m] by axis, on the hull of 1.2 m for which effects specify it
STEADY_FORCE = {axis: about.spread for axis, about in SteadyForce.params().items() if about.fit}
FORCE = STEADY_FORCE | {"heave": STEADY_FORCE["sway"], "pitch": STEADY_FORCE["yaw"]}
THRUST_SHARE = DescribedThrust.params()["coefficient"].spread  # prior sd of a change of thrust
BATCH = 200  # terms computed together; more do not fit into the cache of a processor
SPEED_FIELDS = ("ur", "vr", "wr", "p", "q", "r")  # fields of a motion, by axis


@dataclass(frozen=True)
class ScoredTerm:
    """A term of the symbolic regression with its approximate evidence and coefficient.

    Attributes:
        term: A term of the symbolic regression.
        gain: Log Bayes factor [nats] in addition to the fit.
        coefficient: Its coefficient.
        spread: Prior standard deviation of the coefficient.
    """

    term: SymbolicTerm
    gain: float
    coefficient: float
    spread: float


def score_terms(
    recordings: Sequence[FittedRecording], terms: Sequence[SymbolicTerm]
) -> list[ScoredTerm]:
    """Return the approximate evidence of each symbolic term, added alone to a fit.

    It follows from the force that the fit leaves unexplained, without a refit.

    Args:
        recordings: The recordings as the fit explains them.
        terms: The terms.

    Returns:
        The terms that act at all, those with most evidence first.
    """
    by_run: dict[str, list[int]] = {}  # an event of one recording is zero in all others
    for i, term in enumerate(terms):
        by_run.setdefault(term.run, []).append(i)
    found: dict[int, ScoredTerm] = {}
    for run, places in by_run.items():
        own = [fitted for fitted in recordings if run in ("", fitted.recording.name)]
        for first in range(0, len(places), BATCH):
            some = places[first : first + BATCH]
            scored = _score_batch(own, [terms[i] for i in some])
            found |= {i: one for i, one in zip(some, scored, strict=True) if one is not None}
    return sorted([found[i] for i in sorted(found)], key=lambda s: -s.gain)


def _score_batch(
    recordings: Sequence[FittedRecording], terms: Sequence[SymbolicTerm]
) -> list[ScoredTerm | None]:
    """Score terms over the recordings in which they act; None for a term that is always zero."""
    information, score = np.zeros(len(terms)), np.zeros(len(terms))
    squares, rows = np.zeros(len(terms)), np.zeros(len(terms))
    for fitted in recordings:
        with np.errstate(over="ignore"):
            forces = np.stack([fitted.term_force(term) for term in terms], axis=2)
            sizes = np.stack([fitted.term_value(term) for term in terms])
        squares += (sizes**2).sum(axis=1)
        rows += (sizes != 0.0).sum(axis=1)
        recording, levels = fitted.recording, fitted.fit.levels
        nq = fitted.problem.program.module.NQ
        recording.filtered.add_scores(len(terms), len(recording.times), int(nq))
        latent = LatentForce(
            recording.times,
            np.hstack([fitted.states, fitted.residual]),
            *fitted.smoother,
            slice(2 * nq, 3 * nq),
            *recording.latent_force_rms(fitted.parameter_values, fitted.effect_switches, levels),
            levels.time_constant,
        )
        more_information, more_score = separate_information(forces, latent)
        information = information + more_information
        score = score + more_score
    scored: list[ScoredTerm | None] = []
    numbers = np.column_stack([information, score, squares, rows]).tolist()
    for term, (i, s, square, n) in zip(terms, numbers, strict=True):
        if not (np.isfinite(i) and i > 0.0 and square > 0.0):
            scored.append(None)
            continue
        spread = prior_force_sd(recordings[0].problem.program.vessel, term) / float(
            np.sqrt(square / n)
        )
        whole = i + spread**-2
        gain = 0.5 * s**2 / whole - 0.5 * float(np.log(whole * spread**2))
        scored.append(ScoredTerm(term, gain, s / whole, spread))
    return scored


def prior_force_sd(vessel: Vessel, term: SymbolicTerm) -> float:
    """Return the prior standard deviation of the force that a symbolic term exerts on a vessel.

    It is that of the force where the term acts, and scales with the vessel's size by Froude's law.

    Args:
        vessel: The vessel.
        term: A term of the symbolic regression.

    Returns:
        A force [N], a moment [N m] or a share of the thrust.
    """
    if isinstance(term, DescribedThrust):
        return THRUST_SHARE
    axis = str(getattr(term, "axis", ""))
    unit = "N m" if axis in ROTATIONS else "N"
    return FORCE.get(axis, FORCE["surge"]) * froude_scale(unit, vessel)


def varying_signals(
    recordings: Sequence[FittedRecording],
) -> tuple[dict[str, Array], list[str]]:
    """Return the speeds and actuator signals that vary, of which symbolic terms can be made.

    Args:
        recordings: The recordings as a fit explains them.

    Returns:
        Speeds through the water (rows,) [SI] by the name of the factor, and names of actuators.
    """
    vessel = recordings[0].problem.program.vessel
    speeds = {}
    for axis in dof_in_state_order(vessel):
        name, field = SPEEDS[AXES.index(axis)], SPEED_FIELDS[AXES.index(axis)]
        values = np.concatenate([getattr(fitted.motion, field) for fitted in recordings])
        if np.ptp(values) > 0.0:
            speeds[name] = values
    held = np.concatenate([fitted.actuator_signals for fitted in recordings], axis=1)
    commands = []
    for name in (*vessel.actuators, *vessel.signal_sums):
        if np.ptp(held[vessel.described_signals.index(name)]) > 0.0:
            commands.append(name)
    return speeds, commands
