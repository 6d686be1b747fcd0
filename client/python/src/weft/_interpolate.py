# SPDX-License-Identifier: Apache-2.0
"""Values at the points of a mesh from those at the points of its domain: linear in each triangle of the
domain's constrained Delaunay triangulation."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .domain import Domain
from ._mesh import Mesh

Floats = npt.NDArray[np.float64]


def at_points(triangulation: Mesh, domain: Domain, values: Floats, points: Floats) -> Floats:
    """(q, k): at points (q, 2), from the values (p, k) at the domain's points. `triangulation`: of the
    domain, without Steiner points."""
    return _interpolate(triangulation, _vertex_values(triangulation, domain, values), points)


def _vertex_values(triangulation: Mesh, domain: Domain, values: Floats) -> Floats:
    """(n, k): at the vertices. One where segments cross has the value of the first of them."""
    found = np.zeros((len(triangulation.points), values.shape[1]))
    of_input = np.zeros(len(found), bool)
    vertices, points = triangulation.input_points.T
    found[vertices], of_input[vertices] = values[points], True
    ends = triangulation.edges.ravel()
    crossing = ~of_input[ends]
    at, segments = ends[crossing], np.repeat(triangulation.edge_segments, 2)[crossing]
    first, last = domain.segments[segments].T
    along = domain.points[last] - domain.points[first]
    part = ((triangulation.points[at] - domain.points[first]) * along).sum(1) / (along**2).sum(1)
    found[at] = values[first] + part[:, None] * (values[last] - values[first])
    return found


def _interpolate(triangulation: Mesh, values: Floats, points: Floats) -> Floats:
    """(q, k): values (n, k) at the vertices of a mesh, at points (q, 2) in it. A point beside all
    triangles, by rounding, has the value of the nearest one."""
    order = np.argsort(points[:, 0], kind="stable")
    sorted_points = points[order]
    result = np.zeros((len(points), values.shape[1]))
    best = np.full(len(points), -np.inf)  # the least barycentric coordinate
    corners = triangulation.points[triangulation.triangles]
    margin = 1e-9 * max(float(np.ptp(triangulation.points, axis=0).max()), 1e-300)
    starts = np.searchsorted(sorted_points[:, 0], corners[..., 0].min(axis=1) - margin)
    stops = np.searchsorted(sorted_points[:, 0], corners[..., 0].max(axis=1) + margin, "right")
    for triangle, (start, stop) in enumerate(zip(starts.tolist(), stops.tolist())):
        if start == stop:
            continue
        a, b, c = corners[triangle]
        u, v, to = b - a, c - a, sorted_points[start:stop] - a
        twice = u[0] * v[1] - u[1] * v[0]
        s = (to[:, 0] * v[1] - to[:, 1] * v[0]) / twice
        t = (u[0] * to[:, 1] - u[1] * to[:, 0]) / twice
        weights = np.column_stack([1 - s - t, s, t])
        least = weights.min(axis=1)
        better = np.flatnonzero(least > best[start:stop])
        best[start:stop][better] = least[better]
        result[order[start:stop][better]] = weights[better] @ values[triangulation.triangles[triangle]]
    return result
