"""Tetrahedral meshes of a quarter body (x >= 0, y >= 0), fine at the contact, made by gmsh.

z points out of the body; the pole that the tool presses is the origin. gmsh runs as a process of
its own and writes a .msh file: it is not linked.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

BLOCK = "Box(1) = {{0, 0, {bottom}, {half_width}, {half_depth}, {height}}};"
# A quarter of an ellipsoid with its top at the origin, cut off at z = bottom, where it is held.
ELLIPSOID = """
Sphere(1) = {{0, 0, 0, 1}};
Dilate {{ {{0, 0, 0}}, {{ {x}, {y}, {z} }} }} {{ Volume{{1}}; }}
Translate {{0, 0, -{z}}} {{ Volume{{1}}; }}
Box(2) = {{0, 0, {bottom}, {x}, {y}, {height}}};
BooleanIntersection(3) = {{ Volume{{1}}; Delete; }}{{ Volume{{2}}; Delete; }};
"""
SIZES = """
{points}
Field[1] = Distance;
Field[1].PointsList = {{{names}}};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = {fine};
Field[2].SizeMax = {coarse};
Field[2].DistMin = {radius};
Field[2].DistMax = {reach};
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
Mesh.Optimize = 1;
Mesh.SaveAll = 1;
Mesh.MshFileVersion = 2.2;
"""


def read_msh(path):
    """Nodes (n, 3) [m], triangles (m, 3) and tetrahedra (k, 4) of a .msh file of version 2.2."""
    lines = iter(Path(path).read_text().splitlines())
    triangles, tetrahedra = [], []
    for line in lines:
        if line == "$Nodes":
            rows = [next(lines).split() for _ in range(int(next(lines)))]
            nodes = np.array([row[1:] for row in rows], float)
            row_of = {row[0]: i for i, row in enumerate(rows)}
        elif line == "$Elements":
            for _ in range(int(next(lines))):
                words = next(lines).split()
                corners = words[3 + int(words[2]):]
                if words[1] in ("2", "4"):
                    (triangles if words[1] == "2" else tetrahedra).append(
                        [row_of[c] for c in corners])
    triangles, tetrahedra = np.array(triangles), np.array(tetrahedra)
    # Points that only steer the mesh size belong to no element.
    used = np.unique(tetrahedra)
    renumber = np.full(len(nodes), -1)
    renumber[used] = np.arange(len(used))
    return nodes[used], renumber[triangles], renumber[tetrahedra]


def make(shape, centers, fine, radius, coarse, growth=0.35):
    """@param shape    gmsh commands that make one volume
    @param centers  (n, 3) where it is fine [m]
    @param fine     element size [m] within `radius` [m] of a centre; it grows by `growth` a metre
                    outwards up to `coarse` [m]
    @return as read_msh"""
    names = range(1000, 1000 + len(centers))
    points = "\n".join(f"Point({name}) = {{ {x}, {y}, {z} }};"
                       for name, (x, y, z) in zip(names, centers))
    text = 'SetFactory("OpenCASCADE");\n' + shape + SIZES.format(
        points=points, names=", ".join(map(str, names)), fine=fine, coarse=coarse, radius=radius,
        reach=radius + (coarse - fine) / growth)
    with tempfile.TemporaryDirectory() as folder:
        geometry, mesh = Path(folder) / "body.geo", Path(folder) / "body.msh"
        geometry.write_text(text)
        run = subprocess.run(["gmsh", "-3", "-v", "2", str(geometry), "-o", str(mesh)],
                             capture_output=True, text=True)
        if run.returncode != 0 or not mesh.exists():
            raise RuntimeError("gmsh made no mesh:\n" + run.stdout + run.stderr)
        return read_msh(mesh)


def block(half_width, half_depth, height, fine, radius, coarse, growth=0.35):
    """A block of sides 2 half_width and 2 half_depth [m], along x and y, under z = 0; see make."""
    shape = BLOCK.format(bottom=-height, half_width=half_width, half_depth=half_depth,
                         height=height)
    return make(shape, [(0.0, 0.0, 0.0)], fine, radius, coarse, growth)


def turned_block(half_width, height, fine, radius, coarse, growth=0.35):
    """As block; the mesh of its face x = 0 is that of its face y = 0 turned about z."""
    shape = (BLOCK.format(bottom=-height, half_width=half_width, half_depth=half_width,
                          height=height)
             + "\nPeriodic Surface {1} = {3} Rotate {{0, 0, 1}, {0, 0, 0}, Pi / 2};\n")
    return make(shape, [(0.0, 0.0, 0.0)], fine, radius, coarse, growth)


def ellipsoid(half_axes, height, centers, fine, radius, coarse, growth=0.35):
    """An ellipsoid with its top at the origin, cut off `height` [m] below it; see make."""
    x, y, z = half_axes
    shape = ELLIPSOID.format(x=x, y=y, z=z, bottom=-height, height=height)
    return make(shape, centers, fine, radius, coarse, growth)
