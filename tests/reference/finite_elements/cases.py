"""The cases: body, material, tool and path of each."""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np
from scipy.optimize import brentq

import body_mesh
import tools
from contact import Contact
from large_strain import Deep, DeepCase
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
    presses: int = 8  # steps down
    turns: int = 16  # steps to phi_max; twice as many back


def on_plane(points):
    return np.abs(points[:, 2]) < 1e-9


def within(radius):
    return lambda points: np.hypot(points[:, 0], points[:, 1]) < radius


def below(height):
    return lambda points: points[:, 2] < height + 1e-9


def ball_on_block(ball, depth, width, height, *, across=None, radius=None, coarse=None, patch=1.35,
                  **keys):
    """A ball on the middle of a block that is held at its bottom; it touches within `patch` times
    `radius` [m]. `across` [m]: its other width."""
    radius = radius or np.sqrt(ball * depth)
    coarse = coarse or height / 4
    half_depth = (across or width) / 2
    return Case(
        radius, depth, keys.pop("phi_max", 0.1), tools.Ball(ball),
        lambda fine: body_mesh.block(width / 2, half_depth, height, fine, (patch - 0.15) * radius,
                                     coarse),
        on_plane, within(patch * radius), below(-height), **keys)


@dataclass
class Ellipsoid:
    """With its top at the origin; what is more than `height` [m] below that is held."""
    half_axes: tuple  # [m]
    height: float

    def top(self, x, y):
        return self.half_axes[2] * (np.sqrt(1 - (x / self.half_axes[0]) ** 2
                                            - (y / self.half_axes[1]) ** 2) - 1)

    def onto(self, points):
        """Points near the upper half, moved along z onto it."""
        return np.column_stack([points[:, :2], self.top(points[:, 0], points[:, 1])])

    def holds(self, points):
        x, y, z = (points / self.half_axes).T
        return np.abs(x ** 2 + y ** 2 + (z + 1) ** 2 - 1) < 1e-6

    def case(self, radius, depth, tool, centers, reach, touches, **keys):
        """@param centers, reach  it is fine within `reach` [m] of the points (n, 2) `centers`"""
        fine_at = self.onto(np.array(centers))
        return Case(radius, depth, keys.pop("phi_max"), tool,
                    lambda fine: body_mesh.ellipsoid(self.half_axes, self.height, fine_at, fine,
                                                     reach, 0.012),
                    self.holds, touches, below(-self.height), onto=self.onto, **keys)


# The body of the scenes mallet_on_ellipsoid and compass_on_ellipsoid: there y is up. Their lowest
# point cannot hold a continuum, so its lowest tenth is held.
ELLIPSOID = Ellipsoid((0.07, 0.06, 0.05), 0.09)


def mallet_on_ellipsoid(depth=5e-4, long=0.0077, short=0.0019):
    """The scene's lying capsule, radius 15 mm. `long` and `short` [m] are the contact's half axes
    by Hertz."""
    radius, half_length = 0.015, 0.02
    rod = tools.Rod(radius, (-half_length, 0, radius), (half_length, 0, radius))
    return ELLIPSOID.case(
        short, depth, rod, [(x, 0) for x in np.linspace(0, 1.1 * long, 12)], 1.6 * short,
        lambda points: np.hypot(points[:, 0] / (1.3 * long), points[:, 1] / (1.9 * short)) < 1,
        phi_max=0.1, divisions=(3, 4))


def compass_on_ellipsoid(depth=2e-4, phi_max=0.02):
    """The scene's two feet: round tips of 4 mm radius on legs that lean inwards by 15 degrees and
    end 22 mm from the axis. Depth counts from where they touch."""
    tip, lean = 0.004, np.radians(15)
    foot = 0.022 - tip * np.sin(lean)
    # Where the tip's centre is when it just touches: off the surface by its radius.
    x = brentq(lambda x: x - foot + tip * slope_part(x), 0.0, 0.05)
    normal = np.array([slope_part(x), np.sqrt(1 - slope_part(x) ** 2)])
    center = np.array([x, ELLIPSOID.top(x, 0.0)]) + tip * normal
    ball = tools.Rod(tip, (foot, 0, center[1]), (foot, 0, center[1]))
    contact, way = np.sqrt(tip * depth), foot * phi_max
    return ELLIPSOID.case(
        contact, depth, ball, [(x, y) for y in np.linspace(0, way, 4)], 1.2 * contact,
        lambda points: np.hypot(points[:, 0] - x, points[:, 1] - np.clip(points[:, 1], 0, way))
        < 1.45 * contact,
        phi_max=phi_max, divisions=(4, 6))


