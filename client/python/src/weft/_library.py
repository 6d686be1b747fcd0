# SPDX-License-Identifier: Apache-2.0
"""The library libweft.so, by ctypes: a message of weft.v1 goes in, arrays and a message come out.

The functions and structures are those of include/weft/c.h. Other threads of Python go on meanwhile.
"""

from __future__ import annotations

import ctypes
import dataclasses
import functools
import os
import pathlib
import time
from collections.abc import Callable
from ctypes import POINTER, c_char_p, c_double, c_int, c_int32, c_size_t, c_uint64, c_void_p
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from . import _carried, _protocol, errors, results
from .errors import DomainError, MissingPackage

_T = TypeVar("_T")

_NAME = "libweft.so.0"
_STAGES = ("queued", "triangulate", "size", "refine", "emit")


class Progress(ctypes.Structure):
    """weft_progress."""

    _fields_ = [("stage", c_int32), ("triangles", c_uint64), ("expected_triangles", c_uint64),
                ("fraction", c_double)]


_OnProgress = ctypes.CFUNCTYPE(c_int, POINTER(Progress), c_void_p)


class Arrays(ctypes.Structure):
    """weft_arrays."""

    _fields_ = [("struct_size", c_size_t), ("vertex_count", c_size_t), ("triangle_count", c_size_t),
                ("edge_count", c_size_t), ("input_point_count", c_size_t), ("leaf_count", c_size_t),
                ("vertices", c_void_p), ("triangles", c_void_p), ("regions", c_void_p),
                ("edges", c_void_p), ("input_points", c_void_p), ("leaves", c_void_p),
                ("bulges", c_void_p)]


@dataclasses.dataclass(frozen=True, eq=False)
class Made:
    """A mesh: the arrays of weft.Mesh, and its summary."""

    points: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int32]
    regions: npt.NDArray[np.int32]
    edges: npt.NDArray[np.int32]
    edge_markers: npt.NDArray[np.int32]
    edge_segments: npt.NDArray[np.int32]
    edge_bulges: npt.NDArray[np.float64]
    input_points: npt.NDArray[np.int32]
    summary: results.Summary


@functools.cache
def _library() -> Any:
    carried = _carried.FOLDER / "lib" / _NAME
    try:
        library = ctypes.CDLL(str(carried) if carried.is_file() else _NAME)
    except OSError as error:
        raise MissingPackage(f"no library of weft: {error}; install libweft0, see docs/install.md, or "
                             "mesh with a server: weft.local() or weft.Client") from None
    library.weft_make_message.argtypes = [c_char_p, c_size_t, _OnProgress, c_void_p, POINTER(c_void_p)]
    library.weft_make_message.restype = c_void_p
    library.weft_mesh_arrays.argtypes = [c_void_p, POINTER(Arrays)]
    library.weft_mesh_arrays.restype = None
    library.weft_read_domain.argtypes = [c_char_p, c_void_p, POINTER(c_void_p)]
    library.weft_read_domain.restype = c_void_p
    library.weft_domain_warning.argtypes = [c_void_p, c_size_t, c_void_p]
    library.weft_domain_warning.restype = c_char_p
    library.weft_domain_is_geographic.argtypes = [c_void_p, POINTER(c_int)]
    library.weft_domain_region_values.argtypes = [c_void_p, POINTER(POINTER(c_int32)), POINTER(POINTER(c_double))]
    library.weft_domain_region_values.restype = c_size_t
    for name in ("error_message", "error_field"):
        getattr(library, f"weft_{name}").argtypes = [c_void_p]
        getattr(library, f"weft_{name}").restype = c_char_p
    for name in ("mesh_free", "error_free", "domain_free"):
        getattr(library, f"weft_{name}").argtypes = [c_void_p]
        getattr(library, f"weft_{name}").restype = None
    for name in ("mesh_summary", "error_status", "domain_message"):
        getattr(library, f"weft_{name}").argtypes = [c_void_p, POINTER(c_size_t)]
        getattr(library, f"weft_{name}").restype = c_void_p
    return library


def _bytes_of(function: Any, of: Any) -> bytes:
    """The message that a function gives."""
    size = c_size_t()
    at = function(of, ctypes.byref(size))
    return ctypes.string_at(at, size.value)


class _Watch:
    """Hears of the progress of a run. What it raises, Ctrl-C included, ends the run."""

    def __init__(self, on_progress: Callable[[results.Progress], object] | None) -> None:
        self._on_progress = on_progress
        self._start = time.monotonic()
        self.raised: BaseException | None = None

    def on_progress(self, progress: Any, user: Any) -> int:
        try:
            if self._on_progress is not None and self.raised is None:
                now = progress.contents
                self._on_progress(results.Progress(
                    _STAGES[now.stage], now.triangles, now.expected_triangles,
                    time.monotonic() - self._start, now.fraction))
        except BaseException as raised:
            self.raised = raised
        return self.raised is not None


