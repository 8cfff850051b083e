"""Writes the table of sensor grades into docs/sensors.md: `python docs/_ext/grade_table.py`."""

from pathlib import Path

from boatsim.physics.content import load_class
from boatsim.simulate.graded_sensor import sensor_grades

PAGE = Path(__file__).parents[1] / "sensors.md"
HEAD = "| sensor | error | consumer | survey | unit |"
GRADES = ("consumer", "survey")


def grade_table() -> list[str]:
    """Return the lines of the table: each error with its size in both grades and its unit."""
    lines = [HEAD, "| --- | --- | --- | --- | --- |"]
    for sensor, grades in sensor_grades().items():
        kind = load_class("sensor", sensor)
        default = kind()
        names = dict.fromkeys(name for grade in GRADES for name in grades[grade])
        for name in names:
            values = [grades[grade].get(name, getattr(default, name)) for grade in GRADES]
            about = kind.params().get(name)
            words = about.words if about else "how roll and pitch are known"
            shown = [f"{value:g}" if isinstance(value, float) else str(value) for value in values]
            unit = about.unit if about else ""
            lines.append(f"| `{sensor}` | {words} | {shown[0]} | {shown[1]} | {unit} |")
    return lines


def main() -> None:
    """Replace the table of the page."""
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    begin = lines.index("GRADES") if "GRADES" in lines else lines.index(HEAD)
    end = begin + 1
    while lines[end].startswith("|"):
        end += 1
    lines[begin:end] = grade_table()
    PAGE.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