def slope_part(x):
    """The x component of the ellipsoid's normal at (x, 0)."""
    wide, _, high = ELLIPSOID.half_axes
    normal = np.array([x / wide ** 2, np.sqrt(1 - (x / wide) ** 2) / high])
    return normal[0] / np.linalg.norm(normal)


BALL, DEPTH = 0.05, 4.127e-4  # [m]
CONTACT = np.sqrt(BALL * DEPTH)
COLUMN = 0.05  # [m] side and height


def all_cases():
    return {
        # A half-space is out of reach: the held bottom stiffens the block by about
        # 1.1 / 4000 (the first term for a layer by Dimitriadis et al., 2002).
        "half_space": ball_on_block(BALL, DEPTH, 8000 * CONTACT, 4000 * CONTACT,
                                    coarse=1300 * CONTACT, pressed_without_friction=True,
                                    phi_max=0.2),
        "ball_on_cube_nu30": ball_on_block(BALL, DEPTH, 0.1, 0.1, poisson_ratio=0.3),
        "ball_on_cube_nu49": ball_on_block(BALL, DEPTH, 0.1, 0.1, poisson_ratio=0.49),
        "thin_layer": ball_on_block(BALL, DEPTH, 24 * CONTACT, 2 * CONTACT, coarse=CONTACT,
                                    radius=1.2 * CONTACT, patch=1.5),
        # Deep enough for a contact radius of 0.4 of the side.
        "soft_column": ball_on_block(0.2, 2.4e-3, COLUMN, COLUMN, youngs_modulus=1e4, friction=5.0,
                                     radius=0.4 * COLUMN, patch=1.5, coarse=COLUMN / 8),
        # Twelve times as high as wide: most of the depth is the column's own, and half of the turn. Pressed
        # by half of what would buckle it (Euler: 84 mN).
        "slender_column": ball_on_block(0.008, 1.0e-4, 0.008, 0.1, youngs_modulus=1e6,
                                        poisson_ratio=0.3, friction=0.5, radius=0.63e-3,
                                        coarse=0.002),
        # A wall pressed on its narrow upper side, as a tube's rim is.
        "plate_on_edge": ball_on_block(0.0036, 4e-4, 0.006, 0.06, across=0.06, youngs_modulus=1e6,
                                       poisson_ratio=0.3, friction=0.5, coarse=0.003),
        "mallet_on_ellipsoid": mallet_on_ellipsoid(),
        "compass_on_ellipsoid": compass_on_ellipsoid(),
        "large_strain": DeepCase(),
        # What linear elasticity makes of the same.
        "large_strain_linear": ball_on_block(DeepCase.ball, DeepCase.depth, DeepCase.width,
                                             DeepCase.width, poisson_ratio=DeepCase.poisson_ratio,
                                             phi_max=DeepCase.phi_max),
    }


def path(case):
    """Depth [m] and phi [rad], pose by pose: down, to phi_max, back to -phi_max."""
    down = [(case.depth * (i + 1) / case.presses, 0.0) for i in range(case.presses)]
    to = [(case.depth, case.phi_max * (i + 1) / case.turns) for i in range(case.turns)]
    fro = [(case.depth, case.phi_max * (1 - (i + 1) / case.turns)) for i in range(2 * case.turns)]
    return down + to + fro


def begin(case, fine, report):
    """Body and tool before they touch, with elements of size `fine` [m] at the contact."""
    if isinstance(case, DeepCase):
        deep = Deep(case, fine)
        report(f"{deep.body.tie.shape[1]} unknowns, {len(deep.body.contact)} contact nodes")
        return deep
    body = condense(case.mesh(fine), case.outside, case.touches, case.fixed, case.youngs_modulus,
                    case.poisson_ratio)
    report(f"{body.unknowns} unknowns, {len(body.contact)} contact nodes")
    return Contact(body, case.tool, case.friction, case.youngs_modulus, fine, case.onto)


def run(case, divisions, report):
    """@param report  called with a line of text now and then
    @return rows (step, depth, phi, force, torque, contact radius), rows (r, twist) at phi_max"""
    contact = begin(case, case.radius / divisions, report)
    rows, twist = [(0, 0.0, 0.0, 0.0, 0.0, 0.0)], None
    for step, (depth, phi) in enumerate(path(case), 1):
        rubs = step > case.presses or not case.pressed_without_friction
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
