# SPDX-License-Identifier: Apache-2.0
"""The library libweft.so, by ctypes: a request, as a message of weft.v1, becomes arrays in this process.

The structures are those of include/weft/c.h, in its order. Other threads of Python go on meanwhile.
"""

from __future__ import annotations

import ctypes
import dataclasses
import functools
import time
from collections.abc import Callable
from ctypes import POINTER, c_char_p, c_double, c_float, c_int, c_int32, c_size_t, c_uint8, c_uint32, c_uint64, c_void_p
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _carried, errors, results
from .errors import MissingPackage

_NAME = "libweft.so.0"
_NO_AREA = 0xFFFFFFFF
_EDGE = 2  # of weft.v1.Measure
_SIZES = {None: 0, "constant": 1, "expression": 2, "raster": 3}
_FIELDS = {"distance": 0, "raster": 1, "mesh": 2, "width": 3}
_STAGES = ("queued", "triangulate", "size", "refine", "emit")
_MOST_LEAVES = 65536  # whose boxes are given, as by a server


class Bound(ctypes.Structure):
    _fields_ = [("has_max_area", c_int32), ("has_max_edge", c_int32), ("max_area", c_double),
                ("max_edge", c_double)]


class Region(ctypes.Structure):
    _fields_ = [("x", c_double), ("y", c_double), ("id", c_int32), ("bound", Bound)]


class Area(ctypes.Structure):
    _fields_ = [("has_region", c_int32), ("region", c_int32), ("priority", c_int32),
                ("is_hole", c_int32), ("bound", Bound)]


class SizeAt(ctypes.Structure):
    _fields_ = [("marker", c_int32), ("max_edge", c_double)]


class Grid(ctypes.Structure):
    _fields_ = [("x", c_double), ("y", c_double), ("dx", c_double), ("dy", c_double),
                ("columns", c_uint32), ("rows", c_uint32)]


class Field(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("kind", c_int32),
                ("markers", c_void_p), ("marker_count", c_size_t),
                ("points", c_void_p), ("point_count", c_size_t),
                ("segments", c_void_p), ("segment_count", c_size_t),
                ("triangles", c_void_p), ("triangle_count", c_size_t),
                ("point_values", c_void_p), ("grid", Grid), ("grid_values", c_void_p)]


class Request(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t),
                ("points", c_void_p), ("point_count", c_size_t),
                ("segments", c_void_p), ("segment_count", c_size_t),
                ("segment_markers", c_void_p), ("segment_areas", c_void_p),
                ("holes", c_void_p), ("hole_count", c_size_t),
                ("regions", c_void_p), ("region_count", c_size_t),
                ("areas", c_void_p), ("area_count", c_size_t),
                ("fill", c_int32), ("snap", c_double),
                ("size_kind", c_int32), ("size_measure", c_int32), ("size_constant", c_double),
                ("size_expression", c_char_p), ("size_grid", Grid), ("size_values", c_void_p),
                ("fields", c_void_p), ("field_count", c_size_t),
                ("gradation", c_double), ("gradation_within", c_int32), ("cells_across", c_double),
                ("sizes_at", c_void_p), ("size_at_count", c_size_t),
                ("min_angle_deg", c_double), ("min_edge", c_double), ("placement", c_int32),
                ("sweeps", c_int32), ("allow_unrefined", c_int32), ("simplify", c_double)]


class Told(ctypes.Structure):
    """weft_progress."""

    _fields_ = [("stage", c_int32), ("triangles", c_uint64), ("expected_triangles", c_uint64),
                ("fraction", c_double)]


_OnProgress = ctypes.CFUNCTYPE(c_int, POINTER(Told), c_void_p)


class Control(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("threads", c_uint32), ("max_triangles", c_uint64),
                ("max_bytes", c_uint64), ("max_seconds", c_double), ("on_progress", _OnProgress),
                ("user", c_void_p)]


class Arrays(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("vertex_count", c_size_t), ("triangle_count", c_size_t),
                ("edge_count", c_size_t), ("input_point_count", c_size_t), ("leaf_count", c_size_t),
                ("vertices", c_void_p), ("triangles", c_void_p), ("regions", c_void_p),
                ("edges", c_void_p), ("input_points", c_void_p), ("leaves", c_void_p)]


