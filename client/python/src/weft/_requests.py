# SPDX-License-Identifier: Apache-2.0
"""What a user asks for, as messages."""

from __future__ import annotations

import dataclasses
import math
import numbers
import reprlib
from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypedDict

import numpy as np

from . import _options, _protocol
from ._names import marker_of
from ._projection import SNAP, Projection
from ._raster_window import MOST_VALUES
from ._receiver import MeshReceiver
from ._warning import keeping_warnings, warn
from .domain import _FILLS, Domain, DomainLike, as_domain
from .errors import DomainError
from .fields import Field, FileField, RasterField, check_is_field, is_field
from .size import Raster, Size


@dataclasses.dataclass(frozen=True)
class Layers:
    """Rows of thin triangles along a wall, no thicker than there is room for; see docs/sides.md."""

    first: float
    """Height of the row at the wall, in the unit of the points, above 0."""
    rows: int
    """Number of rows, 1 to 200."""
    ratio: float = 1
    """Height of each row over that of the one before, 1 to 10."""
    region: int | None = None
    """Id of the region of their triangles; None: one of their own."""


class MeshOptions(TypedDict, total=False):
    """What else a mesh may be asked for; the defaults are the server's."""

    edge: Size
    """The length of edges, instead of `size`: no triangle is larger than the equilateral one whose
    edges have the length at its centroid. A number, an expression in x, y and names of `fields`, a
    Raster or a function of lengths."""
    fields: Mapping[str, Field]
    """What `edge` or `size` may name besides x and y: see distance, raster, on_mesh and width."""
    edge_at: Mapping[int, float] | Mapping[str, float] | Mapping[int | str, float]
    """Maximum length of edges on segments, by their marker, a number or a name of the domain's
    `marker_names`: `{2: 500, "inlet": 100}`. With `gradation`, lengths
    grow from there by at most that."""
    lonlat: bool
    """The domain is in longitude and latitude, in degrees: it is meshed in a plane in metres, so that
    angles hold on the ground, and the points of the mesh are in longitude and latitude. Sizes are
    square metres, lengths metres, x and y metres of the plane; `fields` are projected, too, those
    in points from longitude and latitude. Needs pyproj."""
    crs: str
    """The projection, as PROJ names it, such as "EPSG:32618"; implies `lonlat`. Default: the
    conformal one whose scale varies least over the domain."""
    to_metres: bool
    """Leave the points of the mesh in metres of the projection; implies `lonlat`."""
    keep: Literal["all"] | int | str | Sequence[int] | Sequence[str] | Sequence[int | str]
    """Segments that stay as they are: "all", or a marker or several, numbers or names of the domain's
    `marker_names`. No new point lies on them, and triangles there may miss their bounds, which
    `summary.unrefined.kept` counts."""
    periodic: Sequence[tuple[int | str, int | str]]
    """Sides that repeat each other, pairs of markers, numbers or names of the domain's `marker_names`:
    `[(4, 2), ("bottom", "top")]`. Each is a line of straight segments; a translation or a rotation that takes one to
    the other takes vertices to vertices, which `Mesh.periodic` pairs."""
    layers: Mapping[int, Layers] | Mapping[str, Layers] | Mapping[int | str, Layers]
    """Layers along walls, by their marker, a number or a name of the domain's `marker_names`. Bounds on
    angles and sizes hold outside of them."""
    # The others are explained by help(weft.Client.mesh), from the protocol.
    gradation: float
    gradation_within: bool
    cells_across: float
    points_per_circle: float
    min_edge: float
    placement: Literal["lattice", "circumcentre"]
    optimise: int
    snap: float
    simplify: float
    allow_unrefined: bool
    max_triangles: int
    max_seconds: float
    threads: int
    quadtree: bool
    no_cache: bool


_Request = _protocol.message("weft.v1.GenerateMeshRequest")
_EDGE = 2
_FILL_NUMBERS = {name: number for number, name in _FILLS.items()}


def projection(domain: Domain, options: MeshOptions) -> Projection | None:
    """Of a domain that the options say is in longitude and latitude. Raises DomainError, MissingPackage."""
    if not (options.get("lonlat") or options.get("crs") or options.get("to_metres")):
        if domain.geographic:
            warn("the coordinates are longitudes and latitudes: lengths, areas and angles are those of degrees; "
                 "lonlat=True has them on the ground")
        return None
    if domain.geographic is False:
        raise DomainError("the domain lies in a plane, its file or object says: leave out lonlat, crs and to_metres, "
                          "or bring it into longitude and latitude")
    return Projection(domain, options.get("crs"), options.get("to_metres", False), float(options.get("snap") or 0))


def mesh_request(domain: Domain, size: Size, min_angle: float, options: MeshOptions,
                 projected: Projection | None = None) -> Any:
    """A GenerateMeshRequest. `projected`: of the domain, if it is in longitude and latitude."""
    unknown = set(options) - set(MeshOptions.__annotations__)
    if unknown:
        raise TypeError(f"unknown option {sorted(unknown)[0]!r}; there are "
                        f"{', '.join(MeshOptions.__annotations__)}")
    request = _Request()
    if projected is not None:
        domain = projected.domain
    _fill_domain(domain, request.domain)
    if size is not None and options.get("edge") is not None:
        raise ValueError("size and edge exclude each other")
    lengths = options.get("edge") is not None
    asked, name = (options["edge"], "edge") if lengths else (size, "size")
    fields = dict(options.get("fields", {}))
    if is_field(asked):
        if name in fields:
            raise ValueError(f"{name} is a field, and fields has another of that name")
        fields[name], asked = asked, name
    _fill_size(asked, domain, request.size, lengths=lengths)
    if lengths:
        request.size.measure = _EDGE
    if options.get("gradation_within") and "gradation" not in options:
        raise ValueError("gradation_within needs gradation, whose distances it is about")
    for marker, max_edge in options.get("edge_at", {}).items():
        request.size.at.add(marker=marker_of(marker, domain.marker_names), max_edge=max_edge)
    _fill_fields(fields, domain, projected, request.size.fields)
    if "keep" in options:
        _fill_keep(options["keep"], domain, request.quality)
    _fill_periodic(options.get("periodic", ()), domain, request.quality)
    for marker, layers in options.get("layers", {}).items():
        request.quality.layers.add(marker=marker_of(marker, domain.marker_names), **dataclasses.asdict(layers))
    values: dict[str, object] = {"min_angle": min_angle, **options}
    for name, option in _options.by_keyword().items():
        if name in values:
            option.set(request, values[name])
    if projected is not None and request.domain.snap == 0:
        request.domain.snap = SNAP
    return request


