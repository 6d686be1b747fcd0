# SPDX-License-Identifier: Apache-2.0
"""Fields and sizes as a textbook defines them, in numpy alone: every point against every segment.
What a mesh made of its size is measured against these."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def distance(points: Floats, a: Floats, b: Floats) -> Floats:
    """Of points (n, 2) to the nearest of the segments from a (m, 2) to b (m, 2)."""
    along = b - a
    squared = np.einsum("md,md->m", along, along)
    nearest = np.empty(len(points))
    for start in range(0, len(points), 256):  # of which all differences fit in a cache
        off = points[start:start + 256, None] - a
        t = np.clip(np.einsum("nmd,md->nm", off, along) / squared, 0, 1)
        off -= t[..., None] * along
        nearest[start:start + 256] = np.einsum("nmd,nmd->nm", off, off).min(axis=1)
    return np.sqrt(nearest)


def bilinear(points: Floats, values: Floats, origin: tuple[float, float], step: float) -> Floats:
    """At points (n, 2) inside the grid whose values[j, i] is at origin + step * (i, j)."""
    u, v = (points - origin).T / step
    i = np.clip(u.astype(int), 0, values.shape[1] - 2)
    j = np.clip(v.astype(int), 0, values.shape[0] - 2)
    u, v = u - i, v - j
    below = values[j, i] * (1 - u) + values[j, i + 1] * u
    above = values[j + 1, i] * (1 - u) + values[j + 1, i + 1] * u
    return below * (1 - v) + above * v


def limited(points: Floats, sources: Floats, sizes: Floats, growth: float) -> Floats:
    """At points (n, 2) the least, over all sources (m, 2), of what the size there grows to."""
    least = np.empty(len(points))
    for row, point in enumerate(points):
        least[row] = (sizes + growth * np.hypot(*(sources - point).T)).min()
    return least


def patches(points: Floats, most: int) -> list[npt.NDArray[np.intp]]:
    """The rows of points (n, 2), in patches that are near together, of at most so many each."""
    whole = [np.arange(len(points))]
    while len(whole[0]) > most:
        halves = []
        for rows in whole:
            axis = np.ptp(points[rows], axis=0).argmax()
            halves += np.array_split(rows[np.argsort(points[rows, axis])], 2)
        whole = halves
    return whole


def edges_allowed(corners: Floats) -> Floats:
    """Of triangles (n, 3, 2) the edge of the equilateral one with the same area."""
    (x0, y0), (x1, y1), (x2, y2) = np.moveaxis(corners, 0, -1)
    area = ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)) / 2
    return np.sqrt(area * 4 / np.sqrt(3))
