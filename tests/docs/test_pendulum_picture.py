"""The picture of the tutorial on published logs shows what the tool finds today."""

import xml.etree.ElementTree as ElementTree

import pytest

from tests.pages import ROOT, figures, figures_agree
from tools.draw_pendulum import diagnosed, picture

SVG = "{http://www.w3.org/2000/svg}"


@pytest.mark.slow
def test_the_picture_of_the_pendulum_is_that_of_its_diagnosis(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    """The words are equal, and the figures agree to one unit of the last digit."""
    answer, runs = diagnosed(tmp_path_factory.mktemp("pendulum"))
    rms = answer["fit"]["roll_rms_rad"]
    assert rms["patched"] < 0.5 * rms["recalibrated"]  # half the error of retuning alone
    shown = (ROOT / "docs" / "pendulum.svg").read_text("utf-8")
    old, new = (
        list(ElementTree.fromstring(text).iter(f"{SVG}text"))
        for text in (shown, picture(answer, runs))
    )
    assert [len((text.text or "").split()) for text in old] == [
        len((text.text or "").split()) for text in new
    ]
    for before, now in zip(old, new, strict=True):
        pairs = zip(figures(before.text or ""), figures(now.text or ""), strict=True)
        assert all(figures_agree(*pair) for pair in pairs), (before.text, now.text)
