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
from ._text import read_text, shortest, without_fortran
from ._warning import warn
from .errors import DomainError

_ARC = re.compile(r"# arc=(.*)")  # see files/formats/triangle/triangle_arcs.h
_NAME = re.compile(r"# (marker|region)=(-?[0-9]+):(.*)")  # see files/formats/triangle/triangle_names.h
_DOUBTFUL = re.compile(r"[0-9],[0-9]")


class Lines:
    """The lines of a file that say something, one after the other."""

    def __init__(self, path: pathlib.Path) -> None:
        self.file = str(path)
        # Comments may be in any encoding; a name that is not UTF-8 is left out.
        lines = read_text(path, "surrogateescape").split("\n")
        stripped = (self._blanks_alone(line.partition("#")[0]) for line in lines)
        self._lines = [without_fortran(line) for line in stripped if line]
        self._at = 0
        named = (_NAME.fullmatch(line.rstrip("\t")) for line in lines)
        self.arcs = [found[1].strip() for found in map(_ARC.match, lines) if found]
        self.names = [(found[1], int(found[2]), found[3]) for found in named if found]

    @staticmethod
    def _blanks_alone(line: str) -> str:
        """The line, whose fields commas may separate."""
        line = line.strip()
        if "," not in line:
            return line
        if _DOUBTFUL.search(line) and re.search(r"\s", line):
            raise DomainError(f"the commas of {line!r} may be decimal marks, or separate numbers: write decimal "
                              "points, or blanks alone between numbers")
        return line.replace(",", " ")

    def header(self, what: str) -> list[int]:
        """The counts of the line, of which all but the first may be missing."""
        if self._at >= len(self._lines):
            raise DomainError(f"it ends where the number of {what} should be")
        return [int(number) for number in self.rows(what, 1, 1)[0]]

    def table(self, what: str, rows: int, columns: int) -> npt.NDArray[np.float64]:
        """(rows, columns): what lines hold beyond these is ignored."""
        lines = self._next(what, rows)
        if rows == 0:
            return np.zeros((0, columns))
        try:
            return np.loadtxt(lines, ndmin=2, usecols=range(columns))
        except ValueError as error:
            raise DomainError(f"{what}: {error}") from None

    def rows(self, what: str, count: int, least: int) -> list[list[float]]:
        """Rows that may differ in length, of `least` numbers or more."""
        rows = []
        for line in self._next(what, count):
            try:
                row = [float(word) for word in line.split()]
            except ValueError as error:
                raise DomainError(f"{what}: {error}") from None
            if len(row) < least:
                raise DomainError(f"{what}: {len(row)} numbers a line, expected {least}")
            if not np.isfinite(row).all():
                raise DomainError(f"{what}: a number is not finite")
            rows.append(row)
        return rows

    def are_longer(self, rows: int, columns: int) -> bool:
        """Whether one of the next lines has more fields."""
        return any(len(line.split()) > columns for line in self._lines[self._at:self._at + rows])

    def _next(self, what: str, rows: int) -> list[str]:
        lines = self._lines[self._at:self._at + rows]
        self._at += rows
        if len(lines) < rows:
            raise DomainError(f"it ends after {len(lines)} of {rows} {what}")
        return lines

    def ended(self) -> bool:
        return self._at >= len(self._lines)


def indices(numbers: npt.NDArray[np.float64], named: npt.NDArray[np.float64],
            what: str = "segment") -> npt.NDArray[np.int64]:
    """The indices of the points that segments, or triangles, name, whatever their numbers."""
    order = np.argsort(numbers, kind="stable")
    ascending = numbers[order]
    if (ascending[1:] == ascending[:-1]).any() or not np.array_equal(numbers, np.rint(numbers)):
        raise DomainError("the points are not numbered, each by a whole number of its own")
    if not named.size:
        return np.zeros(named.shape, np.int64)
    if not len(numbers):
        raise DomainError(f"there are {what}s, but no points")
    found = np.minimum(np.searchsorted(ascending, named), len(ascending) - 1)
    missing = np.argwhere(ascending[found] != named)
    if len(missing):
        row, end = missing[0]
        raise DomainError(f"{what}s: {what} {row + 1} of the file names the point "
                          f"{shortest(named[row, end])}; the numbers are from "
                          f"{shortest(ascending[0])} to {shortest(ascending[-1])}")
    result: npt.NDArray[np.int64] = order[found]
    return result


