# SPDX-License-Identifier: Apache-2.0
"""Rasters in a plane, by the rules of files/formats/rasters/projected_window.cpp; PROJ is called
through pyproj."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._optional import need
from ._raster_file import RasterFile
from ._raster_window import MOST_VALUES, Box, Window, read_window
from ._warning import warn
from .errors import DomainError

Floats = npt.NDArray[np.float64]

_DEGREES = 360.0  # how much of x is a full turn in EPSG:4326


def of_array(raster: Window, plane: Any, box: Box) -> Window:
    """Square cells of the plane `plane`, of the raster's resolution, over the box, each with the
    bilinear value of a raster in longitude and latitude."""
    back = _from_plane(plane, "EPSG:4326")
    out = _grid_over(back, box, raster.spacing, _DEGREES, "raster")
    return _filled(out, raster, back, _DEGREES)


def of_file(file: RasterFile, plane: Any, box: Box, most: int) -> Window:
    """The same of the part of a file that the box needs, of at most so many values."""
    if not file.crs and not file.grids[0].looks_like_degrees():
        raise DomainError(f"{file.name}: has no coordinate system, and its coordinates are no degrees; "
                          "gdal_translate -a_srs gives it one")
    back = _from_plane(plane, file.wkt or "EPSG:4326")
    turn = file.turn if file.crs else _DEGREES
    grid = file.grids[0]
    out = _grid_over(back, box, (grid.dx, grid.dy), turn, file.name, most)
    raster = read_window(file, _box_in_raster(back, out, turn, file.name))
    if not file.crs:
        warn(f"{file.name}: has no coordinate system; its coordinates are taken for longitudes and "
             "latitudes (EPSG:4326)")
    return _filled(out, raster, back, turn)


def _from_plane(plane: Any, system: str) -> Any:
    """What leads from the plane to the system."""
    pyproj = need("pyproj", "a raster on a domain in longitude and latitude")
    return pyproj.Transformer.from_crs(plane, pyproj.CRS.from_user_input(system), always_xy=True)


def _grid_over(back: Any, box: Box, spacing: tuple[float, float], turn: float, name: str,
               most: int = MOST_VALUES) -> Window:
    """Square cells over the box, and two more nodes on each side; without values yet."""
    lower, upper = np.array(box[:2]), np.array(box[2:])
    size = _cell_size(back, lower, upper, spacing[0] * spacing[1], turn, name)
    counts = np.ceil((upper - lower) / size) + 5
    while counts.prod() > most:
        size *= 1.01
        counts = np.ceil((upper - lower) / size) + 5
    columns, rows = counts.astype(int).tolist()
    x, y = (lower - 2 * size).tolist()
    return Window(np.empty((rows, columns), np.float32), (x, y), (size, size))


def _filled(out: Window, raster: Window, back: Any, turn: float) -> Window:
    rows, columns = out.values.shape
    x = out.origin[0] + out.spacing[0] * np.arange(columns)
    for j in range(rows):
        at = back.transform(x, np.full(columns, out.origin[1] + out.spacing[1] * j))
        out.values[j] = _bilinear(raster, at[0], at[1], turn)
    return out


def _box_in_raster(back: Any, out: Window, turn: float, name: str) -> Box:
    """The box of the raster that holds the grid, and some more. The inside of the border maps to the
    inside of its image, except at a pole, which has no longitude: there the longitudes along the
    border make a turn, or jump."""
    rows, columns = out.values.shape
    t = np.arange(256) / 256
    zeros, ones = np.zeros(256), np.ones(256)
    x, y = back.transform(
        out.origin[0] + out.spacing[0] * (columns - 1) * np.concatenate([t, ones, 1 - t, zeros, [0]]),
        out.origin[1] + out.spacing[1] * (rows - 1) * np.concatenate([zeros, t, ones, 1 - t, [0]]))
    there = np.isfinite(x) & np.isfinite(y)
    x, y = x[there], y[there]
    if not len(x):
        raise _no_counterpart(name)
    steps = _short_way(np.diff(x), turn)
    along = x[0] + np.concatenate([[0], np.cumsum(steps)])  # continued along the border
    left, right, bottom, top = map(float, (along.min(), along.max(), y.min(), y.max()))
    bottom, top = bottom - (top - bottom) / 64, top + (top - bottom) / 64
    if turn and ((np.abs(steps) > turn / 4).any() or abs(along[-1] - along[0]) > turn / 2):
        if bottom + top > 0:
            return -turn / 2, bottom, turn / 2, turn / 4
        return -turn / 2, -turn / 4, turn / 2, top
    pad = (right - left) / 64
    # The turn that is nearest to the origin, in whatever turn the border began.
    shift = float(_short_way(left, turn)) - left
    return left + shift - pad, bottom, right + shift + pad, top


def _no_counterpart(name: str) -> DomainError:
    return DomainError(f"{name}: the domain has no counterpart in the raster's coordinate system")


def _short_way(difference: Any, turn: float) -> Any:
    return difference - turn * np.round(difference / turn) if turn else difference


def _cell_size(back: Any, lower: Floats, upper: Floats, cell: float, turn: float,
               name: str) -> float:
    """The edge of a square of the plane that is as large as a cell of the raster."""
    step = (upper - lower).max() / 1024
    i, j = np.meshgrid((np.arange(7) + 0.5) / 7, (np.arange(7) + 0.5) / 7, indexing="ij")
    x, y = lower[0] + (upper[0] - lower[0]) * i.ravel(), lower[1] + (upper[1] - lower[1]) * j.ravel()
    (x0, y0), (x1, y1), (x2, y2) = (back.transform(x + dx, y + dy)
                                    for dx, dy in ((0, 0), (step, 0), (0, step)))
    with np.errstate(all="ignore"):
        cells = np.abs(_short_way(x1 - x0, turn) * (y2 - y0)
                       - _short_way(x2 - x0, turn) * (y1 - y0)) / cell
        sizes = step / np.sqrt(cells)
    sizes = np.sort(sizes[np.isfinite(sizes) & (sizes > 0)])
    if not len(sizes):
        raise _no_counterpart(name)
    return float(sizes[len(sizes) // 2])


def _bilinear(raster: Window, x: Floats, y: Floats, turn: float) -> Floats:
    """Of the nodes with data, if the nearest has any; up to two cells beside the raster."""
    values, (dx, dy) = raster.values, raster.spacing
    rows, columns = values.shape
    u, v = (x - raster.origin[0]) / dx, (y - raster.origin[1]) / dy
    if turn:
        u = u - turn / dx * np.floor((u + 0.5) * dx / turn)
    with np.errstate(invalid="ignore"):
        inside = (u >= -2) & (u <= columns + 1) & (v >= -2) & (v <= rows + 1)
    u = np.clip(np.where(inside, u, 0), 0, columns - 1)
    v = np.clip(np.where(inside, v, 0), 0, rows - 1)
    nearest = values[np.floor(v + 0.5).astype(int), np.floor(u + 0.5).astype(int)]
    i, j = np.floor(u).astype(int), np.floor(v).astype(int)
    total, weights = np.zeros(len(u)), np.zeros(len(u))
    for di, wu in ((0, 1 - (u - i)), (1, u - i)):
        for dj, wv in ((0, 1 - (v - j)), (1, v - j)):
            value = values[np.minimum(j + dj, rows - 1), np.minimum(i + di, columns - 1)]
            weight = np.where(np.isnan(value), 0, wu * wv)
            total += weight * np.where(weight > 0, value, 0)
            weights += weight
    with np.errstate(invalid="ignore"):
        return np.where(inside & ~np.isnan(nearest), total / weights, np.nan)
