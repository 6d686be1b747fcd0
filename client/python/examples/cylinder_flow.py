# SPDX-License-Identifier: Apache-2.0
"""The steady flow around a cylinder in a channel at Reynolds number 20, by quadratic velocities and
linear pressures (Taylor and Hood) on a mesh that is finer around the cylinder and in its wake.

The benchmark 2D-1 of Schaefer and Turek (1996): channel 2.2 x 0.41, cylinder of diameter 0.1 at
(0.2, 0.2), parabolic inflow of mean velocity 0.2, viscosity 0.001. Exits with 1 if the drag is
farther than 1 % from the reference. Needs python3-scipy.

    python3 cylinder_flow.py DOMAIN [PICTURE]      DOMAIN with the markers below, such as channel.poly
"""

import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg
import weft

INFLOW, OUTFLOW, WALL, CYLINDER = 1, 2, 3, 4
SIZE = "min(1.5e-5 + 0.04*(hypot(x-0.2, y-0.2) - 0.05)^2, x > 0.2 && abs(y-0.2) < 0.07 ? 2e-4 : 8e-4)"
VISCOSITY, MEAN_SPEED, DIAMETER = 1e-3, 0.2, 0.1
DRAG, LIFT = 5.57953523384, 0.010618948146  # of the benchmark
# Quadrature of degree 5 on a triangle: barycentric coordinates and weights (Dunavant 1985).
A, B, WA, WB = 0.470142064105115, 0.101286507323456, 0.132394152788506, 0.125939180544827
PLACES = np.array([[1 / 3] * 3] + [[1 - 2 * c if i == j else c for j in range(3)]
                                   for c in (A, B) for i in range(3)])
WEIGHTS = np.array([0.225] + [WA] * 3 + [WB] * 3)
# Quadratic shape functions: of the corners, then of the midpoints of the sides 0-1, 1-2, 2-0.
ENDS = np.array([[0, 1], [1, 2], [2, 0]])
SHAPES = np.hstack([PLACES * (2 * PLACES - 1), 4 * PLACES[:, ENDS[:, 0]] * PLACES[:, ENDS[:, 1]]])


class Space:
    """Numbers and integrals of the velocities: `nodes` (m, 6) of each triangle, `points` of nodes."""

    def __init__(self, mesh):
        n = len(mesh.points)
        sides = np.sort(mesh.triangles[:, ENDS].reshape(-1, 2), axis=1).astype(np.int64)
        self.sides, number = np.unique(sides[:, 0] * n + sides[:, 1], return_inverse=True)
        self.corners = n
        self.nodes = np.hstack([mesh.triangles, n + number.reshape(-1, 3)])
        middles = mesh.points[np.column_stack(divmod(self.sides, n))].mean(axis=1)
        self.points = np.vstack([mesh.points, middles])
        at = mesh.points[mesh.triangles]
        opposite = np.roll(at, -2, axis=1) - np.roll(at, -1, axis=1)
        doubled = opposite[:, 0, 0] * opposite[:, 1, 1] - opposite[:, 0, 1] * opposite[:, 1, 0]
        hats = np.stack([-opposite[..., 1], opposite[..., 0]], axis=-1) / doubled[:, None, None]
        self.weights = doubled[:, None] / 2 * WEIGHTS  # (m, q)
        of_corners = np.einsum("qi,mid->mqid", 4 * PLACES - 1, hats)
        of_sides = 4 * (PLACES[:, ENDS[:, 0], None] * hats[:, None, ENDS[:, 1]]
                        + PLACES[:, ENDS[:, 1], None] * hats[:, None, ENDS[:, 0]])
        self.slopes = np.concatenate([of_corners, of_sides], axis=2)  # (m, q, 6, 2)

    def nodes_on(self, mesh, marker):
        """Corners and midpoints of the edges with this marker."""
        edges = np.sort(mesh.edges[mesh.edge_markers == marker], axis=1).astype(np.int64)
        middles = np.searchsorted(self.sides, edges[:, 0] * self.corners + edges[:, 1])
        return np.unique(np.concatenate([edges.ravel(), self.corners + middles]))

    def matrix(self, values, rows, columns, shape):
        """Of (m, r, c) values, at `rows` (m, r) and `columns` (m, c)."""
        row, column = np.broadcast_arrays(rows[:, :, None], columns[:, None, :])
        return sparse.coo_matrix((values.ravel(), (row.ravel(), column.ravel())), shape=shape).tocsr()


