"""Torsion in Blender: a panel for the keys of a scene, a check that names objects, and a live view.

Install: Edit > Preferences > Add-ons > Install, choose this file, switch it on, and say there where the program
`torsion` is. The panel is in the sidebar of the 3D view (N), tab Torsion; the same is in Properties: Object, and Scene.
What it sets are custom properties under the names of docs/scenes.md, so that a file needs the add-on only while it is
edited.
"""

bl_info = {
    "name": "Torsion",
    "description": "Contact, torque and twist of elastic bodies: keys, check and live view of a scene",
    "author": "The Torsion authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Torsion, Properties > Object and Scene",
    "category": "Physics",
}

import json
import os
import shutil
import subprocess
import tempfile
import textwrap
import time

import bpy
from bpy.app.handlers import persistent

NUMBER, WORD, TEXT, VECTOR, FLAG = "number", "word", "text", "vector", "flag"
ELASTIC, TOOL, FIXED, PART, SCENE = "elastic", "tool", "fixed", "part", "scene"
ROLES = ("elastic", "tool", "fixed_point", "fixed_box", "fixed_sphere")
SHAPES = ("mesh", "box", "sphere", "ellipsoid", "cylinder", "capsule")


class Key:
    """A key of docs/scenes.md: on what it is, what it holds, what it is where it is not set, and its unit."""

    def __init__(self, name, on, kind, default, text, unit="", words=(), low=-1e6, high=1e6):
        self.name, self.on, self.kind, self.default, self.text = name, on, kind, default, text
        self.unit, self.words, self.low, self.high = unit, words, low, high

    @property
    def label(self):
        words = self.name[len("torsion_"):].replace("_", " ").replace("youngs", "young's").capitalize()
        return f"{words} ({self.unit})" if self.unit else words


KEYS = (
    Key("torsion_youngs_modulus", (ELASTIC,), NUMBER, 3e6, "How stiff it is: gel 1e4, skin 5e4, rubber 1e6", "Pa",
        low=1.0, high=1e15),
    Key("torsion_poisson_ratio", (ELASTIC,), NUMBER, 0.5, "0.5 keeps its volume, as rubber, gel and flesh do",
        low=0.0, high=0.5),
    Key("torsion_density", (ELASTIC,), NUMBER, 1100.0, "Of the body", "kg/m³", low=1e-3, high=1e6),
    Key("torsion_static_friction", (ELASTIC,), NUMBER, 0.75, "While it sticks; at least the dynamic one", low=0.0,
        high=100.0),
    Key("torsion_dynamic_friction", (ELASTIC,), NUMBER, 0.75, "While it slips", low=0.0, high=100.0),
    Key("torsion_contact_model", (ELASTIC,), WORD, "auto", "What makes force and torque of a contact",
        words=("auto", "paper", "mdr", "patch", "winkler")),
    Key("torsion_body_model", (ELASTIC,), WORD, "auto", "How the body gives way as a whole",
        words=("auto", "none", "skeleton", "compliance")),
    Key("torsion_tolerance", (ELASTIC,), NUMBER, 0.05, "Relative error of the torque that auto may make", low=1e-4,
        high=1.0),
    Key("torsion_fixed", (ELASTIC,), WORD, "bottom_center", "What holds the body",
        words=("bottom_center", "bottom_face", "attribute", "children")),
    Key("torsion_region_threshold", (ELASTIC,), NUMBER, 0.003, "Contact points nearer than this are one region", "m",
        low=1e-6, high=1e3),
    Key("torsion_shape", (ELASTIC, TOOL, PART), WORD, "mesh", "What is felt: the mesh, or the shape that fills its box",
        words=SHAPES),
    Key("torsion_draw", (ELASTIC, TOOL, PART), WORD, "shape", "What is drawn of an exact shape", words=("shape", "mesh")),
    Key("torsion_size", (ELASTIC, TOOL, PART), VECTOR, (0.02, 0.02, 0.02),
        "Of an empty that is a shape: full extents along its axes", "m", low=1e-6),
    Key("torsion_mass", (TOOL,), NUMBER, 1.0, "Of the tool", "kg", low=1e-6),
    Key("torsion_center_of_mass", (TOOL,), VECTOR, (0.0, 0.0, 0.0), "In the object's axes", "m"),
    Key("torsion_device", (TOOL,), WORD, "animation", "What moves the tool", words=("animation", "mouse", "usb")),
    Key("torsion_title", (SCENE,), TEXT, "", "What the scene is"),
    Key("torsion_caption", (SCENE,), TEXT, "", "What to look at"),
    Key("torsion_loop", (SCENE,), FLAG, True, "Begin again after the animation"),
    Key("torsion_speed", (SCENE,), NUMBER, 1.0, "Of real time", low=0.01, high=1.0),
    Key("torsion_colors", (SCENE,), WORD, "material", "What the body's colours show",
        words=("material", "twist", "pressure")),
    Key("torsion_lines", (SCENE,), FLAG, True, "Lines that are fixed to bodies and tools"),
    Key("torsion_stick_slip", (SCENE,), FLAG, False, "Marks where the contact sticks and slips"),
    Key("torsion_torque", (SCENE,), WORD, "total", "Torque as one arrow, or couples apart", words=("total", "parts")),
)
BY_NAME = {key.name: key for key in KEYS}


