# SPDX-License-Identifier: Apache-2.0
"""Where a ring crosses itself, and where the rings of a polygon overlap, as
files/formats/domains/ring_crossing.h finds it: for warnings alone, so without exact predicates, and not to the
end in polygons of very many edges near each other."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
import numpy.typing as npt

Points = npt.NDArray[np.float64]

_FEW = 16  # corners of a ring, of which numpy's calls would take longer than the work
_MOST_WORK = 50_000_000  # edges that are looked at, about a second of work


def find_crossing(ring: Points) -> tuple[int, int] | None:
    """Two edges whose insides cross, by their first corners, the lower first."""
    if len(ring) <= _FEW:
        return _crossing_of_few(ring)
    ends = np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)
    low, high = ends.min(axis=1), ends.max(axis=1)
    # Along the axis on which fewer edges overlap: each with those that begin before it ends.
    orders = [np.argsort(low[:, axis], kind="stable") for axis in (0, 1)]
    counts = [np.searchsorted(low[order, axis], high[order, axis], "right") - np.arange(1, len(ring) + 1)
              for axis, order in enumerate(orders)]
    axis = int(counts[1].sum() < counts[0].sum())
    order, after = orders[axis], counts[axis]
    if after.sum() > _MOST_WORK:
        return None
    first = np.arange(len(ring))
    for step in range(1, int(after.max(initial=0)) + 1):
        first = first[after[first] >= step]
        i, j = order[first], order[first + step]
        near = ((low[i] <= high[j]) & (low[j] <= high[i])).all(axis=1)
        i, j = i[near], j[near]
        crossing = np.flatnonzero(_cross(ends[i, 0], ends[i, 1], ends[j, 0], ends[j, 1]))
        if len(crossing):
            a, b = int(i[crossing[0]]), int(j[crossing[0]])
            return min(a, b), max(a, b)
    return None


def _crossing_of_few(ring: Points) -> tuple[int, int] | None:
    corners = [complex(*corner) for corner in ring.tolist()]
    for (i, (a, b)), (j, (c, d)) in combinations(enumerate(zip(corners, corners[1:] + corners[:1])), 2):
        u, v = (b - a).conjugate(), (d - c).conjugate()
        if ((u * (c - a)).imag * (u * (d - a)).imag < 0) and ((v * (a - c)).imag * (v * (b - c)).imag < 0):
            return i, j
    return None


class _Ring:
    """Its edges by their lower ordinates, so that those at a height are found."""

    def __init__(self, points: Points) -> None:
        self.points = points
        ends = np.stack([points, np.roll(points, -1, axis=0)], axis=1)
        bottoms = ends[:, :, 1].min(axis=1)
        self._tallest = float((ends[:, :, 1].max(axis=1) - bottoms).max())
        order = np.argsort(bottoms, kind="stable")
        self._edges, self._bottoms = ends[order], bottoms[order]

    def edges(self, bottom: float, top: float) -> Points:
        """(k, 2, 2): the ends of all edges between two heights, and of others."""
        first = int(np.searchsorted(self._bottoms, bottom - self._tallest * (1 + 1e-9)))
        found: Points = self._edges[first:int(np.searchsorted(self._bottoms, top, "right"))]
        return found


def find_overlap(rings: Sequence[Points]) -> tuple[int, int | None, Points] | None:
    """A hole that is in part outside of the first ring or in another hole: its index, that of a ring whose
    edges it crosses, and a place."""
    if len(rings) < 2:
        return None
    low = np.array([ring.min(axis=0) for ring in rings])
    high = np.array([ring.max(axis=0) for ring in rings])
    sorted_rings = [_Ring(ring) for ring in rings]
    work = 0
    for i, ring in enumerate(sorted_rings[1:], 1):
        near = np.flatnonzero(((low[:i] <= high[i]) & (low[i] <= high[:i])).all(axis=1)).tolist()
        for j in sorted({0, *near}):
            other = sorted_rings[j]
            close = other.edges(low[i, 1], high[i, 1])
            work += i + len(ring.points) + len(close)
            if work > _MOST_WORK:
                return None
            crossing = _crossing(ring, close, low[i], high[i])
            if crossing is not None:
                return i, j, crossing
            same = len(ring.points) == len(other.points) and \
                set(map(tuple, ring.points)) == set(map(tuple, other.points))
            overlaps = (not same and _is_inside(ring, other) is False if j == 0 else
                        same or _is_inside(ring, other) or _is_inside(other, ring))
            if overlaps:
                return i, None, ring.points[np.lexsort(ring.points.T[::-1])[0]]
    return None


def _side(a: Points, b: Points, p: Points) -> Points:
    """Of p to the line from a to b: positive on its left."""
    u, v = b - a, p - a
    side: Points = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return side


def _cross(a: Points, b: Points, c: Points, d: Points) -> npt.NDArray[np.bool_]:
    """Whether the inside of the edge from a to b crosses that of the edge from c to d."""
    crosses: npt.NDArray[np.bool_] = ((_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0))
    return crosses


def _crossing(ring: _Ring, edges: Points, low: Points, high: Points) -> Points | None:
    """The start of an edge of a ring, which lies in a box, whose inside crosses that of one of the edges."""
    close = edges[((edges.min(axis=1) <= high) & (edges.max(axis=1) >= low)).all(axis=1)]
    own = ring.edges(low[1], high[1])
    rows = max(1, 1_000_000 // max(1, len(close)))
    for first in range(0, len(own) if len(close) else 0, rows):
        part = own[first:first + rows, None]
        cross = _cross(part[..., 0, :], part[..., 1, :], close[:, 0], close[:, 1])
        if cross.any():
            start: Points = own[first + int(np.argwhere(cross)[0][0]), 0]
            return start
    return None


def _is_inside(ring: _Ring, other: _Ring) -> bool | None:
    """Whether a ring that does not cross another one lies in it; None if all its corners and the middles of
    its edges are on it."""
    points = ring.points
    for p in np.concatenate([points, (points + np.roll(points, -1, axis=0)) / 2]):
        edges = other.edges(p[1], p[1])
        a, b = edges[:, 0], edges[:, 1]
        side = _side(a, b, p)
        rounding = 1e-12 * np.linalg.norm(b - a, axis=1) * np.linalg.norm(p - a, axis=1)
        if ((np.abs(side) <= rounding) & (((a - p) * (b - p)).sum(axis=1) <= 0)).any():
            continue
        up = (a[:, 1] <= p[1]) & (b[:, 1] > p[1]) & (side > 0)
        down = (b[:, 1] <= p[1]) & (a[:, 1] > p[1]) & (side < 0)
        return bool((np.count_nonzero(up) + np.count_nonzero(down)) % 2)
    return None
