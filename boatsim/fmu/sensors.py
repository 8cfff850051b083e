"""The sensors of a vessel's FMU: their variables, and their numbers in the C source.

`boatsim/fmu/c/sensors.h` contains the sensors themselves. They are those of a scenario: the
standard ones and additional ones, with the random streams that a run has.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any

from boatsim.errors import BadInput
from boatsim.fmu.units import base_unit, unit_of_channel
from boatsim.fmu.variables import Variable
from boatsim.fmu.ziggurat import ziggurat_source
from boatsim.physics.content import snake_case
from boatsim.physics.particulars import GRAVITY
from boatsim.simulate.control_columns import SENSED
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.sensing import Sensor, Sensors
from boatsim.simulate.sensors.compass import COMPENSATIONS, Compass
from boatsim.simulate.sensors.dvl import Dvl
from boatsim.simulate.sensors.gnss import Gnss
from boatsim.simulate.sensors.imu import Imu

# Readings in the order of the C source: fields of `Sense` after t, then those of further sensors
READINGS = ("psi", "r", "ax", "ay", "u", "v", "x", "y", "phi", "p", "q", "az", "fix_age_s")
ALWAYS = ("psi", "r", "ax", "ay")  # of the standard sensors; the others are options
WITH_SPEED_LOG = ("u",)
WITH_POSITION_FIX = ("x", "y")
IDEAL = (*ALWAYS, *WITH_SPEED_LOG, *WITH_POSITION_FIX)
STANDARD = "sensors"  # name of the standard sensors, as in a scenario
# Sensors that the C source has
ADDITIONAL: Mapping[str, type[Sensor]] = {"imu": Imu, "compass": Compass, "dvl": Dvl, "gnss": Gnss}
# Parameters that set the size of an array in the C source
CONSTANT = ("rate", "latency")
SEED = "sensors.seed"
LARGEST_SEED = 2.0**53  # a double holds each smaller whole number exactly
# Streams of a run: of the standard sensors, of the camera, and of each additional sensor
STANDARD_STREAM, FIRST_STREAM = 0, 2
SPARE_POINTS = 4  # of the path of an antenna beyond those within the age of a fix


@dataclass(frozen=True)
class SensorSuite:
    """The sensors of a vessel, with the time between their samples and their seed.

    Attributes:
        standard: Standard sensors.
        additional: Additional sensors by name, in the order of their random streams.
        period: Time between two samples [s].
        seed: Seed of the errors at the start; a parameter of the FMU.
        scenario: Name of the scenario of which they are.
    """

    standard: Sensors
    additional: Mapping[str, Sensor]
    period: float
    seed: int
    scenario: str

    @classmethod
    def from_scenario(cls, scenario: Scenario) -> "SensorSuite":
        """Return the sensors of a scenario, which are read once per control period.

        Args:
            scenario: The scenario.

        Raises:
            BadInput: An FMU cannot have one of the sensors, or the seed.
        """
        additional: dict[str, Sensor] = {}
        for sensor in scenario.additional_sensors:
            name = snake_case(type(sensor).__name__)
            if ADDITIONAL.get(name) is not type(sensor):
                raise BadInput(
                    f"{scenario.name}: an FMU takes no sensor {name!r}; allowed are "
                    f"{', '.join(ADDITIONAL)}"
                )
            additional[name] = sensor
        if scenario.file.seed > LARGEST_SEED:
            raise BadInput(
                f"{scenario.name}: seed = {scenario.file.seed}; an FMU takes 0 to "
                f"{LARGEST_SEED:.0f}"
            )
        period = scenario.controller.period
        return cls(scenario.sensors, additional, period, scenario.file.seed, scenario.name)

    def parameters(self) -> dict[str, float]:
        """Return the values of all numbers of the sensors by name, in the order of the C source."""
        found: dict[str, float] = {}
        for name, sensor in {STANDARD: self.standard, **self.additional}.items():
            for key in _numbers(sensor):
                found[f"{name}.{key}"] = float(getattr(sensor, key))
        return found

    def columns(self) -> dict[str, str]:
        """Return the readings that the sensors give, with their columns in a recording."""
        given = [*ALWAYS]
        if self.standard.ideal:
            given = [*IDEAL]
        else:
            if self.standard.speed_sd >= 0.0:
                given += WITH_SPEED_LOG
            if self.standard.position_sd >= 0.0:
                given += WITH_POSITION_FIX
        usual = {column.rpartition("_")[0]: column for column in SENSED}
        columns = {reading: usual[reading] for reading in given}
        for sensor in self.additional.values():
            columns |= type(sensor).columns
        return {reading: columns[reading] for reading in READINGS if reading in columns}


def _numbers(sensor: Any) -> dict[str, Any]:
    """Parameters of a sensor that are numbers, by name."""
    return {key: about for key, about in type(sensor).params().items() if key != "compensation"}


def sensor_variables(suite: SensorSuite) -> Iterator[Variable]:
    """Return the parameters and outputs of the sensors of an FMU.

    Parameters can be set before a simulation starts. The standard sensors have none if they are
    ideal.

    Args:
        suite: The sensors.
    """
    yield Variable(
        name=SEED,
        kind="SEED",
        index=0,
        unit="",
        words="seed of the errors of the sensors, a whole number, as of boatsim run",
        causality="parameter",
        variability="fixed",
        start=float(suite.seed),
        low=0.0,
        high=LARGEST_SEED,
    )
    values = suite.parameters()
    places = {name: place for place, name in enumerate(values)}
    for name, sensor in {STANDARD: suite.standard, **suite.additional}.items():
        if name == STANDARD and suite.standard.ideal:
            continue
        for key, about in _numbers(sensor).items():
            whole = f"{name}.{key}"
            low, high = about.low, about.high
            if key in CONSTANT:
                continue
            if name == STANDARD and key in ("speed_sd", "position_sd"):
                if values[whole] < 0.0:
                    continue
                low = 0.0
            unit = _unit(about.unit)
            words = about.words if unit or not about.unit else f"{about.words} [{about.unit}]"
            yield Variable(
                name=whole,
                kind="SENSOR_PARAMETER",
                index=places[whole],
                unit=unit,
                words=words,
                causality="parameter",
                variability="fixed",
                start=values[whole],
                low=low,
                high=high,
            )
    for reading, column in suite.columns().items():
        yield Variable(
            name=f"sensed_{column}",
            kind="SENSED",
            index=READINGS.index(reading),
            unit=unit_of_channel(column),
            words=f"last sample of a sensor, as the column sensed_{column} of a recording",
            causality="output",
            variability="discrete",
            initial="calculated",
        )


def _unit(unit: str) -> str:
    """A unit, or "" for one with a root, which FMI cannot express."""
    try:
        if unit:
            base_unit(unit)
    except BadInput:
        return ""
    return unit


def sensor_source(suite: SensorSuite) -> dict[str, str]:
    """Return the macros that choose the sensors of the C source, by name.

    Args:
        suite: The sensors.
    """
    parameters = suite.parameters()
    found = {
        "SENSOR_PARAMETERS": str(len(parameters)),
        "SAMPLE_PERIOD": suite.period.hex(),
        "STANDARD_SENSORS_ARE_IDEAL": str(int(suite.standard.ideal)),
        "STREAM_STANDARD": str(STANDARD_STREAM),
        "STANDARD_GRAVITY": GRAVITY.hex(),
        "GNSS_PATH": str(_antenna_points(suite)),
    }
    for place, name in enumerate(parameters):
        found[f"SENSOR_{name.replace('.', '_').upper()}"] = str(place)
    for name in ADDITIONAL:
        found[f"HAS_{name.upper()}"] = str(int(name in suite.additional))
    for stream, name in enumerate(suite.additional, FIRST_STREAM):
        found[f"STREAM_{name.upper()}"] = str(stream)
    for i, name in enumerate(COMPENSATIONS):
        found[f"COMPASS_{name.upper()}"] = str(i)
    compass = suite.additional.get("compass")
    if isinstance(compass, Compass):
        found["COMPASS_COMPENSATION"] = str(COMPENSATIONS.index(compass.compensation))
    return found


def sensor_tables() -> str:
    """Return the C source of the tables from which random numbers are made."""
    return ziggurat_source()


def _antenna_points(suite: SensorSuite) -> int:
    """Number of samples whose motion a satellite receiver needs for its next fix."""
    if "gnss" not in suite.additional:
        return SPARE_POINTS
    sensor: Any = suite.additional["gnss"]
    age = float(sensor.latency + 1.0 / sensor.rate)
    return ceil(age / suite.period) + SPARE_POINTS
