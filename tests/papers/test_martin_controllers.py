"""Martin's course keepers and roll reducers against his printed numbers.

In calm water the ships are matrices integrated exactly over a control period, with nothing of the
simulator in it; in seas they are the shipped vessels.
"""

import sys
from collections.abc import Callable
from dataclasses import fields
from functools import cache
from math import degrees, exp, log, nan, pi, radians, sqrt
from typing import Any, NamedTuple

import numpy as np
import pytest
from alike import few
from scipy.linalg import expm

from benchmarks import martin
from boatsim.control.base import Sense
from boatsim.control.identification import (
    Forgetting,
    IdentifiedShip,
    LeastSquaresEstimator,
    append_rudder_state,
    state_space,
)
from boatsim.errors import BadInput
from boatsim.metrics.settling import Settling
from boatsim.physics.base import Array
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.recordings.table import Recording
from boatsim.simulate import scenario
from boatsim.simulate.run import run

PidCourse, Sliding, MinimumVariance, Predictive, PolePlacement = (
    load_class("controller", n)
    for n in ("pid_course", "sliding", "minimum_variance", "predictive", "pole_placement")
)
surface, nominal = (
    getattr(sys.modules[Sliding.__module__], name) for name in ("switching_surface", "nominal_ship")
)
predictions = sys.modules[Predictive.__module__].prediction_matrices
ackermann = sys.modules[PolePlacement.__module__].ackermann_gains
T = 0.5  # [s] control period

# Ships: -a_rr -a_rv -a_rphi -a_vr -a_vv a_pr a_pv -a_pphi b_r b_v b_p zeta (the review's section
# 2.4)
SHIPS = {
    "K1": (0.8135, 0.1550, 0.0283, 0.1237, 0.5305, -0.6516, 0.0625, 0.8888, 0.3344, -0.6948, 0.2814, 0.090),
    "K3": (0.6875, 0.1710, 0.0270, 0.0354, 0.5464, -0.4991, 0.0485, 0.6603, 0.2765, -0.5903, 0.2392, 0.090),
    "E1": (0.5212, 0.0566, 0.0131, 1.0223, 0.2733, -0.5990, 0.0289, 0.7744, 0.0764, -0.3008, 0.0592, 0.051),
    "E2": (0.4009, 0.0435, 0.0077, 0.7864, 0.2102, -0.4608, 0.0222, 0.7744, 0.0310, -0.1220, 0.0240, 0.035),
    "E3": (0.4761, 0.0642, 0.0124, 0.8290, 0.2922, -0.5417, 0.0270, 0.8457, 0.0598, -0.2426, 0.0532, 0.044),
    "E4": (0.3296, 0.0444, 0.0059, 0.5739, 0.2023, -0.3751, 0.0187, 0.8457, 0.0196, -0.0797, 0.0175, 0.028),
}  # fmt: skip
PID = {"E": PidCourse, "K": lambda **s: PidCourse(derivative=0.5, integral=30.0, **s)}
VSS_RRS = {"roll_reduction": True, "boundary": 0.025}


@cache
def discrete(ship: str) -> tuple[Array, Array]:
    """A (5, 5), B (5,) of psi, r, v, phi, p over a period with the rudder held."""
    rr, rv, rf, vr, vv, pr, pv, pf, br, bv, bp, zeta = SHIPS[ship]
    a = np.array(
        [
            [0, 1, 0, 0, 0],
            [0, -rr, -rv, -rf, 0],
            [0, -vr, -vv, 0, 0],
            [0, 0, 0, 0, 1],
            [0, pr, pv, -pf, -2.0 * zeta * sqrt(pf)],
        ]
    )
    whole = np.zeros((6, 6))
    whole[:5, :5], whole[:5, 5] = a, (0.0, br, bv, 0.0, bp)
    held = expm(whole * T)
    return held[:5, :5], held[:5, 5]


class Voyage(NamedTuple):
    psi: Array  # (n + 1,) rad
    phi: Array
    rudder: Array  # (n,) rad

    def table(self) -> dict[str, float]:
        return Settling().values(
            Recording("run", T * np.arange(len(self.psi)), {"psi_rad": self.psi})
        )