def stream_request(domain: DomainLike, size: Size, min_angle: float,
                   options: MeshOptions) -> tuple[Any, MeshReceiver]:
    """A GenerateMeshRequest, and what takes its mesh."""
    domain = as_domain(domain)
    projected = projection(domain, options)
    request = mesh_request(domain, size, min_angle, options, projected)
    sent = domain if projected is None else projected.domain
    return request, MeshReceiver(len(sent.points), len(sent.segments), projected,
                                 (sent.marker_names, sent.region_names),
                                 sampled=callable(size) or callable(options.get("edge")))


def job_request(domain: DomainLike, size: Size, min_angle: float, options: MeshOptions) -> Any:
    """A GenerateMeshRequest of which nobody keeps the projection until the mesh is fetched."""
    domain = as_domain(domain)
    projected = projection(domain, options)
    if projected is not None and not projected.to_metres:
        raise ValueError("the mesh of a job is fetched in metres of the projection: say so with "
                         "to_metres=True")
    return mesh_request(domain, size, min_angle, options, projected)


def _fill_domain(domain: Domain, message: Any) -> None:
    message.points.extend(domain.points.ravel().tolist())
    message.segments.extend(domain.segments.ravel().tolist())
    if domain.markers.any():
        message.segment_markers.extend(domain.markers.tolist())
    message.arc_segments.extend(domain.arcs.keys())
    message.arc_bulges.extend(domain.arcs.values())
    message.holes.extend(domain.holes.ravel().tolist())
    for region in domain.regions:
        message.regions.add(x=region.x, y=region.y, id=region.id, max_area=region.max_area,
                            max_edge=region.max_edge)
    for table, names in ((message.marker_names, domain.marker_names),
                         (message.region_names, domain.region_names)):
        for number, name in sorted(names.items()):
            table.add(id=number, name=name)
    message.fill = _FILL_NUMBERS[domain.fill]
    for area in domain.areas:
        message.areas.add(region=area.region, max_area=area.max_area, max_edge=area.max_edge,
                          priority=area.priority, hole=area.hole)
    if domain.segment_areas.any():
        message.segment_areas.extend(domain.segment_areas.tolist())


def _fill_keep(keep: Any, domain: Domain, quality: Any) -> None:
    if isinstance(keep, str) and keep == "all":
        quality.keep.SetInParent()
        return
    markers = [keep] if isinstance(keep, (str, numbers.Integral)) else keep
    for marker in markers:  # no marker on the wire would mean all
        quality.keep.markers.append(marker_of(marker, domain.marker_names))


def _fill_periodic(pairs: Any, domain: Domain, quality: Any) -> None:
    for i, pair in enumerate(pairs):
        if np.shape(pair) != (2,):
            raise ValueError(f"periodic[{i}] is {pair!r}; it must be a pair of markers, such as (4, 2)")
        first, second = (marker_of(marker, domain.marker_names) for marker in pair)
        quality.periodic.add(**{"from": first, "to": second})


def _fill_fields(fields: Mapping[str, Field], domain: Domain, projected: Projection | None,
                 messages: Any) -> None:
    rasters = sum(isinstance(field, (FileField, RasterField)) for field in fields.values())
    # They share the server's limit; less is read of each file if they have more together.
    for most in (MOST_VALUES, MOST_VALUES // max(rasters, 1)):
        del messages[:]
        with keeping_warnings() as sentences:
            for name, field in fields.items():
                check_is_field(name, field)
                if isinstance(field, FileField):
                    field = dataclasses.replace(field, most=most)
                in_plane = field if projected is None else projected.field(field)
                in_plane._fill(messages.add(name=name), domain)
        if sum(len(message.raster.values) for message in messages) <= MOST_VALUES:
            break
    for sentence in sentences:
        warn(sentence)


def _fill_size(size: Size, domain: Domain, message: Any, *, lengths: bool) -> None:
    if size is None:
        return
    if callable(size):
        middles = domain.points[domain.segments].mean(axis=1)
        size = Raster.adaptive(size, domain.box(),
                               np.concatenate([domain.points, middles]), lengths=lengths)
    if isinstance(size, Raster):
        raster = message.raster
        raster.x, raster.y = size.origin
        raster.dx, raster.dy = size.spacing
        raster.rows, raster.columns = size.values.shape
        raster.values.extend(size.values.ravel().tolist())
        return
    if isinstance(size, str):
        try:
            size = float(size)
        except ValueError:
            message.expression = size
            return
    name = "edge" if lengths else "size"
    try:
        number = float(size) if isinstance(size, numbers.Real) else math.nan
    except OverflowError:
        raise DomainError(f"{name} is a number beyond double precision") from None
    if not math.isfinite(number):
        raise DomainError(f"{name} is {reprlib.repr(size)}; see weft.Size")
    message.constant = number
