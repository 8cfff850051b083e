"""Settings of the answer: what diagnosis.json and the report state."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class AnswerConfig:
    """Settings of the answer of a diagnosis: which uncertainties and upper limits are reported."""

    law_error: float = setting(
        0.05,
        "1",
        "Share of a fitted value (rad for directions) that is added to its sd in quadrature: a "
        "law of nature is never exactly that of a candidate.",
        0.0,
        1.0,
    )
    limit_quantile: float = setting(
        1.645, "sd", "One-sided quantile of upper limits: 95 %.", low=0.0
    )
    limit_share: float = setting(
        0.5,
        "1",
        "An upper limit is reported only where the fitted sd is below this share of the prior "
        "sd; otherwise it would only repeat the prior.",
        0.0,
        1.0,
    )
    at_bound: float = setting(
        1e-3,
        "1",
        "A value within this relative distance of a bound is reported as at the bound, and counts "
        "as such for the probability of an effect.",
    )
    least_improvement: float = setting(
        1.1,
        "1",
        "The report calls a result a hint if no rms error on held-out recordings decreases by "
        "more than this factor.",
        low=1.0,
    )
    unchanged_share: float = setting(
        0.05,
        "1",
        "The report calls an rms error unchanged if it differs by less than this share.",
        0.0,
        1.0,
    )
    refined_sds: float = setting(
        2.0,
        "sd",
        "A refitted coefficient is listed as a refined number if it differs from the vessel file "
        "by more than this many sd; a smaller difference may be chance.",
        low=0.0,
    )
    refined_share: float = setting(
        0.05,
        "1",
        "A refitted coefficient is listed as a refined number if it differs from the vessel file "
        "by more than this share; a smaller difference does not matter to an owner.",
        low=0.0,
    )
    formula_sds: float = setting(
        2.0,
        "sd",
        "The verdict states a formula only if each coefficient is further than this from zero; a "
        "smaller one may be chance.",
        low=0.0,
    )