def flow(mesh):
    """Velocities (k, 2) at corners and midpoints, pressures (n,), and the force (2,) on the cylinder:
    what the equations at its nodes are short of."""
    space = Space(mesh)
    k, n = len(space.points), len(mesh.points)
    diffusion = space.matrix(VISCOSITY * np.einsum("mq,mqid,mqjd->mij", space.weights, space.slopes,
                                                   space.slopes), space.nodes, space.nodes, (k, k))
    pressure = [space.matrix(-np.einsum("mq,mqi,qj->mij", space.weights, space.slopes[..., d], PLACES),
                             space.nodes, mesh.triangles, (k, n)) for d in (0, 1)]
    inflow = space.nodes_on(mesh, INFLOW)
    still = np.concatenate([space.nodes_on(mesh, WALL), space.nodes_on(mesh, CYLINDER)])
    velocity = np.zeros((k, 2))
    y = space.points[inflow, 1]
    velocity[inflow, 0] = 6 * MEAN_SPEED * y * (0.41 - y) / 0.41**2
    fixed = np.zeros((k, 2), bool)
    fixed[inflow] = fixed[still] = True
    free = np.concatenate([~fixed[:, 0], ~fixed[:, 1], np.ones(n, bool)])

    def convection(v):
        """The matrix of (v . grad) w, which takes each component of w alone, and those, (d, e), of
        (w . grad) v: of component e of w to component d."""
        here = np.einsum("qi,mid->mqd", SHAPES, v[space.nodes])
        slope = np.einsum("mqid,mie->mqed", space.slopes, v[space.nodes])
        carry = space.matrix(np.einsum("mq,qi,mqjd,mqd->mij", space.weights, SHAPES, space.slopes, here),
                             space.nodes, space.nodes, (k, k))
        react = [[space.matrix(np.einsum("mq,qi,qj,mq->mij", space.weights, SHAPES, SHAPES,
                                         slope[..., d, e]), space.nodes, space.nodes, (k, k))
                  for e in (0, 1)] for d in (0, 1)]
        return carry, react

    values = np.concatenate([velocity[:, 0], velocity[:, 1], np.zeros(n)])
    for _ in range(10):  # Newton's method, from nothing but the inflow
        carry, react = convection(values[:2 * k].reshape(2, k).T)
        moved = diffusion + carry
        residual = np.concatenate([moved @ values[:k] + pressure[0] @ values[2 * k:],
                                   moved @ values[k:2 * k] + pressure[1] @ values[2 * k:],
                                   pressure[0].T @ values[:k] + pressure[1].T @ values[k:2 * k]])
        left = np.linalg.norm(residual[free])
        if left < 1e-10:
            break
        jacobian = sparse.bmat([[moved + react[0][0], react[0][1], pressure[0]],
                                [react[1][0], moved + react[1][1], pressure[1]],
                                [pressure[0].T, pressure[1].T, None]]).tocsr()
        values[free] -= scipy.sparse.linalg.spsolve(jacobian[free][:, free].tocsc(), residual[free])
    else:
        sys.exit(f"Newton's method has not converged: the residual is {left:.1e}")
    cylinder = space.nodes_on(mesh, CYLINDER)
    force = -np.array([residual[cylinder].sum(), residual[k + cylinder].sum()])
    return values[:2 * k].reshape(2, k).T, values[2 * k:], force


def draw(mesh, velocity, picture):
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(2, 1, figsize=(11, 5), layout="constrained")
    mesh.plot(ax=axes[0])
    speed = np.hypot(*velocity[:len(mesh.points)].T)
    drawn = axes[1].tripcolor(*mesh.points.T, mesh.triangles, speed, shading="gouraud")
    figure.colorbar(drawn, ax=axes[1], label="speed")
    axes[1].set_aspect("equal")
    for ax in axes:
        ax.set(xlim=(0, 2.2), ylim=(0, 0.41))
    figure.savefig(picture, dpi=110)


def main():
    with weft.local() as client:
        mesh = client.mesh(sys.argv[1], size=SIZE,
                           min_angle=28)
    print(mesh.quality())
    velocity, _, force = flow(mesh)
    drag, lift = 2 * force / (MEAN_SPEED**2 * DIAMETER)
    print(f"drag {drag:.4f}, reference {DRAG:.4f}; lift {lift:.4f}, reference {LIFT:.4f}")
    if len(sys.argv) > 2:
        draw(mesh, velocity, sys.argv[2])
    if abs(drag / DRAG - 1) > 0.01:
        sys.exit("the drag is not that of the benchmark")


main()
