"""A linear elastic body with two mirror planes, condensed onto its contact surface with GetFEM.

All bodies and tools here are mirror images of themselves in x = 0 and in y = 0. Pressing keeps
both mirrors; turning about z reverses under each of them. So a solution is the sum of a part that
is even in both mirrors and one that is odd in both, and each of them lives on a quarter of the
body with its own conditions on the mirror planes. That is exact (linear elasticity, small
strains), also under friction, because only the body is split: the contact law sees the sum.

Elements: Taylor-Hood tetrahedra (quadratic displacement u, linear continuous pressure p), which
do not lock up to nu = 0.5.
"""

from dataclasses import dataclass
from typing import Callable

import getfem as gf
import numpy as np
import scipy.sparse as sp
from scipy.linalg import solve_triangular
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

PARITIES = ("even", "odd")
FORM = ("2*G*(Sym(Grad_u):Grad_Test_u) - p*Trace(Grad_Test_u) - Test_p*Trace(Grad_u)"
        " - p*Test_p/lambda")


@dataclass
class QuarterBody:
    nodes: np.ndarray  # (n, 3) [m] of the displacement
    surface: np.ndarray  # (s, 6) rows of `nodes`: triangles that may touch, corners then edges
    contact: np.ndarray  # (c) rows of `nodes` on them
    on_surface: np.ndarray  # (n) bool: on the surface that the tool presses, touching or not
    free: dict  # parity -> rows of the 3 c contact displacements that are not held
    compliance: dict  # parity -> (free, free) [m/N] of the quarter
    solve_odd: Callable  # odd forces (3 c) [N] -> displacements (n, 3) [m]
    unknowns: int  # of the larger of the two systems


def assemble(nodes, tetrahedra, shear_modulus, poisson_ratio):
    """The stiffness of the whole quarter with nothing held.

    @return matrix, node of every displacement (n, 3), node of every pressure (m, 3); unknowns are
    the displacements, three a node, then the pressures"""
    mesh = gf.Mesh("empty", 3)
    mesh.add_convex(gf.GeoTrans("GT_PK(3,1)"), nodes[tetrahedra].transpose(2, 1, 0))
    displacement, pressure = gf.MeshFem(mesh, 3), gf.MeshFem(mesh, 1)
    displacement.set_fem(gf.Fem("FEM_PK(3,2)"))
    pressure.set_fem(gf.Fem("FEM_PK(3,1)"))
    model = gf.Model("real")
    model.add_fem_variable("u", displacement)
    model.add_fem_variable("p", pressure)
    model.add_initialized_data("G", [shear_modulus])
    model.add_initialized_data("lambda",
                               [2 * shear_modulus * poisson_ratio / (1 - 2 * poisson_ratio)])
    model.add_linear_term(gf.MeshIm(mesh, gf.Integ("IM_TETRAHEDRON(3)")), FORM)
    model.assembly("build_matrix")
    tangent = model.tangent_matrix()
    tangent.to_csc()
    starts, rows = tangent.csc_ind()
    matrix = sp.csc_matrix((tangent.csc_val(), rows, starts))
    first_u, count_u = model.interval_of_variable("u")
    first_p, count_p = model.interval_of_variable("p")
    order = np.r_[first_u:first_u + count_u, first_p:first_p + count_p]
    return (matrix[order][:, order], displacement.basic_dof_nodes().T[::3],
            pressure.basic_dof_nodes().T)


def held_on_mirrors(points, parity, tolerance):
    """(n, 3) displacement components and (n) pressures that are zero on the mirror planes."""
    on_x, on_y = points[:, 0] < tolerance, points[:, 1] < tolerance
    if parity == "even":
        held = np.stack([on_x, on_y, np.zeros_like(on_x)], axis=1)
        return held, np.zeros(len(points), bool)
    return np.stack([on_y, on_x, on_x | on_y], axis=1), on_x | on_y


def surface_triangles(corners, triangles, nodes, tree, chosen):
    """Rows (s, 6) of `nodes` for the triangles whose corners are all chosen, off the mirrors."""
    within = np.ptp(corners) * 1e-9
    on_mirror = (corners[triangles][:, :, :2] < within).all(axis=1).any(axis=1)
    surface = triangles[chosen[triangles].all(axis=1) & ~on_mirror]
    middles = 0.5 * (corners[surface] + corners[np.roll(surface, -1, axis=1)])
    return tree.query(np.concatenate([corners[surface], middles], axis=1))[1]


