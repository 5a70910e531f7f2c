"""Triangle meshes as lists: positions and normals (x, y, z), triangles (a, b, c), in metres."""

import math


class Mesh:
    def __init__(self):
        self.positions = []
        self.normals = []
        self.triangles = []
        self.texcoords = []  # as many as positions, or none

    def add(self, position, normal):
        self.positions.append(position)
        self.normals.append(normal)
        return len(self.positions) - 1


    def painted(self, uv):
        """With uv(position, normal) at each vertex."""
        self.texcoords = [uv(*both) for both in zip(self.positions, self.normals)]
        return self

    def moved(self, x, y, z):
        self.positions = [(a + x, b + y, c + z) for a, b, c in self.positions]
        return self


def normalized(v):
    length = math.sqrt(sum(c * c for c in v))
    return tuple(c / length for c in v)


def graded(share, grading):
    """From -1 to 1 with steps that grow outwards; grading 1 is even."""
    return math.copysign(abs(share) ** grading, share)


def cube_faces(count, grading=1.0):
    """The surface of the cube of side 2, a face at a time: (axis sign, grid of points)."""
    steps = [graded(2.0 * i / count - 1.0, grading) for i in range(count + 1)]
    for axis in range(3):
        for sign in (-1.0, 1.0):
            grid = []
            for u in steps:
                row = []
                for v in steps:
                    point = [0.0, 0.0, 0.0]
                    point[axis] = sign
                    point[(axis + 1) % 3] = u
                    point[(axis + 2) % 3] = v
                    row.append(tuple(point))
                grid.append(row)
            yield axis, sign, grid


def bent_cube(count, grading, place, normal_of):
    """A cube's faces with every point put at place(point); normal_of(point, axis, sign)."""
    mesh = Mesh()
    for axis, sign, grid in cube_faces(count, grading):
        rows = [[mesh.add(place(p), normal_of(p, axis, sign)) for p in row] for row in grid]
        for i in range(count):
            for j in range(count):
                a, b, c, d = rows[i][j], rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]
                if sign > 0.0:
                    mesh.triangles += [(a, b, c), (a, c, d)]
                else:
                    mesh.triangles += [(a, c, b), (a, d, c)]
    return mesh


def box(half, count=1, grading=1.0):
    def face_normal(_, axis, sign):
        return tuple(sign if i == axis else 0.0 for i in range(3))

    return bent_cube(count, grading, lambda p: tuple(h * c for h, c in zip(half, p)), face_normal)


def on_sphere(point):
    """Spreads the cube's points more evenly over the sphere than normalising them does."""
    return normalized(tuple(math.tan(c * math.pi / 4.0) for c in point))


def ellipsoid(half, count):
    def place(p):
        return tuple(h * c for h, c in zip(half, on_sphere(p)))

    def normal(p, _axis, _sign):
        return normalized(tuple(c / h for h, c in zip(half, on_sphere(p))))

    return bent_cube(count, 1.0, place, normal)


def revolved(profile, count):
    """A closed solid of revolution about y. profile: (radius, y, normal radius, normal y) from the
    bottom of the axis to its top; the first and last radius are 0."""
    mesh = Mesh()
    rings = []
    for radius, y, normal_radius, normal_y in profile:
        ring = []
        for k in range(count + 1):
            angle = 2.0 * math.pi * (k % count) / count
            c, s = math.cos(angle), math.sin(angle)
            ring.append(mesh.add((radius * c, y, -radius * s),
                                 normalized((normal_radius * c, normal_y, -normal_radius * s))))
        rings.append(ring)
    for (low, high, (r0, y0, *_), (r1, y1, *_)) in zip(rings, rings[1:], profile, profile[1:]):
        if (r0, y0) == (r1, y1):
            continue  # a crease: same place, another normal
        for k in range(count):
            a, b, c, d = low[k], low[k + 1], high[k + 1], high[k]
            if r0 > 0.0:
                mesh.triangles.append((a, b, d) if r1 == 0.0 else (a, b, c))
            if r1 > 0.0:
                mesh.triangles.append((a, c, d))
    return mesh


def arc(center_y, radius, start, end, count):
    """Points of a profile on a circle about the axis, by latitude in degrees."""
    points = []
    for i in range(count + 1):
        latitude = math.radians(start + (end - start) * i / count)
        c, s = math.cos(latitude), math.sin(latitude)
        c = 0.0 if abs(latitude) >= math.pi / 2.0 - 1e-9 else c
        points.append((radius * c, center_y + radius * s, c, s if c > 0.0 else math.copysign(1, s)))
    return points


def capsule(radius, half_height, count):
    middle = half_height - radius
    profile = arc(-middle, radius, -90.0, 0.0, count // 4) + arc(middle, radius, 0.0, 90.0,
                                                                  count // 4)
    return revolved(profile, count)


def cylinder(radius, half_height, count):
    return revolved([(0.0, -half_height, 0.0, -1.0), (radius, -half_height, 0.0, -1.0),
                     (radius, -half_height, 1.0, 0.0), (radius, half_height, 1.0, 0.0),
                     (radius, half_height, 0.0, 1.0), (0.0, half_height, 0.0, 1.0)], count)


def tapered_leg(tip_radius, top_radius, length, count):
    """A leg that stands on a round tip at y = 0 and grows thicker up to its round top."""
    slope = math.degrees(math.asin((top_radius - tip_radius) / (length - tip_radius - top_radius)))
    profile = arc(tip_radius, tip_radius, -90.0, -slope, 8) + arc(
        length - top_radius, top_radius, -slope, 90.0, 8)
    return revolved(profile, count)


def grooved_ball(radius, count):
    """A ball whose meridians are cut by shallow grooves, so that one sees it turn. It keeps the
    full radius along the axes, as an exact sphere fitted to its bounds needs."""
    mesh = Mesh()
    rings = []
    rows = count // 2
    for i in range(rows + 1):
        latitude = math.pi * (i / rows - 0.5)
        c, s = (0.0, math.copysign(1.0, latitude)) if i in (0, rows) else (math.cos(latitude),
                                                                          math.sin(latitude))
        ring = []
        for k in range(count + 1):
            angle = 2.0 * math.pi * (k % count) / count
            groove = 0.04 * max(0.0, -math.cos(4.0 * angle)) ** 24 * c
            direction = (c * math.cos(angle), s, -c * math.sin(angle))
            ring.append(mesh.add(tuple(radius * (1.0 - groove) * d for d in direction), direction))
        rings.append(ring)
    for i, (low, high) in enumerate(zip(rings, rings[1:])):
        for k in range(count):
            a, b, c, d = low[k], low[k + 1], high[k + 1], high[k]
            if i == 0:
                mesh.triangles.append((a, c, d))
            elif i == rows - 1:
                mesh.triangles.append((a, b, d))
            else:
                mesh.triangles += [(a, b, c), (a, c, d)]
    return mesh
