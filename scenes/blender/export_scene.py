"""Builds a scene in Blender the way an author does and exports it as glTF:

    blender --background --factory-startup --python scenes/blender/export_scene.py -- OUT.glb

knob_on_pad.glb beside this file is what Debian 12's Blender 3.4 made of it: a pad of rubber, scaled and
with a modifier, held by an empty, under a knob that comes down and turns.
"""

import math
import pathlib
import sys

import bpy

FRAMES_A_SECOND = 24


def new_object(name, add_mesh, location, **properties):
    add_mesh(location=location)
    made = bpy.context.active_object
    made.name = name
    for key, value in properties.items():
        made[key] = value
    return made


def add_material(made, name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = color
    made.data.materials.append(material)
    return material


def make_pad():
    pad = new_object("pad", bpy.ops.mesh.primitive_cube_add, (0.0, 0.0, 0.02),
                     torsion_role="elastic", torsion_fixed="children", torsion_shape="mesh")
    pad.scale = (0.05, 0.04, 0.02)  # left on the object: the reader applies it
    modifier = pad.modifiers.new("finer", "SUBSURF")
    modifier.subdivision_type = "SIMPLE"
    modifier.levels = modifier.render_levels = 4
    rubber = add_material(pad, "soft rubber", (0.8, 0.42, 0.22, 1.0))
    rubber["torsion_youngs_modulus"] = 2.0e5
    rubber["torsion_poisson_ratio"] = 0.45
    rubber["torsion_dynamic_friction"] = 0.8

    bpy.ops.object.empty_add(type="CUBE", location=(0.0, 0.0, 0.0))
    holder = bpy.context.active_object
    holder.name = "glued side"
    holder["torsion_role"] = "fixed_box"
    holder.parent = pad
    holder.location = (0.0, 0.0, -1.0)  # in the pad's own unit cube: its lowest tenth
    holder.scale = (1.1, 1.1, 0.1)


def make_knob():
    knob = new_object("knob", bpy.ops.mesh.primitive_uv_sphere_add, (0.0, 0.0, 0.06),
                      torsion_role="tool", torsion_mass=0.3, torsion_shape="ellipsoid")
    knob.scale = (0.018, 0.012, 0.015)
    add_material(knob, "steel", (0.25, 0.38, 0.55, 1.0))
    keys = [(1, 0.060, 0.0), (16, 0.051, 0.0), (40, 0.051, -35.0), (72, 0.051, 35.0),
            (84, 0.060, 35.0)]
    for frame, height, degrees in keys:
        knob.location = (0.0, 0.0, height)
        knob.rotation_euler = (0.0, 0.0, math.radians(degrees))
        knob.keyframe_insert("location", frame=frame)
        knob.keyframe_insert("rotation_euler", frame=frame)


def add_camera():
    bpy.ops.object.camera_add(location=(0.18, -0.22, 0.17),
                              rotation=(math.radians(64.0), 0.0, math.radians(39.0)))
    bpy.context.active_object.name = "camera"
    bpy.context.active_object.data.angle = 0.45
    bpy.context.active_object.data.clip_start = 0.01


def main():
    here = pathlib.Path(__file__).resolve().parent
    after = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    out = pathlib.Path(after[0]) if after else here / "knob_on_pad.glb"
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    scene = bpy.context.scene
    scene.render.fps = FRAMES_A_SECOND
    scene.frame_start, scene.frame_end = 1, 84
    make_pad()
    make_knob()
    add_camera()
    bpy.ops.export_scene.gltf(filepath=str(out), export_format="GLB", export_extras=True,
                              export_attributes=True, export_cameras=True, export_apply=True)


main()
