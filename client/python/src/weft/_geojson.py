# SPDX-License-Identifier: Apache-2.0
"""A domain from a GeoJSON object, by the rules of client/formats/domains/geojson.h: the same file
gives the same request, and so the same mesh, as on the command line. A ring that crosses itself is
taken as it is, inside by the even-odd rule.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Sequence
from json import dumps
from typing import Any

import numpy as np
import numpy.typing as npt

from ._names import Label, Labels
from ._text import number_of, shortest
from ._warning import warn
from .errors import DomainError

Points = npt.NDArray[np.float64]


# As client/formats/domains/left_out.h has it.
_LEFT_OUT = {"ring without an area": "rings without an area",
             "line without a length": "lines without a length",
             "empty geometry": "empty geometries",
             "region without an area": "regions without an area"}


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
        self.left_out: dict[str, int] = {}
        self.first_left_out = ""
        self.file = file

    def leave_out(self, what: str, path: str) -> None:
        """Of which nothing can be meshed; `what` is one of _LEFT_OUT."""
        self.first_left_out = self.first_left_out or path or "the geometry"
        self.left_out[what] = self.left_out.get(what, 0) + 1

    def left_out_sentence(self) -> str:
        counts = [(self.left_out[one], one, many) for one, many in _LEFT_OUT.items()
                  if one in self.left_out]
        parts = [f"{count:,} {one if count == 1 else many}" for count, one, many in counts]
        joined = " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)
        said = "is left out: " if sum(self.left_out.values()) == 1 else "are left out, the first is "
        return f"{joined} {said}{self.first_left_out}"

    def read(self, json: Any, path: str, properties: dict[str, Any]) -> None:
        if not isinstance(json, dict) or not isinstance(json.get("type"), str):
            raise DomainError(f"{path or 'the root'} is not a GeoJSON object")
        kind = json["type"]
        where = f"{path}." if path else ""
        if kind in ("FeatureCollection", "GeometryCollection"):
            name = "features" if kind == "FeatureCollection" else "geometries"
            for i, part in enumerate(json.get(name, ())):
                if part is None:
                    self.leave_out("empty geometry", f"{where}{name}[{i}]")
                else:
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
        if len(coordinates) == 0:  # RFC 7946 allows it
            self.leave_out("empty geometry", path.removesuffix("coordinates").removesuffix("."))
            return
        if not kind.startswith("Multi"):
            read(coordinates, path, properties)
            return
        for i, part in enumerate(coordinates):
            if isinstance(part, Sequence) and len(part) == 0:
                self.leave_out("empty geometry", f"{path}[{i}]")
            else:
                read(part, f"{path}[{i}]", properties)

    def point(self, position: Any, path: str, properties: dict[str, Any]) -> None:
        self.points.append(_positions([position], path))
        self.count += 1

    def line(self, positions: Any, path: str, properties: dict[str, Any]) -> None:
        points = _positions(positions, path)
        if len(points) < 2:
            self.marker_labels.of(properties)  # as the command line numbers names
            self.leave_out("line without a length", path)
            return
        self.lines.append(len(self.segments))
        self.chain(points, False, properties)

    def polygon(self, rings: Any, path: str, properties: dict[str, Any]) -> None:
        first = len(self.segments)
        for i, ring in enumerate(rings):
            points = _positions(ring, f"{path}[{i}]")
            if _is_collapsed(points):
                self.marker_labels.of(properties)
                self.leave_out("ring without an area", f"{path}[{i}]")
                if i == 0:  # its holes have no more
                    return
                continue
            if (points[0] != points[-1]).any():
                raise DomainError(f"{path}[{i}] is a ring that is not closed: it starts at "
                                  f"{tuple(points[0])} and ends at {tuple(points[-1])}")
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
            raise DomainError("it holds no geometry" +
                              (f": {self.left_out_sentence()}" if self.left_out else ""))
        points = np.concatenate(self.points)
        every = np.concatenate([*self.segments, np.zeros((0, 2), np.int64)])
        marker_of, marker_names = self.marker_labels.numbers()
        region_of, region_names = self.region_labels.numbers()
        regions = []
        for polygon, label, properties, path in self.polygons:
            seed = _interior_point(points, np.concatenate(self.segments[polygon]), every)
            if seed is None:
                self.leave_out("region without an area", path)
                continue
            regions.append(region(*seed, region_of[label], properties.get("max_area"),
                                  properties.get("max_edge")))
        if self.left_out:
            warn((f"{self.file}: " if self.file else "") + self.left_out_sentence())
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


def _value(properties: Any, name: str) -> Any:
    """A property; a text that is a number is that number, one of blanks is none."""
    value = properties.get(name)
    if not isinstance(value, str):
        return value
    number = number_of(value)
    return (value if value.strip() else None) if number is None else number


def _properties(properties: Any, path: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name in ("marker", "region"):
        value = _value(properties, name)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            if not -2**31 <= value < 2**31 or value != int(value):
                raise DomainError(f"{path}.{name} is {shortest(_float(value))}, not an integer of 32 "
                                  "bits")
            found[name] = int(value)
        texts = (value, properties.get(f"{name}_name"))
        if text := next((text for text in texts if text and isinstance(text, str)), ""):
            found[f"{name}_name"] = text
    for name in ("max_area", "max_edge"):
        bound = _value(properties, name)
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


def _is_collapsed(points: Points) -> bool:
    """Whether there are fewer than 3 distinct points. That all are on one line does not count: a ring
    around a pole is, in degrees."""
    return len(np.unique(points, axis=0)) < 3


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
