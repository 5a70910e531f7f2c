#!/usr/bin/env python3
"""A gateway that answers 2 ms late, and says by how much later the client at last counts on being.

usage: slow_gateway.py PORT
"""

import socket
import struct
import sys
import time

SAMPLES = 100
LATE = 0.002  # s
DELAY_AT = 200  # docs/gateway.md: the eighth number from byte 144 on

server = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
server.bind(("127.0.0.1", int(sys.argv[1])))
server.settimeout(20.0)
print("ready", flush=True)
delays = []
while len(delays) < SAMPLES:
    sample, client = server.recvfrom(512)
    delays.append(struct.unpack_from("<d", sample, DELAY_AT)[0])
    time.sleep(LATE)
    session, sequence = struct.unpack_from("<II", sample, 8)
    answer = struct.pack("<IHHIIIId", 0x47524F54, 1, 2, session, sequence, 2, 0, 0.0) + bytes(48) + struct.pack(
        "<7d", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    server.sendto(answer, client)
print("delay", delays[-1] - delays[0])
