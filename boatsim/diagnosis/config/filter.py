"""Settings of the Kalman filter, the smoother and free runs."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class FilterConfig:
    """Settings of the Kalman filter, the smoother and free runs: integration steps, initial states.

    A free run is a simulation from a recorded state with the recorded commands alone.
    """

    free_run_step: float = setting(
        0.02,
        "s",
        "Largest integration step of a free run: the step of the simulation, so that time lags "
        "are averaged alike. Parameters of hulls longer than 1.2 m are fitted to free runs with a "
        "step that grows with the square root of the length, by which the path changes by less "
        "than 1e-5 lengths.",
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
