"""Values of wrong types in vessel files, each refused in one line."""

from pathlib import Path

import boats
import pytest

from boatsim.errors import BadInput
from boatsim.physics import vessel

TERM = '[[effect]]\nuse = "described_force"\nname = "swirl"\naxis = "yaw"\n'
LAG = '[[effect]]\nuse = "command_delay"\ndelay = 0.1\n'
DAMPING = '[[effect]]\nuse = "roll_damping"\n'


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (f"{DAMPING}name = 3\n", "name = 3; allowed is a text"),
        (f'{DAMPING}name = ["a"]\n', "name = ['a']; allowed is a text"),
        (f"{LAG}fed_by = [1, 2]\n", "fed_by = [1, 2]; allowed is a name or a list of names"),
        (f"{LAG}on = [{{ a = 1 }}]\n", "on = [{'a': 1}]; allowed is a name or a list of names"),
        (f"{LAG}on = [[1]]\n", "on = [[1]]; allowed is a name or a list of names"),
        (f"{LAG}other_side = 1\n", "other_side = 1; allowed is true or false"),
        (f"{TERM}of = [{{ a = 1 }}]\n", "of = [{'a': 1}]; allowed is a name or a list of names"),
        (f"{TERM}of = 3\n", "of = 3; allowed is a name or a list of names"),
        (f"{TERM}of = []\nacts = [1]\n", "acts = [1]; allowed is a text"),
        (TERM.replace('"yaw"', "[]") + "of = []\n", "axis = []; allowed is a text"),
        (f"{TERM}of = []\ncoefficient = true\n", "coefficient = True; allowed is a number"),
    ],
)
def test_a_value_of_a_wrong_type_is_one_line(tmp_path: Path, more: str, said: str) -> None:
    place = boats.written(tmp_path, "test_boat", f"{boats.ROLL}{more}")
    with pytest.raises(BadInput) as error:
        vessel.load_vessel(f"{place}/")
    assert said in str(error.value) and "\n" not in str(error.value)
    assert str(error.value).startswith("test_boat/vessel.toml: ")
