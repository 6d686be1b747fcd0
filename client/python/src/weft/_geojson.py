# SPDX-License-Identifier: Apache-2.0
"""A domain from a GeoJSON object, by the rules of client/formats/domains/geojson.h: the same file gives the
same request, and so the same mesh, as the command line does. A ring that crosses itself is taken as
it is, inside by the even-odd rule.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import DomainError

Points = npt.NDArray[np.float64]


class _Reader:
    def __init__(self) -> None:
        self.points: list[Points] = []
        self.segments: list[npt.NDArray[np.int64]] = []
        self.markers: list[npt.NDArray[np.int32]] = []
        self.lines: list[int] = []  # of `segments`, those that are no rings
        self.polygons: list[tuple[slice, dict[str, Any], str]] = []  # those that ask for a region
        self.even_odd = False
        self.count = 0

    def read(self, json: Any, path: str, properties: dict[str, Any]) -> None:
        if not isinstance(json, dict) or not isinstance(json.get("type"), str):
            raise DomainError(f"{path or 'the root'} is not a GeoJSON object")
        kind = json["type"]
        where = f"{path}." if path else ""
        if kind in ("FeatureCollection", "GeometryCollection"):
            name = "features" if kind == "FeatureCollection" else "geometries"
            for i, part in enumerate(json.get(name, ())):
                self.read(part, f"{where}{name}[{i}]", properties)
        elif kind == "Feature":
            if json.get("geometry") is not None:
                self.read(json["geometry"], f"{where}geometry",
                          _properties(json.get("properties") or {}, f"{where}properties"))
        else:
            self.geometry(kind, json.get("coordinates"), f"{where}coordinates", properties)

    def geometry(self, kind: str, coordinates: Any, path: str, properties: dict[str, Any]) -> None:
        kinds: dict[str, Callable[[Any, str, dict[str, Any]], None]] = {
            "Point": self.point, "LineString": self.line, "LinearRing": self.line,
            "Polygon": self.polygon}
        read = kinds.get(kind.removeprefix("Multi"))
        if read is None:
            raise DomainError(f"{path} is of the type {kind!r}, which is not GeoJSON's")
        if coordinates is None:
            raise DomainError(f"{path} is missing")
        if len(coordinates) == 0:  # RFC 7946 allows it: no geometry
            return
        if not kind.startswith("Multi"):
            read(coordinates, path, properties)
            return
        for i, part in enumerate(coordinates):
            read(part, f"{path}[{i}]", properties)

    def point(self, position: Any, path: str, properties: dict[str, Any]) -> None:
        self.points.append(_positions([position], path))
        self.count += 1

    def line(self, positions: Any, path: str, properties: dict[str, Any]) -> None:
        points = _positions(positions, path)
        if len(points) < 2:
            raise DomainError(f"{path} is a line with fewer than 2 distinct points")
        self.lines.append(len(self.segments))
        self.chain(points, False, properties)

    def polygon(self, rings: Any, path: str, properties: dict[str, Any]) -> None:
        first = len(self.segments)
        for i, ring in enumerate(rings):
            points = _positions(ring, f"{path}[{i}]")
            if len(ring) < 4:
                raise DomainError(f"{path}[{i}] is a ring of {len(ring)} positions, it needs 4")
            if (points[0] != points[-1]).any():
                raise DomainError(f"{path}[{i}] is a ring that is not closed: it starts at "
                                  f"{tuple(points[0])} and ends at {tuple(points[-1])}")
            if len(points) < 4:
                raise DomainError(f"{path}[{i}] is a ring with fewer than 3 distinct points")
            self.chain(points[:-1], True, properties)
        self.even_odd = True
        if {"region", "max_area", "max_edge"} & properties.keys():
            self.polygons.append((slice(first, len(self.segments)), properties, path))

    def chain(self, points: Points, closed: bool, properties: dict[str, Any]) -> None:
        numbers = np.arange(self.count, self.count + len(points))
        segments = np.column_stack([numbers, np.roll(numbers, -1)])
        self.points.append(points)
        self.count += len(points)
        self.segments.append(segments if closed else segments[:-1])
        self.markers.append(np.full(len(self.segments[-1]), properties.get("marker", 0), np.int32))

    def domain(self, region: Callable[..., Any]) -> dict[str, Any]:
        """What Domain is made of."""
        if not self.points:
            raise DomainError("it holds no geometry")
        points = np.concatenate(self.points)
        every = np.concatenate([*self.segments, np.zeros((0, 2), np.int64)])
        regions = []
        for polygon, properties, path in self.polygons:
            seed = _interior_point(points, np.concatenate(self.segments[polygon]), every)
            if seed is None:
                raise DomainError(f"{path} is a polygon with a region but without area")
            regions.append(region(*seed, properties.get("region", 0), properties.get("max_area"),
                                  properties.get("max_edge")))
        # Two coincident segments leave the parity of even-odd filling alone.
        twice = self.lines if self.even_odd else []
        return {
            "points": points,
            "segments": np.concatenate([every, *(self.segments[i] for i in twice)]),
            "markers": np.concatenate([*self.markers, *(self.markers[i] for i in twice),
                                       np.zeros(0, np.int32)]),
            "regions": regions,
            "fill": "even-odd" if self.even_odd else "seeds",
        }


def read(json: Any, region: Callable[..., Any]) -> dict[str, Any]:
    """The arguments of Domain; `region` makes a Region of x, y, id, max_area and
    max_edge."""
    reader = _Reader()
    reader.read(json, "", {})
    return reader.domain(region)


def _properties(properties: Any, path: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name in ("marker", "region"):
        value = properties.get(name)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            if value != int(value) or not -2**31 <= value < 2**31:
                raise DomainError(f"{path}.{name} is {value}, not an integer of 32 bits")
            found[name] = int(value)
    for name in ("max_area", "max_edge"):
        bound = properties.get(name)
        if isinstance(bound, (int, float)) and not isinstance(bound, bool):
            if not bound > 0:
                raise DomainError(f"{path}.{name} is {bound}, not positive")
            found[name] = float(bound)
    return found


def _positions(positions: Any, path: str) -> Points:
    """(n, 2), less those that repeat their predecessor."""
    try:
        points = np.array([position[:2] for position in positions], np.float64).reshape(-1, 2)
    except (TypeError, ValueError, IndexError):
        raise DomainError(f"{path} does not hold positions [x, y]") from None
    if len(points) == 0:
        return points
    new = np.concatenate([[True], (points[1:] != points[:-1]).any(axis=1)])
    distinct: Points = points[new]
    return distinct


def _interior_point(points: Points, own: npt.NDArray[np.int64],
                    every: npt.NDArray[np.int64]) -> tuple[float, float] | None:
    """A point inside the polygon of the segments `own`, away from all segments: on a line through
    the widest gap between ordinates, the middle of the widest piece inside."""
    ordinates = np.unique(points[own, 1])
    if len(ordinates) < 2:
        return None
    gap = int(np.argmax(np.diff(ordinates)))
    low, high = ordinates[gap], ordinates[gap + 1]
    # Vertices of others may lie in the gap: take the widest of what they leave.
    between = points[every, 1]
    stops = np.unique(np.concatenate([[low, high], between[(between > low) & (between < high)]]))
    gap = int(np.argmax(np.diff(stops)))
    y = stops[gap] / 2 + stops[gap + 1] / 2

    def crossings(segments: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
        a, b = points[segments[:, 0]], points[segments[:, 1]]
        met = (a[:, 1] > y) != (b[:, 1] > y)
        a, b = a[met], b[met]
        crossed: npt.NDArray[np.float64] = np.sort(
            a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0]))
        return crossed

    xs = crossings(every)
    left, right = xs[:-1], xs[1:]
    inside = np.searchsorted(crossings(own), left, side="right") % 2 == 1
    widths = np.where(inside, right - left, 0)
    if not len(widths) or widths.max() <= 0:
        return None
    widest = int(np.argmax(widths))
    return float(left[widest] / 2 + right[widest] / 2), float(y)
