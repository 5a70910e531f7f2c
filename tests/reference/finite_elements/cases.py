"""The cases of small strain: body, material, tool and path of each."""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np

import body_mesh
import tools
from contact import Contact
from quarter_body import condense


@dataclass
class Case:
    radius: float  # [m] of the contact, or the shorter half axis: element sizes are shares of it
    depth: float  # [m]
    phi_max: float  # [rad]
    tool: Callable
    mesh: Callable  # element size at the contact [m] -> nodes, triangles, tetrahedra
    outside: Callable  # (n, 3) points -> (n) bool: on the surface that the tool presses
    touches: Callable  # (n, 3) points of it -> (n) bool: may touch
    fixed: Callable  # (n, 3) points -> (n) bool
    youngs_modulus: float = 3e6  # [Pa]
    poisson_ratio: float = 0.4999
    friction: float = 0.75
    pressed_without_friction: bool = False  # as Lubkin's solution has it
    onto: Callable = field(default=lambda points: points)  # the exact surface under the mesh's
    divisions: tuple = (6, 9)  # elements to `radius`, mesh by mesh


def on_plane(points):
    return np.abs(points[:, 2]) < 1e-9


def within(radius):
    return lambda points: np.hypot(points[:, 0], points[:, 1]) < radius


def below(height):
    return lambda points: points[:, 2] < height + 1e-9


def ball_on_block(ball, depth, width, height, *, radius=None, coarse=None, patch=1.35, **keys):
    """A ball on the middle of a block that is held at its bottom; it touches within `patch` times
    `radius` [m]."""
    radius = radius or np.sqrt(ball * depth)
    coarse = coarse or height / 4
    return Case(
        radius, depth, keys.pop("phi_max", 0.1), tools.Ball(ball),
        lambda fine: body_mesh.block(width / 2, height, fine, (patch - 0.15) * radius, coarse),
        on_plane, within(patch * radius), below(-height), **keys)


BALL, DEPTH = 0.05, 4.127e-4  # [m]
CONTACT = np.sqrt(BALL * DEPTH)


def all_cases():
    return {
        # A half-space is out of reach: the block's finite size stiffens it by about 0.1 %.
        "half_space": ball_on_block(BALL, DEPTH, 800 * CONTACT, 400 * CONTACT,
                                    coarse=130 * CONTACT, pressed_without_friction=True,
                                    phi_max=0.2),
        "ball_on_cube_nu30": ball_on_block(BALL, DEPTH, 0.1, 0.1, poisson_ratio=0.3),
        "ball_on_cube_nu49": ball_on_block(BALL, DEPTH, 0.1, 0.1, poisson_ratio=0.49),
    }


PRESSES = 8


def path(case, turns=16):
    """Depth [m] and phi [rad], pose by pose: down, to phi_max, back to -phi_max."""
    down = [(case.depth * (i + 1) / PRESSES, 0.0) for i in range(PRESSES)]
    to = [(case.depth, case.phi_max * (i + 1) / turns) for i in range(turns)]
    fro = [(case.depth, case.phi_max * (1 - (i + 1) / turns)) for i in range(2 * turns)]
    return down + to + fro


def run(case, divisions, report):
    """@param report  called with a line of text now and then
    @return rows (step, depth, phi, force, torque, contact radius), rows (r, twist) at phi_max"""
    fine = case.radius / divisions
    body = condense(case.mesh(fine), case.outside, case.touches, case.fixed, case.youngs_modulus,
                    case.poisson_ratio)
    report(f"{body.unknowns} unknowns, {len(body.contact)} contact nodes")
    contact = Contact(body, case.tool, case.friction, case.youngs_modulus, fine, case.onto)
    rows, twist = [(0, 0.0, 0.0, 0.0, 0.0, 0.0)], None
    for step, (depth, phi) in enumerate(path(case), 1):
        rubs = step > PRESSES or not case.pressed_without_friction
        contact.friction = case.friction if rubs else 0.0
        contact.move(depth, phi)
        rows.append((step, depth, phi, *contact.loads()))
        report("  ".join(f"{value:.5g}" for value in rows[-1])
               + f"  {contact.iterations} iterations")
        if phi == case.phi_max:
            twist = np.stack(contact.twist_along_x(), axis=1)
    if contact.reaches_the_border():
        raise RuntimeError("the contact reaches the border of the patch that may touch")
    return rows, twist
