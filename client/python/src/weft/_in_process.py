# SPDX-License-Identifier: Apache-2.0
"""Meshes without a server."""

from __future__ import annotations

from collections.abc import Callable
from typing import Unpack

from . import _library
from ._mesh import Mesh
from ._receiver import warn_of
from ._requests import MeshOptions, mesh_request, projection
from .domain import DomainLike, as_domain
from .results import Progress
from .size import Size


def mesh(domain: DomainLike, size: Size = None, min_angle: float = 20, *,
         on_progress: Callable[[Progress], object] | None = None,
         **options: Unpack[MeshOptions]) -> Mesh:
    """Meshes a domain in this process, by the library libweft.so, without a server.

    The arguments, the mesh, the warnings and the exceptions are those of Client.mesh; the same request
    gives the same mesh, byte for byte. There are no limits of a server. `threads`: default: one for
    each processor, if the mesh is worth it. `no_cache` has no effect. Other threads of Python go on
    meanwhile; Ctrl-C, and what `on_progress` raises, ends the work.

    Raises MissingPackage if the library is neither in the package nor in the system's path.

        mesh = weft.mesh("pipe.poly", size="0.4*hypot(x-200, y-200) + 1", min_angle=30)
    """
    given = as_domain(domain)
    projected = projection(given, options)
    request = mesh_request(given, size, min_angle, options, projected)
    sent = given if projected is None else projected.domain
    made = _library.make(request, on_progress)
    warn_of(made.summary, sampled=callable(size) or callable(options.get("edge")))
    points, summary = made.points, made.summary
    if projected is not None:
        points, summary = projected.to_lonlat(points, made.input_points), projected.brought_back(summary)
    return Mesh(points=points, triangles=made.triangles, regions=made.regions, edges=made.edges,
                edge_markers=made.edge_markers, edge_segments=made.edge_segments,
                edge_bulges=made.edge_bulges,
                input_points=made.input_points, summary=summary,
                marker_names=sent.marker_names, region_names=sent.region_names)