def sailed(
    controller: Any, ship: str, psi: float = 0.0, r: float = 0.0, periods: int = 1200
) -> Voyage:
    """A calm-water test: heading [deg] and yaw rate [rad/s] at the start."""
    a, b = discrete(ship)
    x, seen, rudder = np.array([radians(psi), r, 0.0, 0.0, 0.0]), [], []
    controller.reset()
    for k in range(periods):
        seen.append(x)
        sense = Sense(T * k, x[0], x[1], nan, nan, nan, nan, nan, nan, x[3], x[4])
        rudder.append(controller.step(sense, {})["rudder_rad"])
        x = a @ x + b * rudder[-1]
    track = np.array([*seen, x])
    return Voyage(track[:, 0], track[:, 3], np.array(rudder))


def calm(controller: Any, test: str) -> Voyage:
    """`E1 offset` or `E1 impulse`."""
    ship, kind = test.split()
    return (
        sailed(controller, ship, psi=15.0) if kind == "offset" else sailed(controller, ship, r=0.1)
    )


def fed(
    controller: Any, psi: Callable[[int], float], phi: Callable[[int], float], periods: int
) -> list[float]:
    """Rudder angles [rad] answered to given readings."""
    controller.reset()
    return [
        controller.step(Sense(T * k, psi(k), 0, 0, 0, nan, nan, nan, nan, phi(k)), {})["rudder_rad"]
        for k in range(periods)
    ]


# Printed responses: settling, rise [s]; appendix VI
# ---------------------------------------------------------------

TESTS = ("E1 offset", "E1 impulse", "E2 impulse", "E3 impulse", "E4 impulse")
PRINTED = {
    "PID": ((61.5, 9.5), (53.0, 11.5), (82.0, 18.5), (63.5, 12.0), (89.0, 20.5)),
    "VSS": ((45.0, 20.5), (37.5, 27.5), (42.0, 11.0), (40.0, 14.0), (599.5, 12.0)),
    "VSS RRS": ((54.5, 10.0), (86.5, 13.5), (70.5, 20.0), (64.5, 12.5), (75.5, 22.5)),
}
MADE = {"PID": PidCourse, "VSS": Sliding, "VSS RRS": lambda: Sliding(**VSS_RRS)}


@pytest.mark.parametrize(("name", "seconds"), [("PID", 1.5), ("VSS", 5.0), ("VSS RRS", 3.5)])
def test_eastward_ho_first_crosses_her_course_when_printed(name: str, seconds: float) -> None:
    for test, (_, rise) in zip(TESTS, PRINTED[name], strict=True):
        assert calm(MADE[name](), test).table()["rise"] == pytest.approx(rise, abs=seconds), test


@pytest.mark.parametrize(("name", "factor"), [("PID", 1.35), ("VSS", 2.05), ("VSS RRS", 1.3)])
def test_eastward_ho_settles_when_printed(name: str, factor: float) -> None:
    ratios = [
        calm(MADE[name](), t).table()["settling"] / s
        for t, (s, _) in zip(TESTS, PRINTED[name], strict=True)
    ]
    assert max(abs(log(ratio)) for ratio in ratios) < log(factor)


def test_the_relay_never_comes_to_rest_on_the_slow_laden_ship() -> None:
    """Printed -20.2 to 19.5 deg."""
    found = calm(Sliding(), "E4 impulse").table()
    assert found["settling"] > 595 and 12 < -found["lowest"] < 22 and 12 < found["highest"] < 22


@pytest.mark.parametrize(("ship", "rise"), [("K1", 5.5), ("K3", 5.5)])
def test_kynoc_under_pid_first_crosses_her_course_when_printed(ship: str, rise: float) -> None:
    assert sailed(PID["K"](), ship, r=0.1).table()["rise"] == pytest.approx(rise, abs=0.75)


@pytest.mark.parametrize(
    ("test", "rise"), list(zip(TESTS[1:], (19.0, 21.5, 19.5, 19.5), strict=True))
)
def test_pole_placement_first_crosses_the_course_when_printed(test: str, rise: float) -> None:
    assert calm(PolePlacement(), test).table()["rise"] == pytest.approx(rise, abs=2.5)


