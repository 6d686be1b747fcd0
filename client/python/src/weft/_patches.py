# SPDX-License-Identifier: Apache-2.0
"""A part of a mesh anew, and meshes that are joined, by `weft remesh` and `weft stitch`."""

from __future__ import annotations

import json
import os
import pathlib
import tempfile
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _convert, _options
from .errors import DomainError, MeshFileError

if TYPE_CHECKING:
    from ._mesh import Mesh


def remesh(mesh: Mesh, within: Any, options: Mapping[str, Any]) -> Mesh:
    """See Mesh.remesh."""
    with tempfile.TemporaryDirectory(prefix="weft-") as name:
        folder = pathlib.Path(name)
        return _made([mesh], folder, "remesh", "--within", str(_polygons(within, folder)), *_flags(options))


def stitch(*meshes: Mesh, tolerance: float | None = None) -> Mesh:
    """Joins meshes whose outlines meet vertex by vertex. Vertices, triangles and edges of the first come first,
    with their numbers. By the program weft, which is in the package or in the PATH.

    `tolerance`: vertices of two outlines that are within it become one, in the unit of the points; default:
    1e-9 of the extent.

    Raises MeshFileError without the program, and for a vertex of one outline on an edge of another, or meshes
    that overlap, of which it names the first place.

        both = weft.stitch(land, sea)
    """
    if len(meshes) < 2:
        raise ValueError(f"stitch joins two meshes or more, not {len(meshes)}")
    flags = [] if tolerance is None else [f"--tolerance={tolerance!r}"]
    with tempfile.TemporaryDirectory(prefix="weft-") as name:
        return _made(meshes, pathlib.Path(name), "stitch", *flags)


def _made(meshes: Sequence[Mesh], folder: pathlib.Path, command: str, *arguments: str) -> Mesh:
    files = [folder / f"{number}.npz" for number in range(len(meshes))]
    for mesh, file in zip(meshes, files):
        mesh.write(file)
    out = folder / "made.npz"
    try:
        _convert.run(command, *map(str, files), "-o", str(out), "--quiet", *arguments, error=MeshFileError)
    except _convert.Refused as refused:
        raise (DomainError if refused.usage else MeshFileError)(str(refused)) from None
    return type(meshes[0]).read(out)


def _polygons(within: Any, folder: pathlib.Path) -> pathlib.Path:
    """The file of what may be a path, GeoJSON, or rings."""
    if isinstance(within, (str, os.PathLike)):
        return pathlib.Path(within).absolute()
    shape = getattr(within, "__geo_interface__", within)
    if not isinstance(shape, Mapping):
        rings = [within] if np.ndim(within[0]) == 1 else within
        closed = [np.vstack([ring, ring[:1]]).tolist() for ring in map(np.asarray, rings)]
        shape = {"type": "Polygon", "coordinates": closed}
    file = folder / "within.geojson"
    file.write_text(json.dumps(shape))
    return file


def _flags(options: Mapping[str, Any]) -> list[str]:
    known = _options.by_keyword()
    flags = []
    for name, value in options.items():
        if name not in known and name not in ("size", "edge", "edge_at", "keep", "lonlat"):
            raise TypeError(f"remesh has no option {name!r}")
        if value is None or value is False:
            continue
        flag = "--" + name.replace("_", "-")
        if name == "edge_at":
            flags += [f"{flag}=marker={marker}:{length!r}" for marker, length in value.items()]
        elif value is True:
            flags.append(flag)
        elif name == "keep" and not isinstance(value, str) and np.ndim(value) == 1:
            flags.append(f"{flag}={','.join(map(str, value))}")
        else:
            flags.append(f"{flag}={value}")
    return flags
