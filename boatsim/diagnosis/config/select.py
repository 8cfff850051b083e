"""Settings of the selection of candidate effects."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class SelectConfig:
    """Settings for selecting effects: evidence required, screening, forward selection, pruning."""

    odds: float = setting(
        2.0,
        "nats",
        "Log of the odds, about seven to one, at which an effect is identified; each candidate "
        "has the same prior probability.",
        low=0.0,
    )
    most_effects: int = setting(
        8,
        "count",
        "Largest number of effects in one answer; further ones would have almost no data of "
        "their own.",
        low=1,
    )
    fewest_instances: int = setting(
        3,
        "count",
        "Drives from which on an error of each single one is a candidate; `thrust_imbalance` "
        "describes the difference of two.",
        low=1,
    )
    budget: int = setting(
        2_500_000_000,
        "steps x dof",
        "Work of the search: integration steps in every pass of the filter, times degrees of "
        "freedom, and what takes as long as these. 2,500 million take 4 to 5 minutes on a slow "
        "processor; then the step that has begun and the removal of effects are completed, which "
        "takes another minute, and the search reports what it has not tried. It gets less where "
        "`work.total` leaves less.",
        low=1,
    )
    last_budget: int = setting(
        600_000_000,
        "steps x dof",
        "Work of the second search, in which candidates that are tried last take part. A quarter "
        "of `budget`, because most candidates have been tried before.",
        low=1,
    )
    last_share: float = setting(
        0.1,
        "1",
        "Share of the evidence that the selected effects gain, which a candidate that is tried "
        "last must gain alone, where the first search ended at its budget: the second one has "
        "a quarter of its work, and cannot reach as much otherwise. A tenth, because a rough fit "
        "may miss most of what a candidate gains.",
        0.0,
        1.0,
    )
    again_share: float = setting(
        0.5,
        "1",
        "Share of the work of the first search that must remain for a second one with another "
        "correlation time of the latent force; that correlation time is sought only then.",
        low=0.0,
    )
    thorough_work: int = setting(
        175_000_000,
        "steps x dof",
        "Work of the search, about 15 seconds, after which it saves work. Recordings of a minute "
        "and a half need less.",
        low=0,
    )
    lazy_share: float = setting(
        0.5,
        "1",
        "A search that saves work does not screen a candidate whose gain on top of fewer effects "
        "was less than this share of the best gain: with more effects it hardly gains more "
        "(Minoux 1978). All are screened before the search ends.",
        0.0,
        1.0,
    )
    saving_full_fits: int = setting(
        3, "count", "The setting `most_full_fits` of a search that saves work.", low=1
    )
    further_share: float = setting(
        0.15,
        "1",
        "Share of `budget` after which effects that hide each other are no longer sought.",
        0.0,
        1.0,
    )
    saving_seconds: int = setting(
        15,
        "count",
        "Candidates that a search that saves work screens as the second one of two that hide each "
        "other; they gained most as the first one.",
        low=1,
    )
    same_maximum: float = setting(
        1.0,
        "posterior sd",
        "A refit of a search that saves work ends where its parameters are this close to those of "
        "the fit that it starts from, without a gain: it leads back to it.",
        low=0.0,
    )
    calm_steps: int = setting(
        4,
        "count",
        "Gauss-Newton steps of a refit with the latent force at its assumed level, before all "
        "levels are fitted again.",
        low=1,
    )
    further_fits: int = setting(
        3,
        "count",
        "Candidates that are fitted in full, and with a second one, where much remains unexplained "
        "and no candidate gains enough by itself.",
        low=1,
    )
    least_gain: float = setting(
        4.0, "nats", "Evidence that an identified effect must gain alone.", low=0.0
    )
    last_gain: float = setting(
        30.0,
        "nats",
        "Evidence that a candidate that is tried last must gain on top of those found before it. "
        "It has several parameters and starts, so that it takes up some of any force that acts "
        "near a place.",
        low=0.0,
    )
    unknown_gain: float = setting(
        6.0,
        "nats",
        "Evidence for a force beyond the assumed disturbance from which the cause is reported as "
        "outside the candidates.",
        low=0.0,
    )
    model_error: float = setting(
        0.05,
        "1",
        "Share of the explained evidence added to `unknown_gain`: a law of nature is never "
        "exactly that of a candidate.",
        0.0,
        1.0,
    )
    structure_error: float = setting(
        0.02,
        "1",
        "The same share where the remaining force correlates with a motion, a command or a place.",
        0.0,
        1.0,
    )
    slight_share: float = setting(
        0.025,
        "1",
        "An effect that gains less than this share of what the others explain may only correct "
        "the shape of their laws.",
        0.0,
        1.0,
    )
    deterministic_share: float = setting(
        0.5,
        "1",
        "A deterministic effect is preferred to a stochastic force from this share of its gain on.",
        0.0,
        1.0,
    )
    remaining_share: float = setting(
        0.25,
        "1",
        "A stochastic force is withdrawn if what it leaves unexplained gains more than this "
        "share of what it gains.",
        0.0,
        1.0,
    )
    braking_share: float = setting(
        -0.3,
        "1",
        "Mean power of an oscillating force, relative to the largest possible, below which it "
        "acts as friction and is withdrawn.",
        -1.0,
        0.0,
    )
    keep_factor: float = setting(
        40.0,
        "1",
        "An effect whose gain by the curvature exceeds the required evidence by this factor is "
        "kept without a fit that omits it.",
        low=1.0,
    )
    alike: float = setting(
        3.0, "nats", "Candidates within this of the best are reported as look-alikes.", low=0.0
    )
    alike_share: float = setting(
        0.5,
        "1",
        "Two effects are alike if each alone explains more than this share of what both explain.",
        0.0,
        1.0,
    )
    refining_lead: float = setting(
        0.1,
        "1",
        "Share of the evidence of an effect by which another one must be ahead of a better value "
        "of an estimated number: in a rough model differences of evidence between effects that are "
        "nearly alike, such as a lag and a delay, are due to its errors of form.",
        0.0,
        1.0,
    )
    most_look_alikes: int = setting(
        3, "count", "Look-alikes that are reported of an identified effect, the best ones.", low=0
    )
    most_rivals: int = setting(
        3, "count", "Rivals that are fitted in the place of each identified effect.", low=0
    )
    certainty: float = setting(
        1.0,
        "sd",
        "Distance from zero effect from which an effect acts. The rms value of a stochastic force, "
        "of which a recording holds few periods, is uncertain even where it clearly acts.",
        low=0.0,
    )
    determined_share: float = setting(
        0.1,
        "1",
        "An effect acts, too, if the data narrow another of its parameters to this share of the "
        "prior.",
        0.0,
        1.0,
    )
    near_front: float = setting(
        5.0, "nats", "Candidates this close to the best one of a screening are fitted in full."
    )
    front_share: float = setting(
        0.5, "1", "Candidates with this share of the best gain are fitted in full.", 0.0, 1.0
    )
    most_full_fits: int = setting(
        6, "count", "Candidates on top of one model that are fitted in full.", low=1
    )
    start_steps: int = setting(
        2,
        "count",
        "Gauss-Newton steps from each starting point of a candidate whose full fit leaves much "
        "unexplained; the best one is then fitted in full.",
        low=1,
    )
    screening_failure: float = setting(
        8.0,
        "nats",
        "A screening this far below the model without the candidate has failed: a parameter "
        "without use costs less.",
        low=0.0,
    )
    screening_steps: int = setting(
        3, "count", "Gauss-Newton steps of a candidate with the gains of the filter held.", low=1
    )
    screening_starts: int = setting(
        2, "count", "Starting points of a candidate from which a step is computed.", low=1
    )
    screening_dampings: int = setting(
        3, "count", "Attempts at one such step, each with more damping.", low=1
    )
    screening_halvings: int = setting(
        8, "count", "A starting point that is far too strong is halved at most this often.", low=0
    )
    screening_loss: float = setting(
        30.0,
        "nats",
        "A starting point this far below zero effect is too strong and is halved.",
        low=0.0,
    )
    screening_promise: float = setting(
        0.3, "nats", "A candidate with a smaller predicted gain is not followed further.", low=0.0
    )
    screening_start: float = setting(
        0.1, "prior sd", "Starting point of a candidate that specifies none.", 1e-6, 10.0
    )
    recheck_points: int = setting(
        4,
        "count",
        "Points, each half as far from zero effect as the one before, at which a screening is "
        "computed again with the full filter.",
        low=1,
    )
    recheck_share: float = setting(
        0.5,
        "1",
        "A screening is confirmed if the full filter gains more than this share of its gain.",
        0.0,
        1.0,
    )
    recheck_loss: float = setting(
        3.0, "nats", "A screening is confirmed, too, if the full filter gains at most this less."
    )
    recheck_steps: int = setting(
        2, "count", "Gauss-Newton steps from the best of these points.", low=1
    )
    swell_share: float = setting(
        0.7,
        "1",
        "Share of the fitted latent force with which a stochastic force starts; the latent force "
        "keeps as much.",
        1e-3,
        1.0,
    )
