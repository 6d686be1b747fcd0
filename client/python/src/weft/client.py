# SPDX-License-Identifier: Apache-2.0
"""The client that blocks. weft.aio has its twin for asyncio, _channel.py what both have in common."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterable, Iterator
from types import TracebackType
from typing import Any, Self, Unpack

import grpc

from . import _jobs, _protocol, errors, results
from ._channel import ClientBase, StreamBase
from ._options import documented
from ._receiver import MeshReceiver
from ._requests import MeshOptions, job_request, stream_request
from ._wire import Chunk
from .domain import DomainLike
from ._mesh import Mesh
from .results import Job, JobState, Progress, ServerInfo
from .size import Size


class Client(ClientBase):
    """A connection to a server. Thread-safe; a context manager that closes it. For the process that makes
    it: in a fork, methods raise WeftError.

    `target`: "host:port" or "unix:/path"; default: $WEFT_SERVER. `token`: the bearer token; default:
    $WEFT_TOKEN. `tls`: True, or a TLS. `insecure`: send a token unencrypted even to other machines.
    `retries`: how often in a row a call is made again, without any progress in between, if the
    server was away or asks for it; streams go on where they broke.

    Methods raise ServerError (errors.py) when a call fails in the end, and DamagedStream for what
    is no mesh. Every `timeout` is in seconds, of all attempts together; default: none.

        with weft.Client("mesh.example.org:7421", tls=True) as client:
            mesh = client.mesh("pipe.poly", size="0.4*hypot(x-200, y-200) + 1", min_angle=30)
    """

    _grpc = grpc

    def close(self) -> None:
        """Ends the connection and the calls on it. In a fork of the process that made the client, does
        nothing."""
        if self._own_channel.is_own():
            self._channel.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    @documented
    def mesh(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
             on_progress: Callable[[Progress], object] | None = None, timeout: float | None = None,
             **options: Unpack[MeshOptions]) -> Mesh:
        """Meshes a domain.

        `domain`: a Domain, the path of a file, a GeoJSON object, a shapely geometry, arrays (n, 2) of
        rings; see DomainLike.
        `size`: upper bound on the areas of triangles, squared units of the domain: a positive number,
        an expression in x, y and names of `fields`, a Raster, a function of two arrays; default: none.
        `min_angle`: lower bound on every angle, degrees, 0 to 36; default: 20. Beside smaller angles of
        the domain it cannot hold.
        `on_progress`: called with a Progress a few times a second; default: not.
        `timeout`: seconds, of all attempts together; default: none.

        Size, in units of the domain (metres with `lonlat`):
        `edge`: length of edges, instead of `size` and of the same kinds; default: none.
        `fields`: {name: Field} that `edge` or `size` may name; default: none.
        `edge_at`: {marker or its name: length of edges on these segments}, above 0; default: none.
        `keep`: markers or names of segments that stay as they are, or "all"; default: none.
        `periodic`: pairs of markers or names of sides that get the same vertices; default: none.
        `layers`: {marker or its name: Layers} of walls with rows of thin triangles; default: none.

        Place:
        `lonlat`: True if the domain is in longitude and latitude, degrees; default: False.
        `crs`: name of the projection, implies `lonlat`; default: the one that distorts least.
        `to_metres`: leave the mesh in metres of the projection, implies `lonlat`; default: False.

        Others, in units of the domain:
        {options}

        Raises InvalidRequest with the field at fault, DomainError before that if it is known here.
        A WeftWarning says where a function was sampled too coarsely, see Raster.adaptive; that a
        size is larger than the domain, a raster of sizes coarser than the edges it asks for, or a
        field not named.
        """
        with self.stream(domain, size, min_angle, on_progress=on_progress, timeout=timeout,
                         **options) as stream:
            return stream.mesh()

    def stream(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
               on_progress: Callable[[Progress], object] | None = None,
               timeout: float | None = None, **options: Unpack[MeshOptions]) -> MeshStream:
        """As `mesh`, but gives the chunks while the rest of the mesh is refined.

            with client.stream("coast.geojson", size=1e-4) as stream:
                for chunk in stream:
                    total += len(chunk.triangles)
            print(stream.summary.digest)

        Of a domain in longitude and latitude, the chunks are in metres, and the mesh at the end in
        degrees.
        """
        request, receiver = stream_request(domain, size, min_angle, options)
        return MeshStream(self, _protocol.GENERATE_MESH, request, timeout, on_progress, receiver)

    def server_info(self) -> ServerInfo:
        """What the server is and what it admits."""
        return results.server_info(self._call(_protocol.GET_SERVER_INFO))

    def submit(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
               request_id: str | None = None, notify: str | None = None, timeout: float | None = None,
               **options: Unpack[MeshOptions]) -> Job:
        """Submits a job that makes the mesh; the server must keep jobs.

        `request_id`: a submission that is repeated with the same one finds the same job; default: a
        random one. `notify`: a URL that the server tells of the job's end, by a signed POST; default:
        the one that the server has for the client, if any. The rest is as in `mesh`; of a domain in longitude and latitude the mesh is
        fetched in metres, so `to_metres` must be set.
        """
        mesh = job_request(domain, size, min_angle, options)
        answer = self._call(_protocol.SUBMIT_JOB, timeout, mesh=mesh, no_cache=mesh.no_cache,
                            request_id=_jobs.request_id(request_id), notify=notify or "")
        return results.job(answer.job)

    def get_job(self, job: Job | str) -> Job:
        """The job of this id, as it is now."""
        return results.job(self._call(_protocol.GET_JOB, id=_jobs.id_of(job)).job)

    def list_jobs(self, states: Iterable[JobState] = (), limit: int | None = None) -> list[Job]:
        """One's own jobs, the youngest first; in one of the states, default: all."""
        pages = _jobs.Pages(states, limit)
        while pages.wanted():
            pages.take(self._call(_protocol.LIST_JOBS, **pages.request()))
        return pages.jobs

    def watch(self, job: Job | str, timeout: float | None = None) -> Iterator[Job]:
        """The job at once, and again whenever it changes; the last is final."""
        watch = _jobs.Watch()
        retry = self._retry(timeout)
        while True:
            call = self._stream(_protocol.WATCH_JOB, retry, id=_jobs.id_of(job))
            try:
                for message in call:
                    if (seen := watch.take(message.job)) is not None:
                        retry.restart()
                        yield seen
                if watch.ended:
                    return
                error: errors.ServerError = errors.Unavailable(
                    f"the server {self.target} ended the watch before the job", code="UNAVAILABLE")
            except grpc.RpcError as broken:
                if watch.ended:
                    return
                error = errors.of_call(broken, self.target)
            finally:
                call.cancel()
            self._wait(retry.wait_after(error))

    def wait(self, job: Job | str, *, on_progress: Callable[[Progress], object] | None = None,
             timeout: float | None = None) -> Job:
        """The job, once it has succeeded; raises its error if it failed or was cancelled."""
        for seen in self.watch(job, timeout):
            if on_progress and seen.progress:
                on_progress(seen.progress)
        if seen.error:
            raise seen.error
        return seen

    def cancel(self, job: Job | str) -> Job:
        """Ends a job that has not ended; does nothing to one that has."""
        return results.job(self._call(_protocol.CANCEL_JOB, id=_jobs.id_of(job)).job)

    def delete(self, job: Job | str) -> None:
        """Deletes a job that has ended; raises FailedPrecondition for one that has not."""
        self._call(_protocol.DELETE_JOB, id=_jobs.id_of(job))

    def fetch(self, job: Job | str, timeout: float | None = None) -> Mesh:
        """The mesh of a job that succeeded; FailedPrecondition before that."""
        with self.stream_job(job, timeout) as stream:
            return stream.mesh()

    def stream_job(self, job: Job | str, timeout: float | None = None) -> MeshStream:
        """As `fetch`, but gives the chunks as they come."""
        request = _protocol.FETCH_MESH.request(id=_jobs.id_of(job))
        return MeshStream(self, _protocol.FETCH_MESH, request, timeout, None, MeshReceiver())

    def _wait(self, seconds: float) -> None:
        # A connection comes back only while someone waits for it. This call does; so would a subscription to
        # the channel's state, but its thread may stop the interpreter from ending.
        end = time.monotonic() + seconds
        with contextlib.suppress(grpc.RpcError):
            self._channel.unary_unary(_protocol.HEALTH)(b"", timeout=seconds, wait_for_ready=True)
        time.sleep(max(0.0, end - time.monotonic()))

    def _call(self, method: _protocol.Method, timeout: float | None = None, **fields: Any) -> Any:
        call = self._channel.unary_unary(method.path, method.request.SerializeToString,
                                         method.response.FromString)
        retry = self._retry(timeout)
        repeated = False
        while True:
            try:
                return call(method.request(**fields), timeout=retry.time_left(),
                            metadata=self._metadata)
            except grpc.RpcError as broken:
                error = errors.of_call(broken, self.target, fields.get("mesh"))
            # Where the answer to the first attempt was lost, the job may be gone already.
            if repeated and method is _protocol.DELETE_JOB and isinstance(error, errors.NotFound):
                return method.response()
            self._wait(retry.wait_after(error))
            repeated = True


