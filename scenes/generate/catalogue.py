"""The scenes: the three experiments of Luo & Xiao (2007) with the parameters of their Table I, each
also with a body three hundred times softer, three more, and those of the gallery."""

from . import motions, shapes
from .gltf_writer import Gltf

RUBBER = {"torsion_youngs_modulus": 3e6, "torsion_poisson_ratio": 0.5, "torsion_density": 1100.0,
          "torsion_static_friction": 0.75, "torsion_dynamic_friction": 0.75}
GEL = {**RUBBER, "torsion_youngs_modulus": 2e4, "torsion_static_friction": 0.6,
       "torsion_dynamic_friction": 0.6}
STICKY_GEL = {**GEL, "torsion_static_friction": 1.2, "torsion_dynamic_friction": 1.2}
SOFT = {**RUBBER, "torsion_youngs_modulus": 1e4}
# Holds a quarter more than it has once it slips.
STICKY = {**RUBBER, "torsion_static_friction": 0.9375}

BODY_COLOR = [0.80, 0.42, 0.22, 1.0]
TOOL_COLOR = [0.25, 0.38, 0.55, 0.13]  # glass, so that the contact shows through


def start(bin_name, eye, at, field_of_view=0.5):
    gltf = Gltf(bin_name)
    gltf.body_material = gltf.material("rubber", BODY_COLOR, roughness=0.5)
    gltf.tool_material = gltf.material("glass", TOOL_COLOR, roughness=0.15, glass=True)
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


def ball_on_cube(name, material, depth, degrees, *shown):
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
    if shown:
        gltf.show(*shown)
    return gltf.files(name)


def elastic_ellipsoid(gltf, material):
    body(gltf, "ellipsoid", shapes.ellipsoid((0.07, 0.05, 0.06), 36), (0.0, 0.05, 0.0),
         "ellipsoid", material)


def mallet_on_ellipsoid(name, material, depth, degrees, *shown):
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
    if shown:
        gltf.show(*shown)
    return gltf.files(name)


def compass_on_ellipsoid(name, material, depth, degrees, *shown):
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
    if shown:
        gltf.show(*shown, torsion_torque="parts")
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
    gltf.show("Ten contacts at once", "Ten feet, each a tenth of a millimetre shorter than the one "
              "before: each contact sticks and slips by itself.", torsion_colors="twist",
              torsion_stick_slip=True)
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
    gltf.show("One tool on two bodies", "The soft cube gives way where the firm one holds: the bar "
              "feels both.", torsion_colors="twist")
    return gltf.files(name)


def gallery(name, bin_name, size, material, depth, motion, eye, at, shown):
    """A ball on a soft slab of `size`, on its bottom face."""
    radius = 0.02
    gltf = start(bin_name, eye, at)
    ball = gltf.mesh("ball", shapes.grooved_ball(radius, 64), gltf.tool_material)
    half = tuple(0.5 * side for side in size)
    body(gltf, "slab", shapes.box(half, 12), (0.0, half[1], 0.0), "box", material,
         torsion_fixed="bottom_face")
    top = (0.0, size[1] + radius, 0.0)
    node = gltf.node("ball", mesh=ball, translation=top,
                     extras={"torsion_role": "tool", "torsion_shape": "sphere",
                             "torsion_mass": 0.5})
    gltf.animation("motion", node, motion(top, depth))
    gltf.show(*shown[:2], torsion_colors="twist", torsion_stick_slip=True, **shown[2])
    return gltf.files(name)


def twist_and_slip():
    def motion(top, depth):
        return motions.pressed(top, depth, 0.002, [(0.0, 0.0)],
                               [(0.0, 0.0), (1.0, 0.0), (3.0, 75.0), (3.4, 75.0)], 4.0)
    return gallery("gallery/1_twist_and_slip", "ball_on_block.bin", (0.08, 0.05, 0.08), STICKY_GEL, 0.007, motion,
                   (0.1, 0.125, 0.13), (0.0, 0.056, 0.0),
                   ("Twist and slip ring",
                    "The ball turns and the gel turns with it. Slip (yellow) begins at the rim and grows inwards; "
                    "the torque bends until all slips.", {"torsion_speed": 0.2}))


