"""Settings of the search for times, axes and forms of a force that the vessel model lacks."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class LocateConfig:
    """Settings for locating a missing force: on which axes, when and under which conditions."""

    band_sds: float = setting(
        2.0, "sd", "Half width of the band of the missing force; zero outside it is missing force."
    )
    interval_min_duration: float = setting(
        0.5, "correlation times", "Shorter intervals of missing force are not reported."
    )
    interval_max_gap: float = setting(
        1.0, "correlation times", "Intervals of missing force with a shorter gap are merged."
    )
    mean_force_min_sds: float = setting(
        3.0, "sd", "A mean residual force is reported if it differs from zero by more than this."
    )
    disturbance_factor: float = setting(
        1.5,
        "1",
        "Multiple of the assumed disturbance level to which the latent force is limited when the "
        "residual force is judged.",
        low=1e-3,
    )
    coefficient_step: float = setting(
        0.1,
        "prior sd",
        "Step of a coefficient for the derivative of the missing force by it; the force is nearly "
        "linear over this distance.",
        1e-6,
        10.0,
    )
    region_max_p: float = setting(
        0.01, "1", "Largest corrected p-value of a region that is reported.", high=1.0
    )
    play_width: float = setting(
        0.1,
        "rad",
        "Play in the steering for which the missing force is computed; the force is proportional "
        "to it.",
        low=1e-6,
    )
    wall_range: float = setting(
        2.0,
        "reaches",
        "Distance beyond which a wall has no effect, in reaches of the exponential decrease.",
        low=0.1,
    )
    periodicity_band: float = setting(
        1.26, "1", "Ratio of the limits of a frequency band, a third of an octave.", low=1.01
    )
    periodicity_neighbours: int = setting(
        2, "count", "Bands on either side with which a peak of the spectrum is compared.", low=1
    )
    periodicity_min_rows: float = setting(
        5.0,
        "rows",
        "Rows in a period, at least; faster errors change from row to row for other reasons.",
        low=2.0,
    )
    periodicity_min_ordinates: int = setting(
        3, "count", "Periodogram ordinates in a band, at least.", low=1
    )
    structure_max_p: float = setting(
        0.003,
        "1",
        "Largest corrected p-value of a structure of the residual force: at most one log of three "
        "hundred without a cause is called unknown by it.",
        high=1.0,
    )
    structure_least_share: float = setting(
        0.05,
        "1",
        "Share of the information about a structure of the residual force that the fitted "
        "parameters are taken to leave, at least; with less, rounding decides.",
        low=1e-3,
        high=1.0,
    )
    structure_parts: int = setting(
        8, "count", "Parts of a run in each of which a residual force may act alone.", low=1
    )
