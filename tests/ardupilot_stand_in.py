"""Stand-in for ArduPilot's software in the loop, written from its documentation: it sends servo outputs
over UDP, reads the sensor readings of the simulator, and steers a boat along a course or a square.

python -m tests.ardupilot_stand_in --port 9002 --square 20 --seconds 120

It knows nothing of boatsim. Position and speed come from the readings, not from an estimator as in
ArduPilot, and there is no mode, no arming and no MAVLink.
"""

import argparse
import json
import re
import socket
import struct
from collections.abc import Callable, Sequence
from math import atan2, degrees, hypot, pi, radians
from typing import Any

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
# Section, key and how many numbers follow it, in the order in which ArduPilot looks for them
FIELDS = (
    ("", "timestamp", 1),
    ("imu", "gyro", 3),
    ("imu", "accel_body", 3),
    ("", "position", 3),
    ("", "attitude", 3),
    ("", "velocity", 3),
    ("windvane", "direction", 1),
    ("windvane", "speed", 1),
)
Readings = dict[str, tuple[float, ...]]
TRIM = 1500  # [us]


def read_message(message: bytes) -> Readings:
    """The readings in a message, found as ArduPilot's parser finds them: by a search for the name of the
    section and then of the key; the value begins two characters after the key. Blanks are not allowed
    there, and a key that is a part of an earlier word would be read in the wrong place."""
    assert message.startswith(b"\n") and message.endswith(b"\n"), "a line feed before and after"
    text = message.decode("ascii").strip("\n")
    assert "\n" not in text
    found: Readings = {}
    for section, key, size in FIELDS:
        at = text.find(section)
        if at < 0:
            continue
        at = text.find(key, at + len(section) + 1)
        assert at >= 0, f"{section} without {key}"
        values = text[at + len(key) + 2 :]
        if size > 1:
            assert values[0] == "["
            values = values[1:]
        numbers = []
        for part in values.split(",")[:size]:
            number = NUMBER.match(part)
            assert number, f"{key}: {part}"
            numbers.append(float(number[0]))
        found[f"{section}.{key}".strip(".")] = tuple(numbers)
    return found


class StandIn:
    """One autopilot on the loopback interface."""

    def __init__(self, port: int, rate: int = 50, outputs: int = 16, counter: int = 0) -> None:
        self.simulator = ("127.0.0.1", port)
        self.rate, self.outputs, self.counter = rate, outputs, counter
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.message = b""
        self.packet = b""

    def __enter__(self) -> "StandIn":
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def send(self, pulses: dict[int, int]) -> None:
        """Send the next frame: pulse [us] by number of the output, from 1; others have no signal."""
        values = [pulses.get(number, 0) for number in range(1, self.outputs + 1)]
        magic = {16: 18458, 32: 29569}[self.outputs]
        self.packet = struct.pack(f"<HHI{self.outputs}H", magic, self.rate, self.counter, *values)
        self.counter += 1
        self.repeat()

    def repeat(self) -> None:
        """Send the last frame again, as after a second without an answer."""
        self.socket.sendto(self.packet, self.simulator)

    def receive(self, seconds: float = 60.0) -> Readings:
        """The readings in the next answer; the frame is sent again each second until it arrives."""
        self.socket.settimeout(1.0)
        for _ in range(round(seconds)):
            try:
                self.message, _ = self.socket.recvfrom(65000)
            except TimeoutError:
                self.repeat()
            else:
                json.loads(self.message)  # it is valid JSON, too
                return read_message(self.message)
        raise TimeoutError("the simulator does not answer")

    def is_quiet(self, seconds: float = 0.1) -> bool:
        """Whether no further answer arrives."""
        self.socket.settimeout(seconds)
        try:
            self.socket.recvfrom(65000)
        except TimeoutError:
            return True
        return False

    def exchange(self, pulses: dict[int, int]) -> Readings:
        """Send a frame and wait for its answer."""
        self.send(pulses)
        return self.receive()

    def drive(self, law: Callable[[Readings], dict[int, int]], seconds: float) -> list[Readings]:
        """Steer by a law from readings to pulses for a simulated time; the readings of all frames."""
        rows = [self.exchange(dict.fromkeys((1, 3), TRIM))]
        while rows[-1]["timestamp"][0] < seconds - 1e-6:
            rows.append(self.exchange(law(rows[-1])))
        return rows


