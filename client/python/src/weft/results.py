# SPDX-License-Identifier: Apache-2.0
"""What a server says, beside meshes. Immutable; seconds are floats, times are in UTC."""

from __future__ import annotations

import dataclasses
import datetime
import enum
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from . import _protocol, errors
from .quality import quality_of

T = TypeVar("T")


def _take(kind: type[T], message: Any, **special: Any) -> T:
    """A `kind` whose fields are those of the message but for the special ones."""
    names = (f.name for f in dataclasses.fields(kind))
    return kind(**special, **{name: getattr(message, name) for name in names if name not in special})


@dataclasses.dataclass(frozen=True)
class Accepted:
    """A request was admitted."""

    job_id: str
    """Names it in the server's log."""
    engine_version: str
    """A mesh depends on the request and this alone."""
    threads: int
    """On which it computes at the same time, at most."""


@dataclasses.dataclass(frozen=True)
class Progress:
    """Where the work is."""

    stage: str
    """`queued`, `triangulate`, `size`, `refine` or `emit`."""
    triangles: int
    """Of the mesh so far."""
    expected_triangles: int
    """Of the final mesh, estimated from the size; 0: not known."""
    elapsed_seconds: float
    """Since the request was accepted."""
    fraction: float
    """Finished over expected work, 0 to 1; never falls."""


@dataclasses.dataclass(frozen=True)
class Unrefined:
    """Triangles that miss a bound, by the reason why; each counts once."""

    small_input_angle: int
    """The angle is forced by two input segments."""
    edge_floor: int
    """A split would make edges below `min_edge`."""
    kept: int
    """A split would put a vertex on a segment that `keep` names."""
    budget: int
    """`max_triangles` was reached."""
    precision: int
    """A split would make edges where double precision ends; above 0 only with `allow_unrefined`, as
    is the next."""
    streaming: int
    """What is around the triangle had been sent already when it was to be split."""
    too_large: int
    """Of those in `precision` and `streaming`, the triangles larger than their bound; the others miss
    the minimum angle alone."""
    x: float
    """Centroid of the first triangle in `precision` or `streaming`; 0 if there is none."""
    y: float
    """See x."""
    kept_x: float
    """Centroid of the largest triangle in `kept`; 0 if there is none."""
    kept_y: float
    """See kept_x."""


@dataclasses.dataclass(frozen=True)
class Merging:
    """What of the input was merged because it lay nearer together than a tolerance."""

    tolerance: float
    """The larger of `snap` and the distance that double precision cannot keep apart."""
    points: int
    """Input points that moved onto another vertex."""
    segments: int
    """Input segments that were led through a vertex that is not exactly on them."""
    farthest: float
    """The largest distance that a point or a segment moved."""
    farthest_x: float
    """Where that is; 0 if nothing moved."""
    farthest_y: float
    """See farthest_x."""
    vanished_faces: int
    """Bounded faces of the input that the merging closed."""
    vanished_x: float
    """A place in one of them; 0 if there is none."""
    vanished_y: float
    """See vanished_x."""


@dataclasses.dataclass(frozen=True)
class NarrowPlace:
    """Two segments so near to each other that the bound on angles makes many triangles between them. A
    `snap` a little above `width` merges them, one above `widest` most of such places."""

    segment: int
    """Index of a segment of the domain."""
    other: int
    """Index of the other."""
    x: float
    """Of a place on the first, where they make the most triangles."""
    y: float
    """See x."""
    width: float
    """How far they are apart there."""
    triangles: int
    """Between them and around, at least."""
    in_all: int
    """Triangles in all such places of the domain, at least."""
    widest: float
    """Nine tenths of these lie where segments are no further apart than this."""


@dataclasses.dataclass(frozen=True)
class OutsideSegments:
    """Segments of the domain that border no area and of which no part bounds the mesh or lies in it. Where lines
    should enclose a face and do not close, they are outside."""

    segments: int
    """Number of them; of several that coincide, one counts."""
    first: int
    """Index of the first."""
    x: float
    """Of a point on the first."""
    y: float
    """See x."""


@dataclasses.dataclass(frozen=True)
class LayerSummary:
    """The layers along walls."""

    triangles: int
    least_thickness: float
    """Of the thinnest layers that do not end in a point, in the unit of the points."""
    x: float
    """Of a corner of the wall where they are."""
    y: float
    """See x."""
    cut: int
    """Corners of walls where layers are thinner than was asked for, because there is no room."""


@dataclasses.dataclass(frozen=True)
class Simplification:
    """What `simplify` did to the domain."""

    points: int
    """Of the domain, that are no vertices of the mesh."""
    islands: int
    """And other holes, that are meshed now."""
    waters: int
    """Parts of the domain that are no longer meshed."""
    channels: int
    """That were cut."""
    cut_off: int
    """Waters behind these, that are no longer meshed."""
    straits: int
    """Channels that stay although they are narrower: the widest way to a large water."""
    area: float
    """Of the new domain less that of the old one."""
    farthest: float
    """No point of a new line is farther than this from the segments of the domain."""
    cuts: tuple[tuple[float, float], ...]
    """A point in each channel that was cut, of 1,024 channels at most."""


