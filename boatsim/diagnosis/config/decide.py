"""Settings of the decision what the recordings show: probabilities and verdicts."""

from dataclasses import dataclass
from math import inf

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class DecideConfig:
    """Weights of a logistic regression: the probability that an identified effect is a true cause.

    The regression is one of right and wrong effects, over about 1,080 simulated logs with known
    causes, made by `validation.calibration` with the seeds 2 and 3 while its shares of the kinds of
    logs were being chosen. That of `alternative` was fitted again to the 306 logs with a cause
    among the first 419 of seed 9 and the first 210 of seed 10, when this sign was related to the
    axes of an effect; those of `remainder` and of a stochastic force to about 1,000 logs of the
    seeds 12 to 15, when these signs were new.
    The three weights of a constant size were not fitted but set by hand: they are equal, and small,
    because these odds come from the same data. On 119 logs of seed 13 they made names too sure
    where nothing remained unexplained, and are now multiplied by the feature `unexplained`,
    relative to its limit. An intercept of 2.9 fits 390 logs of the seeds 12 to 14 better, but takes
    the name from the nonlinear damping and the dry friction of real recordings, whose laws are
    never exactly those of a candidate, as those of a simulated cause are.
    All weights were then multiplied by 0.85, and 0.3 was added to the intercept, together with
    `odds_beside_unknown`, because the log odds were too far from zero on both sides in logs of the
    seeds 12 to 16: `--weights` prints the scale that fits a folder of logs best.
    `python -m validation.calibration --weights` fits weights to the logs that it has diagnosed.
    Each multiplies a feature of `boatsim.diagnosis.open_set.probability`. The settings `least_...`,
    `largest_...` and `..._range` at the end limit these features.
    """

    least_probability: float = setting(
        0.5,
        "1",
        "Probability, together with look-alikes, from which an effect is named; below it an effect "
        "is only reported as possible: it is more probably a stand-in.",
        0.0,
        1.0,
    )
    odds_beside_unknown: float = setting(
        -1.3,
        "nats",
        "Added to the log odds of an effect where an unknown cause is reported and the vessel file "
        "calls none of its numbers estimated: there an effect is a stand-in more often than its "
        "own signs tell. Chosen with simulated logs of the seeds 12 to 16.",
        low=-inf,
    )
    largest_refined_addition: float = setting(
        3.0,
        "sd",
        "Standard deviations, those of the file's estimate and of the fit together, up to which a "
        "load is a better value of an estimated mass; a larger one is missing physics. Of normally "
        "distributed errors 0.3 % are larger.",
        0.0,
    )
    unexplained_share: float = setting(
        0.25,
        "1",
        "Share of the explained evidence added to `select.unknown_gain`: a smaller remainder is "
        "reported as an error of the identified laws and not as an unknown cause.",
        0.0,
        1.0,
    )
    structure_share: float = setting(
        0.15,
        "1",
        "The same share where the remaining force correlates with a motion, a command or a place.",
        0.0,
        1.0,
    )
    held_out_share: float = setting(
        3.0,
        "1",
        "Evidence for a force beyond the assumed disturbance on held-out recordings, relative to "
        "the threshold of an unknown cause, from which a cause is unknown if that force also "
        "correlates significantly with a motion, command or place. Without such a correlation "
        "known effects of uncertain size left up to 16 there (calibration, seed 8).",
        0.0,
    )
    sure_probability: float = setting(
        0.75,
        "1",
        "Probability from which an effect is stated without the word probably: odds of 3 to 1.",
        0.0,
        1.0,
    )
    time_parts: int = setting(
        4,
        "count",
        "Parts in time of each recording between which the size of an effect is compared: two "
        "halves, each again halved.",
        low=2,
    )
    ranges: int = setting(
        4,
        "count",
        "Ranges of each speed and command, with equal numbers of rows, between which the size of "
        "an effect is compared: quartiles.",
        low=2,
    )
    prior_factor_sd: float = setting(
        100.0,
        "1",
        "Prior sd of the size of an effect on a part of the data, as a share of the fitted size. "
        "It is wide and only keeps the equations regular where a part has no information.",
        low=1.0,
    )
    comparable_factor_sd: float = setting(
        1.0,
        "1",
        "Sd of that size below which a part is compared with others; with more it does not "
        "distinguish the fitted size from none.",
        low=1e-6,
    )
    unknown_factor_sd: float = setting(
        1e6,
        "1",
        "Sd of that size where held-out recordings are missing or cannot be simulated.",
        low=1.0,
    )
    size_tolerance: float = setting(
        0.1,
        "1",
        "Share of the size of an effect by which parts of the data may differ although the effect "
        "is true: its law is never exactly that of the candidate.",
        0.0,
    )
    least_axis_share: float = setting(
        0.3,
        "1",
        "Size of the force of an effect along an axis, relative to the axis of its largest one, "
        "from which a force along that axis could take its place. A wind or a shifted mass centre "
        "acts along all axes, a drag mainly along one.",
        0.0,
        1.0,
    )
    clear_deviation: float = setting(
        2.5,
        "sd",
        "Deviation of the size on held-out recordings from which it is given as the reason why an "
        "effect is only possible; below it, true effects are as frequent as stand-ins.",
        0.0,
    )
    clear_excess: float = setting(
        0.3,
        "1",
        "Variation of the size of an effect, as a share of it, from which it is given as the "
        "reason why the effect is only possible.",
        0.0,
    )
    clear_rest: float = setting(
        1.0,
        "1",
        "Unexplained force, relative to the threshold of an unknown cause, from which it is given "
        "as the reason why an effect is only possible.",
        0.0,
    )
    confirmed_sd: float = setting(
        0.5,
        "1",
        "Largest sd of the size of an effect on held-out recordings, as a share of the fitted "
        "size, for which these must confirm it: a true effect then differs from zero by two "
        "standard deviations.",
        0.0,
    )
    required_sd: float = setting(
        4.0,
        "sd",
        "Size of an effect on held-out recordings, in its standard deviations, from which these "
        "require it, although their simulations get no better while all other parameters stay: a "
        "true effect whose fit shares an error with another parameter is not refuted.",
        0.0,
    )
    intercept: float = setting(
        3.21,
        "1",
        "Log of the odds of a name whose features are all zero.",
        low=-inf,
    )
    held_out_gain: float = setting(
        0.196,
        "1",
        "Weight: log of the log-likelihood [nats] that held-out recordings gain by the effect.",
        low=-inf,
    )
    held_out_significance: float = setting(
        0.0677,
        "1",
        "Weight: size on held-out recordings in its standard deviations: a true effect is found"
        " again.",
        low=-inf,
    )
    held_out_deviation: float = setting(
        -0.35,
        "1",
        "Weight: deviation of the size on held-out recordings from the fitted size, in standard"
        " deviations with 10 % error of the law.",
        low=-inf,
    )
    held_out_constant: float = setting(
        0.212,
        "1",
        "Weight: log of the odds that the size on held-out recordings is the fitted size, and not "
        "that of a stand-in.",
        low=-inf,
    )
    times_apart: float = setting(
        -0.723,
        "1",
        "Weight: variation of the size between parts in time, as a share of the fitted size.",
        low=-inf,
    )
    times_constant: float = setting(
        0.212,
        "1",
        "Weight: log of the odds that the size is the same in all parts in time, and does not vary "
        "as that of a stand-in.",
        low=-inf,
    )
    ranges_apart: float = setting(
        -1.2,
        "1",
        "Weight: variation of the size between ranges of a speed, a command or the heading, as "
        "a share of the fitted size.",
        low=-inf,
    )
    ranges_constant: float = setting(
        0.212,
        "1",
        "Weight: log of the same odds for ranges of a speed, a command or the heading.",
        low=-inf,
    )
    unexplained: float = setting(
        -0.233,
        "1",
        "Weight: evidence that remains unexplained, as a share of the threshold of an unknown "
        "cause.",
        low=-inf,
    )
    remainder: float = setting(
        -1.7,
        "1",
        "Weight: share of the unexplained evidence, or of that of its significant dependence on "
        "motion, commands, place or time, in the sum of it and of the evidence of the effect. It "
        "counts beyond `law_error`, and not if the vessel file calls any of its numbers estimated, "
        "because such a model leaves force unexplained whether or not the effect is true.",
        low=-inf,
    )
    structure: float = setting(
        -1.06,
        "1",
        "Weight: dependence of the remaining force on motion, commands, place or time, as a "
        "share of all gained evidence.",
        low=-inf,
    )
    alternative: float = setting(
        -0.573,
        "1",
        "Weight: evidence of the best single-term force along the axes of the effect in its place, "
        "as a share of its own evidence. The level of the latent force is the one fitted without "
        "the effect.",
        low=-inf,
    )
    prior_distance: float = setting(
        -1.22,
        "1",
        "Weight: log of the distance from zero effect in prior standard deviations: an "
        "implausible size.",
        low=-inf,
    )
    exceeds_range: float = setting(
        -3.38,
        "1",
        "Weight: whether a parameter is at a bound of its range and a recording requires more.",
        low=-inf,
    )
    stochastic_at_bound: float = setting(
        -3.65,
        "1",
        "Weight: whether a parameter of a stochastic force is at a bound of its range: the "
        "narrowest spectrum is that of a periodic force, as of a steering that hunts, and not of "
        "a sea.",
        low=-inf,
    )
    stochastic_times: float = setting(
        -0.637,
        "1",
        "Weight: for a stochastic force, chi-square per degree of freedom, beyond 1, of the "
        "hypothesis that its rms value is the same in all parts in time.",
        low=-inf,
    )
    stochastic_ranges: float = setting(
        -0.408,
        "1",
        "Weight: the same for ranges of a command or the heading. The rms value of a sea changes "
        "with the heading, too, so that this tells less.",
        low=-inf,
    )
    look_alikes: float = setting(
        0.55,
        "1",
        "Weight: number of its look-alikes, each of which may be the true cause.",
        low=-inf,
    )
    coefficient_shift: float = setting(
        -0.408,
        "1",
        "Weight: rms distance of the refitted coefficients from the vessel file in prior "
        "standard deviations.",
        low=-inf,
    )
    effects: float = setting(
        -1.43,
        "1",
        "Weight: log of the number of identified effects: true causes are few.",
        low=-inf,
    )
    least_held_out_gain: float = setting(
        0.1,
        "nats",
        "Lower limit of the gain in the feature `held_out_gain`, whose logarithm it is; less is no "
        "evidence. Beyond this and the following limits of features the campaign has few examples, "
        "and no single one shall decide.",
        low=1e-9,
    )
    held_out_significance_range: tuple[float, ...] = setting(
        (-3.0, 10.0), "sd", "Limits of the feature `held_out_significance`.", low=-inf
    )
    largest_held_out_deviation: float = setting(
        8.0, "sd", "Upper limit of the feature `held_out_deviation`."
    )
    largest_variation: float = setting(
        2.0, "1", "Upper limit of the features `times_apart` and `ranges_apart`."
    )
    law_error: float = setting(
        0.05,
        "1",
        "Share of all gained evidence that may remain unexplained and is no sign of a stand-in: "
        "the law of a real effect never has exactly the form of a candidate.",
        0.0,
        1.0,
    )
    largest_ratio: float = setting(
        6.0, "1", "Upper limit of the features `stochastic_times` and `stochastic_ranges`."
    )
    stand_in_variation: float = setting(
        0.5,
        "1",
        "Share of its size by which that of a stand-in varies between parts of the data, in the "
        "features `held_out_constant`, `times_constant` and `ranges_constant`: five times "
        "`size_tolerance`, by which a true one may vary.",
        low=1e-6,
    )
    largest_constant: float = setting(
        4.0, "1", "Upper limit of these features; odds against a constant size count as zero."
    )
    largest_unexplained: float = setting(4.0, "1", "Upper limit of the feature `unexplained`.")
    largest_structure: float = setting(1.0, "1", "Upper limit of the feature `structure`.")
    largest_alternative: float = setting(2.0, "1", "Upper limit of the feature `alternative`.")
    largest_coefficient_shift: float = setting(
        4.0, "prior sd", "Upper limit of the feature `coefficient_shift`."
    )
    least_reference_gain: float = setting(
        1.0,
        "nats",
        "Evidence of an effect, or of all effects, to which the features `alternative` and "
        "`structure` are related, at least.",
        low=1e-9,
    )
    largest_log_odds: float = setting(
        30.0,
        "nats",
        "Limit of the log of the odds; beyond it the probability is 0 or 1 in every printed digit.",
        high=700.0,
    )