@pytest.mark.parametrize("test", TESTS)
def test_minimum_variance_with_roll_reduction_never_settles_on_eastward_ho(test: str) -> None:
    reducer = MinimumVariance(roll_reduction=True, rudder_weight=0.0)
    assert calm(reducer, test).table()["settling"] > 550


@pytest.mark.parametrize("test", ["E2 impulse", "E4 impulse"])
@pytest.mark.parametrize("settings", [(b, r) for b in (True, False) for r in (True, False)])
def test_predictive_control_swings_for_ever_at_half_speed(
    test: str, settings: tuple[bool, bool]
) -> None:
    """Printed 20 to 41 deg either way."""
    found = calm(Predictive(bang_bang=settings[0], roll_reduction=settings[1]), test).table()
    assert min(-found["lowest"], found["highest"]) > 10


# Steering machine
# -------------------------------------------------------------------------------------------------

ALL = [
    PidCourse,
    Sliding,
    lambda **s: Sliding(**VSS_RRS, **s),
    MinimumVariance,
    lambda **s: MinimumVariance(roll_reduction=True, **s),
    Predictive,
    lambda **s: Predictive(bang_bang=True, **s),
    lambda **s: Predictive(roll_reduction=True, **s),
    PolePlacement,
    lambda **s: PolePlacement(roll_reduction=True, **s),
]


@pytest.mark.parametrize("make", ALL)
@pytest.mark.parametrize("rate", [4.0, 5.0, 15.0])
def test_no_command_outruns_the_steering_machine(make: Callable[..., Any], rate: float) -> None:
    rudder = sailed(make(rudder_rate=radians(rate)), "E4", psi=100.0, r=-0.1, periods=200).rudder
    assert np.abs(np.diff(rudder, prepend=0.0)).max() == pytest.approx(radians(rate) * T)
    assert np.abs(rudder).max() <= radians(40.0) + 1e-12


@pytest.mark.parametrize("make", ALL)
def test_mirrored_ship_gets_the_mirrored_rudder(make: Callable[..., Any]) -> None:
    one, other = (
        sailed(make(), "E1", psi=s * 10.0, r=s * 0.02, periods=60).rudder for s in (1.0, -1.0)
    )
    assert other == pytest.approx(-one, abs=1e-9)


@pytest.mark.parametrize("make", ALL)
def test_reset_forgets_the_last_voyage(make: Callable[..., Any]) -> None:
    controller = make()
    one, other = (sailed(controller, "E1", psi=10.0, periods=60).rudder for _ in range(2))
    assert one.tolist() == other.tolist()


@pytest.mark.parametrize("make", ALL)
def test_course_is_a_goal_and_north_is_no_wall(make: Callable[..., Any]) -> None:
    """A heading of 185 deg for a course of 175 deg, compass cut at +-180 deg, is 10 deg off."""

    def answers(course: float) -> list[float]:
        controller, seen = make(), []
        for k in range(40):
            psi = (radians(course + 10.0 * np.cos(0.3 * k)) + pi) % (2 * pi) - pi
            sense = Sense(T * k, psi, 0, 0, 0, nan, nan, nan, nan, 0.0)
            seen.append(controller.step(sense, {"psi_rad": radians(course)})["rudder_rad"])
        return seen

    assert answers(175.0) == pytest.approx(answers(0.0), abs=1e-9)


@pytest.mark.parametrize("kind", [Sliding, MinimumVariance, Predictive, PolePlacement])
def test_roll_reduction_without_a_roll_sensor_is_refused(kind: Any) -> None:
    assert fed(kind(), lambda k: 0.1, lambda k: nan, 3)  # a course keeper needs none
    with pytest.raises(BadInput, match="inclinometer"):
        fed(kind(roll_reduction=True), lambda k: 0.1, lambda k: nan, 1)


# PID
# --------------------------------------------------------------------------------------------------------------


