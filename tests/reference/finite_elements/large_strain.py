"""A ball pressed deep into a block and turned, at large strain: neo-Hookean with GetFEM.

Half a turn's mirror does not hold at large strain, but a quarter turn about the axis brings body
and tool onto themselves: so does the solution. A quarter x >= 0, y >= 0 is left, whose face x = 0
moves as its face y = 0 turned by 90 degrees.

Energy per undeformed volume: G/2 (J^(-2/3) |F|^2 - 3) + K/2 (J - 1)^2, with a pressure of its own
for the second term (Taylor-Hood tetrahedra). Tractions are those per undeformed area.
"""

from dataclasses import dataclass
from types import SimpleNamespace

import getfem as gf
import numpy as np
import scipy.sparse as sp
from scipy.optimize import brentq
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

import body_mesh
import tools
from contact import UP, integration_points
from quarter_body import surface_triangles

STIFFNESS = 100.0  # of the penalty, in Young's moduli over an element size
ENERGY = ("G/2*(pow(Det(Id(3)+Grad_u),-2/3)*Norm_sqr(Id(3)+Grad_u)-3)"
          " - p*(Det(Id(3)+Grad_u)-1) - p*p/(2*K)")


@dataclass
class DeepCase:
    ball: float = 0.05  # [m] radius
    depth: float = 0.0125  # [m]
    phi_max: float = 0.5  # [rad]
    width: float = 0.1  # [m] of the block, and its height
    youngs_modulus: float = 3e6  # [Pa]
    poisson_ratio: float = 0.49
    friction: float = 0.75
    presses: int = 8
    turns: int = 8
    divisions: tuple = (4, 6)
    pressed_without_friction: bool = False

    @property
    def radius(self):
        return np.sqrt(self.ball * self.depth)


def about_axis(turn):
    cosine, sine = np.cos(turn), np.sin(turn)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


class Body:
    """The GetFEM model, its unknowns tied and held: full = tie @ free."""

    def __init__(self, case, fine):
        half = case.width / 2
        corners, triangles, tetrahedra = body_mesh.turned_block(
            half, case.width, fine, 1.3 * case.radius, case.width / 5)
        mesh = gf.Mesh("empty", 3)
        mesh.add_convex(gf.GeoTrans("GT_PK(3,1)"), corners[tetrahedra].transpose(2, 1, 0))
        displacement, pressure = gf.MeshFem(mesh, 3), gf.MeshFem(mesh, 1)
        displacement.set_fem(gf.Fem("FEM_PK(3,2)"))
        pressure.set_fem(gf.Fem("FEM_PK(3,1)"))
        modulus, ratio = case.youngs_modulus, case.poisson_ratio
        self.model = model = gf.Model("real")
        model.add_fem_variable("u", displacement)
        model.add_fem_variable("p", pressure)
        model.add_initialized_data("G", [modulus / (2 * (1 + ratio))])
        model.add_initialized_data("K", [modulus / (3 * (1 - 2 * ratio))])
        integration = gf.MeshIm(mesh, gf.Integ("IM_TETRAHEDRON(5)"))
        model.add_nonlinear_term(integration, ENERGY)
        # The model does not keep alive what it is made of.
        self.parts = mesh, displacement, pressure, integration
        self.nodes = displacement.basic_dof_nodes().T[::3]
        first_u, count_u = model.interval_of_variable("u")
        first_p, count_p = model.interval_of_variable("p")
        self.displacements = np.arange(first_u, first_u + count_u)
        self.tie = self.ties(np.arange(first_p, first_p + count_p), pressure.basic_dof_nodes().T,
                             case.width)
        tree = cKDTree(self.nodes)
        on_top = np.abs(corners[:, 2]) < 1e-9
        touches = on_top & (np.hypot(corners[:, 0], corners[:, 1]) < 1.6 * case.radius)
        surface = surface_triangles(corners, triangles, self.nodes, tree, touches)
        self.top = np.abs(self.nodes[:, 2]) < 1e-9
        self.contact = np.unique(surface)
        self.points = integration_points(
            SimpleNamespace(nodes=self.nodes, surface=surface, contact=self.contact),
            lambda points: points)
        columns = self.displacements[(3 * self.contact[:, None] + np.arange(3)).ravel()]
        size = count_u + count_p
        pick = sp.csr_matrix((np.ones(len(columns)), (np.arange(len(columns)), columns)),
                             shape=(len(columns), size))
        self.sample = (self.points.sample @ pick).tocsr()

    def ties(self, pressures, pressure_nodes, height):
        """The face x = 0 follows the face y = 0 turned; the axis does not move sideways."""
        turn = about_axis(np.pi / 2)
        rows, columns, values = [], [], []
        count = 0

        def add(nodes, dofs, rotate, held):
            nonlocal count
            follows = (nodes[:, 0] < 1e-9) & (nodes[:, 1] > 1e-9)
            leader = np.arange(len(nodes))
            distance, leader[follows] = cKDTree(nodes).query(nodes[follows] @ turn)
            if distance.max() > 1e-8:
                raise RuntimeError("the faces x = 0 and y = 0 do not match")
            free = ~held & ~follows[:, None]
            number = np.full(free.shape, -1)
            number[free] = count + np.arange(free.sum())
            count += int(free.sum())
            for component in range(dofs.shape[1]):
                for other in range(dofs.shape[1]):
                    value = np.where(follows, rotate[component, other], float(component == other))
                    target = number[leader, other]
                    used = (value != 0.0) & (target >= 0)
                    rows.append(dofs[used, component])
                    columns.append(target[used])
                    values.append(value[used])

        axis = (self.nodes[:, 0] < 1e-9) & (self.nodes[:, 1] < 1e-9)
        bottom = self.nodes[:, 2] < -height + 1e-9
        held = np.stack([axis | bottom, axis | bottom, bottom], axis=1)
        add(self.nodes, self.displacements.reshape(-1, 3), np.round(turn), held)
        add(pressure_nodes, pressures[:, None], np.eye(1),
            np.zeros((len(pressure_nodes), 1), bool))
        return sp.csr_matrix((np.concatenate(values),
                              (np.concatenate(rows), np.concatenate(columns))),
                             shape=(len(self.displacements) + len(pressures), count))

    def missing(self, unknown):
        """Forces that the body lacks (full)."""
        self.model.to_variables(self.tie @ unknown)
        self.model.assembly("build_rhs")
        return self.model.rhs()

    def tangent(self):
        """Where `missing` was called last (full, sparse)."""
        self.model.assembly("build_matrix")
        matrix = self.model.tangent_matrix()
        matrix.to_csc()
        starts, rows = matrix.csc_ind()
        size = len(starts) - 1
        # The shape said: from the rows that have an entry SciPy would take one row too few where the
        # last has none.
        return sp.csc_matrix((matrix.csc_val(), rows, starts), shape=(size, size))


