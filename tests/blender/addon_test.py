"""The add-on in Blender without a window:

    blender --background --factory-startup --python-exit-code 1 --python addon_test.py -- ADDON TORSION CONVENTIONS

Builds a scene by the panel's properties only, checks it, breaks it, exports it, and lets the live view follow.
"""

import importlib.util
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import time

import bpy

ADDON, TORSION, CONVENTIONS = sys.argv[sys.argv.index("--") + 1:]


def load():
    spec = importlib.util.spec_from_file_location("torsion_addon", ADDON)
    addon = importlib.util.module_from_spec(spec)
    sys.modules["torsion_addon"] = addon
    spec.loader.exec_module(addon)
    addon.register()
    return addon


def json_of(path):
    with open(path, "rb") as file:
        data = file.read()
    length, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + length])


def near(a, b):
    assert len(a) == len(b) and all(abs(x - y) < 1e-6 for x, y in zip(a, b)), (list(a), list(b))


def test_keys_are_those_of_the_program(addon):
    """Every key of scenes/conventions.hpp has a row in the add-on, with the same words."""
    with open(CONVENTIONS, encoding="utf-8") as file:
        source = file.read()
    table = source[source.index("kSceneKeys = {"):]
    names = set(re.findall(r'SceneKey\{"(torsion_\w+)"', table)) - {"torsion_role"}
    assert names == set(addon.BY_NAME), names ^ set(addon.BY_NAME)
    for name, words in re.findall(r'SceneKey\{"(torsion_\w+)",[^{}]*?KeyKind::kWord,\s*"([^"]+)"', table):
        if name != "torsion_role":
            assert tuple(words.split()) == addon.BY_NAME[name].words, name
    roles = re.search(r'"torsion_role",[^{}]*?"([^"]+)"', table).group(1)
    assert tuple(roles.split()) == addon.ROLES


def build():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.mesh.primitive_cube_add(location=(0.0, 0.0, 0.02), scale=(0.04, 0.04, 0.02))
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    pad = bpy.context.object
    pad.name = "pad"
    pad.torsion_role = "elastic"
    pad.torsion_shape = "box"
    pad.torsion_youngs_modulus = 2e4
    pad.torsion_fixed = "bottom_face"
    bpy.ops.object.empty_add(location=(0.0, 0.0, 0.05))
    ball = bpy.context.object
    ball.name = "ball"
    ball.torsion_role = "tool"
    ball.torsion_shape = "sphere"
    ball.torsion_size = (0.02, 0.02, 0.02)
    ball.torsion_mass = 0.25
    for frame, height in ((1, 0.052), (24, 0.048)):
        ball.location.z = height
        ball.keyframe_insert("location", frame=frame)
    bpy.context.scene.torsion_title = "By the panel"
    bpy.context.scene.torsion_loop = False
    return pad, ball


def test_what_is_set_is_what_is_written(addon, pad, ball):
    assert [key.name for key in addon.keys_of(ball)] == [
        key.name for key in addon.KEYS if "tool" in key.on]
    assert not ball.has_torsion_device and ball.torsion_device == "animation"
    ball.has_torsion_device = True
    assert ball["torsion_device"] == "animation"
    ball.has_torsion_device = False
    assert "torsion_device" not in ball
    # Blender's axes and glTF's: y up.
    ball.torsion_size = (0.01, 0.02, 0.03)
    near(ball["torsion_size"], (0.01, 0.03, 0.02))
    near(ball.torsion_size, (0.01, 0.02, 0.03))
    ball.torsion_size = (0.02, 0.02, 0.02)
    ball.torsion_center_of_mass = (0.001, 0.002, 0.003)
    near(ball["torsion_center_of_mass"], (0.001, 0.003, -0.002))
    near(ball.torsion_center_of_mass, (0.001, 0.002, 0.003))
    ball.has_torsion_center_of_mass = False
    bpy.ops.object.empty_add()
    part = bpy.context.object
    assert not addon.keys_of(part)
    part.parent = pad
    assert {key.name for key in addon.keys_of(part)} == {"torsion_shape", "torsion_draw", "torsion_size"}
    part.torsion_role = "fixed_box"
    assert not addon.keys_of(part)
    part.torsion_role = "none"
    assert "torsion_role" not in part
    bpy.data.objects.remove(part)