def owner_of(thing):
    """The nearest object at or above one that is a tool or a body; None where there is none."""
    while thing is not None and thing.get("torsion_role") not in ("elastic", "tool"):
        thing = thing.parent
    return thing


def keys_of(thing):
    """The keys that an object, or the scene, may have."""
    if isinstance(thing, bpy.types.Scene):
        kind = SCENE
    else:
        role = thing.get("torsion_role", "")
        kind = FIXED if role.startswith("fixed") else role or (PART if owner_of(thing) else "")
    return [key for key in KEYS if kind in key.on]


# Vectors are stored as glTF has them, y up: Blender's (x, y, z) is glTF's (x, z, -y).

def stored(key, value):
    if key.kind == VECTOR:
        x, y, z = value
        return [x, z, y if key.name == "torsion_size" else -y]
    if key.kind == FLAG:
        return bool(value)
    return value


def shown(key, value):
    if key.kind == VECTOR:
        x, y, z = value
        return (x, z if key.name == "torsion_size" else -z, y)
    return value


def read(thing, key):
    value = thing.get(key.name)
    if key.kind == WORD:
        return key.words.index(value) if value in key.words else key.words.index(key.default)
    if value is None:
        return key.default
    return shown(key, value)


def write(thing, key, value):
    thing[key.name] = key.words[value] if key.kind == WORD else stored(key, value)


def property_of(key):
    """Blender's property of a key, kept in the custom property of its name."""
    common = {"name": key.label, "description": key.text, "get": lambda self: read(self, key),
              "set": lambda self, value: write(self, key, value)}
    if key.kind == WORD:
        items = [(word, word.replace("_", " "), "") for word in key.words]
        return bpy.props.EnumProperty(items=items, **common)
    if key.kind == TEXT:
        return bpy.props.StringProperty(**common)
    if key.kind == FLAG:
        return bpy.props.BoolProperty(**common)
    if key.kind == VECTOR:
        return bpy.props.FloatVectorProperty(size=3, min=key.low, max=key.high, precision=4, **common)
    return bpy.props.FloatProperty(min=key.low, max=key.high, precision=4, **common)


def is_set_property(key):
    def change(self, on):
        if on and key.name not in self:
            self[key.name] = stored(key, key.default)
        elif not on and key.name in self:
            del self[key.name]

    return bpy.props.BoolProperty(name="Set " + key.label, description="Off: " + default_text(key),
                                  get=lambda self: key.name in self, set=change)


def default_text(key):
    return "as the scene needs" if key.name in ("torsion_region_threshold", "torsion_center_of_mass",
                                                "torsion_fixed", "torsion_size") else f"{key.default} is taken"


def role_property():
    items = [("none", "none", "Not part of the physics, or a part of the tool or body above it"),
             ("elastic", "elastic body", "What is pressed: it deforms and twists"),
             ("tool", "tool", "What presses: rigid"),
             ("fixed_point", "fixed point", "Below a body: where its beams start"),
             ("fixed_box", "fixed box", "Below a body: what lies in this box, from -1 to 1, is held"),
             ("fixed_sphere", "fixed sphere", "Below a body: what lies in this unit sphere is held")]
    names = [item[0] for item in items]

    def get(self):
        role = self.get("torsion_role", "none")
        return names.index(role) if role in names else 0

    def change(self, value):
        if value:
            self["torsion_role"] = names[value]
        elif "torsion_role" in self:
            del self["torsion_role"]

    return bpy.props.EnumProperty(name="Role", items=items, get=get, set=change)


def properties():
    """(type, name, property) of all that the panels show. They keep nothing of their own: a group of them would leave an
    empty custom property in every file."""
    yield bpy.types.Object, "torsion_role", role_property()
    for key in KEYS:
        kind = bpy.types.Scene if SCENE in key.on else bpy.types.Object
        yield kind, key.name, property_of(key)
        yield kind, "has_" + key.name, is_set_property(key)


