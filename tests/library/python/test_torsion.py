"""The Python module: scenes, runs and arrays, against exact solutions and against itself."""
import os
import pathlib
import re
import threading
import time

import numpy as np
import pytest

import torsion

RADIUS, HALF, DEPTH = 0.02, 0.05, 4e-4
SCENES = pathlib.Path(os.environ["TORSION_SCENES"])


def ball_on_pad(model="mdr"):
    pad = torsion.Body("pad", [torsion.box([2 * HALF] * 3)])
    pad.youngs_modulus, pad.poisson_ratio = 1e5, 0.5
    pad.static_friction = pad.dynamic_friction = 0.5
    pad.fixed = torsion.Fixed.bottom_face
    pad.contact_model, pad.body_model = model, "none"
    return torsion.Scene([pad], [torsion.Tool("ball", [torsion.sphere(RADIUS)])])


def pressed_and_turned(steps=100, turns=500, turn=0.5):
    """Poses (steps + turns, 1, 7): down by DEPTH, then about the vertical."""
    poses = np.zeros((steps + turns, 1, 7))
    depth = DEPTH * np.minimum(np.arange(steps + turns) / (steps - 1), 1.0)
    angle = turn * np.clip((np.arange(steps + turns) - steps + 1) / turns, 0.0, 1.0)
    poses[:, 0, 1] = HALF + RADIUS - depth
    poses[:, 0, 3] = np.cos(angle / 2)
    poses[:, 0, 5] = np.sin(angle / 2)
    return poses


def test_a_ball_presses_as_hertz_and_turns_as_lubkin_say():
    simulation = torsion.Simulation(torsion.build(ball_on_pad()))
    trace = simulation.run(pressed_and_turned())
    assert trace.shape == (600, 1)
    assert trace["time"][1, 0] == 1e-3
    assert not trace["faults"].any()
    contact_modulus = 1e5 / 0.75
    hertz = 4 / 3 * contact_modulus * np.sqrt(RADIUS) * DEPTH**1.5
    assert trace["normal_force"][99, 0] == pytest.approx(hertz, rel=0.02)
    region = simulation.regions()[0]
    saturated = 3 * np.pi / 16 * 0.5 * region["normal_force"] * region["radius"]
    assert -trace["couple"][-1, 0] == pytest.approx(saturated, rel=0.01)
    assert trace["stick_share"][-1, 0] == 0.0


def test_steps_and_a_run_give_the_same_bits():
    model = torsion.build(ball_on_pad("patch"))
    poses = pressed_and_turned(turns=50)
    whole, single = torsion.Simulation(model), torsion.Simulation(model)
    whole.run(poses)
    for pose in poses:
        single.step(pose)
    assert whole.hash == single.hash
    assert np.array_equal(whole.wrench(), single.wrench())


def test_a_copy_goes_on_by_itself():
    simulation = torsion.Simulation(torsion.build(ball_on_pad()))
    poses = pressed_and_turned(turns=50)
    simulation.run(poses[:100])
    copy, before = simulation.copy(), simulation.hash
    copy.run(poses[100:])
    assert simulation.hash == before
    simulation.run(poses[100:])
    assert simulation.hash == copy.hash
    simulation.reset()
    assert simulation.time == 0.0


def test_parts_of_the_load_add_up():
    simulation = torsion.Simulation(torsion.build(ball_on_pad()))
    simulation.run(pressed_and_turned(turns=50, turn=0.05))
    about = np.array([0.1, 0.2, -0.3])
    parts, wrench = simulation.load_parts(about=about), simulation.wrench(about=about)
    assert parts["normal_force"] + parts["friction"] == pytest.approx(wrench[:3], rel=1e-9, abs=1e-9)
    assert parts["couple"] + parts["lever_torque"] == pytest.approx(wrench[3:], rel=1e-9, abs=1e-9)
    assert abs(parts["couple"][1]) > 0.0
    stiffness = simulation.stiffness()
    assert stiffness.shape == (6, 6)
    assert np.allclose(stiffness, stiffness.T)


def test_a_file_with_another_material():
    scene = torsion.load(str(SCENES / "ball_on_cube.gltf"))
    assert scene.bodies == ["cube"]
    poses = scene.animation()
    assert poses.shape == (round(scene.duration * 1000), 1, 7)
    largest = []
    for factor in (1.0, 2.0):
        other = scene.copy()
        other["cube"].youngs_modulus *= factor
        model = torsion.build(other, contact_model="mdr", body_model="none")
        trace = torsion.Simulation(model).run(poses)
        largest.append(np.abs(trace["force"]).max())
    assert largest[1] == pytest.approx(2 * largest[0], rel=1e-6)


def test_what_is_wrong_is_said():
    scene = ball_on_pad()
    scene["pad"].poisson_ratio = 0.7
    with pytest.raises(ValueError, match="poisson_ratio is 0.7"):
        torsion.build(scene)
    with pytest.raises(ValueError, match="nowhere.gltf"):
        torsion.load("nowhere.gltf")
    with pytest.raises(KeyError):
        scene["nobody"]
    simulation = torsion.Simulation(torsion.build(ball_on_pad()))
    with pytest.raises(ValueError, match=r"\(1, 7\)"):
        simulation.step(np.zeros((2, 7)))
    with pytest.raises(ValueError, match="7"):
        simulation.run(np.zeros((3, 1, 6)))
    with pytest.raises(IndexError):
        simulation.wrench(tool=1)
    with pytest.raises(IndexError):
        simulation.cells(region=0)


