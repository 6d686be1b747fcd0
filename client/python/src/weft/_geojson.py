# SPDX-License-Identifier: Apache-2.0
"""A domain from a GeoJSON object, by the rules of files/formats/domains/geojson.h: the same file
gives the same request, and so the same mesh, as on the command line.
"""

from __future__ import annotations

import math
import numbers
import re
from collections.abc import Callable, Sequence
from json import dumps
from typing import Any

import numpy as np
import numpy.typing as npt

from ._names import Label, Labels
from ._rings import find_crossing, find_overlap
from ._text import coordinates, number_of, shortest
from ._warning import warn
from .errors import DomainError

Points = npt.NDArray[np.float64]


# As files/formats/domains/left_out.h has it.
_LEFT_OUT = {"ring without an area": "rings without an area",
             "line without a length": "lines without a length",
             "empty geometry": "empty geometries"}
_MOST_TOLD = 5  # of each kind


class _Reader:
    def __init__(self, file: str) -> None:
        self.marker_labels, self.region_labels = Labels("marker", file), Labels("region", file)
        self.points: list[Points] = []
        self.segments: list[npt.NDArray[np.int64]] = []
        self.markers: list[Label] = []  # of each of `segments`
        self.borders: list[int] = []  # of each of `segments`, 0 or 1 + its polygon
        # Of each polygon its region's label, if it asks for one, and its properties.
        self.polygons: list[tuple[Label | None, dict[str, Any]]] = []
        self.count = 0
        self.left_out: dict[str, int] = {}
        self.first_left_out = ""
        self.file = file
        self.odd_properties = 0
        self.open_rings = 0
        self.crossings = 0
        self.overlaps = 0

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
            if "geometry" not in json:
                raise DomainError(f"{path or 'the root'} has no \"geometry\"")
            if json["geometry"] is not None:
                self.read(json["geometry"], f"{where}geometry",
                          self.properties(json.get("properties") or {}, f"{where}properties"))
        else:
            self.geometry(kind, json.get("coordinates"), f"{where}coordinates", properties)

    def geometry(self, kind: str, coordinates: Any, path: str, properties: dict[str, Any]) -> None:
        kinds: dict[str, Callable[[Any, str, dict[str, Any]], None]] = {
            "Point": self.point, "LineString": self.line, "LinearRing": self.line,
            "Polygon": self.polygon}
        read = kinds.get(kind.removeprefix("Multi"))
        if read is None:
            raise DomainError(f"{path} is of the type {kind!r}, which is not GeoJSON's" +
                              ("; TopoJSON is read from files named .topojson" if kind == "Topology" else ""))
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

    def leave_out_property(self, path: str, what: str) -> None:
        self.odd_properties += 1
        if self.odd_properties <= _MOST_TOLD:
            self.warn(f"{path} is left out: it is {what}")

    def warn(self, text: str) -> None:
        warn(f"{self.file}: {text}" if self.file else text)

    def properties(self, properties: Any, path: str) -> dict[str, Any]:
        """Those that count: whole numbers, names and bounds."""
        found: dict[str, Any] = {}
        for kind in ("marker", "region"):
            value = _value(properties, kind)
            is_number = isinstance(value, numbers.Real) and not isinstance(value, bool)
            if is_number:
                if not -2**31 <= value < 2**31 or value != int(value):
                    raise DomainError(f"{path}.{kind} is {shortest(_float(value))}, not an integer of 32 "
                                      "bits")
                found[kind] = int(value)
            elif value is not None and not isinstance(value, str):
                self.leave_out_property(f"{path}.{kind}", f"{_shown(value)}, neither a number nor a text")
            name = _property(properties, f"{kind}_name")
            if name is not None and not isinstance(name, str):
                self.leave_out_property(f"{path}.{kind}_name", f"{_shown(name)}, not a text")
            elif isinstance(value, str):
                if name and name.strip() and name != value:
                    self.leave_out_property(f"{path}.{kind}_name", f"{name!r} beside the name {value!r}")
            elif name and name.strip():
                found[f"{kind}_name"] = name
            if isinstance(value, str):
                found[f"{kind}_name"] = value
        return found | _bounds(properties, path)

    def point(self, position: Any, path: str, properties: dict[str, Any]) -> None:
        self.points.append(_positions([position], path))
        self.count += 1

    def line(self, positions: Any, path: str, properties: dict[str, Any]) -> None:
        points = _positions(positions, path)
        if len(points) < 2:
            self.marker_labels.of(properties)  # as the command line numbers names
            self.leave_out("line without a length", path)
            return
        self.chain(points, 0, properties)

    def polygon(self, rings: Any, path: str, properties: dict[str, Any]) -> None:
        kept: dict[str, Points] = {}  # by their paths
        crossings = self.crossings
        for i, ring in enumerate(rings):
            points = _positions(ring, f"{path}[{i}]")
            if _is_collapsed(points):
                self.marker_labels.of(properties)
                self.leave_out("ring without an area", f"{path}[{i}]")
                if i == 0:  # its holes have no more
                    return
                continue
            points = self.without_end(points, f"{path}[{i}]")
            kept[f"{path}[{i}]"] = points
            self.check_crossing(points, ring, f"{path}[{i}]")
            self.chain(points, len(self.polygons) + 1, properties)
        if self.crossings == crossings:
            self.check_overlap(kept)
        if len(rings):
            asks = {"region", "region_name"} & properties.keys()
            self.polygons.append((self.region_labels.of(properties) if asks else None, properties))

    def without_end(self, ring: Points, path: str) -> Points:
        """A ring less its last position, which repeats the first. Tells of one that does not."""
        if (ring[0] == ring[-1]).all():
            return ring[:-1]
        self.open_rings += 1
        if self.open_rings <= _MOST_TOLD:
            self.warn(f"{path} is a ring that is not closed: it starts at {coordinates(*ring[0].tolist())} and ends "
                      f"at {coordinates(*ring[-1].tolist())}; a segment closes it")
        return ring

    def check_crossing(self, ring: Points, positions: Any, path: str) -> None:
        """Tells of a ring that crosses itself; `positions`: as it is given."""
        found = find_crossing(ring)
        if found is None:
            return
        self.crossings += 1
        if self.crossings > _MOST_TOLD:
            return
        numbers = np.flatnonzero(_is_new(_all_positions(positions, path)))
        edges = (f"edge {numbers[i]} from {coordinates(*ring[i].tolist())} to "
                 f"{coordinates(*ring[(i + 1) % len(ring)].tolist())}" for i in found)
        self.warn(f"{path} is a ring that crosses itself: {' crosses '.join(edges)}")

    def check_overlap(self, rings: dict[str, Points]) -> None:
        """Tells of rings that parity does not treat as holes of the first."""
        found = find_overlap(list(rings.values()))
        if found is None:
            return
        self.overlaps += 1
        if self.overlaps > _MOST_TOLD:
            return
        ring, crossed, at = found
        paths = list(rings)
        place = coordinates(*at.tolist())
        fault = ("is a hole that is outside of its polygon or in another hole, at " if crossed is None else
                 f"is a ring that crosses another of its polygon: {paths[crossed]}, near ")
        self.warn(f"{paths[ring]} {fault}{place}; what an odd number of the rings encloses is meshed")

    def chain(self, points: Points, area: int, properties: dict[str, Any]) -> None:
        """A ring of the polygon that 1 less than `area` numbers, or a line if it is 0."""
        numbers = np.arange(self.count, self.count + len(points))
        segments = np.column_stack([numbers, np.roll(numbers, -1)])
        self.points.append(points)
        self.count += len(points)
        self.segments.append(segments if area else segments[:-1])
        self.borders.append(area)
        self.markers.append(self.marker_labels.of(properties))

    def domain(self, area: Callable[..., Any]) -> dict[str, Any]:
        """What Domain is made of."""
        if not self.points:
            raise DomainError("it holds no geometry" +
                              (f": {self.left_out_sentence()}" if self.left_out else ""))
        if self.left_out:
            self.warn(self.left_out_sentence())
        if self.open_rings > _MOST_TOLD:
            self.warn(f"{self.open_rings - _MOST_TOLD} more rings are not closed")
        if self.crossings > _MOST_TOLD:
            self.warn(f"{self.crossings - _MOST_TOLD} more rings cross themselves")
        if self.odd_properties > _MOST_TOLD:
            self.warn(f"{self.odd_properties - _MOST_TOLD} more properties are left out")
        if self.overlaps > _MOST_TOLD:
            self.warn(f"{self.overlaps - _MOST_TOLD} more polygons have rings that overlap")
        marker_of, marker_names = self.marker_labels.numbers()
        region_of, region_names = self.region_labels.numbers()
        lengths = [len(segments) for segments in self.segments]
        return {
            "points": np.concatenate(self.points),
            "segments": np.concatenate([*self.segments, np.zeros((0, 2), np.int64)]),
            "markers": np.repeat([marker_of[label] for label in self.markers], lengths).astype(np.int32),
            "areas": [area(None if label is None else region_of[label], _bound(properties))
                      for label, properties in self.polygons],
            "segment_areas": np.repeat(self.borders, lengths).astype(np.uint32),
            "marker_names": marker_names,
            "region_names": region_names,
            "fill": "union" if self.polygons else "seeds",
        }


