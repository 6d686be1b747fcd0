# SPDX-License-Identifier: Apache-2.0
"""The edges between triangles, and what follows from them."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int32]


@dataclasses.dataclass(frozen=True, eq=False)
class Topology:
    """Of triangles (m, 3), none of which shares an edge with two others."""

    edges: Ints
    """(e, 2): the lower vertex first, in ascending order."""
    of_side: npt.NDArray[np.int64]
    """(m, 3): the edge opposite each corner."""
    counts: npt.NDArray[np.int64]
    """(e,): the triangles at each edge, 1 or 2."""

    def neighbors(self) -> Ints:
        """(m, 3): the triangle across the side opposite each corner, -1 if there is none."""
        triangles = np.arange(len(self.of_side))[:, None]
        both = np.zeros(len(self.edges), np.int64)
        np.add.at(both, self.of_side, np.broadcast_to(triangles, self.of_side.shape))
        across = both[self.of_side] - triangles
        across[self.counts[self.of_side] == 1] = -1
        return across.astype(np.int32)

    def find(self, pairs: npt.NDArray[Any]) -> npt.NDArray[np.int64]:
        """(k,): the edges that join the vertices (k, 2), in either order, each of which is one."""
        factor = int(max(self.edges.max(initial=0), pairs.max(initial=0))) + 1
        low, high = np.sort(pairs.astype(np.int64), axis=1).T
        found: npt.NDArray[np.int64] = np.searchsorted(
            self.edges[:, 0].astype(np.int64) * factor + self.edges[:, 1], low * factor + high)
        return found


def topology(triangles: npt.NDArray[Any]) -> Topology:
    """Of triangles (m, 3)."""
    corners = triangles.astype(np.int64)
    ends = np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1).reshape(-1, 2)
    ends.sort(axis=1)
    factor = int(ends.max(initial=0)) + 1
    keys, of_side, counts = np.unique(ends[:, 0] * factor + ends[:, 1], return_inverse=True,
                                      return_counts=True)
    edges = np.column_stack([keys // factor, keys % factor]).astype(np.int32)
    return Topology(edges, of_side.reshape(-1, 3), counts)