def test_pid_answers_a_lasting_offset_with_kick_and_ramp() -> None:
    """K y (1 + T_D/T_0) at once, then K y (1 + k T_0/T_I): the closed form of the difference
    equation."""
    y, rudder = 0.02, fed(PidCourse(rudder_rate=10.0), lambda k: 0.02, lambda k: 0.0, 20)
    assert rudder[0] == pytest.approx(-y * 3.0)
    assert rudder[1:] == pytest.approx([-y * (1.0 + k * T / 45.0) for k in range(1, 20)])


def test_pid_that_forgets_its_wish_never_crosses_the_course() -> None:
    assert "rise" not in calm(PidCourse(forgets_wish=True), "E1 offset").table()


# Sliding
# ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("roll_reduction", "rate", "within"),
    [(False, 5.0, 1e-5), (True, 5.0, 5e-3), (True, 15.0, 1.2e-3)],
)
def test_iteration_gives_the_printed_switching_surface(
    roll_reduction: bool, rate: float, within: float
) -> None:
    """All entries of all three G."""
    settings = {"roll_reduction": roll_reduction, "design_rate": radians(rate)}
    printed, found = (
        Sliding(**settings).switching_gains(),
        Sliding(printed=False, **settings).switching_gains(),
    )
    assert found == pytest.approx(printed, rel=within)


def test_surface_solves_the_equation_of_appendix_iii() -> None:
    """P = Q + A'PA - A'PBRB'P - PBRB'PA + PBRB'PBRB'P with R = swing."""
    (a, b), q, swing = nominal(True), np.diag([0.85, 0.85, 17.0, 17.0, 0.0095]), radians(2.5)
    g = surface(a, b, np.diag(q), swing)
    n, f = len(b), np.outer(b, swing * g)
    closed = (a - f).T
    p = np.linalg.solve(np.eye(n * n) - np.kron(closed, closed), q.ravel()).reshape(
        n, n
    )  # Lyapunov, given F
    assert b @ p == pytest.approx(g, rel=1e-8)


def test_course_keeping_surface_has_a_time_constant_of_three_seconds() -> None:
    zeros = np.roots(Sliding().switching_gains()[::-1])
    assert np.abs(zeros) == pytest.approx([0.85, 0.85], abs=0.01)
    assert -T / log(np.abs(zeros).max()) == pytest.approx(3.0, abs=0.2)


def test_a_surface_that_does_not_exist_is_refused() -> None:
    with pytest.raises(BadInput, match="no switching surface"):
        surface(*nominal(False), np.full(3, 1e4), radians(2.5))


def test_angles_are_radians_because_printed_runs_rest_where_degrees_could_not() -> None:
    """A ship at rest off her course has S = sum(G) psi, inside the layer; printed rests go up to 0.56 deg."""
    radian = degrees(0.04 / sum(Sliding().switching_gains()))
    printed = (0.5593, 0.1325, 0.3253, 0.2376, 0.3546)  # E1 offset, E1 to E3 impulse, slow servo
    assert radian / 57.2958 < min(printed) and max(printed) < radian
    for test in ("E2 impulse", "E3 impulse"):
        late = {
            angles: calm(Sliding(in_degrees=angles), test).rudder[600:] for angles in (True, False)
        }
        assert not np.diff(late[False]).any()  # radians: she rests
        assert np.diff(late[True]).all()  # degrees: the rudder moves at every single step


# Identification
# ---------------------------------------------------------------------------------------------------

PLAIN = {"alpha": 1.0, "forgetting": 1.0, "beta": 0.0, "delta": 0.0}


def samples(n: int, noise: float, seed: int = 0) -> tuple[Array, Array, Array]:
    rng, theta = np.random.default_rng(seed), np.array([0.8, 0.03, -0.2])
    x = rng.standard_normal((n, 3)) * (0.5, 5.0, 2.0)
    return theta, x, x @ theta + noise * rng.standard_normal(n)


def learnt(law: Forgetting, x: Array, y: Array) -> LeastSquaresEstimator:
    found = LeastSquaresEstimator(np.zeros(3), law)
    for row, value in zip(x, y, strict=True):
        found.update(row, value)
    return found