@dataclasses.dataclass(frozen=True)
class SizeWarning:
    """A size that is probably not what the client wants; the client warns of it with `message`, too."""

    kind: str
    """`bounds_nothing`, `coarse_raster`, `field_not_named`, `gradation_within_alone`, or one that this
    client does not know: empty."""
    field: str
    """Name of the field that is meant; empty if none is."""
    message: str


@dataclasses.dataclass(frozen=True)
class Timings:
    """Where the time went, in seconds: wall time, but work summed over the threads for the stages
    `refine` and `emit`, which overlap."""

    triangulate_seconds: float
    size_seconds: float
    prelude_seconds: float
    refine_seconds: float
    emit_seconds: float
    engine_seconds: float
    """Wall time of all."""


@dataclasses.dataclass(frozen=True, eq=False)
class Summary:
    """What a mesh is like."""

    vertices: int
    triangles: int
    edges: int
    """Edges on input segments."""
    chunks: int
    area: float
    """Squared units of the domain."""
    min_angle_deg: float
    max_angle_deg: float
    min_angle_p1_deg: float
    """1 % of the triangles have a smallest angle below this."""
    mean_quality: float
    """Of 4 sqrt(3) area / (sum of the squared edges), 1 for equilateral triangles."""
    ideal_ratio: float
    """Triangles over the least number that the bounds on their areas allow; 0 without a bound."""
    lattice_share: float
    """How much of the area lies where points came from a lattice, from 0 to 1."""
    streamed: bool
    """Whether the mesh left the server's engine while it was refined, so that only a strip of it was
    in memory at a time."""
    angle_histogram: npt.NDArray[np.int64]
    """(18,): angles per 10 degrees."""
    aspect_histogram: npt.NDArray[np.int64]
    """(9,): triangles per aspect ratio, 1 for equilateral; the bins end at 1.1, 1.25, 1.5, 2, 3, 5,
    10, 100, infinity."""
    size_histogram: npt.NDArray[np.int64]
    """(10,): triangles per area over its bound, bins of 0.1, the last open."""
    unrefined: Unrefined
    merging: Merging
    narrow: NarrowPlace | None
    """The costliest one, if such places have at least a fifth of a mesh of a thousand triangles or more."""
    outside: OutsideSegments | None
    """None if there are none."""
    simplification: Simplification | None
    """Only with `simplify`."""
    layers: LayerSummary | None
    """Only with `layers`. Angles, quality, histograms, ideal_ratio and unrefined are of the triangles
    outside of layers; counts and the area are of all."""
    timings: Timings
    peak_engine_bytes: int
    insertions: int
    """Vertices that refinement inserted."""
    exact_predicates: int
    threads: int
    deferred: int
    rounds: int
    leaves: int
    """Of the quadtree; 0 if the mesh was made without one."""
    leaf_boxes: npt.NDArray[np.float64]
    """(leaves, 4): min x, min y, max x, max y; empty unless `quadtree=True` asked for them."""
    engine_version: str
    cached: bool
    """Whether the server had the mesh at hand: timings, peak and threads are those of the call that
    made it."""
    digest: str
    """SHA-256 in hexadecimal: the name of the mesh."""
    size_warnings: tuple[SizeWarning, ...]


@dataclasses.dataclass(frozen=True)
class ServerLimits:
    """What a request may ask for."""

    max_points: int
    max_segments: int
    max_seeds: int
    max_expression_bytes: int
    max_triangles: int
    max_bytes: int
    max_seconds: float
    max_request_bytes: int
    max_concurrent_jobs: int
    max_min_angle_deg: float
    max_raster_values: int


@dataclasses.dataclass(frozen=True)
class ServerInfo:
    """What a server is and what it admits."""

    version: str
    engine_version: str
    threads: int
    limits: ServerLimits