class TorsionMessage(bpy.types.PropertyGroup):
    text: bpy.props.StringProperty()
    object_name: bpy.props.StringProperty()
    is_problem: bpy.props.BoolProperty()


class TorsionPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: bpy.props.StringProperty(name="Program torsion", subtype="FILE_PATH",
                                      description="Empty: the one on the path")

    def draw(self, _context):
        self.layout.prop(self, "program")


def program():
    """Where torsion is; None where it is not found."""
    addon = bpy.context.preferences.addons.get(__name__)
    chosen = addon.preferences.program if addon else ""
    chosen = chosen or os.environ.get("TORSION_PROGRAM", "")
    return bpy.path.abspath(chosen) if chosen else shutil.which("torsion")


def export(path):
    """Writes the scene beside `path` and puts it there whole, so that nobody reads a half of it."""
    folder, name = os.path.split(path)
    draft = os.path.join(folder, "." + name + ".draft.glb")
    bpy.ops.export_scene.gltf(filepath=draft, export_format="GLB", export_extras=True, export_attributes=True,
                              export_cameras=True, export_apply=True, use_visible=True)
    os.replace(draft, path)


def scene_file():
    """Where the live scene goes: beside the .blend, or in a folder for temporary files."""
    if bpy.data.filepath:
        return os.path.splitext(bpy.data.filepath)[0] + ".glb"
    return os.path.join(bpy.app.tempdir or tempfile.gettempdir(), "torsion_scene.glb")


def object_named_in(text):
    """The object whose name stands between quotes in a message; its parts' names may be longer."""
    for part in text.split('"')[1::2]:
        if part in bpy.data.objects:
            return part
    return ""


def check(context):
    """Runs `torsion check` on the scene as it is. Error: a text. Else the messages are in the window manager."""
    messages = context.window_manager.torsion_messages
    messages.clear()
    found = program()
    if not found or not os.path.isfile(found):
        return "The program torsion is not found: say where it is in the add-on's preferences."
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.glb")
        export(path)
        ran = subprocess.run([found, "check", path, "--json"], capture_output=True, text=True, check=False)
    try:
        said = json.loads(ran.stdout)
    except ValueError:
        return f"torsion check ended with {ran.returncode}: {ran.stderr.strip()[:200]}"
    for problem in said["problems"]:
        what = [problem["where"], problem["key"] + (f" is {problem['value']}," if problem["value"] else ""),
                problem["expected"], f"({problem['mend']})" if problem["mend"] else ""]
        add_message(messages, " ".join(word for word in what if word.strip()), problem["where"], True)
    for warning in said.get("warnings", []):
        add_message(messages, warning, warning, False)
    mark_objects(context, messages)
    return ""


def add_message(messages, text, where, is_problem):
    message = messages.add()
    message.text, message.object_name, message.is_problem = text, object_named_in(where), is_problem


def mark_objects(context, messages):
    """Selects what the messages are of, so that it stands out in the view and in the outliner."""
    names = [message.object_name for message in messages if message.object_name]
    if not names:
        return
    for thing in context.view_layer.objects:
        thing.select_set(thing.name in names)
    context.view_layer.objects.active = bpy.data.objects[names[0]]


class TORSION_OT_check(bpy.types.Operator):
    """Say all that is wrong with the scene, and select the objects it is wrong with"""
    bl_idname = "torsion.check"
    bl_label = "Check"

    def execute(self, context):
        error = check(context)
        if error:
            self.report({"ERROR"}, error)
            return {"CANCELLED"}
        messages = context.window_manager.torsion_messages
        problems = sum(message.is_problem for message in messages)
        self.report({"ERROR"} if problems else {"INFO"},
                    f"{problems} problems, {len(messages) - problems} warnings" if messages else "Nothing is wrong")
        return {"FINISHED"}


class TORSION_OT_select(bpy.types.Operator):
    """Select the object that the message is of"""
    bl_idname = "torsion.select"
    bl_label = "Select"
    object_name: bpy.props.StringProperty()

    def execute(self, context):
        for thing in context.view_layer.objects:
            thing.select_set(thing.name == self.object_name)
        context.view_layer.objects.active = bpy.data.objects.get(self.object_name)
        return {"FINISHED"}


class TORSION_OT_view(bpy.types.Operator):
    """Open the scene in Torsion's window; with Live on it follows what is changed here"""
    bl_idname = "torsion.view"
    bl_label = "View"

    def execute(self, _context):
        found = program()
        if not found or not os.path.isfile(found):
            self.report({"ERROR"}, "The program torsion is not found: say where it is in the add-on's preferences.")
            return {"CANCELLED"}
        export(scene_file())
        subprocess.Popen([found, "view", scene_file()])  # pylint: disable=consider-using-with
        self.report({"INFO"}, "Written to " + scene_file())
        return {"FINISHED"}


