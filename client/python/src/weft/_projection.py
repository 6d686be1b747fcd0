# SPDX-License-Identifier: Apache-2.0
"""Domains in longitude and latitude: into a plane in metres, and their meshes back.

By the rules of files/geo/, with the same choice of a projection, so that the same file gives the
same mesh as `weft mesh --lonlat` does, bit for bit if pyproj has the same version of PROJ. PROJ is
called through pyproj.
"""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _projected_raster
from ._optional import need
from ._raster_window import Window
from ._touches import longitude_step, points_on
from .domain import Domain
from .errors import DomainError
from .fields import Distance, Field, FileField, MeshField, RasterField
from .results import Summary

Floats = npt.NDArray[np.float64]

_DEGREE = math.pi / 180
_STRAIGHT = 1e-3  # of the length of a piece
_SHORT = 0.3  # degrees: turning by them bends a segment by less than _STRAIGHT of its length
_MOST_PIECES = 4096
_MOST_ADDED = 1_000_000
_PER_METRE = 1024  # in the plane, coordinates are multiples of 1 / _PER_METRE
SNAP = 2 / _PER_METRE  # metres: features nearer together are one, unless `snap` says another distance


class Projection:
    """Of one domain, which becomes `domain`, in metres. `snap`: what is to be merged; 0: what is nearer than
    SNAP. Raises DomainError, MissingPackage."""

    def __init__(self, domain: Domain, crs: str | None, to_metres: bool, snap: float) -> None:
        if domain.arcs:
            raise DomainError("a domain in longitude and latitude has no arcs: what is a circle in degrees is "
                              "none in the plane")
        extent = _Extent(domain)
        self.to_metres = to_metres
        self.name = crs if crs else _suitable(domain.points, extent)
        self._plane, self._transformer = _transformer(self.name)
        self._extent = extent
        self._middle = (domain.points[:, 0].min() + domain.points[:, 0].max()) / 2
        points, segments, whole = self._divide(domain, snap if 0 < snap < math.inf else SNAP)
        points[len(domain.points):] = self._as_in_file(points[len(domain.points):])
        self._lonlat = points
        self._metres = self._checked("points", points)
        self.domain = dataclasses.replace(
            domain, points=self._metres, segments=segments, markers=domain.markers[whole],
            segment_areas=domain.segment_areas[whole],
            holes=self._checked("holes", domain.holes),
            regions=[dataclasses.replace(region, x=x, y=y) for region, (x, y) in zip(
                domain.regions, self._checked("regions", np.array(
                    [(region.x, region.y) for region in domain.regions]).reshape(-1, 2)).tolist())])

    def to_lonlat(self, points: Floats, input_points: npt.NDArray[np.int32]) -> Floats:
        """Of a mesh: vertices that are points of the domain get their own degrees back."""
        if self.to_metres:
            return points
        lonlat = self._as_in_file(self._inverse(points))
        vertices, inputs = input_points.T
        same = inputs < len(self._metres)
        same[same] = (self._metres[inputs[same]] == points[vertices[same]]).all(axis=1)
        lonlat[vertices[same]] = self._lonlat[inputs[same]]
        return lonlat

    def brought_back(self, summary: Summary) -> Summary:
        """The summary with the places that it names in degrees, unless the mesh stays in metres."""
        if self.to_metres:
            return summary

        def moved(record: Any, x: str, y: str) -> Any:
            at = np.array([[getattr(record, x), getattr(record, y)]])
            return dataclasses.replace(record, **dict(zip((x, y), self._named_places(at)[0].tolist())))

        unrefined, merging = summary.unrefined, summary.merging
        if unrefined.precision + unrefined.streaming:
            unrefined = moved(unrefined, "x", "y")
        if unrefined.kept:
            unrefined = moved(unrefined, "kept_x", "kept_y")
        if merging.farthest:
            merging = moved(merging, "farthest_x", "farthest_y")
        if merging.vanished_faces:
            merging = moved(merging, "vanished_x", "vanished_y")
        simplification = summary.simplification
        if simplification and simplification.cuts:
            cuts = self._named_places(np.array(simplification.cuts))
            simplification = dataclasses.replace(simplification, cuts=tuple(map(tuple, cuts.tolist())))
        return dataclasses.replace(
            summary, unrefined=unrefined, merging=merging, simplification=simplification,
            narrow=summary.narrow and moved(summary.narrow, "x", "y"),
            outside=summary.outside and moved(summary.outside, "x", "y"),
            layers=summary.layers and moved(summary.layers, "x", "y"))

    def to_plane(self, lonlat: Floats) -> Floats:
        """Raises DomainError for a point that has no place in the plane."""
        return self._finite("points", lonlat)

    def field(self, field: Field) -> Field:
        """The field in the plane: its points are in longitude and latitude, those of an earlier
        mesh in what this one will be; a raster without a system of its own, too."""
        if isinstance(field, Distance):
            return dataclasses.replace(field, points=self._finite("distance", field.points))
        if isinstance(field, MeshField) and not self.to_metres:
            return dataclasses.replace(field, points=self._finite("on_mesh", field.points))
        if isinstance(field, RasterField):
            window = Window(field.values, field.origin, field.spacing)
            return RasterField(**vars(_projected_raster.of_array(window, self._plane,
                                                                 self.domain.box())))
        if isinstance(field, FileField):
            return RasterField(**vars(_projected_raster.of_file(
                field.open(), self._plane, self.domain.box(), field.most)))
        return field

    def _forward(self, lonlat: Floats) -> Floats:
        if not len(lonlat):
            return lonlat.reshape(0, 2)
        return np.column_stack(self._transformer.transform(*lonlat.T))

    def _inverse(self, metres: Floats) -> Floats:
        return np.column_stack(self._transformer.transform(*metres.T, direction="INVERSE"))

    def _named_places(self, metres: Floats) -> Floats:
        """In degrees for people, to 1e-7 of one: to a centimetre."""
        return np.round(self._as_in_file(self._inverse(metres)), 7)

    def _finite(self, what: str, lonlat: Floats) -> Floats:
        at = self._forward(lonlat)
        bad = np.flatnonzero(~np.isfinite(at).all(axis=1))
        if len(bad):
            raise DomainError(f"{what}: point {bad[0]} cannot be projected from longitude and "
                              f"latitude {tuple(lonlat[bad[0]].tolist())}")
        return _on_grid(at)

    def _checked(self, what: str, lonlat: Floats) -> Floats:
        """Points that the projection takes there and back."""
        if not len(lonlat):
            return lonlat
        at = self._forward(self._extent.unwrapped(lonlat))
        there = np.isfinite(at).all(axis=1)
        back = self._inverse(np.where(there[:, None], at, 0))
        away = np.hypot(longitude_step(lonlat[:, 0], back[:, 0]) * np.cos(lonlat[:, 1] * _DEGREE),
                        back[:, 1] - lonlat[:, 1])
        bad = np.flatnonzero(~(there & (away <= 1e-7)))  # degrees: a centimetre
        if len(bad):
            raise DomainError(f"domain.{what}[{bad[0]}], {tuple(lonlat[bad[0]].tolist())}, is outside "
                              f"of what {self.name!r} projects")
        return _on_grid(at)

    def _as_in_file(self, lonlat: Floats) -> Floats:
        lonlat = lonlat.copy()
        lonlat[lonlat[:, 0] <= self._middle - 180, 0] += 360
        lonlat[lonlat[:, 0] > self._middle + 180, 0] -= 360
        return lonlat

    def _divide(self, domain: Domain, snap: float) -> tuple[Floats, npt.NDArray[Any], npt.NDArray[Any]]:
        """Divides segments where points lie on them, and adds points on those that are not straight in
        the plane: all points, the segments, and of each the segment of the domain that it is part of."""
        a, b = domain.points[domain.segments[:, 0]], domain.points[domain.segments[:, 1]]
        turn = _turn_of_segments(a, b)
        stops = points_on(self._extent.unwrapped(domain.points), domain.segments, turn, snap)
        if sum(map(len, stops.values())) > _MOST_ADDED:
            raise DomainError("the domain has so many points on segments that these would be divided more than "
                              f"{_MOST_ADDED:,} times")
        points, count = [domain.points], len(domain.points)
        segments, parts, whole = domain.segments.copy(), [], [np.arange(len(domain.segments))]
        for i in sorted(stops.keys() | np.flatnonzero(turn >= _SHORT).tolist()):
            chain = [segments[i, 0]]
            for stop in [*stops.get(i, ()), segments[i, 1]]:
                start, end = domain.points[chain[-1]], domain.points[stop]
                pieces = self._pieces(start, end)
                # Two segments between the same points get the same points, whatever their direction.
                turned = tuple(end) < tuple(start)
                ends = (end, start) if turned else (start, end)
                steps = np.arange(1, pieces)
                points.append(_on_segment(*ends, (pieces - steps if turned else steps) / pieces))
                chain += [*range(count, count + pieces - 1), stop]
                count += pieces - 1
            if count - len(domain.points) > _MOST_ADDED:
                raise DomainError("the domain has so many long segments that more than "
                                  f"{_MOST_ADDED:,} points would have to be added on them")
            if len(chain) == 2:
                continue
            segments[i] = chain[:2]
            parts.append(np.column_stack([chain[1:-1], chain[2:]]))
            whole.append(np.full(len(chain) - 2, i))
        return np.concatenate(points), np.concatenate([segments, *parts]), np.concatenate(whole)

    def _pieces(self, a: Floats, b: Floats) -> int:
        pieces = 1
        if _turn_of_segments(a[None], b[None])[0] < _SHORT:
            return pieces
        while pieces < _MOST_PIECES and not self._are_straight(a, b, pieces):
            pieces *= 2
        return pieces

    def _are_straight(self, a: Floats, b: Floats, pieces: int) -> bool:
        within = (np.arange(pieces)[:, None] + [0.25, 0.5, 0.75, 1]) / pieces
        at = self._forward(self._extent.unwrapped(_on_segment(a, b, within.ravel())))
        start = self._forward(self._extent.unwrapped(a[None]))
        at = at.reshape(pieces, 4, 2)
        origin = np.concatenate([start, at[:-1, 3]])
        d, away = at[:, 3] - origin, at[:, :3] - origin[:, None]
        off = np.abs(away[..., 0] * d[:, None, 1] - away[..., 1] * d[:, None, 0])
        return bool((off <= _STRAIGHT * (d**2).sum(axis=1)[:, None]).all())