def read(json: Any, area: Callable[..., Any], file: str = "") -> dict[str, Any]:
    """The arguments of Domain; `area` makes an Area of a region and a bound; `file`: what warnings name."""
    reader = _Reader(file)
    reader.read(json, "", {})
    domain = reader.domain(area)
    system = _system(json)
    code = re.split("[:/#]", system.lower())[-1]
    domain["geographic"] = (code in _WGS84 | _GEOGRAPHIC if system else _looks_geographic(domain["points"])) or None
    if system and code not in _WGS84:
        reader.warn(f"its crs is '{system}', not WGS 84 as GeoJSON's is; coordinates are taken as they are")
    return domain


_WGS84 = {"crs84", "4326", "4979"}
_GEOGRAPHIC = {"crs27", "crs83", "4258", "4267", "4269", "4283", "4490", "4617", "4674", "7844"}
"""What the names of systems in longitude and latitude end with: of WGS 84, and of those that the coastlines and
boundaries of many countries come in."""


def _looks_geographic(points: Points) -> bool:
    """GeoJSON is in longitude and latitude, but drawings in a plane are written as GeoJSON, too: most of
    these lie around the origin, or have round coordinates."""
    low, high = points.min(axis=0), points.max(axis=0)
    on_earth = (low >= (-180, -90)).all() and (high <= (180, 90)).all()
    around_origin = (low <= 0).all() and (high >= 0).all()
    fine = np.abs(1000 * points - np.round(1000 * points)) > 1e-6
    return bool(on_earth and not around_origin and 2 * fine.sum() >= fine.size)