class Factor:
    """matrix = L U with its unknowns in the given order."""

    def __init__(self, matrix, order=None):
        # Quasi-definite (positive in u, negative in p): it needs no pivoting.
        self.order = np.arange(matrix.shape[0]) if order is None else order
        self.lu = splu(matrix[self.order][:, self.order].tocsc(), diag_pivot_thresh=0.0,
                       permc_spec="MMD_AT_PLUS_A" if order is None else "NATURAL",
                       options={"SymmetricMode": True, "Equil": False})

    def elimination(self):
        """Unknowns from the first to the last eliminated."""
        return self.order[np.argsort(self.lu.perm_c)]

    def solve(self, right):
        result = np.empty_like(right)
        result[self.order] = self.lu.solve(right[self.order])
        return result


def factor_towards(matrix, rows):
    """@return the Factor of a matrix, and the block (rows, rows) of its inverse. With `rows`
    eliminated last, the end of L and U is the factor of what the others leave of the matrix there;
    that is several times faster than a solution for every row."""
    others = np.setdiff1d(np.arange(matrix.shape[0]), rows)
    first = others[Factor(matrix[others][:, others]).elimination()]
    factor = Factor(matrix, np.r_[first, rows])
    last = factor.elimination()[-len(rows):]
    if not np.array_equal(np.sort(last), np.sort(rows)):
        raise RuntimeError("the rows were not eliminated last")
    lower = factor.lu.L[-len(rows):, -len(rows):].toarray()
    upper = factor.lu.U[-len(rows):, -len(rows):].toarray()
    inverse = solve_triangular(upper, solve_triangular(lower, np.eye(len(rows)), lower=True,
                                                       unit_diagonal=True))
    back = np.argsort(last)[np.argsort(np.argsort(rows))]
    inverse = inverse[np.ix_(back, back)]
    return factor, 0.5 * (inverse + inverse.T)


def solution(factor, free, rows, place, count):
    """A function: forces on the contact [N] -> displacements of all `count` nodes (n, 3) [m]."""
    def solve(force):
        right = np.zeros(len(factor.order))
        right[rows] = force[free]
        displacement = np.append(factor.solve(right), 0.0)[place]
        return displacement[:3 * count].reshape(-1, 3)
    return solve


def condense(mesh, outside, touches, fixed, youngs_modulus, poisson_ratio):
    """@param mesh     nodes, triangles, tetrahedra as body_mesh makes them
    @param outside  (n, 3) points -> (n) bool: on the surface that the tool presses
    @param touches  (n, 3) points of it -> (n) bool: near enough to touch
    @param fixed    (n, 3) points -> (n) bool: does not move"""
    corners, triangles, tetrahedra = mesh
    shear_modulus = youngs_modulus / (2 * (1 + poisson_ratio))
    matrix, nodes, pressure_nodes = assemble(corners, tetrahedra, shear_modulus, poisson_ratio)
    tolerance = 1e-9 * np.ptp(corners)
    tree = cKDTree(nodes)
    near = outside(corners)
    free_surface = surface_triangles(corners, triangles, nodes, tree, near)
    surface = surface_triangles(corners, triangles, nodes, tree, near & touches(corners))
    contact = np.unique(surface)
    loaded = (3 * contact[:, None] + np.arange(3)).ravel()

    on_surface = np.zeros(len(nodes), bool)
    on_surface[free_surface] = True
    body = QuarterBody(nodes, surface, contact, on_surface, {}, {}, None, 0)
    for parity in PARITIES:
        held, held_pressure = held_on_mirrors(nodes, parity, tolerance)
        held |= fixed(nodes)[:, None]
        keep = ~np.concatenate([held.ravel(),
                                held_on_mirrors(pressure_nodes, parity, tolerance)[1]])
        kept = np.flatnonzero(keep)
        small = matrix[kept][:, kept]
        place = np.full(len(keep), -1)
        place[kept] = np.arange(len(kept))
        free = np.flatnonzero(keep[loaded])
        rows = place[loaded[free]]
        factor, compliance = factor_towards(small, rows)

        body.free[parity], body.compliance[parity] = free, compliance
        if parity == "odd":
            body.solve_odd = solution(factor, free, rows, place, len(nodes))
        body.unknowns = max(body.unknowns, len(kept))
    return body