def test_a_good_scene_has_nothing_wrong(addon):
    assert bpy.ops.torsion.check() == {"FINISHED"}
    messages = bpy.context.window_manager.torsion_messages
    assert not [message.text for message in messages if message.is_problem], [m.text for m in messages]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.glb")
        addon.export(path)
        assert os.listdir(folder) == ["scene.glb"]
        document = json_of(path)
        extras = {node["name"]: node.get("extras", {}) for node in document["nodes"]}
        assert extras["pad"] == {"torsion_role": "elastic", "torsion_shape": "box", "torsion_youngs_modulus": 2e4,
                                 "torsion_fixed": "bottom_face"}, extras["pad"]
        assert document["scenes"][0]["extras"]["torsion_title"] == "By the panel"
        ran = subprocess.run([TORSION, "simulate", path, "--json"], capture_output=True, text=True, check=True)
        summary = json.loads(ran.stdout)
        # A ball of 10 mm pressed 2 mm into gel, by Hertz: 16/3 G sqrt(R d^3) with G = 6.7 kPa (nu = 0.5) is 0.32 N,
        # a third more on a pad of 40 mm at most.
        assert 0.25 < summary["peak_force_N"] < 0.45, summary


def test_what_is_wrong_is_said_and_selected(pad, ball):
    pad["torsion_poisson_ratio"] = 0.9
    ball["torsion_masss"] = 1.0
    bpy.ops.object.select_all(action="DESELECT")
    try:
        bpy.ops.torsion.check()
    except RuntimeError as error:  # an operator that reports an error raises it in a script
        assert "2 problems" in str(error), error
    messages = bpy.context.window_manager.torsion_messages
    assert sorted(message.object_name for message in messages if message.is_problem) == ["ball", "pad"]
    assert any("0.9" in message.text and "from 0 to 0.5" in message.text for message in messages)
    assert any("torsion_mass" in message.text for message in messages)
    assert pad.select_get() and ball.select_get()
    bpy.ops.torsion.select(object_name="pad")
    assert pad.select_get() and not ball.select_get() and bpy.context.view_layer.objects.active == pad
    del pad["torsion_poisson_ratio"], ball["torsion_masss"]


def test_a_program_that_is_not_there_is_said():
    os.environ["TORSION_PROGRAM"] = "/nowhere/torsion"
    for operator in (bpy.ops.torsion.check, bpy.ops.torsion.view):
        try:
            operator()
            raise AssertionError("no error")
        except RuntimeError as error:
            assert "not found" in str(error), error
    os.environ["TORSION_PROGRAM"] = TORSION


def test_live_writes_once_after_a_change(addon, ball):
    with tempfile.TemporaryDirectory() as folder:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "live.blend"))
        written = os.path.join(folder, "live.glb")
        scene = bpy.context.scene
        scene.torsion_live = True
        ball = bpy.data.objects["ball"]
        ball.torsion_mass = 0.5
        addon.note_change(scene)
        addon.write_when_quiet()
        assert not os.path.exists(written)  # not quiet yet
        time.sleep(addon.Live.QUIET + 0.1)
        addon.write_when_quiet()
        first = os.stat(written).st_mtime_ns
        extras = {node["name"]: node.get("extras", {}) for node in json_of(written)["nodes"]}
        assert extras["ball"]["torsion_mass"] == 0.5
        time.sleep(addon.Live.QUIET + 0.1)
        addon.write_when_quiet()
        assert os.stat(written).st_mtime_ns == first  # to write is no change
        scene.torsion_live = False


def main():
    os.environ["TORSION_PROGRAM"] = TORSION
    addon = load()
    test_keys_are_those_of_the_program(addon)
    pad, ball = build()
    test_what_is_set_is_what_is_written(addon, pad, ball)
    test_a_good_scene_has_nothing_wrong(addon)
    test_what_is_wrong_is_said_and_selected(pad, ball)
    test_a_program_that_is_not_there_is_said()
    test_live_writes_once_after_a_change(addon, ball)
    addon.unregister()
    print("add-on: all passed")


main()
