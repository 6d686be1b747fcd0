# SPDX-License-Identifier: Apache-2.0
"""A mesh as an image: means per pixel, for meshes of more triangles than can be seen."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Box = tuple[float, float, float, float]

_SPACING = 0.7  # pixels between samples
_AT_ONCE = 1 << 20  # samples


def image(corners: Floats, values: Floats, box: Box, size: int, means: bool) -> Floats:
    """(rows, columns) float64 over the box (min x, min y, max x, max y), the lowest row first, `size`
    pixels along its longer side; NaN where there is no triangle.

    `corners`: (m, 3, 2); `values`: (m,). A pixel has the mean of the triangles that it meets, by their
    area in it, or, without `means`, the value of one of them. Samples each triangle on a lattice of
    its own, so that the work is proportional to the triangles and the pixels.
    """
    left, bottom, right, top = box
    step = max(right - left, top - bottom) / size
    columns = max(1, round((right - left) / step))
    rows = max(1, round((top - bottom) / step))
    at = (corners - (left, bottom)) / ((right - left) / columns, (top - bottom) / rows)
    # Of a triangle that reaches out of the box, at most what a box of twice its size needs is sampled.
    sides = np.roll(at, -1, axis=1) - at
    longest = np.hypot(sides[..., 0], sides[..., 1]).max(axis=1)
    areas = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    counts = np.clip(np.ceil(np.minimum(longest, 4 * size) / _SPACING), 1, None).astype(np.int64)
    sums, weights = np.zeros(rows * columns), np.zeros(rows * columns)
    order = np.argsort(counts, kind="stable")
    ends = np.flatnonzero(np.diff(counts[order], append=-1)) + 1
    start = 0
    for end in ends.tolist():
        k = int(counts[order[start]])
        lattice = _lattice(k)
        step_of = max(1, _AT_ONCE // len(lattice))
        for first in range(start, end, step_of):
            some = order[first:min(end, first + step_of)]
            points = np.einsum("sc,tcd->tsd", lattice, at[some])
            column = np.floor(points[..., 0]).astype(np.int64)
            row = np.floor(points[..., 1]).astype(np.int64)
            inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
            pixel = (row * columns + column)[inside]
            shares = np.broadcast_to((areas[some] / len(lattice))[:, None], inside.shape)[inside]
            of = np.broadcast_to(values[some][:, None], inside.shape)[inside]
            if means:
                sums += np.bincount(pixel, shares * of, len(sums))
                weights += np.bincount(pixel, shares, len(sums))
            else:
                sums[pixel], weights[pixel] = of, 1
        start = end
    with np.errstate(invalid="ignore"):
        out: Floats = (sums / np.where(weights > 0, weights, np.nan)).reshape(rows, columns)
    return out


def _lattice(k: int) -> npt.NDArray[Any]:
    """(k**2, 3): the centroids of the k**2 parts of a triangle, in barycentric coordinates."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(k), np.arange(k)))
    up = i + j < k
    down = i + j < k - 1
    u = np.concatenate([i[up] + 1 / 3, i[down] + 2 / 3]) / k
    v = np.concatenate([j[up] + 1 / 3, j[down] + 2 / 3]) / k
    return np.column_stack([1 - u - v, u, v])
