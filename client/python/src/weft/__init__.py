# SPDX-License-Identifier: Apache-2.0
"""Graded, guaranteed-quality Delaunay meshes from a weft server, as numpy arrays.

    import weft

    with weft.local() as client:                  # or weft.Client("mesh.example.org:7421", tls=True)
        mesh = client.mesh("coast.geojson", size="1e-3 + 1e-2*hypot(x+74, y-40.5)^2", min_angle=30)
    mesh = weft.mesh("coast.geojson", size=1e-3)  # the same, in this process: by libweft.so
    mesh.points, mesh.triangles                   # (n, 2) float64, (m, 3) int32
    mesh.write("coast.vtu")

Lengths are in the unit of the domain, areas in its square, angles in degrees, times in seconds.

This folder has more than 25 files because it is one package: what users import, from `weft` itself,
beside the modules that these share, whose names begin with an underscore.
"""

from . import aio
from ._in_process import SampledSize, mesh, sample_size
from ._mesh import Mesh
from ._patches import stitch
from ._requests import Layers, MeshOptions
from ._target import TLS
from ._triangulate import triangulate
from ._version import __version__
from ._wire import Chunk
from .client import Client, MeshStream
from .domain import Area, Domain, DomainLike, Region
from .errors import (AlreadyExists, BoundsNotMet, Cancelled, DamagedStream, DeadlineExceeded,
                     DomainError, FailedPrecondition, FieldViolation, InvalidRequest, LimitExceeded,
                     LocalServerError, MeshFileError, MissingPackage, NotFound, ServerError,
                     SwitchError, Unauthenticated, Unavailable, WeftError, WeftWarning)
from .fields import Field, distance, on_mesh, raster, width
from .local import LocalServer, local
from .quality import Quality
from .results import (Accepted, Callback, CallbackState, Job, JobState, LayerSummary, Merging, NarrowPlace,
                      OutsideSegments, Progress, ServerInfo, ServerLimits, Simplification, SizeWarning, Summary, Timings, Unrefined)
from .size import Raster, Size

__all__ = [
    "Accepted", "AlreadyExists", "Area", "BoundsNotMet", "Callback", "CallbackState", "Cancelled", "Chunk", "Client",
    "DamagedStream", "DeadlineExceeded", "Domain", "DomainError", "DomainLike", "FailedPrecondition", "Field",
    "FieldViolation", "InvalidRequest", "Job", "JobState", "LayerSummary", "Layers", "LimitExceeded", "LocalServer",
    "LocalServerError", "Merging", "Mesh", "MeshFileError", "MeshOptions", "MeshStream",
    "MissingPackage", "NarrowPlace", "NotFound", "OutsideSegments", "Progress", "Quality", "Raster", "Region",
    "SampledSize", "ServerError", "ServerInfo", "ServerLimits", "Simplification", "Size", "SizeWarning", "Summary", "SwitchError",
    "TLS", "Timings", "Unauthenticated", "Unavailable", "Unrefined", "WeftError", "WeftWarning", "__version__", "aio",
    "distance", "local", "mesh", "on_mesh", "raster", "sample_size", "stitch", "triangulate", "width",
]