@dataclass
class State:
    """The last converged state; displacement (n, 3) [m] and friction (n, 3) [Pa] of the points."""
    unknown: np.ndarray
    displacement: np.ndarray
    friction: np.ndarray
    depth: float = 0.0
    phi: float = 0.0


def tractions(case, friction, points, stiffness, state, displacement, pose):
    """@return traction (n, 3) and its part along the surface (n, 3) [Pa], and how the traction falls
    with displacement (n, 3, 3) [Pa/m]"""
    depth, phi = pose
    center = [0.0, 0.0, case.ball]
    gap, normal = tools.Rod(case.ball, center, center)(points.position, displacement, depth, phi)
    pressure = stiffness * np.maximum(0.0, -gap)
    touching = pressure > 0.0
    outer = normal[:, :, None] * normal[:, None, :]
    across = np.eye(3) - outer
    turn = about_axis(phi - state.phi)
    before = points.position + state.displacement
    carried = before @ turn.T - before - (depth - state.depth) * UP
    slipped = displacement - state.displacement - carried
    trial = np.einsum("nij,nj->ni", across, state.friction @ turn.T - stiffness * slipped)
    size = np.maximum(np.linalg.norm(trial, axis=1), 1e-300)
    limit = friction * pressure
    slips = size >= limit
    direction = trial / size[:, None]
    share = np.where(slips, limit / size, 1.0)[:, None]
    shear = share * trial
    sliding = across - slips[:, None, None] * direction[:, :, None] * direction[:, None, :]
    resistance = stiffness * (outer + share[:, None] * sliding)
    # A sliding point's shear follows the pressure.
    resistance += (stiffness * friction * slips)[:, None, None] * (
        direction[:, :, None] * normal[:, None, :])
    resistance[~touching] = 0.0
    shear[~touching] = 0.0
    return pressure[:, None] * normal + shear, shear, resistance


