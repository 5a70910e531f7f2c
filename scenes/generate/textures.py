"""Small pictures for the scenes' surfaces, made of noise that repeats, as the bytes of PNG files."""

import math
import struct
import zlib

SIDE = 256  # pixels


def png(pixel):
    """pixel(x, y) -> (r, g, b), 0 to 1, encoded."""
    rows = bytearray()
    for y in range(SIDE):
        rows.append(0)
        for x in range(SIDE):
            rows += bytes(max(0, min(255, round(255.0 * c))) for c in pixel(x, y))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", SIDE, SIDE, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9))
            + chunk(b"IEND", b""))


def hashed(*numbers):
    """0 to 1, the same for the same whole numbers."""
    h = 2166136261
    for n in numbers:
        h = ((h ^ (n & 0xFFFF)) * 16777619) & 0xFFFFFFFF
    h ^= h >> 15
    h = (h * 2246822519) & 0xFFFFFFFF
    return ((h ^ (h >> 13)) & 0xFFFFFF) / 0x1000000


def noise(x, y, cells, seed):
    """Smooth, 0 to 1, `cells` waves across the picture, which it repeats in."""
    u, v = x * cells / SIDE, y * cells / SIDE
    i, j = math.floor(u), math.floor(v)
    f, g = u - i, v - j
    f, g = f * f * (3.0 - 2.0 * f), g * g * (3.0 - 2.0 * g)

    def at(a, b):
        return hashed(a % cells, b % cells, seed)

    low = at(i, j) + f * (at(i + 1, j) - at(i, j))
    high = at(i, j + 1) + f * (at(i + 1, j + 1) - at(i, j + 1))
    return low + g * (high - low)


def layered(x, y, cells, seed):
    return sum(noise(x, y, cells << k, seed + k) * 0.5 ** (k + 1) for k in range(4)) / 0.9375


def nearest(x, y, cells, seed):
    """Distances to the nearest and second nearest of scattered points, in cells."""
    u, v = x * cells / SIDE, y * cells / SIDE
    i, j = math.floor(u), math.floor(v)
    found = []
    for a in range(i - 1, i + 2):
        for b in range(j - 1, j + 2):
            px = a + hashed(a % cells, b % cells, seed)
            py = b + hashed(a % cells, b % cells, seed + 1)
            found.append(math.hypot(u - px, v - py))
    found.sort()
    return found[0], found[1]


def blend(a, b, share):
    return tuple(p + share * (q - p) for p, q in zip(a, b))


def skin():
    """Fine cells between furrows, a little blood under them."""
    def pixel(x, y):
        one, two = nearest(x, y, 40, 3)
        furrow = max(0.0, 1.0 - (two - one) / 0.22)
        color = blend((0.86, 0.66, 0.56), (0.80, 0.55, 0.47), layered(x, y, 4, 11))
        return blend(color, (0.66, 0.42, 0.35), 0.42 * furrow)
    return png(pixel)


def ridges():
    """A finger's: lines around it, bent by noise."""
    def pixel(x, y):
        bend = 5.0 * (layered(x, y, 4, 21) - 0.5)
        wave = 0.5 + 0.5 * math.sin(2.0 * math.pi * (28.0 * y / SIDE + bend))
        color = blend((0.87, 0.66, 0.55), (0.81, 0.55, 0.46), layered(x, y, 4, 13))
        return blend(color, (0.70, 0.45, 0.37), 0.45 * wave)
    return png(pixel)


def foam():
    """Pores of many sizes."""
    def pixel(x, y):
        shade = 0.0
        for cells, seed in ((14, 5), (26, 7), (48, 9)):
            one, _ = nearest(x, y, cells, seed)
            shade = max(shade, (1.0 - one / 0.42) * (1.0 if cells < 20 else 0.7))
        color = blend((0.95, 0.86, 0.58), (0.91, 0.79, 0.48), layered(x, y, 6, 17))
        return blend(color, (0.52, 0.40, 0.17), min(1.0, max(0.0, 1.5 * shade)) * 0.75)
    return png(pixel)


def gel():
    """Small bubbles in a clear green."""
    def pixel(x, y):
        color = blend((0.30, 0.72, 0.58), (0.20, 0.60, 0.50), layered(x, y, 4, 41))
        for cells, seed, size in ((9, 43, 0.16), (17, 47, 0.14)):
            one, _ = nearest(x, y, cells, seed)
            if one < size:
                color = blend(color, (0.72, 0.93, 0.84), 0.8 * (1.0 - (one / size) ** 4))
        return color
    return png(pixel)


def lid():
    """Rings about the middle, and a bow with a head that says which way it opens."""
    def pixel(x, y):
        u, v = (x + 0.5) / SIDE - 0.5, (y + 0.5) / SIDE - 0.5
        radius, angle = math.hypot(u, v), math.degrees(math.atan2(v, u))
        color = blend((0.72, 0.14, 0.10), (0.62, 0.10, 0.08), layered(x, y, 8, 31))
        ring = min(abs(radius - r) for r in (0.44, 0.42, 0.2))
        if ring < 0.004:
            color = blend(color, (0.96, 0.90, 0.80), 0.9)
        bow = abs(radius - 0.31) < 0.018 and -150.0 < angle < -35.0
        along = angle + 35.0  # degrees past the end of the bow
        head = 0.0 <= along < 16.0 and abs(radius - 0.31) < 0.055 * (1.0 - along / 16.0)
        if bow or head:
            color = (0.96, 0.90, 0.80)
        return color
    return png(pixel)


def all_textures():
    return {"looks/" + name + ".png": make() for name, make in
            (("skin", skin), ("ridges", ridges), ("foam", foam), ("gel", gel), ("lid", lid))}