class _Extent:
    """Where on the Earth the points lie: files/geo/lonlat_extent.h."""

    def __init__(self, domain: Domain) -> None:
        if not len(domain.points):
            raise DomainError("the domain has no points")
        for name, points in (("points", domain.points), ("holes", domain.holes),
                             ("regions", [(region.x, region.y) for region in domain.regions])):
            for i, (lon, lat) in enumerate(np.asarray(points).reshape(-1, 2)):
                if not abs(lat) <= 90:
                    raise DomainError(f"domain.{name}[{i}]: the latitude {lat} is not between -90 "
                                      "and 90 degrees")
                if not abs(lon) <= 360:
                    raise DomainError(f"domain.{name}[{i}]: the longitude {lon} is not between -360 "
                                      "and 360 degrees")
        lon, lat = domain.points.T
        if len(domain.segments) and (domain.segments.min() < 0
                                     or domain.segments.max() >= len(domain.points)):
            raise DomainError("a segment names a point that does not exist")
        start, end = lon[domain.segments[:, 0]], lon[domain.segments[:, 1]]
        around = np.flatnonzero(np.abs(end - start) >= 360)
        if len(around):
            raise DomainError(f"domain.segments[{around[0]}] goes all around the Earth: divide it, or "
                              "cut the domain")
        step = longitude_step(start, end)
        west = np.concatenate([_wrapped(lon), _wrapped(np.where(step < 0, end, start))])
        width = np.concatenate([np.zeros(len(lon)), np.abs(step)])
        self.south, self.north = float(lat.min()), float(lat.max())
        self._find_range(west, west + width)
        self.centre = _centre(domain.points)

    def _find_range(self, west: Floats, east: Floats) -> None:
        """Cuts the longitudes in the widest gap between the arcs."""
        order = np.argsort(west, kind="stable")
        west, east = west[order], east[order]
        # How far the arcs before each reach; those that go on beyond 180, from -180 on.
        before = np.concatenate([[west[0]], east]).max() - 360
        reached = np.maximum.accumulate(np.concatenate([[before], east]))[:-1]
        gaps = west - reached
        widest = max(0.0, float(gaps.max()))
        self.west = float(west[np.argmax(gaps)]) if widest > 0 else -180.0
        self.around = widest <= 0
        self.width = 360 - widest

    def unwrapped(self, lonlat: Floats) -> Floats:
        """With longitudes from `west` on, in less than a turn."""
        out = lonlat.copy()
        for _ in range(4):
            out[out[:, 0] < self.west, 0] += 360
            out[out[:, 0] >= self.west + 360, 0] -= 360
        return out


