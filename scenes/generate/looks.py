"""Five scenes that look like what they are: things of daily use on rubber, gel, skin and foam."""

import math

from . import motions, shapes
from .gltf_writer import Gltf

GEL = {"torsion_youngs_modulus": 2e4, "torsion_poisson_ratio": 0.49, "torsion_density": 1000.0,
       "torsion_dynamic_friction": 0.6}
RUBBER = {"torsion_youngs_modulus": 4e5, "torsion_poisson_ratio": 0.49, "torsion_density": 1100.0,
          "torsion_dynamic_friction": 0.8}
SKIN = {"torsion_youngs_modulus": 4e4, "torsion_poisson_ratio": 0.48, "torsion_density": 1050.0,
        "torsion_dynamic_friction": 0.5}
FOAM = {"torsion_youngs_modulus": 8e4, "torsion_poisson_ratio": 0.2, "torsion_density": 80.0,
        "torsion_dynamic_friction": 0.4}
STEEL = [0.62, 0.62, 0.64, 1.0]


def start(name, eye, at, field_of_view=0.5):
    gltf = Gltf(name + ".bin")
    gltf.camera("camera", eye, motions.looking(eye, at), field_of_view)
    return gltf


def from_above(size):
    """Texture coordinates straight down on a square of `size`."""
    return lambda p, _: (p[0] / size + 0.5, p[2] / size + 0.5)


def by_faces(size):
    """Texture coordinates along the two axes of the face that a normal is of."""
    def uv(p, n):
        axis = max(range(3), key=lambda i: abs(n[i]))
        return (p[(axis + 1) % 3] / size, p[(axis + 2) % 3] / size)
    return uv


def around(girth, length):
    """Texture coordinates around the y axis and along it."""
    return lambda p, _: (math.atan2(p[2], p[0]) / (2.0 * math.pi) * girth, p[1] / length)


def rounded(radius, low, high, edge, count):
    """A solid of revolution about y, its edges rounded."""
    def corner(y, first):
        return [(radius - edge + c, y + s, c, s) for c, s in
                ((edge * math.cos(a), edge * math.sin(a)) for a in
                 (math.radians(first + 15.0 * i) for i in range(7)))]
    profile = ([(0.0, low, 0.0, -1.0), (radius - edge, low, 0.0, -1.0)] + corner(low + edge, -90.0)
               + corner(high - edge, 0.0) + [(0.0, high, 0.0, 1.0)])
    return shapes.revolved(profile, count)


def fluted(mesh, flutes, depth):
    """Grooves along y: every vertex drawn toward the axis, by the cosine of its angle."""
    for i, (x, y, z) in enumerate(mesh.positions):
        radius = math.hypot(x, z)
        if radius > 0.0:
            groove = depth * (0.5 - 0.5 * math.cos(flutes * math.atan2(z, x)))
            share = 1.0 - groove / radius * min(1.0, radius / depth / 4.0)
            mesh.positions[i] = (x * share, y, z * share)
    angle_step = 1e-3
    for i, (x, y, z) in enumerate(mesh.positions):
        n = mesh.normals[i]
        radius = math.hypot(x, z)
        if radius <= 0.0 or abs(n[1]) > 0.9:
            continue
        angle = math.atan2(z, x)
        slope = depth * 0.5 * flutes * math.sin(flutes * angle) / radius
        c, s = x / radius, z / radius
        mesh.normals[i] = shapes.normalized((n[0] - slope * s, n[1], n[2] + slope * c))
    return mesh


