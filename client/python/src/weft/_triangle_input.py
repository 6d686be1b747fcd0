# SPDX-License-Identifier: Apache-2.0
"""The dict that weft.triangulate takes, and the domain that it stands for."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._hull import convex_hull
from ._masked import refuse_masked
from ._poly import region_ids
from ._switches import Switches
from .domain import Domain, Region
from .errors import DomainError
from .fields import Field

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Arrays = dict[str, npt.NDArray[Any]]

_INPUT = {"vertices": (np.float64, 2), "vertex_markers": (np.int32, 1), "vertex_attributes": (np.float64, 0),
          "segments": (np.int32, 2), "segment_markers": (np.int32, 1), "holes": (np.float64, 2),
          "regions": (np.float64, 4), "triangles": (np.int32, 0), "triangle_attributes": (np.float64, 0),
          "triangle_max_area": (np.float64, 1)}
"""The dtype and the columns of each array of the input; 0: any number."""
_OUTPUT_ALONE = {"edges", "edge_markers", "neighbors"}


def read(tri: Mapping[str, npt.ArrayLike]) -> Arrays:
    """The arrays of the input, each of its type and shape; those that are missing have no rows."""
    for key in tri:
        if key not in _INPUT and key not in _OUTPUT_ALONE:
            raise DomainError(f"the key {key!r} is unknown; there are {', '.join(_INPUT)}")
    given = {key: _array(key, tri.get(key, ()), dtype, columns)
             for key, (dtype, columns) in _INPUT.items()}
    if len(given["vertices"]) < 3:
        raise DomainError(f"vertices: {len(given['vertices'])}, expected 3 or more")
    for key, of in (("vertex_markers", "vertices"), ("vertex_attributes", "vertices"),
                    ("segment_markers", "segments"), ("triangle_attributes", "triangles"),
                    ("triangle_max_area", "triangles")):
        if len(given[key]) not in (0, len(given[of])):
            raise DomainError(f"{key}: {len(given[key])} for {len(given[of])} {of}")
    return given


def _array(key: str, values: npt.ArrayLike, dtype: Any, columns: int) -> npt.NDArray[Any]:
    refuse_masked(key, values)
    try:
        array = np.asarray(values)
        converted = array.astype(dtype)
    except (TypeError, ValueError) as error:
        raise DomainError(f"{key}: {error}") from None
    if dtype is np.int32 and not np.array_equal(array, converted):
        raise DomainError(f"{key}: not integers of 32 bits")
    if dtype is np.float64 and not np.isfinite(converted).all():
        raise DomainError(f"{key}[{np.argwhere(~np.isfinite(converted))[0][0]}] is not finite")
    if array.size == 0:
        return np.zeros((0, columns), dtype)
    if array.ndim == 1 and columns in (0, 1):
        converted = converted[:, None]
    if converted.ndim != 2 or columns not in (0, converted.shape[1]):
        raise DomainError(f"{key}: an array {array.shape}, expected (n, {columns or 'k'})")
    return converted


@dataclasses.dataclass(frozen=True, eq=False)
class Problem:
    """What weft is asked for, besides an angle."""

    domain: Domain
    size: float | str | None
    fields: Mapping[str, Field]
    attributes: Mapping[int, Floats]
    """Of triangles, by region."""


def graph_problem(given: Arrays, switches: Switches) -> Problem:
    """The domain of the segments, of the convex hull, or of both; without r. Raises DomainError."""
    points = given["vertices"]
    segments, markers = given["segments"], column(given["segment_markers"], len(given["segments"]))
    if not switches.poly:
        segments, markers = segments[:0], markers[:0]
    if switches.convex or not switches.poly:
        hull = convex_hull(points)
        segments = np.concatenate([segments, np.column_stack([hull, np.roll(hull, -1)])])
        markers = np.concatenate([markers, np.zeros(len(hull), np.int32)])
    attributes, regions = {}, []
    if switches.poly and (switches.attributes or switches.own_areas):
        ids = region_ids(given["regions"][:, 2].tolist())
        attributes = {number: np.array([value]) for value, number in ids.items()}
        regions = [Region(x, y, ids[attribute], area if switches.own_areas and area > 0 else None)
                   for x, y, attribute, area in given["regions"].tolist()]
    holes = given["holes"] if switches.poly and not switches.no_holes else ()
    domain = Domain(points, segments, markers=markers, holes=np.array(holes), regions=regions)
    return Problem(domain, switches.max_area, {}, attributes)


def column(values: npt.NDArray[Any], rows: int) -> npt.NDArray[Any]:
    """(rows,): zeros if there are none."""
    return values[:, 0] if len(values) else np.zeros(rows, values.dtype)