class Summary(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("digest", c_uint8 * 32),
                *((name, c_uint32) for name in ("chunks", "rounds", "threads")),
                *((name, c_int32) for name in ("streamed", "has_narrow", "overlap_united")),
                *((name, c_double) for name in (
                    "area", "min_angle_deg", "max_angle_deg", "min_angle_p1_deg", "mean_quality",
                    "ideal_ratio", "lattice_share")),
                ("angle_histogram", c_uint64 * 18), ("aspect_histogram", c_uint64 * 9),
                ("size_histogram", c_uint64 * 10),
                *((name, c_uint64) for name in (
                    "small_input_angle", "edge_floor", "budget", "precision", "streaming",
                    "too_large")),
                *((name, c_double) for name in (
                    "unrefined_x", "unrefined_y", "merge_tolerance", "farthest", "farthest_x",
                    "farthest_y", "vanished_x", "vanished_y")),
                *((name, c_uint64) for name in (
                    "merged_points", "merged_segments", "vanished_faces", "overlap_areas")),
                ("overlap_area", c_double),
                ("narrow_segment", c_uint32), ("narrow_other", c_uint32),
                *((name, c_double) for name in (
                    "narrow_x", "narrow_y", "narrow_width", "narrow_triangles",
                    "triangulate_seconds", "size_seconds", "coarse_seconds", "refine_seconds",
                    "emit_seconds", "engine_seconds")),
                *((name, c_uint64) for name in (
                    "peak_bytes", "insertions", "deferred", "exact_predicates")),
                ("warning_count", c_size_t), ("has_simplification", c_int32),
                *((name, c_uint64) for name in (
                    "simplified_points", "dropped_islands", "dropped_waters", "cut_channels")),
                ("simplified_area", c_double), ("simplified_farthest", c_double),
                *((name, c_uint64) for name in ("cut_off_waters", "straits", "outside_segments")),
                ("outside_x", c_double), ("outside_y", c_double), ("outside_first", c_uint32),
                ("narrow_in_all", c_double), ("narrow_widest", c_double)]


@dataclasses.dataclass(frozen=True, eq=False)
class Made:
    """A mesh: the arrays of weft.Mesh, and its summary."""

    points: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int32]
    regions: npt.NDArray[np.int32]
    edges: npt.NDArray[np.int32]
    edge_markers: npt.NDArray[np.int32]
    edge_segments: npt.NDArray[np.int32]
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
    library.weft_make.argtypes = [POINTER(Request), POINTER(Control), POINTER(c_void_p)]
    library.weft_make.restype = c_void_p
    for name in ("mesh_free", "error_free"):
        getattr(library, f"weft_{name}").argtypes = [c_void_p]
        getattr(library, f"weft_{name}").restype = None
    for name in ("error_reason", "error_message", "error_field"):
        getattr(library, f"weft_{name}").argtypes = [c_void_p]
        getattr(library, f"weft_{name}").restype = c_char_p
    for name, kind in (("mesh_arrays", Arrays), ("mesh_summary", Summary)):
        getattr(library, f"weft_{name}").argtypes = [c_void_p, POINTER(kind)]
        getattr(library, f"weft_{name}").restype = None
    for name in ("warning_kind", "warning_field", "warning_message"):
        getattr(library, f"weft_{name}").argtypes = [c_void_p, c_size_t]
        getattr(library, f"weft_{name}").restype = c_char_p
    library.weft_engine_version.restype = c_char_p
    return library


