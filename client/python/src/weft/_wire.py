# SPDX-License-Identifier: Apache-2.0
"""Reads what a mesh is made of from its bytes, without protobuf.

protobuf hands out repeated numbers one Python object at a time. In weft.v1 the arrays of a chunk
are packed and of fixed width, so that numpy takes each as it lies in the message: no copy.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from ._short import ShortRepr
from .errors import DamagedStream

_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5
ACCEPTED, PROGRESS, CHUNK, SUMMARY = 1, 2, 3, 4
"""Field numbers in GenerateMeshResponse and FetchMeshResponse."""

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Chunk(ShortRepr):
    """A piece of a mesh, in the order in which the server sends it.

    Vertices and triangles are numbered from 0 across the mesh. A chunk refers only to vertices of
    itself and of earlier chunks. The arrays are read-only views of the message.
    """

    index: int
    """From 0, without gaps."""
    first_vertex: int
    """Number of this chunk's first vertex."""
    first_triangle: int
    """Number of this chunk's first triangle."""
    points: Floats
    """(n, 2) float64: the vertices from `first_vertex`, in the unit of the domain."""
    triangles: Ints
    """(m, 3) int32: vertex numbers, counter-clockwise."""
    regions: Ints
    """(m,) int32: region id per triangle, 0 if there is none."""
    edges: Ints
    """(k, 2) int32: vertex numbers of the edges that lie on input segments."""
    edge_markers: Ints
    """(k,) int32: marker per edge."""
    edge_segments: Ints
    """(k,) int32: index of the input segment per edge; the lowest if several overlap."""
    edge_bulges: Floats
    """(k,) float64: bulge of the arc that an edge is a chord of; empty if all are straight."""
    input_points: Ints
    """(p, 2) int32: vertex number and index of the input point."""
    box: Floats
    """(4,) float64: min x, min y, max x, max y of the triangles; empty if there are none."""
    sha256: bytes
    """The digest that came with it; it was verified."""


def _varint(data: memoryview, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at += 1
        if byte < 0x80:
            return value, at
        shift += 7
        if shift > 63:
            raise ValueError("a varint is too long")


def _fields(data: memoryview) -> Iterator[tuple[int, int | memoryview]]:
    """Numbers and values of the fields of a message: integers, or the bytes of what has a length."""
    at = 0
    while at < len(data):
        tag, at = _varint(data, at)
        kind = tag & 7
        if kind == _VARINT:
            value, at = _varint(data, at)
            yield tag >> 3, value
        elif kind in (_BYTES, _FIXED32, _FIXED64):
            size, at = _varint(data, at) if kind == _BYTES else (8 if kind == _FIXED64 else 4, at)
            if at + size > len(data):
                raise ValueError("a field is longer than its message")
            yield tag >> 3, data[at:at + size]
            at += size
        else:
            raise ValueError(f"wire type {kind}")


def split(message: bytes) -> tuple[int, memoryview]:
    """The one field of a message of the stream, by its number, and its bytes."""
    try:
        found = list(_fields(memoryview(message)))
    except (ValueError, IndexError) as error:
        raise DamagedStream(f"the stream is damaged: {error}") from None
    if len(found) != 1 or not isinstance(found[0][1], memoryview):
        raise DamagedStream("the stream is damaged: a message is empty or of an unknown kind")
    return found[0][0], found[0][1]


_INTEGERS = {1: "index", 2: "first_vertex", 3: "first_triangle"}
_ARRAYS = {4: ("coordinates", "<f8"), 5: ("triangles", "<i4"), 6: ("regions", "<i4"),
           7: ("edges", "<i4"), 8: ("edge_markers", "<i4"), 9: ("edge_segments", "<i4"),
           10: ("input_points", "<i4"), 11: ("box", "<f8"), 13: ("edge_bulges", "<f8")}
_SHA256 = 12


def read_chunk(data: memoryview) -> Chunk:
    """A weft.v1.Chunk. Its shapes are sound, its numbers are not looked at.

    Vertex numbers above 2**31 - 1 show as negative.
    """
    integers = dict.fromkeys(_INTEGERS.values(), 0)
    parts: dict[str, list[memoryview]] = {name: [] for name, _ in _ARRAYS.values()}
    sha256 = b""
    arrays = {}
    try:
        for number, value in _fields(data):
            if isinstance(value, int):
                if number in _INTEGERS:
                    integers[_INTEGERS[number]] = value
            elif number in _ARRAYS:
                parts[_ARRAYS[number][0]].append(value)
            elif number == _SHA256:
                sha256 = bytes(value)
        for name, dtype in _ARRAYS.values():
            # One part, unless someone between us and the server has split it.
            pieces = [np.frombuffer(part, dtype) for part in parts[name]]
            arrays[name] = pieces[0] if len(pieces) == 1 else np.concatenate([*pieces, np.empty(0, dtype)])
        count = arrays["triangles"].size // 3
        edges = arrays["edges"].size // 2
        chunk = Chunk(
            **integers,
            points=arrays["coordinates"].reshape(-1, 2),
            triangles=arrays["triangles"].reshape(-1, 3),
            regions=arrays["regions"] if arrays["regions"].size else np.zeros(count, np.int32),
            edges=arrays["edges"].reshape(-1, 2),
            edge_markers=(arrays["edge_markers"] if arrays["edge_markers"].size
                          else np.zeros(edges, np.int32)),
            edge_segments=arrays["edge_segments"],
            edge_bulges=arrays["edge_bulges"],
            input_points=arrays["input_points"].reshape(-1, 2),
            box=arrays["box"],
            sha256=sha256)
        if (len(chunk.regions), len(chunk.edge_markers), len(chunk.edge_segments)) != (count, edges, edges) \
                or len(chunk.edge_bulges) not in (0, edges) or len(chunk.box) not in (0, 4):
            raise ValueError("has arrays whose lengths do not fit")
    except (ValueError, IndexError) as error:
        raise DamagedStream(f"the stream is damaged: chunk {integers['index']}: {error}") from None
    return chunk