def test_cells_carry_the_force():
    simulation = torsion.Simulation(torsion.build(ball_on_pad("patch")))
    simulation.run(pressed_and_turned(turns=1, turn=0.0))
    cells = simulation.cells()
    force = (cells["pressure"] * cells["area"]).sum()
    assert force == pytest.approx(simulation.regions()["normal_force"][0], rel=2e-3)  # as simulation_test.cpp
    assert cells["point"].shape == (len(cells), 3)


def test_the_surface_is_dented_and_turns():
    simulation = torsion.Simulation(torsion.build(ball_on_pad()))
    x = np.linspace(-HALF, HALF, 41)
    vertices = np.array([[a, HALF, b] for b in x for a in x])
    corner = (np.arange(40)[:, None] * 41 + np.arange(40)).ravel()
    triangles = np.concatenate([np.stack([corner, corner + 41, corner + 1], axis=1),
                                np.stack([corner + 1, corner + 41, corner + 42], axis=1)])
    surface = torsion.Surface(simulation, vertices, triangles)
    positions = surface.positions
    simulation.run(pressed_and_turned(turns=100, turn=0.01))
    surface.update(simulation)
    middle = 20 * 41 + 20
    assert positions[middle, 1] == pytest.approx(HALF - DEPTH, abs=0.05 * DEPTH)  # a view: no new array
    assert 0.0 < surface.twist[middle] <= 0.0101
    assert not positions.flags.writeable


def test_runs_in_threads_do_not_wait_for_the_interpreter():
    model = torsion.build(ball_on_pad("patch"))
    poses = pressed_and_turned(turns=100)
    hashes = [None, None]

    def work(k):
        simulation = torsion.Simulation(model)
        simulation.run(poses)
        hashes[k] = simulation.hash

    threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert hashes[0] == hashes[1] is not None


def test_two_threads_on_one_simulation_are_told_so():
    simulation = torsion.Simulation(torsion.build(ball_on_pad("patch")))
    poses = pressed_and_turned(turns=3000)
    thread = threading.Thread(target=simulation.run, args=(poses,))
    refused = 0
    thread.start()
    while thread.is_alive():
        try:
            simulation.wrench()
        except RuntimeError as error:
            assert "another thread" in str(error)
            refused += 1
    thread.join()
    assert refused > 0
    alone = torsion.Simulation(torsion.build(ball_on_pad("patch")))
    alone.run(poses)
    assert alone.hash == simulation.hash


def test_numbers_that_are_none_end_in_faults_or_exceptions():
    simulation = torsion.Simulation(torsion.build(ball_on_pad()))
    simulation.step([0.0, np.nan, 0.0, 1.0, 0.0, 0.0, 0.0])
    assert simulation.faults
    assert np.isfinite(simulation.wrench()).all()
    for poses in (np.zeros((0, 1, 7)), np.full((3, 1, 7), np.inf)):
        assert len(simulation.run(poses)) == len(poses)
    with pytest.raises((TypeError, ValueError)):
        simulation.step(None)
    with pytest.raises((TypeError, ValueError)):
        simulation.run("poses")
    with pytest.raises(TypeError):
        torsion.Simulation(None)


def test_a_picture_shows_what_was_changed():
    scene = torsion.load(str(SCENES / "ball_on_cube_soft.gltf"))
    pictures = [torsion.render(scene, at=2.0, size=(320, 240))]
    assert pictures[0].shape == (240, 320, 3) and pictures[0].dtype == np.uint8
    assert pictures[0].std() > 10.0  # something is in it
    scene["cube"].static_friction = scene["cube"].dynamic_friction = 0.05
    pictures.append(torsion.render(scene, at=2.0, size=(320, 240)))
    assert np.abs(pictures[0].astype(int) - pictures[1]).max() > 50  # hardly twisted any more
    with pytest.raises(ValueError, match="made by code"):
        torsion.picture(ball_on_pad(), at=0.0)
    scene["cube"].poisson_ratio = 0.7
    with pytest.raises(ValueError, match="0 to 0.5"):
        torsion.picture(scene, at=0.0)


def test_a_notebook_shows_pictures_and_curves():
    scene = torsion.load(str(SCENES / "ball_on_cube.gltf"))
    assert "data:image/png;base64," in scene._repr_html_()
    model = torsion.build(scene, contact_model="mdr", body_model="none")
    summary = torsion.Summary(scene, torsion.Simulation(model).run(scene.animation()))
    assert "data:image/png;base64," in summary._repr_html_()
    curves = summary.curves()
    assert len(curves) == 3 and not any("nan" in curve for curve in curves)
    assert summary._repr_html_().count("<svg") == 3
    made = ball_on_pad()
    trace = torsion.Simulation(torsion.build(made)).run(pressed_and_turned(turns=100))
    assert "<img" not in torsion.Summary(made, trace)._repr_html_()
    assert "<p>pad; tools ball" in made._repr_html_()


def test_the_page_of_the_module_runs(capsys, monkeypatch):
    page = (SCENES.parent / "docs" / "python.md").read_text(encoding="utf-8")
    block = re.search(r"```python\n(.*?)```", page, re.DOTALL)
    monkeypatch.chdir(SCENES.parent)
    exec(compile(block.group(1), "docs/python.md", "exec"), {})
    assert "largest couple" in capsys.readouterr().out


def test_how_fast_a_loop_of_steps_is():
    """Printed, not held against a limit: the machine may do other things as well."""
    simulation = torsion.Simulation(torsion.build(ball_on_pad()))
    poses = pressed_and_turned(turns=5000)
    begin = time.perf_counter()
    for pose in poses:
        simulation.step(pose)
    in_loop = len(poses) / (time.perf_counter() - begin)
    simulation.reset()
    begin = time.perf_counter()
    simulation.run(poses)
    print(f"mdr: {in_loop:.0f} steps/s in a loop, {len(poses) / (time.perf_counter() - begin):.0f} in run()")
