# SPDX-License-Identifier: Apache-2.0
"""An open raster file, by the rules of files/formats/rasters/gdal_source.cpp."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _raster_band
from ._optional import need
from .errors import DomainError

Floats = npt.NDArray[np.float32]

_CHUNK_VALUES = 1 << 21  # held in memory while they are converted


@dataclasses.dataclass(frozen=True)
class Grid:
    """Where the nodes are, from the south-west."""

    x: float
    y: float
    dx: float
    dy: float
    columns: int
    rows: int

    def extent(self) -> tuple[float, float, float, float]:
        """With half a cell around the nodes: min x, min y, max x, max y."""
        return (self.x - self.dx / 2, self.y - self.dy / 2, self.x + (self.columns - 0.5) * self.dx,
                self.y + (self.rows - 0.5) * self.dy)

    def looks_like_degrees(self) -> bool:
        """Whether the coordinates may be longitudes and latitudes."""
        left, bottom, right, top = self.extent()
        return (left >= -360 - self.dx and right <= 360 + self.dx
                and right - left <= 360 + 1.5 * self.dx and bottom >= -90 - self.dy
                and top <= 90 + self.dy)


class RasterFile:
    """One band, which _raster_band.py finds: `grids` of the raster and of its overviews, `crs`, the
    name of its coordinate system, and `wkt`, its definition, which are empty if it has none; x + `turn`
    is the same place as x, 0: there is no such number. Raises DomainError, MissingPackage."""

    def __init__(self, path: str, band: str) -> None:
        gdal = need("osgeo.gdal", "weft.raster of a file", "gdal")
        gdal.UseExceptions()
        self.name = f"{path}:{band}" if band else path
        self._type = gdal.GDT_Float64
        self._all_valid = gdal.GMF_ALL_VALID
        try:
            self._data, chosen = _raster_band.choose(gdal, path, band)
            overviews = (chosen.GetOverview(i) for i in range(chosen.GetOverviewCount()))
            self._levels = [chosen, *overviews]
            transform = self._data.GetGeoTransform(can_return_null=True)
            system = self._data.GetSpatialRef()
        except RuntimeError as error:
            raise DomainError(f"{path}: {error}") from error
        self._scale = self._number(self._levels[0].GetScale(), 1.0)
        self._offset = self._number(self._levels[0].GetOffset(), 0.0)
        self.grids = self._locate(transform)
        self.crs, self.wkt, self.turn = "", "", 0.0
        if system is not None:
            self.crs = system.GetName() or "an unnamed coordinate system"
            self.wkt = system.ExportToWkt(["FORMAT=WKT2"])
            if system.IsGeographic():
                radians = system.GetAngularUnits()
                self.turn = 360.0 if abs(radians * 360 - 2 * math.pi) < 1e-9 else 2 * math.pi / radians

    def read(self, grid: int, column: int, row: int, columns: int, rows: int) -> Floats:
        """(rows, columns), from the southmost row; NaN for what the file calls no data, masks, or is no
        finite float."""
        out = np.empty((rows, columns), np.float32)
        most = max(1, _CHUNK_VALUES // columns)
        for first in range(0, rows, most):
            count = min(most, rows - first)
            out[first:first + count] = self._read_chunk(grid, column, row + first, columns, count)
        return out

    @staticmethod
    def _number(value: float | None, default: float) -> float:
        return default if value is None else float(value)

    def _locate(self, transform: Any) -> list[Grid]:
        if transform is None:
            raise DomainError(f"{self.name}: has no place in the plane: no geotransform; gdalwarp gives "
                              "it one")
        left, dx, shear, top, other_shear, dy = transform
        columns, rows = self._levels[0].XSize, self._levels[0].YSize
        # A shear that moves no pixel by a hundredth of itself is a rounding error.
        if not (abs(shear) * rows <= abs(dx) / 100 and abs(other_shear) * columns <= abs(dy) / 100):
            raise DomainError(f"{self.name}: its geotransform, {transform}, is rotated or sheared; "
                              "gdalwarp makes it upright")
        self._mirrored, self._south_up = dx < 0, dy > 0
        west = left + columns * dx if self._mirrored else left
        south = top if self._south_up else top + rows * dy
        if not (dx and dy and all(map(math.isfinite, (west, south, dx, dy)))):
            raise DomainError(f"{self.name}: has no place in the plane: its geotransform is {transform}")
        grids = []
        for level in self._levels:
            step_x = abs(dx) * columns / level.XSize
            step_y = abs(dy) * rows / level.YSize
            grids.append(Grid(west + step_x / 2, south + step_y / 2, step_x, step_y, level.XSize,
                              level.YSize))
        return grids

    def _read_chunk(self, index: int, column: int, row: int, columns: int, rows: int) -> Floats:
        grid, band = self.grids[index], self._levels[index]
        x = grid.columns - column - columns if self._mirrored else column
        y = row if self._south_up else grid.rows - row - rows
        try:
            values = band.ReadAsArray(x, y, columns, rows, buf_type=self._type)
            mask = None
            if not band.GetMaskFlags() & self._all_valid:
                mask = band.GetMaskBand().ReadAsArray(x, y, columns, rows)
        except RuntimeError as error:
            raise DomainError(f"{self.name}: {error}") from error
        values = values * self._scale + self._offset
        with np.errstate(invalid="ignore"):
            values[~(np.abs(values) <= np.finfo(np.float32).max)] = np.nan
        if mask is not None:
            values[mask == 0] = np.nan
        upright = values if self._south_up else values[::-1]
        found: Floats = (upright[:, ::-1] if self._mirrored else upright).astype(np.float32)
        return found
