"""A spring to the ground and the drift force of waves, which a search for single effects misses.

The truth is integrated here, independently of the compiled program: a box that sways in waves whose
height changes slowly, with and without a spring and a drift force.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.output_error.balanced_forces import add_balanced_forces, is_spring_to_ground
from boatsim.diagnosis.output_error.search import OutputErrorSearch
from boatsim.diagnosis.question import Question, set_up_estimation_problem
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.recordings.table import Notes, Recording

MASS, DAMPING, PUSH = 80.0, 15.0, -200.0  # [kg], [N s/m], [N s/m] of the wave's rate
STIFFNESS, DRIFT = 50.0, -3000.0  # [N/m], [N/m^2] of the truth
SMOOTHING = 1.5 / np.sqrt(9.80665 / 0.4)  # [s] the default of `wave_drift`
FILE = Path("tank.csv")
BOX = """
about = "a box on rails in a measured wave"
source = "none"
freedoms = ["sway"]
length = 0.6
beam = 0.4
draught = 0.2
body = { mass = 48.0, roll_inertia = 1.0, yaw_inertia = 1.4 }

[measured]
wave_m = {}

[[effect]]
use = "added_mass"
surge = 0.0
sway = 32.0
yaw = 0.0

[[effect]]
use = "linear_damping"
sway = 15.0

[[effect]]
use = "wave_excitation"
on = { elevation = "wave_m" }
sway_rate = -200.0

[diagnosis]
rate = 10.0
reasons = { rate = "ten rows in a period of the wave" }
facts = { guided = true, indoors = true, forward_speed_mps = 0.0 }

[estimated]
damping = 0.3
"""
HULL = """<mujoco model="box"><worldbody><body name="hull">
<geom type="box" size="0.3 0.2 0.13"/></body></worldbody></mujoco>"""
OTHERS = ("quadratic_damping", "rail_friction", "steady_force", "wave_drift", "ground_spring")


def recorded(seed: int, truth: float) -> Recording:
    """A run of 40 s of the true box, at 20 Hz; `truth` scales the spring and the drift force."""
    rng = np.random.default_rng(seed)
    rate, height = rng.uniform(5.0, 9.0), rng.uniform(0.012, 0.02)
    t = np.arange(0.0, 40.0, 0.05)
    # a force without a law, twice the assumed disturbance, that no candidate explains
    phases = rng.uniform(0.0, 6.0, 12)
    rates = rng.uniform(2.0, 4.0, 12)

    def wave(s: float) -> float:
        envelope = height * np.clip((s - 4.0) / 4.0, 0.0, 1.0) * np.clip((32.0 - s) / 4.0, 0.0, 1.0)
        return float(envelope * np.sin(rate * s))

    def rest(s: float) -> float:
        return float(0.1 * min(s / 8.0, 1.0) * np.sin(rates * s + phases).sum())

    def slopes(s: float, y: Array) -> list[float]:
        force = PUSH * (wave(s + 1e-3) - wave(s - 1e-3)) / 2e-3 - DAMPING * y[1] + rest(s)
        force += truth * (DRIFT * y[3] - STIFFNESS * y[0])
        first = (wave(s) ** 2 - y[2]) / SMOOTHING
        return [y[1], force / MASS, first, (y[2] - y[3]) / SMOOTHING]

    run = solve_ivp(slopes, (0.0, 40.0), [0.0] * 4, "RK45", t, rtol=1e-8, max_step=0.02)
    sway = run.y[0] + 2e-4 * rng.standard_normal(len(t))
    notes = Notes(noise={"position_sd_m": 2e-4})
    signals = {"y_m": sway, "wave_m": np.array([wave(s) for s in t])}
    return Recording(f"run {seed}", t, signals, path=FILE, notes=notes).thinned(10.0)


def selected(folder: Path, truth: float) -> tuple[Question, Ranking]:
    """The question of 12 fitted and four held-out runs, and its effects without a pair."""
    (folder / "hull.xml").write_text(HULL)
    (folder / "vessel.toml").write_text(BOX)
    box = vessel.load_vessel(str(folder))
    runs: Sequence[Recording] = [recorded(seed, truth) for seed in range(16)]
    loaded = LoadedRecordings(
        list(runs[:12]), list(runs[12:]), {FILE: box}, "four runs", horizon=40.0
    )
    question = set_up_estimation_problem(loaded, DEFAULT)
    ranking = select_and_rank_candidates(question.problem, ("quadratic_damping",), ())
    return question, ranking


@pytest.mark.slow
@pytest.mark.parametrize("truth", [1.0, 0.0])
def test_a_spring_and_the_drift_that_it_balances_are_found_together_or_not_at_all(
    truth: float, tmp_path: Path
) -> None:
    question, ranking = selected(tmp_path, truth)
    problem, held_out = question.problem, question.held_out
    assert set(OTHERS) <= set(question.candidates)
    springs = [name for name in OTHERS if is_spring_to_ground(problem, name)]
    assert springs == ["ground_spring"]
    assert ranking.has_unexplained_force_or_cause
    found = add_balanced_forces(problem, ranking, OTHERS, held_out)
    if not truth:
        assert found is ranking
        return
    assert {"ground_spring", "wave_drift"} <= set(found.best.effects)
    assert {"ground_spring", "wave_drift"} <= {one.name for one in found.named}
    assert found.balanced == ("ground_spring", "wave_drift")
    search = OutputErrorSearch(problem, ranking.best, held_out)
    pair = search.most_probable_pair("ground_spring", OTHERS[:-1])
    assert pair is not None
    # the filter takes the slow force for a disturbance and finds twice these sizes
    stiffness = pair.model.value("ground_spring", "stiffness_east")[0]
    assert stiffness == pytest.approx(STIFFNESS, rel=0.15)
    assert pair.model.value("wave_drift", "sway")[0] == pytest.approx(DRIFT, rel=0.15)
    search.add_effects(OTHERS)
    assert not {"ground_spring", "wave_drift"} <= set(search.model.effects)
