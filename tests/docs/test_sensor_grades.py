"""The page of sensors shows the grades that the program uses."""

from tests.pages import ROOT, grade_table


def test_the_table_of_grades_is_that_of_the_file() -> None:
    page = (ROOT / "docs" / "sensors.md").read_text(encoding="utf-8")
    redraw = "run python docs/_ext/grade_table.py"
    assert "\n".join(grade_table.grade_table()) + "\n\n" in page, redraw