def spiral_bit(radius, low, high, turns):
    """A twist drill: a round with two lips cut in, turned as it goes up; pointed below."""
    mesh = shapes.Mesh()
    around_count, up_count = 64, 96
    rings = []

    def outline(angle):
        cut = max(0.0, math.cos(2.0 * angle)) ** 0.6
        return radius * (1.0 - 0.45 * cut)

    def place(k, j):
        share = j / up_count
        y = low + share * (high - low)
        angle = 2.0 * math.pi * (k % around_count) / around_count
        turned = angle + 2.0 * math.pi * turns * share
        point = min(1.0, (y - low) / (0.6 * radius) + 0.02)
        r = outline(angle) * point
        return (r * math.cos(turned), y, -r * math.sin(turned))

    def normal(k, j):
        a, b = place(k + 1, j), place(k + around_count - 1, j)
        c, d = place(k, min(j + 1, up_count)), place(k, max(j - 1, 0))
        u = tuple(p - q for p, q in zip(a, b))
        v = tuple(p - q for p, q in zip(c, d))
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        return shapes.normalized(n)

    for j in range(up_count + 1):
        rings.append([mesh.add(place(k, j), normal(k, j)) for k in range(around_count + 1)])
    for low_ring, high_ring in zip(rings, rings[1:]):
        for k in range(around_count):
            a, b, c, d = low_ring[k], low_ring[k + 1], high_ring[k + 1], high_ring[k]
            mesh.triangles += [(a, b, c), (a, c, d)]
    return mesh


def body(gltf, name, mesh, material, shape, center, keys, **more):
    return gltf.node(name, mesh=gltf.mesh(name, mesh, material), translation=center,
                     extras={"torsion_role": "elastic", "torsion_shape": shape, "torsion_draw": "mesh",
                             **keys, **more})


def tool(gltf, top, motion, mass=0.2):
    row = gltf.node("tool", translation=top, extras={"torsion_role": "tool", "torsion_mass": mass})
    gltf.animation("motion", row, motion)
    return row


def part(gltf, parent, name, mesh, material, shape, place, rotation=(0.0, 0.0, 0.0, 1.0)):
    gltf.node(name, parent, mesh=gltf.mesh(name, mesh, material), translation=place, rotation=rotation,
              extras={"torsion_shape": shape, "torsion_draw": "mesh"})


def finger_on_lid():
    gltf = start("finger_on_lid", (0.06, 0.135, 0.175), (0.01, 0.04, 0.0), 0.5)
    glaze = gltf.material("glazed clay", [0.80, 0.78, 0.72, 1.0], roughness=0.18)
    paint = gltf.material("painted rubber", [1.0, 1.0, 1.0, 1.0], roughness=0.45, texture="lid.png")
    rim = gltf.material("rubber", [0.45, 0.05, 0.04, 1.0], roughness=0.7)
    skin = gltf.material("skin", [1.0, 1.0, 1.0, 1.0], roughness=0.5, scattering=0.5, texture="ridges.png")
    nail = gltf.material("nail", [0.93, 0.70, 0.62, 1.0], roughness=0.2, scattering=0.3)
    radius, height = 0.034, 0.012
    top = rounded(radius, -0.5 * height, 0.5 * height, 0.002, 96).painted(from_above(2.0 * radius))
    edge = fluted(rounded(radius, -0.5 * height, 0.3 * height, 0.001, 288), 48, 0.0016)
    jar = gltf.node("jar", translation=(0.0, 0.045, 0.0),
                    extras={"torsion_role": "elastic", **RUBBER})
    gltf.node("lid", jar, mesh=gltf.mesh("lid", [lid_top(top), edge], [paint, rim]),
              extras={"torsion_shape": "cylinder", "torsion_draw": "mesh"})
    gltf.node("pot", jar, mesh=gltf.mesh("pot", rounded(0.031, -0.0225, 0.0225, 0.006, 72), glaze),
              translation=(0.0, -0.0225, 0.0), extras={"torsion_shape": "cylinder", "torsion_draw": "mesh"})
    gltf.node("held", jar, translation=(0.0, -0.0255, 0.0), scale=(0.04, 0.0205, 0.04),
              extras={"torsion_role": "fixed_box"})
    turns = [(0.0, 0.0), (1.2, 0.0), (3.0, 70.0), (3.6, 70.0), (4.6, 70.0)]
    times = [i / motions.RATE for i in range(round(4.6 * motions.RATE) + 1)]
    gltf.animation("opens", jar, {"rotation": ("LINEAR", times, [
        motions.about_y(motions.eased(turns, t)) for t in times])})
    place = (0.012, 0.045 + 0.5 * height, 0.006)
    finger = tool(gltf, place, motions.pressed(place, 0.0014, 0.002, [(0.0, 0.0)], [(0.0, 0.0)], 4.6))
    along = shapes.normalized((0.72, 0.50, 0.30))
    back = shapes.normalized(tuple(u - along[1] * d for u, d in zip((0.0, 1.0, 0.0), along)))
    lean = standing(along, back)
    tip, length = 0.008, 0.046
    middle = [c * (0.5 * length - tip) for c in along]
    middle[1] += tip
    part(gltf, finger, "finger", shapes.capsule(tip, 0.5 * length, 64).painted(around(1.0, 0.03)), skin,
         "capsule", middle, lean)
    at = [m - (0.5 * length - 0.0105) * d + 0.0064 * b for m, d, b in zip(middle, along, back)]
    part(gltf, finger, "nail", shapes.ellipsoid((0.0050, 0.0068, 0.0022), 16), nail, "ellipsoid", at, lean)
    onward = shapes.normalized((0.80, 0.12, 0.42))
    side = shapes.normalized(tuple(u - onward[1] * d for u, d in zip((0.0, 1.0, 0.0), onward)))
    joint = [m + (0.5 * length - tip) * d for m, d in zip(middle, along)]
    part(gltf, finger, "next bone", shapes.capsule(0.0086, 0.026, 64).painted(around(1.0, 0.03)), skin,
         "capsule", [j + 0.0175 * d for j, d in zip(joint, onward)], standing(onward, side))
    gltf.show("A finger on a jar's lid", "The jar turns under the finger: the lid's rubber goes along with the "
              "finger until it slips. The body moves by its own animation.", torsion_speed=0.5, torsion_lines=False)
    return gltf.files("looks/finger_on_lid")


