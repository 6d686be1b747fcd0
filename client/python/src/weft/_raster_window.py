# SPDX-License-Identifier: Apache-2.0
"""What of a raster file a box needs, by the rules of files/formats/rasters/raster_window.cpp: the
same file and box give the same nodes and values as on the command line."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from ._raster_file import Floats, Grid, RasterFile
from ._text import coordinates, shortest
from ._warning import warn
from .errors import DomainError

Box = tuple[float, float, float, float]  # min x, min y, max x, max y

MOST_VALUES = 16 << 20
_MARGIN = 2  # nodes on each side of the box
_MOST_READ = 10**11  # values to average: more would take minutes
_TILE_VALUES = 1 << 22  # held in memory while they are averaged


@dataclasses.dataclass(frozen=True)
class Window:
    """Nodes (rows, columns), from the south-west; NaN where there is no data."""

    values: Floats
    origin: tuple[float, float]
    spacing: tuple[float, float]


@dataclasses.dataclass(frozen=True)
class _Plan:
    """Means over factor_x * factor_y nodes of a grid, from `column` and `row` on, which may lie outside
    of a grid that wraps around after `period` columns."""

    grid: int
    x: float  # of column 0
    period: int  # 0: it does not wrap around
    column: int
    columns: int
    row: int
    rows: int
    factor_x: int
    factor_y: int

    def shape(self) -> tuple[int, int]:
        return -(-self.rows // self.factor_y), -(-self.columns // self.factor_x)

    def values(self) -> int:
        rows, columns = self.shape()
        return rows * columns


def read_window(file: RasterFile, box: Box, most: int = MOST_VALUES) -> Window:
    """The nodes in the box, and two more on each side if the raster has them; with more than `most`
    nodes at the resolution of an overview, or by means. Warns of what is odd; raises DomainError."""
    shift, turn = _place(file, box)
    plan = _best_plan(file, box, shift, turn, most)
    if plan.columns * plan.rows > _MOST_READ:
        raise DomainError(f"{file.name}: {shortest(plan.columns * plan.rows)} values in the domain's "
                          "box; make overviews of the raster (gdaladdo)")
    grid, own = file.grids[plan.grid], file.grids[0]
    averaged = plan.factor_x > 1 or plan.factor_y > 1
    values = (_means(file, plan) if averaged
              else _tile(file, plan, 0, plan.columns, 0, plan.rows))
    made = Window(values, (plan.x + (plan.column + (plan.factor_x - 1) / 2) * grid.dx,
                           grid.y + (plan.row + (plan.factor_y - 1) / 2) * grid.dy),
                  (grid.dx * plan.factor_x, grid.dy * plan.factor_y))
    if averaged or plan.grid > 0:
        warn(f"{file.name}: read at a resolution of {coordinates(*made.spacing)}, not its own of "
             f"{coordinates(own.dx, own.dy)}, because the domain's box has more than {most:,} of its "
             "values")
    if np.isnan(values).all():
        warn(f"{file.name}: has no data in the domain's box")
    return made


def _place(file: RasterFile, box: Box) -> tuple[float, float]:
    """By how much the raster is shifted, and the turn. Raises DomainError if it does not meet the
    box."""
    grid = file.grids[0]
    left, bottom, right, top = grid.extent()

    def overlap(shift: float) -> float:
        return min(box[2], right + shift) - max(box[0], left + shift)

    turn, best = file.turn, 0
    goes_round = grid.looks_like_degrees() and abs(right - left - 360) < 1.5 * grid.dx
    guessed = not file.crs and grid.looks_like_degrees()
    if guessed and (goes_round or overlap(0) < 0):
        turn = 360.0
    if turn > 0 and max(abs(box[0]), abs(box[2])) <= 1.5 * turn:
        for turns in (-1, 1, -2, 2):
            if overlap(turns * turn) > overlap(best * turn):
                best = turns
    if top < box[1] or bottom > box[3] or not overlap(best * turn) >= 0:
        system = f" in {file.crs}" if file.crs else ""
        raise DomainError(f"{file.name}: the raster, {_text((left, bottom, right, top))}{system}, does "
                          f"not meet the domain's box, {_text(box)}")
    if guessed and best and not goes_round:
        warn(f"{file.name}: has no coordinate system; its x are taken for longitudes, and shifted by "
             f"{shortest(best * turn)}")
    return best * turn, turn


def _text(box: Box) -> str:
    return f"{coordinates(*box[:2])} to {coordinates(*box[2:])}"


def _best_plan(file: RasterFile, box: Box, shift: float, turn: float, most: int) -> _Plan:
    """That with most values; of several, that of the coarsest grid, which is read fastest."""
    def of_grid(index: int) -> _Plan:
        factor = 1
        found = _plan(file.grids[index], index, box, shift, turn, factor)
        while found.values() > most:
            factor = max(factor + 1, int(math.sqrt(found.values() / most) * factor))
            found = _plan(file.grids[index], index, box, shift, turn, factor)
        return found

    best = of_grid(0)
    if best.factor_x == 1 and best.factor_y == 1:
        return best
    for index in range(1, len(file.grids)):
        other = of_grid(index)
        if other.values() >= best.values():
            best = other
    return best


def _plan(grid: Grid, index: int, box: Box, shift: float, turn: float, factor: int) -> _Plan:
    x, period = grid.x + shift, 0
    # A seam counts only if it meets the nodes to within a tenth of a cell.
    around = turn / grid.dx
    if turn > 0 and 1.5 < around < 1e9 and abs(around - round(around)) <= 0.1:
        period = round(around)
    column, columns = _nodes_between(box[0], box[2], x, grid.dx, _MARGIN * factor)
    column, columns = (_with_values(column, columns, grid.columns, period) if period
                       else _inside(column, columns, grid.columns))
    row, rows = _inside(*_nodes_between(box[1], box[3], grid.y, grid.dy, _MARGIN * factor), grid.rows)
    return _Plan(index, x, period, column, columns, row, rows, min(factor, columns),
                 min(factor, rows))


def _nodes_between(low: float, high: float, first: float, step: float, margin: int) -> tuple[int, int]:
    """The first node and how many there are between the two numbers, with a margin on each side."""
    at = [min(max((end - first) / step, -1e12), 1e12) for end in (low, high)]
    begin, end = math.ceil(at[0]) - margin, math.floor(at[1]) + margin + 1
    return begin, end - begin


def _inside(first: int, count: int, of: int) -> tuple[int, int]:
    begin = min(max(first, 0), of - 1)
    return begin, min(max(first + count, begin + 1), of) - begin


def _with_values(first: int, count: int, columns: int, period: int) -> tuple[int, int]:
    """Without the columns before the first one, and after the last one, that has values."""
    begin, end = first, first + min(count, 2 * period)
    if (at := begin % period) >= columns:
        begin += period - at
    if (at := (end - 1) % period) >= columns:
        end -= at - columns + 1
    return begin, max(end - begin, 1)


def _tile(file: RasterFile, plan: _Plan, column: int, columns: int, row: int, rows: int) -> Floats:
    """The plan's own columns and rows; NaN in a gap at the seam."""
    grid = file.grids[plan.grid]
    out = np.full((rows, columns), np.nan, np.float32)
    begin = i = plan.column + column
    period = plan.period or grid.columns
    width = min(grid.columns, period)
    while i < begin + columns:
        at = i % period
        count = min((width if at < width else period) - at, begin + columns - i)
        if at < width:
            out[:, i - begin:i - begin + count] = file.read(plan.grid, at, plan.row + row, count, rows)
        i += count
    return out