def test_without_forgetting_the_estimate_is_least_squares() -> None:
    _, x, y = samples(60, 0.3)
    found = learnt(Forgetting(**PLAIN, covariance=10.0), x, y)
    assert found.theta == pytest.approx(np.linalg.solve(x.T @ x + 0.1 * np.eye(3), x.T @ y))
    assert found.p == pytest.approx(np.linalg.inv(x.T @ x + 0.1 * np.eye(3)))


def test_covariance_without_excitation_comes_to_rest_where_growth_meets_resetting() -> None:
    """p (1/lambda - 1) + beta = delta p^2."""
    law = Forgetting()
    found = learnt(law, np.zeros((4000, 3)), np.zeros(4000))
    growth = 1.0 / law.forgetting - 1.0
    rest = (growth + sqrt(growth**2 + 4.0 * law.delta * law.beta)) / (2.0 * law.delta)
    assert found.p == pytest.approx(rest * np.eye(3), abs=1e-9)


def test_one_over_lambda_alone_never_learns() -> None:
    """As printed, the covariance is set anew at every sample, so that noise is not averaged
    away."""
    theta, x, y = samples(2000, 1.0)
    law = {**PLAIN, "forgetting": 0.999}
    right, printed = (
        learnt(Forgetting(inverse_alone=alone, **law), x, y) for alone in (False, True)
    )
    assert np.abs(printed.theta - theta).max() > 30.0 * np.abs(right.theta - theta).max()
    assert np.linalg.eigvalsh(right.p).max() < 0.01  # two thousand samples have told something
    assert np.linalg.eigvalsh(printed.p).max() == pytest.approx(1.0 / 0.999)


def test_the_later_covariance_in_the_gain_counts_a_sample_twice() -> None:
    """P(t+1) x is the gain already: over 1 + x'Px once more, a first strong sample teaches almost
    nothing."""
    x, y = np.array([[0.0, 10.0, 0.0]]), np.array([1.0])
    right, printed = (
        learnt(Forgetting(**PLAIN, later_gain=late), x, y).theta[1] for late in (False, True)
    )
    assert right == pytest.approx(0.1 / 2.0)  # x'Px = 1
    assert printed == pytest.approx(right / 2.0)


def test_a_ship_of_the_assumed_form_is_identified_from_her_motion() -> None:
    yaw, roll = (0.7, 0.05, -0.01), (-1.7, 0.9, 0.02, -0.25)
    a, b = state_space(yaw, roll)
    ship, rng, x, u = (
        IdentifiedShip(
            Forgetting(**PLAIN, covariance=1e3), (0.8, 0.03, 0.0), (-1.7, 0.9, 0.01, -0.3)
        ),
        np.random.default_rng(1),
        np.zeros(4),
        0.0,
    )
    past = [x]
    for _ in range(400):
        u = radians(float(rng.uniform(-20.0, 20.0)))
        x = a @ x + b * u
        past.append(x)
        older = past[-3] if len(past) > 2 else np.zeros(4)
        ship.update([x[0], x[1], older[0]], [x[2], x[3], older[2]], u)
    assert ship.yaw_coefficients == pytest.approx(yaw, abs=1e-4)
    assert ship.roll_coefficients == pytest.approx(roll, abs=1e-3)


# Adaptive laws
# ----------------------------------------------------------------------------------------------------

YAW, ROLL = (0.7, 0.05, -0.01), (-1.7, 0.9, 0.02, -0.25)


def test_predictions_are_the_ship_simulated() -> None:
    a, b = append_rudder_state(*state_space(YAW, ROLL))
    forced, free = predictions(a, b, 10, [0, 2])
    x, start, found = np.array([0.1, 0.08, -0.05, 0.02, 0.15]), 0.03, []
    state = a @ x + b * start  # one swing now
    for _ in range(10):
        found += [state[0], state[2]]
        state = a @ state
    assert free @ x + forced * start == pytest.approx(np.array(found))
    assert forced.shape == (20,) and free.shape == (20, 5)


def frozen(controller: Any) -> Any:
    """With the true ship known and nothing more learnt."""
    controller.reset()
    controller.ship._yaw.theta[:] = YAW
    controller.ship._roll.theta[:4] = ROLL
    controller.ship.update = lambda *a: None
    return controller


