# SPDX-License-Identifier: Apache-2.0
"""How large triangles may be."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import TYPE_CHECKING, Union

import numpy as np
import numpy.typing as npt

from . import _sampling
from ._masked import nan_where_masked
from ._short import ShortRepr
from .errors import DomainError

if TYPE_CHECKING:
    from .fields import Field

Floats = npt.NDArray[np.float64]
Size = Union[float, str, "Raster", "Field", Callable[[Floats, Floats], npt.ArrayLike], None]
# The text of help(weft.Size).
Size.__doc__ = """Upper bound on the area of a triangle at its centroid, in squared units of the domain: a number;
an expression in x, y and names of fields; a Raster; a field, such as values at the vertices of an earlier
mesh, see on_mesh; a function of two arrays, see Raster.adaptive, which samples it; or None for no bound."""


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Raster(ShortRepr):
    """A size on a grid: bilinear between its nodes, outside it that of its nearest point.

    `values`: (rows, columns) float64, squared units of the domain, positive and finite, even where
    there is no domain; `values[j, i]` is at `(origin[0] + i * spacing[0], origin[1] + j *
    spacing[1])`. `origin`, `spacing`: (x, y), in the unit of the domain. Raises DomainError.

        depth = weft.Raster(0.01 * water_depth / 1000, origin=(-82, 24), spacing=(0.25, 0.25))
    """

    values: Floats
    origin: tuple[float, float]
    spacing: tuple[float, float]

    def __post_init__(self) -> None:
        values = nan_where_masked(self.values, np.float64)
        if values.ndim != 2 or values.size == 0:
            raise DomainError(f"raster: values of shape {values.shape}, expected (rows, columns)")
        object.__setattr__(self, "values", values)
        bad = np.argwhere(~((values > 0) & np.isfinite(values)))
        if len(bad):
            j, i = bad[0]
            at = tuple(float(o + k * d) for o, k, d in zip(self.origin, (i, j), self.spacing))
            raise DomainError(f"raster: the size at {at} is {values[j, i]}, in column {i} of row {j}; "
                              "it must be positive and finite")

    @staticmethod
    def sample(function: Callable[[Floats, Floats], npt.ArrayLike],
               box: tuple[float, float, float, float], samples: int = 513) -> Raster:
        """A function of x and y over a box: min x, min y, max x, max y.

        `function` takes two arrays of one shape and gives another of it, or a number. `samples` are
        those along the longer side, 2 or more, and are as far apart along the other. What is finer
        than their distance may be missed. Raises DomainError.
        """
        left, bottom, right, top = box
        step = max(right - left, top - bottom) / (samples - 1)
        if not (step > 0 and np.isfinite(step)):
            raise DomainError(f"raster: the box {box} holds nothing")
        columns = int(np.ceil((right - left) / step - 1e-9)) + 1
        rows = int(np.ceil((top - bottom) / step - 1e-9)) + 1
        x, y = np.meshgrid(left + step * np.arange(columns), bottom + step * np.arange(rows))
        return Raster(_sampling.evaluate(function, x, y), (left, bottom), (step, step))

    @staticmethod
    def adaptive(function: Callable[[Floats, Floats], npt.ArrayLike],
                 box: tuple[float, float, float, float], points: npt.ArrayLike = (), *,
                 lengths: bool = False) -> Raster:
        """As `sample`, with as many samples as the function needs: 513 along the longer side, then 1025
        and 2049 if it changes between them.

        The function is looked at in the middles of the cells of the first grid and at `points`, (p,
        2); `client.mesh` takes the vertices of the domain and the middles of its segments. Where it
        is off there by more than a quarter of the length of edges, and the cell is larger than the
        triangles that it asks for, the next grid is evaluated, too. A WeftWarning says where even the
        last is too coarse. What shows in none of these places is missed. `lengths`: the function
        gives lengths of edges, not areas. The function is called with arrays (p,) or (rows, columns),
        for some millions of points at most.
        """
        probes = np.asarray(points, np.float64).reshape(-1, 2)
        values, origin, step = _sampling.sample(function, box, probes, lengths)
        return Raster(values, origin, (step, step))
