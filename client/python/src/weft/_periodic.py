# SPDX-License-Identifier: Apache-2.0
"""The vertices of sides that repeat each other; see Mesh.periodic."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._mesh import Mesh

Ints = npt.NDArray[np.int32]
Numbers = npt.NDArray[np.int64]
Complexes = npt.NDArray[np.complex128]

_TOLERANCE = 1e-9  # of the extent of the mesh


@dataclasses.dataclass(frozen=True, eq=False)
class _Side:
    """The edges with a marker."""

    name: str
    vertices: Numbers
    """(n,): line by line from the end that is lower left, the first line from the lowest left end."""
    at: Complexes
    """(n,): where they are."""
    lines: int
    inside: int
    """1 if triangles are on the left of the first edge alone, -1: on the right, 0: on both or none."""


@dataclasses.dataclass(frozen=True)
class _Motion:
    turn: complex
    shift: complex

    def __call__(self, points: Complexes) -> Complexes:
        return self.turn * points + self.shift


def pairs(mesh: Mesh, a: str | int, b: str | int) -> Ints:
    low, high = mesh._bounds()
    tolerance = _TOLERANCE * float((high - low).max())
    first, second = (_side(mesh, marker, tolerance) for marker in (a, b))
    faults = []
    for motion in _motions(first, second, tolerance):
        image, fault = _images(first, second, motion, tolerance)
        if not fault:
            return np.column_stack([first.vertices, second.vertices[image]]).astype(np.int32)
        faults.append(fault)
    raise ValueError(faults[0])


def _side(mesh: Mesh, marker: str | int, tolerance: float) -> _Side:
    name = f"the side {marker!r}"
    edges = mesh.boundaries[marker].astype(np.int64)
    if not len(edges):
        raise KeyError(f"no edge has the marker {marker!r}")
    points = np.ascontiguousarray(mesh.points).view(np.complex128)[:, 0]
    # Each edge in both directions: it is followed by the other one that leaves its head.
    steps = np.concatenate([edges, edges[:, ::-1]])
    twin = np.roll(np.arange(len(steps)), len(edges))
    leaving = np.argsort(steps[:, 0], kind="stable")
    vertices, start, count = np.unique(steps[leaving, 0], return_index=True, return_counts=True)
    if count.max() > 2:
        knot = int(vertices[count.argmax()])
        raise ValueError(f"{name} is no line: {count.max()} of its edges meet at vertex {_shown(knot, points[knot])}")
    head = np.searchsorted(vertices, steps[:, 1])
    one, other = leaving[start[head]], leaving[start[head] + count[head] - 1]
    is_last = count[head] == 1
    follower = np.where(is_last, np.arange(len(steps)), np.where(one == twin, other, one))
    to_go = (~is_last).astype(np.int64)
    for _ in range(len(steps).bit_length()):  # each round takes as many steps as all before it
        to_go = to_go + to_go[follower]
        follower = follower[follower]
    if not is_last[follower].all():
        raise ValueError(f"{name} is no line: edges of it are a closed one, which has no end")
    rank = np.empty(len(vertices), np.int64)
    rank[_order(points[vertices], tolerance)] = np.arange(len(vertices))
    to_end, to_start = rank[head[follower]], rank[head[follower[twin]]]
    chosen = np.flatnonzero(to_start < to_end)
    chosen = chosen[np.lexsort((-to_go[chosen], to_start[chosen]))]
    walk = steps[chosen].ravel()
    walk = walk[np.append(True, walk[1:] != walk[:-1])]
    return _Side(name, walk, points[walk], int(is_last.sum()) // 2, _inside(mesh, walk[0], walk[1]))


def _inside(mesh: Mesh, tail: Any, head: Any) -> int:
    """What _Side.inside says of an edge."""
    near = mesh.triangles[((mesh.triangles == tail) | (mesh.triangles == head)).sum(axis=1) == 2]
    follows = (near == tail) & (np.roll(near, -1, axis=1) == head)
    left = int(follows.any(axis=1).sum())
    return left - (len(near) - left)


def _motions(first: _Side, second: _Side, tolerance: float) -> list[_Motion]:
    """Those that may take one side to the other, the likeliest first."""
    if first.lines > 1 or second.lines > 1:
        corners = [complex(side.at.real.min(), side.at.imag.min()) for side in (first, second)]
        return [_Motion(1, corners[1] - corners[0])]
    start, end = first.at[[0, -1]]
    lengths = [float(abs(side.at[-1] - side.at[0])) for side in (first, second)]
    if abs(lengths[0] - lengths[1]) > tolerance:
        raise ValueError(f"{first.name} is {lengths[0]:.17g} from end to end, {second.name} {lengths[1]:.17g}: no "
                         "translation or rotation takes one to the other")
    found = []
    for along in (True, False):
        to_start, to_end = second.at[[0, -1] if along else [-1, 0]]
        turn = (to_end - to_start) / (end - start)
        is_translation = abs(turn - 1) * lengths[0] <= tolerance
        turn = 1 if is_translation else turn / abs(turn)
        turns_inside_out = first.inside * second.inside * (1 if along else -1) < 0
        found.append((not turns_inside_out, not is_translation,
                      _Motion(turn, (to_start + to_end) / 2 - turn * (start + end) / 2)))
    return [motion for *_, motion in sorted(found, key=lambda each: each[:2])]


def _images(first: _Side, second: _Side, motion: _Motion, tolerance: float) -> tuple[Numbers, str]:
    """For each vertex of the first side the place of its image in the second one's list, and what is wrong."""
    both = np.concatenate([motion(first.at), second.at])
    order = _order(both, tolerance)
    of_first = order < len(first.at)
    matched = np.flatnonzero((abs(np.diff(both[order])) <= tolerance) & (of_first[1:] != of_first[:-1]))
    low, high = np.sort([order[matched], order[matched + 1]], axis=0)
    image = np.full(len(first.at), -1)
    image[low] = high - len(first.at)
    alone = np.ones(len(second.at), bool)
    alone[image[image >= 0]] = False
    for side, other, lonely in ((first, second, image < 0), (second, first, alone)):
        if lonely.any():
            at = int(lonely.argmax())
            return image, (f"vertex {_shown(side.vertices[at], side.at[at])} of {side.name} has no image on "
                           f"{other.name}")
    return image, ""


def _order(points: Complexes, tolerance: float) -> Numbers:
    """By x and then y, where those whose x differ by rounding alone have the same x."""
    by_x = np.argsort(points.real, kind="stable")
    column = np.empty(len(points), np.int64)
    column[by_x] = np.append(0, np.cumsum(np.diff(points.real[by_x]) > tolerance))
    order: Numbers = np.lexsort((points.imag, column))
    return order


def _shown(vertex: int, point: complex) -> str:
    return f"{vertex} at ({point.real:.6g}, {point.imag:.6g})"
