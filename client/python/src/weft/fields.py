# SPDX-License-Identifier: Apache-2.0
"""What a size expression may name besides x and y.

    mesh = client.mesh("coast.geojson", edge="min(500 + 0.15*coast, 20000)",
                       fields={"coast": weft.distance(marker=2)}, gradation=0.15)

The server computes them, so that an expression of fields is as exact and as fast as one of x and y.
"""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Union

import numpy as np
import numpy.typing as npt

from ._optional import need
from .errors import DomainError

if TYPE_CHECKING:
    from .mesh import Mesh

Field = Union["Distance", "RasterField", "MeshField", "Width"]
"""A number at every point: see distance, raster, on_mesh and width."""

_BYTES = 2  # the wire type of packed arrays


@dataclasses.dataclass(frozen=True, eq=False)
class Distance:
    """See distance."""

    markers: npt.NDArray[np.int32]
    points: npt.NDArray[np.float64]
    segments: npt.NDArray[np.uint32]

    def _fill(self, message: Any) -> None:
        to = message.distance
        to.SetInParent()
        to.markers.extend(self.markers.tolist())
        to.MergeFromString(_packed(2, self.points.astype("<f8")))
        to.segments.extend(self.segments.ravel().tolist())


@dataclasses.dataclass(frozen=True, eq=False)
class RasterField:
    """See raster."""

    values: npt.NDArray[np.float32]
    origin: tuple[float, float]
    spacing: tuple[float, float]
    crs: str | None = None

    def _fill(self, message: Any) -> None:
        to = message.raster
        to.x, to.y = self.origin
        to.dx, to.dy = self.spacing
        to.rows, to.columns = self.values.shape
        to.MergeFromString(_packed(7, self.values.astype("<f4")))


@dataclasses.dataclass(frozen=True, eq=False)
class MeshField:
    """See on_mesh."""

    points: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int32]
    values: npt.NDArray[np.float64]

    def _fill(self, message: Any) -> None:
        to = message.mesh
        to.MergeFromString(_packed(1, self.points.astype("<f8")))
        to.triangles.extend(self.triangles.ravel().tolist())
        to.MergeFromString(_packed(3, self.values.astype("<f8")))


@dataclasses.dataclass(frozen=True)
class Width:
    """See width."""

    def _fill(self, message: Any) -> None:
        message.width.SetInParent()


def distance(*, marker: int | Iterable[int] = (), points: npt.ArrayLike | None = None,
             segments: npt.ArrayLike | None = None) -> Distance:
    """The distance to the nearest of some segments or points, in the unit of the domain.

    Without arguments: to all segments of the domain. `marker`: to those with this marker, or with
    one of these. `points`, (n, 2): to these instead; `segments`, (m, 2): to the segments that join
    two of them each. Raises DomainError.
    """
    markers = np.atleast_1d(np.asarray(marker if isinstance(marker, int) else list(marker), np.int32))
    if points is None:
        if segments is not None:
            raise DomainError("distance: segments without points")
        return Distance(markers, np.empty((0, 2)), np.empty((0, 2), np.uint32))
    if len(markers):
        raise DomainError("distance: marker and points exclude each other")
    return Distance(markers, _table("distance: points", points, np.float64, 2),
                    _table("distance: segments", [] if segments is None else segments, np.uint32, 2))


