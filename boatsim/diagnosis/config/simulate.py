"""Settings of the output-error method: parameters and effects that free runs require."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class SimulateConfig:
    """Settings of the fit to free runs, where a force remains that no effect explains."""

    steps: int = setting(
        8,
        "count",
        "Most Gauss-Newton steps of a fit to free runs; fits of real recordings ended after three "
        "to eight.",
        low=1,
    )
    step_gain: float = setting(
        0.1, "nats", "A smaller gain ends a fit; parameters then move by a fraction of their sd."
    )
    budget: int = setting(
        2_600_000_000,
        "steps x dof",
        "Work of the fits to free runs, counted as in `select.budget`; then no further effect is "
        "dropped or added. 2,600 million take 3 to 4 minutes on a slow processor. They get less "
        "where `work.total` leaves less.",
        low=1,
    )
    unsure_budget: int = setting(
        600_000_000,
        "steps x dof",
        "Work of the search without those stated effects that are only probably causes. It takes "
        "about a minute of CPU.",
        low=1,
    )
    clear_gain: float = setting(
        10.0,
        "nats",
        "Gain of an effect by its size and deviation above which it is not dropped on trial.",
    )
    better: float = setting(
        1.05,
        "1",
        "Factor by which the rms errors on held-out recordings must fall, geometric mean over the "
        "signals, for a vessel fitted to free runs to replace that of the Kalman filter.",
        low=1.0,
    )
    effects: int = setting(
        6,
        "count",
        "Most effects that are added because simulations get better by them. Each costs about as "
        "much as a fit of the vessel; over long recordings `simulate.budget` ends the search.",
    )
    effect_gain: float = setting(
        2.0,
        "nats",
        "Gain by the free runs over fitted and held-out recordings for an added effect. Odds of 7 "
        "suffice, because it is only used for predictions.",
    )
    followed: int = setting(
        10, "count", "Candidates of the largest predicted gain that get a rough fit.", low=1
    )
    followed_steps: int = setting(2, "count", "Gauss-Newton steps of a rough fit.", low=1)
    pair_budget: int = setting(
        800_000_000,
        "steps x dof",
        "Work of the search for a spring to the ground together with the force that it balances; "
        "then no further pair is tried. The best pairs are fitted afterwards, by free runs and by "
        "the Kalman filter.",
        low=1,
    )
    pair_starts: tuple[float, ...] = setting(
        (0.1, 0.3, 1.0),
        "prior sd",
        "Sizes of a spring from which the fits of a pair start: each next frequency is 1.8 times "
        "the one before.",
        low=1e-6,
    )
    pair_steps: int = setting(
        5,
        "count",
        "Gauss-Newton steps of a rough fit of two effects that balance each other; their starting "
        "values may have the wrong signs.",
        low=1,
    )
    fitted_pairs: int = setting(
        3,
        "count",
        "Most pairs of effects that get a full fit, in the order of the evidence of their rough "
        "fits.",
        low=1,
    )
    fitted: int = setting(
        5,
        "count",
        "Most candidates that get a full fit before one is added, in the order of the evidence of "
        "their rough fits; later ones are less probable.",
        low=1,
    )
