"""Scenes for `torsion new` to begin from: of shapes without meshes, each key with a word on it."""

from . import motions
from .gltf_writer import Gltf

GEL = {"torsion_youngs_modulus": 2e4, "torsion_poisson_ratio": 0.49, "torsion_density": 1000.0,
       "torsion_dynamic_friction": 0.6}
RUBBER = {"torsion_youngs_modulus": 1e6, "torsion_poisson_ratio": 0.49, "torsion_density": 1100.0,
          "torsion_dynamic_friction": 0.8}
SKIN = {"torsion_youngs_modulus": 5e4, "torsion_poisson_ratio": 0.48, "torsion_density": 1050.0,
        "torsion_dynamic_friction": 0.5}
FOAM = {"torsion_youngs_modulus": 8e4, "torsion_poisson_ratio": 0.2, "torsion_density": 80.0,
        "torsion_dynamic_friction": 0.4}
ABOUT_BODY = ("What is pressed. torsion_youngs_modulus in Pa, torsion_size its full extents in m; torsion_fixed says "
              "what holds it. All keys: docs/scenes.md.")
ABOUT_TOOL = ("What presses: rigid, moved by the animation below, or with torsion_device mouse or usb by a hand. Its "
              "children are its parts.")


def template(name, title, caption, body, parts, depth, turns, seconds=4.0):
    """body: (name, shape, size, material); parts: (name, shape, size, place above the tip, rotation)."""
    gltf = Gltf(None)
    body_name, shape, size, material = body
    flat = shape == "box"
    row = gltf.node(body_name, translation=(0.0, 0.5 * size[1], 0.0),
                    extras={"comment": ABOUT_BODY, "torsion_role": "elastic", "torsion_shape": shape,
                            "torsion_size": size, **material, **({"torsion_fixed": "bottom_face"} if flat else {})})
    if not flat:
        gltf.node("held", row, translation=(0.0, -0.4 * size[1], 0.0), scale=(size[0], 0.2 * size[1], size[2]),
                  extras={"comment": "What of the body lies in this box, from -1 to 1 along its axes, is held.",
                          "torsion_role": "fixed_box"})
    top = (0.0, size[1], 0.0)
    tool = gltf.node("tool", translation=top,
                     extras={"comment": ABOUT_TOOL, "torsion_role": "tool", "torsion_mass": 0.2})
    for part, part_shape, extents, height, rotation in parts:
        gltf.node(part, tool, translation=(0.0, height, 0.0), rotation=rotation,
                  extras={"torsion_shape": part_shape, "torsion_size": extents})
    gltf.animation("press and turn", tool, motions.pressed(top, depth, 0.002, [(0.0, 0.0)], turns, seconds))
    gltf.show(title, caption, torsion_colors="twist", torsion_stick_slip=True)
    return gltf.small_file("templates/" + name)


UPRIGHT = (0.0, 0.0, 0.0, 1.0)
TURN = [(0.0, 0.0), (1.0, 0.0), (2.2, 45.0), (3.3, 0.0), (4.0, 0.0)]


def templates():
    files = {}
    files |= template("ball", "A ball on rubber", "Press and turn: the torque bends as slip grows from the rim.",
                      ("block", "box", (0.08, 0.05, 0.08), RUBBER),
                      [("ball", "sphere", (0.04, 0.04, 0.04), 0.02, UPRIGHT)], 0.003, TURN)
    files |= template("fingertip", "A fingertip on a pad", "Light pressure, small turns: what a knob's rubber feels.",
                      ("pad", "box", (0.06, 0.012, 0.06), RUBBER),
                      [("fingertip", "ellipsoid", (0.016, 0.024, 0.018), 0.012, UPRIGHT)], 0.0008,
                      [(0.0, 0.0), (1.0, 0.0), (1.8, 20.0), (2.8, -20.0), (3.4, 0.0), (4.0, 0.0)])
    files |= template("screwdriver", "A screwdriver's blade on gel", "A long contact that turns against the gel.",
                      ("gel", "box", (0.06, 0.03, 0.06), {**GEL, "torsion_tolerance": 0.08}),
                      [("blade", "box", (0.008, 0.03, 0.0016), 0.015, UPRIGHT),
                       ("shaft", "cylinder", (0.006, 0.04, 0.006), 0.045, UPRIGHT),
                       ("handle", "capsule", (0.024, 0.07, 0.024), 0.095, UPRIGHT)], 0.002,
                      [(0.0, 0.0), (1.0, 0.0), (2.8, 60.0), (3.4, 60.0), (4.0, 60.0)])
    files |= template("disc", "A disc on a soft belly", "As a stethoscope's: flat, wide, with an edge.",
                      ("belly", "ellipsoid", (0.16, 0.08, 0.14), SKIN),
                      [("disc", "cylinder", (0.036, 0.008, 0.036), 0.004, UPRIGHT),
                       ("stem", "cylinder", (0.012, 0.02, 0.012), 0.018, UPRIGHT)], 0.004, TURN)
    files |= template("drill", "A drill's tip on foam", "A small round tip that turns on and on.",
                      ("foam", "box", (0.05, 0.03, 0.05), FOAM),
                      [("tip", "sphere", (0.006, 0.006, 0.006), 0.003, UPRIGHT),
                       ("bit", "cylinder", (0.006, 0.05, 0.006), 0.028, UPRIGHT),
                       ("chuck", "cylinder", (0.03, 0.03, 0.03), 0.068, UPRIGHT)], 0.0012,
                      [(0.0, 0.0), (1.0, 0.0)] + motions.at_even_speed((1.0, 0.0), (3.2, 720.0)) + [(4.0, 720.0)])
    return files
