"""Settings of the plan for the next recording."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


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