class _Writer:
    """Structures of messages, and the arrays that they point to, which live as long as this."""

    def __init__(self) -> None:
        self._kept: list[Any] = []

    def array(self, numbers: Any, kind: Any) -> int | None:
        """Where the numbers lie; None if there are none."""
        array = np.array(numbers, kind)
        self._kept.append(array)
        return array.ctypes.data if array.size else None

    def structures(self, kind: Any, items: list[Any]) -> int | None:
        array = (kind * len(items))(*items)
        self._kept.append(array)
        return ctypes.addressof(array) if items else None

    def request(self, message: Any) -> Request:
        """A weft.v1.GenerateMeshRequest."""
        domain, size, quality = message.domain, message.size, message.quality
        areas = np.array(domain.segment_areas, np.uint32)
        request = Request(
            struct_size=ctypes.sizeof(Request),
            points=self.array(domain.points, np.float64), point_count=len(domain.points) // 2,
            segments=self.array(domain.segments, np.uint32),
            segment_count=len(domain.segments) // 2,
            segment_markers=self.array(domain.segment_markers, np.int32),
            segment_areas=self.array(np.where(areas == 0, _NO_AREA, areas - 1), np.uint32),
            holes=self.array(domain.holes, np.float64), hole_count=len(domain.holes) // 2,
            regions=self.structures(Region, [Region(r.x, r.y, r.id, _bound(r))
                                             for r in domain.regions]),
            region_count=len(domain.regions),
            areas=self.structures(Area, [Area(a.HasField("region"), a.region, a.priority, a.hole,
                                              _bound(a)) for a in domain.areas]),
            area_count=len(domain.areas),
            fill=max(domain.fill - 1, 0), snap=domain.snap,
            size_kind=_SIZES[size.WhichOneof("field")], size_measure=size.measure == _EDGE,
            size_constant=size.constant,
            fields=self.structures(Field, [self._field(field) for field in size.fields]),
            field_count=len(size.fields),
            gradation=size.gradation, gradation_within=size.gradation_within,
            cells_across=size.cells_across,
            sizes_at=self.structures(SizeAt, [SizeAt(at.marker, at.max_edge) for at in size.at]),
            size_at_count=len(size.at),
            min_angle_deg=quality.min_angle_deg, min_edge=quality.min_edge,
            placement=max(quality.placement - 1, 0),
            sweeps=min(quality.optimise, 2**31 - 1) if quality.HasField("optimise") else -1,
            allow_unrefined=message.allow_unrefined, simplify=message.simplify)
        if request.size_kind == _SIZES["expression"]:
            request.size_expression = size.expression.encode()
        elif request.size_kind == _SIZES["raster"]:
            request.size_grid = _grid(size.raster)
            request.size_values = self.array(size.raster.values, np.float64)
        return request

    def _field(self, message: Any) -> Field:
        kind = message.WhichOneof("kind")
        field = Field(name=message.name.encode(), kind=_FIELDS[kind])
        if kind == "distance":
            distance = message.distance
            field.markers = self.array(distance.markers, np.int32)
            field.marker_count = len(distance.markers)
            field.points = self.array(distance.points, np.float64)
            field.point_count = len(distance.points) // 2
            field.segments = self.array(distance.segments, np.uint32)
            field.segment_count = len(distance.segments) // 2
        elif kind == "raster":
            field.grid = _grid(message.raster)
            field.grid_values = self.array(message.raster.values, np.float32)
        elif kind == "mesh":
            mesh = message.mesh
            field.points = self.array(mesh.vertices, np.float64)
            field.point_count = len(mesh.vertices) // 2
            field.triangles = self.array(mesh.triangles, np.uint32)
            field.triangle_count = len(mesh.triangles) // 3
            field.point_values = self.array(mesh.values, np.float64)
        return field


def _bound(message: Any) -> Bound:
    return Bound(message.HasField("max_area"), message.HasField("max_edge"), message.max_area,
                 message.max_edge)


def _grid(message: Any) -> Grid:
    return Grid(message.x, message.y, message.dx, message.dy, message.columns, message.rows)


class _Watch:
    """Hears of the progress of a run. What it raises, Ctrl-C included, ends the run."""

    def __init__(self, on_progress: Callable[[results.Progress], object] | None) -> None:
        self._on_progress = on_progress
        self._start = time.monotonic()
        self.raised: BaseException | None = None

    def hear(self, told: Any, user: Any) -> int:
        try:
            if self._on_progress is not None and self.raised is None:
                now = told.contents
                self._on_progress(results.Progress(
                    _STAGES[now.stage], now.triangles, now.expected_triangles,
                    time.monotonic() - self._start, now.fraction))
        except BaseException as raised:
            self.raised = raised
        return self.raised is not None


def make(message: Any, on_progress: Callable[[results.Progress], object] | None) -> Made:
    """The mesh of a weft.v1.GenerateMeshRequest; raises as a Client does."""
    library = _library()
    writer = _Writer()
    request = writer.request(message)
    watch = _Watch(on_progress)
    control = Control(
        struct_size=ctypes.sizeof(Control), threads=message.threads,
        max_triangles=message.budget.max_triangles, max_bytes=message.budget.max_bytes,
        max_seconds=message.budget.max_seconds, on_progress=_OnProgress(watch.hear))
    error = c_void_p()
    mesh = library.weft_make(ctypes.byref(request), ctypes.byref(control), ctypes.byref(error))
    if mesh is None:
        try:
            if watch.raised is not None:
                raise watch.raised
            raise errors.of_library(library.weft_error_reason(error).decode(),
                                    library.weft_error_message(error).decode(),
                                    library.weft_error_field(error).decode(), message)
        finally:
            library.weft_error_free(error)
    try:
        if watch.raised is not None:  # by the last call, when the mesh was made already
            raise watch.raised
        return _made(library, mesh, message.want_quadtree)
    finally:
        library.weft_mesh_free(mesh)


