# SPDX-License-Identifier: Apache-2.0
"""Triangle's files (https://www.cs.cmu.edu/~quake/triangle.html) as the dicts of weft.triangulate.

`name.poly` or `name.node`, and for r `name.ele` and `name.area`, become `name.1.node` and so on; these
`name.2.node`. Points are numbered from 0 or from 1 as the input is.
"""

from __future__ import annotations

import contextlib
import os
import pathlib
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._poly import Lines, indices, region_rows, segment_table
from ._switches import Switches
from ._text import shortest
from .errors import DomainError

Arrays = dict[str, npt.NDArray[Any]]


def beside(base: pathlib.Path, suffix: str) -> pathlib.Path:
    """The file of that suffix; what follows a dot in `base` belongs to its name."""
    return base.with_name(base.name + suffix)


def next_base(base: pathlib.Path) -> pathlib.Path:
    """Of the next mesh: `box` leads to `box.1`, and `box.1` to `box.2`."""
    iteration = re.fullmatch(r"(.*)\.(\d+)", base.name, re.ASCII | re.DOTALL)
    stem, number = (iteration[1], int(iteration[2])) if iteration else (base.name, 0)
    return base.with_name(f"{stem}.{number + 1}")


def read(base: pathlib.Path, switches: Switches) -> tuple[Arrays, int]:
    """What weft.triangulate takes, and the number of the first point, 0 or 1. Raises DomainError, which
    names the file, and OSError."""
    poly, node = beside(base, ".poly"), beside(base, ".node")
    found: Arrays = {}
    numbers = np.zeros(0)
    if switches.poly:
        with _named(poly):
            lines = Lines(poly)
            numbers = _read_points(lines, found)
    if not len(numbers):
        with _named(node):
            numbers = _read_points(Lines(node), found)
    if switches.poly:
        with _named(poly):
            _read_graph(lines, numbers, found)
    if switches.refine:
        with _named(ele := beside(base, ".ele")):
            _read_triangles(Lines(ele), numbers, found)
        if switches.own_areas:
            with _named(area := beside(base, ".area")):
                areas = Lines(area)
                found["triangle_max_area"] = areas.table("areas", areas.header("areas")[0], 2)[:, 1]
    return found, 0 if switches.from_zero or (len(numbers) and numbers[0] == 0) else 1


def write(base: pathlib.Path, mesh: Mapping[str, npt.NDArray[Any]], switches: Switches, first: int,
          given: bool) -> list[pathlib.Path]:
    """Writes what the switches ask for, numbered from `first`, and returns the files. `given`: whether the
    points came from a .node file, which without iteration numbers is not written over."""
    triangles = len(mesh["triangles"])
    attributes = mesh.get("vertex_attributes", np.zeros((len(mesh["vertices"]), 0)))
    markers = mesh.get("vertex_markers")
    files: dict[str, Iterable[str]] = {}
    if not switches.no_node and not (switches.no_iteration and given):
        files[".node"] = _table(f"{len(mesh['vertices'])} 2 {attributes.shape[1]} {_count(markers)}", first,
                                mesh["vertices"], attributes, markers)
    if not switches.no_ele:
        rows = mesh.get("triangle_attributes", np.zeros((triangles, 0)))
        files[".ele"] = _table(f"{triangles} {mesh['triangles'].shape[1]} {rows.shape[1]}", first,
                               mesh["triangles"] + first, rows)
    if "segments" in mesh and not (switches.no_poly or switches.no_iteration):
        files[".poly"] = [f"0 2 {attributes.shape[1]} {_count(markers)}", *_graph(mesh, first)]
    if "edges" in mesh:
        markers = mesh.get("edge_markers")
        files[".edge"] = _table(f"{len(mesh['edges'])} {_count(markers)}", first, mesh["edges"] + first, markers)
    if "neighbors" in mesh:
        across = mesh["neighbors"]
        files[".neigh"] = _table(f"{triangles} 3", first, np.where(across < 0, -1, across + first))
    for suffix, rows_of_file in files.items():
        part = base.with_name(f".weft-{base.name}{suffix}")
        part.write_text("\n".join(rows_of_file) + "\n")
        os.replace(part, beside(base, suffix))
    return [beside(base, suffix) for suffix in files]


def _graph(mesh: Mapping[str, npt.NDArray[Any]], first: int) -> Iterable[str]:
    markers = mesh.get("segment_markers")
    yield from _table(f"{len(mesh['segments'])} {_count(markers)}", first, mesh["segments"] + first, markers)
    holes, regions = mesh.get("holes", np.zeros((0, 2))), mesh.get("regions", np.zeros((0, 4)))
    yield from _table(str(len(holes)), first, holes)
    if len(regions):
        yield from _table(str(len(regions)), first, regions)


def _table(header: str, first: int, *columns: npt.NDArray[Any] | None) -> Iterable[str]:
    yield header
    rows = [column.tolist() for column in columns if column is not None]
    for number, parts in enumerate(zip(*rows), first):
        yield " ".join([str(number), *(_text(value) for part in parts for value in part)])


def _text(value: float) -> str:
    return str(value) if isinstance(value, int) else shortest(value)


def _count(markers: npt.NDArray[Any] | None) -> int:
    return 0 if markers is None else 1


@contextlib.contextmanager
def _named(path: pathlib.Path) -> Iterator[None]:
    try:
        yield
    except ValueError as error:
        raise DomainError(f"{path}: {error}") from None


def _header(lines: Lines, what: str, missing: list[int]) -> list[int]:
    """The count and what follows it, of which the end may be missing."""
    counts = lines.header(what)
    return [*counts, *missing[len(counts) - 1:]][:1 + len(missing)]


def _read_points(lines: Lines, found: Arrays) -> npt.NDArray[np.float64]:
    """The numbers of the points."""
    count, _, attributes, markers = _header(lines, "points", [2, 0, 0])
    table = lines.table("points", count, 3 + attributes + (markers > 0))
    found["vertices"] = table[:, 1:3]
    if attributes:
        found["vertex_attributes"] = table[:, 3:3 + attributes]
    if markers:
        found["vertex_markers"] = table[:, -1]
    numbers: npt.NDArray[np.float64] = table[:, 0]
    return numbers


def _read_graph(lines: Lines, numbers: npt.NDArray[np.float64], found: Arrays) -> None:
    segments = segment_table(lines)
    found["segments"] = indices(numbers, segments[:, 1:3])
    if segments.shape[1] > 3:
        found["segment_markers"] = segments[:, 3]
    found["holes"] = lines.table("holes", lines.header("holes")[0], 3)[:, 1:]
    found["regions"] = np.array(region_rows(lines)).reshape(-1, 4)


def _read_triangles(lines: Lines, numbers: npt.NDArray[np.float64], found: Arrays) -> None:
    count, nodes, attributes = _header(lines, "triangles", [3, 0])
    table = lines.table("triangles", count, 1 + nodes + attributes)
    found["triangles"] = indices(numbers, table[:, 1:1 + nodes], "triangle")
    if attributes:
        found["triangle_attributes"] = table[:, 1 + nodes:]
