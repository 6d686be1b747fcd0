# SPDX-License-Identifier: Apache-2.0
"""Meshes without a server."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Unpack

import numpy as np
import numpy.typing as npt

from . import _library, results
from ._mesh import Mesh
from ._receiver import warn_of
from ._requests import MeshOptions, mesh_request, projection
from .domain import DomainLike, as_domain
from .results import Progress
from .size import Size


@dataclasses.dataclass(frozen=True)
class SampledSize:
    """What a request asks for, without a mesh."""

    bounds: npt.NDArray[np.float64]
    """(n,): what the area of a triangle may be at most with its centroid at each point, in squared units
    of the domain: the least of the size, with its gradation, and the region's bound. Infinity for no bound,
    NaN outside of the domain, 0 at a place where the size alone is none."""
    expected_triangles: int
    """Of a mesh, about."""

    @property
    def edges(self) -> npt.NDArray[np.float64]:
        """(n,): the length of edges of equilateral triangles that are so large."""
        lengths: npt.NDArray[np.float64] = np.sqrt(self.bounds * (4 / np.sqrt(3)))
        return lengths


def sample_size(domain: DomainLike, points: npt.ArrayLike, size: Size = None, min_angle: float = 20,
                **options: Unpack[MeshOptions]) -> SampledSize:
    """What a size asks for at `points`, (n, 2) with n up to 262,144, and about how many triangles a mesh
    has: without the mesh.

    The other arguments, the warnings and the exceptions are those of `mesh`; of a domain in longitude and
    latitude, `points` are, too.

        x, y = np.meshgrid(np.linspace(0, 10, 200), np.linspace(0, 7, 140))
        plt.pcolormesh(x, y, weft.sample_size("pipe.poly", np.c_[x.ravel(), y.ravel()], edge="0.1 + 0.2*y")
                       .edges.reshape(x.shape))
    """
    given = as_domain(domain)
    projected = projection(given, options)
    request = mesh_request(given, size, min_angle, options, projected)
    at = np.ascontiguousarray(points, np.float64)
    if at.ndim != 2 or at.shape[1] != 2 or len(at) == 0:
        raise ValueError(f"points is of shape {at.shape}; it must be (n, 2), with a point at least")
    request.sample_points.extend((at if projected is None else projected.to_plane(at)).ravel().tolist())
    summary = _library.summarize(request)
    warn_of(results.summary(summary), sampled=callable(size) or callable(options.get("edge")))
    return SampledSize(np.array(summary.sampled_bounds), summary.expected_triangles)


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
