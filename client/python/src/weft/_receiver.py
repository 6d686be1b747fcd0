# SPDX-License-Identifier: Apache-2.0
"""Takes the messages of a stream and holds them to the rules of weft.v1: their order, the shapes
and indices of the chunks, the digests. Knows no gRPC; what feeds it may resume a stream that broke.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _protocol, _wire, results
from ._projection import Projection
from ._warning import warn
from ._wire import Chunk
from .errors import DamagedStream
from ._mesh import Mesh

_Accepted = _protocol.message("weft.v1.Accepted")
_Progress = _protocol.message("weft.v1.Progress")
_Summary = _protocol.message("weft.v1.Summary")


def _damaged(what: str) -> DamagedStream:
    return DamagedStream(f"the stream is damaged: {what}")


def _names_of(domain: Any) -> tuple[dict[int, str], dict[int, str]]:
    """Of markers and of regions, as a weft.v1.Domain has them."""
    return ({entry.id: entry.name for entry in domain.marker_names},
            {entry.id: entry.name for entry in domain.region_names})


def _digest(chunk: Chunk) -> bytes:
    """The layout of Chunk.sha256."""
    edges = np.column_stack([chunk.edges, chunk.edge_segments, chunk.edge_markers])
    sha256 = hashlib.sha256()
    for array in (chunk.points, chunk.triangles, chunk.regions, edges, chunk.input_points, chunk.edge_bulges):
        sha256.update(np.ascontiguousarray(array).data)
    return sha256.digest()


def warn_of(summary: results.Summary, sampled: bool) -> None:
    """`sampled`: the size's raster was sampled from a function, of which the sampling has warned."""
    if (outside := summary.outside) is not None:
        warn(f"segments[{outside.first}] lies outside of what is meshed" if outside.segments == 1 else
             f"{outside.segments} segments lie outside of what is meshed, the first is segments[{outside.first}]")
    for warning in summary.size_warnings:
        if not (sampled and warning.kind == "coarse_raster"):
            warn(warning.message)


