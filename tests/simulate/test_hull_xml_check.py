"""Hulls that MuJoCo would not bear are refused in one line, and only those."""

import os
import struct
import zlib
from contextlib import suppress
from pathlib import Path

import boats
import pytest

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.simulate.hull_xml_check import MOST_CELLS, MOST_ELEMENTS, check_hull_file
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
    with suppress(BadInput):
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


GEOM = '<geom size="0.1"/>'


def drawing(inside: str = GEOM, top: str = "", assets: str = "") -> str:
    """A hull with something in its body, at the top of the file or among its assets."""
    return (
        f"<mujoco>{top}<asset>{assets}</asset>"
        f'<worldbody><body name="hull">{inside}</body></worldbody></mujoco>'
    )


def built(folder: Path, text: str) -> object:
    place = boats.written(folder, "test_boat", boats.ROLL)
    (place / "hull.xml").write_text(text)
    return build_model(vessel.load_vessel(f"{place}/"))


REPLICATED = '<replicate count="{}">{}</replicate>'
MESH = '<mesh name="m" {}/>'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (drawing(top='<keyframe><key qpos="0 0"/></keyframe>'), "<keyframe>"),
        (drawing(f'<body><joint name="j"/>{GEOM}</body>'), "<joint>"),
        (drawing(top="<sensor><user dim='2000000000'/></sensor>"), "<sensor>"),
        (drawing(assets='<model name="a" file="hull.xml"/>'), "<model>"),  # itself, without an end
        (drawing('<flexcomp type="grid" count="999 999 999"/>'), "<flexcomp>"),
        (drawing(REPLICATED.format(100_000_000, GEOM)), f"more than {MOST_ELEMENTS} elements"),
        (drawing(REPLICATED.format(100_000_000, "")), f"more than {MOST_ELEMENTS} elements"),
        (
            drawing(REPLICATED.format(9999, REPLICATED.format(9999, GEOM))),
            f"more than {MOST_ELEMENTS} elements",
        ),
        (drawing(REPLICATED.format("1e8", GEOM)), "count = '1e8'; allowed are integers"),
        (drawing(300_000 * GEOM), f"more than {MOST_ELEMENTS} elements"),
        (
            drawing(REPLICATED.format(1500, '<include file="more.xml"/>')),
            f"more.xml: more than {MOST_ELEMENTS} elements",
        ),
        (drawing(assets='<hfield nrow="100000" ncol="100000" size="1 1 1 1"/>'), r"1e\+10 cells"),
        (drawing(assets='<texture builtin="flat" width="100000" height="9999"/>'), "cells"),
        (drawing(assets='<texture type="cube" builtin="flat" width="99999"/>'), "cells"),
        (drawing(assets=MESH.format('builtin="plate" params="100000 9"')), "params = 100000"),
    ],
)
def test_what_mujoco_would_not_finish_is_one_line(tmp_path: Path, text: str, said: str) -> None:
    place = boats.written(tmp_path, "test_boat", boats.ROLL)
    (place / "more.xml").write_text(f"<mujocoinclude>{2 * GEOM}</mujocoinclude>")
    with pytest.raises(BadInput, match=said) as error:
        built(tmp_path, text)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("top", "asset", "pipe"),
    [
        ("", MESH.format('file="pipe.stl"'), "pipe.stl"),
        ('<compiler meshdir="in"/>', MESH.format('file="pipe.obj"'), "in/pipe.obj"),
        ('<compiler strippath="true"/>', MESH.format('file="a/pipe.obj"'), "pipe.obj"),
        ("", '<texture type="2d" name="t" file="pipe.png"/>', "pipe.png"),
        ("", '<texture type="cube" name="t" fileup="pipe.png"/>', "pipe.png"),
        ("", '<hfield name="h" size="1 1 1 1" file="pipe.png"/>', "pipe.png"),
    ],
)
def test_a_named_pipe_as_a_mesh_or_texture_is_one_line(
    tmp_path: Path, top: str, asset: str, pipe: str
) -> None:
    place = boats.written(tmp_path, "test_boat", boats.ROLL)
    (place / "in").mkdir()
    os.mkfifo(place / pipe)
    with pytest.raises(BadInput, match=f"{pipe}: is no regular file"):
        built(tmp_path, drawing(top=top, assets=asset))


def test_an_image_that_expands_to_a_gigabyte_is_refused_by_its_header(tmp_path: Path) -> None:
    place = boats.written(tmp_path, "test_boat", boats.ROLL)
    side = 30_000
    assert side * side > MOST_CELLS
    header = b"IHDR" + struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
    image = b"\x89PNG\r\n\x1a\n\0\0\0\r" + header + struct.pack(">I", zlib.crc32(header))
    (place / "t.png").write_bytes(image)
    with pytest.raises(BadInput, match=r"t\.png: .* pixels; simplify them"):
        built(tmp_path, drawing(assets='<texture type="2d" name="t" file="t.png"/>'))


def test_a_hull_of_the_largest_size_is_built_and_repeats_what_it_may(tmp_path: Path) -> None:
    model = built(tmp_path, drawing(REPLICATED.format(MOST_ELEMENTS // 2 - 5, GEOM)))
    assert model.ngeom > MOST_ELEMENTS // 2 - 5


def test_options_of_a_hull_cause_no_warning_of_mujoco(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    built(tmp_path, drawing(top='<option timestep="0.5"/><size memory="1G"/>'))
    assert capfd.readouterr().err == "" and not (tmp_path / "MUJOCO_LOG.TXT").exists()
