"""Base class of sensors whose errors are known by grade, such as "consumer" and "survey"."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Self

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import Value, read_toml
from boatsim.physics.content import snake_case
from boatsim.simulate.sensing import Sensor

GRADES = Path(__file__).with_name("sensor_grades.toml")


@cache
def sensor_grades() -> Mapping[str, Mapping[str, Mapping[str, Value]]]:
    """Return the grades of all sensors: name of the sensor -> grade -> values of its parameters."""
    found: dict[str, dict[str, dict[str, Value]]] = {}
    for sensor, grades in read_toml(GRADES).items():
        assert isinstance(grades, dict)
        tables = found.setdefault(sensor, {})
        for grade, values in grades.items():
            assert isinstance(values, dict)
            tables[grade] = values
    return found


@dataclass(frozen=True)
class GradedSensor(Sensor):
    """Base class of sensors with a `grade`, which sets the sizes of their errors.

    Values that are given beside the grade replace those of the grade. The defaults are the grade
    "consumer".
    """

    grade: str = ""  # of sensor_grades.toml

    @classmethod
    def grades(cls) -> Mapping[str, Mapping[str, Value]]:
        """Return the values of the parameters that each grade of the sensor sets, by its name.

        It is empty for a sensor that the table of grades lacks.
        """
        return sensor_grades().get(snake_case(cls.__name__), {})

    @classmethod
    def from_settings(cls, settings: Mapping[str, object]) -> Self:
        """Return a sensor with the values of its grade and the settings of a file, checked.

        Args:
            settings: Values of the parameters by name, and the grade.

        Raises:
            BadInput: The grade or a setting does not exist, or a value is not allowed.
        """
        grades = cls.grades()
        grade = settings.get("grade") or "consumer"
        if not grades and not settings.get("grade"):
            return super().from_settings(settings)
        if not isinstance(grade, str) or grade not in grades:
            raise BadInput(unknown_name_message(f"{cls.__name__}: grade", str(grade), grades))
        return super().from_settings({**grades[grade], **settings})
