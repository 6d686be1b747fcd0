# SPDX-License-Identifier: Apache-2.0
"""Poisson's equation with linear finite elements, assembled from chunks as they stream in.

    -(u_xx + u_yy) = f in a square with a round hole, u = g on the boundary

for the known u = sin(pi x) cos(pi y). Each mesh has triangles of a quarter of the area, so half the
width: the error in L2 falls by 4 and that of the gradient by 2. Exits with 1 where it does not.
Needs python3-scipy.

    python3 poisson.py
"""

import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg
import weft

AREAS = [4e-3, 1e-3, 2.5e-4, 6.25e-5]
# Quadrature of degree 4 on a triangle: barycentric coordinates and weights (Dunavant 1985).
A, B, WA, WB = 0.445948490915965, 0.091576213509771, 0.223381589678011, 0.109951743655322
NODES = np.array([[1 - 2 * c if i == j else c for j in range(3)] for c in (A, B) for i in range(3)])
WEIGHTS = np.repeat([WA, WB], 3)


def u(p):
    return np.sin(np.pi * p[..., 0]) * np.cos(np.pi * p[..., 1])


def gradient(p):
    x, y = np.pi * p[..., 0], np.pi * p[..., 1]
    return np.pi * np.stack([np.cos(x) * np.cos(y), -np.sin(x) * np.sin(y)], axis=-1)


def f(p):
    return 2 * np.pi**2 * u(p)


def geometry(corners):
    """Areas (m,) and gradients (m, 3, 2) of the hat functions of triangles (m, 3, 2)."""
    opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    doubled = opposite[:, 0, 0] * opposite[:, 1, 1] - opposite[:, 0, 1] * opposite[:, 1, 0]
    hats = np.stack([-opposite[..., 1], opposite[..., 0]], axis=-1) / doubled[:, None, None]
    return doubled / 2, hats


def assemble(stream):
    """Stiffness matrix and load, chunk by chunk while the server refines; and the mesh."""
    rows, columns, values, load = [], [], [], []
    points = np.empty((0, 2))
    for chunk in stream:  # which refers to vertices of its own and of those before
        points = np.concatenate([points, chunk.points])
        corners = points[chunk.triangles]
        areas, hats = geometry(corners)
        values.append(np.einsum("m,mid,mjd->mij", areas, hats, hats))
        rows.append(np.repeat(chunk.triangles, 3, axis=1))
        columns.append(np.tile(chunk.triangles, 3))
        load.append((chunk.triangles, np.einsum("m,q,mq,qi->mi", areas, WEIGHTS, f(NODES @ corners), NODES)))
    n = len(points)
    flat = [np.concatenate([part.ravel() for part in parts]) for parts in (values, rows, columns)]
    matrix = sparse.coo_matrix((flat[0], (flat[1], flat[2])), shape=(n, n)).tocsr()
    right = np.bincount(np.concatenate([t.ravel() for t, _ in load]),
                        np.concatenate([b.ravel() for _, b in load]), n)
    return matrix, right, stream.mesh()


def solve(matrix, right, mesh):
    solution = u(mesh.points)  # g, where it is not computed
    inner = np.ones(len(solution), bool)
    inner[mesh.boundary()] = False
    rest = right - matrix @ np.where(inner, 0, solution)
    solution[inner] = scipy.sparse.linalg.spsolve(matrix[inner][:, inner].tocsc(), rest[inner])
    return solution


def errors(mesh, solution, u, gradient):
    """In L2, of the solution and of its gradient; `u` and `gradient` are the exact ones."""
    corners, values = mesh.points[mesh.triangles], solution[mesh.triangles]
    areas, hats = geometry(corners)
    places = NODES @ corners
    off = (values @ NODES.T - u(places)) ** 2
    slope = np.einsum("mi,mid->md", values, hats)
    off_slope = ((slope[:, None] - gradient(places)) ** 2).sum(axis=2)
    return [np.sqrt(np.einsum("m,q,mq->", areas, WEIGHTS, square)) for square in (off, off_slope)]


def main():
    angle = np.linspace(0, 2 * np.pi, 65)[:-1]
    hole = np.column_stack([0.5 + 0.2 * np.cos(angle), 0.5 + 0.2 * np.sin(angle)])
    domain = weft.Domain.rings([(0, 0), (1, 0), (1, 1), (0, 1)], hole)
    found = []
    with weft.local() as client:
        for area in AREAS:
            with client.stream(domain, size=area, min_angle=30) as stream:
                matrix, right, mesh = assemble(stream)
            found.append(errors(mesh, solve(matrix, right, mesh), u, gradient))
            orders = np.log2(np.divide(*found[-2:])) if len(found) > 1 else (np.nan, np.nan)
            print(f"{len(mesh.triangles):7,} triangles   L2 error {found[-1][0]:.3e}, order {orders[0]:5.2f}"
                  f"   of the gradient {found[-1][1]:.3e}, order {orders[1]:5.2f}")
    if not (abs(orders[0] - 2) < 0.2 and abs(orders[1] - 1) < 0.2):
        sys.exit(f"the last orders are {orders[0]:.2f} and {orders[1]:.2f}, expected 2 and 1")


if __name__ == "__main__":
    main()
