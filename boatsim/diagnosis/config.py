"""The configuration of a diagnosis: all thresholds, priors, tolerances and limits of its stages.

A `DiagnosisConfig` holds frozen groups of settings, named after the stages of
`boatsim.diagnosis.pipeline`: load, check (`checks`), fit, select, decide, describe, plan, adopt,
validate and answer. The stage adopt has no group; it uses `fit.undetermined_sd` and
`validate.harmful`. The groups `filter` and `locate` belong to methods that several stages use.

Each setting has a default, a unit and the reason for its value. Users change settings by their
dotted names, such as `select.odds`: with `boatsim diagnose --set`, or with the argument `settings`
of `boatsim.diagnose`. The values used are written into diagnosis.json. Numbers that only guard
against rounding, define a unit or describe a format stay in the modules that use them.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import Field, dataclass, field, fields, replace
from math import inf, isfinite
from typing import Any, TypeAlias

from boatsim.arguments import short_repr
from boatsim.errors import BadInput, unknown_name_message

Number: TypeAlias = int | float
Plain: TypeAlias = Number | list[Number]  # a setting as JSON has it
Given: TypeAlias = str | Number | Sequence[Number]  # a setting as a user may give it


def setting(
    default: Number | tuple[Number, ...],
    unit: str,
    reason: str,
    low: float = 0.0,
    high: float = inf,
) -> Any:
    """Declare a numerical setting of a diagnosis with its unit, reason and allowed range.

    It is a field of a dataclass that holds the settings of one group.

    Args:
        default: Value used unless the user gives another; its type is the type of the setting.
        unit: Unit of the value, "1" for a ratio, "count" for an integer.
        reason: What the setting does, and why it has this value.
        low: Smallest value allowed.
        high: Largest value allowed.

    Returns:
        A dataclass field that carries the unit, the reason and the range as metadata.
    """
    about = {"unit": unit, "reason": reason, "low": low, "high": high}
    return field(default=default, metadata=about)


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


@dataclass(frozen=True)
class FilterConfig:
    """Settings of the Kalman filter, the smoother and free runs: integration steps, initial states.

    A free run is a simulation from a recorded state with the recorded commands alone.
    """

    free_run_step: float = setting(
        0.02,
        "s",
        "Largest integration step of a free run: the step of the simulation, so that time lags "
        "are averaged alike.",
        low=1e-4,
    )
    filter_step: float = setting(
        0.17,
        "s",
        "Largest integration step of the filter on a hull of 1.2 m; the filter is corrected at "
        "every row and needs no finer one.",
        low=1e-4,
    )
    decay_step: float = setting(
        0.7,
        "1",
        "Largest integration step in time constants of the fastest hull motion at rest; "
        "Runge-Kutta is stable up to 2.8.",
        1e-3,
        2.7,
    )
    phase_error: float = setting(
        0.007,
        "rad",
        "Phase error that Runge-Kutta may accumulate until an oscillation of the hull has died "
        "out.",
        low=1e-6,
    )
    least_damping_ratio: float = setting(
        0.01,
        "1",
        "Damping ratio below which the phase error is judged as if it had this value; the filter "
        "corrects a slower decay before it ends.",
        1e-6,
        1.0,
    )
    initial_force: float = setting(
        3.0,
        "1",
        "Initial rms of the latent force in assumed disturbance levels: moving actuators or a "
        "push by hand may act when a recording begins.",
        low=1e-6,
    )
    rate_time: float = setting(
        1.0,
        "s",
        "Shortest time over which positions are differenced for the prior of the initial rates, so "
        "that their noise does not count as speed.",
        low=1e-3,
    )
    rate_rows: int = setting(4, "count", "The same in rows.", low=1)
    usual_rate: float = setting(
        1.0,
        "m/s, rad/s",
        "Prior sd of an initial rate that a single recorded position does not determine.",
        low=1e-6,
    )
    smoother_passes: int = setting(
        4, "count", "Largest number of smoothing passes about improved initial rates.", low=1
    )
    smoother_tolerance: float = setting(
        0.1,
        "sd",
        "Smoothing is repeated until the initial rates change by less than this.",
        low=0.0,
    )


@dataclass(frozen=True)
class ChecksConfig:
    """Thresholds of the quality checks of recordings, such as units, clock, outliers and signs.

    They include the comparison of a recording with corrected versions of it on the vessel model.
    Durations for a hull of 1.2 m are scaled by Froude's law.
    """

    rest_speed: float = setting(
        0.02,
        "Froude speed",
        "A guided body whose coordinates move less than this speed, over a correlation time of the "
        "disturbance, is at rest; the share of sqrt(g L), and of sqrt(g / L) for angles.",
    )
    rest_wave: float = setting(
        0.05,
        "1",
        "A body does not rest while a recorded wave moves; the share of the largest range of its "
        "elevation that the wave has where it has not arrived or is reflected away.",
        low=0.0,
    )
    rest_min_window: float = setting(
        0.9,
        "1",
        "Share of that time which the window at the end of a recording has at least; rows that are "
        "missing at its edge do not matter.",
        0.0,
        1.0,
    )
    ignored_window: float = setting(
        12.0,
        "correlation times",
        "Time over which the forces that a motion needs are compared with the commanded ones, and "
        "least time in which commands are ignored: longer than the surge of a hull takes.",
        low=1.0,
    )
    ignored_share: float = setting(
        0.25,
        "1",
        "Share of the usual answer to commands below which they are ignored. A drive with half of "
        "its thrust, or a bow into the wind, leaves more.",
        0.0,
        1.0,
    )
    ignored_usual_share: float = setting(
        0.5,
        "1",
        "Share of the commanded forces that the motion must usually show; below it the drives of "
        "the vessel file are wrong throughout.",
        0.0,
        1.0,
    )
    ignored_least_force: float = setting(
        0.7, "usual force", "Commanded force from which an answer can be expected.", 0.0
    )
    ignored_least_speed: float = setting(
        0.1,
        "usual speed",
        "Speed from which a boat counts as moving; one that is aground or at a line does not.",
        0.0,
    )
    push_threshold: float = setting(
        6.0,
        "sd",
        "An unexplained force beyond this many robust standard deviations is a push that was not "
        "recorded; friction and errors of a few per cent of the load stay below 4.",
        low=1.0,
    )
    push_edge: float = setting(
        3.0, "sd", "A push lasts as long as the unexplained force exceeds this.", low=0.5
    )
    push_margin_rows: int = setting(
        2, "count", "Rows before and after a push that are left out, too."
    )
    push_longest_share: float = setting(
        0.25,
        "1",
        "Pushes that take more of a recording than this are no exception: the model lacks a force.",
        0.0,
        1.0,
    )
    probability_evident: float = setting(
        0.99, "1", "Probability of a finding whose evidence has no other explanation.", high=1.0
    )
    probability_strong: float = setting(
        0.95, "1", "Probability of a finding that a rare motion could also cause.", high=1.0
    )
    probability_likely: float = setting(
        0.9, "1", "Probability of a finding that an unusual instrument could also cause.", high=1.0
    )
    probability_possible: float = setting(
        0.7, "1", "Probability of a finding that rests on a small excess over a limit.", high=1.0
    )
    min_verdict_probability: float = setting(
        0.99,
        "1",
        "The verdict of a diagnosis begins with faults of the log from here on.",
        high=1.0,
    )
    hole_duration: float = setting(
        10.0,
        "s",
        "Time without rows in a hull of 1.2 m from which a log has a hole. The command that is "
        "held over it says nothing about the motion behind it.",
        low=0.1,
    )
    hole_min_rows: int = setting(
        60,
        "count",
        "Rows before a hole that suffice to compare reinterpretations.",
        low=2,
    )
    speed_window: float = setting(
        2.0,
        "s",
        "Time over which speeds are averaged in a hull of 1.2 m, so that position noise averages "
        "out.",
        low=0.01,
    )
    pose_clock_max_delay: float = setting(
        4.0,
        "s",
        "Largest delay of the clock of the poses against accelerometers that is looked for, for a "
        "hull of 1.2 m: several periods of its natural motions.",
    )
    pose_clock_max_rate: float = setting(
        0.02, "1", "Largest rate error of that clock; cheap clocks and skipped pictures reach 1 %."
    )
    pose_clock_rates: int = setting(
        6, "count", "Rates on either side of zero that are tried before the refinement.", low=1
    )
    pose_clock_step: float = setting(
        0.05,
        "s",
        "Step of the delays that are tried, a small part of a period.",
        low=1e-3,
    )
    pose_clock_near: float = setting(
        0.03,
        "1",
        "Delays whose correlation before the refinement is this close to the best one are refined.",
    )
    pose_clock_tie: float = setting(
        0.002,
        "1",
        "Delays whose correlation is this close to the best one count as equal, and the smallest "
        "is taken, because a steady oscillation is the same after a period.",
    )
    pose_clock_min_correlation: float = setting(
        0.9,
        "1",
        "Correlation of both accelerations that a corrected clock reaches at least, so that noise "
        "moves no pose.",
        high=1.0,
    )
    pose_clock_max_unexplained: float = setting(
        0.75,
        "1",
        "Share of the disagreement (1 - correlation) that a corrected clock leaves at most.",
        high=1.0,
    )
    pose_clock_max_ratio: float = setting(
        1.5,
        "1",
        "Ratio of the sizes of both accelerations beyond which they are not the same motion.",
        low=1.0,
    )
    pose_clock_margin: float = setting(
        1.5, "1", "Cutoff frequency over that below which nearly all of the energy lies.", low=1.0
    )
    pose_clock_energy_share: float = setting(
        0.95,
        "1",
        "Share of the energy of an accelerometer below the frequency that is multiplied by this "
        "margin; the rest is noise.",
        0.0,
        1.0,
    )
    pose_clock_max_jitter: float = setting(
        0.5,
        "usual steps",
        "Largest difference between the steps of the rows; spectra need equal steps.",
    )
    pose_clock_padding: float = setting(
        0.25,
        "1",
        "Length of the straight line that continues a signal to a whole period, as a share of the "
        "signal, so that it does not jump where it is repeated.",
        0.0,
        10.0,
    )
    pose_clock_neighbours: int = setting(
        2,
        "count",
        "Delays on either side that a delay must surpass to be refined.",
        low=1,
    )
    pose_clock_min_rows: int = setting(
        200, "count", "Rows that a comparison of clocks needs.", low=20
    )
    pose_clock_min_share: float = setting(
        0.5, "1", "Share of the rows with a measured pose that the comparison needs.", high=1.0
    )
    clock_jump_steps: float = setting(
        20.0,
        "1",
        "A time jump is longer than this many usual steps, and than the Froude time; a pause of "
        "the logger is shorter.",
        low=1.0,
    )
    clock_jump_quantile: float = setting(
        0.75,
        "1",
        "Quantile of the steps of the position that is taken as the usual one of a boat under way; "
        "the median may be one at rest.",
        0.0,
        1.0,
    )
    clock_jump_max_distance: float = setting(
        3.0, "1", "Usual steps of the position that a boat moves at most across a time jump."
    )
    clock_jump_expected_distance: float = setting(
        10.0,
        "1",
        "Usual steps of the position that a boat would have moved at its speed during a time jump.",
    )
    clock_speed_rows: int = setting(
        9, "count", "Rows of the moving average of the speed around a time jump.", low=1
    )
    command_excess: float = setting(
        1.05, "1", "Share of a command limit above which another unit is considered.", low=1.0
    )
    command_certain_excess: float = setting(
        3.0,
        "1",
        "Share of a command limit that no drive exceeds, so that the unit must be another one. "
        "Drives exceed the limit of a vessel file by a third, as files are written for another "
        "load or voltage; units that are confused differ by more.",
        low=1.0,
    )
    command_full_per_cent: float = setting(
        99.5, "%", "Commands in per cent reach this, if full command was given and rounded."
    )
    command_min_range: float = setting(
        0.1,
        "1",
        "Share of the limit that a command in its correct unit reaches at least.",
        high=1.0,
    )
    report_outlier_ratio: float = setting(
        8.0,
        "1",
        "Distance from the middle half of the reports of a sensor above which one is impossible, "
        "in widths of this half; a current that follows a throttle stays within four.",
        low=1.0,
    )
    report_beyond_orders: float = setting(
        0.25, "1", "Share of the range of the orders by which a report may exceed them.", low=0.0
    )
    report_change: float = setting(
        0.1, "1", "Share of the range of the orders that counts as a change or a jump.", high=1.0
    )
    report_stale_time: float = setting(
        1.0,
        "s",
        "Shortest time from a change of the order to that of the report that is stale; a drive "
        "answers within a second, and turns gradually.",
        low=0.0,
    )
    report_stale_count: int = setting(
        5, "count", "Stale reports of a recording from which they are stated.", low=1
    )
    stop_margin: float = setting(
        0.05,
        "1",
        "Share of the range of the reports by which an order lies beyond a stop.",
        low=0.0,
    )
    stop_tolerance: float = setting(
        0.01, "1", "Share of this range within which a drive is at its stop.", low=0.0
    )
    stop_quantile: float = setting(
        0.01, "1", "Quantile of the reports that is taken as their end.", high=0.5
    )
    stop_order_share: float = setting(
        0.01, "1", "Share of the rows with an order beyond a stop that shows it.", high=1.0
    )
    stop_share: float = setting(
        0.02, "1", "Share of the rows at a stop that shows it; fewer lie beyond it.", high=1.0
    )
    stop_held_share: float = setting(
        0.5,
        "1",
        "Least share of the orders beyond a stop during which the drive is there; a slow drive "
        "comes near its largest order only now and then.",
        high=1.0,
    )
    response_longest: float = setting(3.0, "s", "Longest dead time of a drive.", low=0.0)
    response_dead_times: int = setting(30, "count", "Dead times that are compared.", low=1)
    response_rate_quantile: float = setting(
        0.9, "1", "Quantile of the rates of the reports that is taken as the usual one.", high=1.0
    )
    response_rates: tuple[float, ...] = setting(
        (0.35, 0.5, 0.7, 0.85, 1.0, 1.2, 1.5),
        "1",
        "Largest rates that are compared, in usual ones.",
    )
    response_lags: tuple[float, ...] = setting(
        (0.0, 0.15, 0.3, 0.6, 1.2), "s", "Lags that are compared."
    )
    response_dead_rows: float = setting(
        2.5, "rows", "Shortest dead time that is stated alone; a logger may take two rows.", low=0.0
    )
    response_error: float = setting(
        0.6,
        "1",
        "Largest error of a response, as a share of the difference between order and report.",
        high=1.0,
    )
    response_gap: float = setting(
        0.01, "1", "Least difference, as a share of the range of the orders.", high=1.0
    )
    direction_turns: float = setting(
        4.0,
        "1",
        "Range in turns above which the direction of a drive may be in degrees: 180 degrees read "
        "as radians are 29 turns, and few logs count the turns of a drive as far as four.",
        low=1.0,
    )
    direction_leap: float = setting(
        1.02,
        "1",
        "Step in turns, between rows, that only a direction in degrees has; one in radians that "
        "wraps moves by a full turn at most, apart from rounding.",
        low=1.0,
    )
    direction_rate: float = setting(
        6.28,
        "rad/s",
        "Rate of turn of a drive that only a direction in degrees has: a turn per second, five "
        "times as fast as the azimuth drives of small boats.",
        low=0.1,
    )
    direction_rate_quantile: float = setting(
        0.5, "1", "Quantile of the rates of turn that is compared with it.", high=1.0
    )
    servo_pulse_range: tuple[float, ...] = setting(
        (900.0, 2100.0),
        "us",
        "Commands in this range are servo pulses, with 1500 us as neutral and 500 us of travel "
        "plus trim.",
    )
    course_window: float = setting(
        1.0, "s", "Length of a stretch of the course on a hull of 1.2 m.", low=0.01
    )
    course_max_turn: float = setting(
        0.2,
        "rad",
        "The heading changes less over a straight stretch and over the one before it, so that "
        "the drift angle of turns has died out.",
    )
    course_min_window: float = setting(
        0.9,
        "1",
        "Share of `course_window` that a stretch lasts at least; shorter ones end at a gap or at "
        "the end of the recording.",
        0.0,
        1.0,
    )
    course_speed_quantile: float = setting(
        0.9,
        "1",
        "Quantile of the distance per stretch that is taken as the one at high speed.",
        0.0,
        1.0,
    )
    course_min_speed: float = setting(
        0.5,
        "1",
        "Share of the distance per stretch at high speed, below which noise dominates the "
        "direction of the course.",
    )
    course_min_stretches: int = setting(
        8, "count", "Straight stretches needed to estimate a heading offset.", low=1
    )
    course_min_variation: float = setting(
        0.03,
        "1",
        "Share of the squared distance that must vary with the heading, so that a current is "
        "distinguished from a heading offset.",
    )
    course_max_residual: float = setting(
        0.1, "1", "Share of that variation that an offset and a current may leave unexplained."
    )
    excitation_min_heading_span: float = setting(
        1.0,
        "rad",
        "Range of headings needed to distinguish wind or current from a force fixed to the hull.",
    )
    excitation_min_speed_variation: float = setting(
        0.2, "1", "Range of the speed over its mean needed to identify nonlinear damping."
    )
    excitation_speed_quantiles: tuple[float, ...] = setting(
        (0.05, 0.95),
        "1",
        "Quantiles of the speed between which this range lies, so that outliers do not widen it.",
        0.0,
        1.0,
    )
    excitation_min_command_span: float = setting(
        0.02, "1", "Share of its range within which a command is considered constant."
    )
    excitation_min_speed_rows: int = setting(
        10, "count", "Rows needed to judge the variation of the speed.", low=1
    )
    saturation_min_share: float = setting(
        0.5, "1", "Share of the rows at a limit from which a command is reported as saturated."
    )
    saturation_tolerance: float = setting(
        1e-3, "1", "Share of its range by which a command may differ from its limit: rounding."
    )
    initial_rest_gain: float = setting(
        6.0,
        "nats",
        "Gain in log likelihood needed to assume that the actuators begin at rest: odds of 400 "
        "to 1.",
    )
    initial_rest_speed: float = setting(
        0.2, "1", "A boat below this share of its largest speed lies still in the first row."
    )
    interpolation_min_rows: int = setting(
        30, "count", "Rows needed to recognize interpolated positions.", low=5
    )
    interpolation_max_correlation: float = setting(
        -0.5,
        "1",
        "Lag-one autocorrelation of fourth differences below which they are noise; white noise "
        "has -0.8.",
        low=-1.0,
        high=1.0,
    )
    interpolation_noise_quantiles: tuple[float, ...] = setting(
        (0.05, 0.95),
        "1",
        "Quantiles to which these differences are limited, so that single jumps do not decide.",
        0.0,
        1.0,
    )
    interpolation_min_noise_digits: float = setting(
        5.0,
        "1",
        "Median size of fourth differences in units of the last digit that is more than "
        "rounding, which yields 1.6.",
    )
    interpolation_max_chance: float = setting(
        1e-4, "1", "Expected number of such runs by chance, at most.", high=1.0
    )
    interpolation_window: int = setting(
        30, "count", "Rows on either side with which a run of equal steps is compared.", low=1
    )
    interpolation_max_local_chance: float = setting(
        1e-3, "1", "Largest probability of a run, given the equal steps around it.", high=1.0
    )
    interpolation_min_run: int = setting(
        3,
        "count",
        "Rows in a run of equal steps, at least; two occur by chance where the noise varies.",
        low=1,
    )
    interpolation_min_share: float = setting(
        0.3,
        "1",
        "Share of rows on straight lines from which a sensor's values were interpolated; noise "
        "of eight digits yields 0.14.",
        high=1.0,
    )
    interpolation_min_runs: int = setting(
        20,
        "count",
        "Stretches of interpolated rows, at least; a steady turn in a log without noise is one.",
        low=1,
    )
    interpolation_max_run_ratio: float = setting(
        40.0,
        "1",
        "Longest stretch of interpolated rows relative to the median one; a vessel at rest is "
        "longer.",
        low=1.0,
    )
    interpolation_min_bend: float = setting(
        8.0,
        "digits",
        "Median deviation from straight lines at the other rows, in units of the last digit; "
        "rounding alone yields 1 to 2.",
        low=2.0,
    )
    rotation_min_sds: float = setting(
        10.0,
        "1",
        "Standard deviations by which the share of rotation in the positions must differ from 0.",
    )
    rotation_tolerance: float = setting(
        0.5,
        "1",
        "Difference from 1 allowed in that share: heading noise reduces it, and correct "
        "positions have a share near 0.",
    )
    jump_min_step: float = setting(
        3.0, "1", "A jump is larger than this multiple of a high quantile of all steps.", low=1.0
    )
    jump_step_quantile: float = setting(
        0.99, "1", "The quantile in the setting `jump_min_step`.", 0.0, 1.0
    )
    jump_min_rows: int = setting(
        8,
        "jump_course_rows",
        "Rows in which jumps are sought, at least; in fewer the usual gap is not known.",
        low=2,
    )
    jump_sampled_rows: int = setting(
        200, "count", "Rows, evenly spaced, from which the usual gap is computed.", low=1
    )
    jump_min_gap: float = setting(
        20.0, "1", "Usual gaps between the courses before and after a row by which one is a jump."
    )
    jump_course_rows: int = setting(
        5, "count", "Rows on either side of a jump through which the course is fitted.", low=2
    )
    jump_min_spacing: int = setting(
        50,
        "rows",
        "Rows per large step, at least; with more large steps the signal is noisy, and none is a "
        "jump.",
        low=1,
    )
    jump_spare_steps: int = setting(
        3,
        "count",
        "Large steps in addition to these that are allowed: a short recording may have some jumps.",
        low=0,
    )
    jump_min_share: float = setting(
        0.5, "1", "Share of a step that must persist, so that it is a jump and no outlier."
    )
    excursion_max_rest: float = setting(
        0.4,
        "1",
        "Share of a jump that may remain after a later jump has taken it back: the boat moves and "
        "the fixes scatter in both rows.",
        0.0,
        1.0,
    )
    excursion_max_share: float = setting(
        0.3,
        "1",
        "Longest time between a jump and the one that takes it back, as a share of the recording: "
        "in a longer part it is not known which part is wrong.",
        0.0,
        1.0,
    )
    outlier_max_duration: float = setting(
        1.5, "s", "Longest duration of an outlier on a hull of 1.2 m; longer ones may be motion."
    )
    outlier_min_sds: float = setting(
        10.0, "1", "Standard deviations of the prediction error from which a fix is an outlier."
    )
    outlier_max_acceleration: float = setting(
        1.5, "1", "Usual accelerations that a boat may have during an outlier."
    )
    outlier_speed_fixes: int = setting(
        6, "count", "Fixes from which the speed before an outlier is estimated.", low=2
    )
    outlier_speed_slack: float = setting(
        0.1, "1", "Share of an outlier by which its threshold grows with each further step."
    )
    outlier_return_fixes: int = setting(
        4, "count", "Fixes for which the course must continue after an outlier.", low=1
    )
    outlier_min_return: float = setting(
        0.5,
        "1",
        "Share of the deviation that disappears within one row when an outlier ends.",
        high=1.0,
    )
    outlier_search_rows: int = setting(
        200, "count", "Rows after a fix in which the end of an outlier is sought.", low=2
    )
    outlier_noise_quantile: float = setting(
        0.95,
        "1",
        "Quantile of the prediction errors that gives their noise: two standard deviations of a "
        "normal variable.",
        high=1.0,
    )
    start_course_fixes: int = setting(
        8, "count", "Fixes through which a parabola is fitted to judge the fix before them.", low=4
    )
    start_max_outliers: int = setting(
        3, "count", "Outliers that are sought at the beginning of a recording, at most.", low=1
    )
    start_min_sds: float = setting(
        6.0, "1", "Standard deviations from the parabola by which a first fix is an outlier."
    )
    position_min_rows: int = setting(10, "count", "Positions needed to judge their unit.", low=2)
    degrees_max_width: float = setting(
        1.0, "deg", "Largest extent of a log in latitude and longitude, 111 km."
    )
    degrees_min_offset: float = setting(
        100.0, "1", "Latitude and longitude are this many extents away from 0, metres are not."
    )
    position_min_froude: float = setting(0.003, "1", "Smallest Froude number of a boat under way.")
    position_max_froude: float = setting(
        2.0, "1", "Largest Froude number of a boat; beyond it boats plane or fly on foils."
    )
    position_impossible_froude: float = setting(10.0, "1", "Froude number that no boat reaches.")
    rates_window: float = setting(
        1.0, "s", "Time over which positions are differenced on a hull of 1.2 m.", low=0.01
    )
    rates_min_rows: int = setting(
        30, "count", "Rows needed to compare a rate with the positions.", low=3
    )
    rates_min_correlation: float = setting(
        0.9, "1", "Correlation from which two rates are those of the same motion.", high=1.0
    )
    rates_min_delay_correlation: float = setting(
        0.3, "1", "Correlation from which a delay between two rates is sought.", high=1.0
    )
    rates_size_ratio: float = setting(
        1.5, "1", "Rates of the same unit differ in size by less than this factor.", low=1.0
    )
    rates_unit_tolerance: float = setting(
        1.2, "1", "Factor by which a ratio may differ from the ratio of two units.", low=1.0
    )
    rates_min_delay: float = setting(
        0.1, "s", "Smallest delay that is reported, on a hull of 1.2 m."
    )
    rates_max_delay: float = setting(2.0, "s", "Largest delay that is sought, on a hull of 1.2 m.")
    rates_min_delay_rows: int = setting(
        2, "rows", "Smallest delay that is reported; a delay of one row is that of a logger.", low=1
    )
    rates_min_durations: int = setting(
        10, "1", "Duration of a recording in largest delays, so that enough of it remains.", low=3
    )
    rates_max_delay_residual: float = setting(
        0.3, "1", "Share of the mean square difference that a delay may leave."
    )
    rates_min_lever: float = setting(
        0.1, "length", "Distance between two points of the hull that is reported."
    )
    rates_max_lever_residual: float = setting(
        0.5, "1", "Share of the variance of the difference that a lever may leave."
    )
    rates_min_difference: float = setting(
        0.02, "1", "Mean square difference, relative to the rate, that needs an explanation."
    )
    clock_stretch_rows: int = setting(
        20,
        "count",
        "Rows over which the clock rate by the track is compared with that by the heading.",
        low=2,
    )
    clock_min_turn: float = setting(
        0.05,
        "rad",
        "Change of heading over such rows from which it tells a clock rate: 3 degrees, ten times "
        "the resolution of most compasses.",
    )
    clock_min_stretches: int = setting(
        12, "count", "Stretches with such a change that are needed for a statement.", low=4
    )
    clock_min_agreement: float = setting(
        0.9,
        "1",
        "Share of these stretches in which heading and yaw rate turn in the same sense; with less "
        "one of them is wrong, and neither shows the clock.",
        0.0,
        1.0,
    )
    clock_min_correlation: float = setting(
        0.5,
        "1",
        "Correlation between both clock rates from which a wander of the clock is reported; a "
        "sensor that is wrong alone yields none.",
        high=1.0,
    )
    clock_min_sds: float = setting(
        5.0, "1", "Standard deviations by which a correlation or a rate must be certain."
    )
    clock_min_wander: float = setting(
        0.02,
        "1",
        "Standard deviation of the clock rate from which a wander is reported: over a free run "
        "it is as large as other errors of a good model.",
    )
    clock_stated_quantiles: tuple[float, ...] = setting(
        (0.05, 0.95),
        "1",
        "Quantiles of the clock rate that the finding of a wander states.",
        0.0,
        1.0,
    )
    clock_min_rate: float = setting(
        0.03,
        "1",
        "Constant error of the clock rate that is reported; delays and interpolation of sensors "
        "cause up to 0.025 in turns.",
    )
    clock_min_track_share: float = setting(
        0.5,
        "1",
        "Share of that error which the track must show over all stretches, straight ones included; "
        "delays and interpolation act in turns only.",
        0.0,
        1.0,
    )
    clock_gain_sds: float = setting(
        3.0,
        "1",
        "Standard deviations by which a gain of velocities must be certain that is reported with "
        "an error of the clock.",
    )
    clock_min_gain: float = setting(
        0.01, "1", "Relative error of recorded velocities that is reported with that of the clock."
    )
    rudder_response_time: float = setting(
        3.5,
        "(length / gravity)^1/2",
        "Time in which a hull responds to its rudder: it travels half its length at Froude "
        "number 0.14.",
        low=0.01,
    )
    rudder_min_correlation: float = setting(
        0.3,
        "1",
        "Correlation of rudder and turn from which the sign of the rudder is certain.",
        high=1.0,
    )
    time_max_step: float = setting(
        5.0,
        "s",
        "Rows further apart cannot be followed on a hull of 1.2 m, which then travels four "
        "lengths.",
        low=0.01,
    )
    time_usual_step: float = setting(
        0.1, "s", "Usual distance between the rows of a log.", low=1e-6
    )
    time_step_tolerance: float = setting(
        100.0, "1", "Factor by which the rows of a log may differ from the usual distance.", low=1.0
    )
    share_min_command: float = setting(
        0.2, "1", "Largest command from which commands may be shares of full command."
    )
    share_max_range: float = setting(
        0.12, "1", "Commands up to 1 are shares if 1 is less than this part of the limit."
    )
    percent_min_command: float = setting(
        20.0, "per cent", "Largest command from which commands may be per cent of full command."
    )
    percent_max_range: float = setting(
        0.5, "1", "Commands up to 100 are per cent if 100 is less than this part of the limit."
    )
    per_cent_min_rounded: float = setting(
        0.99,
        "1",
        "Share of the commands with one decimal at most, as per cent are written.",
        high=1.0,
    )
    per_cent_min_ratio: float = setting(
        1.15,
        "1",
        "Ratio of full thrust ahead and astern from which per cent in place of newtons looks like "
        "a weak reverse.",
        low=1.0,
    )
    per_cent_min_lead: float = setting(
        1.0,
        "nats",
        "Lead over newtons with a weak reverse, which gives the same motion with one more "
        "number: per cent lead by 2 to 7 nats, and a weak reverse that is not the ratio of full "
        "thrust by -39 nats.",
    )
    per_cent_min_levels: int = setting(
        10,
        "count",
        "Different commands from which their rounding is no choice of the pilot.",
        low=1,
    )
    heading_min_offset: float = setting(
        0.3, "rad", "Angle between heading and course from which reinterpretations are compared."
    )
    heading_min_agreement: float = setting(
        0.7, "1", "Agreement of that angle over a log from which it is no accident.", high=1.0
    )
    heading_min_improvement: float = setting(
        0.2, "1", "Increase of the agreement by which a mirrored heading fits better.", high=1.0
    )
    heading_min_rotation: float = setting(
        0.2, "rad", "Smallest rotation of the heading that is compared; less is a compass error."
    )
    unexplained_max_share: float = setting(
        0.5,
        "1",
        "Unexplained force, relative to the force of the drives, from which reinterpretations "
        "are compared.",
    )
    unexplained_min_lever: float = setting(
        0.08,
        "length",
        "Least lever of the drives in yaw to which an unexplained moment is related, for drives "
        "that hardly turn the hull.",
    )
    unexplained_rows: int = setting(
        100, "count", "Rows, evenly spaced, from which the force of the drives is computed.", low=1
    )
    compare_min_gain: float = setting(
        60.0, "nats", "Evidence that a reinterpretation must gain over the log as recorded."
    )
    compare_min_gain_per_row: float = setting(
        0.05, "nats", "The same for each row: small errors of a model add up in a long log."
    )
    compare_min_lead: float = setting(
        25.0,
        "nats",
        "Lead in evidence over the log as recorded, and over reinterpretations that are not "
        "mentioned as alternatives.",
    )
    compare_tie_gain: float = setting(
        3.0,
        "nats",
        "Reinterpretations within this evidence are tied: on a symmetric boat mirrored axes "
        "equal exchanged drives.",
    )
    compare_lead_scale: float = setting(
        4.0, "nats", "Lead that reduces the probability of an error by the factor e.", low=1e-3
    )
    compare_max_rows: int = setting(
        1200, "count", "Rows of all recordings that are compared; a fault concerns all.", low=60
    )
    compare_max_recordings: int = setting(3, "count", "Recordings that are compared.", low=1)
    compare_max_rate: float = setting(
        1.5,
        "1",
        "Multiple of the usual row rate above which the rows are reduced, because each "
        "instrument then has separate rows.",
        low=1.0,
    )
    compare_max_candidates: int = setting(
        6, "count", "Reinterpretations with refitted coefficients, the likeliest ones.", low=1
    )
    compare_max_faults: int = setting(2, "count", "Faults of one log that are sought.", low=1)
    late_min_delay: float = setting(
        0.1, "s", "Smallest delay of positions or heading that is sought, on a hull of 1.2 m."
    )
    late_max_delay: float = setting(2.0, "s", "Largest such delay, on a hull of 1.2 m.", low=0.1)
    late_min_durations: float = setting(
        8.0, "1", "Duration of a recording in largest delays, so that enough of it remains."
    )
    late_max_rivals: int = setting(
        4, "count", "Effects that may together explain a log on time in place of a delay.", low=1
    )
    late_rival_gain: float = setting(
        3.0, "nats", "Evidence that each of them must add, as for an effect of a new vessel."
    )
    rotation_coarse_step: float = setting(
        15.0, "deg", "Distance between the rotations of the heading compared first.", low=1.0
    )
    rotation_step: float = setting(
        4.0, "deg", "Distance between the rotations with refitted coefficients.", low=0.1
    )
    rotation_steps: int = setting(
        4, "count", "Such rotations on either side of the likeliest one.", low=1
    )
    rotation_min_distance: float = setting(
        35.0, "deg", "Rotations of the heading within this distance are one fault."
    )
    rotation_quarter_tolerance: float = setting(
        4.0, "deg", "A rotation within this distance of a quarter turn is the quarter turn."
    )


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
        700_000_000,
        "steps x dof",
        "Work of the search: integration steps in every pass of the filter, times degrees of "
        "freedom, and the covariances of the filter. Recordings of a minute and a half need 2 to "
        "12 million. 700 million take 2 to 5 minutes; then the search ends and reports what it "
        "has not tried.",
        low=1,
    )
    again_share: float = setting(
        0.5,
        "1",
        "Share of the work of the first search that must remain for a second one with another "
        "correlation time of the latent force; that correlation time is sought only then.",
        low=0.0,
    )
    thorough_work: int = setting(
        60_000_000,
        "steps x dof",
        "Work of the search, about 20 seconds, after which it saves work. Recordings of a minute "
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
        2.0, "standard errors", "Errors must grow by more than this to refute an effect.", low=0.0
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


@dataclass(frozen=True)
class DescribeConfig:
    """Settings of the symbolic regression of a force that no candidate effect explains."""

    most_terms: int = setting(
        5, "count", "Largest number of terms: a longer formula would explain noise.", low=0
    )
    force_placeholders: int = setting(
        5,
        "count",
        "Placeholder effects for forces in the compiled program of a diagnosis, so that a term "
        "needs no compilation: as many as a formula has terms. Another number compiles a program.",
        low=0,
    )
    thrust_placeholders: int = setting(
        2,
        "count",
        "The same for changes of the thrust: one for each of two drives, or for each direction.",
        low=0,
    )
    budget: int = setting(
        750_000_000,
        "steps x dof",
        "Work of the description, counted as in `select.budget`; then no further term is sought. "
        "Recordings of a minute and a half need 2 to 10 million, half an hour of "
        "zig-zags between 250 and 750 million.",
        low=1,
    )
    total_budget: int = setting(
        1_000_000_000,
        "steps x dof",
        "Work of a whole diagnosis up to the end of the description, so that it ends within ten "
        "minutes of CPU: where the search used its budget, less is left to the description. Half "
        "an hour of zig-zags needs 200 million before the description.",
        low=1,
    )
    fitted_terms: int = setting(
        4,
        "count",
        "Best terms by approximate evidence that are fitted with the filter for each new term.",
        low=1,
    )
    general_improvement: float = setting(
        0.98,
        "1",
        "A term generalizes if it reduces the mean square error of free runs over held-out "
        "recordings to less than this share; smaller reductions are chance.",
        0.01,
        1.0,
    )
    coarse_refinement: tuple[float, ...] = setting(
        (0.5, 0.25),
        "grammar steps",
        "Changes of the times or lengths of a new term that are scored by approximate evidence.",
        1e-3,
        1.0,
    )
    fine_refinement: tuple[float, ...] = setting(
        (0.12, 0.06, 0.03, 0.015),
        "grammar steps",
        "Smaller changes that are judged by the likelihood of the filter, whose accuracy they "
        "need.",
        1e-4,
        1.0,
    )
    wavelength_step: float = setting(
        0.15,
        "1",
        "Change of a wavelength by one grammar step, as a share of it: about the distance between "
        "the wavelengths that are tested.",
        1e-3,
        1.0,
    )
    oscillation_step: float = setting(
        0.5,
        "periods",
        "Change of the number of periods in a recording by one grammar step: the distance between "
        "the periods that are tested.",
        1e-3,
        10.0,
    )
    refinement_moves: int = setting(
        3, "count", "Largest number of moves of a term with one size of change.", low=1
    )
    refinement_turns: int = setting(
        4,
        "count",
        "Largest number of turns in which a term is moved and all parameters are fitted again.",
        low=0,
    )
    least_move_gain: float = setting(
        0.1, "nats", "A move of a term must increase the log likelihood by more than this.", low=0.0
    )
    recording_parts: int = setting(
        16,
        "count",
        "Parts of a recording; the intervals in which a term may act begin and end at their "
        "limits.",
        low=2,
    )
    interval_lengths: tuple[int, ...] = setting(
        (1, 2, 4, 8), "parts", "Lengths of these intervals, in ascending order.", 1
    )
    fading_spans: tuple[float, ...] = setting(
        (1.0, 0.5, 0.25, 0.125),
        "recordings",
        "Time constants of fading terms, relative to the length of the recordings.",
        1e-3,
        10.0,
    )
    most_oscillations: int = setting(
        60, "count", "Largest number of periods of an oscillating force in a recording.", low=1
    )
    most_thrust_oscillations: int = setting(
        8,
        "count",
        "Largest number of periods of an oscillating change of thrust in a recording; drives "
        "change slowly.",
        low=1,
    )
    shortest_period: float = setting(
        6.0,
        "rows",
        "Shortest period of an oscillation that the rows of a recording resolve.",
        low=2.0,
    )
    threshold_shares: tuple[float, ...] = setting(
        (0.2, 0.4, 0.6, 0.8),
        "1",
        "Thresholds of a speed, as the share of the rows below them.",
        0.0,
        1.0,
    )
    wavelengths: int = setting(
        24, "count", "Number of wavelengths of a pattern that is fixed to the earth.", low=2
    )
    shortest_wavelength: float = setting(
        0.5, "lengths", "Shortest such wavelength: the hull averages over shorter ones.", low=0.01
    )
    memories: int = setting(
        6, "count", "Number of time constants of averages of commands over the past.", low=2
    )
    shortest_memory: float = setting(
        2.0,
        "rows",
        "Shortest of these time constants that the rows of a recording resolve.",
        low=0.1,
    )
    longest_memory: float = setting(
        0.25,
        "recordings",
        "Longest of these time constants, relative to the longest recording; longer averages are "
        "almost constant.",
        1e-3,
        10.0,
    )


@dataclass(frozen=True)
class PlanConfig:
    """Settings for designing the experiment to record next."""

    min_gain: float = setting(
        1.0,
        "nats",
        "Expected log Bayes factor against the closest rival that a manoeuvre must exceed to be "
        "proposed.",
    )
    min_candidate_gain: float = setting(
        1.0,
        "nats",
        "Evidence gain of a candidate about which a manoeuvre is proposed if no effect was "
        "identified.",
    )
    max_candidates: int = setting(
        3, "count", "Candidates that are compared if no effect was identified.", low=1
    )
    refit_steps: int = setting(
        3, "count", "Gauss-Newton steps in which a rival is refitted to an expected motion.", low=0
    )
    refit_halvings: int = setting(
        3, "count", "Halvings of such a step that does not increase the posterior.", low=1
    )
    refit_min_gain: float = setting(
        0.1, "nats", "Such a refit ends when a step gains less than this."
    )
    posterior_step: float = setting(
        0.05,
        "posterior sd",
        "Step of a parameter for the derivative of an expected motion by it.",
        1e-6,
        1.0,
    )
    boat_duration: float = setting(
        40.0, "s", "Duration of a manoeuvre of a boat of 1.2 m.", low=1.0
    )
    ship_duration: float = setting(
        80.0,
        "s",
        "Duration of a manoeuvre of a ship model of 1.2 m, which responds slowly.",
        low=1.0,
    )
    command_tick: float = setting(
        0.5, "s", "Commands of a hull of 1.2 m change at multiples of this time.", low=0.01
    )
    random_levels: tuple[float, ...] = setting(
        (0.15, 0.35, 0.6, 0.9),
        "1",
        "Shares of a command's limit in random steps: gentle to strong, below saturation.",
        high=1.0,
    )
    quick_holds: tuple[float, ...] = setting(
        (1.0, 3.0), "s", "Shortest and longest hold of quick random steps.", low=0.01
    )
    slow_holds: tuple[float, ...] = setting(
        (4.0, 8.0), "s", "Shortest and longest hold of slow random steps.", low=0.01
    )
    ship_holds: tuple[float, ...] = setting(
        (4.0, 12.0), "s", "Shortest and longest hold of random rudder steps of a ship.", low=0.01
    )
    steering_difference: float = setting(
        0.5,
        "1",
        "Difference of thrust per side for a full steering angle, in shares of the limit, on a "
        "vessel without steering angles.",
    )
    zigzag_angles: tuple[float, ...] = setting(
        (10.0, 20.0),
        "deg",
        "Rudder and heading of zig-zags, as in the standards for ship manoeuvrability of the IMO "
        "(MSC.137(76)).",
        low=1.0,
        high=90.0,
    )
    max_switches: int = setting(
        40, "count", "Reversals of the rudder in a zig-zag, at most.", low=1
    )
    release_shares: tuple[float, ...] = setting(
        (0.5, 1.5), "1", "Roll angles of proposed releases, in shares of the largest recorded one."
    )
    max_release_angle: float = setting(0.5, "rad", "Largest roll angle of a proposed release.")
    wall_clearance: float = setting(
        0.6, "length", "Distance of the hull's centre from a wall for which a course is planned."
    )
    wall_contact: float = setting(
        0.5, "length", "Distance of the hull's centre from a wall at which an end would touch it."
    )
    min_share_in_tank: float = setting(
        0.5, "1", "Share of a manoeuvre that must take place before a wall is reached.", high=1.0
    )


@dataclass(frozen=True)
class DiagnosisConfig:
    """All settings of a diagnosis (thresholds, priors, tolerances, limits), grouped by stage.

    The groups `filter` and `locate` belong to methods that several stages use.
    """

    load: LoadConfig = LoadConfig()
    checks: ChecksConfig = ChecksConfig()
    fit: FitConfig = FitConfig()
    select: SelectConfig = SelectConfig()
    decide: DecideConfig = DecideConfig()
    describe: DescribeConfig = DescribeConfig()
    plan: PlanConfig = PlanConfig()
    validate: ValidateConfig = ValidateConfig()
    answer: AnswerConfig = AnswerConfig()
    filter: FilterConfig = FilterConfig()
    locate: LocateConfig = LocateConfig()


DEFAULT = DiagnosisConfig()


def from_settings(settings: Mapping[str, Given]) -> DiagnosisConfig:
    """Return the default configuration of a diagnosis with some settings changed.

    Args:
        settings: Values by dotted name, such as {"select.odds": 3.0}; text is read as a number.

    Raises:
        BadInput: A name does not exist, or a value has the wrong type or is out of range.
    """
    declared = {f"{group}.{one.name}": (group, one) for group, one in _all_settings()}
    config = DEFAULT
    for name, given in settings.items():
        if name not in declared:
            raise BadInput(unknown_name_message("setting", name, declared))
        group, one = declared[name]
        changed = replace(getattr(config, group), **{one.name: _check_value(name, one, given)})
        config = replace(config, **{group: changed})
    return config


def settings_by_name(config: DiagnosisConfig) -> dict[str, Plain]:
    """Return all settings of a diagnosis as a dictionary from dotted names to values.

    For example, "select.odds" is the key of the setting `odds` in the group `select`. Tuples become
    lists.
    """
    plain: dict[str, Plain] = {}
    for group, one in _all_settings():
        value = getattr(getattr(config, group), one.name)
        if isinstance(value, tuple):
            value = list(value)
        plain[f"{group}.{one.name}"] = value
    return plain


def _all_settings() -> Iterator[tuple[str, "Field[Any]"]]:
    """Yield the name of the group and the field of every setting."""
    for group in fields(DiagnosisConfig):
        for one in fields(getattr(DEFAULT, group.name)):
            yield group.name, one


def _check_value(name: str, one: "Field[Any]", given: Given) -> Number | tuple[Number, ...]:
    """Return a given value in the type of its setting. Raises BadInput."""
    if not isinstance(one.default, tuple):
        return _check_number(name, one, given)
    values: Sequence[str | Number]
    if isinstance(given, str):
        values = given.strip("[]()").split(",")
    elif isinstance(given, Sequence):
        values = given
    else:
        values = [given]
    if len(values) != len(one.default):
        needed = f"{len(one.default)} numbers are needed"
        raise BadInput(f"setting {name} = {short_repr(given)}: {needed}")
    return tuple(_check_number(name, one, value) for value in values)


def _check_number(name: str, one: "Field[Any]", given: object) -> Number:
    """Return a number of a setting in its type and range. Raises BadInput."""
    first = one.default[0] if isinstance(one.default, tuple) else one.default
    whole = isinstance(first, int)
    about = one.metadata
    allowed = f"{'an integer' if whole else 'a number'} from {about['low']:g} to {about['high']:g}"
    allowed = f"{allowed} [{about['unit']}]"
    refused = BadInput(f"setting {name} = {short_repr(given)}: allowed is {allowed}")
    if isinstance(given, bool) or not isinstance(given, str | int | float):
        raise refused
    try:
        value = float(given)
    except (ValueError, OverflowError):
        raise refused from None
    if not isfinite(value) or not about["low"] <= value <= about["high"]:
        raise refused
    if not whole:
        return value
    if value != int(value):
        raise refused
    return int(value)
