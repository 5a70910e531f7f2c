"""Coulomb friction with history between a rigid tool and a condensed quarter body.

Contact is held by penalties at the integration points of the contact surface: 12 on a quadratic
triangle, whose displacements can follow the tool's surface exactly. With the penalty of
`STIFFNESS` Young's moduli over an element size the body sinks into the tool by less than 0.1 % of
the depth, and creeps while it sticks by as little.

The point (-x, y) of the body is treated in its mirror image: there the tool turns the other way.
So a quarter has two sides, `+` and `-`, with even +- odd displacements and turns of +-phi.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.optimize import brentq

STIFFNESS = 300.0
UP = np.array([0.0, 0.0, 1.0])

# Dunavant's rule of degree 6 (1985): orbits of points with their weights.
ORBITS = ((0.116786275726379, (0.501426509658179, 0.249286745170910, 0.249286745170910)),
          (0.050844906370207, (0.873821971016996, 0.063089014491502, 0.063089014491502)),
          (0.082851075618374, (0.053145049844817, 0.310352451033784, 0.636502499121399)))


def quadrature():
    """Weights (12) that sum to 1 and barycentric coordinates (12, 3)."""
    points, weights = [], []
    for weight, (a, b, c) in ORBITS:
        turned = {(a, b, c), (b, c, a), (c, a, b), (a, c, b), (c, b, a), (b, a, c)}
        points += sorted(turned)
        weights += [weight] * len(turned)
    return np.array(weights), np.array(points)


def shape_functions(barycentric):
    """Of the quadratic triangle, corners then middles of the edges 01, 12, 20: (points, 6)."""
    corner = barycentric * (2 * barycentric - 1)
    return np.hstack([corner, 4 * barycentric * np.roll(barycentric, -1, axis=1)])


@dataclass
class Points:
    """Integration points of the contact surface."""
    position: np.ndarray  # (n, 3) [m]
    area: np.ndarray  # (n) [m^2]
    sample: sp.csr_matrix  # (3 n, 3 c): contact displacements -> displacements of the points


def integration_points(body, onto):
    weights, barycentric = quadrature()
    functions = shape_functions(barycentric)
    corners = body.nodes[body.surface[:, :3]]
    position = np.einsum("qk,tkd->tqd", barycentric, corners).reshape(-1, 3)
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0],
                                         corners[:, 2] - corners[:, 0]), axis=1)
    rows_of = np.searchsorted(body.contact, body.surface)
    point = np.arange(len(position)).reshape(len(area), -1, 1)
    shape = (len(area), len(weights), 6)
    scalar = sp.csr_matrix((np.broadcast_to(functions, shape).ravel(),
                            (np.broadcast_to(point, shape).ravel(),
                             np.broadcast_to(rows_of[:, None], shape).ravel())),
                           shape=(len(position), len(body.contact)))
    position = onto(position)
    return Points(position, np.outer(area, weights).ravel(), sp.kron(scalar, sp.eye(3)).tocsr())


@dataclass
class Side:
    """The last converged state of one of the two sides; displacement and traction on the body."""
    sign: float
    displacement: np.ndarray  # (n, 3) [m]
    traction: np.ndarray  # (n, 3) [Pa]
    friction: np.ndarray  # (n, 3) [Pa], the part of it along the surface


def evaluate(side, points, displacement, tool, pose, last_pose, limit, stiffness):
    """Tractions on the body for trial displacements of the points.

    @param pose   depth [m] and phi [rad] of the tool; last_pose: those of the converged state
    @param limit  (n) the greatest shear traction [Pa]
    @return a Side, the resistance -d traction / d displacement (n, 3, 3) [Pa/m]"""
    depth, phi = pose
    gap, normal = tool(points.position, displacement, depth, side.sign * phi)
    pressure = stiffness * np.maximum(0.0, -gap)
    touching = pressure > 0.0
    across = np.eye(3) - normal[:, :, None] * normal[:, None, :]
    turn = side.sign * (phi - last_pose[1])
    carried = turn * np.cross(UP, points.position) - (depth - last_pose[0]) * UP
    slipped = displacement - side.displacement - carried
    trial = np.einsum("nij,nj->ni", across, side.friction - stiffness * slipped)
    size = np.linalg.norm(trial, axis=1)
    slips = size >= limit
    direction = trial / np.maximum(size, 1e-300)[:, None]
    share = np.where(slips, limit / np.maximum(size, 1e-300), 1.0)[:, None]
    shear = share * trial

    # A point that opens keeps its shear until `limit` follows: were it dropped at once, the energy
    # would have a step and Newton's method could stop there.
    sliding = across - slips[:, None, None] * direction[:, :, None] * direction[:, None, :]
    pushes = touching[:, None, None] * normal[:, :, None] * normal[:, None, :]
    resistance = stiffness * (pushes + share[:, None] * sliding)
    return (Side(side.sign, displacement, pressure[:, None] * normal + shear, shear), resistance)


class Contact:
    """A body with the tool against it; `move` brings the tool to the next pose."""

    def __init__(self, body, tool, friction, youngs_modulus, element_size, onto):
        self.body, self.tool, self.friction = body, tool, friction
        self.stiffness = STIFFNESS * youngs_modulus / element_size
        self.points = integration_points(body, onto)
        zero = np.zeros_like(self.points.position)
        self.sides = [Side(sign, zero, zero, zero) for sign in (1.0, -1.0)]
        self.pose = (0.0, 0.0)
        self.even, self.odd = body.free["even"], body.free["odd"]
        self.unknown = np.zeros(len(self.even) + len(self.odd))
        self.force = np.zeros_like(self.unknown)
        self.iterations = 0

    def side_displacements(self, unknown):
        """Of the contact nodes (3 c), on the sides + and -."""
        even, odd = np.zeros((2, 3 * len(self.body.contact)))
        even[self.even], odd[self.odd] = unknown[:len(self.even)], unknown[len(self.even):]
        return even + odd, even - odd

    def compliant(self, force):
        """Displacements of the unknowns under forces on them; forces as a vector or in columns."""
        count = len(self.even)
        return np.concatenate([self.body.compliance["even"] @ force[:count],
                               self.body.compliance["odd"] @ force[count:]])

    def trial(self, unknown, pose, limits):
        """The two sides for trial unknowns, the forces on the unknowns and their resistance."""
        sample, area = self.points.sample, self.points.area
        sides, forces, blocks = [], [], []
        for side, limit, nodal in zip(self.sides, limits, self.side_displacements(unknown)):
            new, resistance = evaluate(side, self.points, (sample @ nodal).reshape(-1, 3),
                                       self.tool, pose, self.pose, limit, self.stiffness)
            sides.append(new)
            forces.append(sample.T @ (new.traction * area[:, None]).ravel())
            blocks.append(resistance * area[:, None, None])
        # The quarter's even and odd parts each carry half of what acts on the two sides.
        total, rest = 0.5 * (forces[0] + forces[1]), 0.5 * (forces[0] - forces[1])
        return sides, np.concatenate([total[self.even], rest[self.odd]]), blocks

    def assemble(self, blocks):
        """The resistance of the unknowns (sparse) from the blocks that trial gives."""
        sample = self.points.sample
        rows = np.arange(len(self.points.area) + 1)
        plus, minus = (sample.T @ sp.bsr_matrix((block, rows[:-1], rows)) @ sample
                       for block in blocks)
        mean, half = (0.5 * (plus + minus)).tocsr(), (0.5 * (plus - minus)).tocsr()
        matrix = sp.bmat([[mean[self.even][:, self.even], half[self.even][:, self.odd]],
                          [half[self.odd][:, self.even], mean[self.odd][:, self.odd]]]).tocsr()
        matrix.eliminate_zeros()
        return matrix

    def newton_step(self, missing, resistance):
        """Steps of the unknowns and of the forces on them that bring `missing` forces [N] in:
        step = C change, change = missing - K step. Only what meets the tool is in the matrix."""
        active = np.flatnonzero(np.diff(resistance.indptr))
        free_step = self.compliant(missing)
        if len(active) == 0:
            return free_step, missing
        split = np.searchsorted(active, len(self.even))
        local = resistance[active][:, active]
        small = np.eye(len(active))
        for parity, place, first in (("even", slice(0, split), 0),
                                     ("odd", slice(split, None), len(self.even))):
            rows = active[place] - first
            compliance = self.body.compliance[parity][np.ix_(rows, rows)]
            small[place] += (local[place].T @ compliance).T
        change = missing.copy()
        change[active] -= local @ np.linalg.solve(small, free_step[active])
        return self.compliant(change), change

    def solve(self, pose, limits, tolerance):
        """The equilibrium for given limits of the shear: the minimum of a convex energy, by
        Newton's method with a line search for the zero of its slope. Starts from self.unknown
        and self.force, which obey unknown = C force."""
        for iteration in range(60):
            sides, met, blocks = self.trial(self.unknown, pose, limits)
            missing = met - self.force
            if np.linalg.norm(missing) <= tolerance * np.linalg.norm(met):
                return sides
            self.iterations += 1
            step, change = self.newton_step(missing, self.assemble(blocks))

            def slope(share):
                met = self.trial(self.unknown + share * step, pose, limits)[1]
                return step @ (self.force + share * change - met)

            share = 1.0
            begin, end = slope(0.0), slope(1.0)
            if end > -0.5 * begin:
                share = brentq(slope, 0.0, 1.0, rtol=0.1)
            self.unknown = self.unknown + share * step
            self.force = self.force + share * change
        raise RuntimeError(f"no equilibrium at depth, phi = {pose}")

    def move(self, depth, phi, tolerance=1e-6):
        """Coulomb's law by fixed point: the shear is limited by the pressure found before."""
        pose = (depth, phi)
        self.iterations = 0
        sides = self.sides
        limits = None
        for _ in range(40):
            pressed = [np.linalg.norm(side.traction - side.friction, axis=1) for side in sides]
            before, limits = limits, [self.friction * pressure for pressure in pressed]
            if before is not None and np.linalg.norm(np.subtract(limits, before)) <= (
                    10 * tolerance * np.linalg.norm(limits)):
                self.sides, self.pose = sides, pose
                return
            sides = self.solve(pose, limits, tolerance)
        raise RuntimeError(f"no fixed point of the friction at depth, phi = {pose}")

    def loads(self):
        """Force the body bears [N], torque that turns it [N m], radius of a disc as large [m]."""
        force = torque = area = 0.0
        for side in self.sides:
            traction = side.traction * self.points.area[:, None]
            moment = np.cross(self.points.position + self.tool.moved * side.displacement, traction)
            force -= 2.0 * traction[:, 2].sum()
            torque += 2.0 * side.sign * moment[:, 2].sum()
            area += 2.0 * self.points.area[np.any(side.traction != 0.0, axis=1)].sum()
        return force, torque, np.sqrt(area / np.pi)

    def reaches_the_border(self):
        """Whether the contact may have wanted to grow beyond the triangles that may touch."""
        edges = np.sort(self.body.surface[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        kinds, first, count = np.unique(edges, axis=0, return_index=True, return_counts=True)
        x, y, _ = self.body.nodes.T
        inner = ((x[kinds] < 1e-9).all(axis=1)) | ((y[kinds] < 1e-9).all(axis=1))
        triangles = np.unique(first[(count == 1) & ~inner] // 3)
        size = len(self.points.area) // len(self.body.surface)
        return any(side.traction.reshape(-1, size, 3)[triangles].any() for side in self.sides)

    def twist_along_x(self):
        """Turn of the surface about z along the x axis: x (n) [m], u_y / x (n) [rad]."""
        force = np.zeros(3 * len(self.body.contact))
        for side in self.sides:
            force += 0.5 * side.sign * (
                self.points.sample.T @ (side.traction * self.points.area[:, None]).ravel())
        displacement = self.body.solve_odd(force)
        x, y, _ = self.body.nodes.T
        line = self.body.on_surface & (y < 1e-9) & (x > 1e-9)
        order = np.argsort(x[line])
        return x[line][order], (displacement[line, 1] / x[line])[order]
