# SPDX-License-Identifier: Apache-2.0
"""The domain of a mesh that weft.triangulate refines: what its triangles cover."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from ._switches import Switches
from ._topology import Topology, topology
from ._triangle_input import Arrays, Floats, Ints, Problem, column
from .domain import Area, Domain, Region
from .errors import DomainError
from .fields import Field, on_mesh


def mesh_problem(given: Arrays, switches: Switches) -> Problem:
    """The boundary of the mesh, and the edges between triangles with different attributes, are segments;
    its vertices are points, so that its Delaunay triangulation is there again before it is refined.
    Raises DomainError."""
    points, corners = given["vertices"], _corners(given)
    sides = topology(corners)
    if sides.counts.max() > 2:
        pair = sides.edges[sides.counts > 2][0].tolist()
        raise DomainError(f"triangles: more than two have the edge {pair[0]}, {pair[1]}")
    rows = given["triangle_attributes"] if len(given["triangle_attributes"]) else np.zeros((len(corners), 0))
    kinds, kind_of = np.unique(rows, axis=0, return_inverse=True)
    boundary = sides.counts == 1
    outline = boundary | _differ(sides, kind_of)
    segments, markers = sides.edges[outline], np.zeros(int(outline.sum()), np.int32)
    borders = boundary[outline].astype(np.uint32)
    if switches.poly and len(given["segments"]):
        kept = ~_are_among(segments, given["segments"])
        own = _are_among(given["segments"], sides.edges[boundary]).astype(np.uint32)
        segments = np.concatenate([given["segments"], segments[kept]])
        markers = np.concatenate([column(given["segment_markers"], len(own)), markers[kept]])
        borders = np.concatenate([own, borders[kept]])
    centroids = points[corners].mean(axis=1)
    regions = [Region(float(centroids[first, 0]), float(centroids[first, 1]), int(kind_of[first]))
               for first in _firsts_of_faces(sides, outline)] if rows.size else []
    domain = Domain(points, segments, markers=markers, regions=regions, fill="union", areas=[Area()],
                    segment_areas=borders)
    fields: Mapping[str, Field] = {}
    size: float | str | None = switches.max_area
    areas = column(given["triangle_max_area"], len(corners))
    if switches.own_areas and (areas > 0).any():
        fields = {"area": _grading(points, corners, areas)}
        size = "area" if size is None else f"min(area, {size!r})"
    return Problem(domain, size, fields, dict(enumerate(kinds)) if rows.size else {})


def _corners(given: Arrays) -> Ints:
    triangles = given["triangles"]
    if not len(triangles):
        raise DomainError("triangles: none to refine")
    if triangles.shape[1] not in (3, 6):
        raise DomainError(f"triangles: an array {triangles.shape}, expected (m, 3) or (m, 6)")
    corners: Ints = triangles[:, :3]
    count = len(given["vertices"])
    if not 0 <= corners.min() <= corners.max() < count:
        bad = np.argwhere((corners < 0) | (corners >= count))[0]
        raise DomainError(f"triangles[{bad[0]}] names vertex {corners[tuple(bad)]} of {count}")
    return corners


def _grading(points: Floats, corners: Ints, areas: Floats) -> Field:
    """A size that bounds triangles by the areas of those that they lie in: linear between vertices that
    have the least of the areas around them."""
    least = np.full(len(points), float(np.prod(np.ptp(points, axis=0))))
    bounded = areas > 0
    np.minimum.at(least, corners[bounded].ravel(), np.repeat(areas[bounded], 3))
    return on_mesh((points, corners), least)


def _differ(sides: Topology, kind_of: npt.NDArray[np.int64]) -> npt.NDArray[np.bool_]:
    """(e,): whether the triangles at an edge are of two kinds."""
    least, most = np.full(len(sides.edges), len(kind_of)), np.full(len(sides.edges), -1)
    np.minimum.at(least, sides.of_side, np.broadcast_to(kind_of[:, None], sides.of_side.shape))
    np.maximum.at(most, sides.of_side, np.broadcast_to(kind_of[:, None], sides.of_side.shape))
    differ: npt.NDArray[np.bool_] = least < most
    return differ


def _are_among(pairs: Ints, others: Ints) -> npt.NDArray[np.bool_]:
    """(k,): whether the pairs of vertices (k, 2), in either order, are among the others."""
    found = {tuple(sorted(pair)) for pair in others.tolist()}
    return np.array([tuple(sorted(pair)) in found for pair in pairs.tolist()], bool)


def _firsts_of_faces(sides: Topology, outline: npt.NDArray[np.bool_]) -> list[int]:
    """A triangle of each face that the edges of the outline part."""
    across = sides.neighbors()
    across[outline[sides.of_side]] = -1
    label = np.arange(len(across))
    while True:
        near = np.where(across >= 0, label[across], len(label)).min(axis=1)
        lower = np.minimum(label, near)
        lower = lower[lower]  # jumps along what is known already
        if np.array_equal(lower, label):
            return [int(first) for first in np.unique(label)]
        label = lower
