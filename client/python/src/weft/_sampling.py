# SPDX-License-Identifier: Apache-2.0
"""Samples a function on a grid that is fine enough for it, or says where it is not."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from ._masked import nan_where_masked
from ._warning import warn
from .errors import DomainError

Floats = npt.NDArray[np.float64]
Function = Callable[[Floats, Floats], npt.ArrayLike]

FIRST = 513
"""Samples along the longer side of the first grid."""
MOST = 2049
"""Samples along that side of the last grid; each grid is twice as fine as the one before."""
_FACTOR = 1.25
"""Between samples, lengths of edges may be off by this factor."""


def evaluate(function: Function, x: Floats, y: Floats) -> Floats:
    """The function at points in arrays of any one shape. Raises DomainError."""
    try:
        values = np.broadcast_to(nan_where_masked(function(x, y), np.float64), x.shape)
    except (TypeError, ValueError) as error:
        raise DomainError(f"size: the function of arrays {x.shape} does not give such an array: "
                          f"{error}") from error
    bad = np.argwhere(~((values > 0) & np.isfinite(values)))
    if len(bad):
        at = tuple(bad[0])
        raise DomainError(f"size: the size at ({x[at]}, {y[at]}) is {values[at]}; it must be positive "
                          "and finite, even outside of the domain")
    return values


def sample(function: Function, box: tuple[float, float, float, float], probes: Floats,
           lengths: bool) -> tuple[Floats, tuple[float, float], float]:
    """Values (rows, columns), origin and spacing of a grid over the box: min x, min y, max x, max y.

    The function is evaluated on the first grid, in the middles of its cells and at `probes`, (p, 2),
    places in the box that deserve to be looked at, such as the vertices of the domain. A cell is too
    coarse if the function there is off by more than a quarter from what the grid gives, and the cell
    is larger than the edges of the triangles that the function asks for; `lengths`: it gives these,
    otherwise areas. While there are such cells, the grid is halved, and evaluated in and beside
    them, up to the last grid; then a WeftWarning says where it is too coarse still. The same
    function gives the same values; it is called some 10 times, for at most 2 * MOST**2 points
    besides the probes in each.
    """
    left, bottom, right, top = box
    step = max(right - left, top - bottom) / (FIRST - 1)
    if not (step > 0 and np.isfinite(step)):
        raise DomainError(f"raster: the box {box} holds nothing")
    columns, rows = (int(np.ceil(side / step - 1e-9)) + 1 for side in (right - left, top - bottom))
    values = np.array(evaluate(function, *_grid(box, step, columns, rows)))
    at_probes = evaluate(function, *probes.T.copy())
    look = np.ones((max(rows - 1, 1), max(columns - 1, 1)), bool)
    if rows == 1 or columns == 1:
        return values, (left, bottom), step
    samples = FIRST
    while True:
        coarse, worst = _too_coarse(function, box, step, values, look, probes, at_probes, lengths)
        if worst is None:
            return values, (left, bottom), step
        if samples >= MOST:
            _warn(worst, step)
            return values, (left, bottom), step
        samples = 2 * samples - 1
        step /= 2
        look = _grown(coarse).repeat(2, axis=0).repeat(2, axis=1)
        values = _halved(values)
        inside = np.zeros(values.shape, bool)
        for up in (0, 1):
            for aside in (0, 1):
                inside[up:up + look.shape[0], aside:aside + look.shape[1]] |= look
        inside[::2, ::2] = False  # known
        row, column = np.nonzero(inside)
        values[inside] = evaluate(function, left + step * column, bottom + step * row)


def _grid(box: tuple[float, float, float, float], step: float, columns: int,
          rows: int) -> tuple[Floats, Floats]:
    x, y = np.meshgrid(box[0] + step * np.arange(columns), box[1] + step * np.arange(rows))
    return x, y


def _too_coarse(function: Function, box: tuple[float, float, float, float], step: float,
                values: Floats, look: npt.NDArray[np.bool_], probes: Floats, at_probes: Floats,
                lengths: bool) -> tuple[npt.NDArray[np.bool_],
                                        tuple[float, float, float, float] | None]:
    """Which cells are too coarse, and of the worst: x, y, what the function is there, and what the
    grid gives."""
    j, i = np.nonzero(look)
    x, y = box[0] + step * (i + 0.5), box[1] + step * (j + 0.5)
    # The middles of the cells, then the probes.
    px, py = (probes - box[:2]).T / step
    pi = np.clip(px.astype(np.int64), 0, look.shape[1] - 1)
    pj = np.clip(py.astype(np.int64), 0, look.shape[0] - 1)
    true = np.concatenate([evaluate(function, x, y), at_probes])
    row, column = np.concatenate([j, pj]), np.concatenate([i, pi])
    u = np.concatenate([np.full(len(i), 0.5), np.clip(px - pi, 0, 1)])
    v = np.concatenate([np.full(len(j), 0.5), np.clip(py - pj, 0, 1)])
    corners = [values[row + b, column + a] for b in (0, 1) for a in (0, 1)]
    given = ((1 - v) * ((1 - u) * corners[0] + u * corners[1])
             + v * ((1 - u) * corners[2] + u * corners[3]))
    least = np.minimum.reduce([*corners, true])
    edges = least if lengths else np.sqrt(least * (4 / np.sqrt(3)))
    factor = _FACTOR if lengths else _FACTOR**2
    off = np.abs(np.log(true / given))
    bad = (off > np.log(factor)) & (step > edges)
    coarse = np.zeros(look.shape, bool)
    if not bad.any():
        return coarse, None
    coarse[row[bad], column[bad]] = True
    k = int(np.argmax(np.where(bad, off, 0)))
    at = (float(np.concatenate([x, probes[:, 0]])[k]), float(np.concatenate([y, probes[:, 1]])[k]))
    return coarse, (*at, float(true[k]), float(given[k]))


def _grown(cells: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """These cells and all that touch them."""
    wide = np.pad(cells, 1)
    rows, columns = cells.shape
    grown = np.zeros_like(cells)
    for j in range(3):
        for i in range(3):
            grown |= wide[j:j + rows, i:i + columns]
    return grown


def _halved(values: Floats) -> Floats:
    """Bilinear between the nodes, on a grid of half the spacing."""
    rows, columns = values.shape
    fine = np.empty((2 * rows - 1, 2 * columns - 1))
    fine[::2, ::2] = values
    fine[1::2, ::2] = (values[1:] + values[:-1]) / 2
    fine[:, 1::2] = (fine[:, 2::2] + fine[:, :-2:2]) / 2
    return fine


def _warn(worst: tuple[float, float, float, float], step: float) -> None:
    x, y, true, given = worst
    warn(
        f"the size was sampled every {step:.3g}, which is too coarse for it: at ({x:.6g}, {y:.6g}) it "
        f"is {true:.3g}, but {given:.3g} between the samples; give an expression, or a Raster of that "
        "part of the domain")
