# SPDX-License-Identifier: Apache-2.0
"""Meshes of solvers written in Python; see Mesh.to_skfem and Mesh.to_dolfinx."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._optional import need
from ._topology import topology as topology_of

if TYPE_CHECKING:
    from ._mesh import Mesh


def to_skfem(mesh: Mesh) -> Any:
    skfem = need("skfem", "Mesh.to_skfem", "scikit-fem")
    made = skfem.MeshTri(np.ascontiguousarray(mesh.points.T), np.ascontiguousarray(mesh.triangles.T, np.int64))
    # The facets of scikit-fem have an order of their own.
    low, high = np.sort(made.facets, axis=0)
    keys = low.astype(np.int64) * len(mesh.points) + high
    order = np.argsort(keys)
    facets = {name: order[np.searchsorted(keys[order], _keys(edges, len(mesh.points)))]
              for name, edges in mesh.boundaries.named().items()}
    return made.with_boundaries(facets).with_subdomains(mesh.subdomains.named())


def to_dolfinx(mesh: Mesh, comm: Any) -> tuple[Any, Any, Any]:
    dolfinx, ufl = need("dolfinx.mesh", "Mesh.to_dolfinx"), need("ufl", "Mesh.to_dolfinx")
    if comm is None:
        comm = need("mpi4py.MPI", "Mesh.to_dolfinx", "mpi4py").COMM_WORLD
    element = ufl.VectorElement("Lagrange", ufl.Cell("triangle", geometric_dimension=2), 1)
    # Each process gives a part of the points and of the triangles, in the order of both.
    points, triangles = (np.array_split(array, comm.size)[comm.rank]
                         for array in (mesh.points, mesh.triangles.astype(np.int64)))
    made = dolfinx.create_mesh(comm, triangles, points, ufl.Mesh(element))
    topology = made.topology
    cells = np.arange(_count(topology, 2), dtype=np.int32)
    regions = dolfinx.meshtags(made, 2, cells, mesh.regions[topology.original_cell_index[cells]])
    topology.create_entities(1)
    topology.create_connectivity(1, 2)  # which boundary conditions need
    facets = np.arange(_count(topology, 1), dtype=np.int32)
    # Its vertices and its points have numbers of their own each, and none of them is that of `mesh`.
    numbers = np.zeros(_count(topology, 0), np.int64)
    numbers[topology.connectivity(2, 0).array] = np.array(made.geometry.input_global_indices)[
        made.geometry.dofmap.array]
    facet_keys = _keys(numbers[topology.connectivity(1, 0).array].reshape(-1, 2), len(mesh.points))
    edge_keys = _keys(mesh.edges, len(mesh.points))
    order = np.argsort(edge_keys, kind="stable")
    at = np.minimum(np.searchsorted(edge_keys[order], facet_keys), len(order) - 1)
    found = edge_keys[order][at] == facet_keys
    markers = dolfinx.meshtags(made, 1, facets[found], mesh.edge_markers[order][at[found]])
    made.name, regions.name, markers.name = "mesh", "regions", "markers"
    return made, regions, markers


def second_order(mesh: Mesh) -> tuple[Any, Any]:
    sides = topology_of(mesh.triangles)
    straight = mesh.points[sides.edges].mean(axis=1)
    of_triangle = sides.of_side[:, [2, 0, 1]]
    triangles = np.column_stack([mesh.triangles, len(mesh.points) + of_triangle]).astype(np.int32)
    middles = straight.copy()
    if len(mesh.edge_bulges):
        chords = np.diff(mesh.points[mesh.edges], axis=1)[:, 0]
        middles[sides.find(mesh.edges)] += mesh.edge_bulges[:, None] / 2 * np.column_stack([chords[:, 1], -chords[:, 0]])
        while len(over := np.flatnonzero(_turn_over(np.concatenate([mesh.points, middles])[triangles])
                                         & (middles != straight).any(axis=1)[of_triangle].any(axis=1))):
            middles[of_triangle[over]] = straight[of_triangle[over]]
    return np.concatenate([mesh.points, middles]), triangles


def _turn_over(nodes: Any) -> Any:
    """(m,): whether a coefficient of the Jacobian's determinant is not above 0; files/formats/derived/second_order.h
    says which."""
    a, b, c = np.moveaxis(nodes[:, :3], 1, 0)
    ab, bc, ca = np.moveaxis(2 * nodes[:, 3:] - (nodes[:, :3] + nodes[:, [1, 2, 0]]) / 2, 1, 0)
    u, v = np.stack([ab - a, b - ab, bc - ca]), np.stack([ca - a, bc - ab, c - ca])
    cross = u[:, None, :, 0] * v[None, :, :, 1] - u[:, None, :, 1] * v[None, :, :, 0]
    return (cross + cross.transpose(1, 0, 2) <= 0).any(axis=(0, 1))


def _count(topology: Any, dimension: int) -> int:
    """Of the entities that this process knows."""
    index_map = topology.index_map(dimension)
    return int(index_map.size_local + index_map.num_ghosts)


def _keys(pairs: Any, vertices: int) -> Any:
    """(k,): a number for each pair of vertices, whatever their order."""
    low, high = np.sort(pairs.astype(np.int64), axis=1).T
    return low * vertices + high
