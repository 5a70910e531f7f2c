"""A force controller of one's own: press with 2 N on a soft pad, keep that while turning by a radian.

    python3 hold_force.py
"""
import numpy as np

import torsion

RADIUS, TOP, WANTED = 0.015, 0.04, 2.0  # m, m, N

pad = torsion.Body("pad", [torsion.box([0.1, 2 * TOP, 0.1])])
pad.youngs_modulus = 5e4
pad.static_friction, pad.dynamic_friction = 0.6, 0.6
pad.fixed = torsion.Fixed.bottom_face
model = torsion.build(torsion.Scene([pad], [torsion.Tool("ball", [torsion.sphere(RADIUS)])]), rate=1000)
simulation = torsion.Simulation(model)
print(f"contact model {model.contact_model()}, body model {model.body_model()}")

depth, turn, force = -1e-4, 0.0, 0.0
forces, couples = [], []
for step in range(3000):
    # Integral control of the depth: the contact's own stiffness says how far an error of force is.
    stiffness = max(simulation.stiffness()[1, 1], 200.0)
    depth += np.clip(0.05 * (WANTED - force) / stiffness, -1e-5, 1e-5)
    if step >= 1000:
        turn += 5e-4
    simulation.step([0.0, TOP + RADIUS - depth, 0.0, np.cos(turn / 2), 0.0, np.sin(turn / 2), 0.0])
    force = simulation.wrench()[1]
    forces.append(force)
    couples.append(simulation.load_parts()["couple"][1])

held = np.array(forces[1000:])
region = simulation.regions()[0]
limit = 3 * np.pi / 16 * 0.6 * region["normal_force"] * region["radius"]  # sliding everywhere
print(f"force while turning {held.min():.4f} to {held.max():.4f} N")
print(f"couple {1e3 * couples[-1]:.3f} mN m; if all slides, {1e3 * limit:.3f}")
assert abs(held - WANTED).max() < 0.01 * WANTED
assert abs(abs(couples[-1]) - limit) < 0.04 * limit  # the radius is that of all cells with pressure
