# SPDX-License-Identifier: Apache-2.0
"""What to mesh: a planar straight-line graph, and where it comes from.

Input may be dirty: segments may cross, overlap and repeat, points may coincide. The server resolves
all of it exactly.
"""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _convert, _geojson, _library, _names, _poly, _protocol
from ._masked import refuse_masked
from ._short import ShortRepr
from ._text import read_text
from ._warning import warn
from .errors import DomainError, MissingPackage

Fill = Literal["seeds", "even-odd", "union"]
_FILLS: dict[int, Fill] = {1: "seeds", 2: "even-odd", 3: "union"}  # of weft.v1.Fill


@dataclasses.dataclass(frozen=True)
class Region:
    """A seed that floods the face around it, up to the segments.

    `x`, `y`: inside the face, in the unit of the points. `id`: carried by every triangle of the
    face, 32 bits. `max_area`: bound on the area of its triangles, in squared units, on top of the
    size; `max_edge`: the same by the length of their edges, as an area of sqrt(3)/4 max_edge**2;
    None: no bound.
    """

    x: float
    y: float
    id: int = 0
    max_area: float | None = None
    max_edge: float | None = None


@dataclasses.dataclass(frozen=True)
class Area:
    """A polygon with holes, drawn by the segments that name it in `Domain.segment_areas`; areas may overlap,
    nest and touch.

    `region`: carried by the triangles that it decides: of the areas that cover a triangle and have a
    region, the one of the highest `priority`; of several, the smallest. `max_area`: bound on the area of
    the triangles that it covers, in squared units, on top of the size and of other areas; `max_edge`: the
    same by the length of their edges; None: no bound. `hole`: it carves away what it covers, nothing else.
    """

    region: int | None = None
    max_area: float | None = None
    max_edge: float | None = None
    priority: int = 0
    hole: bool = False


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Domain(ShortRepr):
    """A planar straight-line graph.

    `points`: (n, 2) float64, in any unit, magnitudes up to 1e50.
    `segments`: (k, 2) int32, indices of points.
    `markers`: (k,) int32, carried by the mesh edges on each segment; default: all 0.
    `arcs`: segments that are arcs of circles, and the bulge of each, the tangent of a quarter of the angle by
    which it turns from its first point to its second, above 0 if it turns left, as in DXF: `{3: 1.0}` makes
    segment 3 half a circle. A segment's ends are apart, so a circle is two arcs or more. Edges of the mesh on
    an arc are chords of it. Default: all are straight.
    `holes`: (h, 2) float64, seeds: the face around each is carved away.
    `regions`: seeds of faces with an id and an area bound of their own.
    `fill`: "seeds" meshes every bounded face that no hole floods; "even-odd" the points inside an
    odd number of rings, or of areas if there are any; "union" what an area covers.
    `areas`: polygons; `segment_areas`: (k,) uint32, for each segment 0, or 1 + the index of the area whose
    border it is part of; the segments of an area close to rings. Default: none.
    `marker_names`, `region_names`: what markers and regions are called, by number:
    `{2: "inlet"}`; each name once, UTF-8 of 1 to 255 bytes without control characters. The mesh
    comes back with them.
    `geographic`: whether its file or object says that it is in longitude and latitude, or in a plane: a mesh of
    the former without `lonlat` has a warning, of the latter with it is an error. Default: it says neither.
    `region_values`: the attributes of a .poly file that are no integers, by the id that stands for
    each; no server needs them.

    Raises DomainError if shapes, types or numbers make no sense; what only geometry can tell is
    the server's to find.

        Domain([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)])
        Domain.read("coast.geojson")
    """

    points: npt.NDArray[np.float64]
    segments: npt.NDArray[np.int32]
    markers: npt.NDArray[np.int32] = dataclasses.field(default_factory=lambda: np.zeros(0, np.int32))
    holes: npt.NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.zeros((0, 2)))
    regions: Sequence[Region] = ()
    fill: Fill = "seeds"
    region_values: Mapping[int, float] = dataclasses.field(default_factory=dict)
    marker_names: Mapping[int, str] = dataclasses.field(default_factory=dict)
    region_names: Mapping[int, str] = dataclasses.field(default_factory=dict)
    areas: Sequence[Area] = ()
    segment_areas: npt.NDArray[np.uint32] = dataclasses.field(default_factory=lambda: np.zeros(0, np.uint32))
    geographic: bool | None = None
    arcs: Mapping[int, float] = dataclasses.field(default_factory=dict)

    def __post_init__(self) -> None:
        points = _floats("points", self.points)
        segments = _integers("segments", self.segments, np.int32).reshape(-1, 2)
        markers = _integers("markers", self.markers, np.int32).reshape(-1)
        if not len(markers):
            markers = np.zeros(len(segments), np.int32)
        if len(markers) != len(segments):
            raise DomainError(f"markers: {len(markers)} for {len(segments)} segments")
        if len(segments) and not (0 <= segments.min() and segments.max() < len(points)):
            bad = np.argwhere((segments < 0) | (segments >= len(points)))[0]
            raise DomainError(f"segments[{bad[0]}] names point {segments[tuple(bad)]} of {len(points)}")
        borders = _integers("segment_areas", self.segment_areas, np.uint32).reshape(-1)
        if not len(borders):
            borders = np.zeros(len(segments), np.uint32)
        if len(borders) != len(segments):
            raise DomainError(f"segment_areas: {len(borders)} for {len(segments)} segments")
        if len(borders) and borders.max() > len(self.areas):
            bad = int(np.argmax(borders))
            raise DomainError(f"segment_areas[{bad}] is {borders[bad]}, there are {len(self.areas)} areas")
        arcs = {int(segment): float(bulge) for segment, bulge in sorted(self.arcs.items())}
        for segment, bulge in arcs.items():
            if not 0 <= segment < len(segments):
                raise DomainError(f"arcs: segment {segment} of {len(segments)}")
            if not np.isfinite(bulge):
                raise DomainError(f"arcs[{segment}] is {bulge}")
        if self.fill not in ("seeds", "even-odd", "union"):
            raise DomainError(f"fill is {self.fill!r}; there are 'seeds', 'even-odd' and 'union'")
        for name, value in (("points", points), ("segments", segments), ("markers", markers),
                            ("holes", _floats("holes", self.holes)), ("regions", tuple(self.regions)),
                            ("areas", tuple(self.areas)), ("segment_areas", borders), ("arcs", arcs),
                            ("marker_names", _names.checked("marker_names", self.marker_names)),
                            ("region_names", _names.checked("region_names", self.region_names))):
            object.__setattr__(self, name, value)

    def box(self) -> tuple[float, float, float, float]:
        """Around the points: min x, min y, max x, max y. Raises DomainError if there are none."""
        if not len(self.points):
            raise DomainError("the domain has no points")
        (left, bottom), (right, top) = self.points.min(axis=0).tolist(), self.points.max(axis=0).tolist()
        return left, bottom, right, top

    @staticmethod
    def rings(*rings: npt.ArrayLike) -> Domain:
        """A polygon from arrays (n, 2): an area, what lies inside an odd number of the rings.

        A ring's last point leads to its first, and may repeat it.
        """
        read = Domain.geojson({"type": "MultiLineString", "coordinates": ()} if not rings else {
            "type": "Polygon", "coordinates": [_closed(i, ring) for i, ring in enumerate(rings)]})
        return dataclasses.replace(read, geographic=None)

    @staticmethod
    def geojson(json: dict[str, Any]) -> Domain:
        """From a GeoJSON object (RFC 7946), as `json.load` gives it.

        With polygons, what any of them covers is meshed, each an area, and lines become edges; of lines
        alone, every bounded face. Points become vertices. The members `marker` and `region`
        of a feature's properties are read, integers or names, `marker_name` and `region_name`
        beside integers, `max_area` and `max_edge`.
        """
        return Domain(**_geojson.read(json, Area))

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Domain:
        """From a file of a format that the command line knows: .poly (Triangle), .geojson, .wkt, .shp, .csv,
        meshes and others, see docs/formats.md. The library libweft.so reads it, which is in the package or in the
        system's path; without it, .poly, .geojson and .json are read here, all others by the program weft. A
        WeftWarning says what is odd in it.

        Raises DomainError if its contents make no sense, its format is unknown, or the library and the program
        are needed and missing; OSError if it cannot be read.
        """
        path = pathlib.Path(path)
        try:
            read = _library.read_domain(path)
        except MissingPackage:
            return _read_without_library(path)
        for sentence in read.warnings:
            warn(sentence)
        return dataclasses.replace(_of_message(read.message), geographic=read.geographic,
                                   region_values=read.region_values)


