"""The scenes: the three experiments of Luo & Xiao (2007) with the parameters of their Table I, each
also with a body three hundred times softer, and three more."""

from . import motions, shapes
from .gltf_writer import Gltf

RUBBER = {"torsion_youngs_modulus": 3e6, "torsion_poisson_ratio": 0.5, "torsion_density": 1100.0,
          "torsion_static_friction": 0.75, "torsion_dynamic_friction": 0.75}
SOFT = {**RUBBER, "torsion_youngs_modulus": 1e4}
# Holds a quarter more than it has once it slips.
STICKY = {**RUBBER, "torsion_static_friction": 0.9375}

BODY_COLOR = [0.80, 0.42, 0.22, 1.0]
TOOL_COLOR = [0.25, 0.38, 0.55, 1.0]


def start(bin_name, eye, at, field_of_view=0.5):
    gltf = Gltf(bin_name)
    gltf.body_material = gltf.material("rubber", BODY_COLOR)
    gltf.tool_material = gltf.material("steel", TOOL_COLOR)
    gltf.camera("camera", eye, motions.looking(eye, at), field_of_view)
    return gltf


def body(gltf, name, mesh, center, shape, material, **keys):
    gltf.node(name, mesh=gltf.mesh(name, mesh, gltf.body_material), translation=center,
              extras={"torsion_role": "elastic", "torsion_shape": shape, **material, **keys})


def part(gltf, tool, name, mesh, shape, translation, rotation=(0.0, 0.0, 0.0, 1.0)):
    """mesh: a new one, or the row of one that is there."""
    row = mesh if isinstance(mesh, int) else gltf.mesh(name, mesh, gltf.tool_material)
    gltf.node(name, tool, mesh=row, translation=translation, rotation=rotation,
              extras={"torsion_shape": shape})
    return row


def ball_on_cube(name, material, depth, degrees):
    radius = 0.03
    gltf = start("ball_on_cube.bin", (0.2, 0.285, 0.32), (0.0, 0.073, 0.0))
    body(gltf, "cube", shapes.box((0.05, 0.05, 0.05), 34), (0.0, 0.05, 0.0), "box", material)
    top = (0.0, 0.1 + radius, 0.0)
    ball = gltf.node("ball", mesh=gltf.mesh("ball", shapes.grooved_ball(radius, 64),
                                            gltf.tool_material), translation=top,
                     extras={"torsion_role": "tool", "torsion_shape": "sphere",
                             "torsion_mass": 1.0})
    gltf.animation("press and twist", ball,
                   motions.press_and_twist(top, depth, 0.003, motions.to_and_fro(degrees)))
    return gltf.files(name)


def elastic_ellipsoid(gltf, material):
    body(gltf, "ellipsoid", shapes.ellipsoid((0.07, 0.05, 0.06), 36), (0.0, 0.05, 0.0),
         "ellipsoid", material)


def mallet_on_ellipsoid(name, material, depth, degrees):
    gltf = start("mallet_on_ellipsoid.bin", (0.2, 0.29, 0.33), (0.0, 0.083, 0.0))
    elastic_ellipsoid(gltf, material)
    top = (0.0, 0.1, 0.0)
    mallet = gltf.node("mallet", translation=top,
                       extras={"torsion_role": "tool", "torsion_mass": 1.0})
    lying = motions.about((0.0, 0.0, 1.0), 90.0)
    part(gltf, mallet, "head", shapes.capsule(0.015, 0.035, 40), "capsule", (0.0, 0.015, 0.0),
         lying)
    part(gltf, mallet, "handle", shapes.cylinder(0.005, 0.04, 24), "cylinder", (0.0, 0.065, 0.0))
    gltf.animation("press and twist", mallet,
                   motions.press_and_twist(top, depth, 0.003, motions.to_and_fro(degrees)))
    return gltf.files(name)


