"""Settings for opening recordings: rows used, prior noise and disturbance, length of free runs."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class LoadConfig:
    """Settings for opening recordings: rows used, prior noise and disturbance, length of free runs.

    A free run is a simulation from a recorded state with the recorded commands alone.
    """

    scale_tolerance: float = setting(
        0.01, "1", "Two model scales within this relative difference are the same scale."
    )
    near_track_lengths: float = setting(
        4.0,
        "boat lengths",
        "Largest extent of the tracks, north or east, of a boat that may touch a quay: a boat in a "
        "basin. A boat that goes farther is not beside a wall for most of the recording.",
        low=0.0,
    )
    row_rate: float = setting(
        20.0,
        "Hz",
        "Rows used per second on a hull of 1.2 m; errors of closer rows are not independent.",
        low=0.01,
    )
    enough_rows: int = setting(
        12_000,
        "count",
        "Longer recordings are thinned towards this number of rows, because the cost grows with "
        "the rows and the evidence grows with the manoeuvres.",
        low=10,
    )
    least_row_share: float = setting(
        0.25,
        "1",
        "Thinning of long recordings keeps at least this share of the row rate.",
        0.01,
        1.0,
    )
    disturbance: float = setting(
        2.2e-4,
        "weight",
        "Rms of the force that is attributed to moving water and never reported as missing: 10 "
        "mN on a hull of 4.6 kg in a towing tank.",
        low=1e-12,
    )
    yaw_arm: float = setting(
        0.25, "length", "Lever by which the assumed disturbance turns the hull in yaw.", low=1e-6
    )
    pitch_arm: float = setting(
        0.25, "length", "Lever by which the assumed disturbance trims the hull.", low=1e-6
    )
    roll_arm: float = setting(
        1.0, "draught", "Lever by which the assumed disturbance heels the hull.", low=1e-6
    )
    correlation_time: float = setting(
        1.0,
        "s",
        "Correlation time of the disturbance on a hull of 1.2 m, scaled by Froude's law.",
        low=1e-3,
    )
    horizon: float = setting(
        6.0,
        "s",
        "Length of a free run on a hull of 1.2 m: five lengths of travel at Froude number 0.3.",
        low=0.1,
    )
    input_noise_percentile: float = setting(
        98.0,
        "%",
        "Third differences of a measured force above this percentile are steps of the force and "
        "no noise: a force that is switched twice a second at 100 Hz has 6 % of them.",
        50.0,
        100.0,
    )
    input_noise_order: int = setting(
        3,
        "count",
        "Order of the differences of a measured force in which its noise is estimated; they "
        "contain little of the motion.",
        1,
        20,
    )
    input_noise_time: float = setting(
        0.05,
        "correlation time",
        "Start of the fitted noise of a measured force: that of a force with the assumed level of "
        "the disturbance and this correlation time, in those of the disturbance.",
        low=1e-6,
    )
    finest_noise: float = setting(
        1e-4,
        "1",
        "Lower bound of sensor noise, relative to the length, to a radian and to the Froude "
        "speed: no instrument is more exact.",
        low=1e-12,
    )
    noise_orders: tuple[int, ...] = setting(
        (2, 3, 4, 5, 6),
        "count",
        "Orders of the differences in which sensor noise is estimated; the motion is smoother "
        "than noise at one of them.",
        1,
        20,
    )
    noise_ratio: float = setting(
        3.0,
        "1",
        "Recordings whose estimated noise differs by more than this factor were made by "
        "different instruments and get noise levels of their own.",
        low=1.0,
    )
    coefficient_uncertainty: float = setting(
        0.05,
        "1",
        "Relative prior sd of the vessel's coefficients of damping, thrust, restoring and wind "
        "where neither the vessel nor the notes specify one.",
        1e-6,
        10.0,
    )
    fastest_froude: float = setting(
        10.0,
        "1",
        "No boat reaches this Froude number; positions that move faster are in another unit.",
        low=1.0,
    )
    fast_share: float = setting(
        0.25,
        "1",
        "Share of the rows that must move faster than `fastest_froude`: a unit concerns all rows, "
        "a jump of the position only a few.",
        0.0,
        1.0,
    )
    command_percentile: float = setting(
        98.0,
        "%",
        "Percentile of the size of a command that counts as the largest one recorded, so that a "
        "single wrong row has no influence.",
        1.0,
        100.0,
    )
