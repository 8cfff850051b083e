"""Tables of [runs] in recording.toml that hold for several recordings."""

from pathlib import Path

from boatsim.recordings.notes import notes_for

NOTES = """
[set.held_freedom]
roll = 0.0

[runs."4*".set.held_freedom]
roll = 1.0

[runs."41*".noise]
roll_sd_rad = 0.01

[runs.4101]
use = [1.0, 2.0]
[runs.4101.set.held_freedom]
heave = 1.0
"""


def test_a_pattern_holds_for_the_recordings_whose_names_match(tmp_path: Path) -> None:
    (tmp_path / "recording.toml").write_text(NOTES)
    for name in ("3101", "4021", "4101"):
        (tmp_path / f"{name}.csv").write_text("t_s\n")
    free = notes_for(tmp_path / "3101.csv").notes
    wedged = notes_for(tmp_path / "4021.csv").notes
    both = notes_for(tmp_path / "4101.csv").notes
    assert free.settings == {"held_freedom": {"roll": 0.0}}
    assert wedged.settings == {"held_freedom": {"roll": 1.0}}
    assert wedged.noise == {}
    assert both.settings == {"held_freedom": {"roll": 1.0, "heave": 1.0}}
    assert both.noise == {"roll_sd_rad": 0.01}
    assert both.use == ((1.0, 2.0),)
