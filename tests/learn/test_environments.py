"""Environments for learning: Gymnasium's own checks, the same episodes alone and in a crowd,
actions of a boat."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")

from gymnasium.utils.env_checker import check_env  # noqa: E402

from boatsim.control.approach import Approach  # noqa: E402
from boatsim.control.base import Sense  # noqa: E402
from boatsim.errors import BadInput  # noqa: E402
from boatsim.learn import episode_random, registration  # noqa: E402
from boatsim.learn.actions import make_controls  # noqa: E402
from boatsim.learn.environment_options import make_simulation  # noqa: E402
from boatsim.learn.pilot import run_episodes  # noqa: E402
from boatsim.learn.play import TaskSimulation  # noqa: E402
from boatsim.learn.variation import make_variation  # noqa: E402
from boatsim.physics import vessel  # noqa: E402
from boatsim.physics.content import load_class  # noqa: E402

IDS = registration.environment_ids()
STILL = {"vary": {}, "vessel": "joystick_boat"}  # one boat, no wind


def single(name: str, **more: Any) -> Any:
    return gymnasium.make(name, **more).unwrapped


def many(name: str, count: int, **more: Any) -> Any:
    return gymnasium.make_vec(name, num_envs=count, vectorization_mode="vector_entry_point", **more)


def game(task: str, n: int, **more: Any) -> TaskSimulation:
    return make_simulation(task, n, **{**STILL, **more})  # type: ignore[arg-type]


@pytest.mark.parametrize("name", IDS)
def test_gymnasium_finds_nothing_to_complain_of(
    name: str, recwarn: pytest.WarningsRecorder
) -> None:
    check_env(single(name), skip_render_check=True)
    assert not [
        str(w.message)
        for w in recwarn
        if "gymnasium" in str(w.category).lower() or "Box" in str(w.message)
    ]


@pytest.mark.parametrize("name", IDS)
def test_a_boat_of_many_plays_the_episodes_that_it_plays_alone(name: str) -> None:
    boats = many(name, 4, autoreset_mode="SameStep", duration=4.0)
    alone = [single(name, duration=4.0) for _ in range(4)]
    seen, _ = boats.reset(seed=7)
    for i, env in enumerate(alone):
        assert (env.reset(seed=7 + i)[0] == seen[i]).all()
    boats.action_space.seed(1)
    ends = 0
    for _ in range(50):
        actions = boats.action_space.sample()
        seen, reward, ended, late, info = boats.step(actions)
        for i, env in enumerate(alone):
            own, r, e, t, norms = env.step(actions[i])
            assert (r, e, t) == (reward[i], ended[i], late[i])
            if e or t:
                ends += 1
                assert (info["final_obs"][i] == own).all()
                assert {
                    n: info["final_info"][n][i] for n in norms
                } == norms and "is_success" in norms
                own, _ = env.reset()
            assert (own == seen[i]).all()
    assert ends >= 8  # every boat in two episodes or more


@pytest.mark.parametrize("name", IDS)
def test_the_same_seed_is_the_same_episode_and_the_next_one_another(name: str) -> None:
    env = single(name)
    first, second = env.reset(seed=3)[0], env.reset()[0]
    again = single(name)
    assert (again.reset(seed=3)[0] == first).all() and (again.reset()[0] == second).all()
    env.reset(seed=4)
    actions = np.random.default_rng(1).uniform(-1.0, 1.0, (20, *env.action_space.shape))
    ends = []
    for seed in (3, 3, 5):
        env.reset(seed=seed)
        ends.append([env.step(action)[0] for action in actions][-1])
    assert (ends[0] == ends[1]).all() and (ends[0] != ends[2]).any()


def test_observations_are_the_same_over_their_bounds_and_in_their_units() -> None:
    plain, scaled = single(IDS[0], normalised=False), single(IDS[0])
    bound = np.array([s.bound for s in plain.signals])
    assert plain.reset(seed=1)[0] == pytest.approx(bound * scaled.reset(seed=1)[0], rel=1e-6)
    assert (plain.observation_space.high == bound.astype(np.float32)).all()
    assert [s.name for s in plain.signals][:2] == ["ahead_m", "starboard_m"]


def test_mujoco_and_the_batch_play_the_same_episode() -> None:
    both = [single(IDS[0], simulator=name, step=0.05) for name in ("batch", "mujoco")]
    for env in both:
        env.reset(seed=11)
    actions = np.random.default_rng(2).uniform(-0.5, 0.5, (40, 3))
    for action in actions:
        a, b = (env.step(action) for env in both)
        assert a[0] == pytest.approx(b[0], abs=1e-5) and a[1] == pytest.approx(
            b[1], abs=1e-6
        )  # float32
    one, other = (np.ravel(env.play.motion) for env in both)
    assert one == pytest.approx(other, abs=1e-9)


def test_boats_that_are_over_begin_when_the_mode_says_so() -> None:
    later = many("boatsim/Joystick-v0", 3, duration=0.4)
    later.reset(seed=1)
    nothing = np.zeros((3, 3), dtype=np.float32)
    later.step(nothing)
    _, _, _, late, info = later.step(nothing)
    assert late.all() and info["_is_success"].all()
    first, reward, ended, late, info = later.step(nothing)
    assert not (reward.any() or ended.any() or late.any() or info)
    assert (first == single("boatsim/Joystick-v0", duration=0.4).reset(seed=1)[0]).any()
    asked = many("boatsim/Joystick-v0", 3, duration=0.4, autoreset_mode="Disabled")
    asked.reset(seed=1)
    asked.step(nothing)
    asked.step(nothing)
    mask = np.array([True, False, True])
    asked.reset(options={"reset_mask": mask})
    assert (asked.play.t == np.where(mask, 0.0, 0.4)).all()


@pytest.mark.parametrize(
    ("boat", "use", "names"),
    [
        ("joystick_boat", "manoeuvring", ("thrust", "turn", "inward")),
        ("joystick_boat", "underway", ("thrust", "helm")),
        ("catamaran", "manoeuvring", ("thrust", "helm")),
        ("otter", "manoeuvring", ("shaft", "turn")),
        ("blueboat", "underway", ("thrust", "turn")),
    ],
)
def test_actions_follow_from_the_channels_of_a_boat(
    boat: str, use: Any, names: tuple[str, ...]
) -> None:
    found = make_controls(vessel.load_vessel(boat), use)
    assert found.names == names
    assert np.linalg.matrix_rank(found.pattern) == len(names)  # none is there twice
    ends = found.commands(np.random.default_rng(1).uniform(-3.0, 3.0, (50, len(names))))
    limits = np.array([(c.low, c.high) for c in vessel.load_vessel(boat).commands.values()])
    assert (ends >= limits[:, 0]).all() and (ends <= limits[:, 1]).all()


@pytest.mark.parametrize(
    ("boat", "action"), [("joystick_boat", "helm"), ("catamaran", "helm"), ("otter", "turn")]
)
def test_a_positive_helm_or_turn_brings_the_bow_to_starboard(boat: str, action: str) -> None:
    sea = game("follow_path", 1, vessel=boat)
    sea.begin_episodes(np.zeros(1, dtype=np.uint64), np.array([0]))
    actions = np.full((1, len(sea.controls.names)), 0.5)
    actions[0, sea.controls.names.index(action)] = 0.3
    actions[0, 0] = 0.3
    before = sea.motion.psi[0]
    for _ in range(15):
        sea.step(actions)
    assert sea.motion.psi[0] > before


def test_a_boat_is_berthed_once_it_has_lain_there_and_lost_once_it_touches() -> None:
    sea, task = game("berth", 3), game("berth", 3).task
    sea.begin_episodes(np.arange(3, dtype=np.uint64), np.arange(3))
    quay = -(0.5 * sea.scale.beam + task.gap * sea.scale.length)  # type: ignore[attr-defined]
    states = np.zeros((3, 6))
    states[1, 1] = quay + 0.5 * sea.scale.beam - 0.01  # a cm into the quay
    states[2, 3] = 0.1  # fast
    sea.world.reset(states)
    done = [sea.step(np.zeros((3, 3))) for _ in range(10)]
    assert done[0].terminated.tolist() == [False, True, False]
    assert done[-1].terminated[0] and done[-1].reward[0] > 5.0 and done[-1].metrics["is_success"][0]
    assert not any(step.terminated[2] for step in done)


def test_a_joystick_controller_with_its_outer_loop_berths_in_calm_water() -> None:
    class Berthing:
        def __init__(self) -> None:
            self.inner, self.outer = load_class("controller", "l1_joystick")(), Approach()

        def step(self, sense: Sense) -> dict[str, float]:
            stick = self.outer.step((sense.x, sense.y, sense.psi), sense.v, self.inner.period)
            goal = {"surge_mps": stick.surge, "sway_mps": stick.sway, "yaw_radps": stick.yaw}
            return dict(self.inner.step(sense, goal))

    sea = game("berth", 8, period=0.08, step=0.04, duration=90.0)
    norms = run_episodes(sea, np.arange(8, dtype=np.uint64), lambda goal: Berthing())
    assert (
        norms["is_success"].all()
        and (norms["distance_L"] < 0.1).all()
        and (norms["time_s"] < 90.0).all()
    )


def test_what_varies_differs_from_boat_to_boat_and_stays_within_what_is_said() -> None:
    vary = {
        "load": ["light, narrow", "heavy, wide"],
        "weak_reverse.astern_factor": "uniform(0.5, 0.9)",
    }
    sea = game(
        "berth",
        400,
        vary={
            **vary,
            "current.north": "normal(0.0, 0.02)",
            "fan_wind.speed": 0.5,
            "body.yaw_inertia": "uniform(1.0, 1.2)",
        },
    )
    sea.begin_episodes(np.arange(400, dtype=np.uint64), np.arange(400))
    factor, north = sea.world.get("weak_reverse.astern_factor"), sea.world.get("current.north")
    assert 0.5 <= factor.min() < 0.52 and 0.88 < factor.max() <= 0.9
    assert north.std() == pytest.approx(0.02, rel=0.15)
    assert (sea.world.get("fan_wind.speed") == 0.5).all() and np.ptp(
        sea.world.get("body.yaw_inertia")
    ) > 0.19
    assert set(np.round(sea.world.get("port.y"), 3)) == {-0.19, -0.28}
    assert abs(np.corrcoef(factor, north)[0, 1]) < 0.15


def test_boats_are_as_uncertain_as_their_diagnosis_says(tmp_path: Path) -> None:
    patched = tmp_path / "patched.toml"
    patched.write_text(
        (Path(vessel.load_vessel("trial_boat").file)).read_text()
        + """