def point_table(lines: Lines) -> npt.NDArray[np.float64]:
    """(n, 3): number and coordinates."""
    count, *more = lines.header("points")
    if more and more[0] != 2:
        raise DomainError(f"the dimension is {more[0]}, it must be 2")
    return lines.table("points", count, 3)


def segment_table(lines: Lines) -> npt.NDArray[np.float64]:
    """(k, 3) or (k, 4): number, points and, if the file has it, marker of each segment."""
    count, *marked = lines.header("segments")
    if marked:
        if not marked[0] and lines.are_longer(count, 3):
            warn(f"{lines.file}: what follows the points of segments is ignored, because their header says that "
                 "they have 0 markers")
        return lines.table("segments", count, 4 if marked[0] else 3)
    # A segment has the marker that its line ends in.
    return np.array([[*row, 0][:4] for row in lines.rows("segments", count, 3)]).reshape(-1, 4)


def region_rows(lines: Lines) -> list[list[float]]:
    """x, y, attribute and maximum area of each region; 0 or less is no maximum. A lone value is both, as
    Triangle documents it."""
    count = 0 if lines.ended() else lines.header("regions")[0]
    return [[*row[1:4], row[3:5][-1]] for row in lines.rows("regions", count, 4)]


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
    lines = Lines(path)
    vertices = point_table(lines)
    if not len(vertices):
        vertices = point_table(Lines(path.with_suffix(".node")))
    segments = segment_table(lines)
    holes = lines.table("holes", lines.header("holes")[0], 3)
    rows = region_rows(lines)
    ids = region_ids(attribute for _, _, attribute, _ in rows)
    regions = [region(x, y, ids[attribute], area if area > 0 else None) for x, y, attribute, area in rows]
    region_values = {number: value for value, number in ids.items() if number != value}
    names = {kind: FileNames(kind, str(path)) for kind in ("marker", "region")}
    for number, value in region_values.items():
        names["region"].add(number, _shortest(value))
    for kind, number, name in lines.names:
        if -2**31 <= number < 2**31:
            names[kind].add(number, name)
    return {
        "arcs": _arcs(lines.arcs, segments[:, 0]),
        "points": vertices[:, 1:3],
        "segments": indices(vertices[:, 0], segments[:, 1:3]),
        "markers": segments[:, 3] if segments.shape[1] > 3 else np.zeros(0, np.int32),
        "holes": holes[:, 1:3],
        "regions": regions,
        "region_values": region_values,
        "marker_names": names["marker"].table,
        "region_names": names["region"].table,
        "fill": "seeds",
    }


def _arcs(comments: list[str], numbers: npt.NDArray[np.float64]) -> dict[int, float]:
    """Bulges by the index of the segment."""
    arcs: dict[int, float] = {}
    index = {int(number): i for i, number in enumerate(numbers.tolist())} if comments else {}
    for comment in comments:
        number, _, bulge = comment.partition(":")
        try:
            segment, value = index[int(number)], float(bulge)
        except (KeyError, ValueError):
            raise DomainError(f"the comment '# arc={comment}' is not the number of a segment, a colon, and the "
                              "bulge of its arc") from None
        if segment in arcs:
            raise DomainError(f"the segment {number} has two comments '# arc='")
        arcs[segment] = value
    return arcs


def _shortest(value: float) -> str:
    """As the command line writes it: in the shorter notation."""
    fixed = np.format_float_positional(value, trim="-")
    scientific = np.format_float_scientific(value, trim="-", exp_digits=2)
    return fixed if len(fixed) <= len(scientific) else scientific
