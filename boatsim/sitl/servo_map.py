"""Maps the servo outputs of an autopilot to the command channels of a vessel."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic import Field

from boatsim.errors import BadInput
from boatsim.files import Table, read_toml, validate_table
from boatsim.physics.vessel import Vessel
from boatsim.simulate.manoeuvre import complete_manoeuvring_table
from boatsim.sitl.servo_packet import OUTPUTS

# Pulses [us] at which a servo output has its smallest, neutral and largest value: the limits and
# the trim of the default parameters of Rover (SERVOn_MIN, SERVOn_TRIM, SERVOn_MAX)
PULSES = (1000.0, 1500.0, 2000.0)
# [us] A shorter or longer pulse is no signal; ArduPilot sends 0 for an output without a function
SHORTEST_PULSE, LONGEST_PULSE = 500, 2500
MICROSECONDS = "_us"  # ending of a channel whose unit is that of the pulses
# Servo outputs of Rover by default: steering and throttle, or throttle left and right
STEERING, THROTTLE = 1, 3
LEFT, RIGHT = 1, 3


class ServoTable(Table):
    """Table [[servo]] of a file that maps servo outputs to channels."""

    output: int = Field(ge=1, le=max(OUTPUTS.values()))
    channel: str
    pulse: tuple[float, float, float] = PULSES  # [us]
    # at these pulses; default: low, neutral and high of the channel
    command: tuple[float, float, float] | None = None


class ServoFile(Table):
    """Content of a file that maps servo outputs to channels."""

    servo: list[ServoTable] = Field(min_length=1)


@dataclass(frozen=True)
class Servo:
    """Effect of one servo output on one command channel, linear on both sides of the trim.

    Attributes:
        output: Number of the servo output, from 1.
        channel: The command channel.
        commands: Commands at the shortest pulse, at the trim and at the longest pulse [unit of the
            channel].
        pulses: These pulses [us], in ascending order.
    """

    output: int
    channel: str
    commands: tuple[float, float, float]
    pulses: tuple[float, float, float] = PULSES

    def command(self, pulse: float) -> float:
        """Return the command of the channel at a pulse, which is limited to the range.

        Args:
            pulse: Pulse of the servo output [us]; one that is no signal gives the command at trim.
        """
        low, trim, high = self.pulses
        at_low, at_trim, at_high = self.commands
        if not SHORTEST_PULSE <= pulse <= LONGEST_PULSE:
            return at_trim
        if pulse >= trim:
            share = min((pulse - trim) / (high - trim), 1.0)
            return at_trim + share * (at_high - at_trim)
        share = min((trim - pulse) / (trim - low), 1.0)
        return at_trim + share * (at_low - at_trim)


@dataclass(frozen=True)
class ServoMap:
    """Mapping from all servo outputs to the commands of a vessel; other channels are neutral.

    Attributes:
        servos: Effects of the outputs.
        steering: What the autopilot must be set up for, in words.
    """

    servos: tuple[Servo, ...]
    steering: str = "own map"

    def commands(self, pulses: Sequence[int]) -> dict[str, float]:
        """Return the commands of the mapped channels.

        Args:
            pulses: Pulse of each servo output [us]; missing outputs have no signal.
        """
        found: dict[str, float] = {}
        for servo in self.servos:
            pulse = 0
            if servo.output <= len(pulses):
                pulse = pulses[servo.output - 1]
            found[servo.channel] = servo.command(pulse)
        return found

    def describe(self) -> list[str]:
        """Return one line for each channel: output, pulses and commands at them."""
        lines = []
        for servo in self.servos:
            points = []
            for pulse, command in zip(servo.pulses, servo.commands, strict=True):
                points.append(f"{pulse:g} us {command:g}")
            lines.append(f"servo output {servo.output}: {servo.channel}, {', '.join(points)}")
        return lines


def default_servo_map(vessel: Vessel) -> ServoMap:
    """Return the map for the default outputs of Rover's frames.

    A vessel that is steered by the difference of its thrusts has throttle left on output 1 and
    throttle right on output 3 (skid steering). Any other one has its steering on output 1 and all
    its drives on output 3.

    Args:
        vessel: The vessel.

    Raises:
        BadInput: The vessel has no commands or no means of steering.
    """
    if not vessel.commands:
        raise BadInput(f"{vessel.name} has no command channels; an autopilot cannot control it")
    table = complete_manoeuvring_table(vessel)
    if table.ahead and set(table.steer) <= set(table.ahead):
        servos = []
        for channel, ahead in table.ahead.items():
            output = LEFT
            if table.steer.get(channel, 0.0) < 0.0:
                output = RIGHT
            servos.append(_full_range(vessel, output, channel, ahead))
        words = f"skid steering, throttle left on output {LEFT} and right on output {RIGHT}"
        return ServoMap(tuple(servos), words)
    servos = []
    for channel, per_rad in table.steer.items():
        servos.append(_full_range(vessel, STEERING, channel, per_rad))
    for channel, ahead in table.ahead.items():
        if channel not in table.steer:
            servos.append(_full_range(vessel, THROTTLE, channel, ahead))
    words = f"steering on output {STEERING} and throttle on output {THROTTLE}"
    if not table.ahead:
        words = f"steering on output {STEERING}; {vessel.name} keeps its speed by itself"
    return ServoMap(tuple(servos), words)


def servo_map_of_file(vessel: Vessel, path: Path) -> ServoMap:
    """Return the map that a TOML file with [[servo]] tables contains.

    Args:
        vessel: The vessel.
        path: The file.

    Raises:
        BadInput: The file cannot be read or contains a mistake.
    """
    file = validate_table(ServoFile, read_toml(path), str(path))
    servos = []
    for table in file.servo:
        servos.append(_checked_servo(vessel, table, f"{path}: [[servo]] {table.output}"))
    return _checked_map(servos, str(path))


def servo_map_of_options(vessel: Vessel, options: Iterable[str]) -> ServoMap:
    """Return the map that options of the command line give.

    Args:
        vessel: The vessel.
        options: Each "OUTPUT=CHANNEL", or "OUTPUT=-CHANNEL" for a reversed output.

    Raises:
        BadInput: An option contains a mistake.
    """
    servos = []
    for option in options:
        label = f"--servo {option}"
        output, equals, channel = option.partition("=")
        if not equals or not output.strip().isdigit():
            raise BadInput(f"{label}: write OUTPUT=CHANNEL, such as 1=thrust_port_N")
        name = channel.strip()
        content: dict[str, object] = {
            "output": int(output),
            "channel": name.removeprefix("-"),
        }
        table = validate_table(ServoTable, content, label)
        servo = _checked_servo(vessel, table, label)
        if name.startswith("-"):
            low, trim, high = servo.commands
            servo = Servo(servo.output, servo.channel, (high, trim, low))
        servos.append(servo)
    return _checked_map(servos, "--servo")


def _full_range(vessel: Vessel, output: int, channel: str, positive: float) -> Servo:
    """Effect of an output on the whole range of a channel, in the direction of a command."""
    low, trim, high = _range_of_channel(vessel, channel)
    if positive < 0.0:
        low, high = high, low
    return Servo(output, channel, (low, trim, high))


def _range_of_channel(vessel: Vessel, channel: str) -> tuple[float, float, float]:
    """Commands of a channel at the pulses `PULSES`."""
    found = vessel.commands[channel]
    if channel.endswith(MICROSECONDS):
        return PULSES  # the command is the pulse itself
    return found.low, found.neutral, found.high


def _checked_servo(vessel: Vessel, table: ServoTable, label: str) -> Servo:
    """Effect of an output as a table states it."""
    if table.channel not in vessel.commands:
        raise BadInput(f"{label}: {vessel.unknown_command_message(table.channel)}")
    if not 0.0 < table.pulse[0] < table.pulse[1] < table.pulse[2]:
        raise BadInput(f"{label}: pulse = {list(table.pulse)}; allowed are ascending pulses in us")
    commands = table.command or _range_of_channel(vessel, table.channel)
    found = vessel.commands[table.channel]
    for command in commands:
        if not found.low <= command <= found.high:
            raise BadInput(
                f"{label}: command = {command:g}; allowed {found.low:g} to {found.high:g}"
            )
    return Servo(table.output, table.channel, commands, table.pulse)


def _checked_map(servos: Sequence[Servo], label: str) -> ServoMap:
    """Map of some outputs, none of which shares a channel with another."""
    outputs: Mapping[str, list[int]] = {servo.channel: [] for servo in servos}
    for servo in servos:
        outputs[servo.channel].append(servo.output)
        if len(outputs[servo.channel]) > 1:
            raise BadInput(f"{label}: {servo.channel} is on two servo outputs; give it one")
    return ServoMap(tuple(servos))
