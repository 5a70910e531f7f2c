#!/usr/bin/env python3
"""A client of Torsion's gateway, and a hand made of numbers that presses a tool down and turns it.

    torsion view scenes/ball_on_cube_soft.gltf --device gateway      in one terminal
    python3 torsion_gateway.py                                       in another

For a device of your own: give `Gateway.exchange` the handle's pose each time you have read it, and display the force and
torque that come back; none where `answer.force` is zero, and none where nothing came for 5 ms.
"""

import argparse
import collections
import math
import os
import random
import socket
import struct
import tempfile
import time

SAMPLE = struct.Struct("<IHHIId 3d4d 3d 3d IIII 12d")  # docs/gateway.md
ANSWER = struct.Struct("<IHHIIII d 3d 3d 3d4d")
MAGIC, VERSION = 0x47524F54, 1
TRANSLATION, ROTATION, TURN = 1, 2, 4  # axes that a device senses or pushes on: sums of these
STATES = ("waiting", "rising", "live", "falling", "silent", "refused", "checking", "off")
Answer = collections.namedtuple("Answer", "sequence state faults time force torque tool_position tool_rotation")
# damping, turn damping, mass, inertia, encoder step, encoder turn step, period, delay, largest force, largest torque,
# largest stiffness, largest turn stiffness: N, m, kg, s, rad. 0: not known, and Torsion is cautious.
TRAITS = (1.0, 1e-3, 0.1, 1e-5, 5e-5, 1e-3, 1e-3, 0.0, 8.0, 0.3, 2000.0, 2.0)


class Gateway:
    """address: a port of this machine, or the path of a Unix socket."""

    def __init__(self, address=7747, sensed=TRANSLATION | ROTATION, actuated=TRANSLATION | ROTATION, traits=TRAITS):
        self.own = None
        if isinstance(address, int):
            self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.socket.connect(("127.0.0.1", address))
        else:
            self.own = os.path.join(tempfile.mkdtemp(), "client")
            self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
            self.socket.bind(self.own)
            self.socket.connect(address)
        self.socket.settimeout(0.005)  # s: then there is no force any more
        self.session, self.sequence = random.getrandbits(32), 0
        self.sensed, self.actuated, self.traits = sensed, actuated, traits

    def exchange(self, position, rotation=(0.0, 0.0, 0.0, 1.0), velocity=(0.0,) * 3, turn_rate=(0.0,) * 3, buttons=0):
        """Tells where the handle is: m, from the middle of its workspace, +y up, +z towards the user; rotation x, y, z, w.
        Returns the answer, or None where none came in time: then display no force."""
        self.sequence = (self.sequence + 1) & 0xFFFFFFFF
        packet = SAMPLE.pack(MAGIC, VERSION, 1, self.session, self.sequence, time.monotonic(), *position, *rotation,
                             *velocity, *turn_rate, buttons, self.sensed, self.actuated, 0, *self.traits)
        try:
            self.socket.send(packet)
            while True:
                answer = ANSWER.unpack(self.socket.recv(ANSWER.size))
                head, (state, faults, at), numbers = answer[:5], answer[5:8], answer[8:]
                if head[:4] == (MAGIC, VERSION, 2, self.session) and head[4] == self.sequence:
                    return Answer(head[4], STATES[state], faults, at, numbers[0:3], numbers[3:6], numbers[6:9],
                                  numbers[9:13])
        except (socket.timeout, ConnectionRefusedError, struct.error):
            return None

    def close(self):
        self.socket.close()
        if self.own:
            os.unlink(self.own)
            os.rmdir(os.path.dirname(self.own))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("address", nargs="?", default="7747", help="port, or path of a Unix socket")
    parser.add_argument("--seconds", type=float, default=4.0, help="after the tool is held")
    parser.add_argument("--press", type=float, default=0.004, help="m below where the tool is at first")
    parser.add_argument("--turn", type=float, default=40.0, help="degrees")
    words = parser.parse_args()
    gateway = Gateway(int(words.address) if words.address.isdigit() else words.address)
    begun = due = time.monotonic()
    held_at, most, most_torque, lost, answer = None, 0.0, 0.0, 0, None
    while (now := time.monotonic()) - begun < 60.0 and (held_at is None or now - held_at < words.seconds):
        # Waits at the tool until it has all of its force (a check of its signs comes first), then goes down, and turns.
        if held_at is None and answer is not None and answer.state == "live":
            held_at = now
        held = now - held_at if held_at is not None else 0.0
        share = min(max((held - 0.5) / 1.0, 0.0), 1.0)
        half = math.radians(words.turn) * min(max((held - 1.5) / 1.5, 0.0), 1.0) / 2.0
        answer = gateway.exchange((0.0, -words.press * share, 0.0), (0.0, math.sin(half), 0.0, math.cos(half)))
        if answer is None:
            lost += 1
        else:
            most = max(most, math.hypot(*answer.force))
            most_torque = max(most_torque, math.hypot(*answer.torque))
        due += 1e-3
        time.sleep(max(0.0, due - time.monotonic()))
    print(f"force up to {most:.3f} N, torque up to {most_torque:.5f} N m, at last "
          f"{answer.state if answer else 'silent'}, {lost} answers late")
    gateway.close()


if __name__ == "__main__":
    main()