def _means(file: RasterFile, plan: _Plan) -> Floats:
    """By tiles that fit in memory."""
    fx, fy = plan.factor_x, plan.factor_y
    out = np.empty(plan.shape(), np.float32)
    most_columns = min(max(_TILE_VALUES // (fx * fy), 1), out.shape[1])
    most_rows = min(max(_TILE_VALUES // (fx * fy) // most_columns, 1), out.shape[0])
    for j in range(0, out.shape[0], most_rows):
        for i in range(0, out.shape[1], most_columns):
            part = out[j:j + most_rows, i:i + most_columns]
            tile = _tile(file, plan, i * fx, min(part.shape[1] * fx, plan.columns - i * fx),
                         j * fy, min(part.shape[0] * fy, plan.rows - j * fy))
            part[:] = _means_of(tile, part.shape, fx, fy)
    return out


def _means_of(tile: Floats, shape: tuple[int, ...], fx: int, fy: int) -> Floats:
    """Of the values that are there, added row by row, as the command line adds them."""
    sums, counts = np.zeros(shape), np.zeros(shape, np.int64)
    for b in range(fy):
        for a in range(fx):
            some = tile[b::fy, a::fx]
            there = ~np.isnan(some)
            to = slice(some.shape[0]), slice(some.shape[1])
            sums[to] += np.where(there, some, 0)
            counts[to] += there
    with np.errstate(invalid="ignore"):
        means: Floats = (sums / np.where(counts, counts, np.nan)).astype(np.float32)
    return means