def lid_top(mesh):
    """The part of the lid that faces up: the rim is another mesh."""
    keep = [all(mesh.positions[i][1] > 0.0017 for i in t) for t in mesh.triangles]
    mesh.triangles = [t for t, kept in zip(mesh.triangles, keep) if kept]
    return mesh


def standing(y, z):
    """The rotation whose y and z axes are these, at right angles to each other."""
    x = (y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0])
    w = math.sqrt(max(1e-12, 1.0 + x[0] + y[1] + z[2])) / 2.0
    return ((y[2] - z[1]) / (4.0 * w), (z[0] - x[2]) / (4.0 * w), (x[1] - y[0]) / (4.0 * w), w)


def screwdriver_on_gel():
    gltf = start("screwdriver_on_gel", (0.12, 0.15, 0.22), (0.0, 0.062, 0.0), 0.62)
    gel = gltf.material("gel", [1.0, 1.0, 1.0, 1.0], roughness=0.12, scattering=0.7, texture="gel.png")
    steel = gltf.material("steel", STEEL, metal=1.0, roughness=0.28)
    plastic = gltf.material("plastic", [0.85, 0.30, 0.03, 1.0], roughness=0.3, scattering=0.3)
    black = gltf.material("rubber", [0.03, 0.03, 0.035, 1.0], roughness=0.65)
    body(gltf, "gel", shapes.box((0.03, 0.015, 0.03), 16).painted(by_faces(0.03)), gel, "box", (0.0, 0.015, 0.0), GEL,
         torsion_fixed="bottom_face", torsion_tolerance=0.08)
    top = (0.0, 0.03, 0.0)
    turns = [(0.0, 0.0), (1.0, 0.0), (2.8, 60.0), (3.4, 60.0), (4.0, 60.0)]
    driver = tool(gltf, top, motions.pressed(top, 0.002, 0.002, [(0.0, 0.0)], turns, 4.2))
    part(gltf, driver, "blade", shapes.box((0.004, 0.009, 0.0008)), steel, "box", (0.0, 0.009, 0.0))
    part(gltf, driver, "shaft", rounded(0.003, -0.022, 0.022, 0.0012, 48), steel, "cylinder", (0.0, 0.036, 0.0))
    part(gltf, driver, "collar", rounded(0.0065, -0.004, 0.004, 0.0015, 48), black, "cylinder", (0.0, 0.06, 0.0))
    grip = fluted(shapes.revolved(shapes.arc(-0.02, 0.013, -90.0, 0.0, 16) + shapes.arc(0.02, 0.013, 0.0, 90.0, 16),
                                  144), 8, 0.0022)
    part(gltf, driver, "handle", grip, plastic, "capsule", (0.0, 0.096, 0.0))
    gltf.show("A screwdriver on gel", "A long contact that turns against the gel: the gel is wound up by the blade's "
              "ends.", torsion_speed=0.5, torsion_lines=False)
    return gltf.files("looks/screwdriver_on_gel")