def wrapped(angle: float) -> float:
    """An angle between -pi and pi."""
    return (angle + pi) % (2.0 * pi) - pi


class HeadingHold:
    """PID law of the heading, with a constant throttle, for skid steering or for steering and throttle.

    The output of the law and the throttle are shares of full scale, as in Rover's mixers.
    """

    def __init__(self, heading: float, throttle: float, rate: int, skid: bool = True) -> None:
        self.heading, self.throttle, self.period, self.skid = heading, throttle, 1.0 / rate, skid
        self.p, self.i, self.d = 0.8, 0.05, 0.4
        if not skid:  # a steered drive turns the more, the more throttle it has
            self.p, self.i, self.d = 0.4, 0.02, 0.6
        self.sum = 0.0

    def __call__(self, readings: Readings) -> dict[int, int]:
        error = wrapped(self.heading - readings["attitude"][2])
        self.sum += error * self.period
        turn = self.p * error + self.i * self.sum - self.d * readings["imu.gyro"][2]
        return self.pulses(max(-0.6, min(turn, 0.6)))

    def pulses(self, turn: float) -> dict[int, int]:
        """Pulses [us] of outputs 1 and 3."""
        if self.skid:
            return {1: pulse(self.throttle + turn), 3: pulse(self.throttle - turn)}
        return {1: pulse(turn), 3: pulse(self.throttle)}


class Square(HeadingHold):
    """Drives along a square to starboard by heading for one corner after another."""

    def __init__(self, side: float, throttle: float, rate: int, skid: bool = True) -> None:
        super().__init__(0.0, throttle, rate, skid)
        self.corners = [(side, 0.0), (side, side), (0.0, side), (0.0, 0.0)]
        self.near = 0.15 * side
        self.passed = 0

    def __call__(self, readings: Readings) -> dict[int, int]:
        north, east = self.corners[self.passed % 4]
        x, y, _ = readings["position"]
        if hypot(north - x, east - y) < self.near:
            self.passed += 1
            north, east = self.corners[self.passed % 4]
        self.heading = atan2(east - y, north - x)
        return super().__call__(readings)


def pulse(share: float) -> int:
    """Pulse [us] of a share of full scale, from -1 to 1."""
    return round(TRIM + 500.0 * max(-1.0, min(share, 1.0)))


def main(arguments: Sequence[str] | None = None) -> None:
    """Steer one boat from the command line."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n\n")[0])
    parser.add_argument("--port", type=int, default=9002)
    parser.add_argument("--rate", type=int, default=50, help="frames per second of simulated time")
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated duration")
    parser.add_argument("--throttle", type=float, default=0.6, help="share of full throttle")
    parser.add_argument(
        "--steering", action="store_true", help="steering and throttle, no skid steering"
    )
    parser.add_argument("--heading", type=float, help="heading to hold [deg]")
    parser.add_argument("--square", type=float, default=20.0, help="side of the square [m]")
    given = parser.parse_args(arguments)
    law: Any = Square(given.square, given.throttle, given.rate, not given.steering)
    if given.heading is not None:
        law = HeadingHold(radians(given.heading), given.throttle, given.rate, not given.steering)
    with StandIn(given.port, given.rate) as autopilot:
        last = autopilot.drive(law, given.seconds)[-1]
    north, east, _ = last["position"]
    print(
        f"t = {last['timestamp'][0]:.2f} s: north {north:.2f} m, east {east:.2f} m, "
        f"heading {degrees(last['attitude'][2]):.1f} deg"
    )
    if isinstance(law, Square):
        print(f"{law.passed} corners of the square passed")


if __name__ == "__main__":
    main()
