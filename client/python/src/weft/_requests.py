# SPDX-License-Identifier: Apache-2.0
"""What a user asks for, as messages."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal, TypedDict

from . import _protocol
from ._projection import Projection
from .domain import Domain
from .errors import DomainError
from .fields import Field
from .size import Raster, Size


class MeshOptions(TypedDict, total=False):
    """What else a mesh may be asked for; the defaults are the server's."""

    edge: Size
    """The length of edges, instead of `size`: triangles are at most as large as the equilateral one
    with this edge at their centroid. A number, an expression in x, y and names of `fields`, a
    Raster or a function of lengths."""
    fields: Mapping[str, Field]
    """What `edge` or `size` may name besides x and y: see distance, raster, on_mesh and width."""
    gradation: float
    """How much the length of edges may grow per unit of length; a size that grows faster is lowered.
    Default: no limit."""
    edge_at: Mapping[int, float]
    """How long edges may be on segments, by their marker: `{2: 500}`. With `gradation`, edges grow
    from there by it at most."""
    cells_across: float
    """How many edges fit across the domain at least, about, where it is narrow: no edge is wanted
    longer than the local width divided by it. Best with `gradation`. Default: any number."""
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
    min_edge: float
    """No edge shorter than this is made, in the unit of the points."""
    placement: Literal["lattice", "circumcentre"]
    """Where the points go that split triangles larger than their bound: to a lattice that follows
    the size, with a third fewer triangles, or to circumcentres, without any direction in the mesh.
    Default: lattice."""
    optimise: int
    """Sweeps of smoothing, 0 to 16: vertices around angles below 48 degrees move to where the
    smallest angle around them is largest. Default: 2 if the size makes nearly all triangles, on a
    lattice with few faults or in a mesh below 100,000 triangles; otherwise 0."""
    snap: float
    """Merge everything of the domain that lies nearer together than this first, in the unit of the
    points; `summary.merging` tells what moved."""
    allow_unrefined: bool
    """Take a mesh with triangles that miss a bound though nothing excuses them, instead of
    BoundsNotMet."""
    max_triangles: int
    """Refinement stops here and gives the mesh that it has."""
    max_seconds: float
    """Of work; over it, DeadlineExceeded."""
    threads: int
    """That compute, at most; the mesh does not depend on it. Default: all of the server."""
    quadtree: bool
    """Whether `summary.leaf_boxes` is filled."""
    no_cache: bool
    """Make the mesh again, even if the server has it in its cache."""


_Request = _protocol.message("weft.v1.GenerateMeshRequest")
_PLACEMENTS = {"lattice": 1, "circumcentre": 2}
_EDGE = 2
_FILLS = {"seeds": 1, "even-odd": 2}


def projection(domain: Domain, options: MeshOptions) -> Projection | None:
    """Of a domain that the options say is in longitude and latitude."""
    if not (options.get("lonlat") or options.get("crs") or options.get("to_metres")):
        return None
    return Projection(domain, options.get("crs"), options.get("to_metres", False))


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
    _fill_size(size, domain, request.size)
    if options.get("edge") is not None:
        _fill_size(options["edge"], domain, request.size)
        request.size.measure = _EDGE
    if "cells_across" in options:
        request.size.cells_across = options["cells_across"]
    if "gradation" in options:
        request.size.gradation = options["gradation"]
    for marker, max_edge in options.get("edge_at", {}).items():
        request.size.at.add(marker=marker, max_edge=max_edge)
    for name, field in options.get("fields", {}).items():
        in_plane = field if projected is None else projected.field(field)
        in_plane._fill(request.size.fields.add(name=name))
    request.quality.min_angle_deg = min_angle
    if "min_edge" in options:
        request.quality.min_edge = options["min_edge"]
    if "placement" in options:
        if options["placement"] not in _PLACEMENTS:
            raise ValueError(f"placement is {options['placement']!r}; there are "
                             f"{', '.join(_PLACEMENTS)}")
        request.quality.placement = _PLACEMENTS[options["placement"]]
    if "optimise" in options:
        request.quality.optimise = options["optimise"]
    request.domain.snap = options.get("snap", 0)
    request.allow_unrefined = options.get("allow_unrefined", False)
    if "max_triangles" in options:
        request.budget.max_triangles = options["max_triangles"]
    if "max_seconds" in options:
        request.budget.max_seconds = options["max_seconds"]
    request.threads = options.get("threads", 0)
    request.want_quadtree = options.get("quadtree", False)
    request.no_cache = options.get("no_cache", False)
    return request


def job_request(domain: Domain, size: Size, min_angle: float, options: MeshOptions) -> Any:
    """A GenerateMeshRequest of which nobody keeps the projection until the mesh is fetched."""
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
    message.holes.extend(domain.holes.ravel().tolist())
    for region in domain.regions:
        message.regions.add(x=region.x, y=region.y, id=region.id, max_area=region.max_area,
                            max_edge=region.max_edge)
    message.fill = _FILLS[domain.fill]


def _fill_size(size: Size, domain: Domain, message: Any) -> None:
    if size is None:
        return
    if callable(size):
        if not len(domain.points):
            raise DomainError("the domain has no points")
        (left, bottom), (right, top) = domain.points.min(axis=0), domain.points.max(axis=0)
        size = Raster.sample(size, (left, bottom, right, top))
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
    if not (isinstance(size, (int, float)) and math.isfinite(size)):
        raise DomainError(f"size is {size!r}; see weft.Size")
    message.constant = size
