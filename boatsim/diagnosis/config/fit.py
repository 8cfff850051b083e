"""Settings of the fits of parameters and noise levels."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class FitConfig:
    """Settings for fitting one hypothesis, a vessel model with a given set of candidate effects.

    They concern its parameters, noise levels, correlation time and posterior widths.
    """

    input_noise_sd: float = setting(
        2.0,
        "1",
        "Prior sd of the logarithm of the noise of a measured force, which no rule predicts.",
        low=1e-3,
    )
    refit_gain: float = setting(
        0.3, "nats", "A refit that gains less evidence than this changes nothing.", low=1e-6
    )
    most_refits: int = setting(
        8, "count", "Largest number of refits until parameters and noise levels agree.", low=1
    )
    first_steps: int = setting(
        4, "count", "Gauss-Newton steps before the noise levels are fitted.", low=1
    )
    last_steps: int = setting(
        3, "count", "Gauss-Newton steps after the noise levels are fitted.", low=1
    )
    step_gain: float = setting(
        0.1, "nats", "Gauss-Newton steps end when a step gains less than this.", low=1e-6
    )
    part_steps: int = setting(
        6, "count", "Gauss-Newton steps when one part of the data is fitted alone.", low=1
    )
    most_dampings: int = setting(
        5, "count", "Attempts at one Gauss-Newton step, each with more damping.", low=1
    )
    halvings: int = setting(
        6,
        "count",
        "A start at which the simulated boat diverges is moved halfway to zero effect, at most "
        "this often.",
        low=0,
    )
    derivative_step: float = setting(
        0.01, "prior sd", "Step of forward differences by a parameter.", 1e-6, 1.0
    )
    curvature_step: float = setting(
        0.5,
        "prior sd",
        "Step of second differences by a parameter without a gradient.",
        1e-3,
        2.0,
    )
    broyden_share: float = setting(
        0.5,
        "1",
        "A step must gain this share of the predicted gain for the derivatives to be updated "
        "from it (Broyden 1965).",
        0.0,
        1.0,
    )
    short_step_damping: float = setting(
        0.1,
        "1",
        "With more damping than this a step is so short that its agreement with the prediction "
        "is no sign of convergence.",
    )
    first_damping: float = setting(
        1e-3,
        "1",
        "Damping of the first Gauss-Newton step; 0.1 doubles the weight of the prior, so that this "
        "one hardly shortens the step.",
    )
    least_damping: float = setting(
        1e-2, "1", "Damping that a failed attempt starts from, at least.", low=1e-9
    )
    damping_growth: float = setting(
        10.0,
        "1",
        "Factor by which damping grows after a failed attempt and falls after a step.",
        low=1.01,
    )
    agreement: float = setting(
        0.1,
        "nats",
        "A step whose gain differs from the prediction by less than this, plus a share of it, "
        "shows that the quadratic model holds.",
    )
    agreement_share: float = setting(
        0.02, "1", "The share of the predicted gain in the setting `agreement`.", 0.0, 1.0
    )
    coefficient_range: tuple[float, ...] = setting(
        (0.05, 20.0),
        "1",
        "Lowest and highest factor by which a coefficient of the nominal model may be "
        "recalibrated.",
        1e-6,
        1e6,
    )
    force_sd_below: float = setting(
        0.3,
        "1",
        "Prior sd of the log of the latent force below the assumed disturbance level; narrow, "
        "because calm water is no merit of a model.",
        low=1e-3,
    )
    force_sd_above: float = setting(
        1.5, "1", "Prior sd of the log of the latent force above the assumed level.", low=1e-3
    )
    noise_sd: float = setting(
        0.4, "1", "Prior sd of the log of sensor noise about the specified level.", low=1e-3
    )
    correlation_time_sd: float = setting(
        0.7, "1", "Prior sd of the log of the correlation time of the latent force.", low=1e-3
    )
    least_force: float = setting(
        0.1,
        "1",
        "Lower bound of the latent force in assumed disturbance levels: no model is more exact.",
        1e-6,
        1.0,
    )
    least_noise: float = setting(
        0.1,
        "1",
        "Lower bound of fitted sensor noise in specified levels: no log is more exact.",
        1e-6,
        1.0,
    )
    rough_gain: float = setting(
        2.0,
        "nats",
        "Accuracy of noise levels that are fitted again: a coordinate is revisited only after a "
        "larger gain.",
        low=1e-6,
    )
    fine_gain: float = setting(
        0.3, "nats", "Accuracy of noise levels that are fitted for the first time.", low=1e-6
    )
    force_raises: int = setting(
        10,
        "count",
        "The latent force is raised by a factor of e at most this often until the filter can "
        "follow a recording.",
        low=0,
    )
    search_rounds: int = setting(
        8, "count", "Rounds over all coordinates of a search without gradient.", low=1
    )
    search_finest: float = setting(
        0.3, "1", "Smallest step of such a search, relative to the first one.", 1e-3, 1.0
    )
    search_reach: float = setting(
        2.0, "1", "Largest move of such a search along one coordinate, in steps.", low=1.0
    )
    force_search_step: float = setting(
        0.5,
        "1",
        "First step of such a search for the level of the latent force and the spectra of "
        "stochastic forces, in logarithms of levels and in prior sds: the accuracy of the start.",
        low=1e-3,
    )
    noise_search_step: float = setting(
        0.6,
        "1",
        "First step of the first search for all noise levels, in their logarithms.",
        low=1e-3,
    )
    noise_fine_search_step: float = setting(
        0.4, "1", "First step of the second one, from the result of the first.", low=1e-3
    )
    spectrum_search_step: float = setting(
        0.7,
        "1",
        "First step of a search for level and correlation time of the latent force, in their "
        "logarithms: the prior sd of the correlation time.",
        low=1e-3,
    )
    force_start: float = setting(
        0.7,
        "1",
        "Logarithm of the latent force over its assumed level, from which the search for noise "
        "levels starts: twice that level, because a vessel file is rarely complete.",
    )
    noise_start_range: float = setting(
        1.2,
        "1",
        "Largest distance of the logarithm of sensor noise from its specified level at the start: "
        "three prior sds.",
    )
    noise_min_rows: int = setting(
        8,
        "count",
        "A signal with more rows than this gives the start of its noise by its third differences.",
        low=4,
    )
    correlation_time_steps: int = setting(
        2, "count", "Halvings or doublings of the correlation time that are tested.", low=0
    )
    simulated_step: float = setting(
        0.25,
        "prior sd",
        "Largest change of a parameter for the derivatives of free runs. It lies far above "
        "rounding, and a coefficient hardly bends the answer within it.",
        1e-3,
        1.0,
    )
    known_sd: float = setting(
        0.2,
        "1",
        "Relative prior sd up to which the vessel file knows a coefficient. Measured ones have "
        "0.05 to 0.1, those of a rule of thumb or of another vessel 0.3 to 1.",
    )
    undetermined_sd: float = setting(
        0.7,
        "prior sd",
        "A coefficient with a larger posterior sd keeps the value of the vessel file: the "
        "recordings, or in the vessel of the answer free runs over them, then say less about it "
        "than the prior does, because precisions add up and 0.7 is the root of one half.",
        0.0,
        1.0,
    )
    correlation_time_certainty: float = setting(
        2.0,
        "standard errors",
        "Free-run errors must fall by more than this for another correlation time to be chosen.",
    )
    stretch: float = setting(
        4.0,
        "time constants",
        "Length of the stretches whose errors count as independent of each other in the sandwich "
        "covariance (White 1982).",
        low=0.1,
    )
    fewest_stretches: int = setting(
        10, "count", "Fewest stretches from which the sandwich covariance is estimated.", low=2
    )
    lost_rms: float = setting(
        10.0,
        "sd",
        "A model whose whitened prediction errors have a larger rms in a recording, although the "
        "latent force was fitted, does not follow that recording; it is about 1 where a model "
        "follows, whatever effects it lacks.",
        low=2.0,
    )
    lost_sds: float = setting(
        20.0,
        "sd",
        "The vessel as written loses a recording where its prediction errors stay larger than "
        "this; four times the limit of a single outlier.",
        low=5.0,
    )
    lost_largest_share: float = setting(
        0.5,
        "1",
        "Share of the largest such error that is the limit where it is lower than `lost_sds`, so "
        "that at least the recording with the largest errors is named.",
        0.0,
        1.0,
    )
    lost_window: float = setting(
        2.0,
        "correlation time",
        "Errors stay outside if their rms over this time, from an outlier on, is outside.",
        low=0.5,
    )
    lost_lead: float = setting(
        0.5,
        "1",
        "Time before the loss of a recording, in such times, from which on the largest missing "
        "force gives the axis; a force acts before the motion has changed.",
    )
    lost_raise: float = setting(
        4.0,
        "1",
        "Factor by which the latent force is raised at a time until a lost recording is followed.",
        low=1.5,
    )
    lost_raises: int = setting(
        16,
        "count",
        "Largest number of such steps per axis: 4^16 is more than any force in proportion to the "
        "assumed disturbance.",
        low=1,
    )
