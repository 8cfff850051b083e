"""Hulls that MuJoCo would not bear are refused in one line, and only those."""

from pathlib import Path

import boats
import pytest

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.simulate.hull_xml_check import check_hull_file
from boatsim.simulate.world import build_model

BEGIN = '<mujoco><worldbody><body name="hull"><geom {} type="box" size="1 1 1"/></body></worldbody>{}</mujoco>'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (BEGIN.format('class="a%n"', ""), "has a %"),
        (BEGIN.format('class="a&#37;n"', ""), "has a %"),
        (BEGIN.format('class="<!-- %n -->"', ""), "has a %"),
        (BEGIN.format("class='%s%s'", ""), "has a %"),
        (BEGIN.format("", '<include file="more.xml"/>'), "more.xml: has a %"),
        (BEGIN.format('pos="0 NaN 0"', ""), "has nan"),
    ],
)
def test_what_would_end_the_process_is_refused(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "hull.xml").write_text(text)
    (tmp_path / "more.xml").write_text(
        '<mujocoinclude><include file="hull.xml"/><a class="%n"/></mujocoinclude>'
    )
    with pytest.raises(BadInput, match=said):
        check_hull_file(tmp_path / "hull.xml")


@pytest.mark.parametrize(
    "hiding",
    [
        "<![CDATA[ > <!-- ]]>",
        '<![CDATA[ " ]]>',
        '<!DOCTYPE a [ <!ENTITY b "> <!--"> ]>',
        "<!DOCTYPE a>",
    ],
)
def test_what_could_hide_a_tag_is_refused(tmp_path: Path, hiding: str) -> None:
    (tmp_path / "hull.xml").write_text(hiding + BEGIN.format('class="%n"', ""))
    with pytest.raises(BadInput, match="allowed are tags and comments"):
        check_hull_file(tmp_path / "hull.xml")


def test_an_instruction_hides_no_tag(tmp_path: Path) -> None:
    (tmp_path / "hull.xml").write_text(
        '<?xml version="1.0" encoding="utf-8"?>' + BEGIN.format("", "")
    )
    check_hull_file(tmp_path / "hull.xml")
    (tmp_path / "hull.xml").write_text("<?odd ' ?>" + BEGIN.format('class="%n"', ""))
    with pytest.raises(BadInput, match="has a %"):
        check_hull_file(tmp_path / "hull.xml")


@pytest.mark.parametrize("comment", ["<!-- 5 % of trim -->", '<!-- class="%n" -->', "<!-- nan -->"])
def test_a_comment_may_say_anything(tmp_path: Path, comment: str) -> None:
    (tmp_path / "hull.xml").write_text(comment + BEGIN.format('name="nanny"', comment))
    check_hull_file(tmp_path / "hull.xml")


@pytest.mark.parametrize(
    "text", ["<" * 10**6, '<"' * 10**6, "<!--" * 10**6, "<a b='" * 10**6, "<include " * 10**5]
)
def test_rubbish_takes_no_time(tmp_path: Path, text: str) -> None:
    (tmp_path / "hull.xml").write_text(text)
    check_hull_file(tmp_path / "hull.xml")


@pytest.mark.parametrize(
    "hull",
    [
        b'<mujoco><worldbody><body name="hu\xff"/></worldbody></mujoco>',
        b"",
        b"<mujoco>",
        b"\xff\xfe\0",
        BEGIN.format("", '<asset><mesh name="q" file="nope.obj"/></asset>').encode(),
        BEGIN.format('name="a"/><geom name="b"', "").replace("1 1 1", "0 0 0").encode(),
    ],
)
def test_a_hull_that_is_none_is_one_line(tmp_path: Path, hull: bytes) -> None:
    place = boats.written(tmp_path, "test_boat", boats.ROLL)
    (place / "hull.xml").write_bytes(hull)
    with pytest.raises(BadInput, match=r"hull\.xml: "):
        build_model(vessel.load_vessel(f"{place}/"))
