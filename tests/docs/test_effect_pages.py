"""The reference pages of the effects: law, symbols, case and example of each of them."""

import os
import subprocess
import sys

import pytest
from alike import long

from boatsim.physics import content
from tests.pages import ROOT, effect_cases, effect_examples, reference

EFFECTS = content.shipped_content_names("effect")
PAGES = reference.pages()


@pytest.mark.parametrize("name", EFFECTS)
def test_an_effect_of_the_library_has_a_formula_whose_symbols_are_its_parameters(name: str) -> None:
    kind = content.load_class("effect", name)
    assert kind.formula, f"{name}: state its law as `formula`, in LaTeX"
    assert set(kind.symbols) <= set(kind.params()), name
    own = {p for p in kind.symbols if kind.symbols[p].lstrip("-") in kind.formula}
    for parameter in own:
        assert f"${kind.symbols[parameter]}$ = `{parameter}`" in PAGES[f"effects/{name}"]


@pytest.mark.parametrize("name", EFFECTS)
def test_the_page_of_an_effect_has_law_plot_scenario_and_an_example_with_its_output(
    name: str,
) -> None:
    cases = effect_cases.all_cases()
    assert name in cases, f"add {name} to docs/_ext/effect_cases.toml"
    outputs = effect_examples.stored_outputs()
    assert name in outputs, "run python docs/_ext/effect_examples.py"
    page = PAGES[f"effects/{name}"]
    places = [page.index(part) for part in ("## Law", "<!-- plot", "## Scenario", "## Example")]
    assert places == sorted(places)
    assert outputs[name].strip() in page
    for line in page[places[-1] :].splitlines():
        assert len(line) <= 100, line


def test_no_output_is_stored_of_an_effect_that_does_not_exist() -> None:
    assert set(effect_examples.stored_outputs()) == set(EFFECTS) == set(effect_cases.all_cases())


def test_the_scenario_of_an_effect_is_one_that_has_it_in_its_own_file() -> None:
    assert "boatsim run joystick_boat/" in PAGES["effects/weak_reverse"]
    assert "boatsim run jet_ski/" in PAGES["effects/planing_lag"]
    assert "No shipped scenario" in PAGES["effects/tether"]


@pytest.mark.slow
@pytest.mark.parametrize("names", [EFFECTS[::6], long(EFFECTS)], ids=["every sixth", "all"])
def test_the_examples_of_effects_print_what_their_pages_show(names: list[str]) -> None:
    command = [sys.executable, "-W", "ignore", "docs/_ext/effect_examples.py", "--check", *names]
    environment = os.environ | {"BOATSIM_DEBUG": "1", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


LAWS = """
import sys
sys.path.insert(0, "docs/_ext")
import effect_cases, law_plots, numpy as np
from math import cos, sin

def curve(name, over, x, key):
    case = effect_cases.all_cases()[name]
    _, effect, vessel = law_plots._laws(name, case)[-1]
    return np.array([law_plots._evaluate(effect, vessel, case, over, v) for v in x])[:, "XYZKMN".index(key)]

x = np.linspace(-1.0, 1.0, 9)
assert np.allclose(curve("surge_drag", "u", x, "X"), -(1.0 + 4.0 * abs(x)) * x)
assert np.allclose(curve("speed_loss_in_turn", "v", x, "X"), 10.0 * x * 0.3)
assert np.allclose(curve("wind", "psi", x, "Y"), 0.1 * np.sin(1.57 - x))
assert np.allclose(curve("thrust_loss_with_speed", "u", x, "X"), -(0.5 * x + 0.3 * x * abs(x)) * 0.6)
assert np.allclose(curve("rudder_stall", "angle", x, "N"), 391.9 * np.clip(x, -0.3, 0.3))
for name in list(effect_cases.all_cases())[::8]:
    assert law_plots.plot(name) == law_plots.plot(name), name
"""


@pytest.mark.slow
def test_the_plots_show_the_laws_of_the_formulas_and_are_the_same_each_time() -> None:
    environment = os.environ | {"BOATSIM_DEBUG": "1", "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", LAWS]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
