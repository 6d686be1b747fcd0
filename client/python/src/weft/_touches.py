# SPDX-License-Identifier: Apache-2.0
"""Where points of a domain in longitude and latitude lie on the inside of its segments:
files/geo/segment_touches.h."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import DomainError

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

_METRES_PER_DEGREE = 111195.08  # of latitude
_BENT = 1e-6  # square degrees: a shorter segment is bent by a quarter of a millimetre, at most
_MOST_PAIRS = 20_000_000
_MOST_BANDS = 256
_BAND = 4096  # degrees between the keys of two bands, more than any difference of longitudes


def longitude_step(start: Any, end: Any) -> Any:
    """By the short way round, -180 to 180."""
    step = np.asarray(end - start)
    for _ in range(3):
        step = np.where(step > 180, step - 360, step)
        step = np.where(step < -180, step + 360, step)
    return step


def points_on(points: Floats, segments: npt.NDArray[Any], turn: Floats, snap: float) -> dict[int, list[int]]:
    """Per segment that has some, the points within `snap` metres of it and further from its ends, from its
    start on; one of several as near to each other. `points` are in longitudes of less than a turn from
    the west end on, `turn` is the degrees by which a plane turns each segment. Raises DomainError."""
    near = snap / _METRES_PER_DEGREE
    start = points[segments[:, 0]]
    way = np.column_stack([longitude_step(start[:, 0], points[segments[:, 1], 0]),
                           points[segments[:, 1], 1] - start[:, 1]])
    length = np.sqrt(way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1])
    bent = np.flatnonzero((length > 2 * near) & (length * turn >= _BENT))
    if not len(bent):
        return {}
    found = [_near(points, start, way, *pair, near) for pair in _beside(points, start, way, bent, near)]
    segment, along, point = (np.concatenate(column) for column in zip(*found))
    order = np.lexsort((point, along, segment))
    on: dict[int, list[int]] = {}
    for s, p in zip(segment[order].tolist(), point[order].tolist()):
        stops = on.setdefault(s, [])
        if not stops or _distance(points[stops[-1]].tolist(), points[p].tolist()) > near:
            stops.append(p)
    return on


def longitude_scale(latitude: Any) -> Any:
    """The length of a degree of longitude over that of one of latitude; at least 0.01."""
    return np.maximum(0.01, np.cos(latitude * (math.pi / 180)))


def _distance(a: list[float], b: list[float]) -> float:
    """On the sphere, in degrees."""
    x, y = float(longitude_step(a[0], b[0])) * math.cos(a[1] * (math.pi / 180)), b[1] - a[1]
    return math.sqrt(x * x + y * y)


def _near(points: Floats, start: Floats, way: Floats, segment: Indices, point: Indices,
          near: float) -> tuple[Indices, Floats, Indices]:
    """Of pairs of a segment and a point, those that are near, with how far along it the point is, 0 to 1."""
    at, scale = points[point], longitude_scale(points[point, 1])
    dx, dy = way[segment, 0] * scale, way[segment, 1]
    ex, ey = longitude_step(start[segment, 0], at[:, 0]) * scale, at[:, 1] - start[segment, 1]
    length = np.sqrt(dx * dx + dy * dy)
    along = (ex * dx + ey * dy) / length
    off = np.abs(ex * dy - ey * dx) / length
    kept = (along > near) & (along < length - near) & (off <= near)
    return segment[kept], (along / length)[kept], point[kept]


def _beside(points: Floats, start: Floats, way: Floats, segments: Indices,
            near: float) -> list[tuple[Indices, Indices]]:
    """Pairs of a segment and a point that may be near it: points are in bands by latitude, in each of
    which a segment has a range of longitudes."""
    bands = min(_MOST_BANDS, 1 + int(len(points)**0.5))
    band = np.empty(len(points), np.int64)
    band[np.argsort(points[:, 1], kind="stable")] = np.arange(len(points)) * bands // len(points)
    order = np.lexsort((points[:, 0], band))
    key = _BAND * band[order] + points[order, 0]
    south, north = np.full(bands, np.inf), np.full(bands, -np.inf)
    np.minimum.at(south, band, points[:, 1] - 2 * near)
    np.maximum.at(north, band, points[:, 1] + 2 * near)
    reach = 2 * near / longitude_scale(points[:, 1]).min()

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
        count = np.searchsorted(key, east + turn + reach, side="right") - first
        if count.clip(0).sum() > _MOST_PAIRS:
            raise DomainError(f"the domain has so many points near segments that more than {_MOST_PAIRS:,} pairs of "
                              "them would be looked at")
        which, at = _ranges(first, count)
        pairs.append((segment[which], order[at]))
    return pairs


def _ranges(first: Indices, count: Indices) -> tuple[Indices, Indices]:
    """Each of the integers from the firsts on, and of which range it is."""
    count = np.maximum(count, 0)
    which = np.repeat(np.arange(len(count)), count)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(count) - count - first, count)
