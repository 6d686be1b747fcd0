# SPDX-License-Identifier: Apache-2.0
"""The twin of weft.Client for asyncio: the same methods with `await`, the same errors.

    async with weft.aio.local() as client:
        mesh = await client.mesh("key.poly", size=0.1)
        async with client.stream("key.poly", size=0.01) as stream:
            async for chunk in stream: ...

Files of fields are read, and functions called that give sizes, in a thread of asyncio.to_thread. A call
that is cancelled ends at once, its thread once it has read the file or called the function.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import os
from collections.abc import AsyncIterator, Callable, Iterable, Sequence
from types import TracebackType
from typing import Any, Self, Unpack

import grpc

from . import _jobs, _protocol, _target, errors, results
from ._channel import OwnChannel
from ._receiver import MeshReceiver
from ._requests import MeshOptions, job_request, stream_request
from ._retry import Retry
from ._warning import in_thread
from ._wire import Chunk
from .domain import DomainLike
from .local import LocalServer
from ._mesh import Mesh
from .results import Job, JobState, Progress, ServerInfo
from .size import Size


class Client:
    """See weft.Client. For one event loop, in which it must be made."""

    def __init__(self, target: str | None = None, *, token: str | None = None,
                 tls: _target.TLS | bool | None = None, insecure: bool = False,
                 retries: int = 8) -> None:
        connection = _target.connection(target, token, tls, insecure)
        self.target = connection.target
        self._metadata = connection.metadata
        self._retries = retries
        self._own_channel = OwnChannel(grpc.aio, connection)

    @property
    def _channel(self) -> Any:
        return self._own_channel.get()

    async def close(self) -> None:
        """See weft.Client.close."""
        if self._own_channel.is_own():
            await self._channel.close()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *exception: object) -> None:
        await self.close()

    async def mesh(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
                   on_progress: Callable[[Progress], object] | None = None,
                   timeout: float | None = None, **options: Unpack[MeshOptions]) -> Mesh:
        """See weft.Client.mesh, which explains every option; help(client.mesh) shows it."""
        async with self.stream(domain, size, min_angle, on_progress=on_progress, timeout=timeout,
                               **options) as stream:
            return await stream.mesh()

    def stream(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
               on_progress: Callable[[Progress], object] | None = None,
               timeout: float | None = None, **options: Unpack[MeshOptions]) -> MeshStream:
        """See weft.Client.stream."""
        make = functools.partial(stream_request, domain, size, min_angle, options)
        return MeshStream(self, _protocol.GENERATE_MESH, make, timeout, on_progress)

    async def server_info(self) -> ServerInfo:
        """See weft.Client.server_info."""
        return results.server_info(await self._call(_protocol.GET_SERVER_INFO))

    async def submit(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
                     request_id: str | None = None, timeout: float | None = None,
                     **options: Unpack[MeshOptions]) -> Job:
        """See weft.Client.submit."""
        mesh = await in_thread(job_request, domain, size, min_angle, options)
        answer = await self._call(_protocol.SUBMIT_JOB, timeout, mesh=mesh, no_cache=mesh.no_cache,
                                  request_id=_jobs.request_id(request_id))
        return results.job(answer.job)

    async def get_job(self, job: Job | str) -> Job:
        """See weft.Client.get_job."""
        return results.job((await self._call(_protocol.GET_JOB, id=_jobs.id_of(job))).job)

    async def list_jobs(self, states: Iterable[JobState] = (),
                        limit: int | None = None) -> list[Job]:
        """See weft.Client.list_jobs."""
        pages = _jobs.Pages(states, limit)
        while pages.wanted():
            pages.take(await self._call(_protocol.LIST_JOBS, **pages.request()))
        return pages.jobs

    async def watch(self, job: Job | str, timeout: float | None = None) -> AsyncIterator[Job]:
        """See weft.Client.watch."""
        watch = _jobs.Watch()
        retry = self._retry(timeout)
        while True:
            call = self._stream(_protocol.WATCH_JOB, retry, id=_jobs.id_of(job))
            try:
                async for message in call:
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
            await self._wait(retry.wait_after(error))

    async def wait(self, job: Job | str, *, on_progress: Callable[[Progress], object] | None = None,
                   timeout: float | None = None) -> Job:
        """See weft.Client.wait."""
        async for seen in self.watch(job, timeout):
            if on_progress and seen.progress:
                on_progress(seen.progress)
        if seen.error:
            raise seen.error
        return seen

    async def cancel(self, job: Job | str) -> Job:
        """See weft.Client.cancel."""
        return results.job((await self._call(_protocol.CANCEL_JOB, id=_jobs.id_of(job))).job)

    async def delete(self, job: Job | str) -> None:
        """See weft.Client.delete."""
        await self._call(_protocol.DELETE_JOB, id=_jobs.id_of(job))

    async def fetch(self, job: Job | str, timeout: float | None = None) -> Mesh:
        """See weft.Client.fetch."""
        async with self.stream_job(job, timeout) as stream:
            return await stream.mesh()

    def stream_job(self, job: Job | str, timeout: float | None = None) -> MeshStream:
        """See weft.Client.stream_job."""
        request = _protocol.FETCH_MESH.request(id=_jobs.id_of(job))
        return MeshStream(self, _protocol.FETCH_MESH, lambda: (request, MeshReceiver()), timeout, None)

    def _retry(self, timeout: float | None) -> Retry:
        return Retry(self._retries, timeout, self.target)

    async def _wait(self, seconds: float) -> None:
        async def keep_connecting() -> None:
            # A connection comes back only while someone waits for it.
            while True:
                await self._channel.wait_for_state_change(self._channel.get_state(True))
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(keep_connecting(), seconds)

    async def _call(self, method: _protocol.Method, timeout: float | None = None,
                    **fields: Any) -> Any:
        call = self._channel.unary_unary(method.path, method.request.SerializeToString,
                                         method.response.FromString)
        retry = self._retry(timeout)
        repeated = False
        while True:
            try:
                return await call(method.request(**fields), timeout=retry.time_left(),
                                  metadata=self._metadata)
            except grpc.RpcError as broken:
                error = errors.of_call(broken, self.target, fields.get("mesh"))
            # Where the answer to the first attempt was lost, the job may be gone already.
            if repeated and method is _protocol.DELETE_JOB and isinstance(error, errors.NotFound):
                return method.response()
            await self._wait(retry.wait_after(error))
            repeated = True

    def _stream(self, method: _protocol.Method, retry: Retry, **fields: Any) -> Any:
        call = self._channel.unary_stream(method.path, method.request.SerializeToString,
                                          method.response.FromString)
        return call(method.request(**fields), timeout=retry.time_left(), metadata=self._metadata)

    def _raw_stream(self, method: _protocol.Method, request: Any, retry: Retry) -> Any:
        call = self._channel.unary_stream(method.path, method.request.SerializeToString)
        return call(request, timeout=retry.time_left(), metadata=self._metadata)


class MeshStream(AsyncIterator[Chunk]):
    """See weft.MeshStream. The request is made once its context is entered, or its first chunk is
    awaited, in a thread: that is where errors of files come, and where a function of x and y is
    called."""

    def __init__(self, client: Client, method: _protocol.Method,
                 make: Callable[[], tuple[Any, MeshReceiver]], timeout: float | None,
                 on_progress: Callable[[Progress], object] | None) -> None:
        self._client = client
        self._method = method
        self._make = make
        self._timeout = timeout
        self._on_progress = on_progress
        self._request: Any = None  # until it is made
        self._receiver = MeshReceiver()
        self._call: Any = None

    @property
    def accepted(self) -> results.Accepted | None:
        """Which job it is, once the server admitted it."""
        return self._receiver.accepted

    @property
    def summary(self) -> results.Summary | None:
        """What the mesh is like, once all chunks are there."""
        return self._receiver.summary

    async def mesh(self) -> Mesh:
        """Receives what is left and gives the whole mesh, also the chunks iterated over before."""
        async for _ in self:
            pass
        return await in_thread(self._receiver.mesh)

    def close(self) -> None:
        """Ends the call; does nothing to a stream that has ended."""
        if self._call is not None:
            self._call.cancel()
            self._call = None

    async def __aenter__(self) -> Self:
        await self._prepare()
        return self

    async def __aexit__(self, kind: type[BaseException] | None, value: BaseException | None,
                        traceback: TracebackType | None) -> None:
        self.close()

    def __aiter__(self) -> Self:
        return self

    async def _prepare(self) -> None:
        if self._request is None:
            self._request, self._receiver = await in_thread(self._make)
            self._retry = self._client._retry(self._timeout)

    async def __anext__(self) -> Chunk:
        await self._prepare()
        while self._receiver.summary is None:
            try:
                message = await self._open().read()
            except grpc.RpcError as broken:
                self._call = None
                error = errors.of_call(broken, self._client.target, self._request)
                await self._client._wait(self._retry.wait_after(error))
                continue
            if message is grpc.aio.EOF:
                raise errors.DamagedStream("the stream is damaged: it ended without a summary")
            came = self._receive(message)
            if isinstance(came, Chunk):
                self._retry.restart()
                return came
            if came and self._on_progress:
                self._on_progress(came)
        await self._finish()
        raise StopAsyncIteration

    def _open(self) -> Any:
        if self._call is None:
            self._request.first_chunk = self._receiver.chunks
            self._receiver.resume()
            self._call = self._client._raw_stream(self._method, self._request, self._retry)
        return self._call

    def _receive(self, message: bytes) -> Chunk | Progress | None:
        try:
            return self._receiver.receive(message)
        except BaseException:
            self.close()
            raise

    async def _finish(self) -> None:
        """Lets the call end by itself. What follows the summary does not matter: the mesh is whole."""
        call, self._call = self._call, None
        if call is not None:
            with contextlib.suppress(grpc.RpcError):
                while await call.read() is not grpc.aio.EOF:
                    pass


@contextlib.asynccontextmanager
async def local(weftd: str | os.PathLike[str] | None = None,
                arguments: Sequence[str] = ()) -> AsyncIterator[Client]:
    """See weft.local."""
    server = await asyncio.to_thread(LocalServer, weftd, arguments)
    try:
        async with Client(server.target, token="", retries=0) as client:
            yield client
    finally:
        await asyncio.to_thread(server.close)
