"""Settings of the validation on held-out recordings."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class ValidateConfig:
    """Settings for held-out recordings: when they refute an effect or decide between effects."""

    fewest_runs: int = setting(
        3, "count", "Fewest free runs from which a standard error is estimated.", low=2
    )
    worse: float = setting(
        1.05, "1", "Ratio of rms errors of free runs from which they have grown.", low=1.0
    )
    certainty: float = setting(
        2.0,
        "standard errors",
        "Errors must grow by more than this to refute an effect, and held-out recordings lose as "
        "much log likelihood by it to refute it although free runs are slightly better with it.",
        low=0.0,
    )
    certainty_alike: float = setting(
        1.65,
        "standard errors",
        "The same between look-alikes, and for a stochastic force, which predicts nothing.",
        low=0.0,
    )
    unexplained_share: float = setting(
        0.9,
        "1",
        "An effect without which more than this share of the latent force remains explains "
        "almost nothing of it.",
        0.0,
        1.0,
    )
    harmful: float = setting(
        1.0,
        "1",
        "Ratio of rms errors of free runs, geometric mean over the signals, above which refitted "
        "coefficients are not adopted. A change of the vessel file needs a reason, and no gain on "
        "held-out recordings is none.",
        low=1.0,
    )
    group_harm: float = setting(
        1.5,
        "1",
        "Ratio of rms errors of free runs above which a model harms a group of recordings. An "
        "effect that helps on the whole may be wrong in a group that has few of the runs. "
        "Coefficients keep the value of the vessel file only up to this ratio over all held-out "
        "recordings.",
        low=1.0,
    )
    alone_share: float = setting(
        0.95,
        "1",
        "A part of the data does not show what is missing if the nominal model fitted to it "
        "alone has at most this share more error than the patched vessel.",
        0.0,
        1.0,
    )
