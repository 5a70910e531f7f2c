"""Torsion: forces and torques of rigid tools that press on and twist deformable bodies.

SI units; poses are x, y, z, qw, qx, qy, qz.

    model = torsion.build(torsion.load("scene.gltf"), rate=1000)
    simulation = torsion.Simulation(model)
    trace = simulation.run(poses)          # (steps, tools, 7) -> structured array (steps, tools)
"""
from ._torsion import (Body, Fixed, Model, Part, Scene, Simulation, Surface, Tool, __version__, box, build, capsule,
                       cylinder, describe_faults, ellipsoid, load, mesh, sphere)

__all__ = ["Body", "Fixed", "Model", "Part", "Scene", "Simulation", "Surface", "Tool", "__version__", "box", "build",
           "capsule", "cylinder", "describe_faults", "ellipsoid", "load", "mesh", "sphere"]
