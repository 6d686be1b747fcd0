# SPDX-License-Identifier: Apache-2.0
"""Where points of a domain in longitude and latitude lie on the inside of its segments:
files/geo/segment_touches.h."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

_BENT = 1e-6  # square degrees: a shorter segment is bent by a quarter of a millimetre, at most
_MOST_BANDS = 256
_BAND = 4096  # degrees between the keys of two bands, more than any difference of longitudes


def longitude_step(start: Any, end: Any) -> Any:
    """By the short way round, -180 to 180."""
    step = np.asarray(end - start)
    for _ in range(3):
        step = np.where(step > 180, step - 360, step)
        step = np.where(step < -180, step + 360, step)
    return step


def points_on(points: Floats, segments: npt.NDArray[Any], turn: Floats, near: float) -> dict[int, list[int]]:
    """Per segment that has some, the points within `near` of it and further from its ends, from its
    start on; one of several as near to each other. `points` are in longitudes of less than a turn from
    the west end on, `turn` is the degrees by which a plane turns each segment."""
    start = points[segments[:, 0]]
    way = np.column_stack([longitude_step(start[:, 0], points[segments[:, 1], 0]),
                           points[segments[:, 1], 1] - start[:, 1]])
    length = np.sqrt(way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1])
    bent = np.flatnonzero(length * turn >= _BENT)
    if not len(bent):
        return {}
    found = [_near(points, start, way, length, *pair, near) for pair in _beside(points, start, way, bent, near)]
    segment, along, point = (np.concatenate(column) for column in zip(*found))
    order = np.lexsort((point, along, segment))
    on: dict[int, list[int]] = {}
    last, at = -1, 0.0
    for s, distance, p in zip(segment[order].tolist(), along[order].tolist(), point[order].tolist()):
        if s != last or distance - at > near:
            on.setdefault(s, []).append(p)
            last, at = s, distance
    return on


def _near(points: Floats, start: Floats, way: Floats, length: Floats, segment: Indices, point: Indices,
          near: float) -> tuple[Indices, Floats, Indices]:
    """Of pairs of a segment and a point, those that are near, with how far along it the point is."""
    d, long = way[segment], length[segment]
    e = np.column_stack([longitude_step(start[segment, 0], points[point, 0]), points[point, 1] - start[segment, 1]])
    along = (e[:, 0] * d[:, 0] + e[:, 1] * d[:, 1]) / long
    off = np.abs(e[:, 0] * d[:, 1] - e[:, 1] * d[:, 0]) / long
    kept = (along > near) & (along < long - near) & (off <= near)
    return segment[kept], along[kept], point[kept]


def _beside(points: Floats, start: Floats, way: Floats, segments: Indices,
            near: float) -> list[tuple[Indices, Indices]]:
    """Pairs of a segment and a point that may be near it: points are in bands by latitude, in each of
    which a segment has a range of longitudes."""
    bands = min(_MOST_BANDS, 1 + int(len(points)**0.5))
    band = np.empty(len(points), np.int64)
    band[np.argsort(points[:, 1], kind="stable")] = np.arange(len(points)) * bands // len(points)
    order = np.lexsort((points[:, 0], band))
    key = _BAND * band[order] + points[order, 0]
    reach = 2 * near
    south, north = np.full(bands, np.inf), np.full(bands, -np.inf)
    np.minimum.at(south, band, points[:, 1] - reach)
    np.maximum.at(north, band, points[:, 1] + reach)

    low, high = np.sort([start[segments, 1], start[segments, 1] + way[segments, 1]], axis=0)
    first = np.searchsorted(north, low)
    here, within = _ranges(first, np.searchsorted(south, high, side="right") - first)
    segment = segments[here]
    a, d = start[segment], way[segment]
    with np.errstate(all="ignore"):
        ends = (np.array([south[within], north[within]]) - a[:, 1]) / d[:, 1]
    ends = np.where(d[:, 1] == 0, [[0.0], [1.0]], np.clip(np.sort(ends, axis=0), 0, 1))
    west, east = np.sort(a[:, 0] + d[:, 0] * ends, axis=0) + _BAND * within
    pairs = []
    # A segment may go on beyond the longitudes that points have been given.
    for turn in (-360, 0, 360):
        first = np.searchsorted(key, west + turn - reach)
        which, at = _ranges(first, np.searchsorted(key, east + turn + reach, side="right") - first)
        pairs.append((segment[which], order[at]))
    return pairs


def _ranges(first: Indices, count: Indices) -> tuple[Indices, Indices]:
    """Each of the integers from the firsts on, and of which range it is."""
    count = np.maximum(count, 0)
    which = np.repeat(np.arange(len(count)), count)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(count) - count - first, count)