def readings(
    controller: Any, psi: tuple[float, float, float], phi: tuple[float, float, float], rudder: float
) -> Any:
    """Histories, now first."""
    controller.psi, controller.phi, controller.rudder = list(psi), list(phi), rudder
    return controller


@pytest.mark.parametrize("angle", [False, True])
def test_minimum_variance_takes_the_swing_whose_next_state_is_nearest_the_ideal(
    angle: bool,
) -> None:
    a, b = state_space(YAW, ROLL)
    rng = np.random.default_rng(2)
    for _ in range(50):
        keeper = frozen(
            MinimumVariance(roll_reduction=True, rudder_weight=1e-3, weighs_angle=angle)
        )
        before = rng.uniform(-0.1, 0.1, 4)  # psi, psi-1, phi, phi-1 one period ago
        u = float(rng.choice(np.radians([-20.0, 0.0, 20.0])))
        now = (
            a @ before + b * u
        )  # the ship obeys her model, so the differenced equations must predict her
        psi, phi = (now[0], now[1], before[1]), (now[2], now[3], before[3])

        def cost(v: float, now: Array = now, u: float = u) -> float:
            after, effort = a @ now + b * v, v if angle else v - u
            yaw = after[0] - (1.8 * now[0] - 0.8099 * now[1])
            return float(
                yaw**2 + (after[2] - (1.59 * now[2] - 0.764 * now[3])) ** 2 + 1e-3 * effort**2
            )

        best = min((u, u - radians(2.5), u + radians(2.5)), key=cost)
        assert readings(keeper, psi, phi, u).rudder_demand() == pytest.approx(best)


@pytest.mark.parametrize("roll_reduction", [False, True])
def test_predictive_swing_minimises_the_sum_of_squares_ahead(roll_reduction: bool) -> None:
    keeper = frozen(Predictive(roll_reduction=roll_reduction))
    a, b = state_space(YAW, ROLL)
    x, u = np.array([0.02, 0.018, 0.03, 0.025]), 0.01

    def cost(du: float) -> float:
        state, total = x, 0.0
        for _ in range(10 if roll_reduction else 11):
            state = a @ state + b * (u + du)
            total += state[0] ** 2 + (state[2] ** 2 if roll_reduction else 0.0)
        return float(total)

    best = readings(keeper, (x[0], x[1], 0.0), (x[2], x[3], 0.0), u).rudder_demand() - u
    assert all(cost(best) < cost(best + step) for step in (-1e-4, 1e-4))
    bang = frozen(Predictive(roll_reduction=roll_reduction, bang_bang=True))
    assert readings(
        bang, (x[0], x[1], 0.0), (x[2], x[3], 0.0), u
    ).rudder_demand() - u == pytest.approx(min((0.0, -radians(2.5), radians(2.5)), key=cost))


def test_predictive_swing_with_the_printed_sign_turns_away() -> None:
    found = sailed(Predictive(sign_as_published=True), "E1", psi=1.0, periods=120)
    assert degrees(abs(found.psi[-1])) > 90.0


@pytest.mark.parametrize("roll_reduction", [False, True])
def test_poles_are_placed_where_asked_for(roll_reduction: bool) -> None:
    keeper = frozen(PolePlacement(roll_reduction=roll_reduction))
    readings(keeper, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0).rudder_demand()
    n = 4 if roll_reduction else 2
    a, b = (m[:n, :n] if m.ndim == 2 else m[:n] for m in state_space(YAW, ROLL))
    wanted = [0.89, 0.91, *([0.798 + 0.363j, 0.798 - 0.363j] if roll_reduction else [])]
    assert np.poly(a - np.outer(b, keeper._gains)) == pytest.approx(np.real(np.poly(wanted)))


def test_printed_roll_poles_are_seven_seconds_at_a_damping_of_a_third() -> None:
    pole = np.log(0.798 + 0.363j) / T
    assert 2 * pi / abs(pole) == pytest.approx(7.0, abs=0.05) and -pole.real / abs(
        pole
    ) == pytest.approx(0.3, abs=0.02)