[spread]
correlation = [[1.0, -0.8], [-0.8, 1.0]]
[[spread.of]]
fitted = "thrust_gain_error.factor"
sd = 0.05
scales = ["port.gain", "starboard.gain"]
[[spread.of]]
fitted = "linear_damping.surge"
sd = 0.2
shifts = { "linear_damping.surge" = 1.0 }
"""
    )
    text = patched.read_text()
    patched.write_text('based_on = "trial_boat"\n' + text)
    sea = game("hold_station", 4000, vessel=str(patched))
    sea.begin_episodes(np.arange(4000, dtype=np.uint64), np.arange(4000))
    gain, drag = sea.world.get("port.gain"), sea.world.get("linear_damping.surge")
    assert (gain == sea.world.get("starboard.gain")).all()
    assert gain.mean() == pytest.approx(1.0, abs=0.005) and gain.std() == pytest.approx(
        0.05, rel=0.05
    )
    assert drag.mean() == pytest.approx(3.0, abs=0.02) and drag.std() == pytest.approx(
        0.2, rel=0.05
    )
    assert np.corrcoef(gain, drag)[0, 1] == pytest.approx(-0.8, abs=0.03)
    known = game("hold_station", 10, vessel=str(patched), vary={"spread": 0.0})
    known.begin_episodes(np.arange(10, dtype=np.uint64), np.arange(10))
    assert (known.world.get("linear_damping.surge") == 3.0).all()


@pytest.mark.parametrize(
    ("task", "told", "line"),
    [
        ("berht", {}, "task 'berht' does not exist; did you mean 'berth'"),
        ("berth", {"vessel": "joystik_boat"}, "did you mean 'joystick_boat'"),
        ("berth", {"vary": {"fan_wind.sped": "uniform(0, 1)"}}, "did you mean 'speed'"),
        ("berth", {"vary": {"fan_wind.speed": "unifrm(0, 1)"}}, "did you mean 'uniform'"),
        ("berth", {"vary": {"load": "light"}}, "allowed is a list"),
        ("berth", {"settings": {"plce": 0.2}}, "did you mean 'place'"),
        ("berth", {"period": 0.2, "step": 0.03}, "whole parts of the period"),
        ("berth", {"step": 0.0}, "whole parts of the period"),
        ("berth", {"duration": float("inf")}, "duration = inf s"),
        ("berth", {"vary": {"body.mass": -1.0}}, "vary body.mass = -1; allowed 1e-09 to 1e+18 kg"),
        ("berth", {"vary": {"fan_wind.speed": 99.0}}, "allowed 0 to 40"),
        (
            "joystick",
            {"vessel": "otter"},
            "otter can be moved by shaft, turn only; Joystick needs 3 actions",
        ),
        ("berth", {"vessel": "martin_tank_model"}, "has no drive"),
        ("berth", {"duraton": 3.0}, "did you mean 'duration'"),
    ],
)
def test_what_does_not_fit_is_told_in_one_line(task: str, told: dict[str, Any], line: str) -> None:
    with pytest.raises(BadInput) as error:
        make_simulation(task, 1, **{**STILL, **told})  # type: ignore[arg-type]
    assert line in str(error.value) and "\n" not in str(error.value)


def test_the_loads_of_an_id_belong_to_its_own_boat() -> None:
    arguments = registration.environment_arguments("boatsim/Berth-v0")
    own = make_variation(arguments["vessel"], vary=arguments["vary"])
    other = make_variation("otter", vary=arguments["vary"])
    assert [boat.load for boat in other.boats] == [()]
    assert ("light", "narrow") in [boat.load for boat in own.boats] and len(own.boats) == 4


def test_other_boats_play_too() -> None:
    for boat, task in (
        ("otter", "follow_path"),
        ("blueboat", "hold_station"),
        ("catamaran", "follow_path"),
    ):
        sea = game(task, 2, vessel=boat)
        sea.begin_episodes(np.arange(2, dtype=np.uint64), np.arange(2))
        for _ in range(20):
            sea.step(np.full((2, len(sea.controls.names)), 0.2))
        assert np.isfinite(sea.observations(True)).all()


def test_numbers_drawn_by_lot_are_uniform_and_independent() -> None:
    rows = episode_random.uniform_numbers(
        episode_random.episode_seeds(
            np.arange(20000, dtype=np.uint64), np.zeros(20000, dtype=np.uint64)
        ),
        3,
    )
    assert rows.min() > 0.0 and rows.max() < 1.0
    assert rows.mean(axis=0) == pytest.approx(0.5, abs=0.01) and rows.var(axis=0) == pytest.approx(
        1 / 12, rel=0.03
    )
    assert np.abs(np.corrcoef(rows.T) - np.eye(3)).max() < 0.03
    assert np.abs(np.corrcoef(rows[:-1, 0], rows[1:, 0])[0, 1]) < 0.03


def test_learning_without_gymnasium_can_still_be_imported() -> None:
    code = "import sys; sys.modules['gymnasium'] = None; import boatsim.learn, boatsim.learn.environment_options; print('yes')"
    assert (
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout
        == "yes\n"
    )


def test_stable_baselines_takes_the_boats() -> None:
    pytest.importorskip("stable_baselines3")
    from boatsim.learn.sb3 import BoatVecEnv

    env = BoatVecEnv(many("boatsim/Berth-v0", 3, autoreset_mode="SameStep", duration=0.6))
    env.seed(5)
    seen = env.reset()
    assert (seen[1] == single("boatsim/Berth-v0").reset(seed=6)[0]).all()
    for _ in range(3):
        seen, _, over, infos = env.step(np.zeros((3, 3), dtype=np.float32))
    assert over.all() and {"terminal_observation", "episode", "is_success"} <= infos[0].keys()
    assert infos[0]["TimeLimit.truncated"] and infos[0]["episode"]["l"] == 3