def stethoscope_on_belly():
    gltf = start("stethoscope_on_belly", (0.085, 0.165, 0.16), (0.0, 0.066, 0.0), 0.5)
    skin = gltf.material("skin", [1.0, 1.0, 1.0, 1.0], roughness=0.55, scattering=0.6, texture="skin.png")
    chrome = gltf.material("chrome", [0.75, 0.75, 0.77, 1.0], metal=1.0, roughness=0.15)
    black = gltf.material("rubber", [0.035, 0.035, 0.04, 1.0], roughness=0.6)
    belly = body(gltf, "belly", shapes.ellipsoid((0.08, 0.04, 0.07), 40).painted(from_above(0.05)), skin,
                 "ellipsoid", (0.0, 0.04, 0.0), SKIN)
    gltf.node("held", belly, translation=(0.0, -0.032, 0.0), scale=(0.08, 0.008, 0.07),
              extras={"torsion_role": "fixed_box"})
    times = [i / motions.RATE for i in range(round(6.0 * motions.RATE) + 1)]
    gltf.animation("breathes", belly, {"translation": ("LINEAR", times, [
        (0.0, 0.04 + 0.0008 * (1.0 - math.cos(2.0 * math.pi * t / 2.0)), 0.0) for t in times])})
    top = (0.0, 0.08, 0.0)
    turns = [(0.0, 0.0), (1.0, 0.0), (2.4, 30.0), (3.8, -30.0), (5.0, 0.0)]
    disc = tool(gltf, top, motions.pressed(top, 0.003, 0.003, [(0.0, 0.0)], turns, 6.0))
    part(gltf, disc, "rim", rounded(0.018, -0.002, 0.002, 0.0006, 96), black, "cylinder", (0.0, 0.002, 0.0))
    part(gltf, disc, "bell", rounded(0.0165, -0.002, 0.002, 0.0018, 96), chrome, "cylinder", (0.0, 0.0055, 0.0))
    part(gltf, disc, "stem", rounded(0.006, -0.008, 0.008, 0.003, 48), chrome, "cylinder", (0.0, 0.0145, 0.0))
    part(gltf, disc, "tube", shapes.capsule(0.0042, 0.026, 32), black, "capsule", (0.022, 0.0185, 0.0),
         motions.about((0.0, 0.0, 1.0), 90.0))
    gltf.show("A stethoscope on a belly", "The belly breathes under the disc while a hand turns it to and fro.",
              torsion_lines=False)
    return gltf.files("looks/stethoscope_on_belly")


