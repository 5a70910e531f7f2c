"""Keys of a tool's motion, and turns as quaternions (x, y, z, w)."""

import math

RATE = 30  # rotation keys a second


def about_y(degrees):
    half = math.radians(degrees) / 2.0
    return (0.0, math.sin(half), 0.0, math.cos(half))


def about(axis, degrees):
    half = math.radians(degrees) / 2.0
    return tuple(c * math.sin(half) for c in axis) + (math.cos(half),)


def looking(eye, at):
    """The rotation of a camera at `eye` that looks at `at` with +y up."""
    def unit(v):
        length = math.sqrt(sum(c * c for c in v))
        return tuple(c / length for c in v)

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    z = unit(tuple(e - a for e, a in zip(eye, at)))
    x = unit(cross((0.0, 1.0, 0.0), z))
    y = cross(z, x)
    m = (x, y, z)  # columns
    w = math.sqrt(max(0.0, 1.0 + m[0][0] + m[1][1] + m[2][2])) / 2.0
    return ((m[1][2] - m[2][1]) / (4.0 * w), (m[2][0] - m[0][2]) / (4.0 * w),
            (m[0][1] - m[1][0]) / (4.0 * w), w)


def eased(keys, time):
    """Between the keys (time, value) with rest at each."""
    for (t0, v0), (t1, v1) in zip(keys, keys[1:]):
        if time <= t1:
            s = max(0.0, (time - t0) / (t1 - t0))
            return v0 + (v1 - v0) * s * s * (3.0 - 2.0 * s)
    return keys[-1][1]


def press_and_twist(start, depth, clearance, turns):
    """Down from `clearance` above `start` to `depth` below it, turned as `turns` (time, degrees)
    says, clockwise seen from above being negative; then up again. Four seconds."""
    x, y, z = start
    heights = [(0.0, y + clearance), (0.8, y - depth), (3.4, y - depth), (3.9, y + clearance)]
    values = []
    for _, height in heights:
        values += [(0.0, 0.0, 0.0), (x, height, z), (0.0, 0.0, 0.0)]
    times = [i / RATE for i in range(4 * RATE + 1)]
    return {"translation": ("CUBICSPLINE", [t for t, _ in heights], values),
            "rotation": ("LINEAR", times, [about_y(eased(turns, t)) for t in times])}


def to_and_fro(degrees):
    """Clockwise, then counter-clockwise, then back."""
    return [(0.0, 0.0), (0.9, 0.0), (1.6, -degrees), (2.0, -degrees), (3.0, degrees),
            (3.3, degrees), (4.0, degrees)]


def pressed(start, depth, clearance, path, turns, seconds):
    """Down from `clearance` above `start` to `depth` below it within 0.8 s; there along x as `path`
    (time, m) says and turned as `turns` (time, degrees) says; up again in the last half second."""
    x, y, z = start
    heights = [(0.0, y + clearance), (0.8, y - depth), (seconds - 0.6, y - depth),
               (seconds - 0.1, y + clearance)]
    times = [i / RATE for i in range(round(seconds * RATE) + 1)]
    places = [(x + eased(path, t), eased(heights, t), z) for t in times]
    return {"translation": ("LINEAR", times, places),
            "rotation": ("LINEAR", times, [about_y(eased(turns, t)) for t in times])}


def at_even_speed(first, last):
    """From one key (time, value) to another, without easing: so many keys that none matters."""
    (t0, v0), (t1, v1) = first, last
    steps = round((t1 - t0) * RATE)
    return [(t0 + (t1 - t0) * i / steps, v0 + (v1 - v0) * i / steps) for i in range(steps + 1)]