def _read_without_library(path: pathlib.Path) -> Domain:
    suffix = path.suffix.lower()
    try:
        if suffix == ".poly":
            return Domain(**_poly.read(path, Region))
        if suffix in (".geojson", ".json"):
            return Domain(**_geojson.read(json.loads(read_text(path)), Area, str(path)))
    except ValueError as error:
        raise DomainError(f"{path}: {error}") from None
    with tempfile.TemporaryDirectory(prefix="weft-") as folder:
        message = pathlib.Path(folder) / "domain.pb"
        try:
            converted = _convert.convert(path, message, error=DomainError)
        except _convert.Refused as refused:
            raise DomainError(str(refused)) from None
        for sentence in converted.warnings:
            warn(sentence)
        return dataclasses.replace(_of_message(message.read_bytes()), geographic=converted.geographic)


DomainLike = Union[Domain, str, "os.PathLike[str]", dict[str, Any], npt.NDArray[Any],
                   Sequence[npt.NDArray[Any]], Any]
# The text of help(weft.DomainLike).
DomainLike.__doc__ = """What is taken for a domain: a Domain; the path of a file, see Domain.read; a GeoJSON
object; an object with a `__geo_interface__`, such as a shapely geometry or a GeoDataFrame; the ring of a polygon:
an array (n, 2), a list of n pairs, or a DataFrame with the columns x and y; or a sequence of rings, of which what
lies inside an odd number is meshed."""


