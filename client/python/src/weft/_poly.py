# SPDX-License-Identifier: Apache-2.0
"""A domain from Triangle's .poly file (https://www.cs.cmu.edu/~quake/triangle.poly.html)."""

from __future__ import annotations

import itertools
import pathlib
import re
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from ._names import FileNames
from .errors import DomainError

_NAME = re.compile(r"# (marker|region)=(-?[0-9]+):(.*)")  # see client/formats/triangle/triangle_names.h


class _Lines:
    """The lines of a file that say something, one after the other."""

    def __init__(self, path: pathlib.Path) -> None:
        # Comments may be in any encoding; a name that is not UTF-8 is left out.
        text = path.read_text("utf-8", "surrogateescape")
        lines = text.split("\n")
        stripped = (line.partition("#")[0].strip() for line in lines)
        self._lines = [line for line in stripped if line]
        self._at = 0
        named = (_NAME.fullmatch(line) for line in lines)
        self.names = [(found[1], int(found[2]), found[3]) for found in named if found]

    def header(self, what: str, least: int) -> list[int]:
        if self._at >= len(self._lines):
            raise DomainError(f"it ends where the number of {what} should be")
        numbers = self.table(what, 1, least)[0]
        return [int(number) for number in numbers] + [0] * 4

    def table(self, what: str, rows: int, least: int) -> npt.NDArray[np.float64]:
        """(rows, at least `least`)."""
        lines = self._lines[self._at:self._at + rows]
        self._at += rows
        if len(lines) < rows:
            raise DomainError(f"it ends after {len(lines)} of {rows} {what}")
        if rows == 0:
            return np.zeros((0, least))
        try:
            table = np.loadtxt(lines, ndmin=2)
        except ValueError as error:
            raise DomainError(f"{what}: {error}") from None
        if table.shape[1] < least:
            raise DomainError(f"{what}: {table.shape[1]} numbers a line, expected {least}")
        return table

    def rows(self, what: str, count: int, least: int) -> list[list[float]]:
        """As `table`, of rows that may differ in length."""
        rows = [self.table(what, 1, least)[0] for _ in range(count)]
        for row in rows:
            if not np.isfinite(row).all():
                raise DomainError(f"{what}: a number is not finite")
        return [row.tolist() for row in rows]

    def ended(self) -> bool:
        return self._at >= len(self._lines)


def _numbered(table: npt.NDArray[np.float64], what: str) -> int:
    """The first number of rows that are numbered in order."""
    first = int(table[0, 0]) if len(table) else 0
    if not np.array_equal(table[:, 0], np.arange(first, first + len(table))) or first not in (0, 1):
        raise DomainError(f"the {what} are not numbered in order from 0 or 1")
    return first


def region_ids(attributes: Iterable[float]) -> dict[float, int]:
    """An id for each attribute, which may be any real number.

    An integer of 32 bits is its own id. The other values, in ascending order, get the smallest
    positive ids that no integer among the attributes has.
    """
    values = sorted(set(attributes))
    own = {value: int(value) for value in values if value.is_integer() and -2**31 <= value < 2**31}
    taken = set(own.values())
    free = (number for number in itertools.count(1) if number not in taken)
    return {value: own[value] if value in own else next(free) for value in values}


def read(path: pathlib.Path, region: Callable[..., Any]) -> dict[str, Any]:
    """The arguments of Domain; `region` makes a Region of x, y, id and max_area."""
    lines = _Lines(path)
    count = lines.header("points", 1)[0]
    if count:
        vertices = lines.table("points", count, 3)
    else:
        beside = _Lines(path.with_suffix(".node"))
        vertices = beside.table("points", beside.header("points", 1)[0], 3)
    first = _numbered(vertices, "points")
    count, marked, *_ = lines.header("segments", 1)
    segments = lines.table("segments", count, 4 if marked else 3)
    holes = lines.table("holes", lines.header("holes", 1)[0], 3)
    count = 0 if lines.ended() else lines.header("regions", 1)[0]
    rows = lines.rows("regions", count, 4)
    ids = region_ids(row[3] for row in rows)
    # A lone value is both the attribute and the maximum area, as Triangle documents it.
    regions = [region(row[1], row[2], ids[row[3]], area if (area := row[3:5][-1]) > 0 else None)
               for row in rows]
    region_values = {number: value for value, number in ids.items() if number != value}
    names = {kind: FileNames(kind, str(path)) for kind in ("marker", "region")}
    for number, value in region_values.items():
        names["region"].add(number, _shortest(value))
    for kind, number, name in lines.names:
        if -2**31 <= number < 2**31:
            names[kind].add(number, name)
    return {
        "points": vertices[:, 1:3],
        "segments": segments[:, 1:3] - first,
        "markers": segments[:, 3] if marked else np.zeros(0, np.int32),
        "holes": holes[:, 1:3],
        "regions": regions,
        "region_values": region_values,
        "marker_names": names["marker"].table,
        "region_names": names["region"].table,
        "fill": "seeds",
    }


def _shortest(value: float) -> str:
    """As the command line writes it: in the shorter notation."""
    fixed = np.format_float_positional(value, trim="-")
    scientific = np.format_float_scientific(value, trim="-", exp_digits=2)
    return fixed if len(fixed) <= len(scientific) else scientific
