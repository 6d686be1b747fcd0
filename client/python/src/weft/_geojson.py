# SPDX-License-Identifier: Apache-2.0
"""A domain from a GeoJSON object, by the rules of client/formats/domains/geojson.h: the same file
gives the same request, and so the same mesh, as on the command line. A ring that crosses itself is
taken as it is, inside by the even-odd rule.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable
from json import dumps
from typing import Any

import numpy as np
import numpy.typing as npt

from ._names import Label, Labels
from ._text import shortest
from .errors import DomainError

Points = npt.NDArray[np.float64]


class _Reader:
    def __init__(self, file: str) -> None:
        self.marker_labels, self.region_labels = Labels("marker", file), Labels("region", file)
        self.points: list[Points] = []
        self.segments: list[npt.NDArray[np.int64]] = []
        self.markers: list[Label] = []  # of each of `segments`
        self.lines: list[int] = []  # of `segments`, those that are no rings
        # Those that ask for a region: their segments, its label, their properties, their path.
        self.polygons: list[tuple[slice, Label, dict[str, Any], str]] = []
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
        if {"region", "region_name", "max_area", "max_edge"} & properties.keys():
            self.polygons.append((slice(first, len(self.segments)), self.region_labels.of(properties),
                                  properties, path))

    def chain(self, points: Points, closed: bool, properties: dict[str, Any]) -> None:
        numbers = np.arange(self.count, self.count + len(points))
        segments = np.column_stack([numbers, np.roll(numbers, -1)])
        self.points.append(points)
        self.count += len(points)
        self.segments.append(segments if closed else segments[:-1])
        self.markers.append(self.marker_labels.of(properties))

    def domain(self, region: Callable[..., Any]) -> dict[str, Any]:
        """What Domain is made of."""
        if not self.points:
            raise DomainError("it holds no geometry")
        points = np.concatenate(self.points)
        every = np.concatenate([*self.segments, np.zeros((0, 2), np.int64)])
        marker_of, marker_names = self.marker_labels.numbers()
        region_of, region_names = self.region_labels.numbers()
        regions = []
        for polygon, label, properties, path in self.polygons:
            seed = _interior_point(points, np.concatenate(self.segments[polygon]), every)
            if seed is None:
                raise DomainError(f"{path} is a polygon with a region but without area")
            regions.append(region(*seed, region_of[label], properties.get("max_area"),
                                  properties.get("max_edge")))
        # Two coincident segments leave the parity of even-odd filling alone.
        twice = self.lines if self.even_odd else []
        return {
            "points": points,
            "segments": np.concatenate([every, *(self.segments[i] for i in twice)]),
            "markers": np.concatenate([np.zeros(0, np.int32), *(
                np.full(len(self.segments[i]), marker_of[self.markers[i]], np.int32)
                for i in (*range(len(self.segments)), *twice))]),
            "regions": regions,
            "marker_names": marker_names,
            "region_names": region_names,
            "fill": "even-odd" if self.even_odd else "seeds",
        }


def read(json: Any, region: Callable[..., Any], file: str = "") -> dict[str, Any]:
    """The arguments of Domain; `region` makes a Region of x, y, id, max_area and
    max_edge; `file`: what warnings name."""
    reader = _Reader(file)
    reader.read(json, "", {})
    return reader.domain(region)


def _properties(properties: Any, path: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name in ("marker", "region"):
        value = properties.get(name)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            if not -2**31 <= value < 2**31 or value != int(value):
                raise DomainError(f"{path}.{name} is {shortest(_float(value))}, not an integer of 32 "
                                  "bits")
            found[name] = int(value)
        texts = (properties.get(key) for key in (name, f"{name}_name"))
        if text := next((text for text in texts if text and isinstance(text, str)), ""):
            found[f"{name}_name"] = text
    for name in ("max_area", "max_edge"):
        bound = properties.get(name)
        if bound is None:  # as programs write features that lack a column of their table
            continue
        if isinstance(bound, bool) or not isinstance(bound, numbers.Real):
            raise DomainError(f"{path}.{name} is {dumps(bound, default=repr)}, not a number")
        number = _float(bound)
        if not number > 0:
            raise DomainError(f"{path}.{name} is {shortest(number)}, not positive")
        if math.isinf(number):
            raise DomainError(f"{path}.{name} is larger than the largest number of double precision, "
                              "1.8e308")
        found[name] = number
    return found


def _float(value: Any) -> float:
    """Infinite if it is too large for one: an integer has no largest."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def _positions(positions: Any, path: str) -> Points:
    """(n, 2), less those that repeat their predecessor."""
    try:
        points = np.array([position[:2] for position in positions], np.float64).reshape(-1, 2)
    except (TypeError, ValueError, IndexError, OverflowError):
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