def test_a_rudder_without_effect_has_no_gains() -> None:
    assert ackermann(np.eye(2), np.zeros(2), np.array([1.0, -1.8, 0.81])) is None


# Measure
# ----------------------------------------------------------------------------------------------------------


def test_settling_of_a_damped_swing() -> None:
    """x = e^(-t/10) cos(pi t/8): crosses at 4 s, leaves a band of e^-3 for the last time just before 30 s."""
    t = np.arange(0.0, 600.5, 0.5)
    x = np.exp(-t / 10.0) * np.cos(pi * t / 8.0)
    found = Settling(band=exp(-3.0)).values(Recording("swing", t, {"psi_rad": x}))
    envelope = t[np.nonzero(np.abs(x) > exp(-3.0))[0][-1] + 1]
    assert found["rise"] == pytest.approx(4.5) and found["settling"] == envelope < 30.0
    assert found["final"] == pytest.approx(0.0, abs=1e-9)


def test_what_never_crosses_has_no_rise_and_what_ends_early_nothing() -> None:
    t = np.arange(0.0, 600.5, 0.5)
    found = Settling().values(Recording("decay", t, {"psi_rad": 0.1 + np.exp(-t)}))
    assert "rise" not in found and found["final"] == pytest.approx(degrees(0.1))
    assert Settling().values(Recording("short", t[:100], {"psi_rad": t[:100]})) == {}


# Seas, on the shipped vessels
# ---------------------------------------------------------------------------------------


@cache
def at_sea(vessel: str, test: str, kind: str, seeds: int = 1) -> martin.Entry:
    return martin.Entry(vessel, test, kind, 5.0, seeds).run()


def mean(norm: str, vessel: str, test: str, kind: str, seeds: int = 1) -> float:
    return float(at_sea(vessel, test, kind, seeds).metric_by_seed(norm).mean())


QUARTERING = [
    ("eastward_ho", "seas_45"),
    ("kynoc", "seas_30"),
    ("eastward_ho", "seas_60"),
    ("eastward_ho", "seas_30"),
    ("kynoc", "seas_45"),
    ("kynoc", "seas_60"),
]
OTHERS = ("PID", "VSS", "MV", "Pole", "MV RRS", "Pole RRS")


@pytest.mark.parametrize(("vessel", "test"), few(QUARTERING[:4], 2, 0))
@pytest.mark.slow
def test_the_relay_with_roll_reduction_is_best_or_second_best_at_it(vessel: str, test: str) -> None:
    rolls = sorted(mean("roll_rms", vessel, test, kind) for kind in OTHERS)
    assert mean("roll_rms", vessel, test, "VSS RRS") <= rolls[1]


@pytest.mark.parametrize(("vessel", "test"), few(QUARTERING, 2, 0))
def test_the_relay_keeps_its_course_far_better_than_the_pid(vessel: str, test: str) -> None:
    assert mean("yaw_rms", vessel, test, "VSS") < 0.65 * mean("yaw_rms", vessel, test, "PID")


@pytest.mark.parametrize("kind", ["VSS", "MV", "Pole"])
def test_good_course_keepers_also_cut_kynocs_roll_at_45_degrees(kind: str) -> None:
    """Printed 38 to 50 %; the review asks for 15 to 25."""
    cut = 1.0 - mean("roll_rms", "kynoc", "seas_45", kind) / mean(
        "roll_rms", "kynoc", "seas_45", "PID"
    )
    assert 0.13 < cut < 0.27


@pytest.mark.parametrize("kind", ["MV RRS", "Pole RRS"])
def test_adaptive_roll_reducers_run_away_in_eastward_hos_beam_sea(kind: str) -> None:
    """Printed 40.7 and 20.5 deg; beyond 20 deg the linear ship means nothing."""
    assert mean("yaw_rms", "eastward_ho", "seas_90", kind, 2) > 10.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("vessel", "test"), few([*((v, "seas_90") for v in martin.VESSELS), *QUARTERING], 4, 0)
)
def test_roll_reduction_costs_the_relay_course(vessel: str, test: str) -> None:
    assert mean("yaw_rms", vessel, test, "VSS RRS") > mean("yaw_rms", vessel, test, "VSS")