def hysteresis():
    def motion(top, depth):
        turns = [(0.0, 0.0), (1.0, 0.0)]
        for half in range(7):
            turns.append((2.0 + half, 25.0 if half % 2 == 0 else -25.0))
        return motions.pressed(top, depth, 0.002, [(0.0, 0.0)], turns + [(9.0, 0.0)], 10.0)
    return gallery("gallery/2_hysteresis", "ball_on_block.bin", (0.08, 0.05, 0.08), GEL, 0.005, motion,
                   (0.1, 0.125, 0.13), (0.0, 0.056, 0.0),
                   ("Torque with a memory", "To and fro: the torque by the turn (plot on the left) "
                    "does not go back as it came, but round a loop. Its area is the work of friction.", {}))


def spin_and_slide():
    def motion(top, depth):
        x, y, z = top
        path = motions.at_even_speed((1.0, 0.0), (5.0, 0.06))
        turns = [(0.0, 0.0), (2.6, 0.0)] + motions.at_even_speed((2.6, 0.0), (5.0, 1440.0))
        return motions.pressed((x - 0.03, y, z), depth, 0.002, path, turns, 5.6)
    return gallery("gallery/3_spin_and_slide", "ball_on_slab.bin", (0.14, 0.03, 0.06), GEL, 0.002, motion,
                   (0.09, 0.13, 0.19), (0.0, 0.035, 0.0),
                   ("Spinning makes sliding easy", "The ball slides, then spins as well: the force along its way "
                    "falls, for friction has one direction at each point.", {"torsion_speed": 0.2}))


def paper_and_truth():
    """The same ball on the same gel twice: by the paper's equations and by a contact that slips from its rim."""
    radius = 0.02
    gltf = start("two_balls.bin", (0.0, 0.15, 0.24), (0.0, 0.05, 0.0))
    half = (0.032, 0.02, 0.032)
    slab = gltf.mesh("slab", shapes.box(half, 10), gltf.body_material)
    ball = gltf.mesh("ball", shapes.grooved_ball(radius, 48), gltf.tool_material)
    turns = [(0.0, 0.0), (1.0, 0.0), (2.5, 40.0), (4.5, -40.0), (6.5, 40.0), (7.0, 40.0)]
    for model, x in (("paper", -0.042), ("mdr", 0.042)):
        gltf.node(model + " gel", mesh=slab, translation=(x, half[1], 0.0),
                  extras={"torsion_role": "elastic", "torsion_shape": "box", **GEL,
                          "torsion_fixed": "bottom_face", "torsion_contact_model": model})
        top = (x, 2.0 * half[1] + radius, 0.0)
        node = gltf.node(model + " ball", mesh=ball, translation=top,
                         extras={"torsion_role": "tool", "torsion_shape": "sphere",
                                 "torsion_mass": 0.5})
        gltf.animation(model + " motion", node,
                       motions.pressed(top, 0.005, 0.002, [(0.0, 0.0)], turns, 8.0))
    gltf.show("The paper beside the truth", "Left by the paper's equations, right by mdr, a few per cent from the exact "
              "solution. The paper's contact sticks as a whole: its torque is a straight line. In truth it slips from "
              "its rim inwards, and the torque goes round a loop.",
              torsion_colors="twist", torsion_stick_slip=True, torsion_speed=0.2)
    return gltf.files("gallery/4_paper_and_truth")


def all_files():
    """File name -> bytes, of every scene that ships."""
    files = {}
    files |= twist_and_slip()
    files |= hysteresis()
    files |= spin_and_slide()
    files |= paper_and_truth()
    files |= ball_on_cube("ball_on_cube", RUBBER, 0.0015, 40.0, "Paper: ball on a cube",
                          "Luo and Xiao (2007), Table I: rubber of 3 MPa. Take the ball with the "
                          "mouse and press.")
    files |= ball_on_cube("ball_on_cube_soft", SOFT, 0.010, 60.0)
    files |= ball_on_cube("ball_on_cube_sticky", STICKY, 0.0015, 40.0)
    files |= mallet_on_ellipsoid("mallet_on_ellipsoid", RUBBER, 0.0015, 40.0)
    files |= mallet_on_ellipsoid("mallet_on_ellipsoid_soft", SOFT, 0.010, 60.0,
                               "Paper: mallet on a soft body",
                               "A lying cylinder: its contact is long, and turns with the tool.")
    files |= compass_on_ellipsoid("compass_on_ellipsoid", RUBBER, 0.0012, 20.0)
    files |= compass_on_ellipsoid("compass_on_ellipsoid_soft", SOFT, 0.008, 40.0,
                                "Two tips: arm and couple",
                                "The tips' friction forces make a torque by their arms (r x F); "
                                "each contact adds its couple. Orange: r x F. Violet: the couples.")
    files |= many_regions("many_regions")
    files |= two_bodies("two_bodies")
    return files