def make(message: Any, on_progress: Callable[[results.Progress], object] | None) -> Made:
    """The mesh of a weft.v1.GenerateMeshRequest; raises as a Client does."""
    return _run(message, on_progress, _made)


def summarize(message: Any) -> Any:
    """The weft.v1.Summary of the mesh, as a message."""
    return _run(message, None, _summary)


def _run(message: Any, on_progress: Callable[[results.Progress], object] | None,
         take: Callable[[Any, Any], _T]) -> _T:
    library = _library()
    request = message.SerializeToString()
    watch = _Watch(on_progress)
    error = c_void_p()
    mesh = library.weft_make_message(request, len(request), _OnProgress(watch.on_progress), None, ctypes.byref(error))
    if mesh is None:
        try:
            if watch.raised is not None:
                raise watch.raised
            status = _protocol.message("google.rpc.Status").FromString(_bytes_of(library.weft_error_status, error))
            raise errors.of_status(status, "the library answers", message)
        finally:
            library.weft_error_free(error)
    try:
        if watch.raised is not None:  # by the last call, when the mesh was made already
            raise watch.raised
        return take(library, mesh)
    finally:
        library.weft_mesh_free(mesh)


def _copied(at: int | None, shape: tuple[int, ...], kind: Any) -> Any:
    """A copy of the array that lies there."""
    if at is None or 0 in shape:
        return np.zeros(shape, kind)
    scalar: Any = {np.float64: c_double, np.int32: c_int32}[kind]
    return np.ctypeslib.as_array(ctypes.cast(at, POINTER(scalar)), shape).copy()


def _summary(library: Any, mesh: Any) -> Any:
    return _protocol.message("weft.v1.Summary").FromString(_bytes_of(library.weft_mesh_summary, mesh))


def _made(library: Any, mesh: Any) -> Made:
    arrays = Arrays(struct_size=ctypes.sizeof(Arrays))
    library.weft_mesh_arrays(mesh, ctypes.byref(arrays))
    edges = _copied(arrays.edges, (arrays.edge_count, 4), np.int32)
    return Made(
        points=_copied(arrays.vertices, (arrays.vertex_count, 2), np.float64),
        triangles=_copied(arrays.triangles, (arrays.triangle_count, 3), np.int32),
        regions=_copied(arrays.regions, (arrays.triangle_count,), np.int32),
        edges=edges[:, :2].copy(), edge_segments=edges[:, 2].copy(), edge_markers=edges[:, 3].copy(),
        edge_bulges=_copied(arrays.bulges, (arrays.edge_count if arrays.bulges else 0,), np.float64),
        input_points=_copied(arrays.input_points, (arrays.input_point_count, 2), np.int32),
        summary=results.summary(_summary(library, mesh)))


@dataclasses.dataclass(frozen=True)
class ReadDomain:
    """What a file of a domain holds."""

    message: bytes
    """A weft.v1.Domain."""
    warnings: list[str]
    geographic: bool | None
    """Whether the file says that it is in longitude and latitude, or in a plane; None: neither."""
    region_values: dict[int, float]


def read_domain(path: pathlib.Path) -> ReadDomain:
    """Raises MissingPackage, DomainError, and OSError if the file cannot be opened."""
    library = _library()
    error = c_void_p()
    domain = library.weft_read_domain(os.fsencode(path), None, ctypes.byref(error))
    if domain is None:
        try:
            if library.weft_error_field(error) == b"path":
                open(path, "rb").close()  # an OSError says more to those who catch it
            raise DomainError(library.weft_error_message(error).decode(errors="replace"))
        finally:
            library.weft_error_free(error)
    try:
        return _read(library, domain)
    finally:
        library.weft_domain_free(domain)


def _read(library: Any, domain: Any) -> ReadDomain:
    warnings: list[str] = []
    while sentence := library.weft_domain_warning(domain, len(warnings), None):
        warnings.append(sentence.decode(errors="replace"))
    geographic = c_int()
    known = library.weft_domain_is_geographic(domain, ctypes.byref(geographic))
    ids, values = POINTER(c_int32)(), POINTER(c_double)()
    count = library.weft_domain_region_values(domain, ctypes.byref(ids), ctypes.byref(values))
    return ReadDomain(_bytes_of(library.weft_domain_message, domain), warnings,
                      bool(geographic.value) if known else None,
                      {ids[i]: values[i] for i in range(count)})