class MeshStream(StreamBase, Iterator[Chunk]):
    """The chunks of a mesh, in order, each verified; then `summary`.

    A stream that broke goes on where it was: a mesh that is being made is made again and what is
    there already is not sent twice. After Unavailable was raised, iteration may be tried again
    later. Leaving its context, or `close`, ends the work on the server. Not thread-safe.
    """

    def __init__(self, client: Client, method: _protocol.Method, request: Any,
                 timeout: float | None, on_progress: Callable[[Progress], object] | None,
                 receiver: MeshReceiver) -> None:
        super().__init__(client, method, request, receiver, on_progress)
        self._client: Client = client
        self._retry = client._retry(timeout)

    def mesh(self) -> Mesh:
        """Receives what is left and gives the whole mesh, also the chunks iterated over before."""
        for _ in self:
            pass
        return self._receiver.mesh()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 traceback: TracebackType | None) -> None:
        self.close()

    def __iter__(self) -> Self:
        return self

    def __next__(self) -> Chunk:
        while self._receiver.summary is None:
            try:
                message = next(self._open(), None)
            except grpc.RpcError as broken:
                self._client._wait(self._wait_after(broken))
                continue
            if message is None:
                raise errors.DamagedStream("the stream is damaged: it ended without a summary")
            if (chunk := self._receive(message)) is not None:
                return chunk
        self._finish()
        raise StopIteration

    def _finish(self) -> None:
        """Lets the call end by itself. What follows the summary does not matter: the mesh is whole."""
        call, self._call = self._call, None
        if call is not None:
            try:
                for _ in call:
                    pass
            except grpc.RpcError:
                pass
