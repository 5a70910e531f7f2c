#!/usr/bin/env python3
"""A Haply Inverse3, with or without a VerseGrip, for Torsion, through Haply's Inverse Service:

    pip install websocket-client      (Debian: python3-websocket)
    torsion view scenes/ball_on_cube_soft.gltf --device gateway &
    python3 haply.py

The service (docs.haply.co, 3.5) sends one state a message and takes one command for each. Its axes are right-handed, z up;
x is taken to point right and y away from the user. Run here against an emulated service only: it was not tried on a device.
"""

import argparse
import json
import time

import websocket

from torsion_gateway import ROTATION, TRANSLATION, Gateway

# What is published: 8 N, positions to 0.01 mm. Damping and mass are not: 0, and Torsion is cautious.
TRAITS = (0.0, 0.0, 0.0, 0.0, 1e-5, 0.0, 1e-3, 0.0, 8.0, 0.0, 0.0, 0.0)


def to_torsion(v):
    """x right, y away, z up to x right, y up, z towards the user."""
    return (v["x"], v["z"], -v["y"])


def to_haply(v):
    return {"x": v[0], "y": -v[2], "z": v[1]}


def grip_turn(state):
    """The VerseGrip's rotation x, y, z, w about Torsion's axes; None without one."""
    grips = state.get("wireless_verse_grip") or state.get("verse_grip") or []
    if not grips:
        return None
    turn = grips[0]["state"]["orientation"]
    return (*to_torsion(turn), turn["w"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--gateway", default="7747", help="port, path of a Unix socket, or HOST:PORT")
    parser.add_argument("--secret", help="a copy of what torsion was given as --gateway-secret")
    parser.add_argument("--service", default="ws://localhost:10001")
    parser.add_argument("--seconds", type=float, default=float("inf"))
    words = parser.parse_args()
    service = websocket.create_connection(words.service)
    state = json.loads(service.recv())
    device = state["inverse3"][0]["device_id"]
    home = to_torsion(state["inverse3"][0]["state"]["cursor_position"])  # where it is now is the middle
    turns = grip_turn(state) is not None
    gateway = Gateway(words.gateway, secret=words.secret,
                      sensed=TRANSLATION | (ROTATION if turns else 0), actuated=TRANSLATION, traits=TRAITS)
    end = time.monotonic() + words.seconds
    most, late = 0.0, 0
    try:
        while time.monotonic() < end:
            cursor = state["inverse3"][0]["state"]
            place = [p - h for p, h in zip(to_torsion(cursor["cursor_position"]), home)]
            moving = to_torsion(cursor.get("cursor_velocity", {"x": 0.0, "y": 0.0, "z": 0.0}))
            answer = gateway.exchange(place, grip_turn(state) or (0.0, 0.0, 0.0, 1.0), moving)
            force = answer.force if answer else (0.0, 0.0, 0.0)
            late += answer is None
            most = max(most, force[1])
            service.send(json.dumps({"inverse3": [{"device_id": device, "commands": {
                "set_cursor_force": {"vector": to_haply(force)}}}]}))
            state = json.loads(service.recv())
    finally:
        service.send(json.dumps({"inverse3": [{"device_id": device, "commands": {
            "set_cursor_force": {"vector": {"x": 0.0, "y": 0.0, "z": 0.0}}}}]}))
        service.close()
        gateway.close()
        print(f"up to {most:.4f} N upwards, {late} answers late")


if __name__ == "__main__":
    main()
