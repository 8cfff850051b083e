"""Explanation of the terms of a report."""

from boatsim.diagnosis.answer.findings import Findings

Entry = tuple[str, str]  # a term and its meaning

MODELS: tuple[Entry, ...] = (
    (
        "before, retuned, corrected",
        "Before is the vessel file as given. Retuned is the same vessel with its own "
        "coefficients refitted to the recordings, as far as these determine them and held-out "
        "data get no worse. Corrected is the retuned vessel with the "
        "identified effects added. Effects are compared with the retuned vessel, because "
        "refitting alone reduces any error a little. diagnosis.json calls the three nominal, "
        "recalibrated and patched.",
    ),
    (
        "candidate effect",
        "A physical effect or a measurement error of the library that the vessel model does "
        "not have, or has with other numbers. A diagnosis tests each of them.",
    ),
)
FORCES_AND_ERRORS: tuple[Entry, ...] = (
    (
        "missing force",
        "The force or moment on the hull that the recordings show and the retuned vessel "
        "does not explain, estimated over time. Its band is two standard deviations on either "
        "side. An interval is flagged where the band does not contain zero and the force "
        "exceeds the assumed disturbance level.",
    ),
    (
        "assumed disturbance level",
        "The rms force that waves and turbulence are assumed to cause at any time. A force of "
        "this size is not reported as missing.",
    ),
    (
        "held-out recordings",
        "Recordings that were not used in any fit. They show whether a finding holds on new data.",
    ),
    (
        "free run",
        "A simulation that starts at the recorded state and then receives the recorded "
        "commands only. Its distance from the recording is the error of the model.",
    ),
    (
        "rms",
        "Root mean square: the typical size of a quantity that varies. The rms error of a "
        "position is that of its coordinates x and y.",
    ),
)
NOTATION: tuple[Entry, ...] = (
    (
        "±",
        "One standard deviation. In 95 of 100 cases the true value lies within two of them. "
        "After a percentage it is in percentage points: 69 % (± 1.5) is 67.5 to 70.5 %.",
    ),
    (
        "surge, sway, heave, roll, pitch, yaw",
        "Forward, to starboard, down, starboard side down, bow up, bow to starboard.",
    ),
)


def glossary(f: Findings) -> tuple[Entry, ...]:
    """Return the glossary of a report: its statistical terms with their meaning.

    The thresholds of this diagnosis are included.

    Args:
        f: Findings of a diagnosis.

    Returns:
        Pairs of a term and its meaning.
    """
    of_effects = (_evidence(f), _probability(f))
    return (*MODELS, *of_effects, *FORCES_AND_ERRORS, _formula(f), *NOTATION)


def _evidence(f: Findings) -> Entry:
    least, odds = f.setting("select.least_gain"), f.setting("select.odds")
    slight, close = 100.0 * f.setting("select.slight_share"), f.setting("select.alike")
    return (
        "evidence, nats",
        "The log Bayes factor: the natural logarithm of how many times better the model "
        "with the effect predicts the recordings than the model without it. Each additional "
        "parameter lowers it. Its unit is the nat: 1 nat is a factor of 2.7, 3 nats are a "
        "factor of 20, 4 nats a factor of 55. The odds next to it are the reciprocal of this "
        "factor: 1 in 55 that the better fit is chance means that the model without the effect "
        "is 55 times less probable, if both were equally probable before the recordings were "
        "made. They say that something is missing there, and not that it is this effect. An "
        f"effect is identified if it reaches {least:g} nats. Together with its look-alikes it "
        f"must also reach {odds:g} nats plus the logarithm of the number of candidates tested, "
        f"and {slight:g} % of the evidence of the other effects, whose laws are never exact. "
        f"Candidates within {close:g} nats of an identified effect are its look-alikes.",
    )


def _probability(f: Findings) -> Entry:
    named = f.setting("decide.least_probability")
    return (
        "probability that it is a true cause",
        "The probability that an identified effect is a true cause, and neither one of its "
        "rivals nor a stand-in for a cause that is not among the candidates. It follows "
        "from the size of the effect in each recording, at each time, in each range of speed "
        "and command and in the held-out recordings, and from the force that remains; it is "
        "lower beside an unknown cause, unless the vessel file calls numbers estimated. Of many "
        "simulated logs whose causes are known, this share of such names was right. An "
        f"effect below {100 * named:.0f} %, together with its look-alikes, is only called "
        "possible.",
    )


def _formula(f: Findings) -> Entry:
    odds = f.setting("select.odds")
    return (
        "formula",
        "A law found by symbolic regression for a force that no candidate effect explains. It "
        f"has at most {f.setting('describe.most_terms'):g} terms. Each term must reach "
        f"{odds:g} nats plus the logarithm of the number of terms tested.",
    )
