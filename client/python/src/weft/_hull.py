# SPDX-License-Identifier: Apache-2.0
"""The convex hull of points (A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions",
1979), by exact predicates: no point is outside of it, however near to an edge."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import numpy.typing as npt

from .errors import DomainError

_ROUNDING = 2.0**-50  # relative, of the two products; Shewchuk's bound is 3.3e-16


def _turns_left(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> bool:
    left = (a[0] - c[0]) * (b[1] - c[1])
    right = (a[1] - c[1]) * (b[0] - c[0])
    if abs(left - right) > _ROUNDING * (abs(left) + abs(right)):
        return left > right
    (ax, ay), (bx, by), (cx, cy) = ((Fraction(x), Fraction(y)) for x, y in (a, b, c))
    return (ax - cx) * (by - cy) > (ay - cy) * (bx - cx)


def convex_hull(points: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
    """Indices of the corners, counter-clockwise; of points at one place, the first. Raises DomainError
    if all points lie on a line."""
    places, first = np.unique(points, axis=0, return_index=True)
    chain: list[tuple[float, float]] = [(x, y) for x, y in places.tolist()]
    index = {place: int(at) for place, at in zip(chain, first)}
    halves = []
    for half in (chain, chain[::-1]):
        kept: list[tuple[float, float]] = []
        for point in half:
            while len(kept) > 1 and not _turns_left(kept[-2], kept[-1], point):
                kept.pop()
            kept.append(point)
        halves.append(kept[:-1])
    corners = halves[0] + halves[1]
    if len(corners) < 3:
        raise DomainError(f"vertices: the {len(points)} points lie on a line")
    return np.array([index[corner] for corner in corners])