class Live:
    """Writes the scene half a second after its last change."""
    QUIET = 0.5  # s
    changed = None  # when, by time.monotonic(); None: nothing is to be written
    writing = False


def write_when_quiet():
    """A timer of Blender's. @return s until it is called again"""
    scene = bpy.context.scene
    if scene is not None and scene.torsion_live and Live.changed is not None:
        if time.monotonic() - Live.changed >= Live.QUIET:
            Live.changed, Live.writing = None, True
            try:
                export(scene_file())
            finally:
                Live.writing = False
    return 0.1


@persistent
def note_change(_scene, _graph=None):
    if not Live.writing:
        Live.changed = time.monotonic()


def draw_key(layout, thing, key):
    row = layout.row(align=True)
    row.prop(thing, "has_" + key.name, text="")
    value = row.row(align=True)
    value.enabled = key.name in thing
    value.prop(thing, key.name)


def draw_message(layout, context, message, with_button):
    """Wrapped to the panel's width: Blender's labels are one line each."""
    pixels_a_letter = 7.5 * context.preferences.system.ui_scale
    lines = textwrap.wrap(message.text, max(20, int((context.region.width - 70) / pixels_a_letter)))
    box = layout.column(align=True)
    for i, line in enumerate(lines):
        row = box.row()
        row.label(text=line, icon="BLANK1" if i else "ERROR" if message.is_problem else "INFO")
        if i == 0 and with_button and message.object_name:
            row.operator("torsion.select", text="", icon="RESTRICT_SELECT_OFF").object_name = message.object_name


def draw_object(layout, context):
    thing = context.object
    layout.prop(thing, "torsion_role")
    owner = owner_of(thing)
    if "torsion_role" not in thing and owner is not None:
        layout.label(text=f"A part of {owner.name}", icon="LINKED")
    for key in keys_of(thing):
        draw_key(layout, thing, key)
    for message in context.window_manager.torsion_messages:
        if message.object_name == thing.name:
            draw_message(layout, context, message, False)


def draw_commands(layout, context):
    row = layout.row(align=True)
    row.operator("torsion.check", icon="CHECKMARK")
    row.operator("torsion.view", icon="PLAY")
    row.prop(context.scene, "torsion_live", toggle=True, icon="FILE_REFRESH")
    for message in context.window_manager.torsion_messages:
        draw_message(layout, context, message, True)


def may_have_keys(context):
    return context.object is not None and context.object.type in ("MESH", "EMPTY")


class TORSION_PT_sidebar(bpy.types.Panel):
    bl_label = "Torsion"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Torsion"

    def draw(self, context):
        draw_commands(self.layout, context)
        if may_have_keys(context):
            self.layout.separator()
            self.layout.label(text=context.object.name, icon="OBJECT_DATA")
            draw_object(self.layout, context)


class TORSION_PT_object(bpy.types.Panel):
    bl_label = "Torsion"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        return may_have_keys(context)

    def draw(self, context):
        draw_object(self.layout, context)


class TORSION_PT_scene(bpy.types.Panel):
    bl_label = "Torsion"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "scene"

    def draw(self, context):
        draw_commands(self.layout, context)
        for key in keys_of(context.scene):
            draw_key(self.layout, context.scene, key)


CLASSES = (TorsionMessage, TorsionPreferences, TORSION_OT_check, TORSION_OT_select, TORSION_OT_view,
           TORSION_PT_sidebar, TORSION_PT_object, TORSION_PT_scene)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    for kind, name, value in properties():
        setattr(kind, name, value)
    bpy.types.Scene.torsion_live = bpy.props.BoolProperty(
        name="Live", description="Write the scene anew half a second after each change, for a window that shows it")
    bpy.types.WindowManager.torsion_messages = bpy.props.CollectionProperty(type=TorsionMessage)
    bpy.app.handlers.depsgraph_update_post.append(note_change)
    bpy.app.timers.register(write_when_quiet, persistent=True)


def unregister():
    bpy.app.timers.unregister(write_when_quiet)
    bpy.app.handlers.depsgraph_update_post.remove(note_change)
    del bpy.types.WindowManager.torsion_messages
    del bpy.types.Scene.torsion_live
    for kind, name, _ in properties():
        delattr(kind, name)
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)


if __name__ == "__main__":
    register()
