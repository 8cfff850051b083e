"""Rivals from packages: a weak form is exact, and an absent package is one line."""

import importlib
import sys

import numpy as np
import pytest

from boatsim.errors import BadInput
from validation.practice import hulls
from validation.practice.boats import BOATS
from validation.practice.make import Trial, make_trial
from validation.practice.plans import PLANS
from validation.rivals.__main__ import PACKAGED, make_rival
from validation.rivals.packages import import_package
from validation.rivals.question import Question, free_parameters, read_question
from validation.rivals.sbi_simulator import Hypothesis, Simulator

EASY = Trial(
    "T001_martin_tank_model",
    "martin_tank_model",
    "single",
    False,
    False,
    (hulls.righting_arm_stiffening,),
    PLANS["martin_tank_model"],
    BOATS["martin_tank_model"],
)


@pytest.fixture(scope="module")
def question(tmp_path_factory: pytest.TempPathFactory) -> Question:
    folder = tmp_path_factory.mktemp("set")
    make_trial(EASY, 4, folder)
    return read_question(folder / EASY.name)


@pytest.mark.parametrize("rival", PACKAGED)
def test_an_absent_package_is_said_in_one_line(
    rival: str, question: Question, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("pysindy", "mujoco.sysid", "tabulate", "torch", "sbi", "sbi.inference"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(BadInput) as refused:
        make_rival(rival, question, False)
    assert "boatsim[rivals]" in str(refused.value) and "\n" not in str(refused.value)


def test_no_rival_imports_its_package_before_it_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("pysindy", "mujoco.sysid", "torch", "sbi"):
        monkeypatch.setitem(sys.modules, name, None)
    for rival in PACKAGED:
        sys.modules.pop(f"validation.rivals.{rival}", None)
        importlib.import_module(f"validation.rivals.{rival}")


def test_an_installed_package_is_returned() -> None:
    assert import_package("numpy", "a test") is np


@pytest.mark.slow
def test_the_true_effect_brings_simulations_nearer_to_the_recording(question: Question) -> None:
    simulator = Simulator(question)
    nominal = Hypothesis((), question.start())
    free = free_parameters(question, ("righting_arm_stiffening",))
    mean = np.array([f.mean for f in free])
    own = [j for j, f in enumerate(free) if f.effect == "righting_arm_stiffening"]
    errors = []
    for share in (-1.0, -0.5, 0.5, 1.0):
        theta = mean.copy()
        theta[own] = np.clip(
            mean[own] + share * np.array([free[j].sd for j in own]),
            [free[j].low for j in own],
            [free[j].high for j in own],
        )
        hypothesis = Hypothesis(("righting_arm_stiffening",), theta)
        x = simulator.summaries([hypothesis] * 20, np.random.default_rng(1))
        errors.append(float(np.mean(x.mean(axis=0) ** 2)))
    x = simulator.summaries([nominal] * 20, np.random.default_rng(1))
    assert min(errors) < float(np.mean(x.mean(axis=0) ** 2))


def test_weak_form_of_a_known_rate_is_exact(question: Question) -> None:
    pytest.importorskip("pysindy")
    from validation.rivals.pysindy_weak import PySindyWeak

    rival = PySindyWeak(question, False)
    times = np.linspace(0.0, 20.0, 401)
    rate = np.sin(times)
    library = rival.weak_library(times, 1)
    integral = library.convert_u_dot_integral(-np.cos(times)[:, None])
    features = rival.integrate(library, rate[:, None])
    assert np.asarray(integral) == pytest.approx(features, abs=2e-3 * np.abs(features).max())


def test_sysid_names_what_is_plain_to_see(question: Question) -> None:
    pytest.importorskip("tabulate")  # of mujoco[sysid]
    fit, gains, unknown = make_rival("mujoco_sysid", question, False).answer()
    assert "righting_arm_stiffening" in fit.effects
    assert set(gains) == set(fit.effects) and not unknown


@pytest.mark.slow
def test_sbi_prefers_the_true_effect(question: Question, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("sbi")
    from validation.rivals import sbi_posterior

    monkeypatch.setattr(sbi_posterior, "STRUCTURES", 1500)
    rival = sbi_posterior.SbiPosterior(question, False)
    probabilities = rival.structure()
    assert max(probabilities, key=lambda n: probabilities[n]) == "righting_arm_stiffening"