def knob_on_mat():
    gltf = start("knob_on_mat", (0.1, 0.11, 0.13), (0.0, 0.018, 0.0), 0.5)
    mat = gltf.material("silicone", [0.08, 0.16, 0.30, 1.0], roughness=0.5, scattering=0.25)
    metal = gltf.material("brushed aluminium", [0.78, 0.79, 0.80, 1.0], metal=1.0, roughness=0.35)
    black = gltf.material("rubber", [0.03, 0.03, 0.03, 1.0], roughness=0.7)
    white = gltf.material("paint", [0.9, 0.9, 0.88, 1.0], roughness=0.4)
    body(gltf, "mat", shapes.box((0.04, 0.007, 0.04), 20), mat, "box", (0.0, 0.007, 0.0),
         {**RUBBER, "torsion_youngs_modulus": 2e5}, torsion_fixed="bottom_face")
    top = (0.0, 0.014, 0.0)
    turns = [(0.0, 0.0), (1.0, 0.0), (2.0, 40.0), (3.2, -40.0), (4.2, 0.0)]
    knob = tool(gltf, top, motions.pressed(top, 0.0012, 0.002, [(0.0, 0.0)], turns, 5.0))
    foot = shapes.capsule(0.0035, 0.0035001, 32)
    for i in range(3):
        angle = 2.0 * math.pi * i / 3.0
        part(gltf, knob, f"foot {i}", foot, black, "sphere",
             (0.013 * math.cos(angle), 0.0035, 0.013 * math.sin(angle)))
    part(gltf, knob, "skirt", rounded(0.02, -0.002, 0.002, 0.001, 96), metal, "cylinder", (0.0, 0.008, 0.0))
    part(gltf, knob, "grip", fluted(rounded(0.0155, -0.008, 0.008, 0.0012, 240), 40, 0.0008), metal, "cylinder",
         (0.0, 0.017, 0.0))
    part(gltf, knob, "pointer", shapes.box((0.006, 0.0006, 0.0009)), white, "box", (0.008, 0.0252, 0.0))
    gltf.show("A knob on three feet", "Each foot sticks and slips by itself; most of the torque is their forces' "
              "arms, the rest their couples.", torsion_torque="parts", torsion_lines=False)
    return gltf.files("looks/knob_on_mat")


def drill_on_foam():
    gltf = start("drill_on_foam", (0.10, 0.115, 0.16), (0.0, 0.046, 0.0), 0.62)
    foam = gltf.material("foam", [1.0, 1.0, 1.0, 1.0], roughness=0.95, texture="foam.png")
    steel = gltf.material("steel", STEEL, metal=1.0, roughness=0.22)
    dark = gltf.material("chuck", [0.10, 0.10, 0.11, 1.0], metal=1.0, roughness=0.4)
    yellow = gltf.material("case", [0.80, 0.52, 0.02, 1.0], roughness=0.45)
    body(gltf, "foam", shapes.box((0.025, 0.015, 0.025), 16).painted(by_faces(0.03)), foam, "box",
         (0.0, 0.015, 0.0), FOAM, torsion_fixed="bottom_face")
    top = (0.0, 0.03, 0.0)
    turns = ([(0.0, 0.0), (1.0, 0.0)] + motions.at_even_speed((1.0, 0.0), (3.2, 720.0)) + [(4.0, 720.0)])
    drill = tool(gltf, top, motions.pressed(top, 0.0012, 0.002, [(0.0, 0.0)], turns, 4.0))
    part(gltf, drill, "tip", shapes.ellipsoid((0.003, 0.003, 0.003), 16), steel, "sphere", (0.0, 0.003, 0.0))
    part(gltf, drill, "bit", spiral_bit(0.003, -0.021, 0.021, 2.6), steel, "cylinder", (0.0, 0.024, 0.0))
    chuck = fluted(shapes.revolved(
        [(0.0, -0.012, 0.0, -1.0), (0.005, -0.012, 0.0, -1.0), (0.005, -0.012, 0.8, -0.6),
         (0.012, 0.0, 0.8, -0.6), (0.012, 0.0, 1.0, 0.0), (0.012, 0.012, 1.0, 0.0), (0.012, 0.012, 0.0, 1.0),
         (0.0, 0.012, 0.0, 1.0)], 144), 12, 0.001)
    part(gltf, drill, "chuck", chuck, dark, "cylinder", (0.0, 0.056, 0.0))
    part(gltf, drill, "case", rounded(0.016, -0.012, 0.012, 0.004, 72), yellow, "cylinder", (0.0, 0.08, 0.0))
    gltf.show("A drill on foam", "A small round tip that turns on and on: all of the contact slips, and the couple "
              "stays what it is.", torsion_speed=0.5, torsion_lines=False)
    return gltf.files("looks/drill_on_foam")


def looks():
    """File name -> bytes."""
    files = {}
    for scene in (finger_on_lid, screwdriver_on_gel, stethoscope_on_belly, knob_on_mat, drill_on_foam):
        files |= scene()
    return files
