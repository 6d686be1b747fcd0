# SPDX-License-Identifier: Apache-2.0
"""Laplace's equation in an L-shaped domain, on meshes that follow their own error.

The solution r^(2/3) sin(2 theta/3) is singular at the corner that points inwards. On meshes of equal
triangles the error of the gradient falls as N^(-1/3) in their number N. Here each round estimates
the error of each triangle, and asks for a mesh of four times as many triangles whose sizes make the
estimates equal: the error falls as N^(-1/2), as if there were no corner. Exits with 1 if it does
not. Needs python3-scipy.

    python3 adaptive.py [TRIANGLES]     of the last mesh, 60,000 if not said otherwise
"""

import sys
import time

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg
import weft
from poisson import errors, geometry

L_SHAPE = np.array([(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)])
ROUNDS = 6


def polar(p):
    return np.hypot(p[..., 0], p[..., 1]), np.arctan2(p[..., 1], p[..., 0]) % (2 * np.pi)


def u(p):
    r, theta = polar(p)
    return r ** (2 / 3) * np.sin(2 / 3 * theta)


def gradient(p):
    r, theta = polar(p)
    return 2 / 3 * r[..., None] ** (-1 / 3) * np.stack([-np.sin(theta / 3), np.cos(theta / 3)], axis=-1)


def solve(mesh):
    """The finite element solution at the vertices, u on the boundary."""
    n = len(mesh.points)
    areas, hats = geometry(mesh.points[mesh.triangles])
    values = np.einsum("m,mid,mjd->mij", areas, hats, hats)
    rows, columns = np.repeat(mesh.triangles, 3, axis=1), np.tile(mesh.triangles, 3)
    matrix = sparse.coo_matrix((values.ravel(), (rows.ravel(), columns.ravel())), (n, n)).tocsc()
    solution = np.zeros(n)
    edge = mesh.boundary()
    solution[edge] = u(mesh.points[edge])
    inner = np.ones(n, bool)
    inner[edge] = False
    right = -(matrix @ solution)[inner]
    factors = scipy.sparse.linalg.splu(matrix[inner][:, inner], permc_spec="MMD_AT_PLUS_A",
                                       options={"SymmetricMode": True})
    solution[inner] = factors.solve(right)
    return solution


def at_vertices(mesh, areas, values):
    """Mean of values (m,) of triangles over those at each vertex."""
    corners, n = mesh.triangles.ravel(), len(mesh.points)
    return np.bincount(corners, np.repeat(areas * values, 3), n) / np.bincount(corners, np.repeat(areas, 3), n)


def wanted_edges(mesh, solution, count):
    """At each vertex, the length of edges for a mesh of about `count` triangles with equal errors.

    The error of a triangle is how far the gradient in it is from the mean around its corners
    (Zienkiewicz and Zhu 1987). Its square, per area, is c h^2 for edges of h; of all h with
    as many triangles, the one with the least sum of squares is proportional to c^(-1/4)."""
    areas, hats = geometry(mesh.points[mesh.triangles])
    slope = np.einsum("mi,mid->md", solution[mesh.triangles], hats)
    smooth = np.stack([at_vertices(mesh, areas, slope[:, k]) for k in (0, 1)], axis=-1)
    squares = ((smooth[mesh.triangles].mean(axis=1) - slope) ** 2).sum(axis=1)
    squares += ((smooth[mesh.triangles] - slope[:, None]) ** 2).sum(axis=(1, 2)) / 9
    c = at_vertices(mesh, areas, squares / areas)
    weight = np.bincount(mesh.triangles.ravel(), np.repeat(areas / 3, 3), len(c))
    return c ** -0.25 * np.sqrt((weight * np.sqrt(c)).sum() * 4 / np.sqrt(3) / count)


def main():
    last = int(sys.argv[1]) if len(sys.argv) > 1 else 60_000
    found = []
    with weft.local() as client:
        mesh = client.mesh(L_SHAPE, edge=np.sqrt(4 / np.sqrt(3) * 3 / (last / 4**ROUNDS)))
        solution = solve(mesh)
        for n in last / 4.0 ** np.arange(ROUNDS - 1, -1, -1):
            h = wanted_edges(mesh, solution, n)
            start = time.perf_counter()
            mesh = client.mesh(L_SHAPE, edge=weft.on_mesh(mesh, h))
            meshed = time.perf_counter()
            solution = solve(mesh)
            solved = time.perf_counter()
            found.append((len(mesh.triangles), errors(mesh, solution, u, gradient)[1]))
            order = np.nan
            if len(found) > 1:
                more, less = np.diff(np.log(found[-2:]), axis=0)[0]
                order = -less / more
            print(f"{len(mesh.triangles):9,} triangles   error of the gradient {found[-1][1]:.3e}, "
                  f"order {order:5.2f}   meshed in {meshed - start:.3f} s, solved in {solved - meshed:.3f} s")
    if not abs(order - 0.5) < 0.05:
        sys.exit(f"the error falls as N^-{order:.2f}, expected N^-0.5")


if __name__ == "__main__":
    main()
