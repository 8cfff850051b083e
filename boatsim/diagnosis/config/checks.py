"""Settings of the checks of recordings: what counts as a fault of a log."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


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
    # The reference is the median of a recording, which needs no nominal voltage. The law of
    # `thrust_with_voltage` limits the voltage to the same shares of the nominal one, in simulations
    # too
    voltage_least_share: float = setting(
        0.5,
        "1",
        "Share of the median of a measured voltage below which a reading is an outlier. A battery "
        "in use stays within a third of its usual voltage; a drive that runs has no less.",
        0.0,
        1.0,
    )
    voltage_largest_share: float = setting(
        1.5,
        "1",
        "Share of the median of a measured voltage above which a reading is an outlier, for the "
        "same reason.",
        low=1.0,
    )
    voltage_outlier_share: float = setting(
        0.2,
        "1",
        "Share of the readings of a voltage up to which they are outliers. More of them are no "
        "errors of single rows: the supply was off, or another one was measured.",
        0.0,
        0.5,
    )
    current_rows: int = setting(
        5,
        "count",
        "Readings of an electric current, itself included, with whose median a reading is "
        "compared. A fault of an instrument lasts one or two rows.",
        3,
    )
    current_window: float = setting(
        1.0,
        "s",
        "Longest time that these readings take on a hull of 1.2 m; in a slow log they are fewer. A "
        "burst of thrust lasts longer than half of it.",
        low=0.01,
    )
    current_repeated_ratio: float = setting(
        2.0,
        "1",
        "Single readings of a current that jump by sizes within this ratio are repeated bursts of "
        "thrust, not outliers, where a log is too slow for that many readings. Errors of an "
        "instrument are of any size.",
        low=1.0,
    )
    current_largest_jump: float = setting(
        1.0,
        "1",
        "Difference of a reading of a current from the median around it, over the largest of "
        "these medians, above which it is an outlier. The current of a motor that starts is "
        "higher than its largest steady one for less than a row, and by less than this.",
        0.1,
    )
    current_outlier_share: float = setting(
        0.2,
        "1",
        "Share of the readings of a current up to which they are outliers, for the same reason as "
        "with voltages.",
        0.0,
        0.5,
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
    held_fewest: int = setting(
        2,
        "count",
        "Commands between rest and limit that stay the same together where a log repeats the last "
        "ones. A single one may rest.",
        low=1,
    )
    held_changes: int = setting(
        200,
        "count",
        "Changes of commands from which the usual time between them is known to one per cent.",
        low=10,
    )
    held_usual_share: float = setting(
        0.99, "1", "Share of the times between changes that count as usual.", 0.0, 1.0
    )
    held_longest: float = setting(
        2.0,
        "s",
        "Longest time over which the commands of a hull of 1.2 m count as held. For longer a "
        "helm may have kept them.",
        low=0.01,
    )
    held_times: float = setting(
        5.0,
        "1",
        "Usual times between changes from which commands are held. Two or three messages are "
        "often lost.",
        low=1.0,
    )
    held_leap: float = setting(
        0.75,
        "1",
        "Share of the changes of commands that are smaller than the one behind a time over which "
        "they are held.",
        0.0,
        1.0,
    )
    held_poses: int = setting(
        5,
        "count",
        "New poses while commands stay the same that show that the log goes on, and rows before "
        "and behind in which commands must change.",
        low=1,
    )
    held_moving: float = setting(
        0.5, "1", "Share of these rows in which a command changes.", 0.0, 1.0
    )
    held_rest: float = setting(
        0.01,
        "1",
        "Share of the range of a command within which it is at rest or at a limit, where it may "
        "stay the same.",
        0.0,
        0.5,
    )
    silent_input: float = setting(
        0.05,
        "1",
        "Share of its range by which a command must move to show that a recording of poses without "
        "any change is no rest.",
        low=0.0,
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
    command_clock_max_delay: float = setting(
        1.0,
        "s",
        "Largest delay between commands and motion that is sought in a single recording, on a hull "
        "of 1.2 m; stamps of loggers and filters of sensors differ by less.",
        low=0.1,
    )
    command_clock_step: float = setting(
        0.1, "s", "Distance of the delays that are compared first, on a hull of 1.2 m.", low=1e-3
    )
    command_clock_tolerance: float = setting(
        0.002, "1", "Tolerance of the likeliest delay, as a share of that distance.", low=1e-6
    )
    command_clock_derivative: float = setting(
        0.1, "1", "Step of derivatives by the delay, as a share of that distance.", low=1e-3
    )
    command_clock_intervals: int = setting(
        16,
        "count",
        "Intervals of a file whose scores scatter; each is longer than the correlation time of "
        "the unexplained force.",
        low=4,
    )
    command_clock_min_files: int = setting(
        4,
        "count",
        "Files from which one of them can differ from the others; of fewer files it is unclear "
        "which is right.",
        low=3,
    )
    command_clock_max_share: float = setting(
        0.34, "1", "Largest share of the files that may differ from the others.", high=0.49
    )
    command_clock_scatter: float = setting(
        0.01,
        "s",
        "Expected scatter of the delays of files with equal clocks, on a hull of 1.2 m, which "
        "different manoeuvres cause in a vessel model that is not exact.",
        low=1e-4,
    )
    command_clock_scatter_weight: float = setting(
        4.0,
        "count",
        "Number of files whose scatter has the weight of this expectation.",
    )
    command_clock_min_delay: float = setting(
        0.03, "s", "Smallest difference of a clock that is reported, on a hull of 1.2 m."
    )
    command_clock_min_sds: float = setting(
        5.0, "sd", "Deviation from the other files beyond which a clock differs.", low=3.0
    )
    command_clock_suspect_sds: float = setting(
        2.0,
        "sd",
        "Deviation of a file from the others from which its clock is examined: before the file "
        "is corrected and the vessel fitted again, its uncertainty is overestimated.",
    )
    command_clock_agreement: float = setting(
        3.0,
        "sd",
        "Deviation between the delays by the heading alone and by all sensors up to which all "
        "sensors have the same delay.",
    )
    command_clock_lead: float = setting(
        3.0,
        "nats",
        "Log likelihood by which another clock must exceed a slower drive or late commands of one "
        "drive in this recording: odds of 20.",
    )
    command_clock_lags: tuple[float, ...] = setting(
        (0.0, 0.1, 0.2, 0.4, 0.8),
        "s",
        "Lags of the drives of all recordings that are compared, on a hull of 1.2 m.",
    )
    command_clock_lag_steps: int = setting(
        8, "count", "Steps of the search for the likeliest lag between them.", low=1
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
        8,
        "count",
        "Fixes through which a parabola and a cubic are fitted to judge the fix before them.",
        low=5,
    )
    start_max_outliers: int = setting(
        3, "count", "Outliers that are sought at the beginning of a recording, at most.", low=1
    )
    start_min_sds: float = setting(
        6.0, "1", "Standard deviations from both curves by which a first fix is an outlier."
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
    position_turn_blocks: int = setting(
        50,
        "count",
        "Equal parts of a log over which turns are counted, so that noise of the heading averages "
        "out.",
        low=2,
    )
    position_min_turn: float = setting(
        3.0, "rad", "Sum of turns, about half a circle, from which their length is compared."
    )
    position_turn_lengths: tuple[float, ...] = setting(
        (1.5, 50.0),
        "length",
        "Usual track per radian of turn over a log: boats turn within one to four lengths and go "
        "straight in between. The range is below 100, so that cm and m exclude each other.",
        0.0,
    )
    rates_window: float = setting(
        1.0, "s", "Time over which positions are differenced on a hull of 1.2 m.", low=0.01
    )
    rates_min_rows: int = setting(
        30, "count", "Rows needed to compare a rate with the positions.", low=3
    )
    rates_max_gap: float = setting(
        2.5,
        "1",
        "Time between two samples of a sensor in its usual intervals up to which values between "
        "them are interpolated: one lost sample, with jitter of its time.",
        low=1.0,
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
    sensor_delay_rows: int = setting(
        600,
        "count",
        "Times at which the delays of sensors are compared; more cost time only.",
        low=60,
    )
    sensor_delay_min_share: float = setting(
        0.5, "1", "Share of these times at which all compared sensors are known.", high=1.0
    )
    sensor_delay_grid: int = setting(
        10, "count", "Delays on either side of zero that are tried before the refinement.", low=2
    )
    sensor_delay_intervals: int = setting(
        16,
        "count",
        "Intervals of a recording whose scores scatter; each has several turns of the vessel.",
        low=4,
    )
    sensor_delay_min_intervals: float = setting(
        0.6,
        "intervals",
        "Smallest delay that is reported, in intervals of the sensor; values that a logger holds "
        "until the next are half an interval old on average.",
    )
    sensor_delay_sds: float = setting(
        5.0, "sd", "Deviation from zero from which a sensor counts as late.", low=2.0
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
    clock_share_sds: float = setting(
        3.0,
        "sd",
        "Deviation by which a file shows less of a wander than the files that show it together, "
        "so that its clock is even.",
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
