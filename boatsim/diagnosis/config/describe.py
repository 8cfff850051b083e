"""Settings of the description of an unknown cause by a symbolic law."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


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
        500_000_000,
        "steps x dof",
        "Work of the description, counted as in `select.budget`; then no further term is sought. "
        "It takes about a minute, and gets less where `work.total` leaves less.",
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