def raster(source: npt.ArrayLike | str | os.PathLike[str], *,
           origin: tuple[float, float] | None = None, spacing: tuple[float, float] | None = None,
           band: int = 1) -> RasterField:
    """Values on a grid: bilinear between its nodes; undefined outside, and beside a NaN.

    `source`: an array (rows, columns), `source[j, i]` at `(origin[0] + i * spacing[0], origin[1] +
    j * spacing[1])`; or the path of a raster that GDAL reads (needs the package gdal), whose
    `band` it is, and whose nodes are the centres of its cells. On a domain in longitude and latitude
    it is projected: a file by its own coordinate system, an array from longitude and latitude.
    Raises DomainError, MissingPackage.
    """
    if isinstance(source, (str, os.PathLike)):
        return _read_raster(os.fspath(source), band)
    values = np.ascontiguousarray(source, np.float32)
    if values.ndim != 2 or values.size == 0:
        raise DomainError(f"raster: values of shape {values.shape}, expected (rows, columns)")
    if origin is None or spacing is None:
        raise DomainError("raster: an array needs origin and spacing")
    if np.isinf(values).any():
        j, i = np.argwhere(np.isinf(values))[0]
        raise DomainError(f"raster: the value in column {i} of row {j} is infinite")
    return RasterField(values, (float(origin[0]), float(origin[1])),
                       (float(spacing[0]), float(spacing[1])))


def on_mesh(mesh: Mesh | tuple[npt.ArrayLike, npt.ArrayLike], values: npt.ArrayLike) -> MeshField:
    """Values at the vertices of an earlier mesh: linear in each triangle, outside that of the
    nearest point.

    `mesh`: a Mesh, or its points (n, 2) and triangles (m, 3). `values`: (n,), NaN where the field
    is undefined. Raises DomainError.

        mesh = client.mesh(domain, edge="h", fields={"h": weft.on_mesh(mesh, h)})
    """
    points, triangles = mesh if isinstance(mesh, tuple) else (mesh.points, mesh.triangles)
    vertices = _table("on_mesh: points", points, np.float64, 2)
    corners = _table("on_mesh: triangles", triangles, np.int32, 3)
    numbers = np.ascontiguousarray(values, np.float64)
    if numbers.shape != (len(vertices),):
        raise DomainError(f"on_mesh: values of shape {numbers.shape} for {len(vertices)} points")
    return MeshField(vertices, corners, numbers)


def width() -> Width:
    """The local width of the domain: the diameter of the largest disk inside it that holds the
    point."""
    return Width()


def _table(what: str, rows: npt.ArrayLike, kind: Any, columns: int) -> Any:
    table = np.ascontiguousarray(rows, kind)
    if table.size == 0:
        return table.reshape(0, columns)
    if table.ndim != 2 or table.shape[1] != columns:
        raise DomainError(f"{what} of shape {table.shape}, expected (n, {columns})")
    return table


def _packed(number: int, array: npt.NDArray[Any]) -> bytes:
    """A field of numbers of fixed width, as it is on the wire: protobuf takes them one by one."""
    data = array.tobytes()
    head, size = bytearray([number << 3 | _BYTES]), len(data)
    while size >= 0x80:
        head.append(size & 0x7F | 0x80)
        size >>= 7
    head.append(size)
    return bytes(head) + data


def _read_raster(path: str, band: int) -> RasterField:
    gdal = need("osgeo.gdal", "weft.raster of a file", "gdal")
    gdal.UseExceptions()
    try:
        data = gdal.Open(path)
        left, dx, shear, top, other_shear, dy = data.GetGeoTransform()
        layer = data.GetRasterBand(band)
        values = layer.ReadAsArray().astype(np.float32)
        mask = layer.GetMaskBand().ReadAsArray() == 0
        crs = data.GetProjection() or None
        scale, offset = layer.GetScale(), layer.GetOffset()
    except RuntimeError as error:
        raise DomainError(f"raster: {error}") from error
    if shear or other_shear:
        raise DomainError(f"raster: the grid of {path} is turned or sheared")
    if scale not in (None, 1.0) or offset not in (None, 0.0):
        values = values * np.float32(scale or 1) + np.float32(offset or 0)
    values[mask] = np.nan
    if dx < 0:
        values, left, dx = values[:, ::-1], left + dx * values.shape[1], -dx
    if dy < 0:
        values, top, dy = values[::-1], top + dy * values.shape[0], -dy
    made = raster(values, origin=(left + dx / 2, top + dy / 2), spacing=(dx, dy))
    return dataclasses.replace(made, crs=crs)
