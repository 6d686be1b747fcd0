# SPDX-License-Identifier: Apache-2.0
"""Triangle's call: a dict in, a dict out, and switches between (https://www.cs.cmu.edu/~quake/triangle.html).
The keys and their types are those of the package `triangle`; docs/triangle.md lists the switches.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _shared
from ._interpolate import at_points
from ._requests import MeshOptions
from ._switches import Switches, parse
from ._topology import Topology, topology
from ._triangle_input import Arrays, Floats, Ints, Problem, column, graph_problem, read
from ._triangle_refined import mesh_problem
from ._warning import warn
from .domain import Domain
from ._mesh import Mesh

_MOST_TRIES = 8  # to come near the number of Steiner points


def triangulate(tri: Mapping[str, npt.ArrayLike], opts: str = "") -> Arrays:
    """Triangulates as Triangle does, with weft's meshes.

    `tri`: `vertices` (n, 2) and, if there are any, `vertex_markers` (n,) or (n, 1), `vertex_attributes`
    (n, k), `segments` (s, 2), `segment_markers` (s,), `holes` (h, 2), `regions` (r, 4) of x, y, attribute
    and maximum area; of a mesh that `r` refines, `triangles` (m, 3), `triangle_attributes` (m, k),
    `triangle_max_area` (m,). `opts`: Triangle's switches, such as "pq30a0.1".

    Returns `vertices`, first those of the input in their order, then new ones; `vertex_markers`;
    `triangles`, counter-clockwise; with A or r, `triangle_attributes`; with p or c, `segments` and
    `segment_markers`; with e, `edges` and `edge_markers`; with n, `neighbors`. Integers are int32,
    markers and attributes have two dimensions. Without q and a no points are added, except where segments
    cross.

    Raises SwitchError, DomainError, and the ServerErrors of Client.mesh: the fields that they name are
    those of the dict, and `domain.points` its vertices. The meshes are made in this process, as by weft.mesh, or,
    without its library, by one private server, which starts at the first call and ends with this process.

        square = {"vertices": [(0, 0), (1, 0), (1, 1), (0, 1)], "segments": [(0, 1), (1, 2), (2, 3), (3, 0)]}
        weft.triangulate(square, "pq30a0.01")["triangles"]
    """
    switches = parse(opts)
    given = read(tri)
    problem = mesh_problem(given, switches) if switches.refine else graph_problem(given, switches)
    return _Output(given, switches, problem, _mesh(problem, switches)).arrays()


def _mesh(problem: Problem, switches: Switches) -> Mesh:
    def make(max_triangles: int | None = None) -> Mesh:
        options: MeshOptions = {"fields": problem.fields}
        if max_triangles is not None:
            options["max_triangles"] = max_triangles
        if switches.keep_segments:
            options["keep"] = "all"
        return _shared.mesh(problem.domain, problem.size, switches.min_angle or 0, **options)

    if switches.most_steiner is None or not switches.bounded:
        return make()
    return _limited(problem.domain, make, switches.most_steiner)


def _triangulation(domain: Domain) -> Mesh:
    """The constrained Delaunay triangulation. Its triangles have no bounds, so regions are left out."""
    return _shared.mesh(dataclasses.replace(domain, regions=()), None, 0)


def _limited(domain: Domain, make: Callable[..., Mesh], most: int) -> Mesh:
    """A mesh with at most so many Steiner points. Each makes one triangle more at the boundary, and two
    elsewhere, so the bound on triangles rises until the points are used up."""
    best = start = _triangulation(domain)
    triangles = len(start.triangles) + most
    for _ in range(_MOST_TRIES):
        mesh = make(max_triangles=triangles)
        left = most - (len(mesh.points) - len(start.points))
        if left >= 0:
            best = mesh
        if left <= 0 or not mesh.summary.unrefined.budget:
            break
        triangles += left
    if best is start or best.summary.unrefined.budget:
        warn(f"S{most}: {most} new points are too few for the bounds, which triangles miss")
    return best


class _Output:
    """A mesh with the vertices of the input first."""

    def __init__(self, given: Arrays, switches: Switches, problem: Problem, mesh: Mesh) -> None:
        self._given = given
        self._switches = switches
        self._problem = problem
        self._mesh = mesh
        count = len(given["vertices"])
        vertices, points = mesh.input_points.T
        if switches.jettison:
            kept = np.sort(points)
            points = np.searchsorted(kept, points)
        else:
            kept = np.arange(count)
        self._kept = kept
        number = np.full(len(mesh.points), -1)
        number[vertices] = points
        self._new = np.flatnonzero(number < 0)
        number[self._new] = len(kept) + np.arange(len(self._new))
        self._number = number.astype(np.int32)

    def arrays(self) -> Arrays:
        mesh, switches, given = self._mesh, self._switches, self._given
        sides = topology(mesh.triangles)
        on_segments = sides.find(mesh.edges)
        edge_markers = np.zeros(len(sides.edges), np.int32)
        edge_markers[on_segments] = mesh.edge_markers
        boundary = sides.counts == 1
        edge_markers[boundary & (edge_markers == 0)] = 1
        vertices = np.concatenate([given["vertices"][self._kept], mesh.points[self._new]])
        markers = self._vertex_markers(sides)
        triangles = self._number[mesh.triangles]
        found: Arrays = {
            "vertices": vertices, "vertex_markers": markers[:, None], "triangles": triangles}
        if given["vertex_attributes"].shape[1]:
            found["vertex_attributes"] = self._vertex_attributes()
        if switches.second_order:
            self._add_middles(found, sides, edge_markers)
        if (switches.attributes and switches.poly and not switches.refine) or (
                switches.refine and self._problem.attributes):
            found["triangle_attributes"] = self._triangle_attributes()
        if switches.poly or switches.convex:
            order = np.argsort(mesh.edge_segments, kind="stable")
            found["segments"] = self._number[mesh.edges[order]]
            found["segment_markers"] = edge_markers[on_segments[order]][:, None]
        if switches.edges:
            found["edges"] = self._number[sides.edges]
            found["edge_markers"] = edge_markers[:, None]
        if switches.neighbors:
            found["neighbors"] = sides.neighbors()
        for key in ("holes", "regions"):
            if switches.poly and len(given[key]):
                found[key] = given[key]
        if switches.no_markers:
            for key in ("vertex_markers", "segment_markers", "edge_markers"):
                found.pop(key, None)
        return found

    def _vertex_markers(self, sides: Topology) -> Ints:
        """The marker of the input if it is not 0, else that of the first segment with one at the
        vertex, else 1 on the boundary."""
        count = len(self._given["vertices"])
        markers = np.concatenate([column(self._given["vertex_markers"], count)[self._kept],
                                  np.zeros(len(self._new), np.int32)])
        order = np.argsort(self._mesh.edge_segments, kind="stable")[::-1]  # the first overwrites the others
        of_edges = self._mesh.edge_markers[order]
        order, of_edges = order[of_edges != 0], of_edges[of_edges != 0]
        of_segments = np.zeros(len(markers), np.int32)
        of_segments[self._number[sides.edges[sides.counts == 1]]] = 1
        of_segments[self._number[self._mesh.edges[order]]] = of_edges[:, None]
        return np.where(markers == 0, of_segments, markers)

    def _vertex_attributes(self) -> Floats:
        values, new = self._given["vertex_attributes"], self._mesh.points[self._new]
        domain = self._problem.domain
        return np.concatenate([values[self._kept],
                               at_points(_triangulation(domain), domain, values, new)])

    def _triangle_attributes(self) -> Floats:
        """Those of the region, or 0."""
        attributes = self._problem.attributes
        columns = len(next(iter(attributes.values()), (0,)))
        found = np.zeros((len(self._mesh.regions), columns))
        for number, row in attributes.items():
            found[self._mesh.regions == number] = row
        return found

    def _add_middles(self, found: Arrays, sides: Topology,
                     edge_markers: Ints) -> None:
        """A vertex in the middle of each edge; in a triangle they follow the corners, opposite each."""
        first = len(found["vertices"])
        ends = self._number[sides.edges]
        found["triangles"] = np.column_stack([found["triangles"], first + sides.of_side]).astype(np.int32)
        for key in ("vertices", "vertex_attributes"):
            if key in found:
                found[key] = np.concatenate([found[key], found[key][ends].mean(axis=1)])
        found["vertex_markers"] = np.concatenate([found["vertex_markers"], edge_markers[:, None]])