class MeshReceiver:
    """Receives one mesh, in one stream or in several that go on with each other.

    `points` and `segments` count those of the domain, if it is known. `projected`: the projection of a
    domain in longitude and latitude, by which the mesh is brought back. `names`: of the domain's markers and regions;
    None: those that the server has kept. `sampled`: the size's raster was sampled from a function, of
    which the sampling has warned already.
    """

    def __init__(self, points: int | None = None, segments: int | None = None,
                 projected: Projection | None = None,
                 names: tuple[Mapping[int, str], Mapping[int, str]] | None = None,
                 sampled: bool = False) -> None:
        self._limits = (points, segments)
        self._names = names
        self._projected = projected
        self._sampled = sampled
        self._awaits_accepted = True
        self._sha256 = hashlib.sha256()
        self._parts: list[Chunk] = []
        self.accepted: results.Accepted | None = None
        self.summary: results.Summary | None = None
        self.chunks = 0
        self.vertices = 0
        self.triangles = 0
        self.edges = 0

    def resume(self) -> None:
        """What follows is of a new stream, which begins with chunk number `chunks`."""
        self._awaits_accepted = True

    def receive(self, message: bytes) -> Chunk | results.Progress | None:
        """Takes the next message; gives back what it carries for the user.

        Raises DamagedStream.
        """
        if self.summary:
            raise _damaged("a message follows the summary")
        kind, data = _wire.split(message)
        if self._awaits_accepted != (kind == _wire.ACCEPTED):
            raise _damaged("its first message is not `accepted`" if self._awaits_accepted
                           else "`accepted` came twice")
        if kind == _wire.CHUNK:
            return self._receive_chunk(data)
        try:
            if kind == _wire.ACCEPTED:
                self._receive_accepted(results.accepted(_Accepted.FromString(bytes(data))))
            elif kind == _wire.PROGRESS:
                return results.progress(_Progress.FromString(bytes(data)))
            elif kind == _wire.SUMMARY:
                summary = _Summary.FromString(bytes(data))
                self._receive_summary(results.summary(summary))
                if self._names is None:
                    self._names = _names_of(summary.request.domain)
            else:
                raise _damaged("a message is of an unknown kind")
        except _protocol.DecodeError as error:
            raise _damaged(str(error)) from None
        return None

    def _receive_accepted(self, accepted: results.Accepted) -> None:
        # The mesh at hand is of the engine that began it: another one's may go on differently.
        if self.accepted and self.accepted.engine_version != accepted.engine_version:
            raise _damaged(f"it was resumed by engine {accepted.engine_version}, engine "
                           f"{self.accepted.engine_version} had begun it")
        self.accepted = accepted
        self._awaits_accepted = False

    def _receive_chunk(self, data: memoryview) -> Chunk:
        chunk = _wire.read_chunk(data)
        for what, came, expected in (("index", chunk.index, self.chunks),
                                     ("first vertex", chunk.first_vertex, self.vertices),
                                     ("first triangle", chunk.first_triangle, self.triangles)):
            if came != expected:
                raise _damaged(f"chunk {self.chunks} has the {what} {came}, expected {expected}")
        points, segments = self._limits
        vertices = self.vertices + len(chunk.points)
        for what, numbers, limit in (("vertex", chunk.triangles, vertices),
                                     ("vertex", chunk.edges, vertices),
                                     ("vertex", chunk.input_points[:, 0], vertices),
                                     ("input point", chunk.input_points[:, 1], points),
                                     ("segment", chunk.edge_segments, segments)):
            unsigned = numbers.view(np.uint32)
            largest = int(unsigned.max(initial=0))
            if largest >= (2**31 if limit is None else min(limit, 2**31)) and unsigned.size:
                raise _damaged(f"chunk {chunk.index} names {what} {largest} of {limit}")
        if not np.isfinite(chunk.points).all():
            raise _damaged(f"chunk {chunk.index} has a coordinate that is not finite")
        if not (np.abs(chunk.edge_bulges) <= 1).all():
            raise _damaged(f"chunk {chunk.index} has an edge that is no chord of an arc")
        if _digest(chunk) != chunk.sha256:
            raise _damaged(f"chunk {chunk.index} does not match its SHA-256")
        self._sha256.update(chunk.sha256)
        self._parts.append(chunk)
        self.chunks += 1
        self.vertices = vertices
        self.triangles += len(chunk.triangles)
        self.edges += len(chunk.edges)
        return chunk

    def _receive_summary(self, summary: results.Summary) -> None:
        for what in ("chunks", "vertices", "triangles", "edges"):
            came, announced = getattr(self, what), getattr(summary, what)
            if came != announced:
                raise _damaged(f"{came} {what} came, the summary says {announced}")
        if self._sha256.hexdigest() != summary.digest:
            raise _damaged("the mesh does not match the SHA-256 of the summary")
        self.summary = summary if self._projected is None else self._projected.brought_back(summary)
        warn_of(summary, self._sampled)

    def mesh(self) -> Mesh:
        """The mesh, once the summary is there; gives up the chunks."""
        if self.summary is None:
            raise _damaged("it ended without a summary")
        parts, self._parts = self._parts, []
        marker_names, region_names = self._names or ({}, {})

        def joined(name: str, shape: tuple[int, ...], dtype: type) -> Any:
            return np.concatenate([np.empty(shape, dtype), *(getattr(p, name) for p in parts)])

        bulges = (np.concatenate([p.edge_bulges if len(p.edge_bulges) else np.zeros(len(p.edges)) for p in parts])
                  if any(len(p.edge_bulges) for p in parts) else np.zeros(0))
        points = joined("points", (0, 2), np.float64)
        input_points = joined("input_points", (0, 2), np.int32)
        if self._projected is not None:
            points = self._projected.to_lonlat(points, input_points)
        return Mesh(
            points=points,
            triangles=joined("triangles", (0, 3), np.int32),
            regions=joined("regions", (0,), np.int32),
            edges=joined("edges", (0, 2), np.int32),
            edge_markers=joined("edge_markers", (0,), np.int32),
            edge_segments=joined("edge_segments", (0,), np.int32),
            edge_bulges=bulges,
            input_points=input_points,
            summary=self.summary,
            marker_names=marker_names,
            region_names=region_names)
