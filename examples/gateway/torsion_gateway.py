#!/usr/bin/env python3
"""A client of Torsion's gateway, and a hand made of numbers that presses a tool down and turns it.

    torsion view scenes/ball_on_cube_soft.gltf --device gateway      in one terminal
    python3 torsion_gateway.py                                       in another

For a device of your own: give `Gateway.exchange` the handle's pose each time you have read it, and display the force and
torque that come back; none where `answer.force` is zero, and none where nothing came for 5 ms.
"""

import argparse
import collections
import hmac
import math
import os
import secrets
import socket
import struct
import tempfile
import time

SAMPLE = struct.Struct("<IHHIId 3d4d 3d 3d IIII 12d")  # docs/gateway.md
ANSWER = struct.Struct("<IHHIIII d 3d 3d 3d4d")
HEAD = struct.Struct("<IHHII")
MAGIC, VERSION, SAMPLE_KIND, ANSWER_KIND = 0x47524F54, 1, 1, 2
CHALLENGE_SIZE, TAG, NO_NONCE = 32, 16, bytes(16)
PATIENCE = 0.005  # s: then there is no force any more
TRANSLATION, ROTATION, TURN = 1, 2, 4  # axes that a device senses or pushes on: sums of these
STATES = ("waiting", "rising", "live", "falling", "silent", "refused", "checking", "off")
Answer = collections.namedtuple("Answer", "sequence state faults time force torque tool_position tool_rotation")
# damping, turn damping, mass, inertia, encoder step, encoder turn step, period, delay, largest force, largest torque,
# largest stiffness, largest turn stiffness: N, m, kg, s, rad. 0: not known, and Torsion is cautious.
DELAY = 7
TRAITS = (1.0, 1e-3, 0.1, 1e-5, 5e-5, 1e-3, 1e-3, 0.0, 8.0, 0.3, 2000.0, 2.0)


class Gateway:
    """address: a port of this machine, the path of a Unix socket, or "HOST:PORT" of another machine. secret: a copy of the
    file that Torsion was given as --gateway-secret; without one Torsion is on this machine and has none."""

    def __init__(self, address=7747, sensed=TRANSLATION | ROTATION, actuated=TRANSLATION | ROTATION, traits=TRAITS,
                 secret=None):
        self.own = None
        if isinstance(address, int) or "/" not in address:
            host, _, port = str(address).rpartition(":")
            family, _, _, _, to = socket.getaddrinfo(host.strip("[]") or "127.0.0.1", port, type=socket.SOCK_DGRAM)[0]
            self.socket = socket.socket(family, socket.SOCK_DGRAM)
            self.socket.connect(to)
        else:
            self.own = os.path.join(tempfile.mkdtemp(), "client")
            self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
            self.socket.bind(self.own)
            self.socket.connect(address)
        self.socket.settimeout(PATIENCE)
        self.session, self.sequence = secrets.randbits(32), 0
        self.sensed, self.actuated, self.traits = sensed, actuated, list(traits)
        self.secret, self.nonce = None, NO_NONCE
        if secret is not None:
            with open(secret, "rb") as file:
                self.secret = file.read().strip()
        self.round_trip = 0.0  # s: from a sample to its answer, in the mean

    def tag(self, packet, nonce):
        """What only who has the secret can make."""
        return hmac.digest(self.secret, nonce + packet, "sha256")[:TAG] if self.secret else b""

    def receive(self):
        """The next packet without its tag; nothing of one that is not Torsion's."""
        came = self.socket.recv(512)
        packet = came[:-TAG] if self.secret else came
        nonce = packet[HEAD.size:] if len(packet) == CHALLENGE_SIZE else self.nonce
        return packet if hmac.compare_digest(self.tag(packet, nonce), came[len(packet):]) else b""

    def exchange(self, position, rotation=(0.0, 0.0, 0.0, 1.0), velocity=(0.0,) * 3, turn_rate=(0.0,) * 3, buttons=0):
        """Tells where the handle is: m, from the middle of its workspace, +y up, +z towards the user; rotation x, y, z, w.
        Returns the answer, or None where none came in time: then display no force."""
        self.sequence = (self.sequence + 1) & 0xFFFFFFFF
        asked = time.monotonic()
        head = (MAGIC, VERSION, self.session, self.sequence)
        try:
            self.send(asked, position, rotation, velocity, turn_rate, buttons)
            while time.monotonic() < asked + PATIENCE:
                packet = self.receive()
                if len(packet) < HEAD.size:
                    continue
                magic, version, kind, *whose = HEAD.unpack_from(packet)
                if (magic, version, *whose) != head:
                    continue  # of an older sample
                trip = time.monotonic() - asked
                self.round_trip += (0.01 if self.round_trip else 1.0) * (trip - self.round_trip)
                if kind == ANSWER_KIND:
                    state, faults, at, *numbers = ANSWER.unpack(packet)[5:]
                    return Answer(self.sequence, STATES[state], faults, at, tuple(numbers[0:3]), tuple(numbers[3:6]),
                                  tuple(numbers[6:9]), tuple(numbers[9:13]))
                self.nonce = packet[HEAD.size:]  # a challenge: once more, over its number
                self.send(asked, position, rotation, velocity, turn_rate, buttons)
        except (socket.timeout, ConnectionRefusedError, struct.error):
            pass
        self.nonce = NO_NONCE  # Torsion may have drawn another: it says so again
        return None

    def send(self, asked, position, rotation, velocity, turn_rate, buttons):
        traits = [*self.traits]
        traits[DELAY] += self.round_trip
        packet = SAMPLE.pack(MAGIC, VERSION, SAMPLE_KIND, self.session, self.sequence, asked, *position, *rotation,
                             *velocity, *turn_rate, buttons, self.sensed, self.actuated, 0, *traits)
        self.socket.send(packet + self.tag(packet, self.nonce))

    def close(self):
        self.socket.close()
        if self.own:
            os.unlink(self.own)
            os.rmdir(os.path.dirname(self.own))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("address", nargs="?", default="7747", help="port, path of a Unix socket, or HOST:PORT")
    parser.add_argument("--secret", help="a copy of what torsion was given as --gateway-secret")
    parser.add_argument("--seconds", type=float, default=4.0, help="after the tool is held")
    parser.add_argument("--press", type=float, default=0.004, help="m below where the tool is at first")
    parser.add_argument("--turn", type=float, default=40.0, help="degrees")
    words = parser.parse_args()
    gateway = Gateway(words.address, secret=words.secret)
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