class Deep:
    """Body and ball; `move` brings the ball to the next pose."""

    def __init__(self, case, fine):
        self.case, self.body = case, Body(case, fine)
        self.friction = case.friction
        self.stiffness = STIFFNESS * case.youngs_modulus / fine
        zero = np.zeros_like(self.body.points.position)
        self.state = State(np.zeros(self.body.tie.shape[1]), zero, zero)
        self.traction = zero
        self.iterations = 0

    def balance(self, unknown, pose):
        """@return forces that are missing, their scale [N], the State (both for the free unknowns)
        and the resistance of the points"""
        body = self.body
        displacement = (body.sample @ (body.tie @ unknown)).reshape(-1, 3)
        self.traction, shear, resistance = tractions(
            self.case, self.friction, body.points, self.stiffness, self.state, displacement, pose)
        met = body.sample.T @ (self.traction * body.points.area[:, None]).ravel()
        rest = body.tie.T @ (body.missing(unknown) + met)
        return rest, np.linalg.norm(met), State(unknown, displacement, shear, *pose), resistance

    def step(self, rest, resistance):
        body = self.body
        rows = np.arange(len(resistance) + 1)
        blocks = sp.bsr_matrix((resistance * body.points.area[:, None, None], rows[:-1], rows))
        tangent = body.tangent() + body.sample.T @ blocks @ body.sample
        # Without pivoting as in quarter_body.Factor: a residue of 1e-6 is left, and Newton's next
        # step takes it away.
        factor = splu((body.tie.T @ tangent @ body.tie).tocsc(), permc_spec="MMD_AT_PLUS_A",
                      diag_pivot_thresh=0.0, options={"SymmetricMode": True, "Equil": False})
        return factor.solve(rest)

    def newton(self, pose, tolerance=1e-6):
        """@return the State of equilibrium at pose, or None where Newton's method with a line
        search for the zero of the work does not find it from the last one"""
        unknown = self.state.unknown
        balance = self.balance(unknown, pose)
        for _ in range(40):
            rest, scale, state, resistance = balance
            if np.linalg.norm(rest) <= tolerance * scale:
                return state
            self.iterations += 1
            step = self.step(rest, resistance)

            def work(share):
                value = step @ self.balance(unknown + share * step, pose)[0]
                return value if np.isfinite(value) else -1e300

            share, balance, begin = 1.0, self.balance(unknown + step, pose), step @ rest
            # Where friction makes the tangent lean so much that `begin` is negative, no zero is
            # certain: then the whole step, and in the worst case a shorter way of the ball.
            if begin > 0.0 and not step @ balance[0] >= -0.5 * begin:
                share = max(brentq(work, 0.0, 1.0, xtol=1e-3, rtol=0.1), 1e-3)
                balance = self.balance(unknown + share * step, pose)
            unknown = unknown + share * step
        return None

    def move(self, depth, phi, smallest=1 / 16):
        """In one step, or in shorter ones where that fails."""
        self.iterations = 0
        begin = np.array([self.state.depth, self.state.phi])
        way = np.array([depth, phi]) - begin
        done, part = 0.0, 1.0
        while done < 1.0:
            state = self.newton(tuple(begin + (done + part) * way))
            if state is not None:
                self.state, done = state, done + part
                part = min(part, 1.0 - done)
            elif part > smallest:
                part /= 2
            else:
                raise RuntimeError(f"no equilibrium on the way to depth, phi = {depth, phi}")

    def loads(self):
        """As contact.Contact.loads; the radius is that of the undeformed surface that touches."""
        area = self.body.points.area
        forces = self.traction * area[:, None]
        moment = np.cross(self.body.points.position + self.state.displacement, forces)
        touching = area[self.traction.any(axis=1)].sum()
        return (-4 * forces[:, 2].sum(), 4 * moment[:, 2].sum(), np.sqrt(4 * touching / np.pi))

    def reaches_the_border(self):
        x, y, _ = self.body.points.position[self.traction.any(axis=1)].T
        return bool(np.any(np.hypot(x, y) > 1.3 * self.case.radius))

    def twist_along_x(self):
        """Turn of the points of the undeformed line y = 0: x (n) [m], angle (n) [rad]."""
        body = self.body
        displacement = (body.tie @ self.state.unknown)[body.displacements].reshape(-1, 3)
        x, y, _ = body.nodes.T
        line = np.flatnonzero(body.top & (y < 1e-9) & (x > 1e-9))
        line = line[np.argsort(x[line])]
        return x[line], np.arctan2(displacement[line, 1], x[line] + displacement[line, 0])
