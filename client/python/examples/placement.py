# SPDX-License-Identifier: Apache-2.0
"""What it gains a solver that points lie on a lattice (`placement`): errors of linear finite elements on
meshes of both placements.

poisson     the problem of poisson.py, the same size everywhere
advection   b . grad u = 0 with b = (y, -x) in a quarter of a ring, so a profile is carried round by 90
            degrees: u = exp(-((r - 0.625) / 0.1)^2), given where it does not flow out. Upwinded along
            the streamlines (SUPG, Brooks and Hughes 1982); the same size everywhere
graded      the same on meshes that are finer where the profile is

A row is one bound on the areas. The gain compares the lattice's error with what circumcentres have at as
many triangles, between two of their meshes: 0.80 is an error less by a fifth. Exits with 1 if the lattice
gains nothing on its finest mesh. Needs python3-scipy.

    python3 placement.py
"""

import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg
import weft

import poisson
from poisson import NODES, WEIGHTS

PLACEMENTS = ["lattice", "circumcentre"]
MIDDLE, WIDTH = 0.625, 0.1  # of the profile
FINER = "(2 - 1.8*exp(-((hypot(x, y) - 0.625)/0.15)^2))"


def profile(p):
    return np.exp(-(((np.hypot(p[..., 0], p[..., 1]) - MIDDLE) / WIDTH) ** 2))


def profile_gradient(p):
    r = np.hypot(p[..., 0], p[..., 1])
    return (profile(p) * -2 * (r - MIDDLE) / WIDTH**2 / r)[..., None] * p


def solve_poisson(client, domain, **options):
    with client.stream(domain, **options) as stream:
        matrix, right, mesh = poisson.assemble(stream)
    return mesh, poisson.errors(mesh, poisson.solve(matrix, right, mesh), poisson.u, poisson.gradient)


def solve_advection(client, domain, **options):
    mesh = client.mesh(domain, **options)
    corners, n = mesh.points[mesh.triangles], len(mesh.points)
    areas, hats = poisson.geometry(corners)
    places = NODES @ corners
    flow = np.stack([places[..., 1], -places[..., 0]], axis=-1)
    along = np.einsum("mqd,mid->mqi", flow, hats)  # derivatives of the hats along the flow
    upwind = NODES + along / np.abs(along).sum(axis=2, keepdims=True)
    values = np.einsum("m,q,mqi,mqj->mij", areas, WEIGHTS, upwind, along)
    rows, columns = np.repeat(mesh.triangles, 3, axis=1), np.tile(mesh.triangles, 3)
    matrix = sparse.coo_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n)).tocsr()
    solution, free = profile(mesh.points), np.ones(n, bool)
    free[mesh.boundary()] = False
    free |= mesh.points[:, 1] == 0  # where it flows out
    right = -(matrix @ np.where(free, 0, solution))[free]
    solution[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), right)
    return mesh, poisson.errors(mesh, solution, profile, profile_gradient)


def arc(radius, start, end, pieces):
    angle = np.linspace(start, end, pieces + 1)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def compare(client, name, solve, domain, factor=""):
    """Prints a row for each bound; the last gains, of the error and of the gradient's."""
    found = {placement: [] for placement in PLACEMENTS}
    for area in poisson.AREAS:
        print(f"{name:<9}", end="")
        for placement, rows in found.items():
            mesh, errors = solve(client, domain, size=f"{area}{factor}", placement=placement)
            rows.append([len(mesh.triangles), *errors])
            print("{:9,}  {:.2e}  {:.2e}".format(*rows[-1]), end="")
        lattice, others = (np.log(rows) for rows in found.values())
        gains = np.full(2, np.nan)  # where circumcentres have no mesh of so few triangles
        if others[0, 0] <= lattice[-1, 0]:
            at_as_many = [np.interp(lattice[-1, 0], others[:, 0], others[:, k]) for k in (1, 2)]
            gains = np.exp(lattice[-1, 1:] - at_as_many)
        print("   {:4.2f}  {:4.2f}".format(*gains))
    return gains


def main():
    hole = 0.5 + arc(0.2, 0, 2 * np.pi, 64)[:-1]
    square = weft.Domain.rings([(0, 0), (1, 0), (1, 1), (0, 1)], hole)
    turn = np.concatenate([arc(1, 0, np.pi / 2, 32), arc(0.25, np.pi / 2, 0, 32)])
    ring = weft.Domain.rings(np.where(np.abs(turn) < 1e-12, 0, turn))
    print(f"{'':9}{'lattice':>9}{'error':>10}{'gradient':>10}{'circumc.':>9}{'error':>10}{'gradient':>10}"
          "    gain, gradient")
    with weft.local() as client:
        gains = [compare(client, "poisson", solve_poisson, square),
                 compare(client, "advection", solve_advection, ring),
                 compare(client, "graded", solve_advection, ring, f"*{FINER}")]
    if not np.max(gains) < 1:
        sys.exit(f"the lattice gains nothing: {np.max(gains):.2f}")


main()
