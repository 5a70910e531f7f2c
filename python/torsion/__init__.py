"""Torsion: forces and torques of rigid tools that press on and twist deformable bodies.

SI units; poses are x, y, z, qw, qx, qy, qz.

    model = torsion.build(torsion.load("scene.gltf"), rate=1000)
    simulation = torsion.Simulation(model)
    trace = simulation.run(poses)          # (steps, tools, 7) -> structured array (steps, tools)
"""
from ._torsion import (Body, Fixed, Model, Part, Scene, Simulation, Surface, Tool, __version__, box, build, capsule,
                       cylinder, describe_faults, ellipsoid, load, mesh, sphere)
from .pictures import Summary, picture, render


def _scene_html(scene):
    """A scene in a notebook: what it is, and a picture where it has a file."""
    import base64

    words = f"<p>{', '.join(scene.bodies)}; tools {', '.join(scene.tools)}; {scene.duration:.4g} s</p>"
    if not scene.path:
        return words
    return words + f'<img src="data:image/png;base64,{base64.b64encode(picture(scene, scene.duration / 2)).decode()}">'


Scene._repr_html_ = _scene_html

__all__ = ["Body", "Fixed", "Model", "Part", "Scene", "Simulation", "Summary", "Surface", "Tool", "__version__", "box", "build",
           "capsule", "cylinder", "describe_faults", "ellipsoid", "load", "mesh", "picture", "render",
           "sphere"]