def _suitable(points: Floats, extent: _Extent) -> str:
    """The conformal projection whose scale varies least over the points."""
    best, parameters = math.inf, ""
    shown = np.vstack([points[::1 + (len(points) - 1) // 10_000], [extent.centre]])
    phi = shown[:, 1] * _DEGREE
    for text, log_scale, central in _candidates(extent):
        with np.errstate(all="ignore"):
            scale = log_scale(_wrapped(shown[:, 0] - central) * _DEGREE, phi)
        least, most = float(scale.min()), float(scale.max())
        if most - least < best:
            best = most - least
            parameters = f"{text} +k_0={math.exp(-(least + most) / 2):.6g} +datum=WGS84"
    if not best <= math.log(10):
        raise DomainError("the domain covers so much of the Earth that the scale of every conformal "
                          "projection varies more than tenfold over it: cut the domain")
    return parameters


def _candidates(extent: _Extent) -> list[tuple[str, Any, float]]:
    """Parameters of PROJ, the logarithm of the scale on the sphere, the central longitude."""
    lon = _rounded(float(_wrapped(np.array(extent.west + extent.width / 2))))
    lat = _rounded((extent.south + extent.north) / 2)
    middle = _rounded(extent.centre[0]) if extent.around else lon

    def transverse(dl: Floats, phi: Floats) -> Floats:
        b = np.cos(phi) * np.sin(dl)
        beyond = (np.cos(dl) < 0) & (np.cos(phi) > 0.5)
        return np.where(beyond, np.inf, -np.log1p(-b * b) / 2)

    every: list[tuple[str, Any, float]] = [
        (f"+proj=tmerc +lat_0={_degrees(lat)} +lon_0={_degrees(middle)}", transverse, middle)]
    if not extent.around:
        if 1 <= abs(lat) <= 85:
            sine = math.sin(lat * _DEGREE)

            def unit(phi: Any) -> Any:
                return -sine * np.arcsinh(np.tan(phi)) - np.log(np.cos(phi))

            at0 = unit(lat * _DEGREE)
            every.append((f"+proj=lcc +lat_1={_degrees(lat)} +lat_0={_degrees(lat)} "
                          f"+lon_0={_degrees(lon)}", lambda dl, phi: unit(phi) - at0, lon))
        every.append((f"+proj=merc +lon_0={_degrees(lon)}",
                      lambda dl, phi: -np.log(np.cos(phi)), lon))
    clat = _rounded(extent.centre[1])
    clon = 0.0 if abs(clat) == 90 else _rounded(extent.centre[0])
    sin0, cos0 = math.sin(clat * _DEGREE), math.cos(clat * _DEGREE)

    def stereographic(dl: Floats, phi: Floats) -> Floats:
        c = sin0 * np.sin(phi) + cos0 * np.cos(phi) * np.cos(dl)
        return np.asarray(-np.log((1 + c) / 2))

    every.append((f"+proj=stere +lat_0={_degrees(clat)} +lon_0={_degrees(clon)}", stereographic,
                  clon))
    return every


def _transformer(name: str) -> tuple[Any, Any]:
    """The projected system of this name, and what leads there from its own degrees."""
    pyproj = need("pyproj", "a domain in longitude and latitude")
    try:
        typed = "+proj" in name and "+type=crs" not in name
        plane = pyproj.CRS.from_user_input(name + " +type=crs" if typed else name)
        if not plane.is_projected:
            raise DomainError(f"{name!r} is not a projected coordinate reference system, such as "
                              "EPSG:32618")
        for axis in plane.axis_info[:2]:
            if axis.unit_conversion_factor != 1:
                raise DomainError(f"{name!r} is in units of the {axis.unit_name}, but sizes and lengths "
                                  "are in metres: name a projection in metres")
        return plane, pyproj.Transformer.from_crs(plane.geodetic_crs, plane, always_xy=True)
    except pyproj.exceptions.ProjError as error:
        raise DomainError(f"{name!r} is not a projection that PROJ knows: {error}") from None


def _wrapped(longitude: Floats) -> Floats:
    """To [-180, 180); what lies there stays as it is, bit for bit."""
    out = np.array(longitude, np.float64)
    for _ in range(2):
        out = np.where(out < -180, out + 360, out)
        out = np.where(out >= 180, out - 360, out)
    return out


def _turn_of_segments(a: Floats, b: Floats) -> Floats:
    """By how many degrees a conformal plane turns segments, at most, or nearly so."""
    steep = np.tan(np.maximum(np.abs(a[:, 1]), np.abs(b[:, 1])) * _DEGREE)
    turn: Floats = np.abs(longitude_step(a[:, 0], b[:, 0])) + np.abs(b[:, 1] - a[:, 1]) * np.maximum(1, steep)
    return turn


def _on_grid(metres: Floats) -> Floats:
    """Where the sines of nearly every processor bring the point."""
    nearest: Floats = np.rint(metres * _PER_METRE) / _PER_METRE
    return nearest


def _on_segment(a: Floats, b: Floats, at: Floats) -> Floats:
    return np.column_stack([a[0] + longitude_step(a[0], b[0]) * at, a[1] + (b[1] - a[1]) * at])


def _centre(points: Floats) -> tuple[float, float]:
    """The middle of the box around the points on the unit sphere, seen from its middle."""
    lon, lat = points.T * _DEGREE
    box = np.array([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
    x, y, z = (box.min(axis=1) + box.max(axis=1)) / 2
    middle = math.atan2(z, math.sqrt(x * x + y * y)) / _DEGREE
    if abs(middle) > 89.99:
        return 0.0, -90.0 if middle < 0 else 90.0
    return math.atan2(y, x) / _DEGREE, middle


def _rounded(value: float) -> float:
    """The value that its text says."""
    return math.copysign(math.floor(abs(value) * 1e5 + 0.5), value) / 1e5


def _degrees(value: float) -> str:
    digits = f"{value:.5f}".rstrip("0").removesuffix(".")
    return "0" if digits == "-0" else digits