class JobState(enum.Enum):
    """Where a job is."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def is_final(self) -> bool:
        """Whether it stays so."""
        return self not in (JobState.QUEUED, JobState.RUNNING)

    @property
    def number(self) -> int:
        """As the protocol spells it."""
        return int(_protocol.enum("weft.v1.JobState").values_by_name[f"JOB_STATE_{self.name}"].number)


class CallbackState(enum.Enum):
    """What became of a callback."""

    PENDING = "pending"
    """The job has not ended, or another attempt follows."""
    DELIVERED = "delivered"
    FAILED = "failed"


@dataclasses.dataclass(frozen=True)
class Callback:
    """Telling a URL of the end of a job."""

    url: str
    state: CallbackState
    attempts: int
    error: str
    """Why the last attempt failed; empty if none has, or once it is delivered."""


@dataclasses.dataclass(frozen=True, eq=False)
class Job:
    """A job as it was when the server was asked."""

    id: str
    request_id: str
    state: JobState
    create_time: datetime.datetime | None
    start_time: datetime.datetime | None
    """When work on it first began; None if it has not, or if the mesh was kept already."""
    end_time: datetime.datetime | None
    attempts: int
    """More than 1 if a worker was lost."""
    worker: str
    progress: Progress | None
    """While it is running."""
    error: errors.ServerError | None
    """Why it failed, or that it was cancelled."""
    summary: Summary | None
    """Where it succeeded and the mesh is still kept; without `leaf_boxes`."""
    from_store: bool
    """Whether the mesh was kept already when the job was accepted."""
    client: str
    """Name of the client that submitted it; empty if the server does not identify clients."""
    callback: Callback | None
    """None if nobody is told of its end."""


def accepted(message: Any) -> Accepted:
    return _take(Accepted, message)


def progress(message: Any) -> Progress:
    stages = _protocol.enum("weft.v1.Stage").values_by_number
    stage = stages[message.stage].name.removeprefix("STAGE_").lower() if message.stage in stages else ""
    return _take(Progress, message, stage=stage)


def summary(message: Any) -> Summary:
    counts = {name: np.array(getattr(message, name), np.int64)
              for name in ("angle_histogram", "aspect_histogram", "size_histogram")}
    return _take(Summary, message, **counts,
                 unrefined=_take(Unrefined, message.unrefined),
                 merging=_take(Merging, message.merging),
                 narrow=_take(NarrowPlace, message.narrow) if message.HasField("narrow") else None,
                 outside=_take(OutsideSegments, message.outside) if message.HasField("outside") else None,
                 simplification=(_simplification(message.simplification)
                                 if message.HasField("simplification") else None),
                 layers=_take(LayerSummary, message.layers) if message.HasField("layers") else None,
                 timings=_take(Timings, message.timings),
                 leaf_boxes=np.array(message.leaf_boxes, np.float64).reshape(-1, 4),
                 digest=message.sha256.hex(),
                 size_warnings=tuple(map(_size_warning, message.size_warnings)))


def _simplification(message: Any) -> Simplification:
    return _take(Simplification, message, cuts=tuple(zip(message.cuts[::2], message.cuts[1::2])))


def _size_warning(message: Any) -> SizeWarning:
    kinds = _protocol.enum("weft.v1.SizeWarningKind").values_by_number
    prefix = "SIZE_WARNING_KIND_"
    kind = kinds[message.kind].name.removeprefix(prefix).lower() if message.kind in kinds else ""
    return SizeWarning("" if kind == "unspecified" else kind, message.field, message.message)


def summary_of(points: npt.NDArray[np.float64], triangles: npt.NDArray[np.int32],
               edges: int) -> Summary:
    """What the triangles of a mesh tell; the rest is 0 or empty."""
    quality = quality_of(points, triangles)
    angles = np.concatenate([quality.min_angles, quality.max_angles,
                             180 - quality.min_angles - quality.max_angles])
    corners = points[triangles]
    squares = ((np.roll(corners, -1, axis=1) - corners)**2).sum(axis=(1, 2))
    empty = _protocol.message("weft.v1.Summary")()
    known = {
        "vertices": len(points), "triangles": len(triangles), "edges": edges, "area": quality.area,
        "angle_histogram": np.histogram(angles, np.linspace(0, 180, 19))[0],
        "aspect_histogram": np.histogram(
            quality.aspects, [0, 1.1, 1.25, 1.5, 2, 3, 5, 10, 100, np.inf])[0]}
    if len(triangles):
        known.update(
            min_angle_deg=quality.min_angle, max_angle_deg=quality.max_angle,
            min_angle_p1_deg=float(np.quantile(quality.min_angles, 0.01)),
            mean_quality=float((4 * np.sqrt(3) * quality.areas / squares).mean()))
    return dataclasses.replace(summary(empty), **known)


def server_info(message: Any) -> ServerInfo:
    return _take(ServerInfo, message, limits=_take(ServerLimits, message.limits))


def job(message: Any) -> Job:
    def time(name: str) -> datetime.datetime | None:
        if not message.HasField(name):
            return None
        found = getattr(message, name)
        return (datetime.datetime.fromtimestamp(found.seconds, datetime.timezone.utc)
                + datetime.timedelta(microseconds=found.nanos // 1000))

    name = _protocol.enum("weft.v1.JobState").values_by_number[message.state].name
    state = JobState[name.removeprefix("JOB_STATE_")]
    error = None
    if message.HasField("error"):
        error = errors.of_status(message.error, f"the job {message.id} ended with")
    elif state is JobState.CANCELLED:
        error = errors.Cancelled(f"the job {message.id} was cancelled", code="CANCELLED")
    return _take(
        Job, message, state=state, error=error,
        create_time=time("create_time"), start_time=time("start_time"), end_time=time("end_time"),
        progress=progress(message.progress) if message.HasField("progress") else None,
        summary=summary(message.summary) if message.HasField("summary") else None,
        callback=_callback(message.callback) if message.HasField("callback") else None)


def _callback(message: Any) -> Callback:
    name = _protocol.enum("weft.v1.CallbackState").values_by_number[message.state].name
    return _take(Callback, message, state=CallbackState[name.removeprefix("CALLBACK_STATE_")])