def as_domain(domain: DomainLike) -> Domain:
    """See DomainLike. Raises DomainError."""
    if isinstance(domain, Domain):
        return domain
    if isinstance(domain, (str, os.PathLike)):
        return Domain.read(domain)
    if isinstance(domain, dict):
        return Domain.geojson(domain)
    if hasattr(domain, "__geo_interface__"):
        read = Domain.geojson(domain.__geo_interface__)
        system = getattr(domain, "crs", None)  # of a GeoDataFrame, by pyproj
        return dataclasses.replace(read, geographic=getattr(system, "is_geographic", None))
    if hasattr(domain, "columns") and hasattr(domain, "to_numpy"):  # of pandas or polars
        return Domain.rings(_columns(domain))
    if isinstance(domain, Sequence) or (isinstance(domain, np.ndarray) and domain.ndim):
        if not any(np.size(part) for part in domain):
            raise DomainError(f"an empty {type(domain).__name__} is no domain: it has no points")
        depth = 1 + np.ndim(domain[0])
        if depth == 2:
            return Domain.rings(domain)
        if depth == 3:
            return Domain.rings(*domain)
    raise DomainError(f"a {type(domain).__name__} is no domain; see weft.DomainLike")


def _columns(frame: Any) -> npt.NDArray[Any]:
    """(n, 2): x and y of a DataFrame, which has no other columns."""
    names = [str(name) for name in frame.columns]
    if sorted(names) != ["x", "y"]:
        raise DomainError(f"a DataFrame is the ring of a polygon if its columns are x and y; this one has "
                          f"{', '.join(names) or 'none'}")
    return np.column_stack([frame["x"].to_numpy(), frame["y"].to_numpy()])


def _of_message(message: bytes) -> Domain:
    """From a weft.v1.Domain."""
    sent = _protocol.message("weft.v1.Domain").FromString(message)
    return Domain(
        np.array(sent.points, np.float64).reshape(-1, 2), np.array(sent.segments, np.int32).reshape(-1, 2),
        markers=np.array(sent.segment_markers, np.int32),
        holes=np.array(sent.holes, np.float64).reshape(-1, 2),
        regions=[Region(r.x, r.y, r.id, _given(r, "max_area"), _given(r, "max_edge")) for r in sent.regions],
        areas=[Area(_given(a, "region"), _given(a, "max_area"), _given(a, "max_edge"), a.priority, a.hole)
               for a in sent.areas],
        segment_areas=np.array(sent.segment_areas, np.uint32),
        arcs=dict(zip(sent.arc_segments, sent.arc_bulges)),
        fill=_FILLS[sent.fill],
        marker_names={name.id: name.name for name in sent.marker_names},
        region_names={name.id: name.name for name in sent.region_names})


def _given(message: Any, field: str) -> Any:
    return getattr(message, field) if message.HasField(field) else None


def _closed(index: int, ring: npt.ArrayLike) -> npt.NDArray[np.float64]:
    points = _floats(f"ring {index}", ring)
    if len(points) and (points[0] != points[-1]).any():
        points = np.concatenate([points, points[:1]])
    return points


def _floats(name: str, values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """(n, 2), all finite."""
    refuse_masked(name, values)
    try:
        array = np.ascontiguousarray(values, np.float64)
    except (TypeError, ValueError) as error:
        raise DomainError(f"{name}: {error}") from None
    if array.size == 0:
        return array.reshape(0, 2)
    if array.ndim != 2 or array.shape[1] != 2:
        raise DomainError(f"{name}: an array {array.shape}, expected (n, 2)")
    if not np.isfinite(array).all():
        bad = np.argwhere(~np.isfinite(array))[0][0]
        raise DomainError(f"{name}[{bad}] is {tuple(array[bad])}, not finite")
    return array


def _integers(name: str, values: npt.ArrayLike, dtype: type[Any]) -> npt.NDArray[Any]:
    refuse_masked(name, values)
    array = np.asarray(values)
    converted = array.astype(dtype) if array.dtype != object else None
    if converted is None or (array.size and not np.array_equal(converted, array)):
        raise DomainError(f"{name}: not integers of 32 bits")
    if name == "segments" and array.size and (array.ndim != 2 or array.shape[1] != 2):
        raise DomainError(f"{name}: an array {array.shape}, expected (k, 2)")
    return converted
