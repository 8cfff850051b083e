"""Packets of servo outputs that ArduPilot's software in the loop sends to a simulator.

A packet is binary, in the byte order of the machine (little-endian): a magic number (16 bits), the
frame rate (16 bits), the frame counter (32 bits) and the pulse of each servo output (16 bits). The
magic number tells how many outputs follow. Source: libraries/SITL/examples/JSON/readme.md of
ArduPilot.
"""

import struct
from typing import NamedTuple

OUTPUTS = {18458: 16, 29569: 32}  # magic number -> servo outputs
HEADER = struct.Struct("<HHI")
LARGEST = HEADER.size + 2 * max(OUTPUTS.values())  # bytes of a packet


class ServoFrame(NamedTuple):
    """Servo outputs of one frame of the autopilot.

    Attributes:
        rate: Frames per simulated second [Hz]; the simulation advances by its inverse.
        counter: Number of the frame, modulo 2^32.
        pulses: Pulse of each servo output [us]; 0 for an output without a signal.
    """

    rate: int
    counter: int
    pulses: tuple[int, ...]


def parse_servo_packet(packet: bytes) -> ServoFrame | None:
    """Return the servo outputs in a packet.

    Args:
        packet: The packet as it was received.

    Returns:
        The frame; None if the packet is malformed: wrong magic number or length, or a rate of 0.
    """
    if len(packet) < HEADER.size:
        return None
    magic, rate, counter = HEADER.unpack_from(packet)
    outputs = OUTPUTS.get(magic)
    if outputs is None or rate == 0 or len(packet) != HEADER.size + 2 * outputs:
        return None
    pulses = struct.unpack_from(f"<{outputs}H", packet, HEADER.size)
    return ServoFrame(rate, counter, pulses)