def _system(json: dict[str, Any]) -> str:
    """What the member `crs`, of GeoJSON before RFC 7946, names, if anything."""
    crs = json.get("crs")
    if crs is None:
        return ""
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = properties.get("name") if isinstance(properties, dict) else None
    if not isinstance(name, str):
        return dumps(crs)
    return name


def _bound(properties: dict[str, Any]) -> float | None:
    """That max_area and max_edge make together."""
    bounds = [properties["max_area"]] if "max_area" in properties else []
    if "max_edge" in properties:
        bounds.append(0.4330127018922193 * properties["max_edge"] * properties["max_edge"])
    return min(bounds, default=None)


def _property(properties: Any, name: str) -> Any:
    """The member of this name; otherwise the first, in the order of the alphabet, that only capitals tell
    apart, as databases write them."""
    if name in properties:
        return properties[name]
    others = (key for key in properties if isinstance(key, str) and key.isascii() and key.lower() == name)
    key = min(others, default=None)
    return None if key is None else properties[key]


def _value(properties: Any, name: str) -> Any:
    """A property; a text that is a number is that number, one of blanks is none."""
    value = _property(properties, name)
    if not isinstance(value, str):
        return value
    number = number_of(value)
    return (value if value.strip() else None) if number is None else number


def _bounds(properties: Any, path: str) -> dict[str, float]:
    found: dict[str, float] = {}
    for name in ("max_area", "max_edge"):
        bound = _value(properties, name)
        if bound is None:  # as programs write features that lack a column of their table
            continue
        if isinstance(bound, bool) or not isinstance(bound, numbers.Real):
            raise DomainError(f"{path}.{name} is {_shown(bound)}, not a number")
        number = _float(bound)
        if not number > 0:
            raise DomainError(f"{path}.{name} is {shortest(number)}, not positive")
        if math.isinf(number):
            raise DomainError(f"{path}.{name} is larger than the largest number of double precision, "
                              "1.8e308")
        found[name] = number
    return found


def _shown(value: Any) -> str:
    """For messages."""
    text = dumps(value, default=repr)
    return f"{text[:40]}..." if len(text) > 40 else text


def _float(value: Any) -> float:
    """Infinite if it is too large for one: an integer has no largest."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def _positions(positions: Any, path: str) -> Points:
    """(n, 2), less those that repeat their predecessor."""
    points = _all_positions(positions, path)
    distinct: Points = points[_is_new(points)]
    return distinct


def _is_new(points: Points) -> npt.NDArray[np.bool_]:
    """Of each point, whether it differs from its predecessor."""
    new: npt.NDArray[np.bool_] = np.concatenate([[True], (points[1:] != points[:-1]).any(axis=1)])[:len(points)]
    return new


def _all_positions(positions: Any, path: str) -> Points:
    """(n, 2)."""
    try:
        given = np.array([position[:2] for position in positions])
        if given.dtype.kind in "bUS":  # numpy would read numbers out of texts
            raise TypeError
        return given.astype(np.float64).reshape(-1, 2)
    except (TypeError, ValueError, IndexError, OverflowError):
        raise DomainError(f"{path} does not hold positions [x, y]") from None


def _is_collapsed(points: Points) -> bool:
    """Whether there are fewer than 3 distinct points. That all are on one line does not count: a ring
    around a pole is, in degrees."""
    return len(np.unique(points, axis=0)) < 3