def _copied(at: int | None, shape: tuple[int, ...], kind: Any) -> Any:
    """An array of one's own of what lies there."""
    if at is None or 0 in shape:
        return np.zeros(shape, kind)
    scalar: Any = {np.float64: c_double, np.int32: c_int32}[kind]
    return np.ctypeslib.as_array(ctypes.cast(at, POINTER(scalar)), shape).copy()


def _made(library: Any, mesh: Any, with_leaves: bool) -> Made:
    arrays = Arrays(struct_size=ctypes.sizeof(Arrays))
    library.weft_mesh_arrays(mesh, ctypes.byref(arrays))
    edges = _copied(arrays.edges, (arrays.edge_count, 4), np.int32)
    return Made(
        points=_copied(arrays.vertices, (arrays.vertex_count, 2), np.float64),
        triangles=_copied(arrays.triangles, (arrays.triangle_count, 3), np.int32),
        regions=_copied(arrays.regions, (arrays.triangle_count,), np.int32),
        edges=edges[:, :2].copy(), edge_segments=edges[:, 2].copy(), edge_markers=edges[:, 3].copy(),
        input_points=_copied(arrays.input_points, (arrays.input_point_count, 2), np.int32),
        summary=_summary(library, mesh, arrays, with_leaves))


def _summary(library: Any, mesh: Any, arrays: Arrays, with_leaves: bool) -> results.Summary:
    told = Summary(struct_size=ctypes.sizeof(Summary))
    library.weft_mesh_summary(mesh, ctypes.byref(told))

    def taken(*names: str) -> dict[str, Any]:
        return {name: getattr(told, name) for name in names}

    def counts(name: str) -> npt.NDArray[np.int64]:
        return np.array(getattr(told, name), np.int64)

    leaves = arrays.leaf_count if with_leaves and arrays.leaf_count <= _MOST_LEAVES else 0
    narrow = results.NarrowPlace(told.narrow_segment, told.narrow_other, told.narrow_x, told.narrow_y,
                                 told.narrow_width, int(told.narrow_triangles), int(told.narrow_in_all), told.narrow_widest)
    simplification = results.Simplification(
        told.simplified_points, told.dropped_islands, told.dropped_waters, told.cut_channels,
        told.cut_off_waters, told.straits, told.simplified_area, told.simplified_farthest)
    return results.Summary(
        vertices=arrays.vertex_count, triangles=arrays.triangle_count, edges=arrays.edge_count,
        **taken("chunks", "area", "min_angle_deg", "max_angle_deg", "min_angle_p1_deg",
                "mean_quality", "ideal_ratio", "lattice_share", "insertions", "exact_predicates",
                "threads", "deferred", "rounds"),
        streamed=bool(told.streamed),
        angle_histogram=counts("angle_histogram"), aspect_histogram=counts("aspect_histogram"),
        size_histogram=counts("size_histogram"),
        unrefined=results.Unrefined(
            **taken("small_input_angle", "edge_floor", "budget", "precision", "streaming",
                    "too_large"), x=told.unrefined_x, y=told.unrefined_y),
        merging=results.Merging(
            tolerance=told.merge_tolerance, points=told.merged_points,
            segments=told.merged_segments,
            **taken("farthest", "farthest_x", "farthest_y", "vanished_faces", "vanished_x",
                    "vanished_y")),
        narrow=narrow if told.has_narrow else None,
        outside=(results.OutsideSegments(told.outside_segments, told.outside_first, told.outside_x, told.outside_y)
                 if told.outside_segments else None),
        simplification=simplification if told.has_simplification else None,
        timings=results.Timings(
            prelude_seconds=told.coarse_seconds,
            **taken("triangulate_seconds", "size_seconds", "refine_seconds", "emit_seconds",
                    "engine_seconds")),
        peak_engine_bytes=told.peak_bytes, leaves=arrays.leaf_count,
        leaf_boxes=_copied(arrays.leaves, (leaves, 4), np.float64),
        engine_version=library.weft_engine_version().decode(), cached=False,
        digest=bytes(told.digest).hex(),
        size_warnings=tuple(
            results.SizeWarning(*(getattr(library, f"weft_warning_{part}")(mesh, i).decode()
                                  for part in ("kind", "field", "message")))
            for i in range(told.warning_count)))
