"""Content is searched for by name in the folders of content only."""

from pathlib import Path

import pytest

from boatsim.errors import BadInput
from boatsim.physics import trust
from boatsim.physics.content import find_content_file, is_scenario_name


@pytest.mark.parametrize("folder", ["..", "."])
def test_no_scenario_lies_outside_the_folder_of_scenarios(
    folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = tmp_path / "home"
    inside = home / "scenarios" / "bay"
    inside.mkdir(parents=True)
    for place in (inside, home, home / "scenarios"):
        (place / "calm.toml").write_text('about = "a scenario"\n')
    monkeypatch.setattr(trust, "user_content_folders", lambda: (home,))
    assert is_scenario_name("bay/calm")
    assert not is_scenario_name(f"{folder}/calm")


@pytest.mark.parametrize("kind", ["vessel", "controller", "scenario"])
@pytest.mark.parametrize("name", ["a" * 300, "a" * 300 + "/b", "a/" + "b" * 300])
def test_a_name_too_long_for_a_file_does_not_exist(kind: str, name: str) -> None:
    with pytest.raises(BadInput, match=f"{kind} '{name}' does not exist"):
        find_content_file(kind, name)
