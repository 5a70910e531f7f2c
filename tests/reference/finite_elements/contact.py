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


def integration_points(body):
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
    return Points(position, np.outer(area, weights).ravel(), sp.kron(scalar, sp.eye(3)).tocsr())


@dataclass
class Side:
    """The last converged state of one of the two sides; displacement and traction on the body."""
    sign: float
    displacement: np.ndarray  # (n, 3) [m]
    traction: np.ndarray  # (n, 3) [Pa]
    friction: np.ndarray  # (n, 3) [Pa], the part of it along the surface


def evaluate(side, points, displacement, tool, pose, last_phi, friction, stiffness):
    """Tractions on the body for trial displacements of the points.

    @param pose  depth [m] and phi [rad] of the tool
    @return a Side, the resistance -d traction / d displacement (n, 3, 3) [Pa/m]"""
    depth, phi = pose
    gap, normal = tool(points.position, displacement, depth, side.sign * phi)
    pressure = stiffness * np.maximum(0.0, -gap)
    touching = pressure > 0.0
    across = np.eye(3) - normal[:, :, None] * normal[:, None, :]
    carried = side.sign * (phi - last_phi) * np.cross(UP, points.position)
    slipped = displacement - side.displacement - carried
    trial = np.einsum("nij,nj->ni", across, side.friction - stiffness * slipped)
    size = np.linalg.norm(trial, axis=1)
    slips = size > friction * pressure
    direction = trial / np.maximum(size, 1e-300)[:, None]
    shear = np.where(slips[:, None], friction * pressure[:, None] * direction, trial)
    shear[~touching] = 0.0

    both = normal[:, :, None] * normal[:, None, :]
    sticking = both + across
    share = (friction * pressure / np.maximum(size, 1e-300))[:, None, None]
    sliding = both + friction * direction[:, :, None] * normal[:, None, :] + share * (
        across - direction[:, :, None] * direction[:, None, :])
    resistance = stiffness * np.where(slips[:, None, None], sliding, sticking)
    resistance[~touching] = 0.0
    return (Side(side.sign, displacement, pressure[:, None] * normal + shear, shear), resistance)


class Contact:
    """A body with the tool against it; `move` brings the tool to the next pose."""

    def __init__(self, body, tool, friction, youngs_modulus, element_size):
        self.body, self.tool, self.friction = body, tool, friction
        self.stiffness = STIFFNESS * youngs_modulus / element_size
        self.points = integration_points(body)
        zero = np.zeros_like(self.points.position)
        self.sides = [Side(sign, zero, zero, zero) for sign in (1.0, -1.0)]
        self.phi = 0.0
        self.even, self.odd = body.free["even"], body.free["odd"]
        self.unknown = np.zeros(len(self.even) + len(self.odd))
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

    def trial(self, unknown, pose):
        """Sides, forces on the unknowns and their resistance (sparse) for trial unknowns."""
        sample, area = self.points.sample, self.points.area
        sides, forces, blocks = [], [], []
        for side, nodal in zip(self.sides, self.side_displacements(unknown)):
            new, resistance = evaluate(side, self.points, (sample @ nodal).reshape(-1, 3),
                                       self.tool, pose, self.phi, self.friction, self.stiffness)
            weighted = sp.bsr_matrix((resistance * area[:, None, None], np.arange(len(area)),
                                      np.arange(len(area) + 1)))
            sides.append(new)
            forces.append(sample.T @ (new.traction * area[:, None]).ravel())
            blocks.append((sample.T @ weighted @ sample).tocsr())
        # The quarter's even and odd parts each carry half of what acts on the two sides.
        total, rest = 0.5 * (forces[0] + forces[1]), 0.5 * (forces[0] - forces[1])
        mean, half = 0.5 * (blocks[0] + blocks[1]), 0.5 * (blocks[0] - blocks[1])
        resistance = sp.bmat([[mean[self.even][:, self.even], half[self.even][:, self.odd]],
                              [half[self.odd][:, self.even], mean[self.odd][:, self.odd]]])
        return sides, np.concatenate([total[self.even], rest[self.odd]]), resistance.tocsr()

    def newton_step(self, residual, resistance):
        """Solves (1 + C K) step = -residual; only unknowns that meet the tool are in the matrix."""
        active = np.flatnonzero(np.diff(resistance.indptr))
        if len(active) == 0:
            return -residual
        split = np.searchsorted(active, len(self.even))
        parts = (active[:split], active[split:] - len(self.even))
        local = resistance[active][:, active]
        small = np.eye(len(active))
        for rows, place in zip(parts, (slice(0, split), slice(split, None))):
            compliance = self.body.compliance["even" if place.start == 0 else "odd"]
            small[place] += (local[place].T @ compliance[np.ix_(rows, rows)].T).T
        step = np.linalg.solve(small, -residual[active])
        forces = np.zeros(len(residual))
        forces[active] = local @ step
        return -residual - self.compliant(forces)

    def move(self, depth, phi, tolerance=1e-7, most=60):
        pose = (depth, phi)
        unknown = self.unknown
        # A predictor that sticks everywhere: from it only the ring that slips has to be found.
        friction, self.friction = self.friction, min(self.friction, 1.0) * 1e6
        sides, force, resistance = self.trial(unknown, pose)
        self.friction = friction
        residual = unknown - self.compliant(force)
        for self.iterations in range(1, most + 1):
            step = self.newton_step(residual, resistance)
            share, before = 1.0, np.linalg.norm(residual)
            while True:
                new = unknown + share * step
                sides, force, resistance = self.trial(new, pose)
                residual = new - self.compliant(force)
                if np.linalg.norm(residual) < before or share < 2:
                    break
                share *= 0.5
            unknown = new
            if globals().get("DEBUG"): print(self.iterations, share, before, np.linalg.norm(residual), [int((np.abs(s.traction).sum(1)>0).sum()) for s in sides])
            if np.linalg.norm(residual) < tolerance * np.linalg.norm(unknown):
                break
        else:
            raise RuntimeError(f"no convergence at depth {depth} m, phi {phi} rad")
        self.unknown, self.sides, self.phi = unknown, sides, phi

    def loads(self):
        """Force the body bears [N], torque that turns it [N m], radius of a disc of the area [m]."""
        force = torque = area = 0.0
        for side in self.sides:
            traction = side.traction * self.points.area[:, None]
            moment = np.cross(self.points.position + self.tool.moved * side.displacement, traction)
            force -= 2.0 * traction[:, 2].sum()
            torque += 2.0 * side.sign * moment[:, 2].sum()
            area += 2.0 * self.points.area[np.any(side.traction != 0.0, axis=1)].sum()
        return force, torque, np.sqrt(area / np.pi)

    def twist_along_x(self):
        """Turn of the surface about z along the x axis: x (n) [m], u_y / x (n) [rad]."""
        force = np.zeros(3 * len(self.body.contact))
        for side in self.sides:
            force += 0.5 * side.sign * (
                self.points.sample.T @ (side.traction * self.points.area[:, None]).ravel())
        displacement = self.body.solve["odd"](force)
        x, y, _ = self.body.nodes.T
        line = self.body.on_surface & (y < 1e-9) & (x > 1e-9)
        order = np.argsort(x[line])
        return x[line][order], (displacement[line, 1] / x[line])[order]
