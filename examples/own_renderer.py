"""A renderer of one's own: the deformed surface from Torsion, drawn by matplotlib.

    python3 own_renderer.py twisted.png
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.tri import Triangulation

import torsion

HALF, RADIUS, DEPTH, TURN = 0.03, 0.02, 3e-3, 0.6
CELLS = 60

pad = torsion.Body("pad", [torsion.box([2 * HALF] * 3)])
pad.youngs_modulus, pad.static_friction, pad.dynamic_friction = 2e4, 2.0, 2.0
pad.fixed = torsion.Fixed.bottom_face
model = torsion.build(torsion.Scene([pad], [torsion.Tool("ball", [torsion.sphere(RADIUS)])]))
simulation = torsion.Simulation(model)

# The upper face as a mesh, as fine as what is to be seen.
line = np.linspace(-HALF, HALF, CELLS + 1)
vertices = np.array([[x, HALF, z] for z in line for x in line])
corner = (np.arange(CELLS)[:, None] * (CELLS + 1) + np.arange(CELLS)).ravel()
triangles = np.concatenate([np.stack([corner, corner + CELLS + 1, corner + 1], axis=1),
                            np.stack([corner + 1, corner + CELLS + 1, corner + CELLS + 2], axis=1)])
surface = torsion.Surface(simulation, vertices, triangles)

for share in np.linspace(0, 1, 300):
    simulation.step([0, HALF + RADIUS - DEPTH * share, 0, 1, 0, 0, 0])
for turn in np.linspace(0, TURN, 600):
    simulation.step([0, HALF + RADIUS - DEPTH, 0, np.cos(turn / 2), 0, np.sin(turn / 2), 0])
surface.update(simulation)

place = surface.positions  # m, (n, 3): a view of Torsion's memory
twist = np.degrees(surface.twist)
figure, (above, side) = plt.subplots(1, 2, figsize=(11, 4.6), width_ratios=[1, 1.15])
drawn = above.tripcolor(Triangulation(1e3 * place[:, 0], 1e3 * place[:, 2], triangles), twist,
                        shading="gouraud", cmap="coolwarm", vmin=-abs(twist).max(), vmax=abs(twist).max())
figure.colorbar(drawn, ax=above, label="twist of the surface (degrees)")
for row in range(0, CELLS + 1, 4):  # lines of the material, which turn with it
    for cells in (place[row * (CELLS + 1):(row + 1) * (CELLS + 1)], place[row::CELLS + 1]):
        above.plot(1e3 * cells[:, 0], 1e3 * cells[:, 2], color="k", linewidth=0.4)
above.set(aspect="equal", xlabel="x (mm)", ylabel="z (mm)", title="from above")
middle = slice(CELLS // 2 * (CELLS + 1), (CELLS // 2 + 1) * (CELLS + 1))
side.plot(1e3 * place[middle, 0], 1e3 * (place[middle, 1] - HALF), color="k")
side.set(xlabel="x (mm)", ylabel="height over the face at rest (mm)", title="cut through the middle")
figure.tight_layout()
figure.savefig(sys.argv[1], dpi=100)
print(f"{sys.argv[1]}: twist up to {abs(twist).max():.1f} degrees of the tool's {np.degrees(TURN):.1f}")
assert 0.5 * np.degrees(TURN) < abs(twist).max() <= 1.01 * np.degrees(TURN)