def compass_on_ellipsoid(name, material, depth, degrees):
    gltf = start("compass_on_ellipsoid.bin", (0.2, 0.3, 0.34), (0.0, 0.1, 0.0))
    elastic_ellipsoid(gltf, material)
    # The tips stand 36 mm apart on the ellipsoid, 8 mm below its top.
    spread = 0.022
    height = 0.05 + 0.05 * (1.0 - (spread / 0.07) ** 2) ** 0.5
    top = (0.0, height, 0.0)
    compass = gltf.node("compass", translation=top,
                        extras={"torsion_role": "tool", "torsion_mass": 1.0})
    for side in (-1.0, 1.0):
        part(gltf, compass, "left leg" if side < 0.0 else "right leg",
             shapes.tapered_leg(0.004, 0.006, 0.085, 32), "mesh", (side * spread, 0.0, 0.0),
             motions.about((0.0, 0.0, 1.0), side * 15.0))
    part(gltf, compass, "hinge", shapes.ellipsoid((0.009, 0.009, 0.009), 12), "sphere",
         (0.0, 0.081, 0.0))
    gltf.animation("press and twist", compass,
                   motions.press_and_twist(top, depth, 0.003, motions.to_and_fro(degrees)))
    return gltf.files(name)


def many_regions(name):
    gltf = start("many_regions.bin", (0.2, 0.26, 0.3), (0.0, 0.04, 0.0), 0.55)
    body(gltf, "slab", shapes.box((0.1, 0.02, 0.06), 34), (0.0, 0.02, 0.0), "box", RUBBER,
         torsion_fixed="bottom_face")
    top = (0.0, 0.04, 0.0)
    table = gltf.node("table", translation=top,
                      extras={"torsion_role": "tool", "torsion_mass": 1.0})
    mesh = shapes.capsule(0.008, 0.015, 32)
    for foot in range(10):
        # Each foot is a tenth of a millimetre shorter than the one before.
        place = ((foot % 5 - 2) * 0.034, 0.015 + 1e-4 * foot, (foot // 5 - 0.5) * 0.05)
        mesh = part(gltf, table, f"foot {foot}", mesh, "capsule", place)
    part(gltf, table, "plate", shapes.box((0.085, 0.004, 0.04)), "box", (0.0, 0.032, 0.0))
    gltf.animation("press and twist", table,
                   motions.press_and_twist(top, 0.0018, 0.002, motions.to_and_fro(4.0)))
    return gltf.files(name)


def two_bodies(name):
    gltf = start("two_bodies.bin", (0.2, 0.24, 0.3), (0.0, 0.05, 0.0), 0.5)
    cube = shapes.box((0.03, 0.03, 0.03), 28)
    body(gltf, "firm cube", cube, (-0.045, 0.03, 0.0), "box", SOFT,
         torsion_youngs_modulus=3e5, torsion_region_threshold=0.02)
    body(gltf, "soft cube", cube, (0.045, 0.03, 0.0), "box", SOFT, torsion_youngs_modulus=3e4,
         torsion_region_threshold=0.02)
    top = (0.0, 0.06, 0.0)
    bar = gltf.node("bar", translation=top, extras={"torsion_role": "tool", "torsion_mass": 1.0})
    part(gltf, bar, "rod", shapes.capsule(0.012, 0.085, 40), "capsule", (0.0, 0.012, 0.0),
         motions.about((0.0, 0.0, 1.0), 90.0))
    part(gltf, bar, "grip", shapes.cylinder(0.006, 0.03, 24), "cylinder", (0.0, 0.05, 0.0))
    gltf.animation("press and twist", bar,
                   motions.press_and_twist(top, 0.004, 0.003, motions.to_and_fro(12.0)))
    return gltf.files(name)


def all_files():
    """File name -> bytes, of every scene that ships."""
    files = {}
    files |= ball_on_cube("ball_on_cube", RUBBER, 0.0015, 40.0)
    files |= ball_on_cube("ball_on_cube_soft", SOFT, 0.010, 60.0)
    files |= ball_on_cube("ball_on_cube_sticky", STICKY, 0.0015, 40.0)
    files |= mallet_on_ellipsoid("mallet_on_ellipsoid", RUBBER, 0.0015, 40.0)
    files |= mallet_on_ellipsoid("mallet_on_ellipsoid_soft", SOFT, 0.010, 60.0)
    files |= compass_on_ellipsoid("compass_on_ellipsoid", RUBBER, 0.0012, 20.0)
    files |= compass_on_ellipsoid("compass_on_ellipsoid_soft", SOFT, 0.008, 40.0)
    files |= many_regions("many_regions")
    files |= two_bodies("two_bodies")
    return files