def test_weighing_the_rudder_angle_loses_the_course_that_weighing_its_swing_keeps() -> None:
    """Kynoc at 30 degrees under MV: printed rudder 5.7 deg, yaw 1.0 deg rms."""
    found = {}
    for angle in (False, True):
        table = martin.autopilot_table("kynoc", "MV") | {"weighs_angle": angle}
        found[angle] = martin.simulate_metrics(
            scenario.load("kynoc/seas_30", {"controller": table})
        )
    assert found[False]["yaw_rms"] < 1.03 < found[True]["yaw_rms"]
    assert found[True]["rudder_rms"] < 1.5 < 3.0 < found[False]["rudder_rms"]


@pytest.mark.slow
def test_a_faster_rudder_helps_at_resonance_only() -> None:
    def reduced(pid: str, other: str) -> float:
        rolls = [
            martin.simulate_metrics(scenario.load(f"kynoc/{name}"))["roll_rms"]
            for name in (pid, other)
        ]
        return 100.0 * (1.0 - rolls[1] / rolls[0])

    at_5, at_15 = (reduced("puzzle_rudder_pid", f"puzzle_rudder_{rate}") for rate in (5, 15))
    assert at_15 - at_5 > 30.0  # beam seas
    at_5, at_15 = (reduced("seas_45", f"seas_45_{name}") for name in ("sliding_roll", "fast"))
    assert abs(at_15 - at_5) < 8.0


def test_course_keeping_and_roll_go_together_in_kynocs_quartering_sea() -> None:
    kept = ("pid", "sliding", "idle", "locked")
    rolls = [
        martin.simulate_metrics(scenario.load(f"kynoc/puzzle_course_{name}"))["roll_rms"]
        for name in kept
    ]
    assert rolls == sorted(rolls, reverse=True) and rolls[-1] < 0.6 * rolls[0]


def test_the_pid_never_meets_the_rate_limit_so_that_both_rates_are_one_system() -> None:
    test = "eastward_ho/seas_60"
    slow, fast = (
        martin.simulate_metrics(
            scenario.load(test, {"controller": martin.autopilot_table("eastward_ho", "PID", rate)})
        )
        for rate in (5.0, 15.0)
    )
    assert slow == fast


def test_twin_of_the_table_is_the_engine() -> None:
    test = scenario.load("eastward_ho/seas_60_sliding_roll", {"duration": 60.0})
    one, other = martin.simulate_log(test), run(test).recording
    for name in ("psi_rad", "phi_rad", "rudder_rad"):
        assert one[name] == pytest.approx(other[name], abs=1e-9)


def test_shipped_vessel_sails_as_the_discrete_ship_of_the_thesis() -> None:
    test = scenario.load("eastward_ho/full_load", {"duration": 120.0})
    exact = sailed(PidCourse(), "E3", r=0.1, periods=240)
    assert (
        np.degrees(np.abs(martin.simulate_log(test)["psi_rad"] - exact.psi)).max() < 0.05
    )  # table of four digits


@pytest.mark.parametrize(
    "name",
    [
        n
        for n in shipped_content_names("scenario")
        if n.split("/")[0] in martin.VESSELS and "/seas" in n
    ],
)
def test_scenarios_and_table_set_the_autopilots_alike(name: str) -> None:
    vessel, test = name.split("/")
    shipped = scenario.load(name)
    fast = test.endswith("_fast")
    kind = (
        "VSS RRS"
        if fast or test.endswith("_roll")
        else "VSS"
        if test.endswith("_sliding")
        else "PID"
    )
    wanted = martin.autopilot_table(vessel, kind, 15.0 if fast else 5.0)
    from_table = scenario.load(name, {"controller": wanted}).controller
    assert {k: pytest.approx(v, abs=1e-6) for k, v in public(shipped.controller).items()} == public(
        from_table
    )


def public(controller: Any) -> dict[str, float]:
    return {f.name: float(getattr(controller, f.name)) for f in fields(controller)}
