#!/usr/bin/python3
"""The references' own errors: prints the table of README.md from results/*.csv.

usage: compare.py     the two finest meshes of each case, and the half-space against exact solutions
"""

import re
from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

RESULTS = Path(__file__).parent / "results"
DEPTH, PHI, FORCE, TORQUE, RADIUS = 1, 2, 3, 4, 5


def read(path):
    return np.loadtxt(path, delimiter=",", skiprows=1)


def meshes():
    """Name of a case -> {divisions: path}."""
    found = {}
    for path in sorted(RESULTS.glob("*.csv")):
        match = re.fullmatch(r"(.+)_(\d+)", path.stem)
        if match:
            found.setdefault(match[1], {})[int(match[2])] = path
    return found


def greatest(difference, scale):
    """In percent of the greatest value of `scale`."""
    return 100.0 * np.abs(difference).max() / np.abs(scale).max()


def field_difference(coarse, fine):
    """Greatest difference of the twist where both have it, in percent of phi_max."""
    a, b = (read(path.with_name(path.stem + "_field.csv")) for path in (coarse, fine))
    end = min(a[-1, 0], b[-1, 0])
    radii = np.linspace(max(a[0, 0], b[0, 0]), end, 1000)
    return greatest(np.interp(radii, *a.T) - np.interp(radii, *b.T), b[:, 1])


def sneddon(ball, depth, plane_modulus):
    """Contact radius [m] and force [N] of a sphere (Sneddon 1965)."""
    radius = brentq(lambda a: a / 2 * np.log((ball + a) / (ball - a)) - depth, 1e-9, 0.9 * ball)
    log = np.log((ball + radius) / (ball - radius))
    return radius, plane_modulus * ((radius ** 2 + ball ** 2) / 2 * log - radius * ball)


def lubkin(phi, radius, force, shear_modulus, friction):
    """Torque [N m] of a first loading to phi [rad] (Lubkin 1951, Hertz's pressure)."""
    pressure = 3 * force / (2 * np.pi * radius ** 2)

    def slips_at(share):
        return (friction * pressure / (2 * shear_modulus)
                * (ellipkm1(share ** 2) - ellipe(1 - share ** 2)))

    sticks = brentq(lambda share: slips_at(share) - phi, 1e-12, 1 - 1e-12)
    slipping = quad(lambda share: share ** 2 * slips_at(share), sticks, 1.0)[0]
    return 16 * shear_modulus * radius ** 3 * (phi * sticks ** 3 / 3 + slipping)


def against_half_space(rows, ball=0.05, youngs_modulus=3e6, poisson_ratio=0.4999, friction=0.75):
    """Greatest deviations of force, torque to phi_max and torque on the way back, in percent."""
    down = rows[1:][rows[1:, PHI] == 0.0]
    down = down[:np.argmax(down[:, DEPTH]) + 1]
    exact = np.array([sneddon(ball, depth, youngs_modulus / (1 - poisson_ratio ** 2))
                      for depth in down[:, DEPTH]])
    radius, force = exact[-1]
    turned = rows[len(down) + 1:]
    top = np.argmax(turned[:, PHI])
    contact = (radius, force, youngs_modulus / (2 * (1 + poisson_ratio)), friction)
    to = np.array([lubkin(phi, *contact) for phi in turned[:top + 1, PHI]])
    # Masing's rule for the way back at constant force.
    phi_max = turned[top, PHI]
    fro = np.array([to[-1] - 2 * lubkin((phi_max - phi) / 2, *contact)
                    for phi in turned[top + 1:, PHI]])
    return (greatest(down[:, FORCE] - exact[:, 1], exact[:, 1]),
            greatest(turned[:top + 1, TORQUE] - to, to),
            greatest(turned[top + 1:, TORQUE] - fro, fro))


def main():
    print("Greatest difference of the two finest meshes over the path, in % of the greatest value")
    print("(twist: in % of phi_max)\n")
    print("| case | meshes | force | torque | contact radius | twist |")
    print("|---|---|---|---|---|---|")
    for name, paths in meshes().items():
        if len(paths) < 2:
            continue
        coarse, fine = sorted(paths)[-2:]
        a, b = read(paths[coarse]), read(paths[fine])
        columns = [greatest(a[:, k] - b[:, k], b[:, k]) for k in (FORCE, TORQUE, RADIUS)]
        columns.append(field_difference(paths[coarse], paths[fine]))
        print(f"| {name} | {coarse}, {fine} | " + " | ".join(f"{c:.2f}" for c in columns) + " |")
    print("\nThe half-space against exact solutions: greatest deviation in % of the greatest value\n")
    print("| elements to a radius | force (Sneddon) | torque (Lubkin) | and back (Masing) |")
    print("|---|---|---|---|")
    for divisions, path in sorted(meshes()["half_space"].items()):
        columns = against_half_space(read(path))
        print(f"| {divisions} | " + " | ".join(f"{c:.2f}" for c in columns) + " |")


if __name__ == "__main__":
    main()
