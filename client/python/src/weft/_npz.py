# SPDX-License-Identifier: Apache-2.0
"""NumPy's archive of arrays, as files/formats/meshes/npz.h has it."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]
_MESH = {"points": (np.float64, 2), "triangles": (np.int32, 3), "regions": (np.int32, 1),
         "edges": (np.int32, 2), "edge_markers": (np.int32, 1), "edge_bulges": (np.float64, 1),
         "parts": (np.int32, 1)}
_NAMES = ("marker", "region")
MESH_ARRAYS = (*_MESH, *(f"{kind}_{what}" for kind in _NAMES for what in ("ids", "names")))
"""The names that values at vertices cannot have."""
_STORED = {"triangles": np.uint32, "edges": np.uint32}


def write(path: str | os.PathLike[str], arrays: Mapping[str, Array]) -> None:
    """Stores the arrays under their names, without compression."""
    with zipfile.ZipFile(path, "w") as archive:
        for name, array in arrays.items():
            with archive.open(name + ".npy", "w", force_zip64=True) as file:
                np.save(file, np.ascontiguousarray(array, _STORED.get(name, array.dtype)),
                        allow_pickle=False)


def name_arrays(markers: Mapping[int, str], regions: Mapping[int, str]) -> dict[str, Array]:
    """The arrays of ids and of names; none for a table that is empty."""
    arrays: dict[str, Array] = {}
    for kind, names in zip(_NAMES, (markers, regions)):
        if names:
            arrays[f"{kind}_ids"] = np.array(list(names), np.int32)
            arrays[f"{kind}_names"] = np.array(list(names.values()), np.str_)
    return arrays


def read(path: str | os.PathLike[str]
         ) -> tuple[dict[str, Array], dict[str, Array], dict[int, str], dict[int, str]]:
    """The arrays of the mesh, each of its type and shape, triangles counter-clockwise; the values at
    its vertices, by name; and what markers and regions are called. Raises ValueError, OSError."""
    try:
        with np.load(path, allow_pickle=False) as archive:
            found = {name: archive[name] for name in archive.files}
    except (zipfile.BadZipFile, EOFError, KeyError, AttributeError) as error:
        raise ValueError(f"is not an archive of arrays: {error}") from None
    for name in ("points", "triangles"):
        if name not in found:
            raise ValueError(f"holds no array {name!r}")
    mesh = {name: _shaped(name, found.pop(name, np.zeros(0)), dtype, columns)
            for name, (dtype, columns) in _MESH.items()}
    n, m, k = len(mesh["points"]), len(mesh["triangles"]), len(mesh["edges"])
    for name, count in (("regions", m), ("edge_markers", k)):
        if not len(mesh[name]):
            mesh[name] = np.zeros(count, np.int32)
        if len(mesh[name]) != count:
            raise ValueError(f"{name}: {len(mesh[name])} for {count}")
    for name, count in (("parts", m), ("edge_bulges", k)):
        if len(mesh[name]) not in (0, count):
            raise ValueError(f"{name}: {len(mesh[name])} for {count}")
    for name in ("triangles", "edges"):
        if mesh[name].size and not 0 <= mesh[name].min() <= mesh[name].max() < n:
            raise ValueError(f"{name} name vertices that are not among the {n}")
    if not np.isfinite(mesh["points"]).all():
        raise ValueError("points are not finite")
    if not (np.abs(mesh["edge_bulges"]) <= 1).all():
        raise ValueError("edge_bulges are not of arcs of at most half a circle")
    a, b, c = (mesh["points"][mesh["triangles"][:, i]] for i in range(3))
    turned = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
    mesh["triangles"][turned] = mesh["triangles"][turned][:, [0, 2, 1]]
    values = {name: array.astype(np.float64) for name, array in found.items()
              if array.shape == (n,) and array.dtype.kind == "f"}
    return mesh, values, _names("marker", found), _names("region", found)


def _names(kind: str, found: Mapping[str, Array]) -> dict[int, str]:
    ids, names = found.get(f"{kind}_ids"), found.get(f"{kind}_names")
    if ids is None or names is None:
        return {}
    if ids.ndim != 1 or ids.shape != names.shape or ids.dtype.kind not in "iu" \
            or names.dtype.kind != "U":
        raise ValueError(f"{kind}_ids and {kind}_names are no integers and as many texts")
    return dict(zip(ids.tolist(), names.tolist()))


def _shaped(name: str, array: Array, dtype: Any, columns: int) -> Array:
    if name == "points" and array.ndim == 2 and array.shape[1] == 3:
        array = array[:, :2]
    if columns > 1 and array.size == 0:
        array = array.reshape(0, columns)
    if array.ndim != (2 if columns > 1 else 1) or (columns > 1 and array.shape[1] != columns):
        raise ValueError(f"{name}: an array {array.shape}, expected "
                         + (f"(n, {columns})" if columns > 1 else "(n,)"))
    kinds = "f" if dtype is np.float64 else "iuf" if array.size == 0 else "iu"
    if array.dtype.kind in kinds:
        converted = array.astype(dtype)
        if dtype is not np.int32 or np.array_equal(converted, array):
            return np.ascontiguousarray(converted)
    raise ValueError(f"{name}: {array.dtype} does not fit {np.dtype(dtype)}")
