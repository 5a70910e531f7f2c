"""Haply's Inverse Service as docs.haply.co describes it, with a handle that goes down by 4 mm (-z) within a second: one state
a message, the next one when a command came. Says what force it was told.

usage: haply_service.py PORT
"""

import asyncio
import json
import os
import sys
import time

import websockets


async def serve(client):
    start, highest, last = time.monotonic(), 0.0, {"x": 0.0, "y": 0.0, "z": 0.0}
    try:
        while True:
            now = time.monotonic() - start
            down = 0.004 * min(max(now - 0.5, 0.0), 1.0)
            await client.send(json.dumps({"inverse3": [{"device_id": "04BA", "state": {
                "cursor_position": {"x": 0.02, "y": -0.1, "z": 0.15 - down},
                "cursor_velocity": {"x": 0.0, "y": 0.0, "z": 0.0}}}]}))
            command = json.loads(await client.recv())["inverse3"][0]
            assert command["device_id"] == "04BA"
            last = command["commands"]["set_cursor_force"]["vector"]
            assert set(last) == {"x", "y", "z"}
            highest = max(highest, last["z"])
            if abs(last["x"]) > 0.01 or abs(last["y"]) > 0.01:
                print("force sideways", last, flush=True)
            await asyncio.sleep(1e-3)
    except websockets.ConnectionClosed:
        print(f"force {last['x']:.4f} {last['y']:.4f} {last['z']:.4f} up to {highest:.4f}", flush=True)
        os._exit(0)  # one client is all it is for


async def main():
    async with websockets.serve(serve, "127.0.0.1", int(sys.argv[1])):
        print("ready", flush=True)
        await asyncio.Future()


asyncio.run(main())
