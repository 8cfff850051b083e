"""Settings of the decision on names."""

from dataclasses import dataclass
from math import inf

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class DecideConfig:
    """Weights of a logistic regression: the probability that an identified effect is a true cause.

    The regression is one of right and wrong effects, over about 1,080 simulated logs with known
    causes, made by `validation.calibration` with the seeds 2 and 3 while its shares of the kinds of
    logs were being chosen. The two weights of a stochastic force were fitted again to about 650
    logs of the seeds 4 to 6, and that of `alternative` to the 306 logs with a cause among the first
    419 of seed 9 and the first 210 of seed 10, when this sign was related to the axes of an effect.
    `python -m validation.calibration --weights` fits weights to the logs that it has diagnosed.
    Each multiplies a feature of `boatsim.diagnosis.open_set.probability`.
    """

    least_probability: float = setting(
        0.45,
        "1",
        "Probability, together with look-alikes, from which an effect is named; below it an effect "
        "is only reported as possible. It is a little below one half, because a true effect that "
        "is not named is reported as an unknown cause, and because the law of a real effect never "
        "has exactly the form of a candidate, which lowers its probability.",
        0.0,
        1.0,
    )
    refined_spreads: float = setting(
        3.0,
        "1",
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
    law_error: float = setting(
        0.1,
        "1",
        "Share of an effect by which a true law may differ from the candidate's.",
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
        3.42,
        "1",
        "Log of the odds of a name whose features are all zero.",
        low=-inf,
    )
    held_out_gain: float = setting(
        0.231,
        "1",
        "Weight: log of the log-likelihood [nats] that held-out recordings gain by the effect.",
        low=-inf,
    )
    held_out_significance: float = setting(
        0.0797,
        "1",
        "Weight: size on held-out recordings in its standard deviations: a true effect is found"
        " again.",
        low=-inf,
    )
    held_out_deviation: float = setting(
        -0.412,
        "1",
        "Weight: deviation of the size on held-out recordings from the fitted size, in standard"
        " deviations with 10 % error of the law.",
        low=-inf,
    )
    times_apart: float = setting(
        -0.851,
        "1",
        "Weight: variation of the size between parts in time, as a share of the fitted size.",
        low=-inf,
    )
    ranges_apart: float = setting(
        -1.41,
        "1",
        "Weight: variation of the size between ranges of a speed, a command or the heading, as "
        "a share of the fitted size.",
        low=-inf,
    )
    unexplained: float = setting(
        -0.274,
        "1",
        "Weight: evidence that remains unexplained, as a share of the threshold of an unknown "
        "cause.",
        low=-inf,
    )
    structure: float = setting(
        -1.25,
        "1",
        "Weight: dependence of the remaining force on motion, commands, place or time, as a "
        "share of all gained evidence.",
        low=-inf,
    )
    alternative: float = setting(
        -0.674,
        "1",
        "Weight: evidence of the best single-term force along the axes of the effect in its place, "
        "as a share of its own evidence. The level of the latent force is the one fitted without "
        "the effect.",
        low=-inf,
    )
    prior_distance: float = setting(
        -1.43,
        "1",
        "Weight: log of the distance from zero effect in prior standard deviations: an "
        "implausible size.",
        low=-inf,
    )
    at_bound: float = setting(
        -3.98,
        "1",
        "Weight: whether a parameter is at a bound of its range and a recording requires more.",
        low=-inf,
    )
    stochastic: float = setting(
        -9.61,
        "1",
        "Weight: whether it is a stochastic force, which fits almost anything.",
        low=-inf,
    )
    stochastic_gain: float = setting(
        1.77,
        "1",
        "Weight: for a stochastic force, log of the log-likelihood [nats] that held-out recordings "
        "gain by it.",
        low=-inf,
    )
    look_alikes: float = setting(
        0.647,
        "1",
        "Weight: number of its look-alikes, each of which may be the true cause.",
        low=-inf,
    )
    coefficient_shift: float = setting(
        -0.48,
        "1",
        "Weight: rms distance of the refitted coefficients from the vessel file in prior "
        "standard deviations.",
        low=-inf,
    )
    effects: float = setting(
        -1.68,
        "1",
        "Weight: log of the number of identified effects: true causes are few.",
        low=-inf,
    )
