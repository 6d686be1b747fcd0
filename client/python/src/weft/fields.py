# SPDX-License-Identifier: Apache-2.0
"""What a size expression may name besides x and y.

    mesh = client.mesh("coast.geojson", edge="min(500 + 0.15*coast, 20000)",
                       fields={"coast": weft.distance(marker=2)}, gradation=0.15)

The server computes them, so that an expression of fields is as exact and as fast as one of x and y.
"""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterable, Sequence
from types import FunctionType
from typing import TYPE_CHECKING, Any, TypeGuard, Union

import numpy as np
import numpy.typing as npt

from ._masked import nan_where_masked, refuse_masked
from ._names import marker_of
from ._raster_file import RasterFile
from ._raster_window import MOST_VALUES, read_window
from ._short import ShortRepr
from .errors import DomainError

if TYPE_CHECKING:
    from .domain import Domain
    from ._mesh import Mesh

Field = Union["Distance", "RasterField", "FileField", "MeshField", "Width"]
"""A number at every point: see distance, raster, on_mesh and width."""

_BYTES = 2  # the wire type of packed arrays


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Distance(ShortRepr):
    """See distance."""

    markers: Sequence[int | str]
    points: npt.NDArray[np.float64]
    segments: npt.NDArray[np.uint32]

    def _fill(self, message: Any, domain: Domain) -> None:
        to = message.distance
        to.SetInParent()
        to.markers.extend(marker_of(marker, domain.marker_names) for marker in self.markers)
        to.MergeFromString(_packed(2, self.points.astype("<f8")))
        to.segments.extend(self.segments.ravel().tolist())


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class RasterField(ShortRepr):
    """See raster."""

    values: npt.NDArray[np.float32]
    origin: tuple[float, float]
    spacing: tuple[float, float]

    def _fill(self, message: Any, domain: Domain) -> None:
        to = message.raster
        to.x, to.y = self.origin
        to.dx, to.dy = self.spacing
        to.rows, to.columns = self.values.shape
        to.MergeFromString(_packed(7, self.values.astype("<f4")))


@dataclasses.dataclass(frozen=True)
class FileField:
    """See raster: of a file, which is read when the domain is known."""

    path: str
    band: str
    most: int = MOST_VALUES
    """Values to send at most."""

    def open(self) -> RasterFile:
        return RasterFile(self.path, self.band)

    def _fill(self, message: Any, domain: Domain) -> None:
        window = read_window(self.open(), domain.box(), self.most)
        RasterField(**vars(window))._fill(message, domain)


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class MeshField(ShortRepr):
    """See on_mesh."""

    points: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int32]
    values: npt.NDArray[np.float64]

    def _fill(self, message: Any, domain: Domain) -> None:
        to = message.mesh
        to.MergeFromString(_packed(1, self.points.astype("<f8")))
        to.triangles.extend(self.triangles.ravel().tolist())
        to.MergeFromString(_packed(3, self.values.astype("<f8")))


@dataclasses.dataclass(frozen=True)
class Width:
    """See width."""

    def _fill(self, message: Any, domain: Domain) -> None:
        message.width.SetInParent()


def distance(*, marker: int | str | Iterable[int | str] = (), points: npt.ArrayLike | None = None,
             segments: npt.ArrayLike | None = None) -> Distance:
    """The distance to the nearest of some segments or points, in the unit of the domain.

    Without arguments: to all segments of the domain. `marker`: to those with this marker, or with
    one of these; numbers, or names of the domain's `marker_names`. `points`, (n, 2): to these
    instead; `segments`, (m, 2): to the segments that join two of them each. Raises DomainError.
    """
    markers = tuple(marker) if isinstance(marker, Iterable) and not isinstance(marker, str) else (marker,)
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
           band: int | str | None = None) -> RasterField | FileField:
    """Values on a grid: bilinear between its nodes; undefined outside, and beside a NaN.

    `source`: an array (rows, columns), `source[j, i]` at `(origin[0] + i * spacing[0], origin[1] +
    j * spacing[1])`; or the path of a raster that GDAL reads (needs the package gdal), whose nodes are
    the centres of its cells. `band`: the number of a band, from 1, or its name; of a file of several
    variables, such as NetCDF, the name or the number of one, and "name:number" one band of it;
    default: the only one. A file is read when a mesh is asked for: what the box of the domain needs
    of it, and two more nodes on each side; of more than 16 Mi values an overview or means over
    squares of them, with a WeftWarning that has both resolutions. On a domain in longitude and
    latitude it is projected: a file by its own coordinate system, an array from longitude and
    latitude.
    Raises DomainError; of a file, the methods that ask for a mesh do so, or raise MissingPackage.
    """
    if isinstance(source, (str, os.PathLike)):
        return FileField(os.fspath(source), "" if band is None else str(band))
    values = nan_where_masked(source, np.float32)
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

    `mesh`: a Mesh, or its points (n, 2) and triangles (m, 3). `values`: (n,), NaN at vertices
    where the field is undefined. Raises DomainError.

        mesh = client.mesh(domain, edge=weft.on_mesh(mesh, h))
    """
    points, triangles = mesh if isinstance(mesh, tuple) else (mesh.points, mesh.triangles)
    vertices = _table("on_mesh: points", points, np.float64, 2)
    corners = _table("on_mesh: triangles", triangles, np.int32, 3)
    numbers = nan_where_masked(values, np.float64)
    if numbers.shape != (len(vertices),):
        raise DomainError(f"on_mesh: values of shape {numbers.shape} for {len(vertices)} points")
    return MeshField(vertices, corners, numbers)


def width() -> Width:
    """The local width of the domain: the diameter of the largest disk inside it that holds the
    point."""
    return Width()


def is_field(value: object) -> TypeGuard[Field]:
    return isinstance(value, (Distance, RasterField, FileField, MeshField, Width))


def check_is_field(name: str, field: object) -> None:
    """Raises DomainError, which names the field, if it is none."""
    if is_field(field):
        return
    given = f"the function {field.__name__}" if isinstance(field, FunctionType) else repr(field)[:80]
    raise DomainError(f"fields[{name!r}] is {given}, not a field; fields are made by "
                      "weft.distance(...), weft.raster(...), weft.on_mesh(...) and weft.width()")


def _table(what: str, rows: npt.ArrayLike, kind: Any, columns: int) -> Any:
    refuse_masked(what, rows)
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
